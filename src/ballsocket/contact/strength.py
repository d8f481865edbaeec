"""How near a contact is to what its materials bear, and where linear elasticity ends."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, reduce
from importlib.resources import files
from math import inf, nan, radians
from typing import Any

import numpy

from ..core.arrays import Array, all_true, clip, isfinite, logical_not, sin, to_numpy, where
from ..core.quantities import LINEARITY, STRENGTH
from ..core.validity import RIGID_BACKING, Range, is_missing
from ..problem import Joint, Material, larger

MAX_ELASTIC_UTILISATION = 1.38
"""The utilisation up to which a linear answer holds.

A ball on an elastic, perfectly plastic flat keeps to Hertz' force up to 1.9 times the indentation at which its inside
begins to yield (Jackson & Green 2005, doi 10.1115/1.1866166); the stress is then sqrt(1.9) times as large.
"""

FIT_EXPONENTS = tuple((i, j, k) for i in range(4) for j in range(4 - i) for k in range(4 - i - j))
"""Of the places, in the terms of the share."""

_THIN, _MASSIVE = 0.05, 1.5
"""Shares of a thin liner that hardly changes its volume, and of a massive socket whose whole bore is pressed alike."""

_OFF, _LEAST = 0.2, 0.08
"""How far the share may be off: relative, and besides."""

_WIDEST = radians(85.0)

_SAFE_STRAIN = 5e-4
"""Strain of a ball without a yield stress above which a note appears; annealed aluminium, 35 MPa over 70 GPa."""

_BALL_UNCHECKED = "strength of the ball not checked: it has no yield stress, and its stress is above 0.05 % of its E"


def fit_variables(half_angle: Array, poisson: Array, thickness_ratio: Array) -> tuple[Array, Array, Array]:
    """What the share is a polynomial of: sin(ε/2), a/(L + a) with a = R2 sin ε, and ν."""
    angle = clip(half_angle, 0.0, _WIDEST)
    width = thickness_ratio * sin(angle)
    return sin(angle / 2), width / (1 + width), clip(poisson, 0.0, 0.5)


@cache
def _terms() -> tuple[tuple[float, int, int, int], ...]:
    table = tomllib.loads((files("ballsocket") / "data" / "von_mises.toml").read_text(encoding="utf-8"))
    return tuple((number, *powers) for number, *powers in table["terms"])


def von_mises_ratio(half_angle: Array, poisson: Array, thickness_ratio: Array) -> Array:
    """Largest von Mises stress in a liner on a rigid backing over the largest pressure: a fit to the exact answer.

    Within 20 % of it, or 0.08 of the pressure where that is more; typically 6 %.
    """
    x, y, nu = fit_variables(half_angle, poisson, thickness_ratio)
    return clip(sum(number * x**i * y**j * nu**k for number, i, j, k in _terms()), _THIN, _MASSIVE)


def ball_stress_ratio(poisson: Array) -> Array:
    """Share of the pressure in a ball, as in a half-space under Hertz' (Johnson 1985, section 4.2), within 2 %."""
    # 1.5/(1 + z²) - (1 + ν)(1 - z atan(1/z)) on the axis, at the depth z = 0.48 a
    return 1.2191 - 0.4608 * (1 + poisson)


def von_mises_bounds(contact: Any, von_mises: Array) -> tuple[Array, Array]:
    """Least and most that the largest von Mises stress in the liner may be where the share says `von_mises`."""
    rigid, floor = contact.joint.backing_ratio <= RIGID_BACKING.high, _LEAST * contact.max_pressure
    least = where(rigid, (1 - _OFF) * von_mises - floor, 0.0 * von_mises)
    return least, where(rigid, (1 + _OFF) * von_mises + floor, inf + von_mises)


def utilisation(joint: Joint, von_mises: Array, pressure: Array) -> Array:
    """Von Mises stress over yield stress of liner or ball, whichever is more, for so much of it in the liner."""
    shares = ((joint.liner, von_mises, 1.0), (joint.ball, pressure, joint_ball_stress_ratio(joint)))
    ratios = [
        stress * share / material.yield_stress
        for material, stress, share in shares
        if material is not None and material.yield_stress is not None
    ]
    return reduce(larger, ratios) if ratios else nan * von_mises  # which may be infinite


def joint_ball_stress_ratio(joint: Joint) -> Array:
    """Largest von Mises stress in the ball over the largest pressure; of a rigid ball 0."""
    return 0.0 if joint.ball is None else ball_stress_ratio(joint.ball.poisson)


@dataclass(frozen=True, kw_only=True)
class ElasticLimit(Range):
    """The utilisations at which a linear answer holds; it does where no yield stress is known."""

    quantity: str | Callable[[Any], Array] = "utilisation"
    high: float = MAX_ELASTIC_UTILISATION
    why: str = "the material flows, and linear elasticity ends"

    def holds(self, contact: Any) -> Array:
        """Inside the range; what takes long to know is only asked for where an estimate leaves it open."""
        least, most = contact.utilisation_bounds
        open_ = (most > self.high) & logical_not(least > self.high)
        if all_true(logical_not(open_)) is not False:
            return logical_not(least > self.high)
        return logical_not(where(open_, contact.utilisation_at(open_), least) > self.high)


def unchecked_strength_reason(joint: Joint) -> str:
    """Return the reason for an unchecked strength of the liner; empty where it has a yield stress."""
    liner, ball = joint.liner, joint.ball
    if liner.yield_stress is not None:
        return ""
    checked = "yield" if liner.strengths else "strength"
    rest = "" if ball is None or ball.yield_stress is None else "; the utilisation is that of the ball alone"
    return f"{checked} not checked: the liner has no yield stress{rest}"


def remarks(contact: Any) -> Iterator[tuple[Array, str]]:
    """Yield masks of points below a limit of a material, each with the note for the other points."""
    joint, pressure = contact.joint, contact.max_pressure
    if joint.liner.proportional_limit is not None:
        yield from _nonlinear("liner", joint.liner, _estimate(contact))
    if joint.liner.strengths:
        yield from _told("liner", joint.liner, contact.von_mises_bounds[1], lambda: contact.von_mises, pressure)
    if joint.ball is not None:
        stress = joint_ball_stress_ratio(joint) * pressure
        if joint.ball.proportional_limit is not None:
            yield from _nonlinear("ball", joint.ball, stress)
        yield from _told("ball", joint.ball, stress, lambda: stress, pressure)
        if not joint.ball.strengths:
            yield logical_not(stress > _SAFE_STRAIN * joint.ball.young), _BALL_UNCHECKED


def _estimate(contact: Any) -> Array:
    """Estimate the largest von Mises stress in the liner; compute it only where no estimate exists."""
    least, most = contact.von_mises_bounds
    middle = (least + most) / 2
    return middle if all_true(isfinite(middle) | is_missing(contact.status)) is not False else contact.von_mises


def _told(
    part: str, material: Material, most: Array, von_mises: Callable[[], Array], pressure: Array
) -> Iterator[tuple[Array, str]]:
    """Remarks on one material, whose von Mises stress is `most` at most."""
    for name, strength in material.strengths.items():
        by_pressure = name == "allowable_pressure"
        if all_true(logical_not((pressure if by_pressure else most) > strength)):
            continue
        ratio = (pressure if by_pressure else von_mises()) / strength
        what = "pressure" if by_pressure else "von Mises stress"
        beyond = f": a linear answer holds up to {MAX_ELASTIC_UTILISATION:g} times" if name == "yield_stress" else ""
        yield logical_not(ratio > 1), f"{what} {_times(ratio)} the {STRENGTH[name].title} of the {part}{beyond}"


def _nonlinear(part: str, material: Material, stress: Array) -> Iterator[tuple[Array, str]]:
    """Compare with the proportional limit; points beyond the yield stress have another note."""
    limit: Array = material.proportional_limit
    yields = material.yield_stress
    good = logical_not(stress > limit) if yields is None else logical_not((stress > limit) & (stress <= yields))
    if all_true(good) is not False:
        return
    times = _times(where(good, nan, stress / limit))
    title = LINEARITY["proportional_limit"].title
    yield good, f"estimated von Mises stress {times} the {title} of the {part}: {_SOFTER}"


_SOFTER = "its secant modulus is below E, so d and ε are larger and pmax is smaller"


def _times(ratio: Array) -> str:
    listed = to_numpy(ratio)
    digits = f"{numpy.nanmax(listed, initial=0.0):.2g}"
    largest = f"{'1.0' if digits == '1' else digits} times"
    return largest if listed.size == 1 else f"up to {largest}"
