"""Joints, materials and layers: checks, changes, text and sources."""

import json
import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

GOOD = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, "liner": bs.UHMWPE}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ball_radius": 0.0}, r"ball_radius = 0 is not allowed: a radius \(mm\) is above 0 and finite"),
        ({"ball_radius": -16.0}, "ball_radius = -16 is not allowed"),
        ({"ball_radius": np.inf}, "ball_radius = inf is not allowed"),
        ({"ball_radius": np.nan}, "ball_radius = nan is not allowed"),
        ({"clearance": -0.1}, r"clearance = -0.1 is not allowed: .* a preloaded joint has an interference instead"),
        ({"clearance": np.array([0.1, 0.2, np.nan])}, r"clearance\[2\] = nan is not allowed"),
        ({"clearance": np.array([[0.1, -1.0], [-2.0, 0.2]])}, r"clearance\[0, 1\] = -1 \(and 1 more\) is not allowed"),
        ({"liner_thickness": 0.0}, r"liner_thickness = 0 is not allowed: .* inf is a massive socket"),
    ],
)
def test_invalid_numbers_of_a_joint_are_named(changes, message):
    with pytest.raises(ValueError, match=message):
        bs.Joint(**(GOOD | changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"young": 0.0}, "young = 0 is not allowed"),
        ({"young": np.inf}, "young = inf is not allowed"),
        ({"poisson": 0.51}, "poisson = 0.51 is not allowed: Poisson's ratio lies above -1, up to 0.5"),
        ({"poisson": -1.0}, "poisson = -1 is not allowed"),
        ({"poisson": np.nan}, "poisson = nan is not allowed"),
    ],
)
def test_invalid_numbers_of_a_material_are_named(changes, message):
    with pytest.raises(ValueError, match=message):
        bs.Material(**({"young": 1000.0, "poisson": 0.4} | changes))


def test_values_of_other_types_raise_a_type_error():
    with pytest.raises(TypeError, match="ball_radius must be a number or an array .* got '16 mm'"):
        bs.Joint(**(GOOD | {"ball_radius": "16 mm"}))
    with pytest.raises(TypeError, match="clearance must be a number or an array .* got True"):
        bs.Joint(**(GOOD | {"clearance": True}))
    with pytest.raises(TypeError, match="liner must be a Material, got 'UHMWPE'"):
        bs.Joint(**(GOOD | {"liner": "UHMWPE"}))
    with pytest.raises(TypeError, match=r"ball must be a Material, or None for a rigid ball, got 3\.0"):
        bs.Joint(**(GOOD | {"ball": 3.0}))
    with pytest.raises(TypeError, match=r"^backing must be a tuple of Layers .*, got 10{39}\.\.\.$"):
        bs.Joint(**(GOOD | {"backing": 10**400}))
    with pytest.raises(TypeError, match=r"^liner must be a Material, got array\(\[\[1\., 1\.\], \[1\., 1\.\]\]\)$"):
        bs.Joint(**(GOOD | {"liner": np.ones((2, 2))}))
    with pytest.raises(TypeError):
        bs.Joint(16.0, 0.1, 6.0, bs.UHMWPE)


def test_equivalent_lengths_make_the_same_joint():
    rest = {"liner": bs.UHMWPE}
    same = bs.Joint(ball_radius=18.0, clearance=0.1, liner_thickness=5.9, **rest)
    assert bs.Joint(head_diameter=36.0, diametral_clearance=0.2, outer_diameter=48.0, **rest) == same
    assert bs.Joint(head_diameter=36.0, socket_radius=18.1, outer_radius=24.0, **rest) == same
    assert bs.Joint(socket_radius=18.1, clearance=0.1, liner_thickness=5.9, **rest) == same
    assert (same.head_diameter, same.diametral_clearance, same.outer_diameter) == (36.0, 0.2, 48.0)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ({"head_diameter": 32.0}, "head_diameter and ball_radius|ball_radius and head_diameter"),
        ({"diametral_clearance": 0.2}, "clearance and diametral_clearance are one too many"),
        ({"socket_radius": 16.1}, "ball_radius, socket_radius and clearance are one too many: any two of them fix"),
        ({"outer_diameter": 44.2}, "outer_diameter and liner_thickness are one too many: either fixes the other"),
        ({"head_diamter": 32.0}, "'head_diamter' .* is not known; did you mean 'head_diameter'"),
    ],
)
def test_redundant_lengths_are_rejected_even_if_they_agree(lengths, message):
    with pytest.raises(ValueError, match=message):
        bs.Joint(**GOOD, **lengths)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ({"ball_radius": 16.0, "clearance": 0.1}, "liner_thickness is missing, or outer_radius"),
        ({"head_diameter": 32.0, "liner_thickness": 6.0}, "two of .* are needed, got head_diameter"),
        (
            {"ball_radius": 16.0, "clearance": 0.1, "outer_radius": 16.1},
            "outer_radius = 16.1 is not .* leave a liner",
        ),
        ({"ball_radius": 16.0, "socket_radius": 15.0, "liner_thickness": 6.0}, "clearance = -1 is not allowed"),
    ],
)
def test_lengths_of_an_impossible_joint_are_rejected(lengths, message):
    with pytest.raises(ValueError, match=message):
        bs.Joint(**lengths, liner=bs.UHMWPE)


def test_a_changed_joint_keeps_its_other_numbers():
    hip = bs.joints["hip-36"]
    varied = hip.replace(liner=bs.UHMWPE, head_diameter=32)
    assert varied == replace(hip, ball_radius=16, liner=bs.UHMWPE, name="hip-36, varied", source="")
    assert varied.replace(clearance=0.2).name == "hip-36, varied"
    assert hip.replace(outer_diameter=48.0).liner_thickness == pytest.approx(5.9)
    assert hip.replace(socket_radius=19.0).clearance == pytest.approx(1.0)
    assert hip.replace(name="mine").name == "mine"
    assert hip.replace() == hip
    with pytest.raises(ValueError, match="'linr' in a joint is not known; did you mean 'liner'"):
        hip.replace(linr=bs.UHMWPE)
    with pytest.raises(TypeError, match="liner must be a Material, got 'uhmwpe'"):
        hip.replace(liner="uhmwpe")


def test_the_outer_radius_is_that_of_the_shell():
    joint = bs.Joint(**GOOD, backing=(SHELL, BONE))
    assert joint.outer_radius == pytest.approx(16.1 + 6.0 + 4.0)
    assert joint.replace(outer_diameter=50.0).liner_thickness == pytest.approx(4.9)
    assert bs.Joint(**GOOD, backing=(BONE,)).outer_radius == pytest.approx(22.1)


SHELL = bs.Layer(thickness=4.0, material=bs.TITANIUM)
CEMENT = bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
BONE = bs.Layer(thickness=np.inf, material=bs.CORTICAL_BONE)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"backing": SHELL}, "backing must be a tuple of Layers from the liner outwards, got <Layer"),
        ({"backing": (SHELL, 3.0)}, r"backing\[1\] must be a Layer, got 3\.0"),
        ({"support": "free"}, "support must be Support.FIXED or Support.FREE, got 'free'"),
    ],
)
def test_invalid_backings_raise_a_type_error(changes, message):
    with pytest.raises(TypeError, match=message):
        bs.Joint(**(GOOD | changes))


def test_invalid_layers_are_rejected():
    with pytest.raises(ValueError, match=r"thickness = 0 is not allowed: a thickness \(mm\) is above 0; inf is"):
        bs.Layer(thickness=0.0, material=bs.TITANIUM)
    with pytest.raises(TypeError, match="material must be a Material, got 'titanium'"):
        bs.Layer(thickness=1.0, material="titanium")
    with pytest.raises(TypeError, match="thickness must be a number or an array .* got '4 mm'"):
        bs.Layer(thickness="4 mm", material=bs.TITANIUM)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"liner_thickness": np.inf, "backing": (SHELL,)}, "liner_thickness = inf is not allowed: only the outermost"),
        (
            {"liner_thickness": np.array([6.0, np.inf]), "backing": (SHELL,)},
            r"liner_thickness\[1\] = inf is not",
        ),
        ({"backing": (SHELL, BONE, CEMENT)}, r"backing\[1\].thickness = inf is not allowed: only the outermost layer"),
    ],
)
def test_only_the_outermost_layer_is_infinite(changes, message):
    with pytest.raises(ValueError, match=message):
        bs.Joint(**(GOOD | changes))


def test_a_backing_is_part_of_the_joint():
    joint = bs.Joint(**GOOD, ball=bs.COCR, backing=[SHELL, BONE], support=bs.Support.FREE)
    assert joint.backing == (SHELL, BONE)
    assert hash(joint) == hash(replace(joint))
    assert joint.numbers()[5:] == (230000.0, 0.3, 4.0, 110000.0, 0.3, np.inf, 17000.0, 0.3)
    assert joint.with_numbers(joint.numbers()) == joint
    rigid = replace(joint, ball=None)
    assert rigid.with_numbers(rigid.numbers()) == rigid
    summary = json.loads(json.dumps(joint.summary(), allow_nan=False))
    titanium = {"name": "titanium", "young": 110000.0, "poisson": 0.3, "yield_stress": 795.0}
    assert summary["backing"][0] == {"thickness": 4.0, **titanium}
    assert summary["backing"][1]["thickness"] == "inf"
    assert summary["support"] == "free"
    plain = bs.Joint(**GOOD).summary()
    assert (plain["backing"], plain["support"]) == ([], "fixed")


def test_a_backing_is_printed():
    text = str(bs.Joint(**GOOD, backing=(SHELL, BONE), support=bs.Support.FREE))
    behind = " on 4 mm of titanium (E 110000 MPa, nu 0.3) on a massive body of cortical bone (E 17000 MPa, nu 0.3)"
    assert f"liner 6 mm of UHMWPE (E 1000 MPa, nu 0.4){behind}, free outside; ball rigid" in text
    assert " on " not in str(bs.Joint(**GOOD))
    assert "free" not in str(bs.Joint(**GOOD))


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


def test_joints_and_materials_are_frozen():
    assert bs.Joint(**GOOD) == bs.Joint(**GOOD)
    with pytest.raises(FrozenInstanceError):
        bs.UHMWPE.young = 2.0


def test_limits_of_allowed_numbers_are_allowed():
    joint = bs.Joint(ball_radius=16.0, clearance=0.0, liner_thickness=np.inf, liner=bs.Material(young=1.0, poisson=0.5))
    assert joint.thickness_ratio == 0.0
    assert joint.modulus_ratio == 0.0
    assert joint.ball is None


def test_effective_modulus_combines_ball_and_liner():
    assert HIP.effective_modulus == pytest.approx(1 / (0.84 / 1000.0 + 0.91 / 230000.0))
    assert bs.Joint(**GOOD).effective_modulus == pytest.approx(1000.0 / 0.84)


@pytest.mark.parametrize("name", bs.materials)
def test_materials_have_sources(name):
    material = bs.materials[name]
    assert material.source
    assert material.name
    assert str(material).startswith(material.name)


@pytest.mark.parametrize("name", bs.joints)
def test_joints_have_sources_and_press(name):
    joint = bs.joints[name]
    assert joint.source
    answers = bs.compare(joint, force=1000.0)
    assert "hess-forsbach" in answers
    assert all(contact.max_pressure > 0 for contact in answers.values())


def test_presets_can_be_pickled():
    assert pickle.loads(pickle.dumps(bs.materials)) == bs.materials


@pytest.mark.parametrize(
    "value",
    [
        *(1 + 2j, np.array([1.0, 2.0j]), [[1.0, 2.0], [3.0]], ["1", "2"], np.True_, np.array([True]), np.float16(3.0)),
        *(None, np.ma.masked_array([1.0, 2.0], mask=[True, False]), np.array(["3 kN"])),
    ],
    ids=repr,
)
def test_values_that_are_not_real_numbers_are_rejected(value):
    with pytest.raises(TypeError, match="clearance must be a number or an array of real numbers in mm"):
        bs.Joint(**(GOOD | {"clearance": value}))


def test_integers_beyond_floating_point_are_rejected():
    with pytest.raises(ValueError, match="force is not allowed: the integer is too large"):
        bs.HessForsbach().press(HIP, force=10**400)
