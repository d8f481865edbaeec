"""The one bracketed inversion: where an increasing law of one number or many has a given value."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import array_api_compat
import numpy

from ..core.arrays import Array, all_true, logical_not, namespace, safe_divisor, stop_gradient, where

Increasing = Callable[..., tuple[Array, Array]]
"""x, ... -> (value, slope), both of the shape of x."""


def increasing_root(
    law: Increasing,
    target: Array,
    low: Array,
    high: Array,
    start: Array,
    given: tuple[Any, ...] = (),
    steps: int = 60,
    tolerance: float = 1e-8,
) -> Array:
    """Solve `law(x, *given)[0] == target` for an increasing law, element by element, inside the bracket [low, high].

    Newton's method with the slope `law(x, *given)[1]`, see `bracketed`. At most `steps` evaluations (all of them inside
    `jax.jit`), fewer once every element moves by less than `tolerance` of itself, which leaves an error of the order of
    its square. Automatic differentiation gives the derivatives of the root (the implicit function theorem), not of the
    way to it.

    Parameters
    ----------
    law : callable
        x, *given -> (value, slope), both of the shape of x.
    target, low, high, start : array
        Broadcastable; low <= start <= high.
    given : tuple
        What else the law takes.

    Returns
    -------
    array
        The root; the nearest end of the bracket where there is none.
    """
    if type(start) is float:
        return root_of_number(law, target, low, high, start, given, steps, tolerance)

    def step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        return bracketed(law, target, given, tolerance, *state[:-1])

    x = _repeated(step, (start, low, high, start < high, start == start), steps)
    if namespace(x) is numpy:
        return x
    x = stop_gradient(x)
    for _ in range(2):  # each step at the root keeps its value and doubles the order of the derivatives that are right
        value, slope = law(x, *given)
        x = x - where(slope > 0, (value - target) / safe_divisor(slope), 0.0)
    return x


def root_of_number(
    law: Increasing,
    target: float,
    low: float,
    high: float,
    start: float,
    given: tuple[Any, ...],
    steps: int,
    tolerance: float,
) -> float:
    """`increasing_root` of one number, step by step as in `bracketed`."""
    x, fresh = start, start < high
    for _ in range(steps):
        value, slope = law(x, *given)
        if value <= target:
            low = x
        if value >= target:
            high = x
        fresh = fresh and x < high
        after = x - (value - target) / slope if slope > 0 else math.nan
        if not low <= after <= high:
            after = high if fresh and after > high else low + (high - low) / 2
        moved, x = abs(after - x), after
        if moved <= tolerance * abs(x):
            break
    return x


def bracketed(
    law: Increasing,
    target: Array,
    given: tuple[Any, ...],
    tolerance: float,
    x: Array,
    low: Array,
    high: Array,
    fresh: Array,
) -> tuple[Array, Array, Array, Array, Array]:
    """One step of Newton's method inside a bracket, which shrinks: x, low, high, fresh, and whether x moved.

    A step that leaves the bracket is replaced by its middle, or by its upper end if that is `fresh`: not tried yet.
    """
    value, slope = law(x, *given)
    low = where(value <= target, x, low)
    high = where(value >= target, x, high)
    fresh = fresh & (x < high)
    newton = x - (value - target) / safe_divisor(slope)
    safe = (slope > 0) & (newton >= low) & (newton <= high)
    other = where(fresh & (newton > high), high, low + (high - low) / 2)
    after = where(safe, newton, other)
    return after, low, high, fresh, abs(after - x) > tolerance * abs(after)


def _repeated(step: Callable[[tuple[Array, ...]], tuple[Array, ...]], state: tuple[Array, ...], times: int) -> Array:
    """The first part of `state` after `step` has been taken until its last part, a mask, is false everywhere."""
    if all_true(state[-1]) is None and array_api_compat.is_jax_array(state[0]):
        import jax  # a loop that is compiled once in place of one that is written out

        return jax.lax.fori_loop(0, times, lambda _, now: step(now), state)[0]
    for _ in range(times):
        state = step(state)
        if all_true(logical_not(state[-1])):
            break
    return state[0]
