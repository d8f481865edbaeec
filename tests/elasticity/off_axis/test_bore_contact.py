"""Ball in a bore: pressures of a displaced ball, forces, equilibrium under loads, tethers, and cost of the search."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis import bore_contact
from ballsocket.elasticity.off_axis.bore_contact import make_bore_arrays
from ballsocket.elasticity.off_axis.compliance import cached_compliance, make_compliance
from ballsocket.elasticity.off_axis.coupled_search import TANGENT_ITERATIONS, solve_sensitivity
from ballsocket.elasticity.off_axis.equilibrium import solve_force
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.elasticity.off_axis.lane_solver import coarser_lanes, solve_lanes, solve_tangents
from ballsocket.elasticity.off_axis.pressure_solver import solve_pressure
from ballsocket.elasticity.off_axis.surfaces import initial_displacement

from ...extent import some
from ...joints import HIP
from .shapes import bore_of, gap_of

FINE, GRID = even_grid(pi / 2, radians(3.6)), even_grid(pi / 2, radians(6.0))
SHELL = make_compliance(bs.ClosedShell(), HIP, bs.Cup(), GRID)
DISPLACEMENTS = np.array([[0.0, 0.0, 0.14], [0.1, 0.05, 0.1], [0.0, 0.0, 0.05], [0.16, 0.0, 0.02]])


def overlap_of(displacement, grid=GRID):
    return gap_of(grid).overlap(np.atleast_2d(displacement))


# --- pressures of displaced balls ---


@pytest.mark.parametrize(("tolerance", "iterations"), [(1e-4, 4), (1e-6, 6), (1e-9, 14)])
def test_pressures_close_the_gap_or_vanish(tolerance, iterations):
    overlap = overlap_of(DISPLACEMENTS)
    solution = solve_pressure(SHELL, overlap, tolerance=tolerance)
    gap = SHELL.softness(solution.pressure) - overlap
    scale = overlap.max(axis=(1, 2), keepdims=True).clip(1e-3)
    assert solution.converged.all()
    assert (solution.pressure >= 0).all()
    assert (np.where(solution.pressure > 0, abs(gap), 0.0) <= tolerance * scale).all()
    assert (gap >= -tolerance * scale).all()
    assert not solution.pressure[2].any()  # within the clearance
    assert solution.iterations <= iterations


def test_energy_is_that_of_the_pressures_and_stationary():
    """At a tolerance of 1e-3 the energy is accurate to its square."""
    overlap = overlap_of(DISPLACEMENTS[[0, 1, 3]])
    accurate, rough = (solve_pressure(SHELL, overlap, tolerance=tolerance) for tolerance in (1e-8, 1e-3))
    stored = GRID.integrate_product(accurate.pressure, SHELL.softness(accurate.pressure)) / 2
    assert accurate.energy == pytest.approx(stored, rel=1e-6)
    assert rough.energy == pytest.approx(stored, rel=2e-5)
    assert rough.iterations < accurate.iterations


# --- equilibrium under loads ---

LOADS = np.array([[0.0, 0.0, 1000.0], [800.0, 300.0, 1500.0], [-20.0, 10.0, 40.0]])
START = 0.15 * LOADS / np.linalg.norm(LOADS, axis=1)[:, None]
HELD = np.ones(3, dtype=bool)
BORE = bore_of(make_compliance(bs.ClosedShell(), HIP, bs.Cup(), FINE))
CIRCULAR = bore_of(BORE.compliance, kind=bs.CircularGap)
SEARCHES = pytest.mark.parametrize("bore", [BORE, CIRCULAR], ids=["lanes", "newton"])


@SEARCHES
def test_forces_are_in_equilibrium_with_the_loads(bore):
    solution = solve_force(bore, LOADS, START, HELD)
    assert solution.converged.all()
    error = np.linalg.norm(bore.force(solution.pressure) - LOADS, axis=1)
    assert (error <= 1e-6 * np.linalg.norm(LOADS, axis=1)).all()
    again = bore.solve_displaced(solution.displacement)
    assert again.pressure == pytest.approx(solution.pressure, abs=1e-3)
    assert again.converged.all()


def test_blocks_of_balls_do_not_change_the_solution(monkeypatch):
    together = solve_force(CIRCULAR, LOADS, START, HELD)
    monkeypatch.setattr(bore_contact, "_BATCH_CELLS", 2 * FINE.rings * FINE.meridians)
    assert [len(block) for block in CIRCULAR.split_into_blocks(np.arange(5))] == [2, 2, 1]
    separate = solve_force(CIRCULAR, LOADS, START, HELD)
    assert separate.displacement == pytest.approx(together.displacement, abs=1e-6)
    monkeypatch.setattr(bore_contact, "_BATCH_CELLS", 1)
    assert [len(block) for block in CIRCULAR.split_into_blocks(np.arange(2))] == [1, 1]


@SEARCHES
@pytest.mark.parametrize("factor", some([0.2, 0.6, 3.0], 2))
def test_bad_starts_and_the_solution_itself_reach_the_same_equilibrium(bore, factor):
    expected = solve_force(bore, LOADS, START, HELD)
    for start, pressure in ((factor * START, None), (expected.displacement, expected.pressure)):
        solution = solve_force(bore, LOADS, start, HELD, pressure)
        assert solution.converged.all()
        assert solution.displacement == pytest.approx(expected.displacement, abs=1e-5 if pressure is None else 1e-6)


@SEARCHES
def test_tether_carries_its_part_of_the_load(bore):
    tether = np.diag([500.0, 200.0, 0.0])
    tethered = replace(bore, tether=tether)
    solution = solve_force(tethered, LOADS, START, HELD)
    assert solution.converged.all()
    carried = bore.force(solution.pressure) + solution.displacement @ tether
    assert carried == pytest.approx(LOADS, abs=2e-3)
    sensitivity = bore.pressure_sensitivity(solution.displacement, solution.pressure > 0, tolerance=1e-6)
    assert tethered.tangent(sensitivity) - bore.tangent(sensitivity) == pytest.approx(np.array(3 * [tether]))


def test_tangent_is_the_derivative_of_the_force():
    solution, h = solve_force(BORE, LOADS[:2], START[:2], HELD[:2]), 1e-6
    sensitivity = BORE.pressure_sensitivity(solution.displacement, solution.pressure > 0, tolerance=1e-8)
    tangent = BORE.tangent(sensitivity)
    for axis, step in enumerate(h * np.eye(3)):
        high, low = (
            solve_pressure(BORE.compliance, BORE.gap.overlap(solution.displacement + change), None, 1e-10).pressure
            for change in (step, -step)
        )
        slope = BORE.force(high - low) / (2 * h)
        assert tangent[:, :, axis] == pytest.approx(slope, rel=2e-3, abs=1e-3 * abs(tangent).max())


def test_preloaded_ball_without_a_load_stays_centred_in_a_symmetric_bore():
    sphere = bore_of(make_compliance(bs.ClosedShell(), HIP, bs.Cup(), even_grid(pi, radians(6.0))), clearance=-0.05)
    solution = solve_force(sphere, np.array([[0.0, 0.0, 1e-9]]), np.array([[0.01, 0.02, -0.01]]), HELD[:1])
    assert solution.converged.all()
    assert solution.displacement == pytest.approx(0.0, abs=1e-6)
    assert solution.pressure == pytest.approx(0.05 * sphere.compliance.uniform_stiffness, rel=1e-3)


# --- coupled search for displacements and pressures ---

ELASTIC = cached_compliance(bs.ClosedShell(), HIP, bs.Cup(), radians(3.0))
LANES = bore_of(ELASTIC)
WEAR = np.maximum(ELASTIC.grid.centroids[0] + ELASTIC.grid.centroids[2], 0.0) ** 2
WORN = WEAR + WEAR[:, ::-1]  # to the last digit symmetric about the plane of the load
FORCES = np.array([400.0, 3000.0, 1200.0, 2000.0])
AXES = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -0.8, 0.6], [0.36, 0.48, 0.8]])


def solve(bore, rows, tolerance=1e-6):
    start = initial_displacement(bore.gap, ELASTIC.uniform_stiffness, bore.gap.depth, FORCES[rows], AXES[rows])
    load = AXES[rows] * FORCES[rows, None]
    return solve_lanes(bore, coarser_lanes(bore), load, FORCES[rows], start, tolerance)


def test_contacts_in_a_plane_of_symmetry_have_the_tangents_of_both_sides():
    share = (solve(LANES, np.arange(2)).pressure > 0).astype(np.float32)
    tangents = solve_tangents(LANES, share, np.ones((share.shape[1], 1)))
    bore = make_bore_arrays(LANES)
    expected = solve_sensitivity(bore, share.T, TANGENT_ITERATIONS).tangent
    assert tangents == pytest.approx(expected, abs=1e-5 * float(abs(expected).max()))


@pytest.mark.parametrize("depth", [0.0, 0.015])
def test_each_lane_balances_its_load_with_closed_gaps(depth):
    bore = bore_of(ELASTIC, depth=depth * WORN)
    solution = solve(bore, np.arange(4))
    overlap = bore.gap.overlap(solution.displacement)
    gap = ELASTIC.softness(solution.pressure) - overlap
    scale = overlap.max(axis=(1, 2), keepdims=True)
    assert solution.converged.all()
    assert (solution.pressure >= 0).all()
    assert (np.where(solution.pressure > 0, abs(gap), 0.0) <= 1.1e-6 * scale).all()
    assert (gap >= -1.1e-6 * scale).all()
    assert bore.force(solution.pressure) == pytest.approx(AXES * FORCES[:, None], abs=1.1e-6 * FORCES.max())
