"""Compiled loop over arrays of contacts for the model `Tabulated`, and Chebyshev series of blocks of contacts.

The numbers of a block are rows of one array: several arrays might overlap, and then LLVM makes no vector instructions.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy
from numba import literal_unroll
from numba.extending import overload

from ..contact import coordinates
from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..elasticity.exact.tabulated import curves, inverse
from ..elasticity.exact.tabulated.curves import JointCurves, Scale, Widest
from ..elasticity.exact.tabulated.model import Tabulated
from ..problem import Joint
from .overloads import VECTOR_FUNCTIONS, as_row, compile_loop, inline_formula, pick_element, vector_formula

LANES = 128  # number of contacts in an inner loop; their values stay in the cache


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
def sum_series(series, first, lanes, rows, x, value, wave, terms):  # type: ignore[no-untyped-def]
    """Sum a Chebyshev series of each contact at row x: T_k+1 = 2x T_k - T_k-1.

    The polynomials are in the rows `wave` and the next, four coefficients in those from `terms` on.
    """
    for j in range(lanes):
        rows[wave, j], rows[wave + 1, j], rows[value, j] = 1.0, rows[x, j], 0.0
    for k in range(0, series.shape[0], 4):
        copy_coefficients(series, k, first, lanes, rows, terms)
        for j in range(lanes):
            twice, t0, t1 = 2 * rows[x, j], rows[wave, j], rows[wave + 1, j]
            t2 = twice * t1 - t0
            t3 = twice * t2 - t1
            rows[value, j] += four_terms(rows, terms, j, t0, t1, t2, t3)
            t0 = twice * t3 - t2
            rows[wave, j], rows[wave + 1, j] = t0, twice * t0 - t3


@inline_formula
def sum_series_with_slopes(functions, count, first, lanes, rows, x, value, wave, terms):  # type: ignore[no-untyped-def]
    """Sum the first two or three series of each contact at row x, and their slopes.

    The polynomials have T_k' = k U_k-1 and U_k+1 = 2x U_k - U_k-1. The sums are in the rows from `value` on, the slopes
    in the three after those of the three sums, the polynomials in four rows from `wave` on, and coefficients in twelve
    rows from `terms` on.
    """
    slope = value + 3
    for j in range(lanes):
        rows[wave, j], rows[wave + 1, j], rows[wave + 2, j], rows[wave + 3, j] = 1.0, rows[x, j], 0.0, 1.0
        for row in range(value, value + 6):
            rows[row, j] = 0.0
    for k in range(0, functions.shape[1], 4):
        order = float(k)
        for row in range(count):
            copy_coefficients(functions[row], k, first, lanes, rows, terms + 4 * row)
        for j in range(lanes):
            twice = 2 * rows[x, j]
            t0, t1, u0, u1 = rows[wave, j], rows[wave + 1, j], rows[wave + 2, j], rows[wave + 3, j]
            t2, u2 = twice * t1 - t0, twice * u1 - u0
            t3, u3 = twice * t2 - t1, twice * u2 - u1
            s0, s1, s2, s3 = order * u0, (order + 1.0) * u1, (order + 2.0) * u2, (order + 3.0) * u3
            rows[value, j] += four_terms(rows, terms, j, t0, t1, t2, t3)
            rows[slope, j] += four_terms(rows, terms, j, s0, s1, s2, s3)
            rows[value + 1, j] += four_terms(rows, terms + 4, j, t0, t1, t2, t3)
            rows[slope + 1, j] += four_terms(rows, terms + 4, j, s0, s1, s2, s3)
            if count > 2:
                rows[value + 2, j] += four_terms(rows, terms + 8, j, t0, t1, t2, t3)
                rows[slope + 2, j] += four_terms(rows, terms + 8, j, s0, s1, s2, s3)
            t0, u0 = twice * t3 - t2, twice * u3 - u2
            rows[wave, j], rows[wave + 1, j] = t0, twice * t0 - t3
            rows[wave + 2, j], rows[wave + 3, j] = u0, twice * u0 - u3


@inline_formula
def copy_coefficients(series, k, first, lanes, rows, terms):  # type: ignore[no-untyped-def]
    """Copy four coefficients of the series of each contact, from that with index k on, to the rows from `terms` on."""
    for term in range(4):
        for j in range(lanes):
            rows[terms + term, j] = series[k + term, first + j]


@inline_formula
def four_terms(rows, term, j, t0, t1, t2, t3):  # type: ignore[no-untyped-def]
    """Sum four terms of the series of contact j of a block, whose coefficients are in the rows from `term` on."""
    return rows[term, j] * t0 + rows[term + 1, j] * t1 + rows[term + 2, j] * t2 + rows[term + 3, j] * t3


def solve_tabulated(model: Tabulated, joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """Solve the model `Tabulated` for arrays of joints in one compiled loop, by forces or indentations."""
    steps = inverse.RIGID_STEPS if joint.ball is None else inverse.ELASTIC_STEPS

    def read_curves(curves: JointCurves, load: Numbers) -> tuple[Numbers, ...]:
        """Compute ε, d, F, p0, dF/dd and the last change of ε of contacts: six arrays (contacts,)."""
        inputs = (load, curves.load_scale(kind), curves.ratio, *curves.widest, *curves.scale)
        start, functions = inverse.start_series(curves, kind), curves.functions
        outputs = numpy.empty((_OUTPUT_COUNT, len(load)))
        # a number in an array of one element, or a flat array
        rows = tuple(number.item() if number.size == 1 else as_row(number, load.shape) for number in inputs)
        _tabulated_kernel(kind)(rows, start, functions, steps, outputs)
        return tuple(outputs)

    return model.solve_with_reader(joint, kind, load, read_curves)


class _EvaluatedCurve(NamedTuple):
    """Tabulated functions and their slopes by ln ε at the half angle of one contact, in compiled code."""

    share: float
    share_slope: float
    force: float
    force_slope: float
    pole: float
    pole_slope: float


_LOAD, _LOAD_SCALE, _RATIO, _OPENING, _FORCE, _CLEARANCE, _AREA, _COMPLIANCE = range(8)  # rows of the inputs
_ANGLE, _INDENTATION, _RESULT_FORCE, _POLE_PRESSURE, _STIFFNESS, _SHIFT = range(8, 14)  # rows of the results

_OUTPUT_COUNT = 6

_X, _ROOT, _WIDENING, _VALUES, _SLOPES, _WAVES = 14, 15, 16, 17, 20, 23
"""Rows of coordinate, unknown, its derivative, three functions, three slopes and four Chebyshev polynomials."""

_TERMS = 27  # first row of twelve coefficients

_ROW_COUNT = 39


_VECTOR_FORMULAS = dict(VECTOR_FUNCTIONS)
"""Elementary functions and formulas of the tables, by name, that compile to vector instructions."""

for _tabulated_formula in (
    coordinates.angle_root,
    curves.log_angle_derivative,
    curves.opening,
    curves.tabulated_state,
    curves.shift_state,
    curves.contact_quantities,
    inverse.start_coordinate,
    inverse.start_root,
    inverse.half_angle_of_root,
    inverse.limited_newton_step,
    *(
        formula
        for functions in inverse.INVERSES.values()
        for formula in (functions.residual, functions.log_share, functions.shift)
    ),
):
    _VECTOR_FORMULAS[_tabulated_formula.__name__] = vector_formula(_tabulated_formula, _VECTOR_FORMULAS)


@cache
def _tabulated_kernel(kind: str) -> Any:
    """Return the compiled loop over contacts of `Tabulated` for one kind of load; inputs are numbers or arrays."""
    formulas = _VECTOR_FORMULAS
    residual = formulas[inverse.INVERSES[kind].residual.__name__]
    log_share = formulas[inverse.INVERSES[kind].log_share.__name__]
    shift_of = formulas[inverse.INVERSES[kind].shift.__name__]
    angle_root, log_angle_derivative = formulas["angle_root"], formulas["log_angle_derivative"]
    start_coordinate, start_root = formulas["start_coordinate"], formulas["start_root"]
    newton_step, half_angle_of_root = formulas["limited_newton_step"], formulas["half_angle_of_root"]
    tabulated_state, shift_state = formulas["tabulated_state"], formulas["shift_state"]
    contact_quantities = formulas["contact_quantities"]

    @inline_formula
    def write_start(start, first, lanes, rows):  # type: ignore[no-untyped-def]
        """Write the first values of the unknown of a block of contacts."""
        for j in range(lanes):
            rows[_LOAD, j] *= rows[_LOAD_SCALE, j]
            rows[_ROOT, j] = log_share(rows[_LOAD, j], Widest(rows[_OPENING, j], rows[_FORCE, j]))
            rows[_X, j] = start_coordinate(rows[_ROOT, j], rows[_RATIO, j])
        sum_series(start, first, lanes, rows, _X, _VALUES, _WAVES, _TERMS)
        for j in range(lanes):
            rows[_ROOT, j] = start_root(rows[_ROOT, j], rows[_VALUES, j])

    @inline_formula
    def write_coordinates(lanes, rows):  # type: ignore[no-untyped-def]
        """Write half angles and coordinates of a block of contacts."""
        for j in range(lanes):
            rows[_ANGLE, j] = half_angle_of_root(rows[_ROOT, j])
            series_root = angle_root(rows[_ANGLE, j], rows[_RATIO, j])
            rows[_X, j] = 2 * series_root - 1
            rows[_WIDENING, j] = 1 / log_angle_derivative(rows[_ANGLE, j], series_root, rows[_RATIO, j])

    @inline_formula
    def write_results(first, lanes, rows, outputs):  # type: ignore[no-untyped-def]
        """Correct the contacts of a block linearly, and write their quantities."""
        for j in range(lanes):
            state = tabulated_state(rows[_ANGLE, j], _evaluated_curve(rows, j))
            shift = shift_of(state, rows[_LOAD, j])
            state = shift_state(state, shift)
            scale = Scale(rows[_CLEARANCE, j], rows[_AREA, j], rows[_COMPLIANCE, j])
            d, F, p0, stiffness, _ = contact_quantities(state, scale)
            rows[_ANGLE, j], rows[_INDENTATION, j], rows[_RESULT_FORCE, j] = state.angle, d, F
            rows[_POLE_PRESSURE, j], rows[_STIFFNESS, j], rows[_SHIFT, j] = p0, stiffness, shift
        outputs[:, first : first + lanes] = rows[_ANGLE : _SHIFT + 1, :lanes]

    def solve_contacts(inputs, start, functions, steps, outputs):  # type: ignore[no-untyped-def]
        """Solve each contact for its load; write ε, d, force, pole pressure, stiffness and last change of ε."""
        rows = numpy.empty((_ROW_COUNT, LANES))
        for first in range(0, outputs.shape[1], LANES):
            lanes = min(LANES, outputs.shape[1] - first)
            copy_inputs(inputs, first, lanes, rows)
            write_start(start, first, lanes, rows)
            write_coordinates(lanes, rows)
            for _ in range(steps):
                sum_series_with_slopes(functions, 2, first, lanes, rows, _X, _VALUES, _WAVES, _TERMS)
                for j in range(lanes):
                    value, slope = residual(rows[_ROOT, j], rows[_LOAD, j], _evaluated_curve(rows, j))
                    rows[_ROOT, j] = newton_step(rows[_ROOT, j], value, slope)
                write_coordinates(lanes, rows)
            sum_series_with_slopes(functions, 3, first, lanes, rows, _X, _VALUES, _WAVES, _TERMS)
            write_results(first, lanes, rows, outputs)

    return compile_loop(solve_contacts)


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
        widening * rows[_SLOPES + 2, j],
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
        (curve.pole, curve.pole_slope),
    )
