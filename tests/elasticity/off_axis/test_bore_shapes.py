"""Bores that are not spheres: functions, ovals, tables and scans with their sphere, axis and orientation."""

from dataclasses import replace
from math import pi, radians

import meshio
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis import bore_shapes
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.elasticity.off_axis.scans import scan_from_points

from .shapes import COARSE, RIGID, TIGHT, WRAPPED, scanned_points


def test_depth_of_a_shifted_sphere_shifts_the_ball_alone():
    """The pole of the grid lies in the contact, where cells are triangles."""
    shift = np.array([0.02, 0.01, 0.03])
    shifted_bore = bs.BoreDeviation(of=lambda n: np.tensordot(shift, n, 1))
    plain, shifted = (replace(COARSE, worn=worn).press(RIGID, force=2000.0, tilt=0.3) for worn in (None, shifted_bore))
    assert shifted.pressure_map[2] == pytest.approx(plain.pressure_map[2], abs=2e-3 * plain.max_pressure)
    assert shifted.displacement == pytest.approx(plain.displacement + shift, abs=1e-5)


@pytest.mark.parametrize("direction", [0.0, 0.4, -1.3, pi])
def test_oval_bore_is_narrowest_along_its_direction(direction):
    oval = bs.OvalBore(squeeze=0.08, direction=direction)
    azimuth, polar = np.linspace(0.0, 2 * pi, 73), np.linspace(0.0, pi / 2, 9)
    equator = oval.depth(unit_vectors(np.full(azimuth.shape, pi / 2), azimuth))
    assert equator == pytest.approx(-0.04 * np.cos(2 * (azimuth - direction)), abs=1e-15)
    meridian = oval.depth(unit_vectors(polar, np.full(polar.shape, direction)))
    assert meridian == pytest.approx(-0.04 * np.sin(polar) ** 2, abs=1e-15)


@pytest.mark.parametrize(
    "azimuth", [[0.0, 1.5, 3.0, 4.5], [-2.0, 0.0, 1.0, 3.5], [0.0, 2.0, 4.0, 2 * pi], [0.0, 2.0, 4.0, 2 * pi - 0.006]]
)
def test_table_is_linear_between_its_angles_and_periodic(azimuth):
    """A table that ends at its start after a full turn keeps its own last column."""
    azimuth, polar = np.array(azimuth), np.array([0.2, 0.7, 1.5])
    values = np.random.default_rng(3).normal(size=(3, 4))
    table = bs.DepthTable(polar=polar, azimuth=azimuth, values=values)

    def depth(polar, azimuth):
        return table.depth(unit_vectors(np.asarray(polar), np.asarray(azimuth)))

    assert depth(polar[:, None], azimuth[None, :-1]) == pytest.approx(values[:, :-1])
    middles = depth(polar[:, None], (azimuth[:-1] + azimuth[1:])[None] / 2)
    assert middles == pytest.approx((values[:, :-1] + values[:, 1:]) / 2)
    assert depth([[0.45]], azimuth[None, :1]) == pytest.approx((values[:1, :1] + values[1:2, :1]) / 2)
    constant = depth([0.05, 0.1, 1.6, 3.0], np.full(4, azimuth[1]))
    assert constant == pytest.approx(values[[0, 0, 2, 2], 1])
    if azimuth[-1] - azimuth[0] < 2 * pi - 1e-6:
        closing = depth(polar, np.full(3, (azimuth[-1] + azimuth[0] + 2 * pi) / 2))
        assert closing == pytest.approx((values[:, -1] + values[:, 0]) / 2)


def test_measured_depth_is_computed_once_for_a_grid():
    calls = []

    class Counted(bore_shapes.InterpolatedDeviation):
        def interpolate(self, directions):
            calls.append(directions)
            return directions[0] ** 2

    measured, grid, other = Counted(), even_grid(1.2, 0.2), even_grid(1.2, 0.3)
    first = measured.depth(grid.centroids)
    assert measured.depth(grid.centroids) is first
    assert len(calls) == 1
    points = grid.centroids.copy()
    assert measured.depth(points) == pytest.approx(first)
    points[0] = 0.5
    assert measured.depth(points) == pytest.approx(0.25)
    assert measured.depth(other.centroids) == pytest.approx(other.centroids[0] ** 2)


def test_names_of_version_1_0_still_work():
    assert (bs.Worn, bs.Pinched) == (bs.BoreDeviation, bs.OvalBore)
    with pytest.warns(DeprecationWarning, match="use BoreDeviation"):
        assert bore_shapes.Worn is bs.BoreDeviation
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    with pytest.warns(DeprecationWarning, match="use equilibrium"):
        assert fitted.rest is fitted.equilibrium
    with pytest.warns(DeprecationWarning, match="use separation_displacement"):
        assert fitted.lost_at == fitted.separation_displacement


# --- scans ---

TO_POLE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]).T
"""Rotation of scanned points onto the cup's axis z."""


def test_noise_of_a_scan_hardly_changes_the_pressure():
    random = np.random.default_rng(2)
    noisy = scan_from_points(scanned_points(depth=lambda n: random.normal(0.0, 0.0005, n.shape[1:])))
    plain, scanned = (replace(COARSE, worn=worn).press(RIGID, force=2000.0, tilt=0.3) for worn in (None, noisy))
    assert scanned.max_pressure == pytest.approx(plain.max_pressure, rel=0.1)


def test_scan_file_gives_sphere_axis_and_wear(tmp_path):
    pit = lambda n: 0.05 * np.exp(-((np.arccos(np.clip(n[2], -1, 1)) / 0.25) ** 2))  # noqa: E731
    points = scanned_points(depth=pit, shift=(5.0, -3.0, 2.0))
    triangles = np.arange(len(points) // 3 * 3).reshape(-1, 3)
    meshio.write_points_cells(tmp_path / "bore.stl", points, [("triangle", triangles)])
    scan = bs.read_scan(tmp_path / "bore.stl")
    assert scan.centre == pytest.approx([5.0, -3.0, 2.0], abs=0.03)
    assert scan.radius == pytest.approx(18.0, abs=0.03)
    assert scan.axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
    fresh, worn = (replace(COARSE, worn=bore).press(RIGID, force=2000.0) for bore in (None, scan))
    assert worn.pole_pressure < fresh.pole_pressure


def test_scan_of_an_exact_sphere_has_no_deviation():
    scan = scan_from_points(scanned_points(radius=20.0, reach=70.0, shift=(1.0, -2.0, 3.0)))
    assert scan.centre == pytest.approx([1.0, -2.0, 3.0], abs=1e-9)
    assert scan.radius == pytest.approx(20.0, abs=1e-9)
    assert scan.reach == pytest.approx(radians(70.0), abs=1e-6)
    assert np.linalg.norm(scan.directions, axis=0) == pytest.approx(1.0)
    for depth in (scan.roughness, scan.deviation, scan.depth(scan.directions)):
        assert depth == pytest.approx(0.0, abs=1e-9)


def test_scan_interpolates_a_linear_depth_exactly_and_stays_in_range():
    """Planes reproduce a linear depth inside the scan; beyond its end the depth is that of the nearest points."""
    scan, slope = scan_from_points(scanned_points(depth=lambda n: 0.02 * n[0] ** 2)), np.array([0.3, -0.1, 0.2])
    linear = replace(scan, deviation=slope @ scan.directions)
    inside = unit_vectors(np.array([0.1, 0.5, 1.0]), np.array([0.3, 2.0, 4.0]))
    assert linear.interpolate(inside) == pytest.approx(slope @ inside, abs=2e-3)
    outside = linear.interpolate(np.array([[0.0], [0.0], [-1.0]]))
    assert linear.deviation.min() <= outside[0] <= linear.deviation.max()


def test_roughness_is_the_root_mean_square_deviation():
    """Waves of zero mean leave the sphere unchanged."""
    points = scanned_points(depth=lambda n: 0.03 * np.cos(8 * np.arctan2(n[1], n[0])))
    wavy, averaged = (scan_from_points(points, finest=finest) for finest in (0.02, 0.3))
    assert wavy.radius == pytest.approx(18.0, abs=1e-3)
    assert wavy.roughness == pytest.approx(0.03 / 2**0.5, rel=0.02)
    assert abs(wavy.deviation).max() == pytest.approx(0.03, rel=0.02)
    assert len(averaged.deviation) < len(wavy.deviation) / 10


@pytest.mark.parametrize("azimuth", [0.0, pi / 2, 5.1])
def test_depth_of_a_scan_is_that_of_the_rotated_oval(azimuth):
    """The scan's x is the cup's x, rotated by the azimuth, whatever the rounding of its axis."""
    scan = scan_from_points(scanned_points(depth=bs.OvalBore(squeeze=0.1).depth) @ TO_POLE, azimuth=azimuth)
    directions = unit_vectors(np.linspace(0.1, 1.3, 12), np.linspace(0.0, 6.0, 12))
    expected = bs.OvalBore(squeeze=0.1, direction=azimuth).depth(directions)
    assert scan.depth(directions) == pytest.approx(expected, abs=3e-3)


def test_scan_along_x_takes_y_as_its_reference():
    along_x = scanned_points(depth=bs.OvalBore(squeeze=0.1).depth) @ TO_POLE @ np.roll(np.eye(3), 1, axis=1)
    scan = scan_from_points(along_x)
    assert scan.axis == pytest.approx([1.0, 0.0, 0.0], abs=1e-3)
    equator = unit_vectors(np.full(8, 1.3), np.arange(8) * pi / 4)
    assert scan.depth(equator) == pytest.approx(bs.OvalBore(squeeze=0.1).depth(equator), abs=3e-3)
