"""Coefficient of friction as an unknown, from friction torques of a sliding ball."""

import json
from math import pi, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import Measured, sliding_torque
from ballsocket.identify.misfit import by_differences
from ballsocket.identify.synthetic import trials

from ..cli.command import run
from ..extent import some

JOINT, MODEL = bs.joints["hess-forsbach"], bs.HessForsbach()
FORCE = np.linspace(300.0, 3000.0, 5)
CONTACT = MODEL.press(JOINT, force=FORCE)
RANGE = {"friction_coefficient": (0.0, 0.3)}
SIGMA = 20.0


def torques(values=None, *, axis_angle=pi / 2, uncertainty=SIGMA, **settings):
    """Make friction torques of μ = 0.06, or of stated values."""
    values = CONTACT.friction_torque(0.06, axis_angle) if values is None else values
    observable = sliding_torque(axis_angle)
    data = {"quantity": "friction_torque", "values": values, "uncertainty": uncertainty, "force": FORCE}
    return Measured(**data, observable=observable, **settings)


@pytest.mark.parametrize("axis_angle", some([0.7, 0.0, pi / 2], 1))
def test_the_coefficient_of_friction_is_recovered_from_torques_about_any_axis(axis_angle):
    result = bs.identify(MODEL, JOINT, torques(axis_angle=axis_angle), RANGE)
    assert result.point["friction_coefficient"] == pytest.approx(0.06, rel=1e-6)
    assert result.identifiable
    assert result["friction_coefficient"].unit == "1"
    assert (result.joint, result.model) == (JOINT, MODEL)


def test_estimate_and_band_are_those_of_weighted_linear_regression():
    """The torque is μ f(F), so that μ = Σ f T/Σ f² with the standard uncertainty σ/sqrt(Σ f²)."""
    noise = SIGMA * np.array([0.5, -1.0, 1.2, 0.3, -0.8])
    lever = np.asarray(CONTACT.friction_torque(1.0))
    values = 0.06 * lever + noise
    estimate = bs.identify(MODEL, JOINT, torques(values), RANGE)["friction_coefficient"]
    assert estimate.value == pytest.approx(lever @ values / (lever @ lever), rel=1e-6)
    half = 1.959964 * SIGMA / sqrt(lever @ lever)
    assert (estimate.high - estimate.low) / 2 == pytest.approx(half, rel=1e-3)


@pytest.mark.long
def test_bands_of_95_percent_contain_the_coefficient_in_most_trials():
    tried = trials(bs.identify(MODEL, JOINT, torques(), RANGE), 40, seed=3)
    assert tried.coverage["friction_coefficient"] >= 0.9
    assert abs(tried.bias["friction_coefficient"]) < 0.1


def test_friction_and_clearance_are_identified_from_torques_and_indentations():
    press = Measured(quantity="indentation", values=CONTACT.indentation, uncertainty=1e-4, force=FORCE)
    result = bs.identify(MODEL, JOINT, [press, torques()], {"clearance": (0.02, 0.3), **RANGE})
    assert result.point == pytest.approx({"clearance": JOINT.clearance, "friction_coefficient": 0.06}, rel=1e-4)
    assert result.identifiable


def test_jax_and_differences_have_equal_derivatives_by_the_coefficient():
    pytest.importorskip("jax")
    from ballsocket.identify.misfit import by_tracing

    misfit = bs.identify(MODEL, JOINT, torques(), RANGE).misfit
    theta = misfit.transform.to_theta([0.06])
    for traced, differences in zip(
        by_tracing(misfit.forward, misfit.transform, theta),
        by_differences(misfit.forward, misfit.transform, theta),
        strict=True,
    ):
        np.testing.assert_allclose(traced, differences, rtol=1e-8)


@pytest.mark.parametrize(("axis", "angle"), some([('axis_angle = "0 deg"', 0.0), ("", pi / 2)], 1))
def test_file_and_command_identify_the_coefficient(tmp_path, axis, angle):
    values = MODEL.press(JOINT, force=np.array([1e3, 2e3, 3e3])).friction_torque(0.06, angle)
    text = ", ".join(f'"{value / 1e3:.9f} N m"' for value in values)
    (tmp_path / "friction.toml").write_text(
        'model = "hess-forsbach"\njoint = "hess-forsbach"\n[free]\nfriction_coefficient = "0..0.3"\n'
        f'[[data]]\nquantity = "friction_torque"\nvalues = [{text}]\nforce = ["1 kN", "2 kN", "3 kN"]\n'
        f'uncertainty = "2 %"\n{axis}\n',
        "utf-8",
    )
    shown = run("identify", "friction.toml", "--json", folder=tmp_path)
    assert shown.returncode == 0, shown.stderr
    (estimate,) = json.loads(shown.stdout)["estimates"]
    assert estimate["name"] == "friction_coefficient"
    assert estimate["value"] == pytest.approx(0.06, rel=1e-6)
    assert estimate["low"] < 0.06 < estimate["high"]
    table = run("identify", "friction.toml", folder=tmp_path).stdout
    assert "hess-forsbach fitted to 3 values (3 x friction_torque)" in table
