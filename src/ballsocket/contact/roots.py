"""Bracketed Newton iteration: the root of an increasing function of a number or of arrays."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import array_api_compat
import numpy

from ..core.arrays import Array, all_true, logical_not, namespace, safe_divisor, stop_gradient, where

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
    """Solve law(x) = target for an increasing function of arrays in a bracket, by Newton's method.

    Each element has its own bracket [low, high].

    Newton's method with the slope `law(x, *arguments)[1]`, see `bracketed_newton_step`. It stops after `steps`
    evaluations, or once no element moves by more than `tolerance` times its value. The error is then of the order of
    the squared tolerance. Inside `jax.jit` it always takes all steps. Automatic differentiation gives the derivatives
    of the root by the implicit function theorem.

    Parameters
    ----------
    law : callable
        Increasing function: x, *arguments -> (value, slope), both of the shape of x.
    target, low, high, start : array
        Value, bracket and first x; broadcastable, low <= start <= high.
    arguments : tuple
        Further arguments of the law.
    steps : int
        Largest number of evaluations.
    tolerance : float
        Relative step below which an element has converged.

    Returns
    -------
    array
        The root, or the nearest end of the bracket where there is none.
    """
    if type(start) is float:
        return scalar_increasing_root(law, target, low, high, start, arguments, steps, tolerance)

    def step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        """Compute one bracketed Newton step of all elements."""
        return bracketed_newton_step(law, target, arguments, tolerance, *state[:-1])

    x = _iterate(step, (start, low, high, start < high, start == start), steps)
    if namespace(x) is numpy:
        return x
    x = stop_gradient(x)
    for _ in range(2):  # a step at the root keeps its value and doubles the order of the correct derivatives
        value, slope = law(x, *arguments)
        x = x - where(slope > 0, (value - target) / safe_divisor(slope), 0.0)
    return x


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
    """Solve law(x) = target for an increasing function of one number, by bracketed Newton steps."""
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
        step, x = abs(next_x - x), next_x
        if step <= tolerance * abs(x):
            break
    return x


def bracketed_newton_step(
    law: Increasing,
    target: Array,
    arguments: tuple[Any, ...],
    tolerance: float,
    x: Array,
    low: Array,
    high: Array,
    fresh: Array,
) -> tuple[Array, Array, Array, Array, Array]:
    """Compute one Newton step within a bracket, and narrow the bracket.

    A step out of the bracket is replaced by the middle of the bracket, or by its upper end while that is `fresh`, that
    is, not yet evaluated.

    Returns
    -------
    array, five times
        x, low, high, fresh, and the mask of the elements that moved by more than the tolerance.
    """
    value, slope = law(x, *arguments)
    low = where(value <= target, x, low)
    high = where(value >= target, x, high)
    fresh = fresh & (x < high)
    newton = x - (value - target) / safe_divisor(slope)
    safe = (slope > 0) & (newton >= low) & (newton <= high)
    fallback = where(fresh & (newton > high), high, low + (high - low) / 2)
    next_x = where(safe, newton, fallback)
    return next_x, low, high, fresh, abs(next_x - x) > tolerance * abs(next_x)


def _iterate(step: Callable[[tuple[Array, ...]], tuple[Array, ...]], state: tuple[Array, ...], times: int) -> Array:
    """Iterate a step until all elements have converged; return the first item of the state.

    The last item of the state is the mask of unconverged elements.
    """
    if all_true(state[-1]) is None and array_api_compat.is_jax_array(state[0]):
        import jax  # compile one loop instead of unrolling the steps

        return jax.lax.fori_loop(0, times, lambda _, current: step(current), state)[0]
    for _ in range(times):
        state = step(state)
        if all_true(logical_not(state[-1])):
            break
    return state[0]
