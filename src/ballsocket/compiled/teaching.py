"""What the functions of `ballsocket.core.arrays` mean for one number, for numba; and the words to teach it formulas."""

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

compilable = register_jitable(forceinline=True)
"""Lets compiled code call a formula as it stands, and puts it into the caller's loop."""

taught = register_jitable
"""Lets compiled code call a formula as it stands, one that is too long to be put into every loop."""


def compiled(function: Callable[..., Any]) -> Any:
    """A pass over arrays, compiled for whichever mix of numbers and arrays it is called with."""
    # contract: a product and a sum may be rounded once; the order of operations stays as written
    return numba.njit(function, error_model="numpy", fastmath={"contract"})


def flat(number: Any, shape: tuple[int, ...]) -> Any:
    """One number as it is, an array as one row of the common shape."""
    if numpy.ndim(number) == 0:
        return float(number)
    whole = number if number.shape == shape else numpy.broadcast_to(number, shape)
    return numpy.ascontiguousarray(whole).reshape(-1)


def pick(part: Any, i: int) -> Any:
    """Element i of an array; a number is the same for all i."""
    return part[i] if isinstance(part, numpy.ndarray) else part


@overload(pick, strict=False, jit_options={"forceinline": True})
def _pick(part: Any, i: Any) -> Callable[..., Any]:
    if isinstance(part, types.Array):
        return lambda part, i: part[i]
    return lambda part, i: part


@overload(arrays.sqrt, strict=False)
def _sqrt(x: Any) -> Callable[..., Any]:
    return lambda x: math.sqrt(x)


@overload(arrays.exp, strict=False)
def _exp(x: Any) -> Callable[..., Any]:
    return lambda x: math.exp(x)


@overload(arrays.log, strict=False)
def _log(x: Any) -> Callable[..., Any]:
    return lambda x: math.log(x)


@overload(arrays.log1p, strict=False)
def _log1p(x: Any) -> Callable[..., Any]:
    return lambda x: math.log1p(x)


@overload(arrays.sin, strict=False)
def _sin(x: Any) -> Callable[..., Any]:
    return lambda x: math.sin(x)


@overload(arrays.cos, strict=False)
def _cos(x: Any) -> Callable[..., Any]:
    return lambda x: math.cos(x)


@overload(arrays.asin, strict=False)
def _asin(x: Any) -> Callable[..., Any]:
    return lambda x: math.asin(x)


@overload(arrays.atan2, strict=False)
def _atan2(y: Any, x: Any) -> Callable[..., Any]:
    return lambda y, x: math.atan2(y, x)


@overload(arrays.where, strict=False)
def _where(condition: Any, this: Any, that: Any) -> Callable[..., Any]:
    return lambda condition, this, that: this if condition else that


@overload(arrays.clip, strict=False)
def _clip(x: Any, low: Any, high: Any) -> Callable[..., Any]:
    return lambda x, low, high: min(max(x, low), high)


@overload(arrays.all_true, strict=False)
def _truth(condition: Any) -> Callable[..., Any]:
    return lambda condition: condition


@overload(arrays.logical_not, strict=False)
def _false(condition: Any) -> Callable[..., Any]:
    return lambda condition: not condition


@overload(roots.increasing_root, strict=False)
def _increasing_root(
    law: Any, target: Any, low: Any, high: Any, start: Any, arguments: Any = (), steps: Any = 60, tolerance: Any = 1e-8
) -> Callable[..., Any]:
    return lambda law, target, low, high, start, arguments=(), steps=60, tolerance=1e-8: roots.root_of_number(
        law, target, low, high, start, arguments, steps, tolerance
    )


compilable(arrays.safe_divisor)
taught(roots.root_of_number)
