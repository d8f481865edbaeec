"""What the paper says of the foundation modulus and of the kinematics (Sections 2 and 3.1)."""

from __future__ import annotations

import numpy

from ...calibrate import refit_table_3
from ...models.base import Model
from ...models.foundation import Bartel, Vessel
from ...models.modulus import bonded_layer, spherical_vessel
from .. import cases
from .finding import SHOWN, Finding, graded, percent


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
        verdict=graded(all(9 < ratio < 11 for ratio in ratios.values()), False),
        comment="Ten times closer to 1/2 is ten times as stiff.",
    )


def linear_kinematics_suffice(_: Model) -> Finding:
    """Eq. (6) against Eq. (5): the closed form with Bartel's modulus against Bartel's own model."""
    worst = dict.fromkeys(SHOWN, 0.0)
    for clearance in cases.CLEARANCES:
        joint = cases.joint(head_radius=17.9, liner_thickness=6.75, clearance=clearance)
        exact, linear = (model.press(joint, force=cases.LOAD) for model in (Bartel(), Vessel()))
        for name in worst:
            worst[name] = max(worst[name], percent(abs(getattr(linear, name) / getattr(exact, name) - 1)))
    return Finding(
        name="linear-kinematics-suffice",
        where="Section 2, Eqs. (5), (6)",
        sentence="For small clearances neglecting sin²φ changes almost nothing.",
        numbers={f"{name.replace('_', ' ')}, worst, %": value for name, value in worst.items()},
        verdict=graded(max(worst.values()) < 1, max(worst.values()) < 2),
        comment="Clearances of 0.05 to 0.2 mm on R1 17.9 mm.",
    )


def constant_above_one_kilonewton(reference: Model) -> Finding:
    """Figure 2, left: the spread of p0/d over 1 to 3 kN."""
    spreads = {}
    for poisson in cases.POISSON:
        contact = reference.press(cases.hip(poisson), force=cases.LOADS)
        modulus = contact.max_pressure / contact.indentation
        spreads[f"ν {poisson:g}, ± %"] = percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))
    below = list(spreads.values())
    return Finding(
        name="constant-above-one-kilonewton",
        where="Section 3.1, Figure 2 left",
        sentence="The foundation modulus p0/d is constant above 1000 N, with slight deviations only at ν 0.45.",
        numbers=spreads,
        verdict=graded(max(below) < 2.0, max(below[:4]) < 3.0),
        comment="Up to ν 0.4 it hardly moves; a liner that is nearly incompressible stiffens as the contact widens.",
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
        spreads[f"ν {poisson:g}, ± %"] = percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))
    return Finding(
        name="independent-of-clearance",
        where="Section 3.1, Figure 2 middle",
        sentence="The foundation modulus is about the same for clearances from 0.05 to 0.2 mm.",
        numbers=spreads,
        verdict=graded(max(spreads.values()) < 2.0, max(list(spreads.values())[:4]) < 3.0),
        comment="At ν 0.45 and 0.49 it falls with the clearance: a narrower contact confines the liner less.",
    )


def quality_of_the_fit(reference: Model) -> Finding:
    """Table 3 against the reference at twelve R2/L."""
    columns = refit_table_3(reference)
    thick = {f"ν {c.poisson:g}, R2/L to 4.1, %": percent(abs(c.difference[:8]).max()) for c in columns}
    thin = {f"ν {c.poisson:g}, R2/L to 7.7, %": percent(abs(c.difference).max()) for c in columns}
    return Finding(
        name="quality-of-the-fit",
        where="Section 3.1, Table 3",
        sentence="Eq. (18) with Table 3 agrees very well with finite elements for all Poisson's ratios.",
        numbers={**thick, **thin},
        verdict=graded(max(thin.values()) < 3.0, max(thick.values()) < 4.0),
        comment="Very well up to R2/L about 4; on thinner liners the published constants are 5 to 11 % too stiff.",
    )
