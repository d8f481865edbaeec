"""Elementary functions of Python numbers and of arrays of any library.

The formulas of this package are written once, with plain arithmetic and the functions below. They run on Python
numbers, NumPy, JAX, PyTorch and any other library that follows the array API standard. `ballsocket.compiled` compiles
the same functions for scalars. The result of Python floats is a Python float from the module `math`; it is infinite or
NaN, as in NumPy, where `math` raises.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import array_api_compat
import numpy

Array = Any
"""A Python number or an array of any library that follows the array API standard."""

Numbers = numpy.ndarray
"""A NumPy array, in code that accepts no other library: solvers, studies and files."""

_DOUBLE_EPSILON = float(numpy.finfo(float).eps)
"""Relative rounding error of double precision."""

_NUMPY_TYPES = (float, int, numpy.ndarray, numpy.generic)
"""Types whose array library is NumPy."""


def is_plain_number(value: Any) -> bool:
    """Return True for a Python or NumPy number, which takes the library and dtype of the other operands."""
    return isinstance(value, int | float)


def namespace(*values: Array) -> Any:
    """Return the array library of some values; NumPy for plain numbers.

    Raises
    ------
    TypeError
        Arrays of several libraries.
    """
    if all(isinstance(value, _NUMPY_TYPES) for value in values):
        return numpy
    arrays = [value for value in values if not is_plain_number(value)]
    try:
        return array_api_compat.array_namespace(*arrays)
    except TypeError as error:
        kinds = sorted({f"{type(value).__module__.split('.')[0]}.{type(value).__name__}" for value in arrays})
        raise TypeError(f"all arrays must be of one library, got {', '.join(kinds)}") from error


def _make_elementwise(name: str, scalar_function: Callable[[float], float]) -> Callable[[Array], Array]:
    """Return the elementwise function of that name for Python numbers and arrays."""

    def function(x: Array) -> Array:
        if type(x) is not float:
            return getattr(namespace(x), name)(x)
        try:
            return scalar_function(x)
        except (ValueError, OverflowError):
            with numpy.errstate(all="ignore"):
                return float(getattr(numpy, name)(x))

    function.__name__ = name
    return function


exp = _make_elementwise("exp", math.exp)
log = _make_elementwise("log", math.log)
log1p = _make_elementwise("log1p", math.log1p)
sin = _make_elementwise("sin", math.sin)
cos = _make_elementwise("cos", math.cos)
tan = _make_elementwise("tan", math.tan)
atan = _make_elementwise("atan", math.atan)
asinh = _make_elementwise("asinh", math.asinh)
asin = _make_elementwise("asin", math.asin)


def sqrt(x: Array) -> Array:
    """Compute √x, with a derivative of 0 at 0, so that a point without load does not turn gradients into NaN."""
    if type(x) is float:
        return math.sqrt(x) if x >= 0 else math.nan
    xp = namespace(x)
    if xp is numpy:
        return numpy.sqrt(x)
    return xp.where(x == 0, 0.0 * x, xp.sqrt(where(x == 0, 1.0, x)))


def power(x: Array, exponent: float) -> Array:
    """Compute x^exponent for a positive exponent, with a derivative of 0 at 0 as in `sqrt`."""
    if type(x) is float:
        return x**exponent if x >= 0 else math.nan
    if namespace(x) is numpy:
        return x**exponent
    return where(x == 0, 0.0 * x, where(x == 0, 1.0, x) ** exponent)


def atan2(y: Array, x: Array) -> Array:
    """Compute the angle in rad of the point (x, y)."""
    if type(y) is float and type(x) is float:
        return math.atan2(y, x)
    return namespace(y, x).atan2(y, x)


def where(condition: Array, if_true: Array, if_false: Array) -> Array:
    """Select elements of two arrays by a mask."""
    if type(condition) is bool and type(if_true) is float and type(if_false) is float:
        return if_true if condition else if_false
    return namespace(condition, if_true, if_false).where(condition, if_true, if_false)


def clip(x: Array, low: float, high: float) -> Array:
    """Limit x to the interval from low to high."""
    return min(max(x, low), high) if isinstance(x, float) else namespace(x).clip(x, low, high)


def isfinite(x: Array) -> Array:
    """Return the mask of the elements that are neither infinite nor NaN."""
    return math.isfinite(x) if type(x) is float else namespace(x).isfinite(x)


def logical_not(condition: Array) -> Array:
    """Invert a mask."""
    return condition ^ True


def safe_divisor(x: Array) -> Array:
    """Replace elements that are not positive by 1, for quotients whose numerator is 0 there."""
    return where(x > 0, x, 1.0)


def device(x: Array) -> Any:
    """Return the device that holds the array `x`."""
    return array_api_compat.device(x)


def machine_epsilon(x: Array) -> float:
    """Return the relative rounding error of the dtype of `x`."""
    if type(x) is float:
        return _DOUBLE_EPSILON
    return float(namespace(x).finfo(x.dtype).eps)


def concrete_values(x: Array) -> numpy.ndarray | None:
    """Return the values of `x` as a NumPy array, or None while they are traced (inside `jax.jit`, `jax.grad`)."""
    try:
        return to_numpy(x)
    except (TypeError, RuntimeError):
        return None


def all_true(condition: Array) -> bool | None:
    """Return True if all elements are true, or None while they are traced (inside `jax.jit`, `vmap`)."""
    try:
        return condition if isinstance(condition, bool) else bool(namespace(condition).all(condition))
    except (TypeError, RuntimeError):  # tracers of JAX and PyTorch have no value
        return None


def stop_gradient(x: Array) -> Array:
    """Return `x` as a constant of automatic differentiation."""
    if array_api_compat.is_torch_array(x):
        return x.detach()
    if array_api_compat.is_jax_array(x):
        import jax

        return jax.lax.stop_gradient(x)
    return x


def to_common_arrays(*values: Array) -> tuple[Array, ...]:
    """Convert values to arrays of the library, floating dtype and device of the arrays among them.

    Lists and integers become floats. Plain numbers without an array become NumPy float64 scalars.
    """
    listed = [numpy.asarray(value) if isinstance(value, list | tuple) else value for value in values]
    xp = namespace(*listed)
    arrays = [value for value in listed if not is_plain_number(value)]
    floating = [value for value in arrays if xp.isdtype(value.dtype, "real floating")]
    dtype = xp.result_type(*floating) if floating else xp.asarray(1.0).dtype
    device = array_api_compat.device(arrays[0]) if arrays else None

    def convert(value: Array) -> Array:
        if is_plain_number(value):
            return xp.asarray(float(value), dtype=dtype, device=device)
        return value if value.dtype == dtype else xp.astype(value, dtype)

    return tuple(convert(value) for value in listed)


def broadcast(x: Array, *values: Array) -> Array:
    """Broadcast `x` against some values; floats among floats stay floats."""
    if type(x) is float and all(type(value) is float for value in values):
        return x
    shape = numpy.broadcast_shapes(*(tuple(getattr(value, "shape", ())) for value in (x, *values)))
    return broadcast_to(x, shape)


def broadcast_to(x: Array, shape: tuple[int, ...]) -> Array:
    """Broadcast `x` to a shape."""
    return x if tuple(x.shape) == shape else namespace(x).broadcast_to(x, shape)


@cache
def gauss_legendre(points: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Compute nodes and weights of the Gauss-Legendre rule on [0, 1]."""
    nodes, weights = numpy.polynomial.legendre.leggauss(points)
    return tuple(float(x) for x in (1 + nodes) / 2), tuple(float(w) for w in weights / 2)


def integral(integrand: Callable[[float], Array], points: int) -> Array:
    """Integrate a function of x over [0, 1] by the Gauss-Legendre rule; its values may be arrays of any library."""
    nodes, weights = gauss_legendre(points)
    return weighted_sum([integrand(node) for node in nodes], weights)


def weighted_sum(values: Sequence[Array], weights: Sequence[float]) -> Array:
    """Sum `weights[i] * values[i]`, a quadrature rule for arrays of any library."""
    total = weights[0] * values[0]
    for value, weight in zip(values[1:], weights[1:], strict=True):
        total = total + weight * value
    return total


def to_numpy(x: Array) -> numpy.ndarray:
    """Convert `x` to a NumPy array in the memory of the host, for output and files."""
    if array_api_compat.is_torch_array(x):
        return numpy.asarray(x.detach().cpu())
    try:
        return numpy.asarray(x)
    except TypeError:  # strict libraries offer DLPack alone
        return numpy.from_dlpack(x)


def to_list(x: Array) -> Any:
    """Convert `x` to lists for JSON: None in place of NaN, and the text "inf" in place of infinity."""
    values = to_numpy(x)
    if values.dtype == bool:
        return values.tolist()
    listed = values.astype(object)
    listed = numpy.where(numpy.isnan(values), numpy.array(None), listed)
    return numpy.where(numpy.isinf(values), numpy.array("inf", dtype=object), listed).tolist()
