"""Coupled search for displacements and pressures: operator, Newton step, equilibrium of each lane."""

from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.bore_contact import initial_displacement, make_bore_arrays
from ballsocket.elasticity.off_axis.compliance import cached_compliance
from ballsocket.elasticity.off_axis.coupled_search import (
    TANGENT_ITERATIONS,
    apply_operator,
    compute_force,
    fold_bore,
    integrate,
    make_predictor,
    measure,
    newton_step,
    project_on_normals,
    solve_sensitivity,
    start_coarse,
)
from ballsocket.elasticity.off_axis.lane_solver import coarser_lanes, solve_lanes, solve_tangents
from ballsocket.elasticity.off_axis.surfaces import ClosedShell

from ...joints import HIP
from .shapes import RIGID, bore_of

COMPLIANCE = cached_compliance(ClosedShell(), HIP, bs.Cup(), radians(3.0))
GRID, BORE = COMPLIANCE.grid, bore_of(COMPLIANCE)
WORN = np.maximum(GRID.centroids[0] + GRID.centroids[2], 0.0) ** 2
FORCES = np.array([400.0, 3000.0, 1200.0, 2000.0])
AXES = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -0.8, 0.6], [0.36, 0.48, 0.8]])


def solve(bore, rows, tolerance=1e-6):
    start = initial_displacement(bore.gap, COMPLIANCE.uniform_stiffness, bore.gap.depth, FORCES[rows], AXES[rows])
    load = AXES[rows] * FORCES[rows, None]
    return solve_lanes(bore, coarser_lanes(bore), load, FORCES[rows], start, tolerance)


@pytest.mark.parametrize("even", [True, False])
def test_symmetric_fields_need_one_side_of_the_plane_of_the_load(even):
    """Overlaps, forces and displacements of even and odd fields are those of both sides together."""
    bore = make_bore_arrays(BORE, np.float64)
    side, sign = fold_bore(bore, even=even), 1 if even else -1
    half = np.random.default_rng(0).standard_normal((GRID.meridians // 2, GRID.rings, 3))
    both = np.concatenate([half, sign * half[::-1]])
    displacement = apply_operator(bore, bore.softness, both)
    folded = apply_operator(side, side.softness, half)
    assert folded == pytest.approx(displacement[: len(half)], abs=1e-12 * abs(displacement).max())
    assert integrate(side, half, folded) == pytest.approx(integrate(bore, both, displacement))
    components = [0, 2] if even else [1]
    assert compute_force(side, half) == pytest.approx(compute_force(bore, both)[components], rel=1e-9, abs=1e-9)
    overlap = project_on_normals(bore, np.eye(3)[:, components])
    assert project_on_normals(side, np.eye(len(components))) == pytest.approx(overlap[: len(half)])


def test_contacts_in_a_plane_of_symmetry_have_the_tangents_of_both_sides():
    pressure = solve(BORE, np.arange(2)).pressure
    tangents = solve_tangents(BORE, pressure)
    bore = make_bore_arrays(BORE)
    expected = solve_sensitivity(bore, pressure.T > 0, TANGENT_ITERATIONS).tangent
    assert tangents == pytest.approx(expected, abs=1e-5 * float(abs(expected).max()))


@pytest.mark.parametrize("depth", [0.0, 0.03])
def test_each_lane_balances_its_load_with_closed_gaps(depth):
    bore = bore_of(COMPLIANCE, depth=depth * WORN)
    solution = solve(bore, np.arange(4))
    overlap = bore.gap.overlap(solution.displacement)
    gap = COMPLIANCE.displacement(solution.pressure) - overlap
    scale = overlap.max(axis=(1, 2), keepdims=True)
    assert solution.converged.all()
    assert (solution.pressure >= 0).all()
    assert (np.where(solution.pressure > 0, abs(gap), 0.0) <= 1.1e-6 * scale).all()
    assert (gap >= -1.1e-6 * scale).all()
    assert bore.force(solution.pressure) == pytest.approx(AXES * FORCES[:, None], abs=1.1e-6 * FORCES.max())


def test_lanes_do_not_depend_on_each_other():
    together, alone = solve(BORE, np.arange(4)), solve(BORE, np.array([2]))
    assert together.displacement[2] == pytest.approx(alone.displacement[0], abs=1e-8)
    assert together.pressure[2] == pytest.approx(alone.pressure[0], abs=2e-5 * alone.pressure.max())


def test_newton_step_anticipates_pressures_that_have_not_converged():
    """The step from rough pressures is close to the way to equilibrium; the force alone would mislead it."""
    bore = coarser_lanes(BORE)
    arrays = make_bore_arrays(bore, np.float64)
    start = initial_displacement(bore.gap, COMPLIANCE.uniform_stiffness, bore.gap.depth, FORCES, AXES)
    lanes = start_coarse(arrays, (AXES * FORCES[:, None]).T, FORCES, start.T)
    predictor = make_predictor(solve_sensitivity(arrays, lanes.pressure > 0, 3))
    step = newton_step(arrays, lanes, predictor)
    solved = bore.solve_displaced((lanes.displacement + step).T)
    error = np.linalg.norm(bore.force(solved.pressure) - AXES * FORCES[:, None], axis=1)
    before = bore.solve_displaced(lanes.displacement.T)
    assert (error < 0.35 * np.linalg.norm(bore.force(before.pressure) - AXES * FORCES[:, None], axis=1)).all()


def test_measured_overlaps_are_those_of_the_gap():
    bore = bore_of(COMPLIANCE, depth=0.02 * WORN)
    arrays = make_bore_arrays(bore, np.float64)
    displacement = 0.15 * AXES
    measured = measure(arrays, 0.0 * AXES.T, displacement.T, np.zeros((GRID.meridians, GRID.rings, 4)))
    overlap = bore.gap.overlap(displacement)
    assert pytest.approx(overlap, abs=1e-12) == measured.remaining.T
    assert measured.overlap_scale == pytest.approx(overlap.max(axis=(1, 2)))


def test_bores_without_lanes():
    """Springs and circular gaps have no coupled search."""
    springs = cached_compliance(bs.Springs(), RIGID, bs.Cup(), radians(3.0))
    assert coarser_lanes(bore_of(springs)) is None
    assert coarser_lanes(bore_of(COMPLIANCE, kind=bs.CircularGap)) is None
