"""Measured reliability of the word "valid": the errors of every model within its range, against the exact solution.

The ranges of the models were found with this measurement: at least 99 % of the valid points have errors within the
promise of the model, and the largest error is at most 1.3 times the promise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import log, radians
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers, to_list
from ..core.validity import Promise
from ..elasticity.exact.tabulated.model import Tabulated
from ..model_catalogue import catalogue
from ..problem import Joint, Material

SHARE, EXCESS = 0.99, 1.3
"""Required share of valid points within the promise, and largest allowed error over the promise."""

TRUTH = Tabulated()  # reference solution, with an error of 2e-4; fast enough for large populations


@dataclass(frozen=True, kw_only=True)
class MeasuredValidity:
    """Measured errors of a model within its range."""

    model: str
    promise: Promise
    # number of contacts, and of those in the range of the model
    contacts: int
    valid: int
    kept_share: float  # share of the valid contacts with all errors within the promise
    worst: dict[str, float]  # largest relative error of each promised quantity over the valid contacts
    worst_joint: Joint  # joint with the largest error

    @property
    def holds(self) -> bool:
        """True for a promise that the measured errors confirm."""
        return self.kept_share >= SHARE and max(self.worst.values()) <= EXCESS * self.promise.within

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {
            "model": self.model,
            "promise": str(self.promise),
            "asked": self.contacts,
            "valid": self.valid,
            "kept": self.kept_share,
            "worst": {name: to_list(numpy.float64(error)) for name, error in self.worst.items()},
            "worst_joint": self.worst_joint.summary(),
        }


def population(size: int, seed: int = 1) -> tuple[Joint, Numbers]:
    """Sample joints of all kinds, as one joint of arrays, and half angles in rad.

    R1 4 to 30 mm, c/R1 0.0005 to 0.02, R2/L 0.2 to 20 and E 200 to 3500 MPa are log-uniform; ν is 0 to 0.499. Steel
    balls alternate with rigid ones. Half angles are 1 to 84 degrees.
    """
    rng = numpy.random.default_rng(seed)
    radius = _log_uniform(rng, 4.0, 30.0, size)
    clearance = radius * _log_uniform(rng, 5e-4, 2e-2, size)
    joint = Joint(
        ball_radius=radius,
        clearance=clearance,
        liner_thickness=(radius + clearance) / _log_uniform(rng, 0.2, 20.0, size),
        liner=Material(young=_log_uniform(rng, 200.0, 3500.0, size), poisson=rng.uniform(0.0, 0.499, size)),
        ball=Material(young=numpy.where(numpy.arange(size) % 2, 210_000.0, 1e9), poisson=0.3),
    )
    return joint, rng.uniform(radians(1.0), radians(84.0), size)


def _log_uniform(rng: numpy.random.Generator, low: float, high: float, size: int) -> Numbers:
    return numpy.exp(rng.uniform(log(low), log(high), size))


def models_with_promise() -> Iterator[Model]:
    """Yield the models of the catalogue whose promise can be compared with the reference solution."""
    return (model for model in catalogue.values() if model.promise is not None and model.name != TRUTH.name)


def measure(model: Model, size: int = 20_000, seed: int = 1) -> MeasuredValidity:
    """Measure the errors of a model with a promise within its range, at the forces of the reference solution.

    `size` and `seed` are those of the population.

    Raises ValueError: a model without a promise, or without a valid contact in the population.
    """
    promise = model.promise
    if promise is None:
        raise ValueError(f"{model.name} has no promise of accuracy: choose a model with one")
    joint, angle = population(size, seed)
    truth = TRUTH.press(joint, half_angle=angle)
    solved = numpy.flatnonzero(numpy.isfinite(truth.force))
    joint = joint.with_numbers([_select(number, solved) for number in joint.numbers()])
    contact = model.press(joint, force=truth.force[solved])
    valid = numpy.asarray(contact.valid)
    if not valid.any():
        raise ValueError(f"{model.name} has no valid contact among {solved.size}: choose a larger size")
    errors = {
        name: abs(getattr(contact, name) / getattr(truth, name)[solved] - 1)[valid] for name in promise.quantities
    }
    largest = numpy.max(list(errors.values()), axis=0)
    worst = numpy.flatnonzero(valid)[int(largest.argmax())]
    return MeasuredValidity(
        model=model.name,
        promise=promise,
        contacts=int(solved.size),
        valid=int(valid.sum()),
        kept_share=float(numpy.mean(largest <= promise.within)),
        worst={name: float(error.max()) for name, error in errors.items()},
        worst_joint=joint.with_numbers([float(_select(number, [worst]).item()) for number in joint.numbers()]),
    )


def _select(number: Any, indices: Any) -> Numbers:
    """Return the numbers of some contacts; a single number belongs to all of them."""
    values = numpy.atleast_1d(numpy.asarray(number, dtype=float))
    return values if values.size == 1 else values[indices]
