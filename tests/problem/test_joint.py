"""Joints, materials and layers: lengths from any radii, diameters and clearances; checks, changes, text and sources."""

import json
import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.problem.dimensions import LENGTHS, check_given, derive_lengths, give

from ..joints import HIP

GOOD = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, "liner": bs.UHMWPE}
SHELL = bs.Layer(thickness=4.0, material=bs.TITANIUM)
CEMENT = bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
BONE = bs.Layer(thickness=np.inf, material=bs.CORTICAL_BONE)
NO_NUMBERS = (
    *(True, 1 + 2j, np.array([1.0, 2.0j]), [[1.0, 2.0], [3.0]], ["1", "2"], np.True_, np.array([True])),
    *(np.float16(3.0), None, np.ma.masked_array([1.0, 2.0], mask=[True, False]), np.array(["3 kN"])),
)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ball_radius": 0.0}, r"ball_radius = 0 is not allowed: a radius \(mm\) is above 0 and finite"),
        ({"ball_radius": np.inf}, "ball_radius = inf is not allowed"),
        ({"ball_radius": np.nan}, "ball_radius = nan is not allowed"),
        ({"ball_radius": "16 mm"}, "ball_radius must be a number or an array .* got '16 mm'"),
        ({"clearance": -0.1}, r"clearance = -0.1 is not allowed: .* a preloaded joint has an interference instead"),
        ({"clearance": np.array([0.1, 0.2, np.nan])}, r"clearance\[2\] = nan is not allowed"),
        ({"clearance": np.array([[0.1, -1.0], [-2.0, 0.2]])}, r"clearance\[0, 1\] = -1 \(and 1 more\) is not allowed"),
        *(({"clearance": value}, "clearance must be a number or an array of real numbers") for value in NO_NUMBERS),
        ({"liner_thickness": 0.0}, r"liner_thickness = 0 is not allowed: .* inf is a massive socket"),
        ({"liner_thickness": np.inf, "backing": (SHELL,)}, "liner_thickness = inf is not allowed: only the outermost"),
        ({"liner_thickness": np.array([6.0, np.inf]), "backing": (SHELL,)}, r"liner_thickness\[1\] = inf is not"),
        ({"backing": (SHELL, BONE, CEMENT)}, r"backing\[1\].thickness = inf is not allowed: only the outermost layer"),
        ({"backing": SHELL}, "backing must be a tuple of Layers from the liner outwards, got <Layer"),
        ({"backing": 10**400}, r"^backing must be a tuple of Layers .*, got 10{39}\.\.\.$"),
        ({"backing": (SHELL, 3.0)}, r"backing\[1\] must be a Layer, got 3\.0"),
        ({"support": "free"}, "support must be Support.FIXED or Support.FREE, got 'free'"),
        ({"liner": "UHMWPE"}, "liner must be a Material, got 'UHMWPE'"),
        ({"liner": np.ones((2, 2))}, r"^liner must be a Material, got array\(\[\[1\., 1\.\], \[1\., 1\.\]\]\)$"),
        ({"ball": 3.0}, r"ball must be a Material, or None for a rigid ball, got 3\.0"),
        ({"young": 0.0}, "young = 0 is not allowed"),
        ({"young": np.inf}, "young = inf is not allowed"),
        ({"poisson": 0.51}, "poisson = 0.51 is not allowed: Poisson's ratio lies above -1, up to 0.5"),
        ({"poisson": -1.0}, "poisson = -1 is not allowed"),
        ({"poisson": np.nan}, "poisson = nan is not allowed"),
        ({"thickness": 0.0}, r"thickness = 0 is not allowed: a thickness \(mm\) is above 0; inf is"),
        ({"material": "titanium"}, "material must be a Material, got 'titanium'"),
    ],
    ids=str,
)
def test_values_that_are_not_allowed_are_refused_by_name(changes, message):
    """By the joint, or by the material or layer that has the field."""
    material, layer = {"young": 1000.0, "poisson": 0.4}, {"thickness": 4.0, "material": bs.TITANIUM}
    kinds = ((bs.Material, material), (bs.Layer, layer), (bs.Joint, GOOD))
    make, good = next((make, good) for make, good in kinds if make is bs.Joint or next(iter(changes)) in good)
    with pytest.raises(TypeError if "must be" in message else ValueError, match=message):
        make(**(good | changes))


def test_joints_are_frozen_and_take_names_only():
    assert bs.Joint(**GOOD) == bs.Joint(**GOOD)
    with pytest.raises(FrozenInstanceError):
        bs.UHMWPE.young = 2.0
    with pytest.raises(TypeError):
        bs.Joint(16.0, 0.1, 6.0, bs.UHMWPE)
    with pytest.raises(ValueError, match="force is not allowed: the integer is too large"):
        bs.HessForsbach().press(HIP, force=10**400)


def test_a_changed_joint_keeps_its_other_numbers():
    hip = bs.joints["hip-36"]
    varied = hip.replace(liner=bs.UHMWPE, head_diameter=32)
    assert varied == replace(hip, ball_radius=16, liner=bs.UHMWPE, name="hip-36, varied", source="")
    assert varied.replace(clearance=0.2).name == "hip-36, varied"
    assert hip.replace(outer_diameter=48.0, head_diameter=36.0).liner_thickness == pytest.approx(5.9)
    assert hip.replace(name="mine").name == "mine"
    assert hip.replace() == hip
    with pytest.raises(ValueError, match="'linr' in a joint is not known; did you mean 'liner'"):
        hip.replace(linr=bs.UHMWPE)
    with pytest.raises(TypeError, match="liner must be a Material, got 'uhmwpe'"):
        hip.replace(liner="uhmwpe")


def test_joints_of_arrays_are_equal_if_all_their_numbers_are():
    hip = bs.joints["hip-36"]
    one, same, other, longer = (hip.replace(clearance=np.array(c)) for c in ([0.1, 0.2], [0.1, 0.2], [0.1, 0.3], [0.1]))
    equal = [one == joint for joint in (same, other, longer, hip)]
    assert (equal, one in [hip, same]) == ([True, False, False, False], True)
    with pytest.raises(TypeError, match="unhashable"):
        hash(one)


def test_a_backing_is_part_of_the_joint():
    joint = bs.Joint(**GOOD, ball=bs.COCR, backing=[SHELL, BONE], support=bs.Support.FREE)
    assert joint.backing == (SHELL, BONE)
    assert hash(joint) == hash(replace(joint))
    assert joint.numbers()[5:] == (230000.0, 0.3, 4.0, 110000.0, 0.3, np.inf, 17000.0, 0.3)
    for again in (joint, replace(joint, ball=None)):
        assert again.with_numbers(again.numbers()) == again
    summary = json.loads(json.dumps(joint.summary(), allow_nan=False))
    titanium = {"name": "titanium", "young": 110000.0, "poisson": 0.3, "yield_stress": 795.0}
    assert summary["backing"][0] == {"thickness": 4.0, **titanium}
    assert (summary["backing"][1]["thickness"], summary["support"]) == ("inf", "free")
    behind = " on 4 mm of titanium (E 110000 MPa, nu 0.3) on a massive body of cortical bone (E 17000 MPa, nu 0.3)"
    assert f"liner 6 mm of UHMWPE (E 1000 MPa, nu 0.4){behind}, free outside; ball" in str(joint)
    doubled = joint.with_numbers([2 * number for number in joint.numbers()])
    assert doubled.numbers() == tuple(2 * number for number in joint.numbers())
    assert (doubled.ball.young, doubled.backing[1].material.poisson) == (460000.0, 0.6)
    floats = joint.replace(ball_radius=16).with_floats()
    assert type(floats.ball_radius) is float
    assert floats.with_floats() is floats


def test_backing_ratio_is_that_of_the_softest_layer():
    free = bs.Support.FREE
    assert bs.Joint(**GOOD).backing_ratio == 0.0
    assert bs.Joint(**GOOD, backing=(SHELL,)).backing_ratio == pytest.approx(1 / 110)
    assert bs.Joint(**GOOD, backing=(SHELL, CEMENT, BONE)).backing_ratio == pytest.approx(1 / 2.3)
    assert bs.Joint(**GOOD, support=free).backing_ratio == np.inf
    assert bs.Joint(**GOOD, backing=(SHELL,), support=free).backing_ratio == np.inf
    # a surface infinitely far away is at rest, free or not
    assert bs.Joint(**GOOD, backing=(SHELL, BONE), support=free).backing_ratio == pytest.approx(1 / 17)
    massive = GOOD | {"liner_thickness": np.array([6.0, np.inf])}
    np.testing.assert_array_equal(bs.Joint(**massive, support=free).backing_ratio, [np.inf, 0.0])


def test_numbers_of_a_backing_broadcast():
    young = np.array([[1e3], [1e5]])
    shell = bs.Layer(thickness=np.array([1.0, 2.0, 3.0]), material=bs.Material(young=young, poisson=0.3))
    joint = bs.Joint(**GOOD, backing=(shell, CEMENT))
    for model in (bs.HessForsbach(), bs.Hertz(), bs.PlaneLayer()):
        contact = model.press(joint, force=3000.0)
        assert contact.max_pressure.shape == contact.valid.shape == (2, 3)
    np.testing.assert_allclose(joint.backing_ratio, [[1.0], [1 / 2.3]])
    assert joint.summary()["backing"][0]["young"] == [[1e3], [1e5]]
    assert "<array 3> mm of E <array 2x1> MPa" in str(joint)


def test_effective_modulus_combines_ball_and_liner():
    assert HIP.effective_modulus == pytest.approx(1 / (0.84 / 1000.0 + 0.91 / 230000.0))
    assert HIP.modulus_ratio == 1000.0 / 230000.0
    limits = {"clearance": 0.0, "liner_thickness": np.inf, "liner": bs.Material(young=1.0, poisson=0.5)}
    joint = bs.Joint(**(GOOD | limits))  # the ends of the allowed numbers
    assert (joint.thickness_ratio, joint.modulus_ratio, joint.ball) == (0.0, 0.0, None)
    assert joint.effective_modulus == pytest.approx(1 / 0.75)


def test_presets_have_sources_and_can_be_pickled():
    assert pickle.loads(pickle.dumps(bs.materials)) == bs.materials
    for material in bs.materials.values():
        assert material.source
        assert material.name
        assert str(material).startswith(material.name)
    for joint in bs.joints.values():
        assert joint.source
        answers = bs.compare(joint, force=1000.0)
        assert "hess-forsbach" in answers
        assert all(contact.max_pressure > 0 for contact in answers.values())


EQUAL = (
    {"ball_radius": 17.0, "clearance": 0.25},
    {"ball_radius": 17.0, "socket_radius": 17.25},
    {"socket_radius": 17.25, "clearance": 0.25},
    {"head_diameter": 34.0, "diametral_clearance": 0.5},
    {"head_diameter": 34.0, "socket_radius": 17.25},
    {"socket_radius": 17.25, "diametral_clearance": 0.5},
)


@pytest.mark.parametrize("thickness", [{"liner_thickness": 5.5}, {"outer_radius": 22.75}, {"outer_diameter": 45.5}])
@pytest.mark.parametrize("radii", EQUAL, ids=str)
def test_all_combinations_of_lengths_give_the_same_joint(radii, thickness):
    joint = bs.Joint(**radii, **thickness, liner=bs.UHMWPE)
    assert (joint.ball_radius, joint.clearance, joint.liner_thickness) == pytest.approx((17.0, 0.25, 5.5), rel=1e-13)
    derived = {"socket_radius": 17.25, "head_diameter": 34.0, "diametral_clearance": 0.5, "interference": -0.25}
    derived |= {"outer_radius": 22.75, "outer_diameter": 45.5}
    for name, value in {**derived, "thickness_ratio": 17.25 / 5.5, "clearance_ratio": 0.25 / 17.25}.items():
        assert getattr(joint, name) == pytest.approx(value), name


def test_outer_radius_includes_the_shell_but_no_infinite_layer():
    for backing, thickness, shell in (((SHELL, BONE), 1.5, 4.0), ((BONE,), 5.5, 0.0)):
        joint = bs.Joint(ball_radius=17.0, clearance=0.25, outer_radius=22.75, liner=bs.UHMWPE, backing=backing)
        assert joint.liner_thickness == pytest.approx(thickness)
        assert joint.shell == shell
    thick = bs.Layer(thickness=np.array([2.0, np.inf]), material=bs.TITANIUM)
    several = bs.Joint(ball_radius=17.0, clearance=0.25, liner_thickness=5.0, liner=bs.UHMWPE, backing=(thick,))
    np.testing.assert_array_equal(several.shell, [2.0, 0.0])


THICK = {"ball_radius": 17.0, "clearance": 0.25, "liner_thickness": 5.5}
OUTER = {"head_diameter": 34.0, "diametral_clearance": 0.5, "outer_diameter": 45.5}
SHELLED = bs.Layer(thickness=1.0, material=bs.TITANIUM)


@pytest.mark.parametrize(
    ("lengths", "changes", "expected"),
    [
        (THICK, {"head_diameter": 36.0}, (18.0, 0.25, 5.5)),
        (THICK, {"diametral_clearance": 0.2}, (17.0, 0.1, 5.5)),
        (THICK, {"interference": 0.05}, (17.0, -0.05, 5.5)),
        (THICK, {"socket_radius": 17.5, "ball_radius": 17.0}, (17.0, 0.5, 5.5)),
        (THICK, {"outer_radius": 23.25, "ball_radius": 17.0}, (17.0, 0.25, 6.0)),
        (THICK, {"socket_radius": 18.0, "clearance": 0.1, "outer_radius": 24.0}, (17.9, 0.1, 6.0)),
        (OUTER, {"head_diameter": 36.0}, (18.0, 0.25, 4.5)),
        (OUTER, {"clearance": 0.1}, (17.0, 0.1, 5.65)),
        (OUTER, {"liner_thickness": 4.0, "head_diameter": 34.0}, (17.0, 0.25, 4.0)),
        (OUTER, {"liner_thickness": 4.0, "outer_diameter": 45.5}, (18.5, 0.25, 4.0)),
        (OUTER, {"backing": (SHELLED,)}, (17.0, 0.25, 4.5)),
        (THICK, {"backing": (SHELLED,)}, (17.0, 0.25, 5.5)),
    ],
)
def test_a_changed_joint_keeps_the_lengths_that_it_was_made_from(lengths, changes, expected):
    joint = bs.Joint(**lengths, liner=bs.UHMWPE).replace(**changes)
    assert (joint.ball_radius, joint.clearance, joint.liner_thickness) == pytest.approx(expected, rel=1e-13)
    assert joint.replace(liner=bs.POM).given_lengths == joint.given_lengths
    several = bs.Joint(head_diameter=np.array([28.0, 32.0]), clearance=0.1, liner_thickness=5.0, liner=bs.POM)
    assert not several.given_lengths["head_diameter"].flags.writeable


@pytest.mark.parametrize("wall", [("ball_radius", "outer_radius"), ("liner_thickness", "outer_radius")])
def test_a_length_that_is_set_takes_the_place_of_one_that_follows(wall):
    for name in LENGTHS:
        lengths = give(name, ("clearance", *wall))
        assert (len(lengths), lengths[-1], check_given(lengths)) == (3, name, lengths)


@pytest.mark.parametrize(
    ("lengths", "changes", "ways"),
    [
        (THICK, {"outer_diameter": 52.0}, "ball_radius = 17 mm or liner_thickness = 5.5 mm"),
        (THICK, {"socket_radius": 17.5}, "ball_radius = 17 mm or clearance = 0.25 mm"),
        (OUTER, {"liner_thickness": 4.0}, "head_diameter = 34 mm or outer_diameter = 45.5 mm"),
    ],
)
def test_a_change_that_breaks_a_given_length_is_refused_with_both_ways(lengths, changes, ways):
    with pytest.raises(ValueError, match=f"another length that the joint gives: add the one that stays, {ways}"):
        bs.Joint(**lengths, liner=bs.UHMWPE).replace(**changes)


@pytest.mark.parametrize(
    ("ball", "socket", "clearance"),
    [(17.9, 18.0, 0.1), (9.7, 9.9, 0.2), (179.9, 180.0, 0.1), (0.8, 0.9, 0.1), (0.01, 0.03, 0.02), (0.3, 0.4, 0.1)],
)
def test_difference_of_two_radii_has_their_digits(ball, socket, clearance):
    """Rounding errors of the difference, as in 0.9 - 0.8 = 0.09999999999999998, are removed at every size."""
    thickness = {"liner_thickness": 5.0}
    lengths = derive_lengths({"ball_radius": ball, "socket_radius": socket, **thickness}, 0.0)
    assert lengths == {"ball_radius": ball, "clearance": clearance, **thickness}
    assert derive_lengths({"socket_radius": socket, "clearance": clearance, **thickness}, 0.0)["ball_radius"] == ball
    thin = derive_lengths({"ball_radius": 1234.5, "socket_radius": 1234.50000001, **thickness}, 0.0)
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
    assert json.loads(json.dumps(liner.summary())) == {"name": "", "young": 1.0, "poisson": 0.3, **liner.stress_limits}
    joint = bs.Joint(ball_radius=17.0, clearance=0.1, liner_thickness=5.0, liner=liner, ball=bs.COCR, backing=(SHELL,))
    assert sorted(joint.strengths()) == [0.5, 1.0, 2.0, 517.0]
    bare = joint.without_strengths()
    assert bare.strengths() == ()
    assert bare.backing[0].material.stress_limits == {}
    assert bare.numbers() == joint.numbers()


def test_texts_of_joints_state_the_clearance_or_an_interference_which_is_a_negative_one():
    joint = bs.Joint(ball_radius=17.0, clearance=0.25, liner_thickness=np.inf, liner=bs.UHMWPE, name="test")
    assert joint.dimensions == "R1 17 mm, clearance 0.25 mm, massive socket"
    assert str(joint) == f"test: {joint.dimensions} of {bs.UHMWPE}; ball rigid"
    summary = joint.summary()
    assert (summary["liner_thickness"], summary["socket_radius"]) == ("inf", 17.25)
    assert (summary["ball"], summary["backing"], summary["support"]) == (None, [], "fixed")
    joint = bs.Joint(ball_radius=17.0, interference=0.05, liner_thickness=5.5, liner=bs.UHMWPE)
    assert (joint.clearance, joint.interference) == (-0.05, 0.05)
    assert "R1 17 mm, interference 0.05 mm, liner 5.5 mm" in str(joint)
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
        ({"liner_thickness": None, "outer_radius": 16.1}, "outer_radius = 16.1 is not .* 16 mm: above 16.1 mm"),
        ({"clearance": None, "socket_radius": 15.0}, "clearance = -1 is not allowed"),
        ({"clearance": None, "interference": 1.7}, "interference = 1.7 is not allowed: it is at most a tenth"),
        ({"head_diamter": 32.0}, "'head_diamter' .* is not known; did you mean 'head_diameter'"),
    ],
)
def test_lengths_that_fix_no_joint_are_refused(lengths, message):
    stated = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, **lengths}
    with pytest.raises(ValueError, match=message):
        bs.Joint(**{name: value for name, value in stated.items() if value is not None}, liner=bs.UHMWPE)
