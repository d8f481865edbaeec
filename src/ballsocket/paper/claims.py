"""The paper's checkable sentences, each with the number behind it and a verdict.

A claim is a function of the reference that plays the part of the paper's finite elements: `Exact()`, or
`FiniteElement()` for one with the same rim and the same half ball as theirs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy

from ..calibrate import refit_table_3
from ..models.base import Model
from ..models.foundation import Bartel, BondedLayer, HessForsbach, Vessel
from ..models.half_space import Hertz
from ..models.modulus import bonded_layer, spherical_vessel
from . import cases

Array = numpy.ndarray


class Verdict(Enum):
    """What became of a sentence."""

    HOLDS = "holds"
    NEARLY = "holds nearly"
    FAILS = "does not hold"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A claim with its number.

    Attributes
    ----------
    name : str
        Short, for links.
    where : str
        Section or figure of the paper.
    sentence : str
        What the paper says, in our own words.
    numbers : dict of str to float
        What was computed, by name with its unit.
    verdict : Verdict
    comment : str
        Why, where the verdict is not plain.
    """

    name: str
    where: str
    sentence: str
    numbers: dict[str, float]
    verdict: Verdict
    comment: str = ""

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "where": self.where,
            "sentence": self.sentence,
            "numbers": self.numbers,
            "verdict": self.verdict.value,
            "comment": self.comment,
        }


Claim = Callable[[Model], Finding]


def _graded(good: bool, nearly: bool) -> Verdict:
    return Verdict.HOLDS if good else Verdict.NEARLY if nearly else Verdict.FAILS


def _percent(share: Any) -> float:
    return 100.0 * float(share)


def overestimated_pressure(reference: Model) -> Finding:
    """Figure 4: Bartel and the bonded layer at ν 0.45."""
    joint = cases.hip(0.45)
    truth = reference.press(joint, force=cases.LOAD).max_pressure
    bartel, bonded = (
        _percent(model.press(joint, force=cases.LOAD).max_pressure / truth - 1) for model in (Bartel(), BondedLayer())
    )
    return Finding(
        name="overestimated-pressure",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 and 3 kN Bartel's model overestimates the peak pressure by 17 %, the bonded layer by 25 %.",
        numbers={"Bartel, %": bartel, "bonded layer, %": bonded},
        verdict=_graded(abs(bartel - 17) < 1 and abs(bonded - 25) < 1, abs(bartel - 17) < 3 and abs(bonded - 25) < 3),
    )


def wide_half_angle(reference: Model) -> Finding:
    """Figure 5: how much wider the closed form's contact is, over all its joints."""
    excess = []
    for series in _series().values():
        angle = reference.press(series, force=cases.LOAD).half_angle
        excess += list(100 * (HessForsbach().press(series, force=cases.LOAD).half_angle / angle - 1))
    low, high = float(min(excess)), float(max(excess))
    return Finding(
        name="wide-half-angle",
        where="Section 3.2, Figure 5",
        sentence="The closed form's half angle is 3 to 8 % larger than that of finite elements (ν 0.4, 3 kN).",
        numbers={"least, %": low, "most, %": high},
        verdict=_graded(low >= 2.5 and high <= 8.5, low >= 1.5 and high <= 10.0),
        comment="Over the ends and some middles of the three series of Figure 5.",
    )


def _series() -> dict[str, Any]:
    return {
        "clearance": cases.joint(clearance=numpy.array(cases.CLEARANCES)),
        "head_radius": cases.joint(head_radius=numpy.array(cases.HEAD_RADII)),
        "liner_thickness": cases.joint(liner_thickness=numpy.array(cases.THICKNESSES)),
    }


def constant_above_one_kilonewton(reference: Model) -> Finding:
    """Figure 2, left: the spread of p0/d over 1 to 3 kN."""
    spreads = {}
    for poisson in cases.POISSON:
        contact = reference.press(cases.hip(poisson), force=cases.LOADS)
        modulus = contact.max_pressure / contact.indentation
        spreads[f"ν {poisson:g}, ± %"] = _percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))
    below = list(spreads.values())
    return Finding(
        name="constant-above-one-kilonewton",
        where="Section 3.1, Figure 2 left",
        sentence="The foundation modulus p0/d is constant above 1000 N, with slight deviations only at ν 0.45.",
        numbers=spreads,
        verdict=_graded(max(below) < 2.0, max(below[:4]) < 3.0),
        comment="It grows with the load at every ν, and the more the less compressible the liner is.",
    )


def independent_of_clearance(reference: Model) -> Finding:
    """Figure 2, middle: the spread of the mean p0/d over the clearances."""
    spreads = {}
    for poisson in cases.POISSON:
        joints = cases.joint(
            head_radius=17.9, liner_thickness=6.75, clearance=numpy.array(cases.CLEARANCES), poisson=poisson
        )
        contact = reference.press(joints, force=cases.LOADS[:, None])
        modulus = (contact.max_pressure / contact.indentation).mean(axis=0)
        spreads[f"ν {poisson:g}, ± %"] = _percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))
    return Finding(
        name="independent-of-clearance",
        where="Section 3.1, Figure 2 middle",
        sentence="The foundation modulus is about the same for clearances from 0.05 to 0.2 mm.",
        numbers=spreads,
        verdict=_graded(max(spreads.values()) < 2.0, max(list(spreads.values())[:4]) < 3.0),
        comment="It falls with the clearance, since a narrower contact is closer to a half-space.",
    )


def quality_of_the_fit(reference: Model) -> Finding:
    """Table 3 against the reference at twelve R2/L."""
    columns = refit_table_3(reference)
    thick = {f"ν {c.poisson:g}, R2/L to 4.1, %": _percent(abs(c.difference[:8]).max()) for c in columns}
    thin = {f"ν {c.poisson:g}, R2/L to 7.7, %": _percent(abs(c.difference).max()) for c in columns}
    return Finding(
        name="quality-of-the-fit",
        where="Section 3.1, Table 3",
        sentence="Eq. (18) with Table 3 agrees very well with finite elements for all Poisson's ratios.",
        numbers={**thick, **thin},
        verdict=_graded(max(thin.values()) < 3.0, max(thick.values()) < 4.0),
        comment="Very well up to R2/L about 4; on thinner liners the published constants are 5 to 11 % too stiff.",
    )


def hertz_is_inadequate(reference: Model) -> Finding:
    """Figure 3: Hertz at 3 kN."""
    truth, hertz = (model.press(cases.hip(), force=cases.LOAD) for model in (reference, Hertz()))
    depth, pressure = (
        _percent(getattr(hertz, name) / getattr(truth, name) - 1) for name in ("indentation", "max_pressure")
    )
    return Finding(
        name="hertz-is-inadequate",
        where="Section 3.2, Figure 3",
        sentence="Hertz' theory is not adequate for this contact.",
        numbers={"indentation off by, %": depth, "peak pressure off by, %": pressure},
        verdict=_graded(abs(depth) > 20 and abs(pressure) > 20, abs(depth) > 10),
    )


def good_agreement_at_0_4(reference: Model) -> Finding:
    """Figures 3 and 5: the closed form at ν 0.4."""
    worst = {"indentation": 0.0, "max_pressure": 0.0}
    for series in (*_series().values(), cases.hip()):
        truth, ours = (model.press(series, force=cases.LOAD) for model in (reference, HessForsbach()))
        for name in worst:
            off = numpy.max(abs(getattr(ours, name) / getattr(truth, name) - 1))
            worst[name] = max(worst[name], _percent(off))
    return Finding(
        name="good-agreement-at-0.4",
        where="Section 3.2, Figures 3 and 5",
        sentence="At ν 0.4 force and pressure of the closed form agree very well with finite elements, in all cases.",
        numbers={
            "indentation at 3 kN, worst, %": worst["indentation"],
            "peak pressure, worst, %": worst["max_pressure"],
        },
        verdict=_graded(max(worst.values()) < 3, max(worst.values()) < 6),
    )


def minor_deviations_at_0_45(reference: Model) -> Finding:
    """Figure 4: the closed form at ν 0.45."""
    truth, ours = (model.press(cases.hip(0.45), force=cases.LOAD) for model in (reference, HessForsbach()))
    depth, pressure = (
        _percent(getattr(ours, name) / getattr(truth, name) - 1) for name in ("indentation", "max_pressure")
    )
    return Finding(
        name="minor-deviations-at-0.45",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 the closed form deviates from finite elements only a little.",
        numbers={"indentation, %": depth, "peak pressure, %": pressure},
        verdict=_graded(max(abs(depth), abs(pressure)) < 5, max(abs(depth), abs(pressure)) < 8),
    )


def stiffness_and_geometry(reference: Model) -> Finding:
    """Figure 5 a, c, e: which way the stiffness at 3 kN goes."""
    rise = {name: reference.press(series, force=cases.LOAD).stiffness for name, series in _series().items()}
    signs = {"clearance": -1, "head_radius": 1, "liner_thickness": -1}
    good = all(numpy.all(sign * numpy.diff(rise[name]) > 0) for name, sign in signs.items())
    return Finding(
        name="stiffness-and-geometry",
        where="Section 3.2, Figure 5 a, c, e",
        sentence="The joint gets softer with clearance, stiffer with the head's radius, stiffer with a thinner liner.",
        numbers={f"last over first of {name}": float(values[-1] / values[0]) for name, values in rise.items()},
        verdict=_graded(good, False),
    )


def clearance_and_pressure(reference: Model) -> Finding:
    """Figure 5 a, b."""
    contact = reference.press(_series()["clearance"], force=cases.LOAD)
    good = numpy.all(numpy.diff(contact.max_pressure) > 0) and numpy.all(numpy.diff(contact.half_angle) < 0)
    return Finding(
        name="clearance-and-pressure",
        where="Section 3.2, Figure 5 a, b",
        sentence="More clearance makes the contact narrower and the peak pressure higher.",
        numbers={
            "p0 at 0.2 over p0 at 0.05 mm": float(contact.max_pressure[-1] / contact.max_pressure[0]),
            "ε at 0.2 over ε at 0.05 mm": float(contact.half_angle[-1] / contact.half_angle[0]),
        },
        verdict=_graded(bool(good), False),
    )


def lowest_pressure(reference: Model) -> Finding:
    """Figure 6, left: where the peak pressure is least, within the limits of Table 1."""
    radius, thickness, contact = _map(reference)
    best = int(numpy.nanargmin(contact.max_pressure))
    return Finding(
        name="lowest-pressure",
        where="Section 3.2, Figure 6 left",
        sentence="Peak pressures are least for large heads with liners of moderate thickness.",
        numbers={
            "least p0, MPa": float(contact.max_pressure[best]),
            "at R1, mm": float(radius[best]),
            "at L, mm": float(thickness[best]),
        },
        verdict=_graded(bool(radius[best] > 18) and 3.0 < thickness[best] < 12.0, bool(radius[best] > 17)),
        comment="Within an outer radius of 26 mm, where a larger head leaves a thinner liner.",
    )


def smallest_area(reference: Model) -> Finding:
    """Figure 6, right: where the contact area is least."""
    radius, thickness, contact = _map(reference)
    best = int(numpy.nanargmin(contact.area))
    return Finding(
        name="smallest-area",
        where="Section 3.2, Figure 6 right",
        sentence="The contact area goes the other way: it is least for small heads with thin liners.",
        numbers={
            "least area, mm²": float(contact.area[best]),
            "at R1, mm": float(radius[best]),
            "at L, mm": float(thickness[best]),
        },
        verdict=_graded(bool(radius[best] < 15 and thickness[best] < 6), bool(radius[best] < 16)),
    )


def _map(reference: Model) -> tuple[Array, Array, Any]:
    radius, thickness = (grid.ravel() for grid in numpy.meshgrid(numpy.linspace(11, 23, 13), numpy.linspace(3, 15, 13)))
    outer = radius + 0.1 + thickness
    kept = (outer >= cases.OUTER_RADII[0]) & (outer <= cases.OUTER_RADII[1])
    radius, thickness = radius[kept], thickness[kept]
    return (
        radius,
        thickness,
        reference.press(cases.joint(head_radius=radius, liner_thickness=thickness), force=cases.LOAD),
    )


def usable_above_0_45(reference: Model) -> Finding:
    """Conclusion 1: ν 0.49 on liners from thick to thin."""
    joints = cases.by_ratio(numpy.array([1.0, 1.8, 2.8, 4.1, 5.8]), 0.49)
    truth, ours = (model.press(joints, force=cases.LOAD) for model in (reference, HessForsbach()))
    worst = {name: _percent(numpy.max(abs(getattr(ours, name) / getattr(truth, name) - 1))) for name in _SHOWN}
    return Finding(
        name="usable-above-0.45",
        where="Conclusions, 1",
        sentence="The closed form gives acceptable results whatever the liner's thickness, also for ν above 0.45.",
        numbers={f"{name.replace('_', ' ')} at ν 0.49, worst, %": value for name, value in worst.items()},
        verdict=_graded(max(worst.values()) < 10, max(worst.values()) < 20),
        comment="One modulus cannot follow how p0/d grows with the load there.",
    )


_SHOWN = ("indentation", "max_pressure", "half_angle")


def unbounded_moduli(_: Model) -> Finding:
    """Section 2: both older moduli near ν 1/2."""
    ratios = {
        name: float(modulus(cases.hip(0.4999)) / modulus(cases.hip(0.499)))
        for name, modulus in (("Bartel", spherical_vessel), ("column", bonded_layer))
    }
    return Finding(
        name="unbounded-moduli",
        where="Section 2, Eqs. (14), (15)",
        sentence="The moduli of Bartel and of the constrained column grow without bound as ν comes near 1/2.",
        numbers={f"{name}: K at 0.4999 over K at 0.499": ratio for name, ratio in ratios.items()},
        verdict=_graded(all(9 < ratio < 11 for ratio in ratios.values()), False),
        comment="Ten times closer to 1/2 is ten times as stiff.",
    )


def linear_kinematics_suffice(_: Model) -> Finding:
    """Eq. (6) against Eq. (5): the closed form with Bartel's modulus against Bartel's own model."""
    worst = dict.fromkeys(_SHOWN, 0.0)
    for clearance in cases.CLEARANCES:
        joint = cases.joint(head_radius=17.9, liner_thickness=6.75, clearance=clearance)
        exact, linear = (model.press(joint, force=cases.LOAD) for model in (Bartel(), Vessel()))
        for name in worst:
            worst[name] = max(worst[name], _percent(abs(getattr(linear, name) / getattr(exact, name) - 1)))
    return Finding(
        name="linear-kinematics-suffice",
        where="Section 2, Eqs. (5), (6)",
        sentence="For small clearances neglecting sin²φ changes almost nothing.",
        numbers={f"{name.replace('_', ' ')}, worst, %": value for name, value in worst.items()},
        verdict=_graded(max(worst.values()) < 1, max(worst.values()) < 2),
        comment="Clearances of 0.05 to 0.2 mm on R1 17.9 mm.",
    )


def only_the_liner_deforms(reference: Model) -> Finding:
    """Section 3.1: the steel head taken as rigid."""
    from dataclasses import replace

    rigid, steel = (
        reference.press(joint, force=cases.LOAD) for joint in (replace(cases.hip(), ball=None), cases.hip())
    )
    changes = {name: _percent(getattr(rigid, name) / getattr(steel, name) - 1) for name in _SHOWN}
    return Finding(
        name="only-the-liner-deforms",
        where="Section 3.1",
        sentence="Steel is so much stiffer than plastic that only the liner need be taken as elastic.",
        numbers={f"{name.replace('_', ' ')} of a rigid head, %": value for name, value in changes.items()},
        verdict=_graded(max(map(abs, changes.values())) < 2, max(map(abs, changes.values())) < 5),
    )


CLAIMS: tuple[Claim, ...] = (
    unbounded_moduli,
    linear_kinematics_suffice,
    only_the_liner_deforms,
    constant_above_one_kilonewton,
    independent_of_clearance,
    quality_of_the_fit,
    hertz_is_inadequate,
    good_agreement_at_0_4,
    minor_deviations_at_0_45,
    overestimated_pressure,
    wide_half_angle,
    stiffness_and_geometry,
    clearance_and_pressure,
    lowest_pressure,
    smallest_area,
    usable_above_0_45,
)
"""In the order of the paper."""


def ledger(reference: Model) -> tuple[Finding, ...]:
    """Every claim against a reference."""
    return tuple(claim(reference) for claim in CLAIMS)
