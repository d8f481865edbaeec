"""Orientation, rim and checks of a cup."""

from math import cos, degrees, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.problem.cup import UP

MEDIAL = (-sin(radians(15.0)), 0.0, cos(radians(15.0)))
"""A load on a right hip, 15° from the vertical to the body's middle."""

ORIENTED = {
    "inclination": st.floats(0.0, pi / 2),
    "anteversion": st.floats(-pi / 2, pi / 2),
    "side": st.sampled_from(bs.Side),
}


@pytest.mark.parametrize(
    ("radius", "thickness", "inclination", "anteversion", "tilt", "centre", "edge"),
    [
        (14.0, 8.0, 45.0, 0.0, 30.0, 14.66, 2.17),
        (14.0, 8.0, 45.0, 15.0, 33.2, 13.87, 1.39),
        (14.0, 8.0, 55.0, 15.0, 42.3, 11.66, -0.82),
        (18.0, 6.0, 45.0, 0.0, 30.0, 18.85, 5.19),
        (18.0, 6.0, 65.0, 15.0, 51.6, 12.06, -1.61),
    ],
)
def test_rim_distance_of_hips_of_28_and_36_mm(radius, thickness, inclination, anteversion, tilt, centre, edge):
    """3 kN, 15° medial, on hemispheres of 1 GPa; arcs in mm on the ball. A steep cup is loaded at its edge."""
    cup = bs.Cup(inclination=radians(inclination), anteversion=radians(anteversion))
    hip = bs.Joint(
        ball_radius=radius,
        clearance=0.1,
        liner_thickness=thickness,
        liner=bs.Material(young=1000.0, poisson=0.4),
    )
    contact = bs.HessForsbach().press(hip, force=3000.0)
    assert degrees(cup.tilt(MEDIAL)) == pytest.approx(tilt, abs=0.05)
    assert cup.edge_distance(radius, 0.0, MEDIAL) == pytest.approx(centre, abs=0.005)
    assert cup.edge_distance(radius, contact.half_angle, MEDIAL) == pytest.approx(edge, abs=0.005)


def test_a_cup_without_an_orientation_is_loaded_along_its_axis():
    assert bs.Cup().dome == UP
    assert bs.Cup().tilt(UP) == 0.0
    assert bs.Cup(arc_of_cover=2.0).edge_distance(18.0, 0.4) == pytest.approx((1.0 - 0.4) * 18.0)


@given(st.builds(bs.Cup, **ORIENTED))
def test_inclination_is_seen_from_the_front_and_anteversion_from_the_frontal_plane(cup):
    x, y, z = cup.opening
    assert x * x + y * y + z * z == pytest.approx(1.0)
    assert np.arcsin(np.clip(y, -1, 1)) == pytest.approx(cup.anteversion, abs=1e-7)
    lateral = x if cup.side is bs.Side.RIGHT else -x
    assert lateral * cos(cup.inclination) == pytest.approx(-z * sin(cup.inclination), abs=1e-12)
    assert lateral >= 0
    assert z <= 0
    assert cup.dome == (-x, -y, -z)


@given(st.builds(bs.Cup, **ORIENTED), st.tuples(*[st.floats(-1e3, 1e3)] * 3).filter(lambda way: np.hypot(*way[:2]) > 1))
def test_the_left_is_the_mirror_image_of_the_right(cup, force):
    other = bs.Side.LEFT if cup.side is bs.Side.RIGHT else bs.Side.RIGHT
    mirrored = bs.Cup(inclination=cup.inclination, anteversion=cup.anteversion, side=other)
    x, y, z = force
    assert mirrored.tilt((-x, y, z)) == pytest.approx(cup.tilt(force), abs=1e-12)


@given(st.builds(bs.Cup, **ORIENTED), st.floats(0.0, pi), st.floats(1e-6, 1e6))
def test_the_tilt_is_the_angle_that_a_force_was_turned_by(cup, angle, length):
    """About an axis across the dome's; to rounding at 0 and π too, where an arc cosine has lost half of its digits."""
    dome = np.array(cup.dome)
    across = np.cross(dome, np.eye(3)[np.argmin(abs(dome))])
    across /= np.linalg.norm(across)
    force = length * (np.cos(angle) * dome + np.sin(angle) * across)
    assert cup.tilt(force) == pytest.approx(angle, abs=1e-14)


def test_directions_over_time_give_angles_over_time():
    forces = np.array([[MEDIAL, UP], [(0.0, 1.0, 1.0), (0.0, 0.0, -2.0)]])
    tilts = bs.Cup().tilt(forces)
    np.testing.assert_allclose(np.degrees(tilts), [[15.0, 0.0], [45.0, 180.0]], atol=1e-12)
    assert isinstance(bs.Cup().tilt(MEDIAL), float)
    assert bs.Cup().edge_distance(10.0, np.zeros(2), forces).shape == (2, 2)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"inclination": 45}, "inclination = 45 is not allowed: .* 0 to 90 degrees, .* 0 to 1.571 radians"),
        ({"anteversion": 15.0}, "anteversion = 15 is not allowed: .* -90 to 90 degrees, .* -1.571 to 1.571 radians"),
        ({"arc_of_cover": 180.0}, "arc_of_cover = 180 is not allowed: .* 40 to 340 degrees, .* to 5.934 radians"),
        ({"inclination": -0.1}, "inclination = -0.1 is not allowed"),
        ({"inclination": np.nan}, "inclination = nan is not allowed"),
    ],
)
def test_angles_are_radians(words, message):
    with pytest.raises(ValueError, match=message):
        bs.Cup(**words)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"inclination": np.zeros(2)}, "inclination must be one number"),
        ({"anteversion": "15 deg"}, "anteversion must be a number"),
        ({"side": "left"}, "side must be Side.RIGHT or Side.LEFT, got 'left'"),
        ({"interface": None}, "interface must be Interface.BONDED or Interface.SLIDING"),
    ],
)
def test_arrays_and_unknown_enumerations_are_rejected(words, message):
    with pytest.raises(TypeError, match=message):
        bs.Cup(**words)


@pytest.mark.parametrize(
    ("direction", "message"),
    [
        ((0.0, 0.0, 0.0), "the length of direction = 0 is not allowed: a direction points somewhere"),
        ([UP, (0.0, 0.0, 0.0)], r"the length of direction\[1\] = 0 is not allowed"),
        ((1.0, 0.0), "a direction has three components"),
        (1.0, "a direction has three components"),
    ],
)
def test_invalid_directions_are_rejected(direction, message):
    with pytest.raises(ValueError, match=message):
        bs.Cup().tilt(direction)


def test_only_models_with_a_rim_have_a_cup():
    """And to those the load is along the cup's axis, wherever that faces."""
    cup = bs.Cup(arc_of_cover=2.5, inclination=0.7, side=bs.Side.LEFT)
    assert bs.FiniteElement(meshes=1).in_cup(cup) == bs.FiniteElement(cup=cup, meshes=1)
    for model in bs.catalogue.values():
        assert model.in_cup(cup) == bs.model.Covered(model=model, cup=cup)
        assert model.in_cup(cup).in_cup(bs.Cup()) is model
