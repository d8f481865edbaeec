"""What no ball can be asked is refused in a sentence; a ball that its bore does not hold has a status."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs

from ...joints import HIP

RIGID = replace(HIP, ball=None)
COARSE = bs.Sphere(ring_width=radians(6.0))
TIGHT = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM)
MANY = RIGID.replace(clearance=np.array([0.1, 0.2]))
WRAPPED = replace(COARSE, cup=bs.Cup(arc_of_cover=radians(300.0)))


def worn(of):
    return lambda: replace(COARSE, worn=bs.Worn(of=of)).press(RIGID, force=1.0)


def pressed(**words):
    return lambda: COARSE.press(RIGID, **{"force": 100.0, **words})


def stood(**words):
    given = {"joint": RIGID, "model": COARSE, "force": 100.0, "inclination": [0.5], "anteversion": [0.1], **words}
    return lambda: bs.orient(given.pop("joint"), **given)


@pytest.mark.parametrize(
    ("asked", "kind", "said"),
    [
        (pressed(tilt=45.0), ValueError, "45 degrees are 0.7854 radians"),
        (pressed(tilt=-0.1), ValueError, "radians"),
        (pressed(tilt=0.3, azimuth=90.0), ValueError, "90 degrees are 1.571 radians"),
        (pressed(inclination=45.0), ValueError, "radians"),
        (pressed(direction=(0.0, 0.0, 0.0)), ValueError, "length of direction = 0 .* points somewhere"),
        (pressed(direction=(0.0, 1.0)), ValueError, "x, y, z"),
        (pressed(direction=(0.0, 0.0, np.nan)), ValueError, "points somewhere"),
        (pressed(direction=(0.0, 0.0, 1.0), tilt=0.1), ValueError, "both"),
        (lambda: bs.Sphere(ring_width=2.0), ValueError, "0.5 to 6 degrees"),
        (lambda: bs.Sphere(ring_width="2 deg"), TypeError, "ring_width must be a number"),
        (lambda: bs.Sphere(ring_width=[0.03, 0.04]), TypeError, "ring_width must be one number"),
        (lambda: bs.Sphere(cup="hemisphere"), TypeError, "cup must be Cup"),
        (lambda: bs.Sphere(worn=0.1), TypeError, "worn must have a method"),
        (lambda: bs.Sphere(worn=bs.Worn), TypeError, "worn must have a method"),
        (lambda: bs.Worn(of=3), TypeError, "of must be a function"),
        (worn(lambda n: np.nan * n[2]), ValueError, "worn depth.* a depth .mm. is finite"),
        (worn(lambda n: np.zeros(7)), ValueError, r"worn depth of shape \(7,\)"),
        (worn(lambda n: "deep"), TypeError, "worn depth must be a number"),
        (worn(lambda n: 1j * n[2]), TypeError, "worn depth must be .* complex"),
        (lambda: bs.Pinched(squeeze="60 um"), TypeError, "squeeze must be a number"),
        (lambda: bs.Pinched(squeeze=0.06, direction=90.0), ValueError, "90 degrees are 1.571 radians"),
        (lambda: COARSE.press(RIGID, force=100.0).pressure_at((1.0, 2.0)), ValueError, "x, y, z"),
        (lambda: COARSE.press(RIGID, force=100.0).pressure_at((0.0, 0.0, 0.0)), ValueError, "points somewhere"),
        (stood(model="sphere"), TypeError, "model must be Sphere, got 'sphere'"),
        (stood(model=bs.Exact()), TypeError, "model must be Sphere, got Exact"),
        (stood(force=[1.0, 2.0]), TypeError, "force must be one number"),
        (stood(joint=MANY), TypeError, "one joint, of plain numbers"),
        (stood(inclination=[]), ValueError, "a row of angles"),
        (lambda: bs.Preload(model=bs.Exact(), joint=TIGHT), TypeError, "model must be Sphere"),
        (lambda: bs.Preload(model=WRAPPED, joint=None), TypeError, "joint must be a Joint"),
        (lambda: bs.Preload(model=WRAPPED, joint=TIGHT).lost_at(np.eye(3)), ValueError, "one direction at a time"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_a_sentence(asked, kind, said):
    with pytest.raises(kind, match=said) as refused:
        asked()
    assert "\n" not in str(refused.value)


def test_a_direction_may_have_any_length():
    plain, short, long = (COARSE.press(RIGID, force=100.0, direction=(size, 0.0, size)) for size in (1, 1e-200, 1e200))
    assert short.max_pressure == long.max_pressure == plain.max_pressure
    assert plain.pressure_at((2.0, 0.0, 2.0)) == pytest.approx(plain.pole_pressure)


def test_no_load_at_all_is_answered_by_nothing():
    for none in ({"force": []}, {"force": 1.0, "tilt": []}, {"indentation": 0.1, "direction": np.zeros((0, 3))}):
        contact = COARSE.press(RIGID, **none)
        assert contact.notes == ()
        assert contact.force_vector.shape == (0, 3)


LOST = {
    "by force": ({"force": 1000.0, "tilt": pi}, "the load points 180.0°"),
    "by displacement": ({"indentation": 12.0, "tilt": pi}, "the load points 180.0°"),
    "through the bore": ({"indentation": 50.0}, "the ball's centre went 50.1 mm from the bore's, 0.0°"),
    "by a load that no liner bears": ({"force": 1e12}, "mm from the bore's, 0.0°"),
}


@pytest.mark.parametrize(("load", "said"), LOST.values(), ids=LOST)
def test_a_ball_that_leaves_its_bore_is_dislocated_and_says_where(load, said):
    contact = COARSE.press(RIGID, **load)
    assert contact.status is bs.Status.DISLOCATED
    assert not contact.valid
    assert np.isnan(contact.max_pressure)
    assert any(said in note for note in contact.notes)


def test_a_ball_that_touches_nothing_is_not_lost_yet():
    apart = COARSE.press(RIGID, tilt=pi, indentation=0.5)
    assert (apart.force, apart.max_pressure, apart.area) == (0, 0, 0)
