"""Directions in the cup, grids of rings and meridians, the gap between ball and bore, and the patch of a contact."""

from math import cos, pi, radians
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.compliance import AxisymmetricOperator
from ballsocket.elasticity.off_axis.contact_patch import ContactPatch
from ballsocket.elasticity.off_axis.directions import (
    check_direction,
    magnitudes_and_directions,
    polar_angle,
    tangents,
    unit_vectors,
)
from ballsocket.elasticity.off_axis.grid import Grid, even_grid, graded_grid, rim_grid
from ballsocket.elasticity.off_axis.surfaces import initial_displacement

from .shapes import direction, gap_of, measures_of

POLAR, AZIMUTH = np.linspace(0.1, 3.0, 7)[:, None], np.linspace(-3.0, 3.0, 5)


def test_unit_vectors_have_their_angles_and_right_handed_tangents():
    n = unit_vectors(POLAR, AZIMUTH)
    assert np.linalg.norm(n, axis=0) == pytest.approx(1.0)
    assert polar_angle(5.0 * n) == pytest.approx(POLAR + 0 * AZIMUTH)
    assert np.arctan2(n[1], n[0]) == pytest.approx(AZIMUTH + 0 * POLAR)
    first, second = tangents(n)
    for vectors in (first, second):
        assert np.linalg.norm(vectors, axis=0) == pytest.approx(1.0)
        assert (vectors * n).sum(axis=0) == pytest.approx(0.0, abs=1e-15)
    assert np.cross(first, second, axis=0) == pytest.approx(n)


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

FINE = Grid(edges=np.linspace(0.0, 1.3, 27), meridians=44)
ODD = Grid(edges=np.linspace(0.0, 1.3, 28), meridians=44)


@pytest.mark.parametrize("reach", [radians(60.0), radians(140.0), pi])
def test_cell_areas_and_normals_integrate_to_the_bore(reach):
    cells = graded_grid(reach, radians(3.0))
    assert cells.areas.sum() * cells.meridians == pytest.approx(2 * pi * (1 - np.cos(reach)))
    assert cells.ring_areas.sum() == pytest.approx(2 * pi * (1 - np.cos(reach)))
    assert (cells.normals * cells.areas).sum(axis=(1, 2)) == pytest.approx([0, 0, pi * np.sin(reach) ** 2], abs=1e-12)


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


RIM_RINGS = [(graded_grid, [0.5, 0.25, 0.25]), (rim_grid, [0.5, 0.25, 0.125, 0.0625, 0.0625]), (even_grid, [1.0])]


@pytest.mark.parametrize(("make", "fractions"), RIM_RINGS)
def test_last_ring_is_graded_towards_the_rim(make, fractions):
    cells = make(1.5, 0.1)
    assert cells.edges[: -len(fractions)] == pytest.approx(np.arange(15) * 0.1)
    assert np.diff(cells.edges[-len(fractions) - 1 :]) == pytest.approx(0.1 * np.array(fractions))
    assert cells.reach == 1.5
    assert cells.meridians == 2 * round(pi / 0.1)
    with pytest.raises(ValueError, match="read-only"):
        cells.centroids[0, 0, 0] = 1.0


def test_grids_have_a_smallest_number_of_rings_and_meridians_and_small_ones_are_not_coarsened():
    assert (even_grid(0.3, 2.0).rings, even_grid(0.3, 2.0).meridians, graded_grid(0.3, 2.0).rings) == (4, 8, 1 + 3)
    assert [even_grid(reach, 1.0 / 6).rings for reach in (1.0, 1.01)] == [6, 7]  # rounding adds no ring
    for rings, meridians, coarsened in ((23, 44, False), (24, 44, True), (26, 34, False), (26, 36, True)):
        cells = Grid(edges=np.linspace(0.0, 1.3, rings + 1), meridians=meridians)
        assert (cells.coarser_grid is not None) == coarsened


@pytest.mark.parametrize("cells", [FINE, ODD], ids=["even", "odd"])
def test_coarsening_preserves_integrals_and_inverts_refinement(cells):
    coarse, random = cells.coarser_grid, np.random.default_rng(1)
    assert (coarse.rings, coarse.meridians) == ((cells.rings + 1) // 2, cells.meridians // 2)
    assert coarse.reach == cells.reach
    fine_field = random.normal(size=(2, cells.rings, cells.meridians))
    coarse_field = random.normal(size=(2, coarse.rings, coarse.meridians))
    assert cells.coarsen(cells.refine(coarse_field)) == pytest.approx(coarse_field)
    integral = cells.integrate_product(fine_field, np.ones(fine_field.shape))
    assert coarse.integrate_product(cells.coarsen(fine_field), np.ones(coarse_field.shape)) == pytest.approx(integral)


@pytest.mark.parametrize("cells", [FINE, ODD], ids=["even", "odd"])
def test_coarse_matrices_are_means_of_the_fine_operator(cells):
    """For low harmonics: refine the pressures, apply the fine operator, and average the displacements."""
    coarse, random, low = cells.coarser_grid, np.random.default_rng(4), cells.meridians // 4
    matrices = random.normal(size=(cells.max_harmonic + 1, cells.rings, cells.rings))
    matrices[low:] = 0.0
    coarse_matrices = cells.coarsen_matrices(matrices)
    assert coarse_matrices.shape == (coarse.max_harmonic + 1, coarse.rings, coarse.rings)
    for m in (0, 1, 3, low - 1):
        field = random.normal(size=(1, coarse.rings, 1)) * np.cos(m * coarse.azimuth)
        expected = cells.coarsen(AxisymmetricOperator(matrices=matrices)(cells.refine(field)))
        assert AxisymmetricOperator(matrices=coarse_matrices)(field) == pytest.approx(expected, abs=1e-9)


def test_cell_averages_attenuate_each_harmonic():
    """The mean of cos mφ over a cell is sinc(m / meridians) of its middle; it acts on pressure and displacement."""
    cells = even_grid(1.5, 0.15)
    averaged = cells.average_over_cells(np.repeat(np.diag(cells.ring_areas)[None], cells.max_harmonic + 1, axis=0))
    shortest = np.ceil(pi * np.sin(cells.polar) / cells.width).clip(2, cells.max_harmonic).astype(int)
    diagonal = np.einsum("mii->mi", averaged)
    for ring, m in enumerate(shortest):
        expected = np.sinc(np.minimum(np.arange(cells.max_harmonic + 1), m) / cells.meridians) ** 2
        assert diagonal[:, ring] == pytest.approx(expected)
    assert not averaged[:, ~np.eye(cells.rings, dtype=bool)].any()


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


@pytest.mark.parametrize("kind", [bs.LinearGap, bs.CircularGap])
def test_slope_is_the_derivative_of_the_overlap(kind):
    gap, h = gap_of(GRID, DEPTH, kind=kind), 1e-5
    slope = np.broadcast_to(gap.overlap_slope(DISPLACEMENT), (3, 3, GRID.rings, GRID.meridians))
    for axis, step in enumerate(h * np.eye(3)):
        difference = (gap.overlap(DISPLACEMENT + step) - gap.overlap(DISPLACEMENT - step)) / (2 * h)
        assert slope[:, axis] == pytest.approx(difference, abs=1e-8)


def test_initial_displacement_carries_the_load_on_springs_in_a_full_sphere():
    axes, force = np.array([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]]), np.array([2000.0, 100.0])
    bore, preloaded, without = (SimpleNamespace(clearance=c, socket_radius=18.0) for c in (0.1, -0.1, 0.0))
    start = initial_displacement(bore, 200.0, np.array([0.0, 0.02]), force, axes)
    length = np.linalg.norm(start, axis=1)
    assert start / length[:, None] == pytest.approx(axes)
    e = length - 0.02
    x = 0.1 / e  # cosine of the half angle
    carried = 2 * np.pi * 18.0**2 * 200.0 * (e * (1 - x**3) / 3 - 0.1 * (1 - x**2) / 2)
    assert carried == pytest.approx(force, rel=1e-6)
    starts = [initial_displacement(joint, 200.0, np.zeros(2), force, axes) for joint in (preloaded, without)]
    assert starts[0] == pytest.approx(starts[1])


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


def test_first_ray_of_the_outline_points_away_from_the_pole():
    patch = cap(direction(0.5, 0.7), radians(20.0))
    assert polar_angle(patch.outline[0]) == pytest.approx(0.5 + radians(20.0), abs=radians(0.2))
    assert polar_angle(patch.outline[45]) == pytest.approx(0.5 - radians(20.0), abs=radians(0.2))
    quarter = patch.outline[22:24].mean(axis=0)
    assert np.arctan2(quarter[1], quarter[0]) > 0.7


def test_inset_moves_the_edge_inside_by_a_fraction_of_a_ring():
    plain, inset = (measures_of(cap(direction(0.4), radians(30.0), inset)) for inset in (0.0, 0.5))
    assert plain.half_angle - inset.half_angle == pytest.approx(0.5 * CAP_GRID.width, rel=0.02)
    assert inset.edge_margin - plain.edge_margin == pytest.approx(0.5 * CAP_GRID.width, rel=0.02)


@pytest.mark.parametrize("tilt", [0.0, 0.3, 0.9])
def test_largest_pressure_is_located_between_the_cells(tilt):
    axis = direction(tilt, 0.4)
    measured = measures_of(cap(axis, radians(25.0)))
    assert measured.max_pressure == pytest.approx(10.0, rel=2e-3)
    assert np.arccos(min(measured.max_pressure_at @ axis, 1.0)) < radians(0.6)


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
    rings = np.where(np.arange(CAP_GRID.rings) <= 12, 3.0, -50.0)
    rings[13] = -1.0
    level = rings[:, None] * np.ones(CAP_GRID.meridians)
    patch = patch_of(np.maximum(level, 0.0), level, tilt=0.0)
    edge = CAP_GRID.polar[12] + 0.75 * (CAP_GRID.polar[13] - CAP_GRID.polar[12])
    assert measures_of(patch).edge_margin == pytest.approx(CAP_GRID.reach - edge, abs=1e-9)


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


def test_ring_around_the_load_has_the_half_angle_of_its_cells():
    loaded = (CAP_GRID.polar > 0.5) & (CAP_GRID.polar < 1.0)
    pressure = np.where(loaded, 1.0, 0.0)[:, None] * np.ones(CAP_GRID.meridians)
    low, high = CAP_GRID.edges[:-1][loaded].min(), CAP_GRID.edges[1:][loaded].max()
    half_angle = measures_of(patch_of(pressure, pressure - 0.5, tilt=0.0)).half_angle
    assert half_angle == pytest.approx(np.arccos(1 - (cos(low) - cos(high))))


def test_contact_beside_the_load_is_outlined_from_its_largest_pressure():
    centre = direction(0.8)
    shifted = cap(centre, radians(20.0))
    patch = patch_of(shifted.pressure, shifted.level, tilt=0.1)
    assert np.arccos(patch.outline @ centre) == pytest.approx(radians(20.0), abs=radians(0.4))


def test_contact_all_around_the_bore_has_no_outline():
    sphere, full = even_grid(pi, radians(6.0)), np.ones((CAP_GRID.rings, CAP_GRID.meridians))
    closed = np.ones((sphere.rings, sphere.meridians))
    assert patch_of(closed, closed, tilt=0.3, grid=sphere).outline == pytest.approx(np.tile(direction(0.3), (90, 1)))
    hemisphere = patch_of(full, full, tilt=0.3)
    assert polar_angle(hemisphere.outline.T) == pytest.approx(pi / 2, abs=1e-4)
    assert measures_of(hemisphere).half_angle == pytest.approx(pi / 2, abs=0.02)
