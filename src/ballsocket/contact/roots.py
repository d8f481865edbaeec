"""Roots of functions and ends of conditions within brackets, and the largest pressure of a solved contact."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from math import inf
from typing import Any

import array_api_compat
import numpy

from ..core.arrays import Array, all_true, logical_not, namespace, safe_divisor, stop_gradient, where, without_gradients

Increasing = Callable[..., tuple[Array, Array]]
"""Increasing function: x, ... -> (value, slope), both of the shape of x."""


def increasing_root(
    law: Increasing,
    target: Array,
    low: Array,
    high: Array,
    start: Array,
    arguments: tuple[Any, ...] = (),
    steps: int = 60,
    tolerance: float = 1e-8,
) -> Array:
    """Solve law(x) = target for x, element by element, by Newton's method within brackets.

    The law is an increasing function x, *arguments -> (value, slope), both of the shape of x. Each element has its own
    bracket low <= start <= high; the result is the nearest end of the bracket where there is no root.

    Newton's method with the slope stops after `steps` evaluations, or once no element moves by more than `tolerance`
    times its value. The error is then of the order of the squared tolerance. A step out of the bracket is replaced by
    the middle of the bracket, or by its upper end while that is `fresh`, that is, not yet evaluated. Inside
    `jax.jit` it is a `lax.while_loop`, or unrolled steps if `steps` is small; inside `torch.compile` and `vmap` of
    PyTorch it takes all steps. Automatic differentiation gives the derivatives of the root, see `implicit_root`.
    """
    if type(start) is float:
        return scalar_increasing_root(law, target, low, high, start, arguments, steps, tolerance)

    def newton_step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        """Step to the next x, and narrow the bracket; the last item is the mask of the elements that still move."""
        x, low, high, fresh, _ = state
        value, slope = law(x, *arguments)
        difference = value - target
        low = where(difference <= 0, x, low)
        high = where(difference >= 0, x, high)
        fresh = fresh & (x < high)
        newton_x = x - difference / safe_divisor(slope)
        newton_in_bracket = (slope > 0) & (newton_x >= low) & (newton_x <= high)
        fallback_x = where(fresh & (newton_x > high), high, low + (high - low) / 2)
        next_x = where(newton_in_bracket, newton_x, fallback_x)
        return next_x, low, high, fresh, abs(next_x - x) > tolerance * abs(next_x)

    def solve(first: Array) -> Array:
        return _iterate_until_converged(newton_step, (first, low, high, first < high, first == first), steps)

    def residual(x: Array) -> tuple[Array, Array]:
        value, slope = law(x, *arguments)
        return value - target, slope

    return implicit_root(residual, solve, start)


def bisect(low: float, high: float, holds: Callable[[float], bool], steps: int = 200, tolerance: float = 0.0) -> float:
    """Find the end of a condition that holds at `low` and not at `high`, by bisection; it holds at the result.

    The result has a relative tolerance, or is exact to rounding by default, unless that takes too many steps.
    """
    for _ in range(steps):
        middle = (low + high) / 2
        if not low < middle < high or high - low < tolerance * high:
            break
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def implicit_root(residual: Increasing, solve: Callable[[Array], Array], start: Array) -> Array:
    """Solve residual(x) = 0 with a solver, and give the root its derivatives by the implicit function theorem.

    The residual is an increasing function x -> (value, slope), both of the shape of x. `solve` computes the root from a
    first x; nobody differentiates through it. The root has derivatives of all orders in traced JAX, up to the third
    elsewhere.
    """
    if namespace(start) is numpy:
        return solve(start)
    if array_api_compat.is_jax_array(start) and all_true(start == start) is None:
        return _implicit_jax_root(lambda x: residual(x)[0], solve, start)
    with without_gradients(start):
        x = solve(start)
    x = stop_gradient(x)
    for _ in range(2):  # a step at the root keeps its value and doubles the order of the correct derivatives
        value, slope = residual(x)
        x = x - where(slope > 0, value / safe_divisor(slope), 0.0)
    return x


def _implicit_jax_root(residual: Callable[[Array], Array], solve: Callable[[Array], Array], start: Array) -> Array:
    """Solve residual(x) = 0 in traced JAX; derivatives of all orders follow from the residual at the root."""
    import jax

    def solve_linearised(product: Callable[[Array], Array], right_side: Array) -> Array:
        """Divide by the slope of the residual, element by element; 0 where the slope is not positive."""
        slope = product(jax.numpy.ones_like(right_side))
        return where(slope > 0, right_side / safe_divisor(slope), 0.0)

    return jax.lax.custom_root(residual, start, lambda _, first: solve(first), solve_linearised)


def scalar_increasing_root(
    law: Increasing,
    target: float,
    low: float,
    high: float,
    start: float,
    arguments: tuple[Any, ...],
    steps: int,
    tolerance: float,
) -> float:
    """Solve law(x) = target for one number x, by Newton's method within a bracket."""
    x, fresh = start, start < high
    for _ in range(steps):
        value, slope = law(x, *arguments)
        if value <= target:
            low = x
        if value >= target:
            high = x
        fresh = fresh and x < high
        next_x = x - (value - target) / slope if slope > 0 else math.nan
        if not low <= next_x <= high:
            next_x = high if fresh and next_x > high else low + (high - low) / 2
        step_size, x = abs(next_x - x), next_x
        if step_size <= tolerance * abs(x):
            break
    return x


def _iterate_until_converged(
    iteration_step: Callable[[tuple[Array, ...]], tuple[Array, ...]], state: tuple[Array, ...], max_steps: int
) -> Array:
    """Repeat a step until its last item, the mask of unconverged elements, is false; return the first item."""
    is_traced = all_true(state[-1]) is None
    if is_traced and max_steps > _MAX_UNROLLED_STEPS and array_api_compat.is_jax_array(state[0]):
        import jax

        def is_unconverged(count_and_state: tuple[Any, tuple[Array, ...]]) -> Array:
            count, current = count_and_state
            return (count < max_steps) & jax.numpy.any(current[-1])

        def advance(count_and_state: tuple[Any, tuple[Array, ...]]) -> tuple[Any, tuple[Array, ...]]:
            count, current = count_and_state
            return count + 1, iteration_step(current)

        return jax.lax.while_loop(is_unconverged, advance, (0, state))[1][0]
    for _ in range(max_steps):
        state = iteration_step(state)
        if not is_traced and all_true(logical_not(state[-1])):
            break
    return state[0]


_MAX_UNROLLED_STEPS = 2
"""Largest number of steps that traced JAX unrolls into one fused computation, in place of a loop."""


_PROFILE_POSITIONS = numpy.array([0.0, 0.05, 0.12, 0.25, 0.4, 0.55, 0.7, 0.82, 0.92, 1.0])
"""Polar angles of a profile over the half angle; a peak of less than 1e-6 between the first two counts as the pole."""

_REFINEMENTS = 4  # number of refinements of the interval that holds the largest pressure
_INTERVAL_POSITIONS = numpy.linspace(0.0, 1.0, 9)  # positions in an interval of a refinement


def find_peak_pressure(
    pressure: Callable[[numpy.ndarray], numpy.ndarray], pole: numpy.ndarray, edge: numpy.ndarray, noise: float
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Find the largest pressure in MPa of each contact, and its polar angle in rad: two arrays (contacts,).

    The function returns the pressure in MPa at angles in rad (angles, contacts). `pole` is the pressure in MPa at the
    pole, `edge` the half angle in rad, and `noise` a relative excess over the pressure at the pole that is ignored.
    """
    values = numpy.vstack([pole, pressure(edge * _PROFILE_POSITIONS[1:-1, None]), 0.0 * edge])
    largest_index = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
    peak_off_pole = (largest_index > 0) & (
        values.max(axis=0, initial=-inf, where=numpy.isfinite(values)) > pole * (1 + noise)
    )
    if not peak_off_pole.any():
        return pole, 0.0 * edge
    low, high = (
        edge * _PROFILE_POSITIONS[numpy.clip(largest_index + neighbour, 0, len(_PROFILE_POSITIONS) - 1)]
        for neighbour in (-1, 1)
    )
    contacts = numpy.arange(len(edge))
    for _ in range(_REFINEMENTS):
        angles = low + (high - low) * _INTERVAL_POSITIONS[:, None]
        values = pressure(angles)
        largest_index = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
        angle, largest = angles[largest_index, contacts], values[largest_index, contacts]
        low, high = (
            angles[numpy.clip(largest_index + neighbour, 0, len(_INTERVAL_POSITIONS) - 1), contacts]
            for neighbour in (-1, 1)
        )
    return numpy.where(peak_off_pole, largest, pole), numpy.where(peak_off_pole, angle, 0.0)


class PeakPressure(ABC):
    """Mixin class of solved contacts that adds the largest pressure and its polar angle."""

    @property
    @abstractmethod
    def largest(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Largest pressure of each contact in MPa, and its polar angle in rad."""

    @property
    def max_pressure(self) -> numpy.ndarray:
        """Largest pressure of each contact in MPa."""
        return self.largest[0]

    @property
    def max_pressure_angle(self) -> numpy.ndarray:
        """Polar angle in rad of the largest pressure of each contact."""
        return self.largest[1]
