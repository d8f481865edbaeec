"""Patch of one contact with synthetic pressures: largest pressure, outline, half angle and margin to the rim."""

from math import cos, pi, radians

import numpy as np
import pytest

from ballsocket.elasticity.off_axis.contact_patch import ContactPatch
from ballsocket.elasticity.off_axis.directions import polar_angle, unit_vectors
from ballsocket.elasticity.off_axis.grid import even_grid

GRID = even_grid(radians(90.0), radians(3.0))


def direction(tilt, azimuth=0.0):
    return unit_vectors(np.asarray(tilt), np.asarray(azimuth))


def cap(axis, half_angle, inset=0.0):
    """Make a patch whose level is linear in the angle from its axis and whose pressure is parabolic."""
    angle = np.arccos(np.clip(np.tensordot(axis, GRID.middles, 1), -1, 1))
    level = half_angle - angle
    pressure = 10.0 * np.maximum(1 - (angle / half_angle) ** 2, 0.0)
    return ContactPatch(grid=GRID, pressure=pressure, level=level, axis=axis, inset=inset)


def patch_of(pressure, level, tilt, grid=GRID):
    return ContactPatch(grid=grid, pressure=pressure, level=level, axis=direction(tilt), inset=0.0)


@pytest.mark.parametrize(("tilt", "azimuth"), [(0.0, 0.6), (0.02, 3.0), (0.5, 0.0), (0.8, -1.5)])
def test_outline_of_a_cap_is_its_circle(tilt, azimuth):
    axis, half_angle = direction(tilt, azimuth), radians(30.0)
    patch = cap(axis, half_angle)
    assert patch.outline.shape == (90, 3)
    assert np.arccos(patch.outline @ axis) == pytest.approx(half_angle, abs=radians(0.25))
    assert patch.half_angle == pytest.approx(half_angle, abs=radians(0.1))
    assert not patch.edge_loaded
    assert patch.edge_margin == pytest.approx(radians(60.0) - tilt, abs=radians(0.15))


def test_first_ray_of_the_outline_points_away_from_the_pole():
    patch = cap(direction(0.5, 0.7), radians(20.0))
    assert polar_angle(patch.outline[0]) == pytest.approx(0.5 + radians(20.0), abs=radians(0.2))
    assert polar_angle(patch.outline[45]) == pytest.approx(0.5 - radians(20.0), abs=radians(0.2))
    quarter = patch.outline[22:24].mean(axis=0)
    assert np.arctan2(quarter[1], quarter[0]) > 0.7


def test_inset_moves_the_edge_inside_by_a_fraction_of_a_ring():
    plain, inset = (cap(direction(0.4), radians(30.0), inset) for inset in (0.0, 0.5))
    assert plain.half_angle - inset.half_angle == pytest.approx(0.5 * GRID.width, rel=0.02)
    assert inset.edge_margin - plain.edge_margin == pytest.approx(0.5 * GRID.width, rel=0.02)


@pytest.mark.parametrize("tilt", [0.0, 0.3, 0.9])
def test_largest_pressure_is_located_between_the_cells(tilt):
    axis = direction(tilt, 0.4)
    value, location = cap(axis, radians(25.0)).largest
    assert value == pytest.approx(10.0, rel=2e-3)
    assert np.arccos(min(location @ axis, 1.0)) < radians(0.6)


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


def test_edge_lies_between_the_last_loaded_and_the_first_open_cell():
    """The levels of further cells do not matter: the edge divides the distance of two middles as 3 : 1."""
    rings = np.where(np.arange(GRID.rings) <= 12, 3.0, -50.0)
    rings[13] = -1.0
    level = rings[:, None] * np.ones(GRID.meridians)
    patch = patch_of(np.maximum(level, 0.0), level, tilt=0.0)
    edge = GRID.polar[12] + 0.75 * (GRID.polar[13] - GRID.polar[12])
    assert patch.edge_margin == pytest.approx(GRID.reach - edge, abs=1e-9)


def test_contact_that_reaches_the_rim_ends_there():
    patch = cap(direction(radians(75.0)), radians(30.0))
    assert patch.edge_loaded
    assert patch.edge_margin == 0.0
    outline = polar_angle(patch.outline.T)
    assert outline.max() == pytest.approx(GRID.reach, abs=1e-9)
    assert outline.min() == pytest.approx(radians(45.0), abs=radians(0.3))
    cut = np.arccos(patch.outline @ patch.axis)
    assert cut.min() == pytest.approx(radians(15.0), abs=1e-9)
    assert cut.max() == pytest.approx(radians(30.0), abs=radians(0.6))


def test_pressure_beyond_the_last_middle_is_extrapolated_to_the_rim():
    patch = cap(direction(radians(75.0)), radians(30.0))
    middle, end = GRID.polar[-1], GRID.reach
    last, before = (patch.pressure_at(direction(polar)) for polar in GRID.polar[[-1, -2]])
    expected = last + (last - before) * (end - middle) / (middle - GRID.polar[-2])
    assert patch.pressure_at(direction(end - 1e-9)) == pytest.approx(expected, rel=1e-6)


def test_margin_of_a_contact_that_almost_reaches_the_rim_is_positive():
    patch = cap(direction(radians(58.5) + 1e-3), radians(30.0))
    level = patch.level.copy()
    level[-1] = -1e-12
    level[-2] = 0.1
    tight = patch_of(np.where(level > 0, 1.0, 0.0), level, tilt=radians(58.5) + 1e-3)
    assert tight.edge_margin == pytest.approx(1e-6)


def test_ring_around_the_load_has_the_half_angle_of_its_cells():
    loaded = (GRID.polar > 0.5) & (GRID.polar < 1.0)
    pressure = np.where(loaded, 1.0, 0.0)[:, None] * np.ones(GRID.meridians)
    low, high = GRID.edges[:-1][loaded].min(), GRID.edges[1:][loaded].max()
    half_angle = patch_of(pressure, pressure - 0.5, tilt=0.0).half_angle
    assert half_angle == pytest.approx(np.arccos(1 - (cos(low) - cos(high))))


def test_contact_beside_the_load_is_outlined_from_its_largest_pressure():
    centre = direction(0.8)
    shifted = cap(centre, radians(20.0))
    patch = patch_of(shifted.pressure, shifted.level, tilt=0.1)
    assert np.arccos(patch.outline @ centre) == pytest.approx(radians(20.0), abs=radians(0.4))


def test_contact_all_around_the_bore_has_no_outline():
    sphere, full = even_grid(pi, radians(6.0)), np.ones((GRID.rings, GRID.meridians))
    closed = np.ones((sphere.rings, sphere.meridians))
    assert patch_of(closed, closed, tilt=0.3, grid=sphere).outline == pytest.approx(np.tile(direction(0.3), (90, 1)))
    hemisphere = patch_of(full, full, tilt=0.3)
    assert polar_angle(hemisphere.outline.T) == pytest.approx(pi / 2, abs=1e-4)
    assert hemisphere.half_angle == pytest.approx(pi / 2, abs=0.02)
