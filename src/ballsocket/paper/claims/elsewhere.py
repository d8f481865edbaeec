"""Numbers that others found, by other programs or in the laboratory."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from io import StringIO

import numpy

from ...contact import Model
from ...core.arrays import Numbers
from ...core.sources import Source
from ...elasticity.exact.contact import ElasticContact
from ...elasticity.exact.model import Exact
from ...elasticity.finite_elements.model import FiniteElement
from ...identify.modulus import max_relative_error
from ...problem import Joint, Material
from ...problem.presets import COCR, CROSSLINKED_PE, STEEL, UHMWPE
from .finding import SHOWN, Finding, graded, percent, true

SOURCES = (Source("jin1999"), Source("plank2007"))
"""Whose numbers these are, besides CalculiX'."""


def elements_agree_with_calculix(_: Model) -> Finding:
    """Nineteen joints under five to nine loads each, by CalculiX and by our elements, both with a free rim."""
    numbers = _against_calculix(FiniteElement(meshes=1), calculix())
    depth, pressure = list(numbers.values())[:2]
    return Finding(
        name="elements-agree-with-calculix",
        where="CalculiX 2.20: another program's elements, another treatment of contact",
        sentence="An independent finite-element program finds the same as ours: 19 joints, 127 loads.",
        numbers=numbers,
        comment="Stated of those runs: indentation to 0.06 %, force 0.1 %, peak pressure 0.05 %, half angle 0.1°, "
        "half as much again at ν 0.49.",
        **graded(max(depth, pressure), close=0.3, wide=1.0),
    )


def exact_agrees_with_calculix(_: Model) -> Finding:
    """CalculiX' joints by the exact solution, whose ball is whole and whose liner is a closed shell."""
    table = calculix()
    compressible = table["poisson"] < 0.47
    numbers = _against_calculix(Exact(), table[compressible])
    pressure, angle = list(numbers.values())[1:]
    softer = {f"at ν 0.49 {name}": value for name, value in _against_calculix(Exact(), table[~compressible]).items()}
    return Finding(
        name="exact-agrees-with-calculix",
        where="CalculiX 2.20: half a ball on its equator, a hemispherical liner with a free rim",
        sentence="Neither the rim nor the half ball matter for pressure and contact angle (ν up to 0.45).",
        numbers={**numbers, **softer},
        **true(pressure < 0.2 and angle < 0.2),
        comment="The indentation of half a ball counts its equator's own displacement; a thick liner that is nearly "
        "incompressible gives way through its rim.",
    )


def _against_calculix(model: Model, table: Numbers) -> dict[str, float]:
    ours = model.press(_joints_of(table), force=table["force"])
    depth, pressure = (percent(max_relative_error(getattr(ours, name), table[name])) for name in SHOWN[:2])
    angle = float(numpy.max(abs(numpy.degrees(ours.half_angle) - table["half_angle_deg"])))
    return {"indentation off by, %": depth, "peak pressure off by, %": pressure, "half angle off by, °": angle}


def _joints_of(table: Numbers) -> Joint:
    return Joint(
        ball_radius=table["ball_radius"],
        clearance=table["clearance"],
        liner_thickness=table["liner_thickness"],
        liner=Material(young=1000.0, poisson=table["poisson"]),
        ball=STEEL,
    )


def calculix() -> Numbers:
    """CalculiX' answers, a row a load, with the columns of `data/calculix.csv` (mm, N, MPa, degrees)."""
    text = (files("ballsocket") / "data" / "calculix.csv").read_text(encoding="utf-8")
    rows = StringIO("\n".join(line for line in text.splitlines() if not line.startswith("#")))
    return numpy.genfromtxt(rows, delimiter=",", names=True, dtype=None, encoding="utf-8")


_JIN_HEADS = {"22 mm head": (11.0, 10.0), "28 mm head": (14.0, 8.0), "32 mm head": (16.0, 6.0)}
"""Head radius and liner thickness in mm. Representative: the abstract does not name the pairs."""

_JIN_CLEARANCES, _JIN_FORCE = numpy.array([0.1, 0.15]), 2500.0


def half_angles_of_jin(reference: Model) -> Finding:
    """Jin et al. 1999: 2.5 kN, 1000 MPa, ν 0.4; measured contact areas agreed with their finite elements."""
    angles = {}
    for name, (radius, thickness) in _JIN_HEADS.items():
        joints = Joint(
            ball_radius=radius, clearance=_JIN_CLEARANCES, liner_thickness=thickness, liner=UHMWPE, ball=COCR
        )
        half_angle = numpy.degrees(reference.press(joints, force=_JIN_FORCE).half_angle)
        for clearance, angle in zip(_JIN_CLEARANCES, half_angle, strict=True):
            angles[f"{name}, L {thickness:g}, c {clearance:g}, °"] = float(angle)
    low, high = min(angles.values()), max(angles.values())
    return Finding(
        name="half-angles-of-jin",
        where=f"{SOURCES[0].authors_and_year}, abstract",
        sentence="The half angle lies between 40° and 50° at 2.5 kN for all heads and cups of that time.",
        numbers=angles,
        unit="°",
        comment="Their pairs are not listed in the abstract; these are heads of 22 to 32 mm with usual liners and "
        "clearances. Half as much clearance again is 4 to 5° less.",
        **graded(max(40 - low, high - 50, 0.0), close=0.5),
    )


_PLANK = (
    ("22 mm, 5 mm thick", 11.0, 5.0),
    ("28 mm, 5 mm thick", 14.0, 5.0),
    ("28 mm, 3 mm thick", 14.0, 3.0),
    ("38 mm, 3 mm thick", 19.0, 3.0),
    ("46 mm, 3 mm thick", 23.0, 3.0),
)
_PLANK_CLEARANCE, _PLANK_FORCE = 0.1, 3000.0


def ordering_of_plank(_: Model) -> Finding:
    """Plank et al. 2007: von Mises stress at the surface of conventional and crosslinked liners, by `Exact`."""
    stress = {
        (name, liner): _surface_stress(radius, thickness, liner)
        for name, radius, thickness in _PLANK
        for liner in (UHMWPE, CROSSLINKED_PE)
    }
    softer = all(stress[name, CROSSLINKED_PE] < stress[name, UHMWPE] for name, *_ in _PLANK)
    small = stress[_PLANK[0][0], UHMWPE]
    large = all(stress[name, CROSSLINKED_PE] < small for name, *_ in _PLANK[-2:])
    return Finding(
        name="ordering-of-plank",
        where=f"{SOURCES[1].authors_and_year}, abstract",
        sentence="Von Mises stress at the surface is lower in crosslinked liners at every size, and in those of 3 mm "
        "under heads of 38 and 46 mm lower than in conventional ones of 5 mm under a 22 mm head.",
        numbers={f"{name}, {liner.name}, MPa": value for (name, liner), value in stress.items()},
        comment="At 3 kN, 0.1 mm of clearance, by the exact solution. The abstract names neither load nor moduli: that "
        "the softer liner has the lower stress follows from our 750 against 1000 MPa, the ordering by size does not.",
        **true(softer and large),
    )


def pressed() -> Mapping[str, tuple[Joint, Numbers]]:
    """The joints and forces in N behind each of these claims, by its name, as arrays."""
    table = calculix()
    elements = _joints_of(table), table["force"]
    radii, thicknesses = (numpy.array(each)[:, None] for each in zip(*_JIN_HEADS.values(), strict=True))
    jin = Joint(ball_radius=radii, clearance=_JIN_CLEARANCES, liner_thickness=thicknesses, liner=UHMWPE, ball=COCR)
    heads, liners = (numpy.array(each)[:, None] for each in list(zip(*_PLANK, strict=True))[1:])
    both = numpy.array([UHMWPE.young, CROSSLINKED_PE.young])
    liner = Material(young=both, poisson=UHMWPE.poisson)
    plank = Joint(ball_radius=heads, clearance=_PLANK_CLEARANCE, liner_thickness=liners, liner=liner, ball=COCR)
    return {
        elements_agree_with_calculix.__name__: elements,
        exact_agrees_with_calculix.__name__: elements,
        half_angles_of_jin.__name__: (jin, numpy.array(_JIN_FORCE)),
        ordering_of_plank.__name__: (plank, numpy.array(_PLANK_FORCE)),
    }


def _surface_stress(radius: float, thickness: float, liner: Material) -> float:
    """The largest von Mises stress in MPa at the surface of the liner, over the contact."""
    joint = Joint(ball_radius=radius, clearance=_PLANK_CLEARANCE, liner_thickness=thickness, liner=liner, ball=COCR)
    contact = Exact().press(joint, force=_PLANK_FORCE)
    assert isinstance(contact, ElasticContact)
    angles = numpy.linspace(0.0, 0.98, 15) * float(contact.half_angle)
    return float(numpy.max(contact.stress(angle=angles, depth=0.0).von_mises))
