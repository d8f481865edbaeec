"""Errors of invalid inputs, and the status of a ball that its bore does not hold."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs

from .shapes import RIGID, TIGHT

COARSE = bs.Sphere(ring_width=radians(6.0))
MANY = RIGID.replace(clearance=np.array([0.1, 0.2]))
WRAPPED = replace(COARSE, cup=bs.Cup(arc_of_cover=radians(300.0)))
FITTED = bs.Preload(model=WRAPPED, joint=TIGHT)


def press_worn(depth):
    return lambda: replace(COARSE, worn=bs.BoreDeviation(of=depth)).press(RIGID, force=1.0)


def press(**arguments):
    return lambda: COARSE.press(RIGID, **{"force": 100.0, **arguments})


def orient(**arguments):
    inputs = {"joint": RIGID, "model": COARSE, "force": 100.0, "inclination": [0.5], "anteversion": [0.1], **arguments}
    return lambda: bs.orient(inputs.pop("joint"), **inputs)


@pytest.mark.parametrize(
    ("function", "kind", "message"),
    [
        (press(tilt=45.0), ValueError, "45 degrees are 0.7854 radians"),
        (press(tilt=-0.1), ValueError, "radians"),
        (press(tilt=0.3, azimuth=90.0), ValueError, "90 degrees are 1.571 radians"),
        (press(inclination=45.0), ValueError, "radians"),
        (press(direction=(0.0, 0.0, 0.0)), ValueError, "length of direction = 0 .* a length is finite and above 0"),
        (press(direction=(0.0, 1.0)), ValueError, "x, y, z"),
        (press(direction=(0.0, 0.0, np.nan)), ValueError, "a length is finite"),
        (press(direction=(0.0, 0.0, 1.0), tilt=0.1), ValueError, "not both"),
        (lambda: bs.Sphere(ring_width=2.0), ValueError, "0.5 to 6 degrees"),
        (lambda: bs.Sphere(ring_width="2 deg"), TypeError, "ring_width must be a number"),
        (lambda: bs.Sphere(ring_width=[0.03, 0.04]), TypeError, "ring_width must be one number"),
        (lambda: bs.Sphere(cup="hemisphere"), TypeError, "cup must be Cup"),
        (lambda: bs.Sphere(worn=0.1), TypeError, "worn must have a method"),
        (lambda: bs.Sphere(worn=bs.BoreDeviation), TypeError, "worn must have a method"),
        (lambda: bs.BoreDeviation(of=3), TypeError, "of must be a function"),
        (press_worn(lambda n: np.nan * n[2]), ValueError, "worn depth.* a depth .mm. is finite"),
        (press_worn(lambda n: np.zeros(7)), ValueError, r"worn depth of shape \(7,\)"),
        (press_worn(lambda n: "deep"), TypeError, "worn depth must be a number"),
        (press_worn(lambda n: 1j * n[2]), TypeError, "worn depth must be .* complex"),
        (lambda: bs.OvalBore(squeeze="60 um"), TypeError, "squeeze must be a number"),
        (lambda: bs.OvalBore(squeeze=0.06, direction=90.0), ValueError, "90 degrees are 1.571 radians"),
        (lambda: COARSE.press(RIGID, force=100.0).pressure_at((1.0, 2.0)), ValueError, "x, y, z"),
        (lambda: COARSE.press(RIGID, force=100.0).pressure_at((0.0, 0.0, 0.0)), ValueError, "a length is finite"),
        (orient(model="sphere"), TypeError, "model must be Sphere, got 'sphere'"),
        (orient(model=bs.Exact()), TypeError, "model must be Sphere, got Exact"),
        (orient(force=[1.0, 2.0]), TypeError, "force must be one number"),
        (orient(joint=MANY), TypeError, "one joint, of plain numbers"),
        (orient(inclination=[]), ValueError, "give a row of angles"),
        (lambda: bs.Preload(model=bs.Exact(), joint=TIGHT), TypeError, "model must be Sphere"),
        (lambda: bs.Preload(model=WRAPPED, joint=None), TypeError, "joint must be a Joint"),
        (
            lambda: bs.Preload(model=WRAPPED, joint=TIGHT).separation_displacement(np.eye(3)),
            ValueError,
            "give one direction",
        ),
    ],
)
def test_invalid_inputs_raise_one_sentence(function, kind, message):
    with pytest.raises(kind, match=message) as error:
        function()
    assert "\n" not in str(error.value)


def test_direction_may_have_any_length():
    plain, short, long = (COARSE.press(RIGID, force=100.0, direction=(size, 0.0, size)) for size in (1, 1e-200, 1e200))
    assert short.max_pressure == long.max_pressure == plain.max_pressure
    assert plain.pressure_at((2.0, 0.0, 2.0)) == pytest.approx(plain.pole_pressure)


def test_empty_load_gives_an_empty_contact():
    for load in ({"force": []}, {"force": 1.0, "tilt": []}, {"indentation": 0.1, "direction": np.zeros((0, 3))}):
        contact = COARSE.press(RIGID, **load)
        assert contact.notes == ()
        assert contact.force_vector.shape == (0, 3)


DISLOCATED = {
    "by force": ({"force": 1000.0, "tilt": pi}, "the load points 180.0°"),
    "by displacement": ({"indentation": 12.0, "tilt": pi}, "the load points 180.0°"),
    "through the bore": ({"indentation": 50.0}, "the ball's centre moved 50.1 mm from the bore's, 0.0°"),
    "by an excessive load": ({"force": 1e12}, "mm from the bore's, 0.0°"),
}


@pytest.mark.parametrize(("load", "message"), DISLOCATED.values(), ids=DISLOCATED)
def test_ball_outside_its_bore_is_dislocated_with_its_position(load, message):
    contact = COARSE.press(RIGID, **load)
    assert contact.status is bs.Status.DISLOCATED
    assert not contact.valid
    assert np.isnan(contact.max_pressure)
    assert any(message in note for note in contact.notes)


def test_ball_without_contact_is_not_dislocated():
    apart = COARSE.press(RIGID, tilt=pi, indentation=0.5)
    assert (apart.force, apart.max_pressure, apart.area) == (0, 0, 0)
