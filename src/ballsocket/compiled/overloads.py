"""Numba overloads of the scalar functions of `ballsocket.core.arrays`, and registration of formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy
from numba.core import types
from numba.extending import overload, register_jitable

from ..contact import roots
from ..core import arrays

inline_formula = register_jitable(forceinline=True)
"""Registration of a formula for compiled code, inlined into the caller's loop."""

jit_formula = register_jitable
"""Registration of a formula for compiled code, not inlined because of its length."""


def compile_loop(function: Callable[..., Any]) -> Any:
    """Compile a loop over arrays with numba; each input is a number or an array."""
    # contract: a product and a sum may be rounded once; the order of operations does not change
    return numba.njit(function, error_model="numpy", fastmath={"contract"})


def as_row(number: Any, shape: tuple[int, ...]) -> Any:
    """Broadcast an array to a common shape and flatten it to one row; convert a number to a float."""
    if numpy.ndim(number) == 0:
        return float(number)
    expanded = number if number.shape == shape else numpy.broadcast_to(number, shape)
    return numpy.ascontiguousarray(expanded).reshape(-1)


def pick_element(values: Any, i: int) -> Any:
    """Return element i of an array; a number is returned itself, because it holds for every i."""
    return values[i] if isinstance(values, numpy.ndarray) else values


@overload(pick_element, strict=False, jit_options={"forceinline": True})
def _overload_pick_element(values: Any, i: Any) -> Callable[..., Any]:
    """Implement `pick_element` for arrays and for numbers in compiled code."""
    if isinstance(values, types.Array):
        return lambda values, i: values[i]
    return lambda values, i: values


@overload(arrays.sqrt, strict=False)
def _overload_sqrt(x: Any) -> Callable[..., Any]:
    """Implement `arrays.sqrt` for numbers in compiled code."""
    return lambda x: math.sqrt(x)


@overload(arrays.exp, strict=False)
def _overload_exp(x: Any) -> Callable[..., Any]:
    """Implement `arrays.exp` for numbers in compiled code."""
    return lambda x: math.exp(x)


@overload(arrays.log, strict=False)
def _overload_log(x: Any) -> Callable[..., Any]:
    """Implement `arrays.log` for numbers in compiled code."""
    return lambda x: math.log(x)


@overload(arrays.log1p, strict=False)
def _overload_log1p(x: Any) -> Callable[..., Any]:
    """Implement `arrays.log1p` for numbers in compiled code."""
    return lambda x: math.log1p(x)


@overload(arrays.sin, strict=False)
def _overload_sin(x: Any) -> Callable[..., Any]:
    """Implement `arrays.sin` for numbers in compiled code."""
    return lambda x: math.sin(x)


@overload(arrays.cos, strict=False)
def _overload_cos(x: Any) -> Callable[..., Any]:
    """Implement `arrays.cos` for numbers in compiled code."""
    return lambda x: math.cos(x)


@overload(arrays.asin, strict=False)
def _overload_asin(x: Any) -> Callable[..., Any]:
    """Implement `arrays.asin` for numbers in compiled code."""
    return lambda x: math.asin(x)


@overload(arrays.atan2, strict=False)
def _overload_atan2(y: Any, x: Any) -> Callable[..., Any]:
    """Implement `arrays.atan2` for numbers in compiled code."""
    return lambda y, x: math.atan2(y, x)


@overload(arrays.where, strict=False)
def _overload_where(condition: Any, yes: Any, no: Any) -> Callable[..., Any]:
    """Implement `arrays.where` for numbers in compiled code."""
    return lambda condition, yes, no: yes if condition else no


@overload(arrays.clip, strict=False)
def _overload_clip(x: Any, low: Any, high: Any) -> Callable[..., Any]:
    """Implement `arrays.clip` for numbers in compiled code."""
    return lambda x, low, high: min(max(x, low), high)


@overload(arrays.all_true, strict=False)
def _overload_all_true(condition: Any) -> Callable[..., Any]:
    """Implement `arrays.all_true` for numbers in compiled code."""
    return lambda condition: condition


@overload(arrays.logical_not, strict=False)
def _overload_logical_not(condition: Any) -> Callable[..., Any]:
    """Implement `arrays.logical_not` for numbers in compiled code."""
    return lambda condition: not condition


@overload(roots.increasing_root, strict=False)
def _overload_increasing_root(
    law: Any, target: Any, low: Any, high: Any, start: Any, arguments: Any = (), steps: Any = 60, tolerance: Any = 1e-8
) -> Callable[..., Any]:
    """Implement `roots.increasing_root` for numbers in compiled code."""
    return lambda law, target, low, high, start, arguments=(), steps=60, tolerance=1e-8: roots.scalar_increasing_root(
        law, target, low, high, start, arguments, steps, tolerance
    )


inline_formula(arrays.safe_divisor)
jit_formula(roots.scalar_increasing_root)
