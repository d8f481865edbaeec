"""Errors of every model against the exact solution, over the joints of the paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.validity import OutsideDomainError
from ..model_catalogue import catalogue, reference, with_gap
from ..problem import Joint
from .cases import RANGES, THICKNESS, joint

FORCES = numpy.array([500.0, 1000.0, 2000.0, 3000.0, 4000.0])
"""Loads in N."""

QUANTITIES = ("indentation", "max_pressure", "half_angle", "force")
"""Compared quantities: the first three at a given force, the force at the indentation of the exact solution."""


@dataclass(frozen=True, kw_only=True)
class Spread:
    """Relative errors of one quantity over all joints and loads."""

    # median, 95th percentile and maximum
    median: float
    high: float
    worst: float
    joint: Joint  # joint with the largest error
    load: float  # force in N of the largest error

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON; `high` is the 95th percentile, `load` in N."""
        return {
            "median": self.median,
            "percentile_95": self.high,
            "worst": self.worst,
            "worst_at": {"joint": self.joint.summary(), "force": self.load},
        }


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Errors of one model."""

    model: str
    spreads: dict[str, Spread]  # errors by quantity
    # fractions of the contacts with a result, and of those within the range of the model
    answered: float
    valid: float

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        errors = {name: spread.summary() for name, spread in self.spreads.items()}
        return {"model": self.model, "answered": self.answered, "valid": self.valid, "errors": errors}


def edge_joints() -> Joint:
    """Create the joints at the ends of the paper's ranges, where errors are largest: arrays of shape (joints,).

    They combine ends and middle of the head radius, ends and middle of the liner thickness that the outer radius
    allows, the ends of the clearance, and ν 0.3, 0.4 and 0.49.
    """
    clearances = RANGES["clearance"]
    largest = RANGES["outer_radius"][1] - THICKNESS[0] - max(clearances)  # leaves the thinnest liner
    radii = numpy.linspace(RANGES["ball_radius"][0], largest, 3)
    R1, c, poisson, fraction = (
        grid.ravel() for grid in numpy.meshgrid(radii, clearances, (0.3, 0.4, 0.49), (0.0, 0.5, 1.0), indexing="ij")
    )
    thinnest, thickest = (numpy.clip(outer - R1 - c, *THICKNESS) for outer in RANGES["outer_radius"])
    thickness = thinnest + fraction * (thickest - thinnest)
    return joint(head_radius=R1, clearance=c, liner_thickness=thickness, poisson=poisson)


def paper_joints(count: int = 128) -> Joint:
    """Create joints that fill the paper's ranges evenly, as arrays of shape (joints,): steel on 1 GPa.

    They are `count` points of Sobol's sequence (a power of two), without those with a liner that is too thin or thick.
    """
    from scipy.stats.qmc import Sobol, scale

    low, high = zip(*RANGES.values(), strict=True)
    points = scale(Sobol(len(RANGES), scramble=False).random(count), low, high)
    thickness = points[:, 1] - points[:, 0] - points[:, 2]
    allowed = (thickness >= THICKNESS[0]) & (thickness <= THICKNESS[1])
    R1, _, clearance, poisson = points[allowed].T
    return joint(head_radius=R1, clearance=clearance, liner_thickness=thickness[allowed], poisson=poisson)


def accuracies(
    models: Mapping[str, Model] | None = None, joints: Joint | None = None, edges: Joint | None = None
) -> tuple[Accuracy, ...]:
    """Compute the errors of models against the exact solution, sorted by the median error of the peak pressure.

    Parameters
    ----------
    models : mapping of str to Model, optional
        By default the full catalogue. A model without a result for any joint is omitted.
    joints : Joint, optional
        Joints of median and percentile, arrays of shape (joints,); `paper_joints()` by default.
    edges : Joint, optional
        Additional joints for the maximum; `edge_joints()` by default.
    """
    chosen = catalogue if models is None else models
    within = paper_joints() if joints is None else joints
    extremes = edge_joints() if edges is None else edges
    n_within, n_edges = len(within.ball_radius), len(extremes.ball_radius)
    pairs = zip(within.numbers(), extremes.numbers(), strict=True)
    family = within.with_numbers(
        [numpy.concatenate([a * numpy.ones(n_within), b * numpy.ones(n_edges)]) for a, b in pairs]
    )
    exact = with_gap(reference, "linear").press(family, force=FORCES[:, None])
    rows = []
    for name, model in chosen.items():
        if name == reference.name:
            continue
        try:
            at_force = model.press(family, force=FORCES[:, None])
            at_indentation = model.press(family, indentation=exact.indentation)
        except OutsideDomainError:
            continue
        spreads = {}
        for quantity in QUANTITIES:
            value = getattr(at_indentation if quantity == "force" else at_force, quantity)
            spreads[quantity] = _spread(abs(value / getattr(exact, quantity) - 1), family, slice(0, n_within))
        answered = float(numpy.mean(numpy.isfinite(at_force.indentation)))
        rows.append(Accuracy(model=name, spreads=spreads, answered=answered, valid=float(numpy.mean(at_force.valid))))
    return tuple(sorted(rows, key=lambda row: row.spreads["max_pressure"].median))


def _spread(error: Numbers, joints: Joint, inner: slice) -> Spread:
    """Compute median and percentile of errors (loads, joints) over the inner joints, and the maximum over all."""
    inside = error[:, inner]
    known = inside[numpy.isfinite(inside)]
    load, which = numpy.unravel_index(int(numpy.nanargmax(error)), error.shape)
    numbers = [float(numpy.broadcast_to(number, error.shape[1:])[which]) for number in joints.numbers()]
    return Spread(
        median=float(numpy.median(known)),
        high=float(numpy.percentile(known, 95)),
        worst=float(error[load, which]),
        joint=joints.with_numbers(numbers),
        load=float(FORCES[load]),
    )
