"""Frame, tilt and rim distance of a cup, from the definition of its radiographic angles."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.problem.cup import UP, AngleDefinition

CUPS = [
    bs.Cup(inclination=radians(inclination), anteversion=radians(anteversion), side=side)
    for inclination, anteversion in ((0.0, 0.0), (45.0, 15.0), (60.0, -20.0), (30.0, 5.0))
    for side in bs.Side
]
EACH_CUP = pytest.mark.parametrize(
    "cup", CUPS, ids=lambda cup: f"{cup.inclination:.2f} {cup.anteversion:.2f} {cup.side}"
)


@EACH_CUP
def test_opening_has_the_radiographic_angles(cup):
    x, y, z = cup.opening
    assert np.hypot(np.hypot(x, y), z) == pytest.approx(1.0, rel=1e-14)
    assert np.arcsin(y) == pytest.approx(cup.anteversion, abs=1e-12)
    assert np.arctan2(abs(x), -z) == pytest.approx(cup.inclination, abs=1e-12)
    assert np.sign(x) == (np.sign(cup.inclination) if cup.side is bs.Side.RIGHT else -np.sign(cup.inclination))
    np.testing.assert_allclose(cup.dome, [-x, -y, -z], atol=1e-15)


@EACH_CUP
def test_frame_is_right_handed_and_orthonormal(cup):
    x, y, z = np.array(cup.frame)
    np.testing.assert_allclose(np.array(cup.frame) @ np.array(cup.frame).T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(np.cross(z, x), y, atol=1e-14)
    np.testing.assert_allclose(z, cup.dome, atol=1e-15)
    assert x[1] == 0.0  # x lies in the plane of the rim and in the frontal plane
    assert x[2] >= 0.0


@EACH_CUP
def test_tilt_is_the_angle_between_load_and_dome(cup):
    directions = np.random.default_rng(4).normal(size=(30, 3))
    expected = np.arccos(directions @ np.array(cup.dome) / np.linalg.norm(directions, axis=1))
    np.testing.assert_allclose(cup.tilt(directions), expected, rtol=1e-9)
    np.testing.assert_allclose(cup.tilt(7.0 * directions), expected, rtol=1e-9)


def test_tilt_of_a_vertical_load_combines_both_angles():
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(15.0))
    assert cup.tilt(UP) == pytest.approx(np.arccos(cos(radians(45.0)) * cos(radians(15.0))), rel=1e-12)
    assert type(cup.tilt(UP)) is float
    assert bs.Cup().tilt((0.0, 0.0, -2.0)) == pytest.approx(pi)
    assert cup.tilted(0.7).tilt(UP) == pytest.approx(0.7, rel=1e-12)
    assert cup.tilted(0.7).anteversion == 0.0


def test_rim_distance_decreases_with_tilt_and_half_angle():
    cup = bs.Cup(arc_of_cover=radians(160.0))
    direction = (sin(0.3), 0.0, cos(0.3))
    assert cup.edge_distance(18.0, 0.5, direction) == pytest.approx((radians(80.0) - 0.3 - 0.5) * 18.0, rel=1e-12)
    assert cup.edge_distance(18.0, 0.5) == pytest.approx((radians(80.0) - 0.5) * 18.0, rel=1e-12)
    assert cup.edge_distance(18.0, 1.4) < 0
    assert cup.rim == pytest.approx(radians(80.0))


def test_orientation_is_known_only_if_an_angle_was_set():
    assert not bs.Cup(arc_of_cover=3.0).oriented
    assert bs.Cup(inclination=0.0).oriented
    assert bs.Cup(anteversion=0.0).oriented


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"inclination": 45.0}, r"inclination = 45 is not allowed: .* 45 degrees are 0.7854 radians"),
        ({"arc_of_cover": 0.5}, "arc_of_cover = 0.5 is not allowed: an arc of cover is 40 to 340 degrees"),
        ({"chamfer": -1.0}, "chamfer = -1 is not allowed"),
    ],
)
def test_numbers_outside_their_range_are_rejected(arguments, message):
    with pytest.raises(ValueError, match=message):
        bs.Cup(**arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"inclination": np.array([0.1, 0.2])}, "inclination must be one number"),
        ({"side": "left"}, "side must be Side.RIGHT or Side.LEFT, got 'left'"),
        ({"interface": True}, "interface must be Interface.BONDED or Interface.SLIDING, got True"),
    ],
)
def test_values_of_other_types_are_rejected(arguments, message):
    with pytest.raises(TypeError, match=message):
        bs.Cup(**arguments)


def test_directions_need_three_components_and_a_length():
    with pytest.raises(ValueError, match="a direction has three components"):
        bs.Cup().tilt([1.0, 0.0])
    with pytest.raises(ValueError, match="length of direction = 0 is not allowed"):
        bs.Cup().tilt([0.0, 0.0, 0.0])


MURRAY = {
    (45.0, 15.0): {"operative": (43.0795, 20.7536), "anatomical": (46.9205, 20.7536)},
    (40.0, 15.0): {"operative": (38.3808, 19.2790), "anatomical": (42.2735, 22.6291)},
}
"""Operative and anatomical angles in degrees of radiographic ones (Murray 1993)."""


@pytest.mark.parametrize("angles", MURRAY, ids=str)
def test_angles_of_a_cup_in_the_definitions_of_murray(angles):
    cup = bs.Cup.from_angles(*map(radians, angles))
    assert cup == bs.Cup(inclination=radians(angles[0]), anteversion=radians(angles[1]))
    for definition, degrees in MURRAY[angles].items():
        assert np.degrees(cup.angles(definition)) == pytest.approx(degrees, abs=6e-5)


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


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"definition": "surgical"}, "definition = 'surgical' is not allowed: radiographic, operative, anatomical"),
        ({"pelvic_tilt": 2.0}, "pelvic_tilt = 2 is not allowed: a pelvic tilt"),
        ({"inclination": 2.0}, "inclination = 2 is not allowed"),
        ({"anteversion": -1.2, "pelvic_tilt": 1.4}, "the cup would open upwards: .* inclination is .*; allowed are 0"),
    ],
)
def test_angles_that_are_not_allowed_are_rejected(arguments, message):
    with pytest.raises(ValueError, match=message):
        bs.Cup.from_angles(**{"inclination": 0.8, "anteversion": 0.2, **arguments})
