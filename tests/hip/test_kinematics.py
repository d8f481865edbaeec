"""Rotations of the ball, cross-shear of tracks of known value, and the tracks themselves."""

from itertools import permutations
from math import cos, pi, radians, sin

import numpy as np
import pytest

from ballsocket.hip import constant_load, flexion, iso_14242_1, kinematics
from ballsocket.hip.kinematics import SurfaceSliding, rotation_matrices, sliding_distance, track_cross_shear

POLE = np.array([[0.0], [0.0], [1.0]])
UP = POLE[:, 0]


def random_directions(count, seed):
    directions = np.random.default_rng(seed).normal(size=(3, count))
    return directions / np.linalg.norm(directions, axis=0)


def plane_rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def test_rotations_are_right_handed_and_their_order_is_the_product_from_the_left():
    quarter = pi / 2
    for axis, (start, end) in enumerate([((0, 1, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, 1, 0))]):
        angles = quarter * (np.arange(3) == axis)
        assert rotation_matrices(angles) @ start == pytest.approx(np.array(end), abs=1e-15)
    angles = np.radians([20.0, 10.0, -30.0])
    single = {name: rotation_matrices(angles * (np.arange(3) == axis)) for axis, name in enumerate("xyz")}
    for order in map("".join, permutations("xyz")):
        first, second, third = (single[name] for name in order)
        assert rotation_matrices(angles, order) == pytest.approx(first @ second @ third, abs=1e-15)


def test_rotation_vectors_invert_the_matrix_exponential():
    from scipy.linalg import expm

    angles = np.random.default_rng(3).uniform(1e-9, 3.0, 50)
    vectors = (random_directions(50, 3) * angles).T
    x, y, z = np.moveaxis(vectors, -1, 0)
    cross = np.stack([0 * x, -z, y, z, 0 * x, -x, -y, x, 0 * x], axis=-1).reshape(-1, 3, 3)
    matrices = np.array([expm(generator) for generator in cross])
    assert kinematics.rotation_vectors(matrices) == pytest.approx(vectors, rel=1e-7, abs=1e-15)
    assert kinematics.rotation_vectors(np.eye(3)) == pytest.approx(np.zeros(3), abs=0)


def test_words_for_a_rotation_order():
    words = {
        "xyz": ("flexion, adduction, rotation", "FE-AA-IER"),
        "xzy": ("flexion; rotation, abduction", "f r a", "fra"),
        "zxy": ("inward rotation, flexion-extension, abduction-adduction", ["rotation", "flexion", "adduction"]),
        "zyx": (" ZYX ",),
        "yxz": (("aa", "fe", "ie"),),
    }
    for axes, texts in words.items():
        assert {kinematics.parse_rotation_order(text) for text in texts} == {axes}
    for text in ("ie r", "flexion, flexion, rotation", "flexion, adduction", "xyzx", "", 123, None):
        with pytest.raises(ValueError, match="rotation_order = .* is not allowed: .* in any order"):
            kinematics.parse_rotation_order(text)


def test_cross_shear_is_zero_on_a_line_one_half_on_a_circle_and_the_shorter_side_of_a_rectangle():
    line = np.linspace(0.0, 3.0, 7)[:, None] * [1.0, 0.0] @ plane_rotation(0.3)
    assert track_cross_shear(np.diff(np.vstack([line, line[::-1]]), axis=0)) == pytest.approx(0.0, abs=1e-15)
    azimuth = 2 * pi * np.arange(49) / 48
    circle = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    assert track_cross_shear(np.diff(circle, axis=0)) == pytest.approx(0.5)
    assert track_cross_shear(np.zeros((4, 2))) == 0.0
    for a, b, angle in ((1.0, 1.0, 0.7), (3.0, 1.0, 0.0), (20.0, 0.5, 0.7), (1.0, 1e-7, 0.7)):
        sides = np.array([[a, 0.0], [0.0, b], [-a, 0.0], [0.0, -b]]) @ plane_rotation(angle)
        assert track_cross_shear(sides) == pytest.approx(b / (a + b), rel=1e-12 if b > 1e-3 else 1e-6)
    sides = np.array([[3.0, 0.0], [0.0, 1.0], [-3.0, 0.0], [0.0, -1.0]])
    assert track_cross_shear(sides, np.array([1.0, 3.0, 1.0, 3.0])) == pytest.approx(0.5)
    assert track_cross_shear(np.stack([sides, sides[:, ::-1]]), 7.0) == pytest.approx([0.25, 0.25])


def test_sliding_over_the_pole_has_the_cross_shear_of_its_track():
    cycle, radius = iso_14242_1(200), 14.0
    sliding = SurfaceSliding(radius=radius, rotation_increments=cycle.rotation_increments, directions=POLE)
    steps = radius * np.cross(cycle.rotation_increments, UP)
    assert sliding.distances[:, 0] == pytest.approx(np.linalg.norm(steps, axis=1), rel=1e-9)
    velocity = sliding.velocities(cycle.seconds)
    assert velocity.shape == (200, 1, 3)
    assert velocity[:, 0] == pytest.approx(200 * steps, rel=1e-9, abs=1e-9)
    pressure = cycle.force_magnitudes[:, None] / 1000
    assert sliding.cross_shear(pressure)[0] == pytest.approx(track_cross_shear(steps[:, :2], pressure[:, 0]), rel=1e-9)


def test_a_point_on_the_axis_does_not_slide_and_flexion_has_no_cross_shear():
    increments = 0.1 * np.tile([0.0, 0.0, 1.0], (4, 1))
    directions = np.array([[0.0, 1.0, sin(0.3)], [0.0, 0.0, 0.0], [1.0, 0.0, cos(0.3)]])
    sliding = SurfaceSliding(radius=10.0, rotation_increments=increments, directions=directions)
    assert sliding.distances == pytest.approx(np.tile([0.0, 1.0, sin(0.3)], (4, 1)), abs=1e-12)
    assert sliding.cross_shear(np.ones((4, 3))) == pytest.approx(np.zeros(3), abs=1e-12)
    assert sliding.crossing_angle(np.ones((4, 3)))[1:] == pytest.approx(0.0, abs=1e-7)
    assert sliding.crossing_angle(np.zeros((4, 3))) == pytest.approx(np.zeros(3), abs=0)
    increments, directions = flexion().rotation_increments, random_directions(40, 1)
    sliding = SurfaceSliding(radius=14.0, rotation_increments=increments, directions=directions)
    assert sliding.cross_shear(np.ones((len(increments), 40))) == pytest.approx(0.0, abs=1e-12)


def test_crossing_angles_of_known_tracks():
    """0 on a line, π/4 on a circle, π/2 b/(a + b) on a rectangle of a by b."""
    azimuth = 2 * pi * (np.arange(400) + 0.5) / 400
    circle = 1e-3 * np.column_stack([np.cos(azimuth), np.sin(azimuth), 0 * azimuth])
    rectangle = np.array([[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-3.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    for increments, angle in ((flexion(40).rotation_increments, 0.0), (circle, pi / 4), (rectangle, pi / 8)):
        sliding = SurfaceSliding(radius=1.0, rotation_increments=increments, directions=POLE)
        assert sliding.crossing_angle(np.ones((len(increments), 1)))[0] == pytest.approx(angle, abs=1e-7)
    sliding = SurfaceSliding(radius=1.0, rotation_increments=rectangle, directions=POLE)
    pressed = np.array([[1.0], [3.0], [1.0], [0.0]])  # 6 mm along the long side, 3 mm along the short one
    assert sliding.crossing_angle(pressed)[0] == pytest.approx(pi / 2 / 3, abs=1e-7)
    assert sliding.cross_shear(pressed)[0] == pytest.approx(1 / 3)


def test_sliding_distance_follows_a_moving_point_along_its_track():
    increments = constant_load(40, amplitude=0.2).rotation_increments
    assert sliding_distance(10.0, increments, UP) == pytest.approx(10.0 * 4 * 0.2, rel=1e-12)
    assert sliding_distance(10.0, increments, np.array([1.0, 0.0, 0.0])) == pytest.approx(0.0, abs=1e-12)
    moving = np.where(np.arange(40)[:, None] < 20, UP, np.array([1.0, 0.0, 0.0]))
    assert sliding_distance(10.0, increments, moving) == pytest.approx(10.0 * 2 * 0.2, rel=1e-12)
    cycle, point = flexion(1000), np.array([[0.0], [np.sin(0.4)], [np.cos(0.4)]])
    track = kinematics.tracks(cycle.rotations, point, radius=14.0)[0]
    assert np.linalg.norm(np.diff(track, axis=0), axis=1).sum() == pytest.approx(2 * radians(43.0) * 14.0, rel=1e-4)
    assert np.linalg.norm(track, axis=1) == pytest.approx(14.0)
