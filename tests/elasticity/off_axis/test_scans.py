"""Scans of bores: sphere fit, axis, orientation, noise and damaged files."""

from dataclasses import replace
from math import pi, radians

import meshio
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.scans import scan_from_points

from .shapes import COARSE, RIGID, scanned_points

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
    assert scan.roughness == pytest.approx(0.0, abs=1e-9)
    assert scan.deviation == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(scan.directions, axis=0) == pytest.approx(1.0)
    assert scan.depth(scan.directions) == pytest.approx(0.0, abs=1e-9)


def test_scan_interpolates_a_linear_depth_exactly_and_stays_in_range():
    """Planes reproduce a linear depth inside the scan; beyond its end the depth is that of the nearest points."""
    scan = scan_from_points(scanned_points(depth=lambda n: 0.02 * n[0] ** 2))
    linear = replace(scan, deviation=0.3 * scan.directions[0] - 0.1 * scan.directions[1] + 0.2 * scan.directions[2])
    inside = unit_vectors(np.array([0.1, 0.5, 1.0]), np.array([0.3, 2.0, 4.0]))
    expected = 0.3 * inside[0] - 0.1 * inside[1] + 0.2 * inside[2]
    assert linear.interpolate(inside) == pytest.approx(expected, abs=2e-3)
    outside = linear.interpolate(np.array([[0.0], [0.0], [-1.0]]))
    assert linear.deviation.min() <= outside[0] <= linear.deviation.max()


def test_roughness_is_the_root_mean_square_deviation():
    """Waves of zero mean leave the sphere unchanged."""
    wavy = scan_from_points(scanned_points(depth=lambda n: 0.03 * np.cos(8 * np.arctan2(n[1], n[0]))), finest=0.02)
    assert wavy.radius == pytest.approx(18.0, abs=1e-3)
    assert wavy.roughness == pytest.approx(0.03 / 2**0.5, rel=0.02)
    assert abs(wavy.deviation).max() == pytest.approx(0.03, rel=0.02)
    averaged = scan_from_points(scanned_points(depth=lambda n: 0.03 * np.cos(8 * np.arctan2(n[1], n[0]))), finest=0.3)
    assert len(averaged.deviation) < len(wavy.deviation) / 10


def test_azimuth_rotates_the_scan_in_the_cup():
    """The scan's x is the cup's x, rotated by the azimuth, whatever the rounding of its axis."""
    points = scanned_points(depth=bs.OvalBore(squeeze=0.1).depth) @ TO_POLE
    for azimuth in (0.0, pi / 2):
        scan = scan_from_points(points, azimuth=azimuth)
        scanned = replace(COARSE, worn=scan).press(RIGID, force=2000.0, tilt=0.4)
        oval = replace(COARSE, worn=bs.OvalBore(squeeze=0.1, direction=azimuth)).press(RIGID, force=2000.0, tilt=0.4)
        assert scanned.max_pressure == pytest.approx(oval.max_pressure, rel=8e-3)
        assert scanned.indentation == pytest.approx(oval.indentation, rel=5e-3)


@pytest.mark.parametrize("azimuth", [0.0, 0.7, 5.1])
def test_depth_of_a_scan_is_that_of_the_rotated_oval(azimuth):
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


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((10, 3)), "a scan has at least 200 points"),
        (np.full((300, 3), np.inf), "a point is finite"),
        (np.full((300, 3), 2e6), r"coordinates \(mm\) are at most 1e\+06"),
        (np.random.default_rng(1).normal(size=(1000, 3)), "not a bore: its points lie .* mm off a sphere of"),
        (np.vstack([scanned_points(reach=90.0), -scanned_points(reach=90.0)]), "cover a full sphere"),
        (scanned_points(reach=10.0), "covers 10°.*at least 25°"),
        (np.random.default_rng(1).uniform(-1, 1, (1000, 3)) * (10.0, 10.0, 0.0), "covers 0°"),
    ],
    ids=["few", "infinite", "far", "cloud", "closed", "narrow", "flat"],
)
def test_points_that_do_not_form_a_bore_raise(points, message):
    with pytest.raises(ValueError, match=message):
        scan_from_points(points)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"finest": 4.0}, "finest = 4 is not allowed"),
        ({"finest": 0.0}, "finest = 0 is not allowed"),
        ({"azimuth": 90.0}, "90 degrees are 1.571 radians"),
    ],
)
def test_angles_out_of_range_raise(arguments, message):
    with pytest.raises(ValueError, match=message):
        scan_from_points(scanned_points(), **arguments)


def test_scan_in_another_unit_raises():
    scan = scan_from_points(scanned_points() / 25.4)
    with pytest.raises(ValueError, match=r"radius of the worn bore = 0\.70.* a scan is in mm"):
        replace(COARSE, worn=scan).press(RIGID, force=2000.0)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("bore.stl", b"no mesh"),
        ("bore.stl", b""),
        ("bore.stl", bytes(80) + b"\x05\x00\x00\x00" + bytes(60)),
        ("bore.stl", b"solid bore\nfacet normal 0 0 1\nouter loop\nvertex 1 2"),
        ("bore.ply", b"ply\nformat ascii 1.0\n"),
        ("bore.obj", b""),
        ("bore", b"ply"),
    ],
)
def test_damaged_mesh_files_raise(name, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=f"{name} cannot be read as a mesh: the file is incomplete or"):
        bs.read_scan(tmp_path / name)
