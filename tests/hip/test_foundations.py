"""Foundations of the socket, interpolation to the ball, and springs solved by NumPy, numba and JAX, in small cases."""

from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from math import radians

import numpy as np
import pytest

from ballsocket.elasticity.off_axis.grid import even_grid, graded_grid
from ballsocket.hip import socket_foundation, spring_equilibrium
from ballsocket.hip.ball_wear import ball_directions, interpolation_at
from ballsocket.hip.elastic_foundation import interpolate_loads, smooth_fields
from ballsocket.hip.socket_foundation import NO_LATERAL_SPRING, grid_neighbours, neighbours_in_subset, spring_foundation
from ballsocket.hip.spring_equilibrium import (
    join_contacts,
    load_blocks,
    newton_step,
    solve_in_blocks,
    solve_patients,
    spring_solver,
)
from ballsocket.hip.wear_integrator import WearIntegrator

from .hips import QUICK, hip, socket_force

CELLS = graded_grid(radians(90.0), radians(6.0))
SPRINGS = spring_foundation(CELLS, modulus=100.0, clearance=0.1, socket_radius=14.1)
SPHERE = even_grid(np.pi, radians(10.0))
UNWORN = np.zeros(len(SPRINGS.areas))
WORN = np.random.default_rng(1).uniform(0.0, 0.02, len(SPRINGS.areas))
LATERAL = np.diag([500.0, 0.0, 0.0])
TILTED = np.array([[0.0, 0.0, 1000.0], [300.0, 0.0, 900.0], [0.0, -200.0, 400.0]])


def test_pressures_of_springs_balance_the_loads():
    solved = SPRINGS.solve_equilibrium(TILTED, UNWORN)
    assert solved.converged
    assert socket_force(SPRINGS, solved) == pytest.approx(TILTED, abs=1e-7 * 1000)
    overlap = solved.displacement @ SPRINGS.normals - 0.1
    assert solved.pressure == pytest.approx(100.0 * overlap.clip(0.0), rel=1e-12)
    assert solved.displacement[0, :2] == pytest.approx(0.0, abs=1e-9)
    again = SPRINGS.solve_equilibrium(TILTED, UNWORN, replace(solved, displacement=-0.2 * TILTED / 1000.0))
    assert again.converged  # from a start without contact
    assert again.pressure == pytest.approx(solved.pressure, rel=1e-6, abs=1e-6)
    worn = SPRINGS.solve_equilibrium(TILTED, UNWORN + 0.05)
    larger = replace(SPRINGS, clearance=0.15).solve_equilibrium(TILTED, UNWORN)
    assert worn.pressure == pytest.approx(larger.pressure, rel=1e-9, abs=1e-12)
    solved = SPRINGS.solve_equilibrium(TILTED, UNWORN, None, LATERAL)  # a lateral spring carries its part
    expected = TILTED - solved.displacement @ LATERAL
    assert socket_force(SPRINGS, solved) == pytest.approx(expected, abs=1e-7 * 1000)
    assert solved.displacement[1, 0] * 500.0 > 10.0


def test_cells_near_contact_are_bounded_by_the_margin_of_the_largest_overlap():
    solved = SPRINGS.solve_equilibrium(TILTED, WORN)
    overlap = (solved.displacement @ SPRINGS.normals).max(axis=0) - 0.1 - WORN
    for margin in (0.0, 0.3, 1.0):
        expected = overlap > -margin * overlap.max()
        assert (SPRINGS.cells_near_contact(solved, WORN, margin) == expected).all()
    part = np.flatnonzero(SPRINGS.cells_near_contact(solved, WORN, 0.3))
    alone = SPRINGS.select_cells(part)
    assert alone.solve_equilibrium(TILTED, WORN[part]).pressure == pytest.approx(solved.pressure[:, part], rel=1e-9)
    assert alone.neighbours.max() < len(part)


def test_neighbours_cross_the_pole_and_end_at_the_rim():
    pairs = grid_neighbours(CELLS)
    rings, meridians = CELLS.rings, CELLS.meridians
    cells = np.arange(rings * meridians).reshape(rings, meridians)
    (before, after), (left, right) = (pair.reshape(2, rings, meridians) for pair in pairs)
    assert (before[1:] == cells[:-1]).all()
    assert (after[:-1] == cells[1:]).all()
    assert (after[-1] == cells[-1]).all()
    assert before[0, 0] == cells[0, meridians // 2]
    assert {left[3, 0], right[3, 0]} == {cells[3, 1], cells[3, -1]}
    subset = neighbours_in_subset(pairs, cells[2:4].ravel())
    assert (subset[0, 0].reshape(2, -1)[0] == np.arange(meridians)).all()  # outside the subset: the cell itself
    assert (subset[0, 1].reshape(2, -1)[0] == meridians + np.arange(meridians)).all()


def test_interpolation_is_exact_at_centres_and_for_fields_of_the_polar_angle():
    centres = interpolation_at(SPHERE, SPHERE.middles.reshape(3, 1, -1))
    field = np.random.default_rng(3).normal(size=(1, SPHERE.rings * SPHERE.meridians))
    assert centres.interpolate(field) == pytest.approx(field, rel=1e-9, abs=1e-9)
    polar, angles = np.repeat(SPHERE.polar, SPHERE.meridians)[None], np.linspace(0.4, 2.7, 17)
    for azimuth in (0.0, 2.0, -3.0):
        points = np.stack([np.sin(angles) * np.cos(azimuth), np.sin(angles) * np.sin(azimuth), np.cos(angles)])
        between = interpolation_at(SPHERE, points[:, None])
        assert between.weights.sum(axis=0) == pytest.approx(1.0)
        assert between.interpolate(polar)[0] == pytest.approx(angles, rel=1e-12)
    beyond_the_rim = np.array([np.sin(1.7), 0.0, np.cos(1.7)])[:, None, None]
    assert interpolation_at(CELLS, beyond_the_rim).weights.sum() == 0
    x, y, z = SPHERE.middles.reshape(3, -1)
    assert (ball_directions(SPHERE) == np.stack([y, z, x])).all()  # the axis of the ball's cells is to the front


@pytest.mark.parametrize(("waves", "factor"), [(0, 1.0), (6, 0.75), (9, 0.5), (12, 0.25), (18, 0.0)])
def test_smoothing_filters_waves_around_the_equator_by_one_two_one(waves, factor):
    """[1 2 1]/4 multiplies a wave over n cells by cos²(π/n); there are 36 cells around the equator."""
    assert SPHERE.meridians == 36
    field = np.cos(waves * SPHERE.azimuth + (np.pi / 4 if waves == 18 else 0.0)) * np.ones((SPHERE.rings, 1))
    equator = smooth_fields(SPHERE, field)[SPHERE.rings // 2]
    np.testing.assert_allclose(equator, factor * field[0], atol=0.012)


def test_smoothing_conserves_volume_and_removes_waves_of_the_grid():
    grid = even_grid(radians(90.0), radians(5.0))
    smooth, field = partial(smooth_fields, grid), np.random.default_rng(5).uniform(size=(grid.rings, grid.meridians))
    assert (smooth(field) * grid.areas).sum() == pytest.approx((field * grid.areas).sum(), rel=1e-12)
    assert smooth(np.ones_like(field)) == pytest.approx(1.0, rel=1e-12)
    board = (-1.0) ** np.add.outer(np.arange(grid.rings), np.arange(grid.meridians))
    assert np.abs(smooth(board)).max() < 1e-12
    wide = np.cos(grid.polar)[:, None] + 0 * grid.azimuth
    assert smooth(wide)[:-1] == pytest.approx(wide[:-1], abs=5e-3)
    sphere = even_grid(np.pi, radians(5.0))
    rings = (-1.0) ** np.arange(sphere.rings)[:, None] * np.ones(sphere.meridians)
    np.testing.assert_allclose(smooth_fields(sphere, rings)[sphere.rings // 2], 0.0, atol=5e-3)


def test_load_levels_interpolate_every_load_of_one_direction():
    loads = np.linspace(10.0, 3000.0, 50)[:, None] * np.array([0.0, 0.6, 0.8])
    levels, weights = interpolate_loads(loads)
    assert len(levels) == 12
    assert weights.sum(axis=1) == pytest.approx(1.0)
    assert weights @ levels == pytest.approx(loads, rel=1e-12)
    magnitudes = np.linalg.norm(levels, axis=1)
    assert (magnitudes[0], magnitudes[-1]) == pytest.approx((10.0, 3000.0))
    assert (np.diff(magnitudes, n=2) > 0).all()  # closer to each other at small loads
    assert len(interpolate_loads(loads[:12])[0]) == 12
    loads[3] = [1.0, 0.0, 50.0]
    assert len(interpolate_loads(loads)[0]) == 50
    same, weights = interpolate_loads(np.tile([0.0, 0.0, 500.0], (40, 1)))
    assert same.tolist() == [[0.0, 0.0, 500.0]]
    assert weights @ same == pytest.approx(np.tile([0.0, 0.0, 500.0], (40, 1)))


# the compiled pass equals NumPy's, in any contact and in any blocks of loads

CONTACTS = {
    "unworn": (np.zeros_like(WORN), NO_LATERAL_SPRING, False),
    "worn": (WORN, NO_LATERAL_SPRING, False),
    "another depth under each load": (WORN * np.array([[0.5], [1.0], [2.0]]), NO_LATERAL_SPRING, False),
    "a lateral spring": (WORN, LATERAL, False),
    "a start without contact": (WORN, NO_LATERAL_SPRING, True),
}


def solved_by(solver, monkeypatch, depth, lateral, far):
    monkeypatch.setattr(socket_foundation, "spring_solver", lambda: solver)
    start = SPRINGS.solve_equilibrium(TILTED, depth)
    start.displacement[:] *= -2.0
    return SPRINGS.solve_equilibrium(TILTED, depth, start if far else None, lateral)


@pytest.fixture(scope="module")
def compiled():
    pytest.importorskip("numba")
    return spring_solver()


@pytest.mark.parametrize("name", CONTACTS)
def test_the_compiled_pass_equals_numpy(name, compiled, monkeypatch):
    one, other = (solved_by(solver, monkeypatch, *CONTACTS[name]) for solver in (compiled, solve_in_blocks))
    assert (one.converged, other.converged) == (True, True)
    np.testing.assert_allclose(one.displacement, other.displacement, rtol=0, atol=1e-11 * 0.1)
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-11 * other.pressure.max())


def test_a_million_cycles_and_a_load_that_no_contact_balances_are_the_same_on_both_paths(compiled, monkeypatch):
    for solver in (compiled, solve_in_blocks):
        assert not solved_by(solver, monkeypatch, np.nan * WORN, NO_LATERAL_SPRING, False).converged
    integrators = []
    for solver in (compiled, solve_in_blocks):
        monkeypatch.setattr(socket_foundation, "spring_solver", lambda solver=solver: solver)
        integrators.append(WearIntegrator(setup=hip(**QUICK)).run_until(1e6, lambda cycles: None))
    one, other = integrators
    assert one.steps == other.steps
    assert one.volume == pytest.approx(other.volume, rel=1e-11)
    np.testing.assert_allclose(one.depth, other.depth, rtol=0, atol=1e-11 * other.depth.max())


def test_blocks_of_loads_do_not_change_the_result(monkeypatch):
    together = solved_by(solve_in_blocks, monkeypatch, *CONTACTS["another depth under each load"])
    near = SPRINGS.cells_near_contact(together, WORN, 0.3)
    monkeypatch.setattr(spring_equilibrium, "_BLOCK_SIZE", 2 * len(SPRINGS.areas))
    assert list(load_blocks(3, len(SPRINGS.areas))) == [slice(0, 2), slice(2, 4)]
    in_blocks = solved_by(solve_in_blocks, monkeypatch, *CONTACTS["another depth under each load"])
    np.testing.assert_allclose(in_blocks.pressure, together.pressure, rtol=0, atol=1e-12 * together.pressure.max())
    assert (SPRINGS.cells_near_contact(together, WORN, 0.3) == near).all()


def test_numpy_solves_where_numba_is_not_installed_which_needs_no_folder_for_its_cache(monkeypatch):
    monkeypatch.setattr(spring_equilibrium, "find_spec", lambda name: None if name == "numba" else find_spec(name))
    assert spring_solver() is solve_in_blocks
    numba = pytest.importorskip("numba")
    plain = numba.njit

    def without_folder(function, cache=False, **options):
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return plain(function, **options)

    monkeypatch.setattr(numba, "njit", without_folder)
    assert spring_equilibrium._compiled_solver.__wrapped__().py_func is spring_equilibrium._solve_one_by_one


@pytest.mark.parametrize("softest", [1.0, 1e-12])
def test_the_newton_step_solves_its_equations(softest):
    """One cell in contact has a stiffness in one direction only: the regularisation holds the others."""
    normal = np.array([0.3, -0.5, np.sqrt(1 - 0.34)])
    stiffness = 400.0 * np.outer(normal, normal) + 400.0 * softest * np.eye(3)
    force = np.array([20.0, -3.0, 500.0]) if softest == 1.0 else 500.0 * normal
    step = np.array(newton_step(tuple(stiffness[np.triu_indices(3)]), tuple(force)))
    np.testing.assert_allclose(stiffness @ step, force, rtol=0, atol=1e-9 * 500.0)


# springs of many patients in JAX

DEPTHS = np.random.default_rng(2).uniform(0.0, 0.02, (3, len(SPRINGS.areas)))


@pytest.fixture
def jax():
    pytest.importorskip("jax")


def contacts(depths, lateral=NO_LATERAL_SPRING):
    """Contacts of three patients: another clearance, modulus, load and worn depth each."""
    patients = zip((0.05, 0.1, 0.2), (80.0, 100.0, 300.0), (0.5, 1.0, 2.0), depths, strict=True)
    return [
        replace(SPRINGS, clearance=clearance, modulus=modulus).contact(factor * TILTED, depth, lateral)
        for clearance, modulus, factor, depth in patients
    ]


@pytest.mark.parametrize(
    ("depths", "lateral"),
    [(DEPTHS, NO_LATERAL_SPRING), (DEPTHS[:, None] * np.array([[0.5], [1.0], [2.0]]), LATERAL)],
)
def test_every_patient_has_the_equilibrium_of_numpy(jax, depths, lateral):
    patients = contacts(depths, lateral)
    start = np.stack([factor * TILTED / 1000.0 for factor in (0.3, 0.2, -0.2)])
    solved = solve_patients(join_contacts(patients), start)
    assert solved.displacement.dtype == np.float64
    assert np.asarray(solved.converged).all()
    for patient, contact in enumerate(patients):
        displacement, pressure = start[patient].copy(), np.empty((3, len(SPRINGS.areas)))
        assert solve_in_blocks(contact, displacement, pressure)
        np.testing.assert_allclose(solved.displacement[patient], displacement, rtol=0, atol=1e-12)
        np.testing.assert_allclose(solved.pressure[patient], pressure, rtol=0, atol=1e-11 * pressure.max())


def test_a_patient_that_does_not_converge_leaves_the_others_converged(jax):
    patients = contacts(np.stack([DEPTHS[0], np.full_like(DEPTHS[0], np.nan), DEPTHS[2]]))
    solved = solve_patients(join_contacts(patients), np.broadcast_to(0.2 * TILTED / 1000.0, (3, 3, 3)))
    assert np.asarray(solved.converged).tolist() == [True, False, True]


def test_contacts_that_do_not_fit_are_refused(jax):
    one, two, _ = contacts(DEPTHS)
    start = np.broadcast_to(0.2 * TILTED / 1000.0, (2, 3, 3))
    few = SPRINGS.contact(TILTED[:2], DEPTHS[0], NO_LATERAL_SPRING)
    many = SPRINGS.contact(TILTED, np.tile(DEPTHS[0], (3, 1)), NO_LATERAL_SPRING)
    for join, error, message in [
        (lambda: join_contacts([]), ValueError, "at least one patient"),
        (lambda: join_contacts([one, few]), ValueError, "got 2 loads on .* cells, 3 loads on .* cells"),
        (lambda: join_contacts([one, many]), ValueError, "a depth under each load, or one depth"),
        (lambda: solve_patients(join_contacts([one, two]), start[:1]), ValueError, r"shape \(1, 3, 3\) is not"),
        (lambda: join_contacts(one), TypeError, "contacts must be a list of SpringContact, got"),
        (lambda: solve_patients(one, start), TypeError, "contacts must be those of join_contacts"),
    ]:
        with pytest.raises(error, match=message):
            join()
