"""Tables of claims: every checkable statement of the paper in its order, and of other authors."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from math import inf

from ...core.sources import Source
from ...models.foundation import Bartel, BondedLayer, HessForsbach
from ...models.half_space import Hertz
from .. import cases
from . import quantities
from .evaluation import ACCEPTABLY, BY_EVALUATION, CONSIDERABLE, EXACTLY, STATED, ZERO, Claim, Computed, percent


def _outer_radius(numbers: Computed) -> str:
    """Format the outer radius of the joint that has the smallest value; the clearance is 0.1 mm."""
    return f"{numbers['at R1, mm'] + 0.1 + numbers['at L, mm']:.3g} mm"


def _excess_of_the_elements(numbers: Computed) -> str:
    """Explain the published overestimates of 17 % and 25 % by the peak pressure of the published elements."""
    excess = [
        percent((1 + value / 100) / published - 1)
        for value, published in zip(numbers.values(), (1.17, 1.25), strict=True)
    ]
    return f"Theirs follow from elements whose peak pressure is {min(excess):.1f} to {max(excess):.1f} % higher."


def _deviation_grows(numbers: Computed) -> bool:
    """Check that the deviation grows with ν, and is considerable at ν 0.46."""
    values = list(numbers.values())
    return all(first <= second for first, second in pairwise(values)) and values[-2] > CONSIDERABLE[0]


_DECADES = "A decade of loads is compared with a decade."
_HEADS = "Judged with the steel head of Table 2, and with the rigid head that Section 3.1 assumes."


CLAIMS: tuple[Claim, ...] = (
    Claim(
        name="linear-kinematics-suffice",
        source="Section 2, Eqs. (5), (6)",
        statement="For small clearances neglecting sin²φ changes almost nothing.",
        quantity=quantities.errors_of_linear_kinematics,
        comment="Over the joints of Table 1 at 3 kN, ν 0.4.",
    ),
    Claim(
        name="unbounded-moduli",
        source="Section 3, Eqs. (14), (15)",
        statement="The moduli of Bartel and of the constrained column grow without bound as ν comes near 1/2.",
        quantity=quantities.unbounded_moduli,
        expected=(9.0, 11.0),
        tolerance=EXACTLY,
        comment="Ten times closer to 1/2 is ten times as stiff.",
    ),
    Claim(
        name="deviations-grow-with-poisson",
        source="Section 3",
        statement="Bartel's model is somewhat stiffer than the liner, noticeably so for larger Poisson's ratios.",
        quantity=quantities.deviations_of_bartel,
        expected=_deviation_grows,
    ),
    Claim(
        name="only-the-liner-deforms",
        source="Section 3.1",
        statement="Steel is much stiffer than plastic: only the liner needs to be taken as elastic.",
        quantity=quantities.errors_of_a_rigid_ball,
    ),
    Claim(
        name="constant-above-one-kilonewton",
        source="Section 3.1, Figure 2 left",
        statement="The foundation modulus p0/d is constant above 1000 N, with slight deviations only at ν 0.45.",
        quantity=partial(quantities.variation_over_force, poisson=quantities.COMMON),
        comment=lambda numbers: f"Up to ν 0.4 it varies by ± {sorted(numbers.values())[-2]:.1g} %.",
    ),
    Claim(
        name="constant-at-0.49",
        source="Section 3.1, Figure 2 left",
        statement="It is as constant at ν 0.49.",
        quantity=partial(quantities.variation_over_force, poisson=quantities.STIFF),
        comment="A liner that is nearly incompressible stiffens as the contact widens: no single modulus follows that.",
    ),
    Claim(
        name="varies-below-one-kilonewton",
        source="Section 3.1, Figure 2 left",
        statement="Only for loads above 1000 N can the modulus be taken as constant: below it varies more (ν up to "
        "0.4).",
        quantity=partial(quantities.variations_over_decades, poisson=quantities.SOFT),
        expected=BY_EVALUATION,
        comment=_DECADES,
    ),
    Claim(
        name="varies-below-one-kilonewton-above-0.4",
        source="Section 3.1, Figure 2 left",
        statement="It varies more below 1000 N at ν 0.45 and 0.49, too.",
        quantity=partial(quantities.variations_over_decades, poisson=quantities.CONFINED),
        expected=BY_EVALUATION,
        comment=_DECADES,
    ),
    Claim(
        name="independent-of-clearance",
        source="Section 3.1, Figure 2 middle",
        statement="The foundation modulus is about the same for clearances from 0.05 to 0.2 mm (ν up to 0.45).",
        quantity=partial(quantities.variation_over_clearance, poisson=quantities.COMMON),
    ),
    Claim(
        name="independent-of-clearance-at-0.49",
        source="Section 3.1, Figure 2 middle",
        statement="It is about the same at ν 0.49, too.",
        quantity=partial(quantities.variation_over_clearance, poisson=quantities.STIFF),
        comment="A narrower contact, which more clearance makes, confines the liner less.",
    ),
    Claim(
        name="stiffer-where-confined",
        source="Section 3.1",
        statement="High Poisson's ratios stiffen the joint most where it is confined: little clearance, thin liners.",
        quantity=quantities.stiffening_by_confinement,
        expected=BY_EVALUATION,
    ),
    Claim(
        name="quality-of-the-fit",
        source="Section 3.1, Table 3",
        statement="Eq. (18) with Table 3 agrees very well with finite elements for all Poisson's ratios, for liners of "
        "R2/L up to 4.1.",
        quantity=partial(quantities.errors_of_table_3, thin=False),
        comment=_HEADS,
    ),
    Claim(
        name="quality-of-the-fit-on-thin-liners",
        source="Section 3.1, Table 3",
        statement="Eq. (18) with Table 3 agrees very well with finite elements for all Poisson's ratios, for thinner "
        "liners.",
        quantity=partial(quantities.errors_of_table_3, thin=True),
        comment=f"{_HEADS} The published constants are too stiff on the thinnest liners.",
    ),
    Claim(
        name="hertz-is-inadequate",
        source="Section 3.2, Figure 3",
        statement="Hertz' theory is not adequate for this contact.",
        quantity=lambda reference: quantities.deviations_of(Hertz(), reference, 0.4, "{} off by, %"),
        expected=lambda numbers: all(abs(value) > CONSIDERABLE[0] for value in numbers.values()),
    ),
    Claim(
        name="good-agreement-at-0.4",
        source="Section 3.2, Figures 3 and 5",
        statement="At ν 0.4 force and pressure of the closed form agree very well with finite elements, in all cases.",
        quantity=quantities.errors_at_0_4,
    ),
    Claim(
        name="older-models-acceptable-at-0.4",
        source="Section 3.2, Figure 3",
        statement="At ν 0.4 Bartel's model and the bonded layer give peak pressures slightly higher, within limits.",
        quantity=lambda reference: quantities.pressure_deviations(
            reference, {model.name: model for model in (Bartel(), BondedLayer())}, 0.4
        ),
        tolerance=ACCEPTABLY,
    ),
    Claim(
        name="minor-deviations-at-0.45",
        source="Section 3.2, Figure 4",
        statement="At ν 0.45 the closed form deviates from finite elements only a little.",
        quantity=lambda reference: quantities.deviations_of(HessForsbach(), reference, 0.45),
    ),
    Claim(
        name="overestimated-pressure",
        source="Section 3.2, Figure 4",
        statement="At ν 0.45 and 3 kN Bartel's model overestimates the peak pressure by 17 %, the bonded layer by "
        "25 %.",
        quantity=lambda reference: quantities.pressure_deviations(
            reference, {"Bartel": Bartel(), "bonded layer": BondedLayer()}, 0.45
        ),
        expected={"Bartel, %": (17.0, 17.0), "bonded layer, %": (25.0, 25.0)},
        tolerance=STATED,
        unit="% of p0",
        comment=_excess_of_the_elements,
    ),
    Claim(
        name="wide-half-angle",
        source="Section 3.2, Figure 5",
        statement="The closed form's half angle is 3 to 8 % larger than that of finite elements (ν 0.4, 3 kN).",
        quantity=quantities.excess_half_angle,
        expected=(3.0, 8.0),
        tolerance=STATED,
        unit="% of ε",
        comment="Springs do not press their neighbours down: the real pressure falls to the edge as a root, theirs "
        "as a line that goes farther, and the more so the thicker the liner.",
    ),
    Claim(
        name="stiffness-and-geometry",
        source="Section 3.2, Figure 5 a, c, e",
        statement="The joint gets softer with clearance, stiffer with the head's radius, stiffer with a thinner liner.",
        quantity=quantities.stiffness_by_geometry,
        expected=BY_EVALUATION,
    ),
    Claim(
        name="clearance-and-pressure",
        source="Section 3.2, Figure 5 a, b",
        statement="More clearance makes the contact narrower and the peak pressure higher.",
        quantity=quantities.pressure_by_clearance,
        expected=BY_EVALUATION,
    ),
    Claim(
        name="lowest-pressure",
        source="Section 3.2, Figure 6 left",
        statement="Peak pressures are least for large heads with liners of moderate thickness.",
        quantity=partial(quantities.minimum_over_table_1, quantity="max_pressure", text="least p0, MPa"),
        expected={"at R1, mm": (17.0, inf), "at L, mm": (4.0, 10.0)},
        tolerance=EXACTLY,
        comment=lambda numbers: (
            f"At an outer radius of {_outer_radius(numbers)}, where a larger head leaves a thinner liner."
        ),
    ),
    Claim(
        name="smallest-area",
        source="Section 3.2, Figure 6 right",
        statement="The contact area goes the other way: it is least for small heads with thin liners.",
        quantity=partial(quantities.minimum_over_table_1, quantity="area", text="least area, mm²"),
        expected={"at R1, mm": (0.0, 14.0), "at L, mm": (0.0, 6.0)},
        tolerance=EXACTLY,
        comment=lambda numbers: (
            f"At an outer radius of {_outer_radius(numbers)}: a small head is allowed a thin liner only as far as that "
            "limit."
        ),
    ),
    Claim(
        name="usable-above-0.45",
        source="Conclusions, 1",
        statement="The closed form gives acceptable results for liners of every thickness, also for ν above 0.45.",
        quantity=quantities.errors_above_0_45,
        tolerance=ACCEPTABLY,
        comment="Largest error of indentation, peak pressure and half angle at 1 and 3 kN, R2/L 0.8 to 7.5. Only on "
        "thin liners at ν 0.49 it is considerable: one modulus cannot follow how p0/d grows with the load.",
    ),
    Claim(
        name="older-models-err-considerably",
        source="Conclusions",
        statement="All existing models accept considerable errors under these conditions.",
        quantity=quantities.errors_of_older_models,
        expected=CONSIDERABLE,
        tolerance=EXACTLY,
        comment="These conditions are ν 0.46 and 0.49, with the joints and loads of the claim before.",
    ),
)
"""Claims of the paper."""

MESHED_CLAIMS: tuple[Claim, ...] = (
    Claim(
        name="mesh-is-fine-enough",
        source="Section 3",
        statement="With twice as many elements force, contact angle and peak pressure grow by less than 1 %.",
        quantity=quantities.changes_by_refinement,
        expected=dict.fromkeys(("force, %", "half angle, %", "peak pressure, %"), (-1.0, 1.0)),
        tolerance=EXACTLY,
        comment="Four-node elements of 0.05 mm along the contact, then of 0.0315 mm, at one indentation.",
    ),
)
"""Claims of the paper that need finite elements with every reference model."""

SOURCES = (Source("jin1999"), Source("plank2007"))
"""Sources of the numbers, besides CalculiX."""

ELSEWHERE: tuple[Claim, ...] = (
    Claim(
        name="exact-agrees-with-calculix",
        source="CalculiX 2.20: half a ball on its equator, a hemispherical liner with a free rim",
        statement="Neither the rim nor the half ball matter for pressure and contact angle (ν up to 0.45).",
        quantity=quantities.errors_of_exact,
        expected={quantities.PRESSURE: (0.0, 0.2), quantities.ANGLE: (0.0, 0.2)},
        tolerance=EXACTLY,
        comment="The indentation of half a ball counts its equator's own displacement; a thick liner that is nearly "
        "incompressible deforms through its rim.",
        joints=cases.calculix_joints,
    ),
    Claim(
        name="half-angles-of-jin",
        source=f"{SOURCES[0].authors_and_year}, abstract",
        statement="The half angle lies between 40° and 50° at 2.5 kN for all heads and cups of that time.",
        quantity=quantities.half_angles_of_jin,
        expected=(40.0, 50.0),
        tolerance=STATED,
        unit="°",
        comment="Their pairs are not listed in the abstract; these are heads of 22 to 32 mm with usual liners and "
        "clearances. Half as much clearance again is 4 to 5° less.",
        joints=cases.jin_joints,
    ),
    Claim(
        name="ordering-of-plank",
        source=f"{SOURCES[1].authors_and_year}, abstract",
        statement="Von Mises stress at the surface is lower in crosslinked liners at every size, and in those of 3 mm "
        "under heads of 38 and 46 mm lower than in conventional ones of 5 mm under a 22 mm head.",
        quantity=quantities.stresses_of_plank,
        expected=BY_EVALUATION,
        comment="At 3 kN, 0.1 mm of clearance, by the exact solution. The abstract names neither load nor moduli: that "
        "the softer liner has the lower stress follows from our 750 against 1000 MPa, the ordering by size does not.",
        joints=cases.plank_joints,
    ),
)
"""Claims of other authors."""

MESHED_ELSEWHERE: tuple[Claim, ...] = (
    Claim(
        name="elements-agree-with-calculix",
        source="CalculiX 2.20: another program's elements, another treatment of contact",
        statement="An independent finite-element program finds the same as ours: 19 joints, 127 loads.",
        quantity=quantities.errors_of_elements,
        expected={quantities.DEPTH: ZERO, quantities.PRESSURE: ZERO},
        tolerance=(0.3, 1.0),
        comment="Stated of those runs: indentation to 0.06 %, force 0.1 %, peak pressure 0.05 %, half angle 0.1°, "
        "half as much again at ν 0.49.",
        joints=cases.calculix_joints,
    ),
)
"""Claims of other authors that need finite elements with every reference model."""
