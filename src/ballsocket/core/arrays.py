"""Elementary functions of Python numbers and of arrays of any library.

The formulas of this package are written once, with plain arithmetic and the functions below. They run on Python
numbers, NumPy, JAX, PyTorch and any other library that follows the array API standard. `ballsocket.compiled` compiles
the same functions for scalars. The result of Python floats is a Python float from the module `math`; it is infinite or
NaN, as in NumPy, where `math` raises.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from typing import Any

import array_api_compat
import numpy
from array_api_compat import device as device
from array_api_compat import is_jax_array as is_jax_array

Array = Any  # a Python number or an array of any library that follows the array API standard
Numbers = numpy.ndarray  # a NumPy array, in code that accepts no other library: solvers, studies and files

_DOUBLE_EPSILON = float(numpy.finfo(float).eps)  # relative rounding error of double precision
_NUMPY_TYPES = (float, int, numpy.ndarray, numpy.generic)  # types whose array library is NumPy


def is_plain_number(value: Any) -> bool:
    """Check if a value is a Python number and not an array.

    NumPy float64 scalars and booleans count as numbers. Such a number adopts the library and dtype of other operands.
    """
    return isinstance(value, int | float)


def namespace(*values: Array) -> Any:
    """Return the array library of the given values, such as NumPy or JAX; NumPy for plain numbers.

    Raises TypeError: arrays of several libraries.
    """
    if all(isinstance(value, _NUMPY_TYPES) for value in values):
        return numpy
    arrays = [value for value in values if not is_plain_number(value)]
    try:
        return array_api_compat.array_namespace(*arrays)
    except TypeError as error:
        kinds = sorted({f"{type(value).__module__.split('.')[0]}.{type(value).__name__}" for value in arrays})
        hint = ": use .to_numpy()" if any(hasattr(value, "to_numpy") for value in arrays) else ""
        raise TypeError(f"all arrays must be of one library, got {', '.join(kinds)}{hint}") from error


def _make_elementwise(name: str, scalar_function: Callable[[float], float]) -> Callable[[Array], Array]:
    """Make an elementwise function, such as `exp`, for Python numbers and arrays of any library."""

    def elementwise_function(x: Array) -> Array:
        """Evaluate the function at each element of x; infinite or NaN where `math` raises an error."""
        if type(x) is not float:
            return getattr(namespace(x), name)(x)
        try:
            return scalar_function(x)
        except (ValueError, OverflowError):
            with numpy.errstate(all="ignore"):
                return float(getattr(numpy, name)(x))

    elementwise_function.__name__ = name
    return elementwise_function


exp = _make_elementwise("exp", math.exp)
log = _make_elementwise("log", math.log)
log1p = _make_elementwise("log1p", math.log1p)
sin = _make_elementwise("sin", math.sin)
cos = _make_elementwise("cos", math.cos)
tan = _make_elementwise("tan", math.tan)
atan = _make_elementwise("atan", math.atan)
asinh = _make_elementwise("asinh", math.asinh)
asin = _make_elementwise("asin", math.asin)


def short_sine(x: Array) -> Array:
    """Compute sin x for |x| up to 0.75; of arrays by a series, which takes compilers a tenth of the time of `sin`."""
    return math.sin(x) if type(x) is float else short_sine_series(x)


def short_sine_series(x: Array) -> Array:
    """Compute sin x for |x| up to 0.75 by its Taylor series, to rounding errors."""
    z = x * x
    p = -1 / 1307674368000
    p = p * z + 1 / 6227020800
    p = p * z - 1 / 39916800
    p = p * z + 1 / 362880
    p = p * z - 1 / 5040
    p = p * z + 1 / 120
    p = p * z - 1 / 6
    return x + x * z * p


def sqrt(x: Array) -> Array:
    """Compute the square root √x; its derivative at x = 0 is set to 0.

    Points without load therefore do not turn gradients into NaN. The root of a negative number is NaN.
    """
    if type(x) is float:
        return math.sqrt(x) if x >= 0 else math.nan
    xp = namespace(x)
    if xp is numpy:
        return numpy.sqrt(x)
    return xp.where(x == 0, 0.0 * x, xp.sqrt(where(x == 0, 1.0, x)))


def power(x: Array, exponent: float) -> Array:
    """Compute x^exponent for a positive exponent; its derivative at x = 0 is set to 0 as in `sqrt`."""
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
    """Select the elements of `if_true` where a mask is true, and of `if_false` elsewhere."""
    if type(condition) is bool and type(if_true) is float and type(if_false) is float:
        return if_true if condition else if_false
    return namespace(condition, if_true, if_false).where(condition, if_true, if_false)


def clip(x: Array, low: float, high: float) -> Array:
    """Limit the elements of x to the interval from low to high."""
    return min(max(x, low), high) if isinstance(x, float) else namespace(x).clip(x, low, high)


def isfinite(x: Array) -> Array:
    """Return a mask that is true for elements that are neither infinite nor NaN."""
    return math.isfinite(x) if type(x) is float else namespace(x).isfinite(x)


def logical_not(condition: Array) -> Array:
    """Invert a boolean mask."""
    return condition ^ True


def repeat_step(step: Callable[[Any], Any], state: Any, count: int) -> Any:
    """Apply a step to a state `count` times; for a state of JAX arrays as one loop, which compiles faster.

    The state is a tuple, also a named one, whose first item is an array.
    """
    if is_jax_array(state[0]):
        import jax

        return jax.lax.fori_loop(0, count, lambda _, current: step(current), state)
    for _ in range(count):
        state = step(state)
    return state


def map_jax_blocks(
    function: Callable[..., tuple[Array, ...]], rows: Sequence[Array], stored_numbers: int
) -> tuple[Array, ...]:
    """Apply a function to rows inside `jax.jit`, block by block in one loop, so that one block is compiled.

    The function takes as many rows, arrays (1,) or (n,), and returns arrays (..., n). Of the given rows, (1,) or
    (contacts,), the last one has the shape (contacts,). The function stores `stored_numbers` values for each contact.
    """
    import jax

    count = rows[-1].shape[0]
    size = _JAX_BLOCKS.get(jax.default_backend(), _JAX_BLOCK_BYTES // (8 * stored_numbers))
    if count <= size:
        return function(*rows)

    def apply_to_block(parts: list[Array]) -> tuple[Array, ...]:
        """Apply the function to one block of the rows that vary."""
        remaining = iter(parts)
        return function(*(row if row.shape[0] == 1 else next(remaining) for row in rows))

    varying = [row for row in rows if row.shape[0] > 1]
    padded = [jax.numpy.pad(row, (0, -count % size), mode="edge").reshape(-1, size) for row in varying]
    values = jax.lax.map(apply_to_block, padded)
    return tuple(jax.numpy.moveaxis(part, 0, -2).reshape(*part.shape[1:-1], -1)[..., :count] for part in values)


_JAX_BLOCKS = {"cpu": 4000}
"""Number of contacts in one block by the platform of JAX; on a CPU, the numbers of a block stay in the cache."""

_JAX_BLOCK_BYTES = 2**30
"""Size of the values that one block stores on other platforms. Small blocks would leave a GPU idle between kernels."""


def safe_divisor(x: Array) -> Array:
    """Replace zero and negative elements, at which the numerator must be 0, by 1 to avoid a division by zero."""
    return where(x > 0, x, 1.0)


def convert_like(values: numpy.ndarray, like: Array) -> Array:
    """Convert NumPy values to the library, dtype and device of another array."""
    xp = namespace(like)
    if xp is numpy and like.dtype == values.dtype:
        return values
    return xp.asarray(values, dtype=like.dtype, device=device(like))


def machine_epsilon(x: Array) -> float:
    """Return the relative rounding error of the dtype of `x`."""
    if type(x) is float:
        return _DOUBLE_EPSILON
    return float(namespace(x).finfo(x.dtype).eps)


def concrete_values(x: Array) -> numpy.ndarray | None:
    """Convert `x` to a NumPy array; return None if `x` is traced (inside `jax.jit`, `jax.grad`)."""
    try:
        return to_numpy(x)
    except (TypeError, RuntimeError):
        return None


def all_true(condition: Array) -> bool | None:
    """Check if all elements are true; return None if they are traced (inside `jax.jit`, `torch.compile`, `vmap`)."""
    if isinstance(condition, bool):
        return condition
    if _is_in_torch_compile(condition):
        return None
    try:
        return bool(namespace(condition).all(condition))
    except (TypeError, RuntimeError):  # tracers of JAX and PyTorch have no value
        return None


def silent_numpy(x: Array) -> AbstractContextManager[Any]:
    """Return a context without warnings of NumPy; it has no effect inside `torch.compile`, which does not trace it."""
    return nullcontext() if _is_in_torch_compile(x) else numpy.errstate(all="ignore")


def _is_in_torch_compile(x: Array) -> bool:
    """Check if `x` is an array of PyTorch inside `torch.compile`, where its values are unknown."""
    if not array_api_compat.is_torch_array(x):
        return False
    import torch

    return bool(torch.compiler.is_compiling())


def without_gradients(x: Array) -> AbstractContextManager[Any]:
    """Return a context in which PyTorch records no operations; it has no effect on other libraries."""
    if not array_api_compat.is_torch_array(x):
        return nullcontext()
    import torch

    return torch.no_grad()


def stop_gradient(x: Array) -> Array:
    """Return `x` as a constant for automatic differentiation: its derivative is 0."""
    if array_api_compat.is_torch_array(x):
        return x.detach()
    if is_jax_array(x):
        import jax

        return jax.lax.stop_gradient(x)
    return x


def to_common_arrays(*values: Array) -> tuple[Array, ...]:
    """Convert values to arrays of one library, floating dtype and device.

    The arrays among the values determine all three.

    Lists and integers become floats. Plain numbers without an array become NumPy float64 scalars.
    """
    converted = [numpy.asarray(value) if isinstance(value, list | tuple) else value for value in values]
    xp = namespace(*converted)
    arrays = [value for value in converted if not is_plain_number(value)]
    float_arrays = [value for value in arrays if xp.isdtype(value.dtype, "real floating")]
    dtype = xp.result_type(*float_arrays) if float_arrays else xp.asarray(1.0).dtype
    device = array_api_compat.device(arrays[0]) if arrays else None

    def convert_value(value: Array) -> Array:
        if is_plain_number(value):
            return xp.asarray(float(value), dtype=dtype, device=device)
        return value if value.dtype == dtype else xp.astype(value, dtype)

    return tuple(convert_value(value) for value in converted)


def owned(x: Array) -> Array:
    """Return a copy of an array that nobody else changes: read-only in NumPy, whose writable arrays are copied."""
    if type(x) is numpy.ndarray:
        if x.flags.writeable or x.base is not None:
            x = x.copy()
            x.flags.writeable = False
        return x
    return x.clone() if array_api_compat.is_torch_array(x) else x


def read_only(x: Array) -> Array:
    """Return a view of a NumPy array whose elements cannot be changed, and any other value itself."""
    if type(x) is not numpy.ndarray or not x.flags.writeable:
        return x
    view = x.view()
    view.flags.writeable = False
    return view


def broadcast(x: Array, *values: Array) -> Array:
    """Broadcast `x` to the common shape of `x` and other values; return a float if all are floats."""
    if {*map(type, (x, *values))} == {float}:
        return x
    shape = numpy.broadcast_shapes(*(tuple(getattr(value, "shape", ())) for value in (x, *values)))
    return broadcast_to(x, shape)


def broadcast_to(x: Array, shape: tuple[int, ...]) -> Array:
    """Broadcast `x` to a given shape."""
    return x if tuple(x.shape) == shape else namespace(x).broadcast_to(x, shape)


@cache
def gauss_legendre(points: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Compute nodes and weights of the Gauss-Legendre quadrature on [0, 1]."""
    nodes, weights = numpy.polynomial.legendre.leggauss(points)
    return tuple(float(x) for x in (1 + nodes) / 2), tuple(float(w) for w in weights / 2)


def integral(integrand: Callable[[float], Array], points: int) -> Array:
    """Integrate a function with values of any array library over [0, 1] by Gauss-Legendre quadrature."""
    nodes, weights = gauss_legendre(points)
    return weighted_sum([integrand(node) for node in nodes], weights)


def weighted_sum(values: Sequence[Array], weights: Sequence[float]) -> Array:
    """Compute the weighted sum of values, such as a quadrature, for arrays of any library."""
    total = weights[0] * values[0]
    for value, weight in zip(values[1:], weights[1:], strict=True):
        total = total + weight * value
    return total


def to_numpy(x: Array) -> numpy.ndarray:
    """Convert an array of any library to a NumPy array in host memory, for output and files."""
    if array_api_compat.is_torch_array(x):
        return numpy.asarray(x.detach().cpu())
    try:
        return numpy.asarray(x)
    except TypeError:  # strict libraries offer DLPack alone
        return numpy.from_dlpack(x)


def to_list(x: Array) -> Any:
    """Convert an array to nested lists for JSON, with None for NaN and the text "inf" for infinity."""
    values = to_numpy(x)
    if values.dtype.kind in "bOUS":
        return values.tolist()
    listed = values.astype(object)
    listed = numpy.where(numpy.isnan(values), numpy.array(None), listed)
    return numpy.where(numpy.isinf(values), numpy.array("inf", dtype=object), listed).tolist()
