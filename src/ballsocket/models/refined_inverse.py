"""Refined model under a force or an indentation: a start from a fitted series, Newton's method, a linear correction.

A power of the half angle grows with a dimensionless load q as ε^n = q/(a + b q) at small loads. What is left, a factor
of ε, is a smooth function of ν, R2/L and ε, which is fitted to the model itself.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import log as ln
from math import nan, prod, radians
from typing import NamedTuple

import numpy

from ..contact.roots import Increasing, increasing_root
from ..core import arrays
from ..core.arrays import Array, Numbers, clip, exp, log, log1p, sqrt, where
from ..core.chebyshev import (
    Pair,
    chebyshev_coefficients,
    chebyshev_points,
    chebyshev_polynomials,
    convert_like,
    multiply_factors,
    series_values,
)
from .liner_compliance import Liner, liner_coefficients
from .refined_state import ScaledContact, scaled_contact, shift_contact

MAX_HALF_ANGLE = radians(85.0)
"""Largest half angle in rad that is solved."""

_LOG_OFFSET = -1.0
"""Value of the unknown, a shifted ln ε, at the widest contact; the shift keeps it away from zero."""

END = _LOG_OFFSET + 1e-12
"""Upper end of the unknown, which includes the widest contact itself."""

TOLERANCE = 1.5e-3
"""Relative Newton step after which ε has a relative error below 1e-6, which the correction squares."""

_POISSON, _THICKNESS_RATIO = (0.2, 0.485), (0.3, 15.0)
"""Ranges of ν and R2/L in the series of the start; the start of other joints is that of the nearest."""

_START_COUNTS = (6, 7, 12)
"""Numbers of Chebyshev polynomials of ν, R2/L and half angle in the start."""

_FIT_STEPS = 12
"""Newton steps to the half angles that the start is fitted to."""

_ANGLE_SCALE, _RATIO_SHIFT = 0.8, 0.2
"""Scales of the coordinates of ε and R2/L."""


ContactProduct = Callable[[ScaledContact, Array], Pair]
"""Function of a trial contact and a load that is 1 at the solution, and the slope of its logarithm by ln ε."""


def indentation_product(contact: ScaledContact, load: Array) -> Pair:
    """Compute x/(1 + x) over that of the load, where x = d/c, and the slope of its logarithm."""
    total = 2 * contact.share + contact.gap
    slope = (contact.share_rate * contact.gap - contact.gap_slope) / total
    return 2 * contact.share / total * (1 + 1 / load), slope


def force_product(contact: ScaledContact, load: Array) -> Pair:
    """Compute x/(1 + x) over that of the load divided by the secant stiffness, and the slope of its logarithm."""
    total = 2 * contact.share + contact.gap
    slope = (contact.share_rate * contact.gap - contact.gap_slope) / total
    slope = slope + contact.secant_rate * contact.secant / (contact.secant + load)
    return 2 * contact.share / total * (1 + contact.secant / load), slope


def _indentation_residual(root: Array, load: Array, liner: Liner) -> Pair:
    """Compute the residual of the indentation at a trial value of the unknown, and its slope."""
    product, slope = indentation_product(scaled_contact(half_angle_of_root(root), liner), load)
    return log(product), slope


def _force_residual(root: Array, load: Array, liner: Liner) -> Pair:
    """Compute the residual of the force at a trial value of the unknown, and its slope."""
    product, slope = force_product(scaled_contact(half_angle_of_root(root), liner), load)
    return log(product), slope


class _LoadInverse(NamedTuple):
    """Functions and constants of one kind of load."""

    residual: Increasing
    product: ContactProduct
    power: float
    """Power n of ε that grows with the load."""
    small: float
    """Constant a of ε^n = q/(a + b q)."""
    large: float
    """Constant b of ε^n = q/(a + b q)."""
    scalar_constants: tuple[float, float]
    """Constants a and b of the start of a single press, which uses no series."""


INVERSES = {
    "force": _LoadInverse(
        residual=_force_residual,
        product=force_product,
        power=3.0,
        small=2.5,
        large=0.04,
        scalar_constants=(2.5, 1 / 3),
    ),
    "indentation": _LoadInverse(
        residual=_indentation_residual,
        product=indentation_product,
        power=2.0,
        small=2 / 3,
        large=0.1,
        scalar_constants=(2 / 3, 2 / 3),
    ),
}
"""Functions and constants of the inverse by kind of load."""


def solve_contact(kind: str, load: Array, liner: Liner, ratio: Array) -> tuple[Array, ...]:
    """Solve for the contact under a dimensionless load: F/(E R2 c) of a force or d/c of an indentation.

    `ratio` is R2/L.

    Returns
    -------
    array
        Half angle ε in rad; NaN beyond the largest half angle.
    array
        Last relative correction of ε.
    array
        One for each field of `ScaledContact`.
    """
    inverse = INVERSES[kind]
    start = _scalar_start(inverse, load) if type(load) is float else _series_start(kind, load, liner.poisson, ratio)
    end = 0.0 * start + END
    root = increasing_root(
        inverse.residual, 0.0 * start, start - 6.0, end, start, arguments=(load, liner), tolerance=TOLERANCE
    )
    contact = scaled_contact(half_angle_of_root(root), liner)
    shift = last_shift(*inverse.product(contact, load))
    return (masked_half_angle(root, shift), shift, *shift_contact(contact, shift))


def half_angle_of_root(root: Array) -> Array:
    """Compute the half angle in rad from the unknown."""
    return exp(root - _LOG_OFFSET) * MAX_HALF_ANGLE


def last_shift(product: Array, slope: Array) -> Array:
    """Compute the last change of ln ε from the values of a `ContactProduct`."""
    return (1 - product) / slope


def masked_half_angle(root: Array, shift: Array) -> Array:
    """Compute the half angle in rad from the unknown and its last change; NaN beyond the largest half angle."""
    return where(root < END, half_angle_of_root(root) * (1 + shift), nan)


def _scalar_start(inverse: _LoadInverse, load: float) -> float:
    """Estimate the unknown of a single press."""
    small, large = inverse.scalar_constants
    return log(load / (small + large * load)) / inverse.power + (_LOG_OFFSET - ln(MAX_HALF_ANGLE))


def _series_start(kind: str, load: Array, poisson: Array, ratio: Array) -> Array:
    """Compute the first value of the unknown from the fitted series; `load` has the shape of all contacts."""
    numbers = arrays.stop_gradient(load), arrays.stop_gradient(poisson), arrays.stop_gradient(ratio)
    flat_load, flat_poisson, flat_ratio = (flatten_like(number, load) for number in numbers)
    log_estimate = start_log_estimate(flat_load, *start_constants(kind))
    coordinate = start_coordinate(exp(log_estimate), start_ratio(flat_ratio), start_constants(kind)[3])
    correction = series_values(start_series(kind, flat_poisson, flat_ratio), coordinate)
    return arrays.namespace(load).reshape(start_root(log_estimate, correction), load.shape)


def flatten_like(number: Array, contacts: Array) -> Array:
    """Flatten an array of one element, or broadcast an array to the shape of `contacts` and flatten it."""
    expanded = number if prod(number.shape) == 1 else arrays.broadcast_to(number, contacts.shape)
    return arrays.namespace(number).reshape(expanded, (-1,))


def start_constants(kind: str) -> tuple[float, float, float, float]:
    """Return power, a and b of the estimate of a kind of load, and its largest half angle."""
    inverse = INVERSES[kind]
    return inverse.power, inverse.small, inverse.large, inverse.large ** (-1 / inverse.power)


def start_log_estimate(load: Array, power: float, small: float, large: float, widest: float) -> Array:
    """Estimate ln ε from the load."""
    return log(load / (small + large * load)) / power


def start_ratio(ratio: Array) -> Array:
    """Limit the ratio R2/L to the range of the start."""
    return clip(ratio, *_THICKNESS_RATIO)


def start_coordinate(estimate: Array, ratio: Array, widest: float) -> Array:
    """Compute the coordinate, -1 to 1, of an estimated half angle, at most `widest`."""
    near = _ANGLE_SCALE * (1 + ratio)
    return 2 * sqrt(log1p(near * estimate) / log1p(near * widest)) - 1


def start_root(log_estimate: Array, correction: Array) -> Array:
    """Compute the first value of the unknown from the estimated ln ε and its correction."""
    root = log_estimate + correction + (_LOG_OFFSET - ln(MAX_HALF_ANGLE))
    return where(root < END, root, END)


def start_series(kind: str, poisson: Array, ratio: Array) -> Array:
    """Compute the Chebyshev coefficients (angles, joints) of the start for joints (joints,)."""
    coordinates = _poisson_coordinate(clip(poisson, *_POISSON)), _ratio_coordinate(start_ratio(ratio))
    factors = [chebyshev_polynomials(x, count) for x, count in zip(coordinates, _START_COUNTS[:2], strict=True)]
    return multiply_factors(convert_like(_start_table(kind), factors[0]), *factors)


_LOG_POISSON = ln(1 - 2 * _POISSON[1]), ln(1 - 2 * _POISSON[0])
_LOG_RATIO = ln(_THICKNESS_RATIO[0] + _RATIO_SHIFT), ln(_THICKNESS_RATIO[1] + _RATIO_SHIFT)
"""Ranges of the logarithms that the coordinates of ν and R2/L are linear in."""


def _poisson_coordinate(poisson: Array) -> Array:
    """Compute the coordinate of Poisson's ratio, from -1 to 1; it is linear in ln(1 - 2ν)."""
    low, high = _LOG_POISSON
    return (high + low - 2 * log(1 - 2 * poisson)) / (high - low)


def _ratio_coordinate(ratio: Array) -> Array:
    """Compute the coordinate of the ratio R2/L, from -1 to 1; it is a shifted logarithm."""
    low, high = _LOG_RATIO
    return (2 * log(ratio + _RATIO_SHIFT) - low - high) / (high - low)


@cache
def _start_table(kind: str) -> Numbers:
    """Fit the correction of the start: Chebyshev coefficients (angles, products of ν and R2/L)."""
    x, y, z = (grid.ravel() for grid in numpy.meshgrid(*map(chebyshev_points, _START_COUNTS), indexing="ij"))
    (low, high), (thick, thin) = _LOG_POISSON, _LOG_RATIO
    poisson = (1 - numpy.exp((high + low - x * (high - low)) / 2)) / 2
    ratio = numpy.exp((thick + thin + y * (thin - thick)) / 2) - _RATIO_SHIFT
    power, small, large, widest = start_constants(kind)
    near = _ANGLE_SCALE * (1 + ratio)
    estimate = numpy.expm1(((1 + z) / 2) ** 2 * numpy.log1p(near * widest)) / near
    load, liner = small / (estimate**-power - large), liner_coefficients(poisson, 1 + 1 / ratio)
    root = first = numpy.log(estimate / MAX_HALF_ANGLE) + _LOG_OFFSET
    for _ in range(_FIT_STEPS):
        value, slope = INVERSES[kind].residual(root, load, liner)
        root = root - value / slope
    coefficients = (root - first).reshape(_START_COUNTS)
    for axis in range(3):
        coefficients = chebyshev_coefficients(coefficients, axis)
    return numpy.ascontiguousarray(coefficients.reshape(-1, _START_COUNTS[2]).T)
