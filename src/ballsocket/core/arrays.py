"""Which array library is this? The few functions the formulas need.

The formulas of this package are written once, with plain arithmetic and the functions below. They run on Python
numbers, NumPy, JAX, PyTorch and any other library that follows the array API standard, and - because the functions
below are all they call - a compiler can be taught to run them on scalars (`ballsocket.compiled`). A Python number stays
one, and takes the quick way of the module `math`; what has no value there is infinite or NaN as in NumPy.
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
"""An array of NumPy, where no other library is let in: inside solvers, in studies and in files."""

_ROUNDING = float(numpy.finfo(float).eps)
_OF_NUMPY = (float, int, numpy.ndarray, numpy.generic)


def is_plain(value: Any) -> bool:
    """Whether `value` is a Python (or NumPy) number, which takes the library and dtype of its neighbours."""
    return isinstance(value, int | float)


def namespace(*values: Array) -> Any:
    """The array library of `values`: NumPy where all of them are plain numbers."""
    if all(isinstance(value, _OF_NUMPY) for value in values):
        return numpy
    arrays = [value for value in values if not is_plain(value)]
    try:
        return array_api_compat.array_namespace(*arrays)
    except TypeError as error:
        kinds = sorted({f"{type(value).__module__.split('.')[0]}.{type(value).__name__}" for value in arrays})
        raise TypeError(f"arrays of one library are needed, got {', '.join(kinds)}") from error


def _elementwise(name: str, of_number: Callable[[float], float]) -> Callable[[Array], Array]:
    """The function of that name, of a Python number or of an array."""

    def function(x: Array) -> Array:
        if type(x) is not float:
            return getattr(namespace(x), name)(x)
        try:
            return of_number(x)
        except (ValueError, OverflowError):
            with numpy.errstate(all="ignore"):
                return float(getattr(numpy, name)(x))

    function.__name__ = name
    return function


exp = _elementwise("exp", math.exp)
log = _elementwise("log", math.log)
log1p = _elementwise("log1p", math.log1p)
sin = _elementwise("sin", math.sin)
cos = _elementwise("cos", math.cos)
tan = _elementwise("tan", math.tan)
atan = _elementwise("atan", math.atan)
asinh = _elementwise("asinh", math.asinh)
asin = _elementwise("asin", math.asin)


def sqrt(x: Array) -> Array:
    """√x. At 0 its derivative is taken as 0, so that a point without load does not make every derivative NaN."""
    if type(x) is float:
        return math.sqrt(x) if x >= 0 else math.nan
    xp = namespace(x)
    if xp is numpy:
        return numpy.sqrt(x)
    return xp.where(x == 0, 0.0 * x, xp.sqrt(where(x == 0, 1.0, x)))


def power(x: Array, exponent: float) -> Array:
    """x^exponent for a positive exponent, with the derivative at 0 as in `sqrt`."""
    if type(x) is float:
        return x**exponent if x >= 0 else math.nan
    if namespace(x) is numpy:
        return x**exponent
    return where(x == 0, 0.0 * x, where(x == 0, 1.0, x) ** exponent)


def atan2(y: Array, x: Array) -> Array:
    if type(y) is float and type(x) is float:
        return math.atan2(y, x)
    return namespace(y, x).atan2(y, x)


def where(condition: Array, this: Array, that: Array) -> Array:
    if type(condition) is bool and type(this) is float and type(that) is float:
        return this if condition else that
    return namespace(condition, this, that).where(condition, this, that)


def clip(x: Array, low: float, high: float) -> Array:
    return min(max(x, low), high) if isinstance(x, float) else namespace(x).clip(x, low, high)


def isfinite(x: Array) -> Array:
    return math.isfinite(x) if type(x) is float else namespace(x).isfinite(x)


def logical_not(condition: Array) -> Array:
    """Where a condition does not hold."""
    return condition ^ True


def safe_divisor(x: Array) -> Array:
    """`x`, and 1 where it is not above zero: a divisor for quotients whose numerator is zero there."""
    return where(x > 0, x, 1.0)


def device(x: Array) -> Any:
    """Where `x` lives."""
    return array_api_compat.device(x)


def machine_epsilon(x: Array) -> float:
    """The relative rounding error of `x`'s dtype."""
    if type(x) is float:
        return _ROUNDING
    return float(namespace(x).finfo(x.dtype).eps)


def concrete_values(x: Array) -> numpy.ndarray | None:
    """The values of `x` as a NumPy array; None where they cannot be known yet (inside `jax.jit`, `jax.grad`)."""
    try:
        return to_numpy(x)
    except (TypeError, RuntimeError):
        return None


def all_true(condition: Array) -> bool | None:
    """Whether all of `condition` holds; None where that cannot be known yet (inside `jax.jit`, `vmap`)."""
    try:
        return condition if isinstance(condition, bool) else bool(namespace(condition).all(condition))
    except (TypeError, RuntimeError):  # JAX's and PyTorch's tracers refuse to be read
        return None


def stop_gradient(x: Array) -> Array:
    """The values of `x`, cut off from automatic differentiation."""
    if array_api_compat.is_torch_array(x):
        return x.detach()
    if array_api_compat.is_jax_array(x):
        import jax

        return jax.lax.stop_gradient(x)
    return x


def to_common_arrays(*values: Array) -> tuple[Array, ...]:
    """`values` as arrays of one library, floating dtype and device: those of the arrays among them.

    Lists and integers are taken as floats. Plain numbers alone become NumPy float64 scalars.
    """
    listed = [numpy.asarray(value) if isinstance(value, list | tuple) else value for value in values]
    xp = namespace(*listed)
    arrays = [value for value in listed if not is_plain(value)]
    floating = [value for value in arrays if xp.isdtype(value.dtype, "real floating")]
    dtype = xp.result_type(*floating) if floating else xp.asarray(1.0).dtype
    device = array_api_compat.device(arrays[0]) if arrays else None

    def converted(value: Array) -> Array:
        if is_plain(value):
            return xp.asarray(float(value), dtype=dtype, device=device)
        return value if value.dtype == dtype else xp.astype(value, dtype)

    return tuple(converted(value) for value in listed)


def broadcast(x: Array, *others: Array) -> Array:
    """`x` in the shape that it and `others` broadcast to; a Python number among such stays one."""
    if type(x) is float and all(type(value) is float for value in others):
        return x
    shape = numpy.broadcast_shapes(*(tuple(getattr(value, "shape", ())) for value in (x, *others)))
    return broadcast_to(x, shape)


def broadcast_to(x: Array, shape: tuple[int, ...]) -> Array:
    """`x` in a given shape."""
    return x if tuple(x.shape) == shape else namespace(x).broadcast_to(x, shape)


@cache
def gauss_legendre(points: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Nodes and weights of the Gauss-Legendre rule on [0, 1]."""
    nodes, weights = numpy.polynomial.legendre.leggauss(points)
    return tuple(float(x) for x in (1 + nodes) / 2), tuple(float(w) for w in weights / 2)


def integral(integrand: Callable[[float], Array], points: int) -> Array:
    """∫ integrand(x) dx over [0, 1] by the Gauss-Legendre rule, for integrands that are arrays of any kind."""
    nodes, weights = gauss_legendre(points)
    return weighted_sum([integrand(node) for node in nodes], weights)


def weighted_sum(values: Sequence[Array], weights: Sequence[float]) -> Array:
    """Sum of `weights[i] * values[i]`: a quadrature rule over any kind of array."""
    total = weights[0] * values[0]
    for value, weight in zip(values[1:], weights[1:], strict=True):
        total = total + weight * value
    return total


def to_numpy(x: Array) -> numpy.ndarray:
    """The values of `x` as a NumPy array on this machine, for people and files."""
    if array_api_compat.is_torch_array(x):
        return numpy.asarray(x.detach().cpu())
    try:
        return numpy.asarray(x)
    except TypeError:  # strict libraries offer DLPack alone
        return numpy.from_dlpack(x)


def to_list(x: Array) -> Any:
    """The values of `x` for JSON, which has no NaN and no infinity: None and the text "inf" stand for them."""
    values = to_numpy(x)
    if values.dtype == bool:
        return values.tolist()
    listed = values.astype(object)
    listed = numpy.where(numpy.isnan(values), numpy.array(None), listed)
    return numpy.where(numpy.isinf(values), numpy.array("inf", dtype=object), listed).tolist()
