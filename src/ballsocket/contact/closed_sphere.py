"""Estimated difference between a closed sphere (the exact solution) and a hemisphere with a free rim.

The formulas hold for a liner on a rigid backing. They are fitted to the estimate of `Exact` (`contact.hemisphere`) and
are 0.7 to 1.3 times that estimate for nine of ten joints. `tabulated` and `refined` use them; `exact` computes the
change for any layers.
"""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from math import radians
from typing import Any

from ..core.arrays import Array, clip, exp, log
from ..core.validity import Range, Remark

NOTED_CHANGE = 0.01  # relative difference above which a note reports it
MAX_CHANGE = 0.15  # largest relative difference of indentation or largest pressure for which the closed sphere is valid

POISSON_RANGE, THICKNESS_RATIO_RANGE, MAX_MODULUS_RATIO = (0.0, 0.499), (0.2, 20.0), 0.02
"""Fitted ranges of Poisson's ratio and R2/L of the liner, and the largest fitted E/E_ball."""

MIN_HALF_ANGLE, MAX_HALF_ANGLE = radians(3.0), radians(83.0)
"""Fitted range of half angles; beyond its ends the estimate is constant."""

BALL_FACTOR = 2.1  # ratio of the largest change by the half ball to the change of the indentation


def polynomial_variables(half_angle: Array, poisson: Array, thickness_ratio: Array) -> tuple[Array, Array, Array]:
    """Compute the variables of the fitted polynomials: ε in rad, ln(R2/L) and ln(0.52 - ν)."""
    return (
        clip(half_angle, MIN_HALF_ANGLE, MAX_HALF_ANGLE),
        log(clip(thickness_ratio, *THICKNESS_RATIO_RANGE)),
        log(0.52 - clip(poisson, *POISSON_RANGE)),
    )


@cache
def polynomial_exponents(degree: int) -> tuple[tuple[int, int, int], ...]:
    """List the exponents (i, j, k) of the three variables in each term of a polynomial of given degree."""
    orders = range(degree + 1)
    return tuple((i, j, k) for i in orders for j in orders for k in orders if i + j + k <= degree)


@cache
def _fitted_polynomials() -> dict[str, list[float]]:
    return tomllib.loads((files("ballsocket") / "data" / "hemisphere.toml").read_text(encoding="utf-8"))


def _fitted_change(name: str, degree: int, contact: Any) -> Array:
    """Evaluate the fitted relative change of a contact: the exponential of a polynomial."""
    joint = contact.joint
    x, y, z = polynomial_variables(contact.half_angle, joint.liner.poisson, joint.thickness_ratio)
    terms = zip(_fitted_polynomials()[name], polynomial_exponents(degree), strict=True)
    return exp(sum(coefficient * x**i * y**j * z**k for coefficient, (i, j, k) in terms))


def hemisphere_indentation_change(contact: Any) -> Array:
    """Estimate the relative increase of indentation at equal force if a hemisphere replaces the closed sphere."""
    return _fitted_change("indentation", 5, contact) + contact.joint.modulus_ratio * _fitted_change("ball", 4, contact)


def max_hemisphere_change(contact: Any) -> Array:
    """Estimate the largest relative change of a contact if a hemisphere replaces the closed sphere.

    It is the largest of the changes of indentation, half angle, largest pressure and stiffness at the same force.
    """
    ball = BALL_FACTOR * contact.joint.modulus_ratio * _fitted_change("ball", 4, contact)
    return _fitted_change("largest", 5, contact) + ball


LIKE_HEMISPHERE = Range(
    quantity=hemisphere_indentation_change,
    symbol="change of d on a hemisphere",
    high=MAX_CHANGE,
    why="the model is a closed sphere, and a socket with a free rim is softer: use fem or sphere",
)

HEMISPHERE_NOTE = Remark(
    quantity=max_hemisphere_change,
    symbol="change on a hemisphere",
    high=NOTED_CHANGE,
    why="closed sphere: on a hemisphere with a free rim, d, ε, pmax or dF/dd differs by more than 1 % at the same "
    "force; the model exact estimates the difference, fem and sphere compute it",
)
