"""Directions in the cup, grids of rings and meridians, the gap between ball and bore, and the patch of a contact."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.contact_patch import ContactPatch
from ballsocket.elasticity.off_axis.directions import (
    check_direction,
    magnitudes_and_directions,
    polar_angle,
    tangents,
    unit_vectors,
)
from ballsocket.elasticity.off_axis.grid import Grid, even_grid

from .shapes import direction, gap_of, measures_of


def test_unit_vectors_have_their_angles_and_right_handed_tangents():
    polar, azimuth = np.linspace(0.1, 3.0, 7)[:, None], np.linspace(-3.0, 3.0, 5)
    n = unit_vectors(polar, azimuth)
    assert polar_angle(5.0 * n) == pytest.approx(polar + 0 * azimuth)
    assert np.arctan2(n[1], n[0]) == pytest.approx(azimuth + 0 * polar)
    first, second = tangents(n)
    assert np.linalg.norm(first, axis=0) == pytest.approx(1.0)
    assert (first * n).sum(axis=0) == pytest.approx(0.0, abs=1e-15)
    assert second == pytest.approx(np.cross(n, first, axis=0))


def test_directions_are_accurate_at_both_poles_and_zero_for_zero_vectors():
    assert polar_angle(np.array([[1e-9, 0.0], [0.0, 1e-9], [1.0, -1.0]])) == pytest.approx([1e-9, pi - 1e-9], rel=1e-6)
    length, direction = magnitudes_and_directions(np.array([[0.0, 3.0, 4.0], [0.0, 0.0, 0.0], [-2.0, 0.0, 0.0]]))
    assert length == pytest.approx([5.0, 0.0, 2.0])
    assert direction == pytest.approx(np.array([[0.0, 0.6, 0.8], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]))


@pytest.mark.parametrize("scale", [1e-200, 1e-99, 1.0, 1e99, 1e200])
def test_directions_of_extreme_length_are_scaled(scale):
    checked = check_direction([[3.0 * scale, 0.0, 4.0 * scale]])
    length = np.linalg.norm(checked, axis=-1)
    assert 0 < length < np.inf
    assert checked / length[:, None] == pytest.approx(np.array([[0.6, 0.0, 0.8]]))
    assert check_direction([1e99, 0, 0])[0] == 1e99
    assert check_direction([1e101, 0, 0])[0] == pytest.approx(1.0)


# --- grids ---


def test_normals_are_means_over_their_cells():
    cells = Grid(edges=np.array([0.0, 0.3, 0.5, 1.1]), meridians=8)
    points, weights = np.polynomial.legendre.leggauss(12)
    for ring in range(3):
        low, high = cells.edges[ring : ring + 2]
        polar = (low + high) / 2 + (high - low) / 2 * points
        azimuth = cells.azimuth[2] + pi / 8 * points
        n = unit_vectors(polar[:, None], azimuth[None])
        measure = (weights * np.sin(polar))[:, None] * weights
        mean = (n * measure).sum(axis=(1, 2)) / measure.sum()
        assert cells.normals[:, ring, 2] == pytest.approx(mean, abs=1e-12)
        assert cells.centroids[:, ring, 2] == pytest.approx(mean / np.linalg.norm(mean), abs=1e-12)
        assert cells.middles[:, ring, 2] == pytest.approx(unit_vectors((low + high) / 2, cells.azimuth[2]))


# --- gap ---

GRID = even_grid(1.4, 0.1)
DEPTH = 0.02 * GRID.middles[0] ** 2
DISPLACEMENT = np.array([[0.3, -0.1, 0.4], [0.0, 0.0, 0.0], [-2.0, 1.0, 3.0]])


def test_overlap_is_the_normal_displacement_or_the_distance_to_the_displaced_ball():
    """The point at the circular overlap from the bore along its normal lies on the ball."""
    along = np.tensordot(DISPLACEMENT, GRID.normals, 1)
    assert gap_of(GRID, DEPTH).overlap(DISPLACEMENT) == pytest.approx(along - 0.1 - DEPTH)
    circular = gap_of(GRID, DEPTH, kind=bs.CircularGap)
    for e, part, field in zip(DISPLACEMENT, along, circular.overlap(DISPLACEMENT), strict=True):
        assert field == pytest.approx(part + np.sqrt(17.9**2 - e @ e + part**2) - 18.0 - DEPTH, abs=1e-12)
    misses = 17.9**2 - 100.0**2 + (100.0 * GRID.normals[2]) ** 2 <= 0
    assert misses.any()
    far = circular.overlap(np.array([[0.0, 0.0, -100.0]]))
    assert far[0][misses] == pytest.approx(-18.0)  # the ray misses the ball


# --- patch of one contact, with synthetic pressures ---

CAP_GRID = even_grid(radians(90.0), radians(3.0))


def cap(axis, half_angle, inset=0.0):
    """Make a patch whose level is linear in the angle from its axis and whose pressure is parabolic."""
    angle = np.arccos(np.clip(np.tensordot(axis, CAP_GRID.middles, 1), -1, 1))
    level = half_angle - angle
    pressure = 10.0 * np.maximum(1 - (angle / half_angle) ** 2, 0.0)
    return ContactPatch(grid=CAP_GRID, pressure=pressure, level=level, axis=axis, inset=inset)


def patch_of(pressure, level, tilt, grid=CAP_GRID):
    return ContactPatch(grid=grid, pressure=pressure, level=level, axis=direction(tilt), inset=0.0)


@pytest.mark.parametrize(("tilt", "azimuth"), [(0.0, 0.6), (0.02, 3.0), (0.5, 0.0), (0.8, -1.5)])
def test_outline_of_a_cap_is_its_circle(tilt, azimuth):
    axis, half_angle = direction(tilt, azimuth), radians(30.0)
    patch = cap(axis, half_angle)
    assert patch.outline.shape == (90, 3)
    assert np.arccos(patch.outline @ axis) == pytest.approx(half_angle, abs=radians(0.25))
    measured = measures_of(patch)
    assert measured.half_angle == pytest.approx(half_angle, abs=radians(0.1))
    assert not measured.edge_loaded
    assert measured.edge_margin == pytest.approx(radians(60.0) - tilt, abs=radians(0.15))


def test_pressure_is_interpolated_across_the_pole_and_the_first_meridian():
    patch = cap(direction(0.0), radians(40.0))
    angle = np.array([0.0, 0.03, 0.2, 0.5])
    expected = 10.0 * (1 - (angle / radians(40.0)) ** 2)
    assert patch.pressure_along(angle) == pytest.approx(expected, abs=0.02)
    for azimuth in (0.0, 1e-3, -1e-3, pi):
        pressure = patch.pressure_at(direction(0.3, azimuth))
        assert pressure == pytest.approx(10 * (1 - (0.3 / radians(40.0)) ** 2), abs=0.02)
    assert patch.pressure_at(direction(1.0)) == 0.0
    assert patch.pressure_at(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])) == pytest.approx([0.0, 10.0], abs=0.02)


def test_contact_that_reaches_the_rim_ends_there_and_has_a_margin_where_it_almost_does():
    patch = cap(direction(radians(75.0)), radians(30.0))
    assert measures_of(patch).edge_loaded
    assert measures_of(patch).edge_margin == 0.0
    outline = polar_angle(patch.outline.T)
    assert outline.max() == pytest.approx(CAP_GRID.reach, abs=1e-9)
    assert outline.min() == pytest.approx(radians(45.0), abs=radians(0.3))
    cut = np.arccos(patch.outline @ patch.axis)
    assert cut.min() == pytest.approx(radians(15.0), abs=1e-9)
    assert cut.max() == pytest.approx(radians(30.0), abs=radians(0.6))
    middle, end = CAP_GRID.polar[-1], CAP_GRID.reach
    last, before = (patch.pressure_at(direction(polar)) for polar in CAP_GRID.polar[[-1, -2]])
    expected = last + (last - before) * (end - middle) / (middle - CAP_GRID.polar[-2])
    assert patch.pressure_at(direction(end - 1e-9)) == pytest.approx(expected, rel=1e-6)
    patch = cap(direction(radians(58.5) + 1e-3), radians(30.0))
    level = patch.level.copy()
    level[-1] = -1e-12
    level[-2] = 0.1
    tight = patch_of(np.where(level > 0, 1.0, 0.0), level, tilt=radians(58.5) + 1e-3)
    assert measures_of(tight).edge_margin == pytest.approx(1e-6)


def test_contact_all_around_the_bore_has_no_outline():
    sphere, full = even_grid(pi, radians(6.0)), np.ones((CAP_GRID.rings, CAP_GRID.meridians))
    closed = np.ones((sphere.rings, sphere.meridians))
    assert patch_of(closed, closed, tilt=0.3, grid=sphere).outline == pytest.approx(np.tile(direction(0.3), (90, 1)))
    hemisphere = patch_of(full, full, tilt=0.3)
    assert polar_angle(hemisphere.outline.T) == pytest.approx(pi / 2, abs=1e-4)
    assert measures_of(hemisphere).half_angle == pytest.approx(pi / 2, abs=0.02)
