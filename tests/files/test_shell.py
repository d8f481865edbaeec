"""Shells in joint files, whose thickness follows from an outer dimension; orientations of cups in files."""

from math import radians

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile, joint_of, varied
from ballsocket.files.joint_toml import tables_of

LENGTHS = {"head_diameter": "36 mm", "diametral_clearance": "0.3 mm"}
LINER = {"material": "xlpe"}
LINER_WALL = {"liner_thickness": 6.5}


def file_of(shell=None, **lengths):
    """Read a joint with a shell of titanium."""
    content = {"joint": {**LENGTHS, **lengths}, "liner": LINER, "shell": {"material": "Ti6Al4V", **(shell or {})}}
    return joint_of(content)


@pytest.mark.parametrize("outer", [{"outer_diameter": "52 mm"}, {"outer_radius": 26}])
def test_the_thickness_of_a_shell_or_liner_follows_from_the_outer_dimension(outer):
    file = file_of(liner_thickness="6.5 mm", **outer)
    assert file.joint.backing == (bs.Layer(thickness=1.35, material=bs.TITANIUM),)
    assert file.joint.outer_diameter == pytest.approx(52.0, rel=1e-14)
    assert joint_of(tables_of(file)).joint == file.joint
    assert file_of({"thickness": "1.35 mm"}, **outer).joint.liner_thickness == pytest.approx(6.5, rel=1e-14)


def test_a_shell_lies_between_the_liner_and_further_layers():
    content = {"joint": LENGTHS | LINER_WALL, "liner": LINER, "shell": {"material": "titanium", "thickness": 3}}
    content["backing"] = [{"material": "cancellous-bone", "thickness": "inf"}]
    assert [layer.material for layer in joint_of(content).joint.backing] == [bs.TITANIUM, bs.CANCELLOUS_BONE]


def test_a_shell_of_a_preset_takes_its_liner():
    plain = joint_of({"joint": LENGTHS | LINER_WALL, "liner": LINER})
    shelled = varied(plain, {"shell": {"material": "titanium"}, "joint": {"outer_diameter": 52}})
    assert shelled.joint.backing[0].thickness == 1.35
    with pytest.raises(ValueError, match="the joint has layers behind its liner already"):
        varied(shelled, {"shell": {"material": "titanium", "thickness": 2}})


@pytest.mark.parametrize(
    ("shell", "lengths", "message"),
    [
        ({}, LINER_WALL, "the thickness of the shell is missing: state it, or outer_diameter and"),
        ({}, {"outer_diameter": 52}, "liner_thickness is missing: outer_diameter alone"),
        ({}, {**LINER_WALL, "outer_diameter": "49 mm"}, "outer_diameter = '49 mm' is not .* take 49.3 mm, which"),
        ({}, {**LINER_WALL, "outer_radius": 24.5}, "outer_radius = 24.5 is not .* take 24.65 mm, which leaves no"),
        ({"thickness": 2}, {**LINER_WALL, "outer_diameter": 52}, "one too many: .* = 6.5 mm, but .* make 5.85 mm"),
        ({"thickness": "-1 mm"}, LINER_WALL, "shell.thickness = '-1 mm' is not allowed: a thickness"),
    ],
)
def test_shells_that_do_not_follow_are_refused(shell, lengths, message):
    with pytest.raises(ValueError, match=message):
        file_of(shell, **lengths)


def read_cup(table, *base):
    return varied(JointFile(bs.joints["hip-28"], {}, *base), {"cup": table}).cup


def test_a_cup_has_the_angles_of_its_definition():
    cup = read_cup({"inclination": 43.0795, "anteversion": 20.7536, "orientation": "operative", "side": "left"})
    assert (cup.inclination, cup.anteversion) == pytest.approx((radians(45.0), radians(15.0)), abs=1e-6)
    assert cup.side is bs.Side.LEFT
    tilted = read_cup({"pelvic_tilt": "10 deg"}, cup)
    assert tilted.angles("operative")[1] == pytest.approx(radians(10.7536), abs=1e-12)
    turned = read_cup({"anteversion": 5, "orientation": "operative"}, cup)
    assert turned.angles("operative") == pytest.approx((radians(43.0795), radians(5.0)), abs=1e-12)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"orientation": "operative"}, "orientation = 'operative' needs an inclination and an anteversion"),
        ({"pelvic_tilt": 10}, "pelvic_tilt needs the inclination and the anteversion of the cup"),
        ({"inclination": 40, "pelvic_tilt": "100 deg"}, "pelvic_tilt = '100 deg' is not allowed: a pelvic tilt .deg."),
        ({"inclination": 40, "orientation": "surgical"}, "orientation = 'surgical' is not allowed: 'radiographic' or"),
        ({"inclination": "95 deg", "orientation": "operative"}, "inclination = '95 deg' is not allowed"),
    ],
)
def test_orientations_that_are_not_allowed_are_refused(table, message):
    with pytest.raises(ValueError, match=message):
        read_cup(table)
