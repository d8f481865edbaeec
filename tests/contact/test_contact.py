"""Quantities of contacts, and their text, dictionaries, frames and plots."""

import json
from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP
from ..refusals import refused_calls

PRESSED = bs.HessForsbach().press(HIP, force=3000.0)


def test_a_contact_is_summarised_for_json():
    assert PRESSED.joint is HIP
    assert type(PRESSED.joint.ball_radius) is float
    summary = json.loads(json.dumps(PRESSED.summary(), allow_nan=False))
    assert summary["half_angle_deg"] == pytest.approx(44.7199, abs=1e-4)
    assert summary["valid"] is True
    assert str(bs.HessForsbach().press(HIP, force=-0.0).summary()["force"]) == "0.0"
    some_failed = bs.Bartel().press(HIP, force=np.array([1000.0, 1e13]))
    assert json.loads(json.dumps(some_failed.summary(), allow_nan=False))["indentation"][1] is None
    assert bs.Exact().press(HIP, force=3000.0).summary()["error"]["force"] < 1e-3


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Tabulated(), bs.Hertz(), bs.Exact()], ids=lambda one: one.name)
def test_a_finished_contact_is_independent_of_the_arrays_of_the_caller(model):
    radius, young, force = np.array([14.0, 16.0]), np.array([800.0, 900.0]), np.array([100.0, 200.0])
    liner = bs.Material(young=young, poisson=0.4)
    joint = bs.Joint(ball_radius=radius, clearance=0.1, liner_thickness=8.0, liner=liner)
    contact, again = (model.press(joint, force=force) for _ in range(2))
    expected = np.array(again.max_pressure)
    radius[:], young[:], force[:] = 20.0, 5.0, 1.0
    np.testing.assert_array_equal(contact.max_pressure, expected)
    np.testing.assert_array_equal(contact.force, [100.0, 200.0])
    for array in (joint.ball_radius, liner.young, contact.force, contact.status, contact.valid, contact.max_pressure):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7


@pytest.mark.parametrize(
    ("scale", "notes"),
    [
        ({}, 0),
        ({"ball_radius": 0.014, "clearance": 1e-4, "liner_thickness": 0.008}, 1),
        ({"liner": bs.Material(young=1e9, poisson=0.4, yield_stress=2e7)}, 2),
        ({"ball": bs.Material(young=210e9, poisson=0.3)}, 1),
        ({"ball_radius": np.array([14.0, 0.014])}, 1),
    ],
)
def test_joints_in_metres_and_pascals_have_a_note(scale, notes):
    lengths = {"ball_radius": 14.0, "clearance": 0.1, "liner_thickness": 8.0, "liner": bs.UHMWPE}
    contact = bs.Bartel().press(bs.Joint(**{**lengths, **scale}), indentation=1e-5)
    assert sum("as if" in note for note in contact.notes) == notes
    presets = (bs.Hertz().press(joint, indentation=0.01) for joint in bs.joints.values())
    assert not any("as if" in note for contact in presets for note in contact.notes)


def test_an_error_that_is_not_known_is_absent():
    """Closed forms have that of their promise where they are valid."""
    assert not bs.Steuermann().press(HIP, force=1000.0).error
    spring = bs.HessForsbach().press(HIP, force=[1000.0, 1e7])
    assert spring.error["max_pressure"][0] == spring.model.promise.within
    assert np.isnan(spring.error["indentation"][1])
    assert "energy" not in spring.error


def test_a_comparison_has_a_row_per_model_and_reasons_of_missing_models():
    answers = bs.compare(bs.joints["tilting-pad-pivot"], force=1000.0)
    assert "use hertz" in answers.missing["plane-layer"]
    assert len(answers.rows()) == len(answers)
    with pytest.raises(KeyError, match="a layer of infinite thickness"):
        answers["bonded-layer"]


def test_contacts_and_comparisons_convert_to_dictionaries_and_frames():
    pytest.importorskip("pandas")
    contact = bs.Exact().press(HIP, force=np.array([[1000.0], [3000.0]]))
    assert contact.to_dict() == contact.summary()
    frame = contact.to_frame()
    np.testing.assert_array_equal(frame.max_pressure_MPa, contact.max_pressure.ravel())
    np.testing.assert_array_equal(frame.half_angle_deg, np.degrees(contact.half_angle).ravel())
    assert frame.valid.tolist() == [True, True]
    assert len(PRESSED.to_frame()) == 1
    answers = bs.compare(HIP.replace(liner_thickness=np.inf), force=1000.0)
    frame = answers.to_frame()
    assert list(frame.index) == [*answers, *answers.missing]
    assert frame.max_pressure_MPa["hertz"] == answers["hertz"].max_pressure
    assert np.isnan(frame.max_pressure_MPa["bonded-layer"])
    assert frame.notes["bonded-layer"] == answers.missing["bonded-layer"]
    many = bs.compare(HIP, force=[1000.0, 3000.0]).to_frame()
    assert many.loc[("exact", 1)].force_N == 3000.0


def test_contacts_and_comparisons_have_plots():
    (left, right), few = PRESSED.plot().axes, {"exact": bs.Exact(), "hertz": bs.Hertz()}
    assert left.lines[0].get_ydata()[0] == PRESSED.max_pressure
    assert right.lines[-1].get_ydata() == pytest.approx([3.0])
    assert len(bs.compare(HIP, force=1000.0, models=few).plot().axes[0].lines) == 2


def test_area_ratios_and_moduli_follow_their_definitions_and_have_their_limits():
    assert PRESSED.area == pytest.approx(2 * np.pi * 17.9**2 * (1 - np.cos(PRESSED.half_angle)))
    assert PRESSED.indentation_ratio == pytest.approx(PRESSED.indentation / 6.75)
    assert PRESSED.width_ratio == pytest.approx(18.0 * np.sin(PRESSED.half_angle) / 6.75)
    assert PRESSED.conformity == pytest.approx(0.1 / PRESSED.indentation)
    thick = bs.HessForsbach().press(HIP.replace(liner_thickness=30.0), indentation=0.05)
    assert thick.depth_ratio == pytest.approx(0.05 / 18.0)
    assert thick.indentation_ratio == pytest.approx(0.05 / 30.0)
    contact = bs.HessForsbach().press(HIP, force=0.0)
    assert contact.conformity == np.inf
    assert contact.foundation_modulus == pytest.approx(bs.hess_forsbach(HIP))
    for model in (bs.Hertz(), bs.PlaneLayer(), bs.Refined(), bs.Exact()):
        assert model.press(HIP, force=[0.0]).foundation_modulus == np.inf
    deep = bs.Hertz().press(HIP, indentation=0.1 * 18.0 * 4.0**2 / 17.9)
    assert deep.half_angle == pytest.approx(4.0, rel=1e-12)
    assert deep.area == pytest.approx(4 * pi * 17.9**2, rel=1e-12)


TWO_JOINTS = HIP.replace(clearance=np.array([0.1, 0.2]))
APART = r"the shapes \(2,\), \(3,\) of joint, load and direction do not broadcast"

test_arguments_that_are_not_allowed_are_refused = refused_calls(
    (lambda: bs.compare(HIP, force=-1.0), "force = -1 is not allowed"),
    (lambda: bs.Hertz().press(HIP, force=[1.0, 2.0]).plot(), "a plot shows one contact for each model, got 2"),
    (lambda: bs.Exact().press(HIP, force=1e13).plot(), "there is nothing to draw: no model has an answer"),
    (lambda: bs.HessForsbach().force_vector(HIP, [0.1, 0.1]), r"displacement of shape \(2,\) .* holds x, y, z"),
    (lambda: bs.HessForsbach().force_vector(HIP, 0.1), r"displacement of shape \(\) .* holds x, y, z"),
    (lambda: bs.HessForsbach().force_vector(HIP, [0.0, np.nan, 0.1]), r"displacement\[1\] = nan is not allowed"),
    (lambda: PRESSED.friction_torque(0.1, 90.0), "axis_angle = 90 is .*: it is in radians; 90 degrees are 1.571"),
    (lambda: PRESSED.friction_torque(0.1, -6.3), "axis_angle = -6.3 is not allowed"),
    (lambda: PRESSED.friction_torque(0.1, 6.3), "axis_angle = 6.3 is not allowed"),
    *(
        (lambda wrong=wrong: PRESSED.friction_torque(wrong), "a coefficient of friction is 0 or more and finite")
        for wrong in (-0.1, np.inf, np.nan)
    ),
    (lambda: PRESSED.pressure_at([0.0, 0.0, 1.001]), "a direction is a unit vector"),
    (lambda: PRESSED.pressure_at([0.0, 0.0, 0.999]), "a direction is a unit vector"),
    (lambda: bs.HessForsbach().press(TWO_JOINTS, force=[1.0, 2.0, 3.0]), APART),
    (lambda: bs.Sphere().press(HIP, force=[1.0, 2.0, 3.0], tilt=[0.1, 0.2]), APART),
    (lambda: replace(bs.UHMWPE, yield_stress=0.0), r"yield_stress = 0 is not allowed: a yield stress \(MPa\) is"),
    (lambda: replace(bs.UHMWPE, fatigue_limit="5 MPa"), "fatigue_limit must be a number"),
    error=(ValueError, TypeError),
)


@pytest.mark.parametrize("axis", [0.0, 0.4, 1.1, pi / 2, 2.5])
def test_friction_torque_is_the_integral_of_pressure_times_lever(axis):
    s = (np.arange(2000) + 0.5) / 2000
    angle, azimuth = PRESSED.half_angle * np.sin(pi / 2 * s), 2 * pi * (np.arange(720) + 0.5) / 720
    cosine = np.cos(angle)[:, None] * cos(axis) + np.sin(angle)[:, None] * np.cos(azimuth) * sin(axis)
    ring = PRESSED.pressure(angle) * np.sin(angle) * PRESSED.half_angle * pi / 2 * np.cos(pi / 2 * s) / 2000
    total = 2 * pi * HIP.socket_radius**2 * np.sum(ring * np.sqrt(1 - cosine**2).mean(axis=1))
    assert PRESSED.friction_torque(0.1, axis) == pytest.approx(0.1 * HIP.ball_radius * total, rel=1e-4)


def test_friction_torque_has_the_shape_of_the_contact_and_the_period_of_half_a_turn():
    contact = bs.HessForsbach().press(HIP, force=np.array([1000.0, 3000.0]))
    torque = contact.friction_torque(0.1)
    assert torque.shape == (2,)
    assert torque[1] == pytest.approx(PRESSED.friction_torque(0.1), rel=1e-12)
    assert type(PRESSED.friction_torque(0.1)) is float
    assert PRESSED.friction_torque(0.0) == 0.0
    assert PRESSED.pressure(-0.3) == PRESSED.pressure(0.3)
    assert type(PRESSED.pressure(0.3)) is float
    PRESSED.pressure_at([0.0, 0.0, 1 + 1e-7])
    torque = PRESSED.friction_torque(0.1, 0.7)
    for angle in (-0.7, pi - 0.7, pi + 0.7, 2 * pi - 0.7, 0.7 - 2 * pi):
        assert PRESSED.friction_torque(0.1, angle) == pytest.approx(torque, rel=1e-12)
    assert PRESSED.friction_torque(0.1, 2 * pi) == pytest.approx(PRESSED.friction_torque(0.1, 0.0), rel=1e-12)
