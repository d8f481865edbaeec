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
    """Solve law(x) = target for x, element by element, by Newton's method within brackets.

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

    def newton_step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        """Advance all elements by one bracketed Newton step."""
        return bracketed_newton_step(law, target, arguments, tolerance, *state[:-1])

    x = _iterate_until_converged(newton_step, (start, low, high, start < high, start == start), steps)
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
    """Compute one Newton step of x towards law(x) = target within a bracket, and narrow the bracket.

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
    newton_x = x - (value - target) / safe_divisor(slope)
    newton_in_bracket = (slope > 0) & (newton_x >= low) & (newton_x <= high)
    fallback_x = where(fresh & (newton_x > high), high, low + (high - low) / 2)
    next_x = where(newton_in_bracket, newton_x, fallback_x)
    return next_x, low, high, fresh, abs(next_x - x) > tolerance * abs(next_x)


def _iterate_until_converged(
    iteration_step: Callable[[tuple[Array, ...]], tuple[Array, ...]], state: tuple[Array, ...], max_steps: int
) -> Array:
    """Repeat an iteration step until all elements have converged; return the first item of the state.

    The last item of the state is the mask of unconverged elements.
    """
    if all_true(state[-1]) is None and array_api_compat.is_jax_array(state[0]):
        import jax  # compile one loop instead of unrolling the steps

        return jax.lax.fori_loop(0, max_steps, lambda _, current: iteration_step(current), state)[0]
    for _ in range(max_steps):
        state = iteration_step(state)
        if all_true(logical_not(state[-1])):
            break
    return state[0]
