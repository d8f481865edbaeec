"""Refined closed form: the exact solution that it was fitted to, and limits that need no fit."""

import csv

import mpmath
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import Shell, Socket
from ballsocket.models.liner_compliance import liner_coefficients, log_compliance_any_wave
from ballsocket.models.refined import FIT

from ..elasticity.exact.test_modes import reference
from ..joints import HIP, lined
from ..places import DATA

LINES = (DATA / "refined_reference.csv").read_text().splitlines()
ROWS = list(csv.DictReader(line for line in LINES if line[0] != "#"))
EXACT = {name: np.array([float(row[name]) for row in ROWS]) for name in ROWS[0]}
MODEL = bs.Refined()
WITHIN = 0.009


def joint_of(poisson, ratio, clearance=0.01) -> bs.Joint:
    return lined(poisson, 18.0 / ratio, ball_radius=18.0 - clearance, clearance=clearance)


JOINT = joint_of(EXACT["poisson"], EXACT["thickness_ratio"])
ANGLE = np.radians(EXACT["half_angle_deg"])
QUANTITIES = ("indentation", "max_pressure", "force")


@pytest.mark.parametrize("load", [{"half_angle": ANGLE}, {"force": EXACT["force"]}], ids=["half angle", "force"])
def test_quantities_are_within_one_percent_of_the_exact_ones(load):
    contact = MODEL.press(JOINT, **load)
    for name, values in (*((name, EXACT[name]) for name in QUANTITIES), ("half_angle", ANGLE)):
        np.testing.assert_allclose(getattr(contact, name), values, rtol=WITHIN, err_msg=name)


def test_the_profile_is_within_2_5_percent_of_the_peak():
    contact = MODEL.press(JOINT, half_angle=ANGLE)
    for share in (25, 50, 75, 90, 97):
        pressure, exact = contact.pressure(share / 100 * ANGLE), EXACT[f"at_{share}"]
        assert np.max(np.abs(pressure / contact.max_pressure - exact / EXACT["max_pressure"])) < 0.025, share


def test_new_random_points_agree_with_the_exact_model():
    rng = np.random.default_rng()  # another set every time: the bound is a promise, not a record
    poisson, ratio = rng.uniform(0.3, 0.46, 20), rng.uniform(1.0, 6.5, 20)
    angle = np.radians(rng.uniform(15.0, 60.0, 20))
    exact = bs.Exact(tolerance=1e-7).press(joint_of(poisson, ratio), half_angle=angle)
    contact = MODEL.press(joint_of(poisson, ratio), half_angle=angle)
    for name in (*QUANTITIES, "stiffness", "energy"):
        rtol = WITHIN if name in QUANTITIES else 0.05
        found, known = getattr(contact, name), getattr(exact, name)
        np.testing.assert_allclose(found, known, rtol=rtol, err_msg=f"{poisson} {ratio}")


def test_quantities_increase_with_half_angle_far_outside_the_fit():
    angle = np.radians(np.arange(0.2, 85.0, 0.2))[:, None, None]
    poisson = np.array([-0.9, -0.3, 0.0, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49, 0.499, 0.5])[:, None]
    contact = MODEL.press(joint_of(poisson, np.geomspace(0.05, 30.0, 14)), half_angle=angle)
    reached = contact.status == bs.Status.OK
    assert np.all(reached[np.degrees(angle[:, 0, 0]) < 79.0])
    assert np.all(np.diff(reached.astype(int), axis=0) <= 0)  # one closing angle, nothing behind it
    for name in QUANTITIES:
        growth = np.diff(np.log(np.where(reached, getattr(contact, name), np.nan)), axis=0)
        assert not np.any(growth <= 0), name


def test_a_small_contact_is_hertzian():
    joint = joint_of(np.array([0.3, 0.4, 0.48]), np.array([1.0, 2.7, 6.5]))
    ours, hertz = MODEL.press(joint, half_angle=1e-3), bs.Hertz().press(joint, half_angle=1e-3)
    for name in (*QUANTITIES, "stiffness", "energy"):
        # up to c/R2, by which the effective radius R1 R2/c differs from R2²/c
        np.testing.assert_allclose(getattr(ours, name), getattr(hertz, name), rtol=5e-3, err_msg=name)


@pytest.mark.parametrize(("low", "high", "within"), [(-2, -2, 2.3e-3), (1, 1, 2.4e-4), (0, 1, 0.01), (-2, 0, 0.032)])
def test_cubic_of_the_plane_bed_has_the_stated_error(low, high, within):
    scale, square, cube = FIT["plane"]
    for s in np.linspace(low, high, 51):
        true = mpmath.log(mpmath.gamma(1 - s / 2) * mpmath.gamma(2 - s / 2) / mpmath.mpf(2) ** s)
        assert abs(-s * np.log(scale) + square * s**2 + cube * s**3 - true) < within
    assert -np.log(scale) == pytest.approx(float(mpmath.euler - mpmath.log(2) - 0.5), abs=7e-5)


def shell_compliance(k: mpmath.mpf, poisson: float, thickness: float) -> mpmath.mpf:
    """c(n) E/R2 of a shell that is held outside, for the wave number k² = n (n + 1)."""
    shell = Shell(thickness=thickness, young=1.0, poisson=poisson)
    return reference(Socket(radius=1.0, shells=(shell,)), mpmath.sqrt(k * k + mpmath.mpf(1) / 4) - mpmath.mpf(1) / 2)


@pytest.mark.parametrize("poisson", [-0.3, 0.3, 0.45, 0.499])
@pytest.mark.parametrize("thickness", [0.1, 0.4, 2.0])
def test_compliance_equals_that_of_an_elastic_shell(poisson, thickness):
    """At q = 1 too, where the closed expression is 0/0 and its two forms meet."""
    numbers = np.sqrt([0.05, 0.3, 0.6999, 0.7001, 0.74, 0.75, 0.75 + 1e-13, 0.76, 0.7999, 0.8001, 2.0, 12.0, 400.0])
    liner = liner_coefficients(poisson, 1 + thickness)
    with mpmath.workdps(40):
        for number in numbers:
            log_c, rate = log_compliance_any_wave(float(number), liner)
            exact = mpmath.mpf(float(number)) + mpmath.mpf("1e-18")  # not on the 0/0
            value = shell_compliance(exact, poisson, thickness)
            step = mpmath.mpf("1e-7")
            below, above = (shell_compliance(exact * (1 + sign * step), poisson, thickness) for sign in (-1, 1))
            assert np.exp(log_c) == pytest.approx(float(value), rel=2e-12)
            assert rate == pytest.approx(float((above - below) / (2 * step * value)), abs=1e-9)


def test_validity_is_the_measured_range_of_width_and_poisson_ratio():
    poisson, ratio = np.array([0.4, 0.4, 0.0, 0.47, 0.4]), np.array([2.0, 2.0, 2.0, 2.0, 12.0])
    contact = MODEL.press(joint_of(poisson, ratio), half_angle=np.radians([45.0, 14.0, 61.0, 45.0, 45.0]))
    assert contact.valid.tolist() == [True, False, True, False, False]


@pytest.mark.parametrize(("coefficient", "position"), [(0.3, 0.0), (0.5, 0.0), (0.8, 0.25), (2.0, 0.5)])
def test_largest_pressure_of_a_full_profile_lies_on_a_ring(coefficient, position):
    """sqrt(1 - y)(1 + β y) is largest at y = (2β - 1)/(3β) for β above 1/2, which no fit has reached."""
    solution = MODEL.press(HIP, half_angle=0.9).laws
    vars(solution)["_shape_coefficient"] = coefficient
    angles = np.linspace(0.0, 0.9, 20_001)
    profile = solution.pressure(angles)
    assert solution.max_pressure == pytest.approx(profile.max(), rel=1e-8)
    assert solution.max_pressure_angle == pytest.approx(angles[profile.argmax()], abs=5e-5)
    assert np.sin(solution.max_pressure_angle / 2) ** 2 / np.sin(0.45) ** 2 == pytest.approx(position, abs=1e-12)
