"""Lengths that a joint gives stay while others vary, in every kind of study."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app.state.screen import Screen
from ballsocket.app.widgets.controls import by_name
from ballsocket.app.widgets.joint_controls import joint_controls
from ballsocket.files.joint_file import parse_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.studies.distributions import Rectangular
from ballsocket.studies.metadata import joint_dimension
from ballsocket.studies.optimisation import optimise
from ballsocket.studies.variance_shares import sensitivity

from ..cli.command import answer, run

SHELL = bs.Layer(thickness=4.0, material=bs.TITANIUM)
LINER = {"liner": bs.UHMWPE, "backing": (SHELL,)}
CUP = bs.Joint(head_diameter=28.0, clearance=0.1, outer_diameter=52.0, **LINER)
HEADS = [22.0, 28.0, 32.0, 36.0, 40.0]
BY_HAND = [bs.Joint(ball_radius=d / 2, clearance=0.1, liner_thickness=21.9 - d / 2, **LINER) for d in HEADS]
FILE = """
[joint]
head_diameter = "28 mm"
clearance = "0.1 mm"
outer_diameter = "52 mm"
[liner]
material = "uhmwpe"
[shell]
material = "titanium"
thickness = "4 mm"
"""


def pressures(model, joints):
    return np.array([model.press(joint, force=3000.0).max_pressure for joint in joints])


def test_heads_of_one_cup_share_its_outside():
    model = bs.Exact()
    found = bs.study(model, CUP, head_diameter=HEADS, force=3000.0)
    expected = pressures(model, BY_HAND)
    np.testing.assert_allclose(found.max_pressure, expected, rtol=1e-9)
    assert HEADS[expected.argmin()] == 32.0
    assert (found.outer_diameter.item(), found.clearance.item()) == (52.0, 0.1)
    np.testing.assert_allclose(joint_dimension(found, "liner_thickness"), [joint.liner_thickness for joint in BY_HAND])
    assert json.loads(found.attrs["held"]) == {"clearance": 0.1, "outer_diameter": 52.0, "shell_thickness": 4.0}


def test_the_best_head_and_its_scatter_hold_the_outside():
    best = optimise(bs.Exact(), CUP, {}, choices={"head_diameter": HEADS}, load={"force": 3000.0})
    assert best.point == {"head_diameter": 32.0}
    assert (best.joint.outer_diameter, best.held["outer_diameter"]) == pytest.approx((52.0, 52.0))
    heads = {"head_diameter": Rectangular(low=27.9, high=28.1)}
    spread = sensitivity(bs.HessForsbach(), CUP, heads, load={"force": 3000.0}, count=8)
    thicker, thinner = (bs.HessForsbach().press(CUP.replace(head_diameter=d), force=3e3) for d in (27.9, 28.1))
    slope = np.log(thinner.max_pressure / thicker.max_pressure) / np.log(28.1 / 27.9)
    assert spread.elasticity.sel(quantity="max_pressure").item() == pytest.approx(slope, rel=1e-3)
    assert json.loads(spread.attrs["held"]) == {"clearance": 0.1, "outer_diameter": 52.0, "shell_thickness": 4.0}


def test_a_thicker_shell_takes_from_the_liner_of_one_outside():
    found = bs.study(bs.Exact(), CUP, shell_thickness=[2.0, 4.0, 5.0], force=3000.0)
    shells = [bs.Layer(thickness=thickness, material=bs.TITANIUM) for thickness in (2.0, 4.0, 5.0)]
    inner = {"ball_radius": 14.0, "clearance": 0.1, "liner": bs.UHMWPE}
    by_hand = [bs.Joint(**inner, liner_thickness=11.9 - shell.thickness, backing=(shell,)) for shell in shells]
    np.testing.assert_allclose(found.max_pressure, pressures(bs.Exact(), by_hand), rtol=1e-9)
    np.testing.assert_allclose(joint_dimension(found, "liner_thickness"), [9.9, 7.9, 6.9])
    with pytest.raises(ValueError, match="the joint has no shell"):
        bs.study(bs.Hertz(), bs.joints["hip-28"], shell_thickness=[2.0, 4.0], force=3000.0)


def test_a_varied_wall_needs_the_length_that_stays():
    with pytest.raises(ValueError, match="add the one that stays, head_diameter = 28 mm or outer_diameter = 52 mm"):
        bs.study(bs.Hertz(), CUP, liner_thickness=[4.0, 6.0], force=3000.0)
    by_head = bs.study(bs.HessForsbach(), CUP, liner_thickness=[4.0, 6.0], head_diameter=28.0, force=3000.0)
    by_outside = bs.study(bs.HessForsbach(), CUP, liner_thickness=[4.0, 6.0], outer_diameter=52.0, force=3000.0)
    np.testing.assert_allclose(joint_dimension(by_head, "outer_diameter"), [44.2, 48.2])
    np.testing.assert_allclose(joint_dimension(by_outside, "head_diameter"), [35.8, 31.8])


def test_files_keep_what_they_give_through_the_shell_and_the_explorer(tmp_path):
    file = parse_joint(FILE.encode(), "cup")
    assert file.joint == CUP
    again = parse_joint(toml_of(file).encode(), "cup")
    assert again.joint.given_lengths == file.joint.given_lengths
    inputs = by_name(joint_controls(Screen(file=replace(again, load={"force": 3000.0}))))
    bigger = inputs["ball_radius"].read("32")["file"].joint  # the explorer shows diameters
    assert bigger.liner_thickness == pytest.approx(5.9)
    thinner = inputs["liner_thickness"].read("5")["file"].joint
    assert (thinner.head_diameter, thinner.outer_diameter) == pytest.approx((28.0, 46.2))
    (tmp_path / "cup.toml").write_text(FILE, encoding="utf-8")
    out = tmp_path / "heads.csv"
    (tmp_path / "heads.toml").write_text(
        'joint = "cup.toml"\nmodel = "exact"\n[axes]\nforce = "3 kN"\nhead_diameter = ["28 mm", "40 mm"]'
    )
    printed = run("study", "heads.toml", f"--out={out}", folder=tmp_path).stdout
    assert "held: radial clearance 0.1 mm, outer diameter 52 mm, shell thickness 4 mm" in printed
    rows = np.genfromtxt(out, delimiter=",", names=True)
    np.testing.assert_allclose(rows["outer_diameter_mm"], 52.0)
    np.testing.assert_allclose(rows["liner_thickness_mm"], [7.9, 1.9])  # which follows
    np.testing.assert_allclose(rows["max_pressure_MPa"], pressures(bs.Exact(), (BY_HAND[1], BY_HAND[-1])), rtol=1e-6)
    pressed = run("press", "cup.toml", "--head-diameter=40", "--force=3 kN", folder=tmp_path).stdout
    assert "liner 1.9 mm" in pressed
    assert "outer diameter 52 mm" in pressed


def test_a_study_of_a_preloaded_joint_holds_its_interference():
    fitted = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM)
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=np.radians(240.0)), ring_width=np.radians(6.0))
    for name, values in (("liner_thickness", [2.0, 3.0]), ("interference", [0.02, 0.03])):
        found = bs.study(model, fitted, quantities=["max_pressure"], force=0.0, **{name: values})
        alone = [model.press(fitted.replace(**{name: value}), force=0.0).max_pressure for value in values]
        np.testing.assert_allclose(found.max_pressure.values.ravel(), alone, rtol=1e-9)


TILTED = f"{FILE[: FILE.index('[shell]')]}[load]\nforce = '3 kN'\ntilt = '50 deg'"
UNBACKED = bs.Joint(head_diameter=28.0, clearance=0.1, outer_diameter=52.0, liner=bs.UHMWPE)


def test_a_study_takes_the_load_and_the_tilt_of_the_joint_file(tmp_path):
    (tmp_path / "cup.toml").write_text(TILTED, encoding="utf-8")
    (tmp_path / "study.toml").write_text("joint = 'cup.toml'\n[axes]\nclearance = [0.1]", encoding="utf-8")
    run("study", "study.toml", "--out=study.csv", folder=tmp_path)
    row = next(csv.DictReader((tmp_path / "study.csv").read_text(encoding="utf-8").splitlines()))
    expected = bs.HessForsbach().press(UNBACKED, force=3000.0)
    assert float(row["max_pressure_MPa"]) == pytest.approx(expected.max_pressure, rel=1e-9)
    assert np.radians(40.0) < expected.half_angle  # the rim cuts the contact, a full sphere in this model
    assert "near the rim" in row["why_not_valid"]


@pytest.mark.long
def test_maps_off_the_axis_press_along_the_direction_of_the_joint_file(tmp_path):
    (tmp_path / "cup.toml").write_text(TILTED, encoding="utf-8")
    ranges = ("--x=clearance=0.2..0.3", "--y=force=1..3 kN", "--points=2", "--limit=edge_distance>=1 mm")
    mapped = answer("map", "cup.toml", "--model=sphere", *ranges, folder=tmp_path)
    joint = UNBACKED.replace(clearance=np.array([[0.2], [0.3]]), head_diameter=28.0)
    contacts = bs.Sphere().press(joint, force=np.array([1e3, 3e3]), tilt=np.radians(50.0))
    assert mapped["verdicts"]["kept"] == (contacts.edge_distance > 1.0).sum() == 2
