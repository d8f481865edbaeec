"""Compiled loops over arrays of contacts for radial foundations and for the model `Refined`."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy
from numba.extending import overload

from ..contact import roots
from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..core.validity import Status
from ..models import kinematics, liner_compliance, refined_inverse, refined_state
from ..models.foundation import RadialFoundation
from ..models.kinematics import Kinematics
from ..models.modulus import Formula
from ..models.refined import RefinedSolution, square_tolerance
from ..models.refined_state import ScaledContact
from ..models.table_3 import scaled_modulus
from ..problem import Joint
from .overloads import VECTOR_FUNCTIONS, as_row, compile_loop, inline_formula, pick_element, vector_formula
from .table_kernel import LANES, copy_inputs, sum_series


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


for _formula in (
    scaled_modulus,
    kinematics.linear_indentation,
    kinematics.linear_force,
    kinematics.linear_stiffness,
    kinematics.circular_force,
    kinematics.circular_stiffness,
):
    inline_formula(_formula)


_FORMULAS = (
    liner_compliance.liner_coefficients,
    liner_compliance._evaluate_polynomial,
    liner_compliance._scaled_polynomial,
    liner_compliance.log_compliance,
    liner_compliance._decay_means,
    liner_compliance._reduced_polynomial,
    liner_compliance.log_compliance_any_wave,
    refined_state.log_compliances,
    refined_state.log_slopes,
    refined_state._log_compliance,
    refined_state._edge_displacement,
    refined_state._pressure_exponent,
    refined_state.angle_derivative,
    refined_state.scaled_contact,
    refined_state.shift_contact,
    refined_state.shape_coefficient,
    refined_state.peak_position,
    refined_state.pressure_ratio,
    refined_inverse.half_angle_of_root,
    refined_inverse.last_shift,
    refined_inverse.masked_half_angle,
    refined_inverse.start_ratio,
    refined_inverse.start_log_estimate,
    refined_inverse.start_coordinate,
    refined_inverse.start_root,
    refined_inverse.force_product,
    refined_inverse.indentation_product,
    roots.bracketed_update,
)
"""Formulas of the model, each after those that it calls."""

_VECTOR_FORMULAS = dict(VECTOR_FUNCTIONS)
"""Elementary functions and formulas, by name, that compile to vector instructions."""

for _refined_formula in _FORMULAS:
    _VECTOR_FORMULAS[_refined_formula.__name__] = vector_formula(_refined_formula, _VECTOR_FORMULAS)


_BLOCK = 16384
"""Number of contacts whose series of the start are computed at once."""

_MAX_STEPS = 60
"""Largest number of Newton steps."""

_LOAD, _RADIUS, _CLEARANCE, _THICKNESS, _YOUNG, _POISSON = range(6)
"""Rows of the inputs."""

_ROOT, _LOW, _HIGH, _FRESH, _SCALED, _PRODUCT, _SLOPE = range(6, 13)
"""Rows of the iteration: unknown, bracket, whether its upper end is new, load, and the values of a trial contact."""

_SHARE, _SHARE_RATE, _GAP, _GAP_SLOPE, _COMPLIANCE, _SECANT, _SECANT_RATE, _COMPLIANCE_RATE = range(13, 21)
"""Rows of the trial contact: the fields of `ScaledContact`."""

_X, _WAVE, _NEXT_WAVE, _CORRECTION = range(21, 25)
"""Rows of the series of the start."""

_ROW_COUNT = 25


def solve_refined(joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """Solve the model `Refined` in one compiled loop, for arrays of forces or indentations."""
    shape = numpy.broadcast_shapes(*(number.shape for number in (*joint.numbers(), load)))
    liner = joint.liner
    numbers = (load, joint.socket_radius, joint.clearance, joint.liner_thickness, liner.young, liner.poisson)
    inputs = tuple(as_row(number, shape) for number in numbers)
    outputs, converged = numpy.empty((3, math.prod(shape))), numpy.empty(math.prod(shape), dtype=bool)
    for first in range(0, len(converged), _BLOCK):
        block = slice(first, min(first + _BLOCK, len(converged)))
        _solve_block(kind, tuple(take_block(row, block) for row in inputs), outputs[:, block], converged[block])
    edge, answer, max_pressure = (output.reshape(shape) for output in outputs)
    solution = RefinedSolution(joint=joint, edge=edge)
    vars(solution)["max_pressure"] = max_pressure
    loads = numpy.broadcast_to(load, shape)
    force, indentation = (loads, answer) if kind == "force" else (answer, loads)
    failures = {Status.NOT_CONVERGED: ~converged.reshape(shape)}
    return SolverResult(laws=solution, force=force, indentation=indentation, failures=failures)


def take_block(row: Any, block: slice) -> Any:
    """Take a block of an array; return a number itself."""
    return row if isinstance(row, float) else row[block]


def _solve_block(kind: str, inputs: tuple[Any, ...], outputs: Numbers, converged: Numbers) -> None:
    """Solve a block of contacts; write half angle, the quantity that is not the load, and pressure to `outputs`."""
    ratio = numpy.atleast_1d(inputs[_RADIUS] / inputs[_THICKNESS])
    start = refined_inverse.start_series(kind, numpy.atleast_1d(inputs[_POISSON]), ratio)
    series = start[:, 0].copy() if start.shape[1] == 1 else start
    limits = refined_inverse.start_constants(kind)
    _kernel(kind)(inputs, series, limits, square_tolerance(outputs), outputs, converged)


@cache
def _kernel(kind: str) -> Any:
    """Return the compiled loop over contacts for given forces or indentations."""
    formulas = _VECTOR_FORMULAS
    half_angle_of_root, masked_half_angle = formulas["half_angle_of_root"], formulas["masked_half_angle"]
    last_shift, bracketed_update = formulas["last_shift"], formulas["bracketed_update"]
    start_log_estimate, start_root = formulas["start_log_estimate"], formulas["start_root"]
    start_coordinate, start_ratio = formulas["start_coordinate"], formulas["start_ratio"]
    liner_coefficients, scaled_contact = formulas["liner_coefficients"], formulas["scaled_contact"]
    shift_contact, shape_coefficient = formulas["shift_contact"], formulas["shape_coefficient"]
    peak_position, pressure_ratio = formulas["peak_position"], formulas["pressure_ratio"]
    product_of, is_force = formulas[f"{kind}_product"], kind == "force"
    exp, log, end, tolerance = formulas["exp"], formulas["log"], refined_inverse.END, refined_inverse.TOLERANCE

    @inline_formula
    def write_start(series, limits, first, lanes, rows):  # type: ignore[no-untyped-def]
        """Write dimensionless loads, first values of the unknown, and brackets of a block of contacts."""
        power, small, large, widest = limits
        for j in range(lanes):
            load = rows[_LOAD, j] if rows[_LOAD, j] > 0.0 else 1.0
            scale = rows[_CLEARANCE, j] * (rows[_YOUNG, j] * rows[_RADIUS, j] if is_force else 1.0)
            rows[_SCALED, j] = load / scale
            rows[_ROOT, j] = start_log_estimate(rows[_SCALED, j], power, small, large, widest)
            ratio = start_ratio(rows[_RADIUS, j] / rows[_THICKNESS, j])
            rows[_X, j] = start_coordinate(exp(rows[_ROOT, j]), ratio, widest)
        sum_series(series, first, lanes, rows, _X, _CORRECTION, _WAVE, _SHARE)
        for j in range(lanes):
            root = start_root(rows[_ROOT, j], rows[_CORRECTION, j])
            rows[_ROOT, j], rows[_LOW, j], rows[_HIGH, j] = root, root - 6.0, end
            rows[_FRESH, j] = 1.0 if root < end else 0.0

    @inline_formula
    def evaluate_contacts(lanes, rows):  # type: ignore[no-untyped-def]
        """Write the trial contacts of a block, and their products with the slopes."""
        for j in range(lanes):
            liner = liner_coefficients(rows[_POISSON, j], 1.0 + rows[_THICKNESS, j] / rows[_RADIUS, j])
            contact = scaled_contact(half_angle_of_root(rows[_ROOT, j]), liner)
            rows[_PRODUCT, j], rows[_SLOPE, j] = product_of(contact, rows[_SCALED, j])
            rows[_SHARE, j], rows[_SHARE_RATE, j] = contact.share, contact.share_rate
            rows[_GAP, j], rows[_GAP_SLOPE, j] = contact.gap, contact.gap_slope
            rows[_COMPLIANCE, j], rows[_COMPLIANCE_RATE, j] = contact.compliance, contact.compliance_rate
            rows[_SECANT, j], rows[_SECANT_RATE, j] = contact.secant, contact.secant_rate

    @inline_formula
    def update_roots(lanes, rows):  # type: ignore[no-untyped-def]
        """Take a bracketed Newton step in a block; return the number of contacts that have not converged."""
        moving = 0
        for j in range(lanes):
            difference, slope, root = log(rows[_PRODUCT, j]), rows[_SLOPE, j], rows[_ROOT, j]
            next_root, low, high, fresh, has_moved = bracketed_update(
                difference, slope, tolerance, root, rows[_LOW, j], rows[_HIGH, j], rows[_FRESH, j] > 0.0
            )
            rows[_ROOT, j], rows[_LOW, j], rows[_HIGH, j] = next_root, low, high
            rows[_FRESH, j] = 1.0 if fresh else 0.0
            moving += 1 if has_moved else 0
        return moving

    @inline_formula
    def write_results(square, first, lanes, rows, outputs, converged):  # type: ignore[no-untyped-def]
        """Correct the contacts of a block linearly, and write half angle, depth or force, and largest pressure."""
        for j in range(lanes):
            shift = last_shift(rows[_PRODUCT, j], rows[_SLOPE, j])
            contact = shift_contact(
                ScaledContact(
                    rows[_SHARE, j],
                    rows[_SHARE_RATE, j],
                    rows[_GAP, j],
                    rows[_GAP_SLOPE, j],
                    rows[_COMPLIANCE, j],
                    rows[_SECANT, j],
                    rows[_SECANT_RATE, j],
                    rows[_COMPLIANCE_RATE, j],
                ),
                shift,
            )
            load, R2, E = rows[_LOAD, j], rows[_RADIUS, j], rows[_YOUNG, j]
            edge = masked_half_angle(rows[_ROOT, j], shift) if load > 0.0 else 0.0
            stiffness = E * R2 * contact.secant
            beta = shape_coefficient(contact)
            ratio = pressure_ratio(peak_position(beta), beta)
            answer = load / stiffness if is_force else load * stiffness
            depth = rows[_CLEARANCE, j] * (2 * contact.share / contact.gap)
            pressure = E / (R2 * contact.compliance) * depth * ratio
            rows[_X, j] = 1.0 if (shift * shift <= square) | (edge == 0.0) else 0.0
            rows[_SHARE, j] = edge
            rows[_GAP, j] = answer if edge > 0.0 else 0.0 * edge
            rows[_SECANT, j] = pressure if edge > 0.0 else 0.0 * edge
        for j in range(lanes):
            outputs[0, first + j] = rows[_SHARE, j]
            outputs[1, first + j] = rows[_GAP, j]
            outputs[2, first + j] = rows[_SECANT, j]
            converged[first + j] = rows[_X, j] > 0.0

    def solve_contacts(inputs, series, limits, square, outputs, converged):  # type: ignore[no-untyped-def]
        """Solve each contact for its load; write half angle, indentation or force, and largest pressure."""
        rows = numpy.empty((_ROW_COUNT, LANES))
        for first in range(0, outputs.shape[1], LANES):
            lanes = min(LANES, outputs.shape[1] - first)
            copy_inputs(inputs, first, lanes, rows)
            write_start(series, limits, first, lanes, rows)
            moving = lanes
            for step in range(_MAX_STEPS + 1):
                evaluate_contacts(lanes, rows)
                if moving == 0 or step == _MAX_STEPS:
                    break
                moving = update_roots(lanes, rows)
            write_results(square, first, lanes, rows, outputs, converged)

    return compile_loop(solve_contacts)
