"""Lengths of joints from every combination of radii, diameters and clearances; ratios and numbers of joints."""

import json
from math import inf

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.problem.dimensions import derive_lengths

SHELL = bs.Layer(thickness=4.0, material=bs.TITANIUM)
BONE = bs.Layer(thickness=inf, material=bs.CANCELLOUS_BONE)
EQUAL = {
    "radius and clearance": {"ball_radius": 17.0, "clearance": 0.25},
    "radius and socket": {"ball_radius": 17.0, "socket_radius": 17.25},
    "socket and clearance": {"socket_radius": 17.25, "clearance": 0.25},
    "diameter and diametral clearance": {"head_diameter": 34.0, "diametral_clearance": 0.5},
    "diameter and socket": {"head_diameter": 34.0, "socket_radius": 17.25},
    "socket and diametral clearance": {"socket_radius": 17.25, "diametral_clearance": 0.5},
}
THICKNESSES = {
    "thickness": {"liner_thickness": 5.5},
    "outer radius": {"outer_radius": 22.75},
    "outer diameter": {"outer_diameter": 45.5},
}


@pytest.mark.parametrize("thickness", THICKNESSES.values(), ids=THICKNESSES)
@pytest.mark.parametrize("radii", EQUAL.values(), ids=EQUAL)
def test_all_combinations_of_lengths_give_the_same_joint(radii, thickness):
    joint = bs.Joint(**radii, **thickness, liner=bs.UHMWPE)
    assert (joint.ball_radius, joint.clearance, joint.liner_thickness) == pytest.approx((17.0, 0.25, 5.5), rel=1e-13)
    assert joint.socket_radius == pytest.approx(17.25)
    assert joint.head_diameter == pytest.approx(34.0)
    assert joint.diametral_clearance == pytest.approx(0.5)
    assert joint.interference == pytest.approx(-0.25)
    assert joint.outer_radius == pytest.approx(22.75)
    assert joint.outer_diameter == pytest.approx(45.5)
    assert joint.thickness_ratio == pytest.approx(17.25 / 5.5)
    assert joint.clearance_ratio == pytest.approx(0.25 / 17.25)


def test_outer_radius_includes_the_shell_but_no_infinite_layer():
    joint = bs.Joint(ball_radius=17.0, clearance=0.25, outer_radius=22.75, liner=bs.UHMWPE, backing=(SHELL, BONE))
    assert joint.liner_thickness == pytest.approx(1.5)
    assert joint.shell == 4.0
    on_bone = bs.Joint(ball_radius=17.0, clearance=0.25, outer_radius=22.75, liner=bs.UHMWPE, backing=(BONE,))
    assert on_bone.liner_thickness == pytest.approx(5.5)
    assert on_bone.shell == 0.0
    thick = bs.Layer(thickness=np.array([2.0, inf]), material=bs.TITANIUM)
    several = bs.Joint(ball_radius=17.0, clearance=0.25, liner_thickness=5.0, liner=bs.UHMWPE, backing=(thick,))
    np.testing.assert_array_equal(several.shell, [2.0, 0.0])


def test_replaced_lengths_keep_the_others():
    current = {"ball_radius": 17.0, "clearance": 0.25, "liner_thickness": 5.5}
    cases = {
        ("head_diameter", 36.0): (18.0, 0.25, 5.5),
        ("socket_radius", 17.5): (17.0, 0.5, 5.5),
        ("diametral_clearance", 0.2): (17.0, 0.1, 5.5),
        ("outer_radius", 23.25): (17.0, 0.25, 6.0),
        ("interference", 0.05): (17.0, -0.05, 5.5),
    }
    for (name, value), expected in cases.items():
        assert tuple(derive_lengths({name: value}, current, 0.0).values()) == pytest.approx(expected, rel=1e-13)
    both = derive_lengths({"socket_radius": 18.0, "clearance": 0.1, "outer_radius": 24.0}, current, 1.0)
    assert tuple(both.values()) == pytest.approx((17.9, 0.1, 5.0), rel=1e-13)
    assert both["ball_radius"] == 17.9  # without the digits of rounding


@pytest.mark.parametrize(
    ("ball", "socket", "clearance"),
    [(17.9, 18.0, 0.1), (9.7, 9.9, 0.2), (179.9, 180.0, 0.1), (0.8, 0.9, 0.1), (0.01, 0.03, 0.02), (0.3, 0.4, 0.1)],
)
def test_difference_of_two_radii_has_their_digits(ball, socket, clearance):
    """Rounding errors of the difference, as in 0.9 - 0.8 = 0.09999999999999998, are removed at every size."""
    assert derive_lengths({"ball_radius": ball, "socket_radius": socket}, {"liner_thickness": 5.0}, 0.0) == {
        "ball_radius": ball,
        "clearance": clearance,
        "liner_thickness": 5.0,
    }
    thin = derive_lengths({"ball_radius": 1234.5, "socket_radius": 1234.50000001, "liner_thickness": 5.0}, {}, 0.0)
    assert thin["clearance"] == pytest.approx(1e-8, rel=1e-4)


def test_lengths_of_arrays_are_derived_element_by_element():
    socket, ball = np.array([17.25, 18.0]), np.array([[17.0], [16.5]])
    joint = bs.Joint(socket_radius=socket, ball_radius=ball, outer_radius=23.0, liner=bs.UHMWPE)
    np.testing.assert_allclose(joint.clearance, [[0.25, 1.0], [0.75, 1.5]], rtol=1e-13)
    np.testing.assert_allclose(joint.liner_thickness, [5.75, 5.0], rtol=1e-13)
    smaller = bs.Joint(socket_radius=socket, clearance=0.25, liner_thickness=5.0, liner=bs.UHMWPE)
    np.testing.assert_allclose(smaller.ball_radius, [17.0, 17.75], rtol=1e-13)
    np.testing.assert_allclose(smaller.outer_radius, [22.25, 23.0], rtol=1e-13)


def test_strengths_are_listed_and_removed():
    liner = bs.Material(young=1.0, poisson=0.3, yield_stress=2.0, fatigue_limit=1.0, proportional_limit=0.5)
    assert liner.strengths == {"yield_stress": 2.0, "fatigue_limit": 1.0}
    assert liner.stress_limits == {"proportional_limit": 0.5, "yield_stress": 2.0, "fatigue_limit": 1.0}
    joint = bs.Joint(ball_radius=17.0, clearance=0.1, liner_thickness=5.0, liner=liner, ball=bs.COCR, backing=(SHELL,))
    assert sorted(joint.strengths()) == [0.5, 1.0, 2.0, 517.0]
    bare = joint.without_strengths()
    assert bare.strengths() == ()
    assert bare.backing[0].material.stress_limits == {}
    assert bare.numbers() == joint.numbers()
    assert json.loads(json.dumps(liner.summary())) == {
        "name": "",
        "young": 1.0,
        "poisson": 0.3,
        "proportional_limit": 0.5,
        "yield_stress": 2.0,
        "fatigue_limit": 1.0,
    }


def test_texts_of_joints():
    joint = bs.Joint(ball_radius=17.0, clearance=0.25, liner_thickness=inf, liner=bs.UHMWPE, name="test")
    assert joint.dimensions == "R1 17 mm, clearance 0.25 mm, massive socket"
    assert str(joint) == f"test: {joint.dimensions} of {bs.UHMWPE}; ball rigid"
    assert str(BONE).startswith("a massive body of cancellous bone (E 500 MPa, nu 0.2)")
    summary = joint.summary()
    assert summary["liner_thickness"] == "inf"
    assert summary["socket_radius"] == 17.25
    assert (summary["ball"], summary["backing"], summary["support"]) == (None, [], "fixed")


def test_an_interference_is_a_negative_clearance():
    joint = bs.Joint(ball_radius=17.0, interference=0.05, liner_thickness=5.5, liner=bs.UHMWPE)
    assert (joint.clearance, joint.interference) == (-0.05, 0.05)
    assert joint.replace(liner_thickness=4.0).interference == 0.05
    assert bs.Joint(ball_radius=10.0, interference=1.0, liner_thickness=5.5, liner=bs.UHMWPE).socket_radius == 9.0


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ({"head_diameter": 32.0}, "ball_radius and head_diameter are one too many: either fixes the other"),
        ({"diametral_clearance": 0.2}, "clearance and diametral_clearance are one too many"),
        ({"interference": 0.1}, "clearance and interference are one too many"),
        ({"socket_radius": 16.1}, "ball_radius, socket_radius and clearance are one too many: any two of them fix"),
        ({"socket_radius": 16.3}, "ball_radius = 16 mm, but the others make 16.2 mm$"),
        ({"outer_diameter": 44.2}, "outer_diameter and liner_thickness are one too many: .*; leave one out$"),
        ({"outer_diameter": 49.0}, "liner_thickness = 6 mm, but the others make 8.4 mm$"),
        ({"liner_thickness": None}, "liner_thickness is missing, or outer_radius"),
        ({"ball_radius": None, "clearance": None, "head_diameter": 32.0}, "two of .* are needed, got head_diameter"),
        ({"liner_thickness": None, "outer_radius": 16.1}, "outer_radius = 16.1 is not .* leave a liner"),
        ({"clearance": None, "socket_radius": 15.0}, "clearance = -1 is not allowed"),
        ({"clearance": None, "interference": 1.7}, "interference = 1.7 is not allowed: it is at most a tenth"),
        ({"head_diamter": 32.0}, "'head_diamter' .* is not known; did you mean 'head_diameter'"),
    ],
)
def test_lengths_that_fix_no_joint_are_refused(lengths, message):
    stated = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, **lengths}
    with pytest.raises(ValueError, match=message):
        bs.Joint(**{name: value for name, value in stated.items() if value is not None}, liner=bs.UHMWPE)
