"""The same formulas, compiled: a radial foundation by force over large arrays in one pass.

Needs numba (`pip install 'ballsocket[fast]'`). Nothing is written twice: numba is taught what the few functions of
`ballsocket.arrays` mean for one number, and then compiles the formulas of `models.kinematics` and `models.modulus`
as they stand, in one pass over the inputs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numba
import numpy
from numba.core import types
from numba.extending import overload, register_jitable

from . import arrays
from .arrays import Array
from .contact import Contact
from .joint import Joint
from .model import Answer, Model, checked_load, prepared
from .models import kinematics
from .models.closed_form import Bound
from .models.foundation import RadialFoundation
from .models.kinematics import Kinematics
from .models.modulus import Formula
from .models.table_3 import eq_18
from .sources import Source
from .validity import Range, Status, inside


@dataclass(frozen=True, kw_only=True)
class Compiled(Model):
    """A radial foundation whose `press(joint, force=...)` on NumPy float64 arrays is one compiled pass.

    Everything else (other loads, other array libraries, dtypes, plain numbers) is passed on to the model.

    Parameters
    ----------
    model : RadialFoundation
        For instance `HessForsbach()`.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.compiled import Compiled
    >>> fast = Compiled(model=bs.HessForsbach())
    >>> contact = fast.press(bs.joints["hess-forsbach"], force=numpy.array([1000.0, 3000.0]))
    >>> contact.max_pressure.round(3)
    array([ 5.921, 11.27 ])
    """

    model: RadialFoundation

    def __post_init__(self) -> None:
        if not isinstance(self.model, RadialFoundation):
            raise TypeError(f"model must be a RadialFoundation, such as HessForsbach(), got {self.model!r}")

    @property
    def parameters(self) -> tuple[Array, ...]:
        return self.model.parameters

    @property
    def name(self) -> str:
        return self.model.name

    @property
    def title(self) -> str:
        return self.model.title

    @property
    def sources(self) -> tuple[Source, ...]:
        return self.model.sources

    @property
    def domain(self) -> tuple[Range, ...]:
        return self.model.domain

    @property
    def validity(self) -> tuple[Range, ...]:
        return self.model.validity

    def press(
        self,
        joint: Joint,
        *,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
    ) -> Contact:
        kind, given = checked_load(force=force, indentation=indentation, half_angle=half_angle)
        numbers = (*joint.numbers(), given)
        large = [number for number in numbers if not arrays.is_plain(number)]
        simple = all(arrays.is_plain(number) for number in self.parameters)
        if kind != "force" or not simple or not large or not all(_is_float64(number) for number in large):
            return super().press(joint, force=force, indentation=indentation, half_angle=half_angle)
        return self._pass(joint, given)

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        return self.model._solve(joint, kind, load)

    def _pass(self, joint: Joint, force: Array) -> Contact:
        _, whole, load = prepared(joint, force)
        points = inside(self.domain, whole, self.name)
        shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in (*whole.numbers(), load)))
        inputs = [_flat(number, shape) for number in (*whole.numbers()[:5], load)]
        outputs = [numpy.empty(math.prod(shape)) for _ in range(3)]
        codes = numpy.empty(math.prod(shape), dtype=numpy.int8)
        constants = tuple(float(number) for number in self.parameters)
        _kernel(self.model.modulus.formula, self.model.kinematics)(*inputs, *outputs, codes, *constants)
        d, p0, angle = (output.reshape(shape) for output in outputs)
        status = codes.reshape(shape)
        if self.domain:
            status = numpy.where(points, status, numpy.int8(Status.OUTSIDE_DOMAIN))
            d, p0, angle = (numpy.where(points, part, numpy.nan) for part in (d, p0, angle))
        contact = Contact(
            model=self,
            laws=Bound(model=self.model, joint=whole, indentation=d),
            joint=whole,
            force=numpy.broadcast_to(load, shape),
            indentation=d,
            status=status,
        )
        vars(contact).update(max_pressure=p0, half_angle=angle)
        return contact


def _is_float64(number: Any) -> bool:
    return isinstance(number, numpy.ndarray) and number.dtype == numpy.float64


def _flat(number: Any, shape: tuple[int, ...]) -> Any:
    """One number as it is, an array as one row of the common shape."""
    if numpy.ndim(number) == 0:
        return float(number)
    whole = number if number.shape == shape else numpy.broadcast_to(number, shape)
    return numpy.ascontiguousarray(whole).reshape(-1)


_compilable = register_jitable(forceinline=True)
"""Lets compiled code call a formula as it stands, and puts it into the caller's loop."""


def _pick(part: Any, i: int) -> Any:
    """Element i of an array; a number is the same for all i."""
    return part[i] if isinstance(part, numpy.ndarray) else part


@overload(_pick, strict=False, inline="always")
def _pick_compiled(part: Any, i: Any) -> Callable[..., Any]:
    if isinstance(part, types.Array):
        return lambda part, i: part[i]
    return lambda part, i: part


@cache
def _kernel(formula: Formula, motion: Kinematics) -> Any:
    """The compiled pass of one kind of model, for whichever mix of numbers and arrays it is called with."""
    modulus = _compilable(formula)
    indentation = _compilable(motion.indentation)
    force_law = _compilable(motion.force)
    versine = _compilable(motion.versine)
    converged, failed = numpy.int8(Status.OK), numpy.int8(Status.NOT_REACHED)

    def run(R1, c, L, E, nu, F, d_out, p0_out, angle_out, status, *constants):  # type: ignore[no-untyped-def]
        for i in range(d_out.size):
            clearance, load = _pick(c, i), _pick(F, i)
            R2 = _pick(R1, i) + clearance
            K = modulus(R2, _pick(L, i), _pick(E, i), _pick(nu, i), *constants)
            d = indentation(R2, clearance, K, load)
            good = abs(force_law(R2, clearance, K, d) - load) <= 1e-12 * load
            d = d if good else math.nan
            d_out[i] = d
            p0_out[i] = K * d
            angle_out[i] = kinematics.angle_of(versine(R2, clearance, d))
            status[i] = converged if good else failed

    # contract: a product and a sum may be rounded once; the order of operations stays as written
    return numba.njit(run, error_model="numpy", fastmath={"contract"})


@overload(arrays.sqrt, strict=False)
def _sqrt(x: Any) -> Callable[..., Any]:
    return lambda x: math.sqrt(x)


@overload(arrays.where, strict=False)
def _where(condition: Any, this: Any, that: Any) -> Callable[..., Any]:
    return lambda condition, this, that: this if condition else that


@overload(arrays.clip, strict=False)
def _clip(x: Any, low: Any, high: Any) -> Callable[..., Any]:
    return lambda x, low, high: min(max(x, low), high)


@overload(kinematics.angle_of, strict=False, jit_options={"forceinline": True})
def _angle_of(versine: Any) -> Callable[..., Any]:
    return _angle_polynomial


def _angle_polynomial(versine: float) -> float:
    """`kinematics.angle_of` up to π/2 without a call into the C library, so that several are computed at once.

    ε = sqrt(2v) P(v); P is asin(x)/x of x = sqrt(v/2) fitted in Chebyshev polynomials over v from 0 to 1, to 1.4e-16:
    `mpmath.chebyfit` of 18 terms in 50 digits.
    """
    p = 5.3808098398167465e-06
    p = p * versine - 3.6946632563759546e-05
    p = p * versine + 0.00012100726393978694
    p = p * versine - 0.00024256787149814154
    p = p * versine + 0.00033365819930609243
    p = p * versine - 0.0003262055706979571
    p = p * versine + 0.00024170243545992032
    p = p * versine - 0.00012117413285500441
    p = p * versine + 7.179378545774666e-05
    p = p * versine + 2.908058015756967e-05
    p = p * versine + 0.00011269686358655027
    p = p * versine + 0.0002705562428799403
    p = p * versine + 0.000699195178549289
    p = p * versine + 0.001898866700217143
    p = p * versine + 0.005580357359544115
    p = p * versine + 0.018749999994887395
    p = p * versine + 0.083333333333381
    p = p * versine + 0.9999999999999999
    return math.sqrt(2 * versine) * p


for _formula in (
    eq_18,
    arrays.divisor,
    kinematics.linear_indentation,
    kinematics.linear_force,
    kinematics.circular_force,
    kinematics.circular_stiffness,
):
    _compilable(_formula)
