"""Gap between ball and bore: exact geometry, derivatives and the estimate of the first displacement."""

from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.bore_contact import GapField, initial_displacement
from ballsocket.elasticity.off_axis.grid import even_grid

GRID = even_grid(1.4, 0.1)
DEPTH = 0.02 * GRID.middles[0] ** 2
DISPLACEMENT = np.array([[0.3, -0.1, 0.4], [0.0, 0.0, 0.0], [-2.0, 1.0, 3.0]])


def gap_field(kind, depth=DEPTH):
    return GapField(grid=GRID, clearance=0.1, socket_radius=18.0, depth=depth, kind=kind)


def test_linear_gap_is_the_normal_displacement():
    overlap = gap_field(bs.LinearGap).overlap(DISPLACEMENT)
    expected = np.tensordot(DISPLACEMENT, GRID.normals, 1) - 0.1 - DEPTH
    assert overlap == pytest.approx(expected)


def test_circular_gap_is_the_distance_to_the_displaced_ball():
    """The point at the overlap from the bore along its normal lies on the ball."""
    gap = gap_field(bs.CircularGap)
    overlap = gap.overlap(DISPLACEMENT)
    for e, field in zip(DISPLACEMENT, overlap, strict=True):
        scale = np.linalg.norm(GRID.normals, axis=0)  # cell means are a little shorter than 1
        along = np.tensordot(e, GRID.normals, 1)
        chord = 17.9**2 - e @ e + along**2
        assert field == pytest.approx(along + np.sqrt(chord) - 18.0 - DEPTH, abs=1e-12)
        assert scale == pytest.approx(1.0, abs=0.01)


def test_ray_that_misses_the_ball_has_a_large_gap():
    gap = gap_field(bs.CircularGap)
    far = np.array([[0.0, 0.0, -100.0]])
    misses = 17.9**2 - 100.0**2 + (100.0 * GRID.normals[2]) ** 2 <= 0
    assert misses.any()
    assert gap.overlap(far)[0][misses] == pytest.approx(-18.0)


@pytest.mark.parametrize("kind", [bs.LinearGap, bs.CircularGap])
def test_slope_is_the_derivative_of_the_overlap(kind):
    gap, h = gap_field(kind), 1e-5
    slope = np.broadcast_to(gap.overlap_slope(DISPLACEMENT), (3, 3, GRID.rings, GRID.meridians))
    for axis in range(3):
        step = h * np.eye(3)[axis]
        difference = (gap.overlap(DISPLACEMENT + step) - gap.overlap(DISPLACEMENT - step)) / (2 * h)
        assert slope[:, axis] == pytest.approx(difference, abs=1e-8)


def test_coarser_gap_averages_the_depth():
    grid = even_grid(1.4, 1.4 / 30)
    gap = GapField(grid=grid, clearance=0.1, socket_radius=18.0, depth=grid.middles[2], kind=bs.LinearGap)
    coarse = gap.on_coarser_grid(grid.coarser_grid)
    assert coarse.depth == pytest.approx(grid.coarsen(grid.middles[2]))
    assert (coarse.grid, coarse.clearance, coarse.kind) == (grid.coarser_grid, 0.1, bs.LinearGap)


def test_initial_displacement_carries_the_load_on_springs_in_a_full_sphere():
    bore = SimpleNamespace(clearance=0.1, socket_radius=18.0)
    axes, force = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]]), np.array([2000.0, 100.0])
    start = initial_displacement(bore, 200.0, np.array([0.0, 0.02]), force, axes)
    length = np.linalg.norm(start, axis=1)
    assert start / length[:, None] == pytest.approx(axes)
    e = length - 0.02
    half_angle = np.arccos(0.1 / e)
    x = np.cos(half_angle)
    carried = 2 * np.pi * 18.0**2 * 200.0 * (e * (1 - x**3) / 3 - 0.1 * (1 - x**2) / 2)
    assert carried == pytest.approx(force, rel=1e-6)
    preloaded = SimpleNamespace(clearance=-0.1, socket_radius=18.0)
    without = initial_displacement(SimpleNamespace(clearance=0.0, socket_radius=18.0), 200.0, np.zeros(2), force, axes)
    assert initial_displacement(preloaded, 200.0, np.zeros(2), force, axes) == pytest.approx(without)
