"""Estimated changes on a hemisphere with a free rim and half a ball, against finite elements of that body."""

import json
import re
from dataclasses import replace
from math import inf, radians
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact.closed_sphere import NOTED_CHANGE, hemisphere_indentation_change, max_hemisphere_change
from ballsocket.elasticity.exact.contact import NearHemisphere
from ballsocket.elasticity.exact.free_face import FreeFace
from ballsocket.elasticity.exact.modes import Shell, Socket

ROWS = json.loads((Path(__file__).parents[2] / "data" / "hemisphere.json").read_text())["rows"]
BONE = bs.Material(young=500.0, poisson=0.3)
TITANIUM = bs.Layer(thickness=3.0, material=bs.TITANIUM)
CLOSED = "closed sphere: "


def layer(thickness, young, poisson=0.3):
    return bs.Layer(thickness=thickness, material=bs.Material(young=young, poisson=poisson))


def joint_of(row):
    layers = [layer(inf if thickness is None else thickness, young, nu) for thickness, young, nu in row["layers"]]
    ball = None if row["ball"] is None else bs.Material(young=row["ball"][0], poisson=row["ball"][1])
    return bs.Joint(
        ball_radius=14.0,
        clearance=0.1,
        liner_thickness=layers[0].thickness,
        liner=layers[0].material,
        ball=ball,
        backing=tuple(layers[1:]),
    )


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['kind']} {row['change']['indentation']:.4f}")
def test_the_change_on_a_hemisphere_is_that_of_finite_elements(row):
    contact = bs.ExactCurve().press(joint_of(row), half_angle=row["half_angle"])
    known = {name: value for name, value in row["change"].items() if name != "von_mises"}
    for name, value in known.items():
        assert contact.hemisphere[name] == pytest.approx(value, rel=0.06, abs=5e-3), name
    noted = any(note.startswith(CLOSED) for note in contact.notes)
    assert noted == (max(map(abs, known.values())) > NOTED_CHANGE)
    assert not contact.valid or abs(known["indentation"]) < 0.16


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['kind']} {row['change']['von_mises']:.4f}")
def test_the_change_of_the_von_mises_stress_is_that_of_finite_elements(row):
    contact = bs.ExactCurve().press(joint_of(row), half_angle=row["half_angle"])
    assert contact._hemisphere_von_mises_change == pytest.approx(row["change"]["von_mises"], rel=0.17, abs=4.5e-3)


BASE = bs.Joint(
    ball_radius=14.0, clearance=0.1, liner_thickness=14.1 / 2.8, liner=bs.Material(young=1000.0, poisson=0.4)
)
SOFT_BACKED = {
    "5 mm of bone behind titanium": ((TITANIUM, layer(5.0, 500.0)), 0.09),
    "15 mm of bone behind titanium": ((TITANIUM, layer(15.0, 500.0)), 0.22),
    "15 mm of 2 GPa behind titanium": ((TITANIUM, layer(15.0, 2000.0)), 0.055),
    "20 mm of bone behind the liner": ((layer(20.0, 500.0),), 0.062),
}


@pytest.mark.parametrize("name", SOFT_BACKED)
def test_finite_soft_backings_are_noted(name):
    backing, change = SOFT_BACKED[name]
    contact = bs.Exact().press(BASE.replace(backing=backing), half_angle=radians(45.0))
    assert contact.hemisphere["indentation"] == pytest.approx(change, rel=0.2)
    assert any(note.startswith(CLOSED) and "d +" in note and "dF/dd -" in note for note in contact.notes)
    assert contact.valid == (change < 0.15)


@pytest.mark.parametrize(
    ("poisson", "ratio", "change"), [(0.45, 1.2, 0.009), (0.48, 1.2, 0.034), (0.495, 1.2, 0.067), (0.495, 0.8, 0.085)]
)
def test_thick_nearly_incompressible_liners_are_noted_with_their_von_mises_stress(poisson, ratio, change):
    liner = bs.Material(young=1000.0, poisson=poisson, yield_stress=1e3)
    joint = BASE.replace(liner_thickness=14.1 / ratio, liner=liner)
    contact = bs.Exact().press(joint, half_angle=radians(50.0))
    assert contact.hemisphere["indentation"] == pytest.approx(change, rel=0.1, abs=1.5e-3)
    note = next(note for note in contact.notes if note.startswith(CLOSED))
    assert contact.valid
    assert "von Mises +" in note


@pytest.mark.parametrize(
    ("young", "poisson", "ball", "change"), [(2600.0, 0.4, 110e3, 0.031), (756.0, 0.48, 110e3, 0.0127)]
)
def test_balls_that_are_a_little_soft_are_noted(young, poisson, ball, change):
    joint = BASE.replace(liner=bs.Material(young=young, poisson=poisson), ball=bs.Material(young=ball, poisson=0.3))
    contact = bs.Exact().press(joint, half_angle=radians(50.0))
    assert contact.hemisphere["indentation"] > NOTED_CHANGE
    assert any(note.startswith(CLOSED) for note in contact.notes)


def test_the_note_has_the_changes_in_percent():
    contact = bs.Exact().press(BASE.replace(backing=(TITANIUM, layer(15.0, 500.0))), half_angle=radians(45.0))
    note = next(note for note in contact.notes if note.startswith(CLOSED))
    noted = {symbol: float(value) for symbol, value in re.findall(r"(d|ε|pmax|dF/dd) ([+-][\d.]+) %", note)}
    change = contact.hemisphere
    assert noted["d"] == pytest.approx(100 * change["indentation"], rel=5e-3)
    assert noted["dF/dd"] == pytest.approx(100 * change["stiffness"], rel=5e-3)
    assert set(noted) == {
        symbol
        for symbol, name in (
            ("d", "indentation"),
            ("ε", "half_angle"),
            ("pmax", "max_pressure"),
            ("dF/dd", "stiffness"),
        )
        if abs(change[name]) > 0.01
    }
    assert "up to" not in note
    angles = np.radians([20.0, 45.0])
    several = bs.Exact().press(BASE.replace(backing=(TITANIUM, layer(15.0, 500.0))), half_angle=angles)
    assert any("has up to d +" in note for note in several.notes)
    largest = max(several.hemisphere["indentation"])
    assert any(f"d +{100 * largest:.3g} %" in note for note in several.notes)


def test_a_contact_is_near_the_hemisphere_up_to_fifteen_percent():
    limit = NearHemisphere()
    assert str(limit) == "change of d or pmax on a hemisphere ≤ 15 %"
    for indentation, pressure, near in ((0.14, -0.14, True), (0.16, 0.0, False), (0.0, -0.16, False)):
        contact = SimpleNamespace(
            hemisphere={"indentation": indentation, "max_pressure": pressure},
            hemisphere_change_bound=lambda name: inf,
            indentation=0.1,
        )
        assert limit.holds(contact) == near
        contact.hemisphere_change_bound = lambda name: 0.15
        assert limit.holds(contact)


def test_a_common_hip_has_no_note():
    contact = bs.Exact().press(bs.joints["hess-forsbach"], force=3000.0)
    assert contact.notes == ()
    assert max(map(abs, contact.hemisphere.values())) < NOTED_CHANGE


def test_a_free_socket_has_the_change_of_finite_elements():
    """5 mm of liner without a backing: finite elements have d +14.1 % and dF/dd -16.2 % at 20 degrees."""
    joint = bs.joints["hip-28"].replace(support=bs.Support.FREE)
    change = bs.Exact().press(joint, half_angle=radians(20.0)).hemisphere
    assert change["indentation"] == pytest.approx(0.1414, rel=0.01)
    assert change["stiffness"] == pytest.approx(-0.1619, rel=0.01)


def test_the_change_does_not_depend_on_clearance_modulus_or_array():
    contact = bs.Exact().press(BASE, half_angle=radians(60.0))
    scaled = replace(BASE, clearance=0.02, ball_radius=14.08, liner=bs.Material(young=300.0, poisson=0.4))
    several = bs.Exact().press(scaled, half_angle=np.radians([30.0, 60.0]))
    for name, value in contact.hemisphere.items():
        assert several.hemisphere[name][1] == pytest.approx(value, rel=1e-6), name


def test_layers_of_one_material_are_one_layer():
    single, double = (
        FreeFace(socket=Socket(radius=10.0, shells=shells)).bore_displacement[:, :6]
        for shells in (
            (Shell(thickness=8.0, young=2.0, poisson=0.4),),
            (Shell(thickness=3.0, young=2.0, poisson=0.4), Shell(thickness=5.0, young=2.0, poisson=0.4)),
        )
    )
    x = np.cos(np.linspace(0.0, 1.3, 9))
    waves = np.polynomial.legendre.legvander(x, len(single) - 1)
    assert waves @ single == pytest.approx(waves @ double, abs=0.02 * abs(waves @ single).max())


def test_tabulated_and_refined_models_estimate_the_change():
    joint = BASE.replace(liner_thickness=14.1 / 1.2, liner=bs.Material(young=1000.0, poisson=0.46))
    exact = bs.Exact().press(joint, half_angle=radians(50.0))
    for model in (bs.Tabulated(), bs.Refined()):
        contact = model.press(joint, half_angle=radians(50.0))
        assert any(note.startswith(CLOSED) for note in contact.notes)
        assert hemisphere_indentation_change(contact) == pytest.approx(exact.hemisphere["indentation"], rel=0.4)
        assert max_hemisphere_change(contact) > NOTED_CHANGE
        assert model.press(bs.joints["hess-forsbach"], force=3000.0).notes == ()
    thick = joint.replace(liner_thickness=30.0, liner=bs.Material(young=1000.0, poisson=0.499))
    assert not bs.Tabulated().press(thick, half_angle=radians(60.0)).valid
    assert not bs.Exact().press(thick, half_angle=radians(60.0)).valid


def test_the_change_is_in_the_summary_and_names_the_next_model(tmp_path):
    from ballsocket.cli.json_answers import next_steps

    contact = bs.Exact().press(BASE.replace(backing=(TITANIUM, layer(5.0, 500.0))), half_angle=radians(45.0))
    result = contact.summary()
    assert result["hemisphere"]["indentation"] == pytest.approx(contact.hemisphere["indentation"])
    steps = next_steps({"results": [result], "valid": True, "notes": []}, ["press", "hip.toml", "--model", "exact"])
    commands = [step.summary() for step in steps if "hemisphere" in step.why]
    assert [step["command"].split()[-1] for step in commands] == ["fem", "sphere"]
