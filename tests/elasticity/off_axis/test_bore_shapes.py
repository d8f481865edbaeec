"""Bores that are not spheres: functions, ovals and tables."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis import bore_shapes
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.grid import even_grid

from .shapes import COARSE, RIGID


def test_depth_of_a_shifted_sphere_shifts_the_ball_alone():
    """The pole of the grid lies in the contact, where cells are triangles."""
    shift = np.array([0.02, 0.01, 0.03])
    shifted_bore = bs.BoreDeviation(of=lambda n: np.tensordot(shift, n, 1))
    plain = COARSE.press(RIGID, force=2000.0, tilt=0.3)
    shifted = replace(COARSE, worn=shifted_bore).press(RIGID, force=2000.0, tilt=0.3)
    assert shifted.pressure_map[2] == pytest.approx(plain.pressure_map[2], abs=2e-3 * plain.max_pressure)
    assert shifted.displacement == pytest.approx(plain.displacement + shift, abs=1e-5)


def test_oval_bore_has_opposite_depths_on_its_two_diameters():
    oval = bs.OvalBore(squeeze=0.1)
    assert oval.depth(np.eye(3)) == pytest.approx([-0.05, 0.05, 0.0])
    rotated = bs.OvalBore(squeeze=0.1, direction=pi / 2)
    assert rotated.depth(np.eye(3)) == pytest.approx([0.05, -0.05, 0.0])
    along, across = (replace(COARSE, worn=bore).press(RIGID, force=2000.0, tilt=0.4) for bore in (oval, rotated))
    assert along.max_pressure != pytest.approx(across.max_pressure, rel=1e-3)


@pytest.mark.parametrize("direction", [0.0, 0.4, -1.3, pi])
def test_oval_bore_is_narrowest_along_its_direction(direction):
    azimuth = np.linspace(0.0, 2 * pi, 73)
    equator = unit_vectors(np.full(azimuth.shape, pi / 2), azimuth)
    depth = bs.OvalBore(squeeze=0.08, direction=direction).depth(equator)
    assert depth == pytest.approx(-0.04 * np.cos(2 * (azimuth - direction)), abs=1e-15)
    polar = np.linspace(0.0, pi / 2, 9)
    meridian = unit_vectors(polar, np.full(polar.shape, direction))
    assert bs.OvalBore(squeeze=0.08, direction=direction).depth(meridian) == pytest.approx(
        -0.04 * np.sin(polar) ** 2, abs=1e-15
    )


def test_table_reproduces_the_function_it_samples():
    polar, azimuth = np.radians(np.arange(0.0, 91.0, 3.0)), np.radians(np.arange(0.0, 360.0, 5.0))
    values = 0.02 * np.sin(polar[:, None]) ** 2 * np.cos(2 * azimuth)
    table = bs.DepthTable(polar=polar, azimuth=azimuth, values=values)
    function = bs.BoreDeviation(of=lambda n: 0.02 * (n[0] ** 2 - n[1] ** 2))
    sampled, exact = (replace(COARSE, worn=bore).press(RIGID, force=2000.0, tilt=0.3) for bore in (table, function))
    assert sampled.max_pressure == pytest.approx(exact.max_pressure, rel=2e-3)
    assert sampled.indentation == pytest.approx(exact.indentation, rel=2e-3)


@pytest.mark.parametrize(
    "azimuth", [[0.0, 1.5, 3.0, 4.5], [-2.0, 0.0, 1.0, 3.5], [0.0, 2.0, 4.0, 2 * pi], [0.0, 2.0, 4.0, 2 * pi - 0.006]]
)
def test_table_is_linear_between_its_angles_and_periodic(azimuth):
    """A table that ends at its start after a full turn keeps its own last column."""
    azimuth, polar = np.array(azimuth), np.array([0.2, 0.7, 1.5])
    values = np.random.default_rng(3).normal(size=(3, 4))
    table = bs.DepthTable(polar=polar, azimuth=azimuth, values=values)
    at_nodes = table.depth(unit_vectors(polar[:, None], azimuth[None, :-1]))
    assert at_nodes == pytest.approx(values[:, :-1])
    middles = table.depth(unit_vectors(polar[:, None], (azimuth[:-1] + azimuth[1:])[None] / 2))
    assert middles == pytest.approx((values[:, :-1] + values[:, 1:]) / 2)
    between = table.depth(unit_vectors(np.array([[0.45]]), azimuth[None, :1]))
    assert between == pytest.approx((values[:1, :1] + values[1:2, :1]) / 2)
    constant = table.depth(unit_vectors(np.array([0.05, 0.1, 1.6, 3.0]), np.full(4, azimuth[1])))
    assert constant == pytest.approx(values[[0, 0, 2, 2], 1])
    if azimuth[-1] - azimuth[0] < 2 * pi - 1e-6:
        closing = table.depth(unit_vectors(polar, np.full(3, (azimuth[-1] + azimuth[0] + 2 * pi) / 2)))
        assert closing == pytest.approx((values[:, -1] + values[:, 0]) / 2)


def test_measured_depth_is_computed_once_for_a_grid():
    calls = []

    class Counted(bore_shapes.InterpolatedDeviation):
        def interpolate(self, directions):
            calls.append(directions)
            return directions[0] ** 2

    measured, grid = Counted(), even_grid(1.2, 0.2)
    first = measured.depth(grid.centroids)
    assert measured.depth(grid.centroids) is first
    assert len(calls) == 1
    points = grid.centroids.copy()
    assert measured.depth(points) == pytest.approx(first)
    points[0] = 0.5
    assert measured.depth(points) == pytest.approx(0.25)
    other = even_grid(1.2, 0.3)
    assert measured.depth(other.centroids) == pytest.approx(other.centroids[0] ** 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"polar": [0.0, 45.0, 90.0]}, r"polar\[1\] = 45 .*is not allowed: an angle is in radians, at most 3.142"),
        (
            {"azimuth": [0.0, 1.5, 3.0, 6.4]},
            r"azimuth\[3\] = 6.4 is not allowed: .* radians, at most 6.283",
        ),
        ({"polar": [0.0, 0.5, pi + 0.005]}, r"polar\[2\] = .* is not allowed: an angle is in radians"),
        ({"azimuth": [0.0, 1.5, 3.0, 2 * pi + 0.005]}, r"azimuth\[3\] = .* is not allowed: an angle is in radians"),
        ({"azimuth": [-2 * pi - 0.005, 1.5, 3.0, 4.0]}, r"azimuth\[0\] = .* is not allowed: an angle is in radians"),
        ({"polar": [0.0, 0.5, 0.2]}, r"polar\[2\] = 0.2 is not allowed: angles ascend"),
        ({"polar": [0.5], "values": np.zeros((1, 4))}, r"polar of shape \(1,\) .* at least two angles"),
        ({"polar": [[0.0, 0.5, 0.2]]}, "at least two angles"),
        ({"values": np.zeros((2, 2))}, r"values of shape \(2, 2\) .* one row per polar angle and one column per"),
        ({"values": np.full((3, 4), np.nan)}, "a depth .mm. is finite"),
    ],
)
def test_invalid_tables_raise(change, message):
    valid = {"polar": [0.0, 0.7, 1.5], "azimuth": [0.0, 1.5, 3.0, 4.5], "values": np.zeros((3, 4))}
    with pytest.raises(ValueError, match=message):
        bs.DepthTable(**valid | change)


def test_names_of_version_1_0_still_work():
    assert bs.Worn is bs.BoreDeviation
    assert bs.Pinched is bs.OvalBore
    with pytest.warns(DeprecationWarning, match="use BoreDeviation"):
        assert bore_shapes.Worn is bs.BoreDeviation
