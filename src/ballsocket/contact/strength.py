"""Stresses of a contact relative to the strength of its materials, and the limit of linear elasticity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import reduce
from math import inf, nan, radians
from typing import Any

import numpy

from ..core.arrays import Array, all_true, clip, exp, logical_not, sqrt, to_numpy, where
from ..core.bounded import Bounded
from ..core.quantities import LINEARITY, STRENGTH
from ..core.validity import RIGID_BACKING, Range
from ..problem import Joint, Material, elementwise_maximum
from ..problem.cup import DEFAULT_CUP, UP
from .closed_sphere import max_hemisphere_change
from .coordinates import LIMIT
from .stress_ratio import MAX_THICKNESS_RATIO, POISSON

MAX_ELASTIC_UTILISATION = 1.3
"""Largest utilisation for which a linear result is valid.

At equal force yielding then lowers the largest pressure by at most 5 %, and changes indentation by 1 % and area by 2 %
(16 random liners by finite elements: R2/L 1.5 to 7, ν 0.31 to 0.47, tangent modulus 0 to E/10).
"""

TABLE_ERROR = 0.005
"""Relative error of the tabulated ratio of von Mises stress to pressure, for a rigid ball on a rigid backing."""

_RIM_ERRORS, _RIM_REACH = (0.04, 0.35), 0.9
"""Errors below and above at the rim, for ν of 0.5, and the arc over the thickness that leaves 37 % of them."""

_CUT_ERROR = 0.5  # relative error below the axial stress where the contact reaches the rim

_HEMISPHERE_SAFETY = 1.5  # factor on the estimated change on a hemisphere
_NEARLY_HEMISPHERE = radians(80.0)  # angle between load and rim from which a cup counts as a hemisphere

_AUXETIC_ERROR, _INCOMPRESSIBLE_ERROR, _THIN_ERROR = 1.2, 0.2, 0.15
"""Errors beyond the table: over -ν below 0, for ν above 0.4993, for R2/L above 20.5."""

_WIDE_ERROR, _WIDEST, _WIDEST_ERROR = 0.015, radians(88.0), 0.3
"""Errors for ε above 85°, by finite elements of 40 deep cups (ν 0.31 to 0.48), and, not measured, above 88°."""

_BALL_ERRORS = (0.02, 0.05, 0.01)
"""Errors by an elastic ball: over E/E_ball (R2/L)^1.5/sqrt(1 - 2ν), at most over R2/L; over E/E_ball up to 1."""

_BACKING_ERROR = 0.5  # error by an elastic backing over the ratio E/E_backing of a backing that counts as rigid

_SAFE_STRAIN = 5e-4
"""Largest elastic strain of a ball without a yield stress; above it a note appears (annealed aluminium)."""

_BALL_UNCHECKED = "strength of the ball not checked: it has no yield stress, and its stress is above 0.05 % of its E"


def von_mises_error(contact: Any) -> Array:
    """Compute the relative error of the ratio of largest von Mises stress to largest pressure in the liner.

    It is `TABLE_ERROR` within the table, larger beyond it and for a soft ball on a thin liner that is nearly
    incompressible, and infinite for an elastic backing.
    """
    joint = contact.joint
    nu, ratio, softness = joint.liner.poisson, joint.thickness_ratio, joint.modulus_ratio
    growth, most, massive = _BALL_ERRORS
    ball = growth * softness * ratio**1.5 / sqrt(1 - 2 * clip(nu, *POISSON))
    ball = where(ball < most * ratio, ball, most * ratio)
    stiff = TABLE_ERROR + massive * clip(softness, 0.0, 1.0) + 0.0 * contact.half_angle
    error = elementwise_maximum(stiff, ball)
    for is_beyond, extra in (
        (nu < POISSON[0], -_AUXETIC_ERROR * nu),
        (nu > POISSON[1], _INCOMPRESSIBLE_ERROR),
        (ratio > MAX_THICKNESS_RATIO, _THIN_ERROR),
        (contact.half_angle > LIMIT, _WIDE_ERROR),
        (contact.half_angle > _WIDEST, _WIDEST_ERROR),
    ):
        error = error + where(is_beyond, extra, 0.0 * error)
    backing = where(joint.backing_ratio <= RIGID_BACKING.high, _BACKING_ERROR * joint.backing_ratio, inf)
    return error + backing


def ball_stress_ratio(poisson: Array) -> Array:
    """Compute the ratio of largest von Mises stress to largest pressure in a ball with a Poisson's ratio.

    The error is at most 2 %.

    The ball is a half-space under the pressure of Hertz (Johnson 1985, section 4.2).
    """
    # 1.5/(1 + z²) - (1 + ν)(1 - z atan(1/z)) on the axis, at the depth z = 0.48 a
    return 1.2191 - 0.4608 * (1 + poisson)


def bounded_von_mises(contact: Any, von_mises: Array) -> Bounded:
    """Return the largest von Mises stress in the liner in MPa, from the table, with its bounds."""
    error = von_mises_error(contact)
    known = error < inf
    high = where(known, (1 + where(known, error, 0.0)) * von_mises, inf + 0.0 * von_mises)
    return Bounded(von_mises, clip(1 - error, 0.0, 1.0) * von_mises, high)


WORN_ERRORS = 0.85, 0.5
"""Relative errors, below and above, of the stress of the axial contact in a bore that is not a sphere.

Pressure of `Sphere` in 69 oval, wavy and worn bores loads the finite elements of the cup: the stress is up to 37 %
larger, where a deep worn part is pressed all over, and down to 82 % smaller at a narrow peak of pressure.
"""


def rim_errors(joint: Joint, edge_distance: Array) -> tuple[Array, Array]:
    """Compute the relative errors, below and above, of the stress of the axial contact near the rim of a cup.

    `edge_distance` is the arc in mm from the edge of the contact to the rim.

    Finite elements of 235 axial and 332 tilted contacts have 99 % of the stresses within. A contact that reaches the
    rim has up to twice the stress, so no bound above, and down to half of it. A quarter of the thickness around the
    corners of the rim is omitted, where the stress is unbounded.
    """
    L, R2, (low, high) = joint.liner_thickness, joint.socket_radius, _RIM_ERRORS
    near = exp(-edge_distance / (_RIM_REACH * where(L < R2, L, R2)))
    above = high * (2 * clip(joint.liner.poisson, 0.0, 0.5)) ** 8 * near
    is_inside = edge_distance > 0
    return where(is_inside, TABLE_ERROR + low * near, _CUT_ERROR), where(is_inside, TABLE_ERROR + above, inf)


def free_rim_error(contact: Any) -> Array:
    """Bound the relative increase of the largest von Mises stress by a free rim, for a model of a closed sphere.

    Finite elements of 120 hemispheres (ν 0.3 to 0.49, R2/L 1 to 10, ε 15° to 72°) exceed it by at most 0.1 %; it is
    0.2 % too large in the median, and 1.2 % for one of ten. Their largest pressure increases by at most half of it.
    """
    model, joint = contact.model, contact.joint
    if not model.is_closed_sphere:
        return 0.0
    # of `RimLimited`, which knows the load in its cup
    cup, direction = (model.cup, model.direction) if hasattr(model, "direction") else (DEFAULT_CUP, UP)
    reach = cup.rim - cup.tilt(direction)
    near_rim = rim_errors(joint, (reach - contact.half_angle) * joint.socket_radius)[1] - TABLE_ERROR
    hemisphere = _HEMISPHERE_SAFETY * max_hemisphere_change(contact)
    return where((hemisphere < near_rim) & (reach >= _NEARLY_HEMISPHERE), hemisphere, near_rim)


def utilisation(joint: Joint, von_mises: Array, pressure: Array) -> Array:
    """Compute the ratio of largest von Mises stress to yield stress, for liner or ball, whichever is larger.

    It takes the largest von Mises stress in the liner and the largest pressure, in MPa. The ratio is NaN if neither
    material has a yield stress.
    """
    stressed_parts = ((joint.liner, von_mises, 1.0), (joint.ball, pressure, joint_ball_stress_ratio(joint)))
    ratios = [
        stress * stress_ratio / material.yield_stress
        for material, stress, stress_ratio in stressed_parts
        if material is not None and material.yield_stress is not None
    ]
    return reduce(elementwise_maximum, ratios) if ratios else nan * von_mises  # von_mises may be infinite


def joint_ball_stress_ratio(joint: Joint) -> Array:
    """Compute the ratio of largest von Mises stress in the ball to largest pressure; 0 for a rigid ball."""
    return 0.0 if joint.ball is None else ball_stress_ratio(joint.ball.poisson)


@dataclass(frozen=True, kw_only=True)
class ElasticLimit(Range):
    """Range of the von Mises stress over the yield stress, if there is one, in which linear elasticity is valid."""

    quantity: str | Callable[[Any], Array] = "utilisation"
    high: float = MAX_ELASTIC_UTILISATION
    why: str = "the material yields, so that linear elasticity is invalid"

    def holds(self, contact: Any) -> Array:
        """Return a mask of the contacts whose ratio of von Mises to yield stress is below the limit.

        The stresses are solved for only where their bounds do not decide.
        """
        stress, pressure = contact.quick_von_mises, contact.max_pressure
        low, high = (utilisation(contact.joint, end, pressure) for end in (stress.low, stress.high))
        undecided = (high > self.high) & logical_not(low > self.high)
        if all_true(logical_not(undecided)) is not False:
            return logical_not(low > self.high)
        return logical_not(where(undecided, contact.utilisation_at(undecided), low) > self.high)


def unchecked_strength_reason(joint: Joint) -> str:
    """Explain why the strength of the liner is not checked; empty if the liner has a yield stress."""
    liner, ball = joint.liner, joint.ball
    if liner.yield_stress is not None:
        return ""
    missing_check = "yield" if liner.strengths else "strength"
    ball_note = "" if ball is None or ball.yield_stress is None else "; the utilisation is that of the ball alone"
    return f"{missing_check} not checked: the liner has no yield stress, give yield_stress in its table{ball_note}"


def strength_remarks(contact: Any) -> Iterator[tuple[Array, str]]:
    """Yield a mask and a note for each strength limit; the note applies to points where the mask is false."""
    joint, pressure = contact.joint, contact.max_pressure
    if joint.liner.proportional_limit is not None and not contact.yields:
        bar = contact.quick_von_mises
        name = "estimated von Mises stress" if bar.is_estimate else "von Mises stress"
        yield from _linearity_remarks("liner", joint.liner, bar.value, name)
    if joint.liner.strengths:
        elastic = replace(joint.liner, yield_stress=None) if contact.yields else joint.liner
        yield from _exceeded_strength_remarks(
            "liner", elastic, contact.quick_von_mises.high, lambda: contact.von_mises, pressure
        )
    if joint.ball is not None:
        stress = joint_ball_stress_ratio(joint) * pressure
        if joint.ball.proportional_limit is not None:
            yield from _linearity_remarks("ball", joint.ball, stress)
        yield from _exceeded_strength_remarks("ball", joint.ball, stress, lambda: stress, pressure)
        if not joint.ball.strengths:
            yield logical_not(stress > _SAFE_STRAIN * joint.ball.young), _BALL_UNCHECKED


def _exceeded_strength_remarks(
    body: str, material: Material, upper_bound: Array, von_mises: Callable[[], Array], pressure: Array
) -> Iterator[tuple[Array, str]]:
    """Yield acceptable points and a note for each exceeded strength; von Mises stresses are at most `upper_bound`."""
    for name, strength in material.strengths.items():
        is_pressure_limit = name == "allowable_pressure"
        if all_true(logical_not((pressure if is_pressure_limit else upper_bound) > strength)):
            continue
        ratio = (pressure if is_pressure_limit else von_mises()) / strength
        stress = "pressure" if is_pressure_limit else "von Mises stress"
        limit = (
            f": results are valid up to {MAX_ELASTIC_UTILISATION:g} times this stress" if name == "yield_stress" else ""
        )
        yield (
            logical_not(ratio > 1),
            f"{stress} {_stress_ratio_text(ratio)} the {STRENGTH[name].title} of the {body}{limit}",
        )


def _linearity_remarks(
    body: str, material: Material, stress: Array, name: str = "von Mises stress"
) -> Iterator[tuple[Array, str]]:
    """Yield a mask and a note for stresses above the proportional limit and up to the yield stress."""
    limit: Array = material.proportional_limit
    yield_stress = material.yield_stress
    linear = (
        logical_not(stress > limit)
        if yield_stress is None
        else logical_not((stress > limit) & (stress <= yield_stress))
    )
    if all_true(linear) is not False:
        return
    ratio_text = _stress_ratio_text(where(linear, nan, stress / limit))
    title = LINEARITY["proportional_limit"].title
    yield linear, f"{name} {ratio_text} the {title} of the {body}: {_SOFTER}"


_SOFTER = "its secant modulus is below E, so d and ε are larger and pmax is smaller"


def _stress_ratio_text(ratio: Array) -> str:
    """Format a ratio of stress to strength, such as "2.5 times"; "up to 2.5 times" for an array."""
    ratios = to_numpy(ratio)
    digits_text = f"{numpy.nanmax(ratios, initial=0.0):.2g}"
    largest = f"{'1.0' if digits_text == '1' else digits_text} times"
    return largest if ratios.size == 1 else f"up to {largest}"
