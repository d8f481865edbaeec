"""Compiled loops over arrays of contacts for radial foundations, `Refined` and `Tabulated`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy
from numba.extending import overload

from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..core.validity import Status
from ..elasticity.exact.tabulated import chebyshev, curves
from ..elasticity.exact.tabulated.curves import (
    CurveCoefficients,
    JointCurves,
    Scale,
    angle_of_force,
    angle_of_indentation,
    contact_quantities,
)
from ..elasticity.exact.tabulated.model import Tabulated
from ..models import kinematics, liner_compliance, refined_state
from ..models.foundation import RadialFoundation
from ..models.kinematics import Kinematics
from ..models.liner_compliance import liner_coefficients
from ..models.modulus import Formula
from ..models.refined import RefinedSolution, make_solver_result, scaled_load
from ..models.refined_state import ScaledContact, half_angle_of_force, half_angle_of_indentation, scaled_contact
from ..models.table_3 import scaled_modulus
from ..problem import Joint
from .overloads import as_row, compile_loop, inline_formula, jit_formula, pick_element


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
    """Return the compiled loop over contacts for one modulus and one kinematics.

    Each input is a number or an array.
    """
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


@overload(kinematics.angle_of, strict=False, jit_options={"forceinline": True})
def _overload_angle_of(versine: Any) -> Callable[..., Any]:
    """Replace `kinematics.angle_of` by a polynomial in compiled code."""
    return _angle_polynomial


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


def solve_refined(joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """Solve the model `Refined` in one compiled loop, for arrays of forces or indentations."""
    shape = numpy.broadcast_shapes(*(number.shape for number in (*joint.numbers(), load)))
    radius_ratio = 1 + joint.liner_thickness / joint.socket_radius
    inputs = (load, scaled_load(joint, kind, load), joint.liner.poisson, radius_ratio)
    outputs = numpy.empty((1 + len(ScaledContact._fields), math.prod(shape)))
    _refined_kernel(kind)(*(as_row(number, shape) for number in inputs), outputs)
    edge, *state = (output.reshape(shape) for output in outputs)
    solution = RefinedSolution(joint=joint, edge=edge)
    vars(solution)["_scaled_contact"] = ScaledContact(*state)
    return make_solver_result(solution, kind, load)


@cache
def _refined_kernel(kind: str) -> Any:
    """Return the compiled loop over contacts of `Refined` for given forces or indentations."""
    solve = half_angle_of_force if kind == "force" else half_angle_of_indentation

    def solve_contacts(load, scaled, poisson, radius_ratio, outputs):  # type: ignore[no-untyped-def]
        """Solve each contact for its load; write its half angle and the fields of `ScaledContact` to `outputs`."""
        for i in range(outputs.shape[1]):
            liner = liner_coefficients(pick_element(poisson, i), pick_element(radius_ratio, i))
            edge = solve(pick_element(scaled, i), liner) if pick_element(load, i) > 0 else 0.0
            state = scaled_contact(edge if edge > 0 else 1.0, liner)
            outputs[0, i] = edge
            outputs[1, i], outputs[2, i], outputs[3, i], outputs[4, i] = state[0], state[1], state[2], state[3]
            outputs[5, i], outputs[6, i], outputs[7, i] = state[4], state[5], state[6]

    return compile_loop(solve_contacts)


@overload(refined_state.log_compliances, strict=False)
def _overload_log_compliances(half_angle: Any, liner: Any, waves: Any) -> Callable[..., Any]:
    """Replace `log_compliances` by its scalar version in compiled code."""
    return refined_state.scalar_log_compliances


def solve_tabulated(model: Tabulated, joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """Solve the model `Tabulated` in one compiled loop, for arrays of forces or indentations."""

    def read_curves(curves: JointCurves, load: Numbers) -> tuple[Numbers, ...]:
        """Compute half angle, indentation, force, pole pressure and stiffness of contacts: five arrays (contacts,)."""
        inputs = (curves.scaled_load(kind, load), curves.ratio, *curves.scale)
        outputs = numpy.empty((5, len(load)))
        _tabulated_kernel(kind)(*(as_row(number, load.shape) for number in inputs), curves.functions, outputs)
        return tuple(outputs)

    return model.solve_with_reader(joint, kind, load, read_curves)


@cache
def _tabulated_kernel(kind: str) -> Any:
    """Return the compiled loop over contacts of `Tabulated` for given forces or indentations."""
    solve = angle_of_force if kind == "force" else angle_of_indentation

    def solve_contacts(load, ratio, clearance, area, compliance, series, outputs):  # type: ignore[no-untyped-def]
        """Solve each contact for its load; write half angle, indentation, force, pole pressure and stiffness."""
        step = 0 if series.shape[2] == 1 else 1
        functions = series[:, :, 0].copy()
        for i in range(outputs.shape[1]):
            functions[:] = series[:, :, step * i]
            curve = CurveCoefficients(pick_element(ratio, i), functions, functions)
            angle = solve(pick_element(load, i), curve)
            scale = Scale(pick_element(clearance, i), pick_element(area, i), pick_element(compliance, i))
            d, F, p0, stiffness, _ = contact_quantities(angle, curve, scale)
            outputs[0, i], outputs[1, i], outputs[2, i], outputs[3, i], outputs[4, i] = angle, d, F, p0, stiffness

    return compile_loop(solve_contacts)


@overload(curves.evaluate_table_functions, strict=False)
def _overload_evaluate(angle: Any, curve: Any, rows: Any) -> Callable[..., Any]:
    """Implement the evaluation of the first one, two or three tabulated functions in compiled code."""
    if rows.count == 1:
        return lambda angle, curve, rows: _evaluate_table_functions(angle, curve)[:1]
    if rows.count == 2:
        return lambda angle, curve, rows: _evaluate_table_functions(angle, curve)[:2]
    return lambda angle, curve, rows: _evaluate_table_functions(angle, curve)


@inline_formula
def _evaluate_table_functions(angle, curve):  # type: ignore[no-untyped-def]
    """Evaluate the tabulated opening, force and pole pressure, and their slopes by ln ε, at a half angle.

    They are Chebyshev series. The recurrences are T_k+1 = 2x T_k - T_k-1 and T_k' = k U_k-1.
    """
    root = chebyshev.angle_root(angle, curve.ratio)
    x = 2 * root - 1
    c, twice = curve.functions, 2 * x
    T, T_next, U, U_next = 1.0, x, 1.0, twice
    opening, force, pole = c[0, 0] + c[0, 1] * x, c[1, 0] + c[1, 1] * x, c[2, 0] + c[2, 1] * x
    opening_slope, force_slope, pole_slope = c[0, 1], c[1, 1], c[2, 1]
    for k in range(2, c.shape[1]):
        T, T_next = T_next, twice * T_next - T
        rise = k * U_next
        opening += c[0, k] * T_next
        force += c[1, k] * T_next
        pole += c[2, k] * T_next
        opening_slope += c[0, k] * rise
        force_slope += c[1, k] * rise
        pole_slope += c[2, k] * rise
        U, U_next = U_next, twice * U_next - U
    rate = curves.angle_derivative(angle, root, curve.ratio)
    return (
        (opening, rate * opening_slope),
        (force, rate * force_slope),
        (pole, rate * pole_slope),
    )


for _formula in (
    scaled_modulus,
    kinematics.linear_indentation,
    kinematics.linear_force,
    kinematics.linear_stiffness,
    kinematics.circular_force,
    kinematics.circular_stiffness,
):
    inline_formula(_formula)

for _long_formula in (
    liner_compliance.liner_coefficients,
    liner_compliance.log_compliance,
    liner_compliance._scaled_polynomial,
    liner_compliance.log_compliance_any_wave,
    liner_compliance._log_compliance_near_one,
    liner_compliance._reduced_polynomial,
    liner_compliance._decay_mean,
    liner_compliance._evaluate_polynomial,
    refined_state.scalar_log_compliances,
    refined_state.log_slopes,
    refined_state._log_compliance,
    refined_state._edge_displacement,
    refined_state._pressure_exponent,
    refined_state.angle_derivative,
    refined_state.scaled_contact,
    refined_state._solve_half_angle,
    refined_state._indentation_residual,
    refined_state._force_residual,
    refined_state.half_angle_of_indentation,
    refined_state.half_angle_of_force,
    chebyshev.angle_root,
    curves.angle_derivative,
    curves.opening,
    curves.contact_quantities,
    curves._solve_angle,
    curves._indentation_residual,
    curves._force_residual,
    curves.angle_of_indentation,
    curves.angle_of_force,
):
    jit_formula(_long_formula)
