"""Numba overloads of the scalar functions of `ballsocket.core.arrays`, and registration of formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import FunctionType
from typing import Any

import numba
import numpy
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, overload, register_jitable

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


def _overload_elementwise(scalar_function: Callable[[float], float]) -> Callable[..., Any]:
    return lambda x: lambda x: scalar_function(x)


for _name in ("sqrt", "exp", "log", "log1p", "sin", "cos", "asin"):
    overload(getattr(arrays, _name), strict=False)(_overload_elementwise(getattr(math, _name)))


_FOR_NUMBERS: dict[Any, Callable[..., Any]] = {
    arrays.atan2: lambda y, x: lambda y, x: math.atan2(y, x),
    arrays.where: lambda condition, yes, no: lambda condition, yes, no: yes if condition else no,
    arrays.clip: lambda x, low, high: lambda x, low, high: min(max(x, low), high),
    arrays.all_true: lambda condition: lambda condition: condition,
    arrays.logical_not: lambda condition: lambda condition: not condition,
}
"""Functions for numbers in compiled code: the outer one receives types, the inner one is compiled."""

for _function, _implementation in _FOR_NUMBERS.items():
    overload(_function, strict=False)(_implementation)
overload(arrays.short_sine, strict=False, jit_options={"forceinline": True})(lambda x: arrays.short_sine_series)


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


# Functions without branches, so that compiled loops compute several numbers at once by vector instructions. The C
# library takes one number at a time. Errors are about one unit in the last place.


@intrinsic
def _to_bits(context: Any, number: Any) -> Any:
    return types.uint64(types.float64), lambda _, builder, __, values: builder.bitcast(values[0], ir.IntType(64))


@intrinsic
def _from_bits(context: Any, bits: Any) -> Any:
    return types.float64(types.uint64), lambda _, builder, __, values: builder.bitcast(values[0], ir.DoubleType())


_ROUND = 6755399441055744.0  # number 1.5·2^52: a sum with it is rounded to an integer, which its lowest bits hold

_ROUND_BITS = 0x4338000000000000
_EXPONENT_BIAS = 1023
_LOG2_E = 1 / math.log(2)
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""Natural logarithm of 2 in two parts; the first has zeros at its end."""


@inline_formula
def _power_of_two(exponent):  # type: ignore[no-untyped-def]
    """Compute 2 to an integer exponent between -1022 and 1023, which is a float."""
    bits = _to_bits(exponent + _ROUND) - types.uint64(_ROUND_BITS - _EXPONENT_BIAS)
    return _from_bits(bits << types.uint64(52))


@inline_formula
def _mantissa_and_exponent(x):  # type: ignore[no-untyped-def]
    bits = _to_bits(x)
    mantissa = (bits & types.uint64(0x000FFFFFFFFFFFFF)) | types.uint64(0x3FE0000000000000)
    return _from_bits(mantissa), types.int64(bits >> types.uint64(52)) - (_EXPONENT_BIAS - 1)


def frexp(x: float) -> tuple[float, int]:
    """Return the mantissa of a positive normal number, from 1/2 to 1, and its binary exponent."""
    return math.frexp(x)


overload(frexp, strict=False, jit_options={"forceinline": True})(lambda x: _mantissa_and_exponent)


@inline_formula
def exp(x):  # type: ignore[no-untyped-def]
    """Compute e^x."""
    x = 710.0 if x > 710.0 else x
    x = -746.0 if x < -746.0 else x
    exponent = (x * _LOG2_E + _ROUND) - _ROUND
    r = (x - exponent * _LN2_HIGH) - exponent * _LN2_LOW
    p = 1 / 6227020800
    p = p * r + 1 / 479001600
    p = p * r + 1 / 39916800
    p = p * r + 1 / 3628800
    p = p * r + 1 / 362880
    p = p * r + 1 / 40320
    p = p * r + 1 / 5040
    p = p * r + 1 / 720
    p = p * r + 1 / 120
    p = p * r + 1 / 24
    p = p * r + 1 / 6
    p = p * r + 0.5
    p = p * (r * r) + r + 1.0
    half = (exponent * 0.5 + _ROUND) - _ROUND
    return p * _power_of_two(half) * _power_of_two(exponent - half)


@inline_formula
def log(x):  # type: ignore[no-untyped-def]
    """Compute the natural logarithm of x (the coefficients are those of FreeBSD's e_log.c)."""
    tiny = x < 2.2250738585072014e-308
    bits = _to_bits(x * 18014398509481984.0 if tiny else x)
    shifted = bits + types.uint64(0x3FF0000000000000 - 0x3FE6A09E667F3BCD)  # mantissa between sqrt(1/2) and sqrt(2)
    exponent = _from_bits((shifted >> types.uint64(52)) | types.uint64(0x4330000000000000)) - 4503599627371519.0
    exponent = exponent - 54.0 if tiny else exponent
    mantissa = (shifted & types.uint64(0x000FFFFFFFFFFFFF)) + types.uint64(0x3FE6A09E667F3BCD)
    f = _from_bits(mantissa) - 1.0
    s = f / (2.0 + f)
    z = s * s
    p = 1.479819860511658591e-01
    p = p * z + 1.531383769920937332e-01
    p = p * z + 1.818357216161805012e-01
    p = p * z + 2.222219843214978396e-01
    p = p * z + 2.857142874366239149e-01
    p = p * z + 3.999999999940941908e-01
    p = p * z + 6.666666666666735130e-01
    half_square = 0.5 * f * f
    value = exponent * _LN2_HIGH - ((half_square - (s * (half_square + p * z) + exponent * _LN2_LOW)) - f)
    value = value if x < math.inf else x
    value = value if x > 0.0 else math.nan
    return -math.inf if x == 0.0 else value


@inline_formula
def log1p(x):  # type: ignore[no-untyped-def]
    """Compute ln(1 + x), accurate for small x."""
    total = 1.0 + x
    rounded = total - 1.0
    safe = 1.0 if rounded == 0.0 else rounded
    value = log(total) * (x / safe)
    return x if (rounded == 0.0) | (x == math.inf) else value


_HALF_PI = (1.5707963267341256, 6.077100506506192e-11)  # π/2 in two parts; the first has zeros at its end


@inline_formula
def _sine_and_cosine(x):  # type: ignore[no-untyped-def]
    """Compute sine and cosine of x, less its multiple of π/2, and the remainder of this multiple divided by 4."""
    quarters = (x * (2 / math.pi) + _ROUND) - _ROUND
    r = (x - quarters * _HALF_PI[0]) - quarters * _HALF_PI[1]
    z = r * r
    s = 1.58962301576546568060e-10
    s = s * z - 2.50507477628578072866e-08
    s = s * z + 2.75573136213857245213e-06
    s = s * z - 1.98412698295895385996e-04
    s = s * z + 8.33333333332211858878e-03
    s = s * z - 1.66666666666666307295e-01
    c = -1.13585365213876817300e-11
    c = c * z + 2.08757008419747316778e-09
    c = c * z - 2.75573141792967388112e-07
    c = c * z + 2.48015872888517045348e-05
    c = c * z - 1.38888888888730564116e-03
    c = c * z + 4.16666666666665929218e-02
    quarter = _to_bits(quarters + _ROUND) & types.uint64(3)
    return r + r * z * s, 1.0 - (0.5 * z - z * z * c), quarter


@inline_formula
def sin(x):  # type: ignore[no-untyped-def]
    """Compute the sine of an angle of up to some thousand turns (coefficients of FreeBSD's k_sin.c, k_cos.c)."""
    s, c, quarter = _sine_and_cosine(x)
    value = s if (quarter & types.uint64(1)) == types.uint64(0) else c
    return value if quarter < types.uint64(2) else -value


@inline_formula
def cos(x):  # type: ignore[no-untyped-def]
    """Compute the cosine of an angle of up to some thousand turns."""
    s, c, quarter = _sine_and_cosine(x)
    value = c if (quarter & types.uint64(1)) == types.uint64(0) else s
    return -value if (quarter == types.uint64(1)) | (quarter == types.uint64(2)) else value


VECTOR_FUNCTIONS: dict[str, Any] = {"exp": exp, "log": log, "log1p": log1p, "sin": sin, "cos": cos} | {"frexp": frexp}
"""Functions without branches by the name of the function of `ballsocket.core.arrays` that they replace."""


def vector_formula(formula: Any, functions: dict[str, Any]) -> Any:
    """Return a formula, registered for compiled code, that calls other functions by the same names."""
    names = {**formula.__globals__, **functions}
    return inline_formula(FunctionType(formula.__code__, names, formula.__name__, formula.__defaults__))


def zero_setter(indices: tuple[int, ...]) -> Any:
    """Return a function of a named tuple of floats that tells the compiler which of them are 0.

    Compiled code then has no branches for them. In Python the function returns its argument.
    """

    def set_zeros(numbers: Any) -> Any:
        return numbers

    @intrinsic
    def insert_zeros(_: Any, numbers: Any) -> Any:
        def generate(_: Any, builder: Any, __: Any, values: Any) -> Any:
            for index in indices:
                values = [builder.insert_value(values[0], ir.Constant(ir.DoubleType(), 0.0), index)]
            return values[0]

        return numbers(numbers), generate

    overload(set_zeros)(lambda numbers: lambda numbers: insert_zeros(numbers))  # type: ignore[call-arg]
    return set_zeros
