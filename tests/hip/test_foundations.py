"""Foundations of the socket, contact shares, interpolation to the ball and film formulas in small exact cases."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from ballsocket.elasticity.off_axis.grid import even_grid, graded_grid
from ballsocket.hip.ball_wear import ball_directions, interpolation_at
from ballsocket.hip.elastic_foundation import GridSmoothing, interpolate_loads
from ballsocket.hip.simulation import _relative_discretization_error, check_cycles
from ballsocket.hip.socket_foundation import contact_shares, grid_neighbours, neighbours_in_subset, spring_foundation

CELLS = graded_grid(radians(90.0), radians(6.0))
SPRINGS = spring_foundation(CELLS, modulus=100.0, clearance=0.1, socket_radius=14.1)
TILTED = np.array([[0.0, 0.0, 1000.0], [300.0, 0.0, 900.0], [0.0, -200.0, 400.0]])


def socket_force(foundation, equilibrium):
    return np.einsum("tp,kp,p->tk", equilibrium.pressure, foundation.normals, foundation.areas)


def test_cells_cover_the_bore():
    assert SPRINGS.areas.sum() == pytest.approx(2 * np.pi * 14.1**2, rel=1e-12)
    assert np.linalg.norm(SPRINGS.directions, axis=0) == pytest.approx(1.0, rel=1e-12)
    assert (SPRINGS.max_stiffness, SPRINGS.edge_inset) == (100.0, 0.0)


def test_pressures_of_springs_balance_the_loads():
    depth = np.zeros(len(SPRINGS.areas))
    solved = SPRINGS.solve_equilibrium(TILTED, depth)
    assert solved.converged
    assert socket_force(SPRINGS, solved) == pytest.approx(TILTED, abs=1e-7 * 1000)
    overlap = solved.displacement @ SPRINGS.normals - 0.1
    assert solved.pressure == pytest.approx(100.0 * overlap.clip(0.0), rel=1e-12)
    assert solved.displacement[0, :2] == pytest.approx(0.0, abs=1e-9)


def test_a_lateral_spring_carries_its_part_of_the_load():
    stiffness = np.diag([500.0, 0.0, 0.0])
    solved = SPRINGS.solve_equilibrium(TILTED, np.zeros(len(SPRINGS.areas)), None, stiffness)
    expected = TILTED - solved.displacement @ stiffness
    assert socket_force(SPRINGS, solved) == pytest.approx(expected, abs=1e-7 * 1000)
    assert solved.displacement[1, 0] * 500.0 > 10.0


def test_an_evenly_worn_bore_is_a_larger_clearance():
    worn = SPRINGS.solve_equilibrium(TILTED, np.full(len(SPRINGS.areas), 0.05))
    larger = replace(SPRINGS, clearance=0.15).solve_equilibrium(TILTED, np.zeros(len(SPRINGS.areas)))
    assert worn.pressure == pytest.approx(larger.pressure, rel=1e-9, abs=1e-12)


def test_a_start_without_contact_reaches_the_same_equilibrium():
    depth = np.zeros(len(SPRINGS.areas))
    solved = SPRINGS.solve_equilibrium(TILTED, depth)
    far = replace(solved, displacement=-0.2 * TILTED / 1000.0)
    again = SPRINGS.solve_equilibrium(TILTED, depth, far)
    assert again.converged
    assert again.pressure == pytest.approx(solved.pressure, rel=1e-6, abs=1e-6)


def test_cells_near_contact_are_bounded_by_the_margin_of_the_largest_overlap():
    depth = np.zeros(len(SPRINGS.areas))
    solved = SPRINGS.solve_equilibrium(TILTED, depth)
    overlap = (solved.displacement @ SPRINGS.normals).max(axis=0) - 0.1
    for margin in (0.0, 0.3, 1.0):
        expected = overlap > -margin * overlap.max()
        assert (SPRINGS.cells_near_contact(solved, depth, margin) == expected).all()
    part = np.flatnonzero(SPRINGS.cells_near_contact(solved, depth, 0.3))
    alone = SPRINGS.select_cells(part)
    assert alone.solve_equilibrium(TILTED, depth[part]).pressure == pytest.approx(solved.pressure[:, part], rel=1e-9)
    assert alone.neighbours.max() < len(part)


def test_a_straight_edge_cuts_cells_in_proportion():
    neighbours = np.array([[[0, 0, 1, 2], [1, 2, 3, 3]], [[0, 1, 2, 3]] * 2])
    level = np.array([[3.0, 1.0, -1.0, -3.0], [2.5, 0.5, -1.5, -3.5], [1.0, 1.0, 1.0, 1.0]])
    shares = contact_shares(level, neighbours, 0.0)
    assert shares[0] == pytest.approx([1.0, 1.0, 0.0, 0.0])
    assert shares[1] == pytest.approx([1.0, 0.75, 0.0, 0.0])
    assert shares[2] == pytest.approx(1.0)
    assert contact_shares(level, neighbours, 0.25)[1] == pytest.approx([1.0, 0.5, 0.0, 0.0])


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
    sphere = even_grid(np.pi, radians(10.0))
    centres = interpolation_at(sphere, sphere.middles.reshape(3, 1, -1))
    field = np.random.default_rng(3).normal(size=(1, sphere.rings * sphere.meridians))
    assert centres.interpolate(field) == pytest.approx(field, rel=1e-9, abs=1e-9)
    polar = np.repeat(sphere.polar, sphere.meridians)[None]
    angles = np.linspace(0.4, 2.7, 17)
    for azimuth in (0.0, 2.0, -3.0):
        points = np.stack([np.sin(angles) * np.cos(azimuth), np.sin(angles) * np.sin(azimuth), np.cos(angles)])
        between = interpolation_at(sphere, points[:, None])
        assert between.weights.sum(axis=-1) == pytest.approx(1.0)
        assert between.interpolate(polar)[0] == pytest.approx(angles, rel=1e-12)


def test_points_beyond_the_grid_have_no_weight():
    low = np.array([np.sin(1.7), 0.0, np.cos(1.7)])[:, None, None]
    assert interpolation_at(CELLS, low).weights.sum() == 0


def test_cells_of_the_ball_have_their_axis_to_the_front():
    sphere = even_grid(np.pi, radians(10.0))
    directions = ball_directions(sphere)
    x, y, z = sphere.middles.reshape(3, -1)
    assert (directions == np.stack([y, z, x])).all()


@pytest.mark.parametrize(("waves", "factor"), [(0, 1.0), (6, 0.75), (9, 0.5), (12, 0.25), (18, 0.0)])
def test_smoothing_filters_waves_around_the_equator_by_one_two_one(waves, factor):
    """[1 2 1]/4 multiplies a wave over n cells by cos²(π/n); there are 36 cells around the equator."""
    sphere = even_grid(np.pi, radians(10.0))
    assert sphere.meridians == 36
    field = np.cos(waves * sphere.azimuth + (np.pi / 4 if waves == 18 else 0.0)) * np.ones((sphere.rings, 1))
    equator = GridSmoothing(grid=sphere)(field)[sphere.rings // 2]
    np.testing.assert_allclose(equator, factor * field[0], atol=0.012)


def test_smoothing_removes_alternate_rings_at_the_equator():
    sphere = even_grid(np.pi, radians(5.0))
    rings = (-1.0) ** np.arange(sphere.rings)[:, None] * np.ones(sphere.meridians)
    equator = GridSmoothing(grid=sphere)(rings)[sphere.rings // 2]
    np.testing.assert_allclose(equator, 0.0, atol=5e-3)


def test_load_levels_interpolate_every_load_of_one_direction():
    sizes = np.linspace(10.0, 3000.0, 50)
    loads = sizes[:, None] * np.array([0.0, 0.6, 0.8])
    levels = interpolate_loads(loads)
    assert len(levels.loads) == 12
    assert levels.weights.sum(axis=1) == pytest.approx(1.0)
    assert levels.interpolate(levels.loads) == pytest.approx(loads, rel=1e-12)
    magnitudes = np.linalg.norm(levels.loads, axis=1)
    assert (magnitudes[0], magnitudes[-1]) == pytest.approx((10.0, 3000.0))
    assert (np.diff(magnitudes, n=2) > 0).all()  # closer to each other at small loads
    assert len(interpolate_loads(loads[:12]).loads) == 12
    turned = loads.copy()
    turned[3] = [1.0, 0.0, 50.0]
    assert len(interpolate_loads(turned).loads) == 50
    same = interpolate_loads(np.tile([0.0, 0.0, 500.0], (40, 1)))
    assert same.loads.tolist() == [[0.0, 0.0, 500.0]]
    assert same.interpolate(same.loads) == pytest.approx(np.tile([0.0, 0.0, 500.0], (40, 1)))


def test_numerical_errors_follow_from_halved_steps():
    ratio = 1 / (1 - 2**-1.5)
    assert _relative_discretization_error([1.0, 1.1, 1.2]) == pytest.approx(ratio * 0.2 / 1.2)
    assert _relative_discretization_error([1.0, 0.9, 1.0]) == pytest.approx(ratio * 0.2)
    assert _relative_discretization_error([0.0, 0.0, 0.0]) == 0.0


def test_cycle_counts_are_sorted_and_end_with_the_total():
    assert check_cycles(5.0, [3, 1, 3]) == [1.0, 3.0, 5.0]
    assert check_cycles(5.0, [0, 5]) == [0.0, 5.0]
    for cycles, counts in ((0.0, []), (float("inf"), []), (5.0, [5.1]), (5.0, [-1])):
        with pytest.raises(ValueError, match="is not allowed"):
            check_cycles(cycles, counts)
