"""How far a contact is from the rim, on this side of it and beyond."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

STEP = radians(4.0)


@pytest.mark.parametrize(
    ("arc", "load"),
    [(180.0, {"force": 2000.0}), (200.0, {"force": 9000.0}), (150.0, {"indentation": 0.05}), (70.0, {"force": 3000.0})],
)
def test_the_edge_comes_to_the_rim_and_goes_beyond_as_the_load_turns(arc, load):
    """Smoothly: by about as much as the load turns, a little less near the rim, by just that beyond."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(arc)), ring_width=radians(3.0))
    tilt = np.arange(0.0, radians(arc / 2 - 8.0), STEP)
    contact = model.press(HIP, tilt=tilt, **{name: value + 0 * tilt for name, value in load.items()})
    margin, turned = contact.edge_margin, -np.diff(contact.edge_margin)
    assert (turned > 0).all()
    assert turned.max() < STEP + radians(1.0)  # the last ring is loaded all at once
    assert turned[contact.edge_loaded[:-1]] == pytest.approx(STEP, rel=1e-6)
    assert (margin[contact.edge_loaded] <= 0).all()
    assert (margin[~contact.edge_loaded] >= 0).all()
    assert contact.edge_distance == pytest.approx(margin * HIP.socket_radius)
    assert contact.rim_distance == pytest.approx((radians(arc) / 2 - tilt) * HIP.socket_radius)


def test_no_ring_on_the_way_to_the_rim_holds_the_edge_up():
    """In rings of 2° a degree of tilt is between half and two degrees of what is left."""
    tilt = np.radians(np.arange(30.0, 52.0))
    margin = bs.Sphere(ring_width=radians(2.0)).press(HIP, force=2000.0, tilt=tilt).edge_margin
    turned = -np.degrees(np.diff(margin[margin > radians(2.0)]))
    assert len(turned) > 15
    assert turned.min() > 0.5
    assert turned.max() < 1.8


def test_a_contact_beyond_the_rim_would_end_there_if_its_load_turned_back_by_so_much():
    model, tilt = bs.Sphere(), radians(70.0)
    over = model.press(HIP, force=2500.0, tilt=tilt)
    assert over.edge_margin < -radians(10.0)
    touching = tilt + over.edge_margin
    back = model.press(HIP, force=2500.0, tilt=[touching - radians(2.0), touching + radians(1.0)])
    assert back.edge_loaded.tolist() == [False, True]
    assert back.edge_margin[0] < radians(4.0)


def test_a_bore_narrower_than_its_contact_lacks_what_the_ball_would_stand_in():
    joint = HIP.replace(clearance=0.05)
    contact = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(60.0))).press(joint, indentation=0.05)
    assert contact.edge_loaded
    assert contact.edge_margin == pytest.approx(pi / 6 - np.arccos(0.05 / 0.1), abs=1e-3)


@pytest.mark.parametrize("poisson", [0.3, 0.45])
def test_error_bars_hold_over_the_rim(poisson):
    """Wide rings against rings half as wide, of contacts that the rim cuts off."""
    liner = bs.Material(young=1000.0, poisson=poisson)
    joint = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=liner)
    tilt = np.radians([45.0, 60.0, 68.0, 75.0])
    wide, close = (bs.Sphere(ring_width=radians(width)).press(joint, force=2000.0, tilt=tilt) for width in (4.0, 2.0))
    assert wide.edge_loaded.tolist() == [False, True, True, True]
    for name in ("indentation", "max_pressure", "half_angle", "energy", "stiffness"):
        off = abs(getattr(wide, name) / getattr(close, name) - 1)
        assert (off <= wide.error[name]).all(), name
