"""Shells, orientations of cups, and changes of joint files."""

from dataclasses import replace
from math import radians

import pytest

import ballsocket as bs
from ballsocket.core.quantities import JOINT
from ballsocket.files.joint_file import JointFile, joint_of, varied
from ballsocket.files.joint_toml import tables_of

from ..refusals import refused_calls

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


def test_a_shell_lies_between_the_liner_and_further_layers_and_takes_the_liner_of_a_preset():
    content = {"joint": LENGTHS | LINER_WALL, "liner": LINER, "shell": {"material": "titanium", "thickness": 3}}
    content["backing"] = [{"material": "cancellous-bone", "thickness": "inf"}]
    for file in (joint_of(content), varied(joint_of(content), {"shell": {"thickness": 2}})):
        assert [layer.material for layer in file.joint.backing] == [bs.TITANIUM, bs.CANCELLOUS_BONE]
    plain = joint_of({"joint": LENGTHS | LINER_WALL, "liner": LINER})
    shelled = varied(plain, {"shell": {"material": "titanium"}, "joint": {"outer_diameter": 52}})
    assert shelled.joint.backing[0].thickness == 1.35


def test_options_replace_the_shell_of_a_file_and_hold_what_it_gives():
    outer = {"head_diameter": 28, "clearance": 0.1, "outer_diameter": 52}
    file = joint_of({"joint": outer, "liner": LINER, "shell": {"material": "titanium", "thickness": 4}})
    for shell, lengths, thickness, liner in [
        ({"thickness": 3}, {}, 3.0, 8.9),
        ({"material": "CoCr"}, {}, 4.0, 7.9),
        ({"material": "CoCr"}, {"outer_diameter": 50}, 4.0, 6.9),
        ({"material": "CoCr"}, {"outer_diameter": 50, "liner_thickness": 5}, 5.9, 5.0),
    ]:
        joint = varied(file, {"shell": shell, "joint": lengths}).joint
        assert (joint.backing[0].thickness, joint.liner_thickness) == pytest.approx((thickness, liner), abs=1e-12)
        assert joint.backing[0].material.name == ("CoCr" if "material" in shell else bs.TITANIUM.name)
    both = {"joint": outer | {"liner_thickness": 6}, "liner": LINER, "shell": {"material": "titanium"}}
    assert varied(joint_of(both), {"liner": {"material": "POM"}}).joint.given_lengths == both["joint"]
    with pytest.raises(ValueError, match="another shell would change another length that the joint gives"):
        varied(joint_of(both), {"shell": {"thickness": 3}})
    massive = {"joint": LENGTHS | LINER_WALL, "liner": LINER, "backing": [{"material": "titanium", "thickness": "inf"}]}
    with pytest.raises(ValueError, match="the layer behind the liner is massive"):
        varied(joint_of(massive), {"shell": {"material": "CoCr", "thickness": 2}})


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


STATED = joint_of(
    {
        "joint": {"head_diameter": 36, "clearance": 0.1, "outer_diameter": 52},
        "liner": {"material": "uhmwpe", "young": 900},
        "load": {"force": "3 kN", "tilt": 20},
        "cup": {"arc_of_cover": 170},
    }
)
THIN = {"joint": {"liner_thickness": 5, "head_diameter": 36}}


@pytest.mark.parametrize(
    ("tables", "changed"),
    [
        ({"joint": {"diametral_clearance": 0.3}}, {"clearance": 0.15, "ball_radius": 18, "outer_radius": 26}),
        ({"joint": {"ball_radius": 16}}, {"clearance": 0.1, "ball_radius": 16, "outer_radius": 26}),
        (THIN, {"ball_radius": 18, "clearance": 0.1, "outer_radius": 23.1}),
        (THIN, {"name": "varied: outer diameter 46.2 mm in place of 52 mm"}),
        ({"liner": {"material": "pom"}}, {"liner": bs.POM}),
        ({"liner": {"young": "2 GPa"}}, {"liner": replace(bs.UHMWPE, young=2000.0)}),
        ({"load": {"indentation": "40 um"}}, {"load": {"indentation": 0.04}, "aim": {"tilt": radians(20)}}),
        ({"load": {"direction": "0,0,1"}}, {"load": {"force": 3000}, "aim": {"direction": (0, 0, 1)}}),
        ({"cup": {"chamfer": 1}}, {"cup": bs.Cup(arc_of_cover=radians(170), chamfer=1.0)}),
    ],
)
def test_tables_replace_values_of_a_file_and_the_values_that_exclude_them(tables, changed):
    file = varied(STATED, tables)
    values = {name: getattr(file if hasattr(file, name) else file.joint, name) for name in changed}
    numbers = {name: value for name, value in changed.items() if name in JOINT}
    assert {name: values[name] for name in numbers} == pytest.approx(numbers, rel=1e-12)
    assert {**values, **numbers} == changed


def changed(**tables):
    return lambda: varied(STATED, tables)


test_lengths_angles_and_loads_that_do_not_follow_or_exclude_each_other_are_refused = refused_calls(
    (lambda: file_of(**LINER_WALL), "the thickness of the shell is missing: state it, or outer_diameter and"),
    (lambda: file_of(outer_diameter=52), "liner_thickness is missing: outer_diameter alone"),
    (lambda: file_of(**LINER_WALL, outer_diameter="49 mm"), "outer_diameter = '49 mm' is not .* take 49.3 mm, which"),
    (lambda: file_of(**LINER_WALL, outer_radius=24.5), "outer_radius = 24.5 is not .* take 24.65 mm, which leaves no"),
    (lambda: file_of({"thickness": 2}, **LINER_WALL, outer_diameter=52), "one too many: .* = 6.5 mm, but .* 5.85 mm"),
    (lambda: file_of({"thickness": "-1 mm"}, **LINER_WALL), "shell.thickness = '-1 mm' is not allowed: a thickness"),
    (changed(cup={"orientation": "operative"}), "orientation = 'operative' needs an inclination and an anteversion"),
    (changed(cup={"pelvic_tilt": 10}), "pelvic_tilt needs the inclination and the anteversion of the cup"),
    (changed(cup={"inclination": 40, "pelvic_tilt": "100 deg"}), "pelvic_tilt = '100 deg' is not allowed"),
    (changed(cup={"inclination": 40, "orientation": "surgical"}), "= 'surgical' is not allowed: 'radiographic' or"),
    (changed(cup={"inclination": "95 deg", "orientation": "operative"}), "inclination = '95 deg' is not allowed"),
    (changed(joint={"liner_thickness": 5}), "liner_thickness would change another length .* add the one that stays"),
    (changed(ball={"young": "2 GPa"}), "the ball needs a material, or young and poisson; missing: poisson"),
)
