"""What "valid" is worth: every model against the elastic answer at the joints where it trusts itself.

The ranges of the models were found here: at 99 % of the points that a model calls valid its errors are within its
promise, and the worst is no more than 1.3 times that.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import log, radians
from typing import Any

import numpy

from ..catalogue import catalogue
from ..contact import Model
from ..core.arrays import to_list
from ..core.validity import Promise
from ..elasticity.exact.tabulated.model import Tabulated
from ..problem import Joint, Material

SHARE, EXCESS = 0.99, 1.3
"""How many of the valid points keep the promise, and by how much the worst may exceed it."""

TRUTH = Tabulated()
"""The elastic answer to 2e-4, which is quick enough for very many joints."""

Numbers = numpy.ndarray


@dataclass(frozen=True, kw_only=True)
class MeasuredValidity:
    """How a model keeps its promise.

    Attributes
    ----------
    model : str
    promise : Promise
    asked, valid : int
        Contacts that were asked for, and those that the model calls valid.
    kept : float
        Share of the valid ones whose errors are all within the promise.
    worst : dict of str to float
        Largest relative error of each promised quantity among the valid ones.
    worst_joint : Joint
        Where the largest of all errors is.
    """

    model: str
    promise: Promise
    asked: int
    valid: int
    kept: float
    worst: dict[str, float]
    worst_joint: Joint

    @property
    def holds(self) -> bool:
        """Whether the promise is kept as it says."""
        return self.kept >= SHARE and max(self.worst.values()) <= EXCESS * self.promise.within

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "model": self.model,
            "promise": str(self.promise),
            "asked": self.asked,
            "valid": self.valid,
            "kept": self.kept,
            "worst": {name: to_list(numpy.float64(error)) for name, error in self.worst.items()},
            "worst_joint": self.worst_joint.summary(),
        }


def population(size: int, seed: int = 1) -> tuple[Joint, Numbers]:
    """Joints of all kinds, as one of arrays, and half angles in rad.

    R1 4 to 30 mm, c/R1 0.0005 to 0.02, R2/L 0.2 to 20 and E 200 to 3500 MPa in the logarithm; ν 0 to 0.499; in every
    other joint a steel ball, and in the others one so stiff that it is rigid; half angles of 1 to 84 degrees.
    """
    rng = numpy.random.default_rng(seed)
    radius = _spread(rng, 4.0, 30.0, size)
    clearance = radius * _spread(rng, 5e-4, 2e-2, size)
    joint = Joint(
        ball_radius=radius,
        clearance=clearance,
        liner_thickness=(radius + clearance) / _spread(rng, 0.2, 20.0, size),
        liner=Material(young=_spread(rng, 200.0, 3500.0, size), poisson=rng.uniform(0.0, 0.499, size)),
        ball=Material(young=numpy.where(numpy.arange(size) % 2, 210_000.0, 1e9), poisson=0.3),
    )
    return joint, rng.uniform(radians(1.0), radians(84.0), size)


def _spread(rng: numpy.random.Generator, low: float, high: float, size: int) -> Numbers:
    return numpy.exp(rng.uniform(log(low), log(high), size))


def promising(models: Iterable[Model] = tuple(catalogue.values())) -> Iterator[Model]:
    """Models whose promise can be measured against the elastic answer."""
    return (model for model in models if model.promise is not None and model.name != TRUTH.name)


def measure(model: Model, size: int = 20_000, seed: int = 1) -> MeasuredValidity:
    """How a model keeps its promise, at the forces of the elastic answer.

    Parameters
    ----------
    model : Model
        One with a promise.
    size, seed : int
        Of the population.

    Raises
    ------
    ValueError
        A model that promises nothing, or one that trusts itself nowhere in the population.
    """
    promise = model.promise
    if promise is None:
        raise ValueError(f"{model.name} promises nothing")
    joint, angle = population(size, seed)
    truth = TRUTH.press(joint, half_angle=angle)
    answered = numpy.flatnonzero(numpy.isfinite(truth.force))
    joint = joint.with_numbers([_at(number, answered) for number in joint.numbers()])
    contact = model.press(joint, force=truth.force[answered])
    valid = numpy.asarray(contact.valid)
    if not valid.any():
        raise ValueError(f"{model.name} trusts itself nowhere among {answered.size} contacts")
    errors = {
        name: abs(getattr(contact, name) / getattr(truth, name)[answered] - 1)[valid] for name in promise.quantities
    }
    largest = numpy.max(list(errors.values()), axis=0)
    place = numpy.flatnonzero(valid)[int(largest.argmax())]
    return MeasuredValidity(
        model=model.name,
        promise=promise,
        asked=int(answered.size),
        valid=int(valid.sum()),
        kept=float(numpy.mean(largest <= promise.within)),
        worst={name: float(error.max()) for name, error in errors.items()},
        worst_joint=joint.with_numbers([float(_at(number, [place]).item()) for number in joint.numbers()]),
    )


def _at(number: Any, places: Any) -> Numbers:
    """A number, or those of an array at some places."""
    values = numpy.atleast_1d(numpy.asarray(number, dtype=float))
    return values if values.size == 1 else values[places]
