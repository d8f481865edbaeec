"""A radial foundation by force over large arrays in one pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy
from numba.extending import overload

from ..core.arrays import Numbers
from ..core.validity import Status
from ..models import kinematics
from ..models.foundation import RadialFoundation
from ..models.kinematics import Kinematics
from ..models.modulus import Formula
from ..models.table_3 import eq_18
from ..problem import Joint
from .teaching import compilable, compiled, flat, pick


def passed(model: RadialFoundation, joint: Joint, force: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """d, K d, ε and the status of every point, in the common shape of a joint of arrays and its loads."""
    shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in (*joint.numbers(), force)))
    inputs = [flat(part, shape) for part in (*joint.numbers()[:5], force)]
    outputs = [numpy.empty(math.prod(shape)) for _ in range(3)]
    codes = numpy.empty(math.prod(shape), dtype=numpy.int8)
    constants = tuple(float(number) for number in model.parameters)
    kernel(model.modulus.formula, model.kinematics)(*inputs, *outputs, codes, *constants)
    d, p0, angle = (output.reshape(shape) for output in outputs)
    return d, p0, angle, codes.reshape(shape)


@cache
def kernel(formula: Formula, motion: Kinematics) -> Any:
    """The compiled pass of one kind of model, for whichever mix of numbers and arrays it is called with."""
    modulus = compilable(formula)
    indentation = compilable(motion.indentation)
    force_law = compilable(motion.force)
    versine = compilable(motion.versine)
    converged, failed = numpy.int8(Status.OK), numpy.int8(Status.NOT_REACHED)

    def run(R1, c, L, E, nu, F, d_out, p0_out, angle_out, status, *constants):  # type: ignore[no-untyped-def]
        for i in range(d_out.size):
            clearance, load = pick(c, i), pick(F, i)
            R2 = pick(R1, i) + clearance
            K = modulus(R2, pick(L, i), pick(E, i), pick(nu, i), *constants)
            d = indentation(R2, clearance, K, load)
            good = abs(force_law(R2, clearance, K, d) - load) <= 1e-12 * load
            d = d if good else math.nan
            d_out[i] = d
            p0_out[i] = K * d
            angle_out[i] = kinematics.angle_of(versine(R2, clearance, d))
            status[i] = converged if good else failed

    return compiled(run)


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
    kinematics.linear_indentation,
    kinematics.linear_force,
    kinematics.linear_stiffness,
    kinematics.circular_force,
    kinematics.circular_stiffness,
):
    compilable(_formula)
