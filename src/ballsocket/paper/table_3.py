"""Table 3 of the paper: the foundation modulus fitted to finite elements, and fitted again to the exact solution."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Array
from ..identify.modulus import Calibration, as_polynomial, calibrate
from ..models.modulus import polynomial
from ..models.table_3 import table_3
from ..problem import Joint, Material
from ..problem.presets import STEEL

RATIOS = numpy.array([0.73, 1.0, 1.35, 1.8, 2.3, 2.8, 3.4, 4.1, 4.9, 5.8, 6.7, 7.7])
"""Ratios R2/L over which Table 3 is refitted."""


def paper_joint(poisson: Array, ratios: Array = RATIOS) -> Joint:
    """Create joints from R2/L in the ranges of Table 1: outer radius 24 mm, clearance 0.1 mm, steel on 1 GPa."""
    socket = 24.0 * ratios / (1 + ratios)
    return Joint(
        ball_radius=socket - 0.1,
        clearance=0.1,
        liner_thickness=24.0 - socket,
        liner=Material(young=1000.0, poisson=poisson),
        ball=STEEL,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class TableColumn:
    """Column of Table 3: the constants of the paper and ours.

    `difference` is the relative difference of the paper's K from the reference at each of `RATIOS`. `paper_error` has
    the largest errors of the closed form with the paper's K; `calibration.error` has those with ours.
    """

    poisson: float
    paper: tuple[float, float, float]
    ours: tuple[float, float, float]
    difference: numpy.ndarray
    paper_error: dict[str, float]
    calibration: Calibration

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {
            "poisson": self.poisson,
            "paper": list(self.paper),
            "ours": list(self.ours),
            "thickness_ratio": RATIOS.tolist(),
            "difference": self.difference.tolist(),
            "residual": self.calibration.residual.tolist(),
            "spread_over_load": self.calibration.spread,
            "error": self.calibration.error,
            "paper_error": self.paper_error,
        }


def refit_table_3(reference: Model | None = None) -> tuple[TableColumn, ...]:
    """Fit Table 3 again, by default to `Exact()`."""
    return tuple(refit_column(poisson, reference) for poisson in table_3()["poisson"])


def refit_column(poisson: float, reference: Model | None = None) -> TableColumn:
    """Fit one column of Table 3 again, for one of its Poisson's ratios.

    Raises
    ------
    ValueError
        A Poisson's ratio that Table 3 does not have.
    """
    published = table_3()
    if poisson not in published["poisson"]:
        raise ValueError(f"poisson = {poisson!r} has no column in Table 3; allowed: {published['poisson']}")
    column = published["poisson"].index(poisson)
    paper = _three(published[name][column] for name in ("C1", "C2", "C3"))
    joint = paper_joint(poisson)
    fit = calibrate(joint, form=as_polynomial, reference=reference)
    theirs = replace(fit, modulus=polynomial(*paper))
    return TableColumn(
        poisson=poisson,
        paper=paper,
        ours=_three(fit.modulus.constants),
        difference=theirs.residual,
        paper_error=theirs.error,
        calibration=fit,
    )


def _three(numbers: Iterable[Any]) -> tuple[float, float, float]:
    """Convert three numbers to floats."""
    first, second, third = (float(number) for number in numbers)
    return first, second, third
