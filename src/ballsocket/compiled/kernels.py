"""Compiled loops over arrays of contacts for radial foundations, `Refined` and `Tabulated`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy
from numba import literal_unroll
from numba.extending import overload

from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..core.validity import Status
from ..elasticity.exact.tabulated import chebyshev, curves, inverse
from ..elasticity.exact.tabulated.curves import JointCurves, Scale, Widest
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
from .overloads import (
    VECTOR_FUNCTIONS,
    as_row,
    compile_loop,
    inline_formula,
    jit_formula,
    pick_element,
    vector_formula,
)


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
    steps = inverse.RIGID_STEPS if joint.ball is None else inverse.ELASTIC_STEPS

    def read_curves(curves: JointCurves, load: Numbers) -> tuple[Numbers, ...]:
        """Compute half angle, indentation, force, pole pressure and stiffness of contacts: five arrays (contacts,)."""
        inputs = (curves.scaled_load(kind, load), curves.ratio, *curves.widest, *curves.scale)
        start, functions = inverse.start_series(curves, kind), curves.functions
        if functions.shape[2] == 1:
            inputs, start, functions = tuple(map(_as_number, inputs)), start[:, 0].copy(), functions[:, :, 0].copy()
        outputs = numpy.empty((5, len(load)))
        rows = tuple(as_row(number, load.shape) for number in inputs)
        _tabulated_kernel(kind)(rows, start, functions, steps, outputs)
        return tuple(outputs)

    return model.solve_with_reader(joint, kind, load, read_curves, single_joint_block=max(load.size, 1))


def _as_number(values: Numbers) -> Any:
    """Return the number in an array of one element; another array itself."""
    return values.item() if values.size == 1 else values


class _EvaluatedCurve(NamedTuple):
    """Tabulated functions and their slopes by ln ε at the half angle of one contact, in compiled code."""

    share: float
    share_slope: float
    force: float
    force_slope: float
    pole: float


_LANES = 128
"""Number of contacts that each inner loop of the tables handles; their values stay in the cache.

All values are rows of one array: several arrays might overlap, and then LLVM makes no vector instructions.
"""

_INPUT_COUNT = 7
_LOAD, _RATIO, _OPENING, _FORCE, _CLEARANCE, _AREA, _COMPLIANCE = range(_INPUT_COUNT)
"""Rows of the inputs."""

_ANGLE, _INDENTATION, _RESULT_FORCE, _POLE_PRESSURE, _STIFFNESS = range(7, 12)
"""Rows of the results."""

_X, _ROOT, _WIDENING, _VALUES, _SLOPES = 12, 13, 14, 15, 18
"""Rows of coordinate, unknown, its derivative, three functions and three slopes."""

_WAVE, _NEXT_WAVE, _RISE, _NEXT_RISE = range(21, 25)
"""Rows of the Chebyshev polynomials."""

_ROW_COUNT = 25


_VECTOR_FORMULAS = dict(VECTOR_FUNCTIONS)
"""Elementary functions and formulas of the tables, by name, that compile to vector instructions."""

for _tabulated_formula in (
    chebyshev.angle_root,
    curves.angle_derivative,
    curves.opening,
    curves.contact_quantities,
    inverse.start_coordinate,
    inverse.start_root,
    inverse.half_angle_of_root,
    inverse.limited_newton_step,
    *(each for functions in inverse.INVERSES.values() for each in (functions.residual, functions.log_share)),
):
    _VECTOR_FORMULAS[_tabulated_formula.__name__] = vector_formula(_tabulated_formula, _VECTOR_FORMULAS)


@cache
def _tabulated_kernel(kind: str) -> Any:
    """Return the compiled loop over contacts of `Tabulated` for given forces or indentations.

    Each input is a number or an array.
    """
    residual = _VECTOR_FORMULAS[inverse.INVERSES[kind].residual.__name__]
    log_share = _VECTOR_FORMULAS[inverse.INVERSES[kind].log_share.__name__]
    angle_root, angle_derivative = _VECTOR_FORMULAS["angle_root"], _VECTOR_FORMULAS["angle_derivative"]
    start_coordinate, start_root = _VECTOR_FORMULAS["start_coordinate"], _VECTOR_FORMULAS["start_root"]
    newton_step, half_angle_of_root = _VECTOR_FORMULAS["limited_newton_step"], _VECTOR_FORMULAS["half_angle_of_root"]
    contact_quantities = _VECTOR_FORMULAS["contact_quantities"]

    def solve_contacts(inputs, start, functions, steps, outputs):  # type: ignore[no-untyped-def]
        """Solve each contact for its load; write half angle, indentation, force, pole pressure and stiffness."""
        rows = numpy.empty((_ROW_COUNT, _LANES))
        for first in range(0, outputs.shape[1], _LANES):
            lanes = min(_LANES, outputs.shape[1] - first)
            copy_inputs(inputs, first, lanes, rows)
            for j in range(lanes):
                widest = Widest(rows[_OPENING, j], rows[_FORCE, j])
                rows[_ROOT, j] = log_share(rows[_LOAD, j], widest)
                rows[_X, j] = start_coordinate(rows[_ROOT, j], rows[_RATIO, j])
            _sum_series(start, first, lanes, rows, _VALUES)
            for j in range(lanes):
                rows[_ROOT, j] = start_root(rows[_ROOT, j], rows[_VALUES, j])
            for step in range(steps + 1):
                for j in range(lanes):
                    rows[_ANGLE, j] = half_angle_of_root(rows[_ROOT, j])
                    series_root = angle_root(rows[_ANGLE, j], rows[_RATIO, j])
                    rows[_X, j] = 2 * series_root - 1
                    rows[_WIDENING, j] = angle_derivative(rows[_ANGLE, j], series_root, rows[_RATIO, j])
                _sum_two_series(functions, first, lanes, rows)
                if step < steps:
                    for j in range(lanes):
                        value, slope = residual(rows[_ROOT, j], rows[_LOAD, j], _evaluated_curve(rows, j))
                        rows[_ROOT, j] = newton_step(rows[_ROOT, j], value, slope)
            _sum_series(functions[2], first, lanes, rows, _VALUES + 2)
            for j in range(lanes):
                scale = Scale(rows[_CLEARANCE, j], rows[_AREA, j], rows[_COMPLIANCE, j])
                d, F, p0, stiffness, _ = contact_quantities(rows[_ANGLE, j], _evaluated_curve(rows, j), scale)
                rows[_INDENTATION, j], rows[_RESULT_FORCE, j] = d, F
                rows[_POLE_PRESSURE, j], rows[_STIFFNESS, j] = p0, stiffness
            outputs[:, first : first + lanes] = rows[_ANGLE : _STIFFNESS + 1, :lanes]

    return compile_loop(solve_contacts)


def copy_inputs(inputs: Any, first: int, lanes: int, rows: Numbers) -> None:
    """Copy the inputs of a block of contacts, numbers or arrays, to the first rows."""
    for row, values in enumerate(inputs):
        rows[row, :lanes] = values if numpy.ndim(values) == 0 else values[first : first + lanes]


@overload(copy_inputs, strict=False)
def _overload_copy_inputs(inputs: Any, first: Any, lanes: Any, rows: Any) -> Callable[..., Any]:
    """Implement `copy_inputs` in compiled code, for a tuple of numbers and arrays."""

    def copy(inputs, first, lanes, rows):  # type: ignore[no-untyped-def]
        row = 0
        for values in literal_unroll(inputs):
            for j in range(lanes):
                rows[row, j] = pick_element(values, first + j)
            row = row + 1

    return copy


@inline_formula
def _evaluated_curve(rows, j):  # type: ignore[no-untyped-def]
    """Return the tabulated functions that are evaluated for contact j of a block."""
    widening = rows[_WIDENING, j]
    return _EvaluatedCurve(
        rows[_VALUES, j],
        widening * rows[_SLOPES, j],
        rows[_VALUES + 1, j],
        widening * rows[_SLOPES + 1, j],
        rows[_VALUES + 2, j],
    )


@overload(curves.evaluate_table_functions, strict=False, jit_options={"forceinline": True})
def _overload_evaluate(angle: Any, curve: Any, rows: Any) -> Callable[..., Any]:
    """Return the tabulated functions that the loop has already evaluated at the half angle of the contact."""
    if rows.count == 1:
        return lambda angle, curve, rows: ((curve.share, curve.share_slope),)
    if rows.count == 2:
        return lambda angle, curve, rows: ((curve.share, curve.share_slope), (curve.force, curve.force_slope))
    return lambda angle, curve, rows: (
        (curve.share, curve.share_slope),
        (curve.force, curve.force_slope),
        (curve.pole, 0.0),
    )


@inline_formula
def _sum_series(series, first, lanes, rows, value_row):  # type: ignore[no-untyped-def]
    """Sum a Chebyshev series of each contact: T_k+1 = 2x T_k - T_k-1."""
    for j in range(lanes):
        rows[_WAVE, j], rows[_NEXT_WAVE, j], rows[value_row, j] = 1.0, rows[_X, j], 0.0
    for k in range(0, series.shape[0], 2):
        for j in range(lanes):
            twice, even, odd = 2 * rows[_X, j], rows[_WAVE, j], rows[_NEXT_WAVE, j]
            c0, c1 = pick_coefficient(series, k, first + j), pick_coefficient(series, k + 1, first + j)
            rows[value_row, j] += c0 * even + c1 * odd
            even = twice * odd - even
            rows[_WAVE, j], rows[_NEXT_WAVE, j] = even, twice * even - odd


@inline_formula
def _sum_two_series(functions, first, lanes, rows):  # type: ignore[no-untyped-def]
    """Sum the series of opening and force of each contact, and their slopes: T_k' = k U_k-1, U_k+1 = 2x U_k - U_k-1."""
    opening, force = functions[0], functions[1]
    for j in range(lanes):
        rows[_WAVE, j], rows[_NEXT_WAVE, j], rows[_RISE, j], rows[_NEXT_RISE, j] = 1.0, rows[_X, j], 0.0, 1.0
        rows[_VALUES, j], rows[_VALUES + 1, j], rows[_SLOPES, j], rows[_SLOPES + 1, j] = 0.0, 0.0, 0.0, 0.0
    for k in range(0, opening.shape[0], 2):
        order = float(k)
        for j in range(lanes):
            twice, even, odd = 2 * rows[_X, j], rows[_WAVE, j], rows[_NEXT_WAVE, j]
            even_rise, odd_rise = rows[_RISE, j], rows[_NEXT_RISE, j]
            even_slope, odd_slope, i = order * even_rise, (order + 1.0) * odd_rise, first + j
            c0, c1 = pick_coefficient(opening, k, i), pick_coefficient(opening, k + 1, i)
            rows[_VALUES, j] += c0 * even + c1 * odd
            rows[_SLOPES, j] += c0 * even_slope + c1 * odd_slope
            c0, c1 = pick_coefficient(force, k, i), pick_coefficient(force, k + 1, i)
            rows[_VALUES + 1, j] += c0 * even + c1 * odd
            rows[_SLOPES + 1, j] += c0 * even_slope + c1 * odd_slope
            even, even_rise = twice * odd - even, twice * odd_rise - even_rise
            rows[_WAVE, j], rows[_NEXT_WAVE, j] = even, twice * even - odd
            rows[_RISE, j], rows[_NEXT_RISE, j] = even_rise, twice * even_rise - odd_rise


def pick_coefficient(series: Any, k: int, i: int) -> Any:
    """Return coefficient k of the series of contact i, or of the one series of all contacts."""
    return series[k, i] if series.ndim > 1 else series[k]


@overload(pick_coefficient, strict=False, jit_options={"forceinline": True})
def _overload_pick_coefficient(series: Any, k: Any, i: Any) -> Callable[..., Any]:
    """Implement `pick_coefficient` in compiled code."""
    return (lambda series, k, i: series[k, i]) if series.ndim > 1 else (lambda series, k, i: series[k])


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
):
    jit_formula(_long_formula)
