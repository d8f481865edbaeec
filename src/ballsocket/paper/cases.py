"""Joints and loads of the paper (doi 10.3390/app112311170) and of other publications; Table 3 fitted again."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from importlib.resources import files
from io import StringIO
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Array, Numbers
from ..core.quantities import JOINT
from ..models.modulus import polynomial
from ..models.table_3 import table_3
from ..problem import Joint, Material
from ..problem.presets import COCR, CROSSLINKED_PE, STEEL, UHMWPE
from ..studies.calibration import Calibration, as_polynomial, calibrate

RANGES = {"ball_radius": (11.0, 23.0), "outer_radius": (16.0, 26.0), "clearance": (0.05, 0.2), "poisson": (0.3, 0.49)}
"""Table 1 of Heß & Forsbach 2021 in mm, and the Poisson's ratios of Table 3."""

THICKNESS = (3.0, 15.0)  # smallest and largest liner thickness in mm

RATIOS = numpy.array([0.73, 1.0, 1.35, 1.8, 2.3, 2.8, 3.4, 4.1, 4.9, 5.8, 6.7, 7.7])
"""Ratios R2/L over which Table 3 is refitted."""


def paper_joint(poisson: Array, ratios: Array = RATIOS) -> Joint:
    """Create the joints of Figure 2 (right) and Table 3 from R2/L: outer radius 24 mm, clearance 0.1 mm."""
    socket = 24.0 * ratios / (1 + ratios)
    return joint(head_radius=socket - 0.1, liner_thickness=24.0 - socket, poisson=poisson)


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

    Raises ValueError: a Poisson's ratio that Table 3 does not have.
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
    first, second, third = (float(number) for number in numbers)
    return first, second, third


POISSON = (0.30, 0.35, 0.40, 0.45, 0.49)  # Poisson's ratios of Table 3 and Figure 2

CLEARANCES = (0.05, 0.1, 0.15, 0.2)
HEAD_RADII = (11.0, 14.0, 16.0, 20.0, 23.0)
THICKNESSES = (3.0, 6.0, 9.0, 12.0)
"""Series of Figure 5 in mm. The paper states the ends of each series, and not always the values between them."""

LOAD = 3000.0  # force in N at which pressures and areas are shown

LOADS = numpy.array([1000.0, 1500.0, 2000.0, 2500.0, 3000.0])
"""Forces in N over which the foundation modulus is averaged."""

OUTER_RADII = RANGES["outer_radius"]  # limits of Table 1 for R2 + L in mm, dotted in Figure 6


def hip(poisson: Numbers | float = 0.4) -> Joint:
    """Create the joint of Figures 3 and 4: R2 18, L 6.75, c 0.1 mm."""
    return joint(head_radius=17.9, liner_thickness=6.75, poisson=poisson)


def joint(
    *,
    head_radius: Array = 16.0,
    clearance: Array = 0.1,
    liner_thickness: Array = 6.0,
    poisson: Array = 0.4,
) -> Joint:
    """Create a joint of steel on 1 GPa; the defaults are the common joint of the series of Figure 5."""
    return Joint(
        ball_radius=head_radius,
        clearance=clearance,
        liner_thickness=liner_thickness,
        liner=Material(young=1000.0, poisson=poisson),
        ball=STEEL,
    )


def series() -> dict[str, Joint]:
    """Return the three series of Figure 5, each as one joint of arrays."""
    return {
        "clearance": joint(clearance=numpy.array(CLEARANCES)),
        "head_radius": joint(head_radius=numpy.array(HEAD_RADII)),
        "liner_thickness": joint(liner_thickness=numpy.array(THICKNESSES)),
    }


def named_series() -> Iterator[tuple[str, Joint, tuple[float, ...]]]:
    """Yield symbol, joints and values of each series of Figure 5."""
    symbols = (JOINT[name].symbol for name in ("clearance", "ball_radius", "liner_thickness"))
    yield from zip(symbols, series().values(), (CLEARANCES, HEAD_RADII, THICKNESSES), strict=True)


def outline(heads: int = 5, liners: int = 3) -> tuple[Numbers, Numbers, Joint]:
    """Return head radii and liner thicknesses in mm over the range of Table 1, and their joints with c 0.1 mm."""
    radius = numpy.linspace(*RANGES["ball_radius"], heads)[:, None] + numpy.zeros(liners)
    thinnest, thickest = (numpy.clip(outer - radius - 0.1, *THICKNESS) for outer in (OUTER_RADII[0], OUTER_RADII[1]))
    thickness = thinnest + (thickest - thinnest) * numpy.linspace(0.0, 1.0, liners)
    radius, thickness = radius.ravel(), thickness.ravel()
    return radius, thickness, joint(head_radius=radius, liner_thickness=thickness)


def scaled_modulus(contact_pressure: Numbers, indentation: Numbers, socket_radius: Numbers) -> Numbers:
    """Compute the dimensionless modulus K~ = p0 R2/(d E), Eq. (17), for a liner of 1000 MPa."""
    return contact_pressure * socket_radius / (indentation * 1000.0)


# Joints of other publications


def calculix() -> Numbers:
    """Read the results of CalculiX: one row a load, with the columns of `data/calculix.csv` (mm, N, MPa, degrees)."""
    text = (files("ballsocket") / "data" / "calculix.csv").read_text(encoding="utf-8")
    rows = StringIO("\n".join(line for line in text.splitlines() if not line.startswith("#")))
    return numpy.genfromtxt(rows, delimiter=",", names=True, dtype=None, encoding="utf-8")


def joints_of_calculix(table: Numbers) -> Joint:
    """Create the joints of rows of the CalculiX table, as arrays."""
    names = ("clearance", "liner_thickness", "poisson")
    return joint(head_radius=table["ball_radius"], **{name: table[name] for name in names})


def calculix_joints() -> tuple[Joint, Numbers]:
    """Return the joints and forces in N of CalculiX."""
    table = calculix()
    return joints_of_calculix(table), table["force"]


JIN_HEADS = {"22 mm head": (11.0, 10.0), "28 mm head": (14.0, 8.0), "32 mm head": (16.0, 6.0)}
"""Head radius and liner thickness in mm. Representative: the abstract does not name the pairs."""

JIN_CLEARANCES, JIN_FORCE = numpy.array([0.1, 0.15]), 2500.0


def jin_joints() -> tuple[Joint, Numbers]:
    """Return the joints and the force in N of Jin et al. 1999."""
    radii, thicknesses = (numpy.array(column)[:, None] for column in zip(*JIN_HEADS.values(), strict=True))
    joints = Joint(ball_radius=radii, clearance=JIN_CLEARANCES, liner_thickness=thicknesses, liner=UHMWPE, ball=COCR)
    return joints, numpy.array(JIN_FORCE)


PLANK = (
    ("22 mm, 5 mm thick", 11.0, 5.0),
    ("28 mm, 5 mm thick", 14.0, 5.0),
    ("28 mm, 3 mm thick", 14.0, 3.0),
    ("38 mm, 3 mm thick", 19.0, 3.0),
    ("46 mm, 3 mm thick", 23.0, 3.0),
)
PLANK_CLEARANCE, PLANK_FORCE = 0.1, 3000.0


def plank_joints() -> tuple[Joint, Numbers]:
    """Return the joints and the force in N of Plank et al. 2007."""
    heads, thicknesses = (numpy.array(column)[:, None] for column in list(zip(*PLANK, strict=True))[1:])
    liner = Material(young=numpy.array([UHMWPE.young, CROSSLINKED_PE.young]), poisson=UHMWPE.poisson)
    joints = Joint(ball_radius=heads, clearance=PLANK_CLEARANCE, liner_thickness=thicknesses, liner=liner, ball=COCR)
    return joints, numpy.array(PLANK_FORCE)
