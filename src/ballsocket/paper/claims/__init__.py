"""The paper's checkable sentences and numbers from elsewhere, each with what we find and a verdict.

A claim is a function of the reference that plays the part of the paper's finite elements: `Exact()`, or
`FiniteElement()`, which has the same rim and the same half ball as theirs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ...contact import Model
from . import agreement, design, elsewhere, modulus
from .finding import Claim, Finding, Verdict

CLAIMS: tuple[Claim, ...] = (
    modulus.linear_kinematics_suffice,
    modulus.unbounded_moduli,
    agreement.deviations_grow_with_poisson,
    agreement.only_the_liner_deforms,
    modulus.constant_above_one_kilonewton,
    modulus.constant_at_0_49,
    modulus.varies_below_one_kilonewton,
    modulus.independent_of_clearance,
    modulus.independent_of_clearance_at_0_49,
    modulus.stiffer_where_confined,
    modulus.quality_of_the_fit,
    modulus.quality_of_the_fit_on_thin_liners,
    agreement.hertz_is_inadequate,
    agreement.good_agreement_at_0_4,
    agreement.older_models_acceptable_at_0_4,
    agreement.minor_deviations_at_0_45,
    agreement.overestimated_pressure,
    agreement.wide_half_angle,
    design.stiffness_and_geometry,
    design.clearance_and_pressure,
    design.lowest_pressure,
    design.smallest_area,
    agreement.usable_above_0_45,
    agreement.older_models_err_considerably,
)
"""Claims of the paper, in its order."""

ELSEWHERE: tuple[Claim, ...] = (
    elsewhere.exact_agrees_with_calculix,
    elsewhere.half_angles_of_jin,
    elsewhere.ordering_of_plank,
)
"""Claims of others."""

MESHED_CLAIMS: tuple[Claim, ...] = (agreement.mesh_is_fine_enough,)
MESHED_ELSEWHERE: tuple[Claim, ...] = (elsewhere.elements_agree_with_calculix,)
"""Claims that need finite elements whatever the reference: seconds."""


def judged(claim: Claim, reference: Model) -> Finding:
    """The finding, with the function that made it."""
    return replace(claim(reference), code=f"{claim.__module__}.{claim.__name__}")


def ledger(reference: Model, claims: Iterable[Claim] = CLAIMS) -> tuple[Finding, ...]:
    """Every claim against a reference."""
    return tuple(judged(claim, reference) for claim in claims)


__all__ = [
    "CLAIMS",
    "ELSEWHERE",
    "MESHED_CLAIMS",
    "MESHED_ELSEWHERE",
    "Claim",
    "Finding",
    "Verdict",
    "judged",
    "ledger",
]
