"""Compiled loop over arrays of contacts for radial foundations."""

from __future__ import annotations

import math
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
from ..models.table_3 import scaled_modulus
from ..problem import Joint
from .overloads import as_row, compile_loop, inline_formula, pick_element


def solve_forces(model: RadialFoundation, joint: Joint, force: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """Solve a radial foundation for forces: return indentation, pole pressure, half angle and status of each contact.

    The arrays have the common shape of the joint and its loads.
    """
    shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in (*joint.numbers(), force)))
    inputs = [as_row(number, shape) for number in (*joint.numbers()[:5], force)]
    outputs = [numpy.empty(math.prod(shape)) for _ in range(3)]
    status_codes = numpy.empty(math.prod(shape), dtype=numpy.int8)
    constants = tuple(float(number) for number in model.parameters)
    foundation_kernel(model.modulus.formula, model.kinematics)(*inputs, *outputs, status_codes, *constants)
    d, p0, angle = (output.reshape(shape) for output in outputs)
    return d, p0, angle, status_codes.reshape(shape)


@cache
def foundation_kernel(formula: Formula, motion: Kinematics) -> Any:
    """Return the compiled loop over contacts for one modulus and one kinematics. Each input is a number or an array."""
    modulus = inline_formula(formula)
    indentation = inline_formula(motion.indentation)
    force_law = inline_formula(motion.force)
    versine = inline_formula(motion.versine)
    success, failed = numpy.int8(Status.OK), numpy.int8(Status.NOT_REACHED)

    def solve_contacts(R1, c, L, E, nu, F, d_out, p0_out, angle_out, status, *constants):  # type: ignore[no-untyped-def]
        """Solve each contact for its force; write indentation, pole pressure, half angle and status to arrays."""
        for i in range(d_out.size):
            clearance, load = pick_element(c, i), pick_element(F, i)
            R2 = pick_element(R1, i) + clearance
            K = modulus(R2, pick_element(L, i), pick_element(E, i), pick_element(nu, i), *constants)
            d = indentation(R2, clearance, K, load)
            converged = abs(force_law(R2, clearance, K, d) - load) <= 1e-12 * load
            d = d if converged else math.nan
            d_out[i] = d
            p0_out[i] = K * d
            angle_out[i] = kinematics.angle_of(versine(R2, clearance, d))
            status[i] = success if converged else failed

    return compile_loop(solve_contacts)


def _angle_polynomial(versine: float) -> float:
    """Compute the angle in rad, 0 to π/2, from its versine by a polynomial that compilers can vectorise.

    It replaces `kinematics.angle_of`, which calls the C library.

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


overload(kinematics.angle_of, strict=False, jit_options={"forceinline": True})(lambda versine: _angle_polynomial)

for _formula in (
    scaled_modulus,
    kinematics.linear_indentation,
    kinematics.linear_force,
    kinematics.linear_stiffness,
    kinematics.circular_force,
    kinematics.circular_stiffness,
):
    inline_formula(_formula)
