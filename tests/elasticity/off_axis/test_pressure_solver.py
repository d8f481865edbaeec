"""Pressure solver: complementarity, energy, tolerance, and pressure changes in a fixed contact."""

from math import pi, radians

import numpy as np
import pytest
from scipy.optimize import nnls

import ballsocket as bs
from ballsocket.elasticity.off_axis.bore_contact import GapField
from ballsocket.elasticity.off_axis.compliance import make_compliance
from ballsocket.elasticity.off_axis.grid import Grid, even_grid
from ballsocket.elasticity.off_axis.pressure_solver import solve_pressure, solve_pressure_change

from ...joints import HIP
from .shapes import RIGID

GRID = even_grid(pi / 2, radians(6.0))
SHELL = make_compliance(bs.ClosedShell(), HIP, bs.Cup(), GRID)
SPRINGS = make_compliance(bs.Springs(), RIGID, bs.Cup(), GRID)
DISPLACEMENTS = np.array([[0.0, 0.0, 0.14], [0.1, 0.05, 0.1], [0.0, 0.0, 0.05], [0.16, 0.0, 0.02]])


def overlap_of(displacement, grid=GRID):
    depth = np.zeros((grid.rings, grid.meridians))
    gap = GapField(grid=grid, clearance=0.1, socket_radius=18.0, depth=depth, kind=bs.LinearGap)
    return gap.overlap(np.atleast_2d(displacement))


@pytest.mark.parametrize(("tolerance", "iterations"), [(1e-4, 4), (1e-6, 6), (1e-9, 14)])
def test_pressures_close_the_gap_or_vanish(tolerance, iterations):
    overlap = overlap_of(DISPLACEMENTS)
    solution = solve_pressure(SHELL, overlap, tolerance=tolerance)
    gap = SHELL.displacement(solution.pressure) - overlap
    scale = overlap.max(axis=(1, 2), keepdims=True).clip(1e-3)
    assert solution.converged.all()
    assert (solution.pressure >= 0).all()
    assert (np.where(solution.pressure > 0, abs(gap), 0.0) <= tolerance * scale).all()
    assert (gap >= -tolerance * scale).all()
    assert not solution.pressure[2].any()  # within the clearance
    assert solution.iterations <= iterations


def test_pressures_agree_with_non_negative_least_squares():
    """S p >= u, p >= 0 and p (S p - u) = 0 by Cholesky factors and another algorithm, in few cells."""
    grid = Grid(edges=np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5]), meridians=16)
    compliance = make_compliance(bs.ClosedShell(), RIGID, bs.Cup(), grid)
    cells = grid.rings * grid.meridians
    unit = np.eye(cells).reshape(cells, grid.rings, grid.meridians)
    matrix = compliance.displacement(unit).reshape(cells, cells).T
    weights = np.repeat(grid.areas[:, 0], grid.meridians)
    symmetric = weights[:, None] * matrix
    factor = np.linalg.cholesky((symmetric + symmetric.T) / 2)
    overlap = overlap_of([0.03, 0.0, 0.104], grid)
    expected, _ = nnls(factor.T, np.linalg.solve(factor, weights * overlap.ravel()))
    assert 0 < (expected > 0).sum() < cells
    pressure = solve_pressure(compliance, overlap, tolerance=1e-9).pressure.ravel()
    assert pressure == pytest.approx(expected, abs=1e-5 * expected.max())


def test_spring_pressures_are_the_modulus_times_the_overlap():
    overlap = overlap_of(DISPLACEMENTS)
    modulus = bs.hess_forsbach(RIGID)
    solution = solve_pressure(SPRINGS, overlap)
    assert solution.pressure == pytest.approx(modulus * np.maximum(overlap, 0.0), rel=1e-5, abs=1e-9)
    energy = modulus / 2 * GRID.integrate_product(np.maximum(overlap, 0.0), np.maximum(overlap, 0.0))
    assert solution.energy == pytest.approx(energy, rel=1e-5, abs=1e-12)


def test_energy_is_that_of_the_pressures_and_stationary():
    """At a tolerance of 1e-3 the energy is accurate to its square."""
    overlap = overlap_of(DISPLACEMENTS[[0, 1, 3]])
    accurate, rough = (solve_pressure(SHELL, overlap, tolerance=tolerance) for tolerance in (1e-8, 1e-3))
    stored = GRID.integrate_product(accurate.pressure, SHELL.displacement(accurate.pressure)) / 2
    assert accurate.energy == pytest.approx(stored, rel=1e-6)
    assert rough.energy == pytest.approx(stored, rel=2e-5)
    assert rough.iterations < accurate.iterations


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_pressures_scale_with_the_overlap(scale):
    overlap = overlap_of(DISPLACEMENTS[:2])
    reference, scaled = solve_pressure(SHELL, overlap), solve_pressure(SHELL, scale * overlap)
    assert scaled.pressure == pytest.approx(scale * reference.pressure, rel=1e-4, abs=1e-5 * scale)
    assert scaled.iterations <= reference.iterations + 2


def test_solution_as_a_start_converges_at_once():
    overlap = overlap_of(DISPLACEMENTS[:2])
    first = solve_pressure(SHELL, overlap)
    assert solve_pressure(SHELL, overlap, first.pressure, 1e-5).iterations == 0
    assert first.iterations > 3


def test_each_contact_has_its_own_tolerance():
    overlap = overlap_of(DISPLACEMENTS[[1, 1]])
    mixed = solve_pressure(SHELL, overlap, tolerance=np.array([1e-2, 1e-9]))
    strict = solve_pressure(SHELL, overlap[:1], tolerance=1e-9)
    assert mixed.pressure[1] == pytest.approx(strict.pressure[0], abs=1e-6)
    assert abs(mixed.pressure[0] - strict.pressure[0]).max() > 1e-4


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_pressure_change_solves_the_touching_cells(scale, tolerance):
    """In touching cells the displacement equals the further overlap; outside the pressure stays 0."""
    touching = overlap_of([0.05, 0.0, 0.13]) > 0.01
    overlap = scale * overlap_of([0.02, 0.1, 0.15])
    change = solve_pressure_change(SHELL, touching, overlap, tolerance=tolerance)
    assert not change[~touching].any()
    residual = np.where(touching, overlap - SHELL.displacement(change), 0.0)
    assert abs(residual).max() <= 3 * tolerance * abs(overlap[touching]).max()
    again = solve_pressure_change(SHELL, touching, overlap, change, tolerance)
    assert again == pytest.approx(change, abs=1e-12 * scale) or tolerance == 1e-2


def test_pressure_change_is_the_difference_of_two_solutions():
    low, high = overlap_of([0.0, 0.0, 0.14]), overlap_of([0.0, 0.0, 0.14 + 1e-5])
    first, second = (solve_pressure(SHELL, overlap, tolerance=1e-10).pressure for overlap in (low, high))
    assert ((first > 0) == (second > 0)).all()
    change = solve_pressure_change(SHELL, first > 0, high - low, tolerance=1e-8)
    assert change == pytest.approx(second - first, abs=1e-4 * abs(change).max())
