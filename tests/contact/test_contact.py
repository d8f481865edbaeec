"""Text, dictionaries, frames and plots of contacts and comparisons."""

import json

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

PRESSED = bs.HessForsbach().press(HIP, force=3000.0)


def test_a_contact_is_printed_and_summarised():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    assert "max_pressure" in repr(contact)
    assert "11.27" in repr(contact)
    assert "<table>" in contact._repr_html_()
    summary = json.loads(json.dumps(contact.summary(), allow_nan=False))
    assert list(summary) == [
        *("model", "force", "indentation", "half_angle_deg", "max_pressure", "area", "stiffness", "energy"),
        *("foundation_modulus", "pole_pressure", "max_pressure_angle_deg", "utilisation"),
        *("utilisation_note", "valid", "notes"),
    ]
    assert summary["half_angle_deg"] == pytest.approx(44.7199, abs=1e-4)
    assert summary["valid"] is True


def test_many_contacts_print_ranges_and_summarise_failures_as_none():
    contact = bs.Bartel().press(HIP, force=np.array([1000.0, 1e13]))
    assert "1 of 2" in repr(contact)
    summary = contact.summary()
    assert summary["indentation"][1] is None
    assert json.dumps(summary, allow_nan=False)


def test_comparison_prints_a_row_per_model_and_reasons_of_missing_models():
    answers = bs.compare(bs.joints["tilting-pad-pivot"], force=1000.0)
    assert "plane-layer" in answers.missing
    assert "use hertz" in repr(answers)
    assert len(answers.rows()) == len(answers)
    assert "<table>" in answers._repr_html_()
    with pytest.raises(KeyError, match="a layer of infinite thickness"):
        answers["bonded-layer"]
    with pytest.raises(ValueError, match="force = -1 is not allowed"):
        bs.compare(HIP, force=-1.0)


def test_contacts_convert_to_dictionaries_and_frames():
    pytest.importorskip("pandas")
    contact = bs.Exact().press(HIP, force=np.array([[1000.0], [3000.0]]))
    assert contact.to_dict() == contact.summary()
    frame = contact.to_frame()
    np.testing.assert_array_equal(frame.max_pressure_MPa, contact.max_pressure.ravel())
    np.testing.assert_array_equal(frame.half_angle_deg, np.degrees(contact.half_angle).ravel())
    assert frame.valid.tolist() == [True, True]
    assert len(PRESSED.to_frame()) == 1


def test_a_comparison_converts_to_a_frame():
    pytest.importorskip("pandas")
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
    with pytest.raises(ValueError, match="a plot shows one contact for each model, got 2; draw several with a study"):
        bs.Hertz().press(HIP, force=[1.0, 2.0]).plot()
    with pytest.raises(ValueError, match="there is nothing to draw: no model has an answer"):
        bs.Exact().press(HIP, force=1e13).plot()


def test_a_displacement_has_three_components():
    model = bs.HessForsbach()
    assert model.force_vector(HIP, [0.0, 0.0, 0.12]).shape == (3,)
    for wrong in ([0.1, 0.1], 0.1, [[1.0], [2.0]]):
        with pytest.raises(ValueError, match="displacement of shape .* its last axis holds x, y, z"):
            model.force_vector(HIP, wrong)


def test_area_and_ratios_follow_their_definitions():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    assert contact.area == pytest.approx(2 * np.pi * 17.9**2 * (1 - np.cos(contact.half_angle)))
    assert contact.indentation_ratio == pytest.approx(contact.indentation / 6.75)
    assert contact.width_ratio == pytest.approx(18.0 * np.sin(contact.half_angle) / 6.75)
    assert contact.conformity == pytest.approx(0.1 / contact.indentation)
    thick = bs.HessForsbach().press(HIP.replace(liner_thickness=30.0), indentation=0.05)
    assert thick.depth_ratio == pytest.approx(0.05 / 18.0)
    assert thick.indentation_ratio == pytest.approx(0.05 / 30.0)


def test_a_contact_of_floats_has_the_joint_that_was_pressed():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    assert contact.joint is HIP
    assert type(contact.joint.ball_radius) is float


def test_conformity_is_infinite_without_load():
    contact = bs.HessForsbach().press(HIP, force=0.0)
    assert contact.conformity == np.inf
    assert contact.foundation_modulus == pytest.approx(bs.hess_forsbach(HIP))
    assert bs.Hertz().press(HIP, force=0.0).foundation_modulus == np.inf


def test_negative_friction_and_nan_displacements_are_rejected():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    with pytest.raises(ValueError, match="coefficient = -0.1 is not allowed"):
        contact.friction_torque(-0.1)
    with pytest.raises(ValueError, match=r"displacement\[1\] = nan is not allowed"):
        bs.HessForsbach().force_vector(HIP, np.array([0.0, np.nan, 0.1]))
