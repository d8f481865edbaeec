"""Orientation, frame, rim and checks of a cup, from the definition of its radiographic angles."""

from math import cos, degrees, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.problem.cup import UP, AngleDefinition

from ..refusals import refused_calls

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
    hip = bs.Joint(ball_radius=radius, clearance=0.1, liner_thickness=thickness, liner=bs.UHMWPE)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    assert degrees(cup.tilt(MEDIAL)) == pytest.approx(tilt, abs=0.05)
    assert cup.edge_distance(radius, 0.0, MEDIAL) == pytest.approx(centre, abs=0.005)
    assert cup.edge_distance(radius, contact.half_angle, MEDIAL) == pytest.approx(edge, abs=0.005)


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


def test_tilt_of_a_vertical_load_combines_both_angles_and_follows_directions_over_time():
    forces = np.array([[MEDIAL, UP], [(0.0, 1.0, 1.0), (0.0, 0.0, -2.0)]])
    np.testing.assert_allclose(np.degrees(bs.Cup().tilt(forces)), [[15.0, 0.0], [45.0, 180.0]], atol=1e-12)
    assert type(bs.Cup().tilt(MEDIAL)) is float
    assert bs.Cup().edge_distance(10.0, np.zeros(2), forces).shape == (2, 2)
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(15.0))
    assert cup.tilt(UP) == pytest.approx(np.arccos(cos(radians(45.0)) * cos(radians(15.0))), rel=1e-12)
    assert cup.tilted(0.7).tilt(UP) == pytest.approx(0.7, rel=1e-12)
    assert cup.tilted(0.7).anteversion == 0.0
    assert not bs.Cup(arc_of_cover=3.0).oriented
    assert bs.Cup(inclination=0.0).oriented
    assert bs.Cup(anteversion=0.0).oriented


@given(st.builds(bs.Cup, **ORIENTED))
def test_frame_is_right_handed_and_orthonormal(cup):
    x, y, z = frame = np.array(cup.frame)
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(np.cross(z, x), y, atol=1e-14)
    np.testing.assert_allclose(z, cup.dome, atol=1e-15)
    assert x[1] == 0.0  # x lies in the plane of the rim and in the frontal plane
    assert x[2] >= 0.0


@pytest.mark.parametrize(
    ("angles", "operative", "anatomical"),
    [
        ((45.0, 15.0), (43.0795, 20.7536), (46.9205, 20.7536)),
        ((40.0, 15.0), (38.3808, 19.2790), (42.2735, 22.6291)),
    ],
)
def test_angles_of_a_cup_in_the_definitions_of_murray(angles, operative, anatomical):
    """Murray 1993."""
    cup = bs.Cup.from_angles(*map(radians, angles))
    assert cup == bs.Cup(inclination=radians(angles[0]), anteversion=radians(angles[1]))
    assert np.degrees(cup.angles("operative")) == pytest.approx(operative, abs=6e-5)
    assert np.degrees(cup.angles("anatomical")) == pytest.approx(anatomical, abs=6e-5)


def test_each_definition_describes_the_same_axis():
    """The definitions are projections of the axis: on the frontal, the sagittal and the transverse plane."""
    random = np.random.default_rng(4)
    for inclination, anteversion in zip(random.uniform(0.01, 1.56, 200), random.uniform(-1.55, 1.55, 200), strict=True):
        cup = bs.Cup(inclination=inclination, anteversion=anteversion)
        x, y, z = cup.opening
        assert np.sin(cup.angles("operative")[0]) == pytest.approx(x, abs=1e-12)
        assert np.tan(cup.angles("operative")[1]) == pytest.approx(-y / z, rel=1e-10)
        assert np.cos(cup.angles("anatomical")[0]) == pytest.approx(-z, abs=1e-12)
        assert np.tan(cup.angles("anatomical")[1]) == pytest.approx(y / x, rel=1e-10)
        for definition in AngleDefinition:
            again = bs.Cup.from_angles(*cup.angles(definition), definition=definition)
            np.testing.assert_allclose(again.angles(), (inclination, anteversion), rtol=0, atol=1e-12)


@pytest.mark.parametrize("definition", ["radiographic", "Operative", AngleDefinition.ANATOMICAL])
@pytest.mark.parametrize("tilt", [-20.0, 10.0])
def test_a_pelvic_tilt_rotates_the_cup_about_the_transverse_axis(definition, tilt):
    angles = radians(40.0), radians(18.0)
    straight, tilted = (
        bs.Cup.from_angles(*angles, definition=definition, pelvic_tilt=radians(size)) for size in (0.0, tilt)
    )
    before, after = straight.angles("operative"), tilted.angles("operative")
    assert after[0] == pytest.approx(before[0], abs=1e-12)
    assert after[1] == pytest.approx(before[1] - radians(tilt), abs=1e-12)
    assert straight.opening[0] == pytest.approx(tilted.opening[0], abs=1e-12)


def from_angles(**words):
    return bs.Cup.from_angles(**{"inclination": 0.8, "anteversion": 0.2, **words})


test_angles_and_directions_that_are_not_allowed_are_refused = refused_calls(
    (lambda: bs.Cup(inclination=45), "inclination = 45 is not allowed: .* 0 to 90 degrees, .*; 45 degrees are 0.7854"),
    (lambda: bs.Cup(anteversion=15.0), "anteversion = 15 is .* -90 to 90 degrees, .* -1.571 to 1.571 radians"),
    (lambda: bs.Cup(arc_of_cover=180.0), "arc_of_cover = 180 is not allowed: .* 40 to 340 degrees, .* to 5.934 radia"),
    (lambda: bs.Cup(arc_of_cover=0.5), "arc_of_cover = 0.5 is not allowed: an arc of cover is 40 to 340 degrees"),
    (lambda: bs.Cup(inclination=-0.1), "inclination = -0.1 is not allowed"),
    (lambda: bs.Cup(inclination=np.nan), "inclination = nan is not allowed"),
    (lambda: bs.Cup(chamfer=-1.0), "chamfer = -1 is not allowed"),
    (lambda: bs.Cup().tilt(direction=(0.0, 0.0, 0.0)), "the length of direction = 0 is not allowed: a direction"),
    (lambda: bs.Cup().tilt(direction=[UP, (0.0, 0.0, 0.0)]), r"the length of direction\[1\] = 0 is not allowed"),
    (lambda: bs.Cup().tilt(direction=(1.0, 0.0)), "a direction has three components"),
    (lambda: bs.Cup().tilt(direction=1.0), "a direction has three components"),
    (lambda: from_angles(definition="surgical"), "'surgical' is not allowed: radiographic, operative, anatomical"),
    (lambda: from_angles(pelvic_tilt=2.0), "pelvic_tilt = 2 is not allowed: a pelvic tilt"),
    (lambda: from_angles(inclination=2.0), "inclination = 2 is not allowed"),
    (lambda: from_angles(anteversion=-1.2, pelvic_tilt=1.4), "would open upwards: .* inclination is .*; allowed a"),
)

test_arguments_of_another_kind_are_refused = refused_calls(
    (lambda: bs.Cup(inclination=np.zeros(2)), "inclination must be one number"),
    (lambda: bs.Cup(anteversion="15 deg"), "anteversion must be a number"),
    (lambda: bs.Cup(side="left"), "side must be Side.RIGHT or Side.LEFT, got 'left'"),
    (lambda: bs.Cup(interface=True), "interface must be Interface.BONDED or Interface.SLIDING, got True"),
    error=TypeError,
)
