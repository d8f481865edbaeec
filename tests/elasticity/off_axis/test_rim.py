"""How far a contact is from the rim, on this side of it and beyond."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.rim import edge_margins

from ...extent import either
from ...joints import HIP

STEP = radians(4.0)


def lined(ball_radius, clearance, thickness, young, poisson):
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=ball_radius, clearance=clearance, liner_thickness=thickness, liner=liner)


CUPS = {
    "thin and soft": (lined(18.0, 0.15, 2.5, 800.0, 0.45), bs.Cup(arc_of_cover=radians(150.0)), 2000.0, 52.3),
    "hip-36": (bs.joints["hip-36"], bs.Cup(arc_of_cover=radians(170.0)), 3000.0, 45.9),
    "nearly incompressible": (lined(17.9, 0.1, 6.75, 1000.0, 0.49), bs.Cup(), 2000.0, 60.4),
    "thick with a chamfer": (
        lined(14.0, 0.1, 12.0, 1000.0, 0.4),
        bs.Cup(arc_of_cover=radians(170.0), chamfer=1.0),
        2000.0,
        35.6,
    ),
}
"""Joint, cup, load in N, and the tilt in degrees at which the contact first touches the rim, in rings of 0.5°."""


@pytest.mark.parametrize("name", CUPS)
def test_the_edge_distance_falls_without_a_plateau_or_a_step_at_the_rim(name):
    """By 0.04 to 0.2 mm for each half degree, whose differences stay below 0.1 mm."""
    joint, cup, force, first_touch = CUPS[name]
    tilt = np.radians(first_touch + np.arange(-3.0, 2.1, 0.5))
    contact = bs.Sphere(cup=cup).press(joint, force=force, tilt=tilt)
    steps = np.diff(contact.edge_distance)
    assert steps.max() < -0.03
    assert steps.min() > -0.2
    assert abs(np.diff(steps)).max() < 0.1
    assert (contact.edge_loaded == (contact.edge_distance <= 0)).all()


@pytest.mark.parametrize("name", list(CUPS)[: either(quick=1, long=4)])
def test_wide_rings_give_the_edge_distance_of_narrow_ones(name):
    """Rings of 2° within 0.1 mm, far from the rim, near it, and beyond it."""
    joint, cup, force, first_touch = CUPS[name]
    tilt = np.radians(first_touch + np.array([-25.0, -9.0, -3.5, -0.7, 0.7, 6.0]))
    wide, narrow = (
        bs.Sphere(cup=cup, ring_width=radians(width)).press(joint, force=force, tilt=tilt).edge_distance
        for width in (2.0, either(quick=1.0, long=0.5))
    )
    assert wide == pytest.approx(narrow, abs=0.1)
    touching = first_touch + np.degrees(wide[-1] / joint.socket_radius) + 6.0
    assert touching == pytest.approx(first_touch, abs=0.25)


@pytest.mark.parametrize("name", list(CUPS)[: either(quick=2, long=4)])
def test_the_edge_distance_of_a_cut_contact_costs_few_presses(name):
    joint, cup, force, first_touch = CUPS[name]
    contact = bs.Sphere(cup=cup).press(joint, force=force, tilt=radians(first_touch + 6.0))
    state, presses = contact.laws.pieces[0][1].state, []

    def press(*words):
        presses.append(words)
        return state.press(*words)

    margin = edge_margins(replace(state, press=press))
    assert np.degrees(margin[0]) == pytest.approx(-6.0, abs=0.25)
    assert len(presses) <= 9


def test_the_edge_of_a_contact_lies_between_the_cells():
    """Half angles of closed shells at rings of 2°: within 0.25° of the exact ones, of 14 random joints."""
    random, off = np.random.default_rng(11), []
    for _ in range(14):
        radius = random.uniform(8.0, 30.0)
        joint = lined(
            radius,
            10 ** random.uniform(-2.0, -0.4),
            radius * 10 ** random.uniform(-1.0, 0.2),
            1000.0,
            random.choice([0.0, 0.3, 0.4, 0.45, 0.48]),
        )
        exact = bs.Exact().press(joint, half_angle=np.radians(random.uniform(14.0, 58.0, 4)))
        model = bs.Sphere(surface=bs.ClosedShell(), ring_width=radians(2.0))
        contact = model.press(joint, indentation=exact.indentation, tilt=random.uniform(0.0, 0.35, 4))
        off.append(np.degrees(contact.half_angle - exact.half_angle))
    assert abs(np.array(off)).max() < 0.25


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
