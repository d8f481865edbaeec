"""What the paper says of the foundation modulus and of the kinematics (Sections 2 and 3.1)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy

from ...contact import Model
from ...core.arrays import Numbers
from ...identify.modulus import max_relative_error
from ...models.foundation import Bartel, Vessel
from ...models.modulus import bonded_layer, spherical_vessel
from .. import cases
from ..table_3 import RATIOS, refit_table_3
from .finding import SHOWN, Finding, graded, named, percent, true

_COMMON, _STIFF = cases.POISSON[:4], cases.POISSON[4:]
_WIDEST = 4.1


def unbounded_moduli(_: Model) -> Finding:
    """Both older moduli near ν 1/2."""
    ratios = {
        name: float(modulus(cases.hip(0.4999)) / modulus(cases.hip(0.499)))
        for name, modulus in (("Bartel", spherical_vessel), ("column", bonded_layer))
    }
    return Finding(
        name="unbounded-moduli",
        where="Section 3, Eqs. (14), (15)",
        sentence="The moduli of Bartel and of the constrained column grow without bound as ν comes near 1/2.",
        numbers={f"{name}: K at 0.4999 over K at 0.499": ratio for name, ratio in ratios.items()},
        comment="Ten times closer to 1/2 is ten times as stiff.",
        **true(all(9 < ratio < 11 for ratio in ratios.values())),
    )


def linear_kinematics_suffice(_: Model) -> Finding:
    """Eq. (6) against Eq. (5): the closed form with Bartel's modulus against Bartel's own model, over Table 1."""
    joints = cases.outline()[-1]
    worst = dict.fromkeys(SHOWN, 0.0)
    for clearance in (cases.CLEARANCES[0], cases.CLEARANCES[-1]):
        family = cases.with_clearance(joints, clearance)
        exact, linear = (model.press(family, force=cases.LOAD) for model in (Bartel(), Vessel()))
        for name in worst:
            off = max_relative_error(getattr(linear, name), getattr(exact, name))
            worst[name] = max(worst[name], percent(off))
    return Finding(
        name="linear-kinematics-suffice",
        where="Section 2, Eqs. (5), (6)",
        sentence="For small clearances neglecting sin²φ changes almost nothing.",
        numbers={f"{named(name)}, worst, %": value for name, value in worst.items()},
        comment="Over the joints of Table 1 at 3 kN, ν 0.4.",
        **graded(max(worst.values())),
    )


def _spread(modulus: Numbers) -> float:
    """Half of how far the values lie apart, in percent of their middle."""
    return percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))


def _over_force(reference: Model, poisson: Iterable[float], forces: Numbers) -> dict[str, float]:
    """The spread of p0/d over loads, for each ν."""
    spreads = {}
    for each in poisson:
        contact = reference.press(cases.hip(each), force=forces)
        spreads[f"ν {each:g}, ± %"] = _spread(contact.max_pressure / contact.indentation)
    return spreads


def constant_above_one_kilonewton(reference: Model) -> Finding:
    """Figure 2, left: the spread of p0/d over 1 to 3 kN, up to ν 0.45."""
    spreads = _over_force(reference, _COMMON, cases.LOADS)
    return Finding(
        name="constant-above-one-kilonewton",
        where="Section 3.1, Figure 2 left",
        sentence="The foundation modulus p0/d is constant above 1000 N, with slight deviations only at ν 0.45.",
        numbers=spreads,
        **graded(max(spreads.values())),
    )


def constant_at_0_49(reference: Model) -> Finding:
    """K over the load at ν 0.49."""
    spreads = _over_force(reference, _STIFF, cases.LOADS)
    return Finding(
        name="constant-at-0.49",
        where="Section 3.1, Figure 2 left",
        sentence="It is as constant at ν 0.49.",
        numbers=spreads,
        comment="A liner that is nearly incompressible stiffens as the contact widens: no single modulus follows that.",
        **graded(max(spreads.values())),
    )


def varies_below_one_kilonewton(reference: Model) -> Finding:
    """Figure 2, left: the spread of p0/d over 100 N to 1 kN beside that over 1 to 3 kN."""
    below = _over_force(reference, cases.POISSON, numpy.array([100.0, 200.0, 350.0, 500.0, 750.0, 1000.0]))
    above = _over_force(reference, cases.POISSON, cases.LOADS)
    return Finding(
        name="varies-below-one-kilonewton",
        where="Section 3.1, Figure 2 left",
        sentence="Only for loads above 1000 N can the modulus be taken as constant: below it varies more.",
        numbers={f"100 N to 1 kN, {name}": value for name, value in below.items()},
        **true(all(below[name] > above[name] for name in below)),
        comment=_stays_below(below, above),
    )


def _stays_below(below: dict[str, float], above: dict[str, float]) -> str:
    quiet = [name.split(",")[0] for name in below if below[name] <= above[name]]
    return f"Not at {' and '.join(quiet)}, where it varies more above." if quiet else ""


def _over_clearance(reference: Model, poisson: Iterable[float]) -> dict[str, float]:
    """The spread of the mean p0/d over the clearances, for each ν."""
    spreads = {}
    for each in poisson:
        joints = cases.joint(
            head_radius=17.9, liner_thickness=6.75, clearance=numpy.array(cases.CLEARANCES), poisson=each
        )
        contact = reference.press(joints, force=cases.LOADS[:, None])
        spreads[f"ν {each:g}, ± %"] = _spread((contact.max_pressure / contact.indentation).mean(axis=0))
    return spreads


def independent_of_clearance(reference: Model) -> Finding:
    """Figure 2, middle, up to ν 0.45."""
    spreads = _over_clearance(reference, _COMMON)
    return Finding(
        name="independent-of-clearance",
        where="Section 3.1, Figure 2 middle",
        sentence="The foundation modulus is about the same for clearances from 0.05 to 0.2 mm (ν up to 0.45).",
        numbers=spreads,
        **graded(max(spreads.values())),
    )


def independent_of_clearance_at_0_49(reference: Model) -> Finding:
    """K over the clearance at ν 0.49."""
    spreads = _over_clearance(reference, _STIFF)
    return Finding(
        name="independent-of-clearance-at-0.49",
        where="Section 3.1, Figure 2 middle",
        sentence="It is about the same at ν 0.49, too.",
        numbers=spreads,
        comment="A narrower contact, which more clearance makes, confines the liner less.",
        **graded(max(spreads.values())),
    )


def stiffer_where_confined(reference: Model) -> Finding:
    """Figure 2: K at ν 0.49 over K at ν 0.4, by clearance and thickness."""
    tight, loose, thick, thin = (
        cases.joint(head_radius=17.9, clearance=0.05, liner_thickness=6.75, poisson=numpy.array([0.4, 0.49])),
        cases.joint(head_radius=17.9, clearance=0.2, liner_thickness=6.75, poisson=numpy.array([0.4, 0.49])),
        cases.by_ratio(numpy.array([1.2, 1.2]), numpy.array([0.4, 0.49])),
        cases.by_ratio(numpy.array([7.5, 7.5]), numpy.array([0.4, 0.49])),
    )
    rise = {}
    for name, joints in (("c 0.05 mm", tight), ("c 0.2 mm", loose), ("R2/L 1.2", thick), ("R2/L 7.5", thin)):
        contact = reference.press(joints, force=cases.LOAD)
        modulus = contact.max_pressure / contact.indentation
        rise[f"K at ν 0.49 over K at 0.4, {name}"] = float(modulus[1] / modulus[0])
    by_clearance, by_thickness = list(rise.values())[:2], list(rise.values())[2:]
    return Finding(
        name="stiffer-where-confined",
        where="Section 3.1",
        sentence="High Poisson's ratios stiffen the joint most where it is confined: little clearance, thin liners.",
        numbers=rise,
        **true(by_clearance[0] > by_clearance[1] and by_thickness[1] > by_thickness[0]),
    )


def quality_of_the_fit(reference: Model) -> Finding:
    """Table 3 against the reference, for R2/L up to 4.1."""
    return _fit(reference, "quality-of-the-fit", "for liners of R2/L up to 4.1", RATIOS <= _WIDEST, "")


def quality_of_the_fit_on_thin_liners(reference: Model) -> Finding:
    """Quality of the fit for thinner liners."""
    why = "The published constants are {low:.0f} to {high:.0f} % too stiff at R2/L {thinnest:g}."
    return _fit(reference, "quality-of-the-fit-on-thin-liners", "for thinner liners", RATIOS > _WIDEST, why)


def _fit(reference: Model, name: str, which: str, chosen: Numbers, comment: str) -> Finding:
    columns = refit_table_3(reference)
    worst = {f"ν {c.poisson:g}, worst, %": percent(abs(c.difference[chosen]).max()) for c in columns}
    ends = [percent(column.difference[-1]) for column in columns]
    return Finding(
        name=name,
        where="Section 3.1, Table 3",
        sentence=f"Eq. (18) with Table 3 agrees very well with finite elements for all Poisson's ratios, {which}.",
        numbers=worst,
        comment=comment.format(low=min(ends), high=max(ends), thinnest=RATIOS[-1]),
        **graded(max(worst.values())),
    )
