"""Estimated changes on a hemisphere with a free rim and half a ball, against finite elements of that body."""

import json
import re
from dataclasses import replace
from math import inf, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.cli.json_answers import next_steps
from ballsocket.contact.closed_sphere import NOTED_CHANGE, hemisphere_indentation_change, max_hemisphere_change

from ...extent import some
from ...places import DATA

ROWS = json.loads((DATA / "hemisphere.json").read_text())["rows"]


def material(young, poisson, **more):
    return bs.Material(young=young, poisson=poisson, **more)


def layer(thickness, young, poisson=0.3):
    return bs.Layer(thickness=inf if thickness is None else thickness, material=material(young, poisson))


def closed_sphere_notes(contact):
    return [note for note in contact.notes if note.startswith("closed sphere: ")]


BASE = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=14.1 / 2.8, liner=material(1000.0, 0.4))
TITANIUM = bs.Layer(thickness=3.0, material=bs.TITANIUM)


@pytest.mark.parametrize("row", some(ROWS), ids=lambda row: f"{row['kind']} {row['change']['indentation']:.4f}")
def test_the_change_on_a_hemisphere_is_that_of_finite_elements(row):
    liner, *backing = [layer(*part) for part in row["layers"]]
    ball = None if row["ball"] is None else material(*row["ball"])
    joint = BASE.replace(liner_thickness=liner.thickness, liner=liner.material, ball=ball, backing=tuple(backing))
    contact = bs.ExactCurve().press(joint, half_angle=row["half_angle"])
    known = dict(row["change"])
    assert contact._hemisphere_von_mises_change == pytest.approx(known.pop("von_mises"), rel=0.17, abs=4.5e-3)
    for name, value in known.items():
        assert contact.hemisphere[name] == pytest.approx(value, rel=0.06, abs=5e-3), name
    assert bool(closed_sphere_notes(contact)) == (max(map(abs, known.values())) > NOTED_CHANGE)
    assert not contact.valid or abs(known["indentation"]) < 0.16


def thick(ratio, poisson):
    return {"liner_thickness": 14.1 / ratio, "liner": material(1000.0, poisson, yield_stress=1e3)}


@pytest.mark.parametrize(
    ("changes", "angle", "change", "rel", "noted"),
    [
        ({"backing": (TITANIUM, layer(15.0, 500.0))}, 45.0, 0.22, 0.2, ("d +", "dF/dd -")),
        ({"backing": (layer(20.0, 500.0),)}, 45.0, 0.062, 0.2, ("d +", "dF/dd -")),
        (thick(1.2, 0.45), 50.0, 0.009, 0.1, ("von Mises +",)),
        (thick(0.8, 0.495), 50.0, 0.085, 0.1, ("von Mises +",)),
        ({"liner": material(756.0, 0.48), "ball": material(110e3, 0.3)}, 50.0, 0.0190, 0.1, ()),
    ],
)
def test_soft_backings_thick_liners_and_slightly_soft_balls_are_noted(changes, angle, change, rel, noted):
    contact = bs.Exact().press(BASE.replace(**changes), half_angle=radians(angle))
    assert contact.hemisphere["indentation"] == pytest.approx(change, rel=rel, abs=1.5e-3)
    (note,) = closed_sphere_notes(contact)
    assert all(words in note for words in noted)
    assert contact.valid == (change < 0.15)


def test_the_note_has_the_changes_in_percent():
    joint = BASE.replace(backing=(TITANIUM, layer(15.0, 500.0)))
    contact = bs.Exact().press(joint, half_angle=radians(45.0))
    (note,) = closed_sphere_notes(contact)
    noted = {symbol: float(value) for symbol, value in re.findall(r"(d|ε|pmax|dF/dd) ([+-][\d.]+) %", note)}
    symbols = {"d": "indentation", "ε": "half_angle", "pmax": "max_pressure", "dF/dd": "stiffness"}
    change = {symbol: 100 * contact.hemisphere[name] for symbol, name in symbols.items()}
    assert noted == {symbol: pytest.approx(value, rel=5e-3) for symbol, value in change.items() if abs(value) > 1}
    assert {"d", "dF/dd"} <= set(noted)


@pytest.mark.parametrize("ball", [None, bs.COCR])
@pytest.mark.parametrize("load", [500.0, 3000.0])
def test_the_quick_estimate_is_near_the_computed_change(ball, load):
    joint = replace(bs.joints["hip-28"], ball=ball)
    contact = bs.Exact().press(joint, force=load)
    change = hemisphere_indentation_change(contact)
    assert change == pytest.approx(contact.hemisphere["indentation"], rel=0.3, abs=1e-4)
    largest = max(abs(value) for value in contact.hemisphere.values())
    assert max_hemisphere_change(contact) == pytest.approx(largest, rel=0.4, abs=2e-4)
    soft = bs.Exact().press(replace(joint, ball=material(50e3, 0.3)), force=load)
    assert hemisphere_indentation_change(soft) > change


def test_a_free_socket_has_the_change_of_finite_elements():
    """5 mm of liner without a backing: finite elements have d +14.1 % and dF/dd -16.2 % at 20 degrees."""
    joint = bs.joints["hip-28"].replace(support=bs.Support.FREE)
    change = bs.Exact().press(joint, half_angle=radians(20.0)).hemisphere
    assert change["indentation"] == pytest.approx(0.1414, rel=0.01)
    assert change["stiffness"] == pytest.approx(-0.1619, rel=0.01)


def test_the_change_does_not_depend_on_clearance_modulus_or_array():
    contact = bs.Exact().press(BASE, half_angle=radians(60.0))
    scaled = replace(BASE, clearance=0.02, ball_radius=14.08, liner=material(300.0, 0.4))
    several = bs.Exact().press(scaled, half_angle=np.radians([30.0, 60.0]))
    for name, value in contact.hemisphere.items():
        assert several.hemisphere[name][1] == pytest.approx(value, rel=1e-6), name


def test_tabulated_and_refined_models_estimate_the_change():
    joint = BASE.replace(liner_thickness=14.1 / 1.2, liner=material(1000.0, 0.46))
    for model in (bs.Tabulated(), bs.Refined()):
        contact = model.press(joint, half_angle=radians(50.0))
        assert closed_sphere_notes(contact)
    thicker = joint.replace(liner_thickness=30.0, liner=material(1000.0, 0.499))
    for model in (bs.Tabulated(), bs.Exact()):
        assert not model.press(thicker, half_angle=radians(60.0)).valid


def test_the_change_is_in_the_summary_and_names_the_next_model():
    contact = bs.Exact().press(BASE.replace(backing=(TITANIUM, layer(5.0, 500.0))), half_angle=radians(45.0))
    result = contact.summary()
    assert result["hemisphere"]["indentation"] == pytest.approx(contact.hemisphere["indentation"])
    steps = next_steps({"results": [result], "valid": True, "notes": []}, ["press", "hip.toml", "--model", "exact"])
    commands = [step["command"] for step in steps if "hemisphere" in step["why"]]
    assert [command.split()[-1] for command in commands] == ["fem", "sphere"]
