"""Claims of other authors: results of another program, and of the laboratory."""

from __future__ import annotations

from importlib.resources import files
from io import StringIO

import numpy

from ...contact import Model
from ...core.arrays import Numbers
from ...core.deprecation import renamed_names
from ...core.sources import Source
from ...elasticity.exact.contact import ElasticContact
from ...elasticity.exact.model import Exact
from ...elasticity.finite_elements.model import FiniteElement
from ...identify.modulus import max_relative_error
from ...problem import Joint, Material
from ...problem.presets import COCR, CROSSLINKED_PE, STEEL, UHMWPE
from .evaluation import BY_EVALUATION, EXACTLY, ZERO, Claim, Computed, Evaluation, percent

SOURCES = (Source("jin1999"), Source("plank2007"))
"""Sources of the numbers, besides CalculiX."""

_DEPTH, _PRESSURE, _ANGLE = "indentation off by, %", "peak pressure off by, %", "half angle off by, °"


def _errors_of_elements(_: Model) -> Computed:
    """Compute the errors of our elements against CalculiX: 19 joints under five to nine loads, with a free rim."""
    return _errors(FiniteElement(meshes=1), calculix())


def _errors_of_exact(_: Model) -> Computed:
    """Compute the errors of the exact solution (full ball, closed shell) against CalculiX."""
    table = calculix()
    compressible = table["poisson"] < 0.47
    stiff = _errors(Exact(), table[~compressible])
    return {**_errors(Exact(), table[compressible]), **{f"at ν 0.49 {name}": value for name, value in stiff.items()}}


def _errors(model: Model, table: Numbers) -> dict[str, float]:
    """Compute the largest errors of a model in rows of the CalculiX table."""
    contact = model.press(_joints_of(table), force=table["force"])
    depth, pressure = (
        percent(max_relative_error(getattr(contact, name), table[name])) for name in ("indentation", "max_pressure")
    )
    angle = float(numpy.max(abs(numpy.degrees(contact.half_angle) - table["half_angle_deg"])))
    return {_DEPTH: depth, _PRESSURE: pressure, _ANGLE: angle}


def _joints_of(table: Numbers) -> Joint:
    """Create the joints of rows of the CalculiX table, as arrays."""
    return Joint(
        ball_radius=table["ball_radius"],
        clearance=table["clearance"],
        liner_thickness=table["liner_thickness"],
        liner=Material(young=1000.0, poisson=table["poisson"]),
        ball=STEEL,
    )


def calculix() -> Numbers:
    """Read the results of CalculiX: one row a load, with the columns of `data/calculix.csv` (mm, N, MPa, degrees)."""
    text = (files("ballsocket") / "data" / "calculix.csv").read_text(encoding="utf-8")
    rows = StringIO("\n".join(line for line in text.splitlines() if not line.startswith("#")))
    return numpy.genfromtxt(rows, delimiter=",", names=True, dtype=None, encoding="utf-8")


def _calculix_joints() -> tuple[Joint, Numbers]:
    """Return the joints and forces in N of CalculiX."""
    table = calculix()
    return _joints_of(table), table["force"]


_JIN_HEADS = {"22 mm head": (11.0, 10.0), "28 mm head": (14.0, 8.0), "32 mm head": (16.0, 6.0)}
"""Head radius and liner thickness in mm. Representative: the abstract does not name the pairs."""

_JIN_CLEARANCES, _JIN_FORCE = numpy.array([0.1, 0.15]), 2500.0


def _half_angles_of_jin(reference: Model) -> Computed:
    """Compute the half angles in degrees of Jin et al. 1999: 2.5 kN, 1000 MPa, ν 0.4."""
    angles = {}
    for name, (radius, thickness) in _JIN_HEADS.items():
        joints = Joint(
            ball_radius=radius, clearance=_JIN_CLEARANCES, liner_thickness=thickness, liner=UHMWPE, ball=COCR
        )
        half_angle = numpy.degrees(reference.press(joints, force=_JIN_FORCE).half_angle)
        for clearance, angle in zip(_JIN_CLEARANCES, half_angle, strict=True):
            angles[f"{name}, L {thickness:g}, c {clearance:g}, °"] = float(angle)
    return angles


def _jin_joints() -> tuple[Joint, Numbers]:
    """Return the joints and the force in N of Jin et al. 1999."""
    radii, thicknesses = (numpy.array(column)[:, None] for column in zip(*_JIN_HEADS.values(), strict=True))
    joints = Joint(ball_radius=radii, clearance=_JIN_CLEARANCES, liner_thickness=thicknesses, liner=UHMWPE, ball=COCR)
    return joints, numpy.array(_JIN_FORCE)


_PLANK = (
    ("22 mm, 5 mm thick", 11.0, 5.0),
    ("28 mm, 5 mm thick", 14.0, 5.0),
    ("28 mm, 3 mm thick", 14.0, 3.0),
    ("38 mm, 3 mm thick", 19.0, 3.0),
    ("46 mm, 3 mm thick", 23.0, 3.0),
)
_PLANK_CLEARANCE, _PLANK_FORCE = 0.1, 3000.0


def _stresses_of_plank(_: Model) -> Evaluation:
    """Compute the largest von Mises stress at the surface of conventional and crosslinked liners, with `Exact`."""
    stress = {
        (name, liner): _surface_stress(radius, thickness, liner)
        for name, radius, thickness in _PLANK
        for liner in (UHMWPE, CROSSLINKED_PE)
    }
    lower_in_crosslinked = all(stress[name, CROSSLINKED_PE] < stress[name, UHMWPE] for name, *_ in _PLANK)
    smallest_head = stress[_PLANK[0][0], UHMWPE]
    lower_under_large_heads = all(stress[name, CROSSLINKED_PE] < smallest_head for name, *_ in _PLANK[-2:])
    return Evaluation(
        {f"{name}, {liner.name}, MPa": value for (name, liner), value in stress.items()},
        lower_in_crosslinked and lower_under_large_heads,
    )


def _surface_stress(radius: float, thickness: float, liner: Material) -> float:
    """Compute the largest von Mises stress in MPa at the surface of the liner, over the contact."""
    joint = Joint(ball_radius=radius, clearance=_PLANK_CLEARANCE, liner_thickness=thickness, liner=liner, ball=COCR)
    contact = Exact().press(joint, force=_PLANK_FORCE)
    assert isinstance(contact, ElasticContact)
    angles = numpy.linspace(0.0, 0.98, 15) * float(contact.half_angle)
    return float(numpy.max(contact.stress(angle=angles, depth=0.0).von_mises))


def _plank_joints() -> tuple[Joint, Numbers]:
    """Return the joints and the force in N of Plank et al. 2007."""
    heads, thicknesses = (numpy.array(column)[:, None] for column in list(zip(*_PLANK, strict=True))[1:])
    liner = Material(young=numpy.array([UHMWPE.young, CROSSLINKED_PE.young]), poisson=UHMWPE.poisson)
    joints = Joint(ball_radius=heads, clearance=_PLANK_CLEARANCE, liner_thickness=thicknesses, liner=liner, ball=COCR)
    return joints, numpy.array(_PLANK_FORCE)


ELSEWHERE: tuple[Claim, ...] = (
    Claim(
        name="exact-agrees-with-calculix",
        source="CalculiX 2.20: half a ball on its equator, a hemispherical liner with a free rim",
        statement="Neither the rim nor the half ball matter for pressure and contact angle (ν up to 0.45).",
        quantity=_errors_of_exact,
        expected={_PRESSURE: (0.0, 0.2), _ANGLE: (0.0, 0.2)},
        tolerance=EXACTLY,
        comment="The indentation of half a ball counts its equator's own displacement; a thick liner that is nearly "
        "incompressible deforms through its rim.",
        joints=_calculix_joints,
    ),
    Claim(
        name="half-angles-of-jin",
        source=f"{SOURCES[0].authors_and_year}, abstract",
        statement="The half angle lies between 40° and 50° at 2.5 kN for all heads and cups of that time.",
        quantity=_half_angles_of_jin,
        expected=(40.0, 50.0),
        tolerance=(0.5, 5.0),
        unit="°",
        comment="Their pairs are not listed in the abstract; these are heads of 22 to 32 mm with usual liners and "
        "clearances. Half as much clearance again is 4 to 5° less.",
        joints=_jin_joints,
    ),
    Claim(
        name="ordering-of-plank",
        source=f"{SOURCES[1].authors_and_year}, abstract",
        statement="Von Mises stress at the surface is lower in crosslinked liners at every size, and in those of 3 mm "
        "under heads of 38 and 46 mm lower than in conventional ones of 5 mm under a 22 mm head.",
        quantity=_stresses_of_plank,
        expected=BY_EVALUATION,
        comment="At 3 kN, 0.1 mm of clearance, by the exact solution. The abstract names neither load nor moduli: that "
        "the softer liner has the lower stress follows from our 750 against 1000 MPa, the ordering by size does not.",
        joints=_plank_joints,
    ),
)
"""Claims of other authors."""

MESHED_ELSEWHERE: tuple[Claim, ...] = (
    Claim(
        name="elements-agree-with-calculix",
        source="CalculiX 2.20: another program's elements, another treatment of contact",
        statement="An independent finite-element program finds the same as ours: 19 joints, 127 loads.",
        quantity=_errors_of_elements,
        expected={_DEPTH: ZERO, _PRESSURE: ZERO},
        tolerance=(0.3, 1.0),
        comment="Stated of those runs: indentation to 0.06 %, force 0.1 %, peak pressure 0.05 %, half angle 0.1°, "
        "half as much again at ν 0.49.",
        joints=_calculix_joints,
    ),
)
"""Claims of other authors that need finite elements with every reference model."""

__getattr__ = renamed_names(
    __name__, {claim.identifier: f"{__package__}.{claim.identifier}" for claim in (*ELSEWHERE, *MESHED_ELSEWHERE)}
)
