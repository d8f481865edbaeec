"""Distance of contacts from the rim, inside the bore and for edge loading."""

import re
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app.views.cup import _verdict
from ballsocket.app.widgets.reading import Reading
from ballsocket.elasticity.off_axis.load_cases import edge_margins

from ...extent import either, some
from ...joints import HIP, lined

STEP = radians(4.0)
THIN = lined(0.45, ball_radius=18.0, clearance=0.15, thickness=2.5, young=800.0)
CHAMFERED = bs.Cup(arc_of_cover=radians(170.0), chamfer=1.0)
CUPS = {
    "thin and soft": (THIN, bs.Cup(arc_of_cover=radians(150.0)), 2000.0, 52.3),
    "hip-36": (bs.joints["hip-36"], bs.Cup(arc_of_cover=radians(170.0)), 3000.0, 45.9),
    "nearly incompressible": (lined(0.49), bs.Cup(), 2000.0, 60.4),
    "thick with a chamfer": (lined(ball_radius=14.0, thickness=12.0), CHAMFERED, 2000.0, 35.6),
}
"""Joint, cup, load in N, and the tilt in degrees at which the contact first touches the rim, in rings of 0.5°."""


@pytest.mark.long
@pytest.mark.parametrize("name", CUPS)
def test_edge_distance_decreases_smoothly_with_tilt_at_the_rim(name):
    joint, cup, force, first_touch = CUPS[name]
    tilt = np.radians(first_touch + np.arange(-3.0, 2.1, 0.5))
    contact = bs.Sphere(cup=cup).press(joint, force=force, tilt=tilt)
    steps = np.diff(contact.edge_distance)
    assert steps.max() < -0.03
    assert steps.min() > -0.2
    assert abs(np.diff(steps)).max() < 0.1
    assert (contact.edge_loaded == (contact.edge_distance <= 0)).all()


@pytest.mark.long
@pytest.mark.parametrize("name", list(CUPS)[: either(quick=1, long=4)])
def test_edge_distance_of_a_cut_contact_without_its_curve_is_that_of_the_curve(name):
    joint, cup, force, first_touch = CUPS[name]
    contact = bs.Sphere(cup=cup).press(joint, force=force, tilt=radians(first_touch + 6.0))
    margin = edge_margins(replace(contact.laws.pieces[0][1].state, rim_curve=None))
    assert margin[0] == pytest.approx(contact.edge_margin, abs=radians(0.1))
    assert np.degrees(margin[0]) == pytest.approx(-6.0, abs=0.25)


@pytest.mark.parametrize("load", some([{"force": [400.0, 2000.0]}, {"indentation": [0.01, 0.04]}], 1))
def test_contacts_leave_the_rim_at_the_tilt_that_their_curve_states(load):
    model = bs.Sphere(ring_width=radians(3.0))
    touching = radians(80.0) + model.press(HIP, **load, tilt=radians(80.0)).edge_margin
    near = touching + np.radians([[-0.1], [0.1]])
    assert model.press(HIP, **load, tilt=near).edge_loaded.tolist() == [[False] * 2, [True] * 2]


LOADS = [(arc, {"force": force}) for arc, force in ((180.0, 2000.0), (200.0, 9000.0), (70.0, 3000.0))]
LOADS.insert(2, (150.0, {"indentation": 0.05}))


@pytest.mark.parametrize(("arc", "load"), some(LOADS, 2))
def test_edge_margin_follows_the_rotation_of_the_load(arc, load):
    """It decreases by about the rotation, a little less near the rim, and by exactly the rotation beyond."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(arc)), ring_width=radians(3.0))
    tilt = np.arange(0.0, radians(arc / 2 - 8.0), STEP)
    contact = model.press(HIP, tilt=tilt, **load)
    margin, decrease = contact.edge_margin, -np.diff(contact.edge_margin)
    assert (decrease > 0).all()
    assert decrease.max() < STEP + radians(1.0)  # the last ring is loaded all at once
    assert decrease[contact.edge_loaded[:-1]] == pytest.approx(STEP, rel=1e-6)
    assert (margin[contact.edge_loaded] <= 0).all()
    assert (margin[~contact.edge_loaded] >= 0).all()
    assert contact.edge_distance == pytest.approx(margin * HIP.socket_radius)
    assert contact.rim_distance == pytest.approx((radians(arc) / 2 - tilt) * HIP.socket_radius)


def test_bore_narrower_than_its_axial_contact_misses_the_overlap():
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(60.0)))
    contact = model.press(HIP.replace(clearance=0.05), indentation=0.05)
    assert contact.edge_loaded
    assert contact.edge_margin == pytest.approx(pi / 6 - np.arccos(0.05 / 0.1), abs=1e-3)


@pytest.mark.long
@pytest.mark.parametrize("poisson", [0.45, 0.3])
def test_error_estimates_hold_for_edge_loading(poisson):
    tilt = np.radians([45.0, 60.0, 68.0, 75.0])
    wide, narrow = (
        bs.Sphere(ring_width=radians(width)).press(lined(poisson), force=2000.0, tilt=tilt) for width in (4.0, 2.0)
    )
    assert wide.edge_loaded.tolist() == [False, True, True, True]
    for name in ("indentation", "max_pressure", "half_angle", "energy", "stiffness"):
        error = abs(getattr(wide, name) / getattr(narrow, name) - 1)
        assert (error <= wide.error[name]).all(), name


@pytest.mark.long
def test_error_of_the_edge_margin_holds_against_finer_rings():
    """Two contacts end before the rim, and the rim cuts the third; its error has the tolerance of a search too."""
    tilt = np.radians([0.0, 40.0, 62.0])
    coarse, fine = (
        bs.Sphere(ring_width=radians(width)).press(HIP, force=2000.0, tilt=tilt)
        for width in (4.0, either(quick=2.0, long=1.5))
    )
    error = coarse.error["edge_margin"]
    assert coarse.edge_loaded.tolist() == [False, False, True]
    assert (abs(coarse.edge_margin - fine.edge_margin) <= error).all()
    assert (radians(0.02) * coarse.edge_loaded < error).all()
    assert (error < radians(2.5)).all()
    assert coarse.summary()["error"]["edge_margin_deg"] == pytest.approx(np.degrees(error))


def test_explorer_writes_known_digits_of_the_edge_margin_or_no_contact():
    model = bs.Sphere(cup=bs.Cup(inclination=radians(45.0)), ring_width=radians(4.0))
    for load, words in (
        ({"force": 3000.0}, r"✓ .* ends \d\.\d mm from the rim"),
        ({"force": 0.0}, r"\? No contact: the ball is not loaded"),
        ({"force": 1000.0, "direction": (0.0, 0.0, -1.0)}, "✗ No contact: dislocated"),
    ):
        assert re.search(words, _verdict(model.press(HIP, **load), Reading())["text"])
