"""Cross-shear of tracks whose value is known, and tracks themselves."""

from math import pi, radians

import numpy as np
import pytest

from ballsocket.elasticity.off_axis.directions import tangents
from ballsocket.hip import flexion, iso_14242_1
from ballsocket.hip.kinematics import SurfaceSliding, track_cross_shear, tracks

POLE = np.array([[0.0], [0.0], [1.0]])


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def test_a_straight_track_has_none_and_a_circle_has_one_half():
    there = np.linspace(0.0, 3.0, 7)[:, None] * [1.0, 0.0] @ turned(0.3)
    assert track_cross_shear(np.diff(np.vstack([there, there[::-1]]), axis=0)) == pytest.approx(0.0, abs=1e-15)
    around = 2 * pi * np.arange(49) / 48
    assert track_cross_shear(np.diff(np.column_stack([np.cos(around), np.sin(around)]), axis=0)) == pytest.approx(0.5)


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (3.0, 1.0), (20.0, 0.5)])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_rectangle_has_the_share_of_its_shorter_side(a, b, angle):
    sides = np.array([[a, 0.0], [0.0, b], [-a, 0.0], [0.0, -b]]) @ turned(angle)
    assert track_cross_shear(sides) == pytest.approx(b / (a + b), rel=1e-12)


def test_under_pressure_a_side_counts_for_more():
    sides = np.array([[3.0, 0.0], [0.0, 1.0], [-3.0, 0.0], [0.0, -1.0]])
    assert track_cross_shear(sides, np.array([1.0, 3.0, 1.0, 3.0])) == pytest.approx(0.5)


def test_what_slides_over_the_socket_has_the_cross_shear_of_its_track():
    cycle, radius = iso_14242_1(200), 14.0
    sliding = SurfaceSliding(radius=radius, rotation_increments=cycle.rotation_increments, directions=POLE)
    steps = radius * np.cross(cycle.rotation_increments, POLE[:, 0])
    assert sliding.distances[:, 0] == pytest.approx(np.linalg.norm(steps, axis=1), rel=1e-9)
    pressure = cycle.force_magnitudes[:, None] / 1000
    assert sliding.cross_shear(pressure)[0] == pytest.approx(track_cross_shear(steps[:, :2], pressure[:, 0]), rel=1e-9)


def test_velocities_are_what_the_steps_are_over_time():
    cycle = iso_14242_1(50)
    sliding = SurfaceSliding(radius=14.0, rotation_increments=cycle.rotation_increments, directions=POLE)
    velocity = sliding.velocities(cycle.seconds)
    assert velocity.shape == (50, 1, 3)
    assert np.linalg.norm(velocity, axis=2) == pytest.approx(sliding.distances / cycle.seconds[:, None], rel=1e-9)
    assert velocity[:, 0, 2] == pytest.approx(0.0, abs=1e-9)  # along the surface


def test_crossing_angles_of_tracks_that_are_known():
    """0 on a line; on an ellipse of turns that becomes a circle, π/4; on a rectangle of a by b, π/2 b/(a + b)."""
    around = 2 * pi * (np.arange(400) + 0.5) / 400
    circle = 1e-3 * np.column_stack([np.cos(around), np.sin(around), 0 * around])
    rectangle = np.array([[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-3.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    for turns, angle in ((flexion(40).rotation_increments, 0.0), (circle, pi / 4), (rectangle, pi / 8)):
        sliding = SurfaceSliding(radius=1.0, rotation_increments=turns, directions=POLE)
        assert sliding.crossing_angle(np.ones((len(turns), 1)))[0] == pytest.approx(angle, abs=1e-7)


def test_flexion_alone_has_no_cross_shear_anywhere():
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(3, 40))
    directions /= np.linalg.norm(directions, axis=0)
    cycle = flexion()
    sliding = SurfaceSliding(radius=14.0, rotation_increments=cycle.rotation_increments, directions=directions)
    assert sliding.cross_shear(np.ones((cycle.n_steps, 40))) == pytest.approx(0.0, abs=1e-12)


def test_tangents_are_across_each_other():
    rng = np.random.default_rng(2)
    n = rng.normal(size=(3, 30))
    n /= np.linalg.norm(n, axis=0)
    frame = np.stack([*tangents(n), n])
    assert np.einsum("ikp,jkp->pij", frame, frame) == pytest.approx(np.broadcast_to(np.eye(3), (30, 3, 3)), abs=1e-14)


def test_the_track_of_a_point_is_as_long_as_it_slides():
    cycle, point = flexion(1000), np.array([[0.0], [np.sin(0.4)], [np.cos(0.4)]])
    track = tracks(cycle.rotations, point, radius=14.0)[0]
    assert np.linalg.norm(np.diff(track, axis=0), axis=1).sum() == pytest.approx(2 * radians(43.0) * 14.0, rel=1e-4)
    assert np.linalg.norm(track, axis=1) == pytest.approx(14.0)


def test_a_point_of_the_socket_draws_its_track_on_the_ball():
    """As long as that of the ball on the socket, and the other way round: flexion to the front is one to the back."""
    cycle = flexion(1000)
    there = tracks(cycle.rotations, POLE, radius=14.0)[0]
    back = tracks(cycle.rotations.swapaxes(1, 2), POLE, radius=14.0)[0]
    assert back == pytest.approx(there * [1.0, -1.0, 1.0], abs=1e-9)
