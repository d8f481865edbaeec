"""Refused inputs of `Sphere`, bores, scans, orientations, preloads and decks."""

from dataclasses import replace
from functools import partial
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import TiltedDeck
from ballsocket.elasticity.off_axis.scans import scan_from_points

from ...joints import lined
from ...refusals import refused_calls
from .shapes import RIGID, TIGHT, WRAPPED, scanned_points

COARSE = bs.Sphere(ring_width=radians(6.0))
MANY = RIGID.replace(clearance=np.array([0.1, 0.2]))
NAN = np.nan


def press_worn(**bore):
    return replace(COARSE, worn=bs.BoreDeviation(**bore)).press(RIGID, force=1.0)


def pressure_at(direction):
    return FORCE().pressure_at(direction)


def press_scan(points):
    return replace(COARSE, worn=scan_from_points(points)).press(RIGID, force=2000.0)


FORCE = partial(COARSE.press, RIGID, force=100.0)
MOVE = partial(COARSE.press, RIGID, displacement=(0.0, 0.0, 0.2))
TABLE = partial(bs.DepthTable, polar=[0.0, 0.7, 1.5], azimuth=[0.0, 1.5, 3.0, 4.5], values=np.zeros((3, 4)))
ORIENT = partial(bs.orient, joint=RIGID, model=COARSE, force=100.0, inclination=[0.5], anteversion=[0.1])
PRELOAD = partial(bs.Preload, model=WRAPPED, joint=TIGHT)
PULL = partial(bs.pull_out, model=replace(WRAPPED, cup=bs.Cup(arc_of_cover=radians(200.0))), joint=TIGHT)
STUDY = partial(bs.study, COARSE, RIGID, force=2000.0)
DECK = partial(TiltedDeck, joint=lined(), cup=bs.Cup(), indentation=0.04, tilt=0.5)
SCAN = partial(scan_from_points, points=scanned_points())
CLOUD = np.random.default_rng(1).normal(size=(1000, 3))
RIGHT_ANGLE = "90 degrees are 1.571 radians"

AXIAL = bs.Exact(), bs.HessForsbach(), bs.Tabulated()

VALUE_ERRORS = [
    (FORCE, {"tilt": 45.0}, "45 degrees are 0.7854 radians"),
    (FORCE, {"tilt": -0.1}, "radians"),
    (FORCE, {"tilt": 0.3, "azimuth": 90.0}, RIGHT_ANGLE),
    (FORCE, {"inclination": 45.0}, "radians"),
    (FORCE, {"direction": (0.0, 0.0, 0.0)}, "length of direction = 0 .* a length is finite and above 0"),
    (FORCE, {"direction": (0.0, 1.0)}, "x, y, z"),
    (FORCE, {"direction": (0.0, 0.0, NAN)}, "a length is finite"),
    (FORCE, {"direction": (0.0, 0.0, 1.0), "tilt": 0.1}, "not both"),
    (MOVE, {"tilt": 0.1}, "leave direction, tilt and azimuth out"),
    (MOVE, {"inclination": 0.1}, "give inclination and anteversion in the cup"),
    (MOVE, {"force": 1.0}, "exactly one"),
    (bs.Sphere, {"ring_width": radians(0.49)}, "0.5 to 6 degrees"),
    (bs.Sphere, {"ring_width": radians(6.01)}, "0.5 to 6 degrees"),
    (bs.Sphere, {"keep": "all"}, "keep must be 'fields' or 'summary', got 'all'"),
    (pressure_at, {"direction": (1.0, 2.0)}, "x, y, z"),
    (pressure_at, {"direction": (0.0, 0.0, 0.0)}, "a length is finite"),
    (press_worn, {"of": lambda n: NAN * n[2]}, "worn depth.* a depth .mm. is finite"),
    (press_worn, {"of": lambda n: np.zeros(7)}, r"worn depth of shape \(7,\)"),
    (bs.OvalBore, {"squeeze": 0.06, "direction": 90.0}, RIGHT_ANGLE),
    (TABLE, {"polar": [0.0, 0.5, pi + 0.005]}, r"polar\[2\] = .* an angle is in radians, at most 3.142"),
    (TABLE, {"azimuth": [0.0, 1.5, 3.0, 2 * pi + 0.005]}, r"azimuth\[3\] = .* radians, at most 6.283"),
    (TABLE, {"azimuth": [-2 * pi - 0.005, 1.5, 3.0, 4.0]}, r"azimuth\[0\] = .* is not allowed: an angle is in radians"),
    (TABLE, {"polar": [0.0, 0.5, 0.2]}, r"polar\[2\] = 0.2 is not allowed: angles ascend"),
    (TABLE, {"polar": [0.5], "values": np.zeros((1, 4))}, r"polar of shape \(1,\) .* at least two angles"),
    (TABLE, {"polar": [[0.0, 0.5, 0.2]]}, "at least two angles"),
    (TABLE, {"values": np.zeros((2, 2))}, r"values of shape \(2, 2\) .* one row per polar angle and one column per"),
    (TABLE, {"values": np.full((3, 4), NAN)}, "a depth .mm. is finite"),
    (SCAN, {"points": np.zeros((10, 3))}, "a scan has at least 200 points"),
    (SCAN, {"points": np.full((300, 3), np.inf)}, "a point is finite"),
    (SCAN, {"points": np.full((300, 3), 2e6)}, r"coordinates \(mm\) are at most 1e\+06"),
    (SCAN, {"points": CLOUD}, "not a bore: its points lie .* mm off a sphere of"),
    (SCAN, {"points": np.vstack([scanned_points(reach=90.0), -scanned_points(reach=90.0)])}, "cover a full sphere"),
    (SCAN, {"points": scanned_points(reach=10.0)}, "covers 10°.*needs 25°"),
    (SCAN, {"points": CLOUD * (1.0, 1.0, 0.0)}, "not a bore: its points lie"),
    (SCAN, {"finest": 4.0}, "finest = 4 is not allowed"),
    (SCAN, {"finest": 0.0}, "finest = 0 is not allowed"),
    (SCAN, {"azimuth": 90.0}, RIGHT_ANGLE),
    (press_scan, {"points": scanned_points() / 25.4}, r"radius of the worn bore = 0\.70.* a scan is in mm"),
    (ORIENT, {"inclination": []}, "give a row of angles"),
    (ORIENT, {"inclination": [45.0]}, r"inclination\[0\] = 45 is not allowed"),
    (ORIENT, {"anteversion": [[0.1, 0.2]]}, "give a row of angles"),
    (ORIENT, {"anteversion": [0.2, 0.1]}, "angles .rad. rise"),
    (ORIENT, {"force": -1.0}, "force = -1"),
    (ORIENT, {"model": replace(COARSE, direction=np.eye(3))}, "directions of the model = 3 .* give one direction"),
    (STUDY, {"azimuth": [0.0, 0.5]}, "a tilt is needed too"),
    (STUDY, {"tilt": [0.0, 0.5], "inclination": [0.1, 0.2]}, "tilt and the orientation of the cup"),
    (partial(bs.study, bs.Exact(), RIGID, force=1.0), {"tilt": [0.0, 0.5]}, "use sphere"),
    (PRELOAD, {"model": bs.Sphere()}, "beyond the equator"),
    (PRELOAD, {"joint": RIGID}, "interference"),
    (lambda: PRELOAD().separation_displacement(np.eye(3)), {}, "give one direction"),
    (PULL, {"model": replace(WRAPPED, cup=bs.Cup())}, "a socket of 180 deg does not hold its ball"),
    (PULL, {"friction": -0.1}, "friction = -0.1 is not allowed"),
    (DECK, {"joint": lined(ball=bs.STEEL)}, "rigid ball"),
    (DECK, {"cup": bs.Cup(interface=bs.Interface.SLIDING)}, "bonded liner"),
    (DECK, {"indentation": 0.0}, "indentation"),
    (DECK, {"tilt": 45.0}, "radians"),
    (DECK, {"element_size": radians(0.49)}, "an element is 0.5 to 15 degrees wide"),
    (DECK, {"element_size": radians(15.1)}, "an element is 0.5 to 15 degrees wide"),
    (DECK, {"scale": 0.0}, "a scale lies above 0 and is at most 1"),
    (DECK, {"scale": 1.05}, "a scale lies above 0 and is at most 1"),
    *((partial(model.press, TIGHT), {"force": 1.0}, "sphere") for model in AXIAL),
]
TYPE_ERRORS = [
    (bs.Sphere, {"ring_width": "2 deg"}, "ring_width must be a number"),
    (bs.Sphere, {"ring_width": [0.03, 0.04]}, "ring_width must be one number"),
    (bs.Sphere, {"cup": "hemisphere"}, "cup must be Cup"),
    (bs.Sphere, {"worn": 0.1}, "worn must have a method"),
    (bs.Sphere, {"worn": bs.BoreDeviation}, "worn must have a method"),
    (bs.BoreDeviation, {"of": 3}, "of must be a function"),
    (press_worn, {"of": lambda n: "deep"}, "worn depth must be a number"),
    (press_worn, {"of": lambda n: 1j * n[2]}, "worn depth must be .* complex"),
    (bs.OvalBore, {"squeeze": "60 um"}, "squeeze must be a number"),
    (ORIENT, {"model": "sphere"}, "model must be Sphere, got 'sphere'"),
    (ORIENT, {"model": bs.Exact()}, "model must be Sphere, got Exact"),
    (ORIENT, {"force": [1.0, 2.0]}, "force must be one number"),
    (ORIENT, {"joint": MANY}, "one joint, of plain numbers"),
    (PRELOAD, {"model": bs.Exact()}, "model must be Sphere"),
    (PRELOAD, {"joint": None}, "joint must be a Joint"),
]


def calls(cases):
    return [(partial(function, **change), message) for function, change, message in cases]


test_invalid_values_are_refused = refused_calls(*calls(VALUE_ERRORS))
test_invalid_kinds_are_refused = refused_calls(*calls(TYPE_ERRORS), error=TypeError)


def test_limits_themselves_are_allowed():
    for degrees in (0.51, 5.99):
        assert bs.Sphere(ring_width=radians(degrees)).ring_width == radians(degrees)
    for degrees in (0.51, 14.9):
        assert DECK(element_size=radians(degrees), scale=1.0).element_size == radians(degrees)
    assert TIGHT.replace(liner_thickness=3.0).interference == pytest.approx(0.05)


@pytest.mark.parametrize(
    "content", [b"no mesh", b"", bytes(80) + b"\x05\0\0\0" + bytes(60), b"solid a\nvertex 1 2", b"ply\n"]
)
@pytest.mark.parametrize("name", ["bore.stl", "bore.ply", "bore.obj", "bore"])
def test_damaged_mesh_files_raise(name, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=f"{name} cannot be read as a mesh: the file is incomplete or"):
        bs.read_scan(tmp_path / name)
