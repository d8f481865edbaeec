"""Friction of the ball in its socket: a force at the pole of the contact and a moment that brakes the spin."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..arrays import Array, exp, sqrt
from ..checks import one_number, require


class Coulomb:
    """A coefficient of sliding, and one of a ball that hardly moves where that differs."""

    coefficient: float
    static_coefficient: float | None

    @property
    def static(self) -> float:
        """The coefficient of a ball that hardly moves."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient

    def check_static(self) -> None:
        """Raise ValueError for a static coefficient that is below that of sliding."""
        if self.static_coefficient is not None:
            checked(self, "static_coefficient", self.coefficient, "static friction is not below that of sliding")


@dataclass(frozen=True, kw_only=True)
class Friction(Coulomb):
    """Regularised Coulomb friction: the force is smooth in the speed, nearly μ N once that is above the transition.

    Sliding and drilling share one limit: with v the slip at the pole of the contact, ω the spin about its axis and ρ
    the mean lever of the pressure about it, q² = v² + (ρ ω)² + (transition speed)²::

        f = -N (μ(q)/q + viscous) v,   M = -N (μ(q)/q + viscous) ρ² ω,
        μ(q) = coefficient + (static - coefficient) exp[-(q/stribeck_speed)²].

    Parameters
    ----------
    coefficient : float
        Of sliding friction, 0 or more.
    transition_speed : float
        In mm/s, above 0: at this slip the force has 71 % of its size. Below, the ball creeps.
    static_coefficient : float, optional
        Of a ball that hardly moves, not below the coefficient. None, the default, is the same.
    stribeck_speed : float
        In mm/s, above 0: how fast one goes over into the other.
    viscous : float
        In s/mm, 0 or more: what is added per speed.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    TypeError
        What is no number.
    """

    coefficient: float
    transition_speed: float = 0.1
    static_coefficient: float | None = None
    stribeck_speed: float = 10.0
    viscous: float = 0.0

    def __post_init__(self) -> None:
        for name in ("coefficient", "viscous"):
            checked(self, name, 0.0, "friction is 0 or more and finite: below 0 it would make energy")
        for name in ("transition_speed", "stribeck_speed"):
            checked(self, name, 5e-324, "a speed (mm/s) is above 0 and finite")
        self.check_static()


def checked(friction: object, name: str, least: float, allowed: str) -> None:
    """Make a number of a frozen value a float, if it is allowed."""
    value = one_number(name, getattr(friction, name))
    require(name, value, least <= value < math.inf, allowed)
    object.__setattr__(friction, name, value)


def grip(versine: Array) -> Array:
    """∫ p |a x n| dA over the force: how much more a turning ball is braked than one that slides on a point.

    a is an axis across the load, 1 - cos ε the versine. A fit to radial springs, within 2e-6; a hundredth off where
    the pressure has another shape.
    """
    m = versine
    return 1.0 + m * (0.166617 + m * (0.066859 + m * (0.019915 + m * (0.023034 + m * (0.009908 * m - 0.013095)))))


def drill_lever(versine: Array) -> Array:
    """The lever ρ of the pressure about the axis of the load, ∫ p R2 sin φ dA over F times the grip, over R2 sin ε.

    8/15 for a small contact. A fit to radial springs, within 1e-5.
    """
    m = versine
    return 8 / 15 + m * (0.165042 + m * (0.054402 + m * (0.015167 + m * (0.019374 + m * (0.009834 * m - 0.011755)))))


def coefficient_at(speed: Array, sliding: Array, static: Array, stribeck_speed: Array) -> Array:
    """μ of a slip."""
    share = speed / stribeck_speed
    return sliding + (static - sliding) * exp(-share * share)


def combined(slip_squared: Array, drill_squared: Array, transition_speed: Array) -> Array:
    """q in mm/s."""
    return sqrt(slip_squared + drill_squared + transition_speed * transition_speed)
