"""Joints, materials and layers: checks, changes, text and sources."""

import json
import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

GOOD = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, "liner": bs.UHMWPE}
SHELL = bs.Layer(thickness=4.0, material=bs.TITANIUM)
CEMENT = bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
BONE = bs.Layer(thickness=np.inf, material=bs.CORTICAL_BONE)
NOT_A_NUMBER = "clearance must be a number or an array of real numbers in mm"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ball_radius": 0.0}, r"ball_radius = 0 is not allowed: a radius \(mm\) is above 0 and finite"),
        ({"ball_radius": -16.0}, "ball_radius = -16 is not allowed"),
        ({"ball_radius": np.inf}, "ball_radius = inf is not allowed"),
        ({"ball_radius": np.nan}, "ball_radius = nan is not allowed"),
        ({"ball_radius": "16 mm"}, "ball_radius must be a number or an array .* got '16 mm'"),
        ({"clearance": -0.1}, r"clearance = -0.1 is not allowed: .* a preloaded joint has an interference instead"),
        ({"clearance": np.array([0.1, 0.2, np.nan])}, r"clearance\[2\] = nan is not allowed"),
        ({"clearance": np.array([[0.1, -1.0], [-2.0, 0.2]])}, r"clearance\[0, 1\] = -1 \(and 1 more\) is not allowed"),
        *(
            ({"clearance": value}, NOT_A_NUMBER)
            for value in (
                *(True, 1 + 2j, np.array([1.0, 2.0j]), [[1.0, 2.0], [3.0]], ["1", "2"], np.True_, np.array([True])),
                *(np.float16(3.0), None, np.ma.masked_array([1.0, 2.0], mask=[True, False]), np.array(["3 kN"])),
            )
        ),
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
        ({"thickness": "4 mm"}, "thickness must be a number or an array .* got '4 mm'"),
        ({"material": "titanium"}, "material must be a Material, got 'titanium'"),
    ],
    ids=str,
)
def test_values_that_are_not_allowed_are_refused_by_name(changes, message):
    """By the joint, or by the material or layer that has the field."""
    make, good = {
        "young": (bs.Material, {"young": 1000.0, "poisson": 0.4}),
        "poisson": (bs.Material, {"young": 1000.0, "poisson": 0.4}),
        "thickness": (bs.Layer, {"thickness": 4.0, "material": bs.TITANIUM}),
        "material": (bs.Layer, {"thickness": 4.0, "material": bs.TITANIUM}),
    }.get(next(iter(changes)), (bs.Joint, GOOD))
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
    assert hip.replace(outer_diameter=48.0).liner_thickness == pytest.approx(5.9)
    assert hip.replace(name="mine").name == "mine"
    assert hip.replace() == hip
    with pytest.raises(ValueError, match="'linr' in a joint is not known; did you mean 'liner'"):
        hip.replace(linr=bs.UHMWPE)
    with pytest.raises(TypeError, match="liner must be a Material, got 'uhmwpe'"):
        hip.replace(liner="uhmwpe")


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


def test_limits_of_allowed_numbers_are_allowed():
    joint = bs.Joint(ball_radius=16.0, clearance=0.0, liner_thickness=np.inf, liner=bs.Material(young=1.0, poisson=0.5))
    assert joint.thickness_ratio == 0.0
    assert joint.modulus_ratio == 0.0
    assert joint.ball is None


def test_effective_modulus_combines_ball_and_liner():
    assert HIP.effective_modulus == pytest.approx(1 / (0.84 / 1000.0 + 0.91 / 230000.0))
    assert HIP.modulus_ratio == 1000.0 / 230000.0
    assert bs.Joint(**GOOD).effective_modulus == pytest.approx(1000.0 / 0.84)


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


def test_numbers_of_floats_are_restored_in_their_order():
    joint = bs.Joint(**(GOOD | {"ball_radius": 16}), ball=bs.COCR, backing=(SHELL, BONE))
    doubled = joint.with_numbers([2 * number for number in joint.numbers()])
    assert doubled.numbers() == tuple(2 * number for number in joint.numbers())
    assert doubled.ball.young == 460000.0
    assert doubled.backing[1].material.poisson == 0.6
    floats = joint.with_floats()
    assert type(floats.ball_radius) is float
    assert floats.with_floats() is floats
