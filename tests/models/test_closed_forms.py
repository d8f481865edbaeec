"""Closed-form models: the contract of models outside the catalogue, moduli, and formulas of single models."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.arrays import gauss_legendre

from ..catalogue import test_contract as contract
from ..joints import HIP
from ..refusals import refused_calls

CORRECTED = bs.corrected_vessel(0.9, 0.2, -0.1)
OWN = {
    "steuermann of order 3": bs.Steuermann(exponent=3),
    "constant modulus": bs.RadialFoundation(modulus=bs.constant(250.0)),
    "polynomial modulus": bs.RadialFoundation(modulus=bs.polynomial(1.0, 2.0, 0.1)),
    "corrected vessel, exact kinematics": bs.RadialFoundation(modulus=CORRECTED, kinematics=bs.exact_kinematics),
    "strong adhesion": bs.AdhesiveSocket(work_of_adhesion=1e-3),
}
"""Models that are not in the catalogue."""
PLATE = bs.Joint(ball_radius=10.0, clearance=0.02, liner_thickness=np.inf, liner=bs.STEEL, ball=bs.STEEL)
LAWS = (
    contract.test_force_indentation_and_half_angle_are_inverse,
    contract.test_force_is_the_slope_of_the_energy_and_stiffness_that_of_the_force,
    contract.test_pressure_integrates_to_its_integral_and_its_vertical_part_to_the_force,
    contract.test_pressure_is_largest_at_the_stated_angle_zero_at_the_edge_and_at_a_direction_that_at_its_polar_angle,
    contract.test_zero_load_gives_zero_contact,
)


@pytest.mark.parametrize("model", OWN.values(), ids=OWN)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_models_outside_the_catalogue_obey_its_contract(model, law):
    law(model)


def test_moduli_have_their_formulas_and_a_vessel_that_of_a_thick_sphere_under_uniform_pressure():
    E, nu, a, b = 1000.0, 0.35, 18.0, 24.75
    # u = A r + B/r² with u(b) = 0 and σ_rr(a) = -p
    lame, shear = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    stress_per_A = (3 * lame + 2 * shear) + 4 * shear * b**3 / a**3
    displacement_per_A = a - b**3 / a**2
    joint = replace(HIP, liner=bs.Material(young=E, poisson=nu))
    assert bs.spherical_vessel(joint) == pytest.approx(stress_per_A / -displacement_per_A, rel=1e-12)
    E, nu, R2, L = 1000.0, 0.4, 18.0, 6.75
    kappa = R2 / (R2 + L)
    joint = replace(HIP, liner=bs.Material(young=E, poisson=nu))
    assert bs.bonded_layer(joint) == pytest.approx((1 - nu) * E / ((1 + nu) * (1 - 2 * nu) * L), rel=1e-12)
    factor = 0.9 + 0.2 * kappa - 0.1 * kappa**2
    assert CORRECTED(joint) == pytest.approx(bs.spherical_vessel(joint) * factor, rel=1e-12)
    ratio = R2 / L
    assert bs.polynomial(1.0, 2.0, 0.1)(joint) == pytest.approx(E / R2 * (1 + 2 * ratio + 0.1 * ratio**2), rel=1e-12)
    assert bs.constant(123.0)(joint) == 123.0


test_numbers_outside_their_range_are_refused = refused_calls(
    (lambda: bs.corrected_vessel(1.0, -1.5, 0.0), r"factor at κ = 0\.7 = .* must be above 0"),
    (lambda: bs.corrected_vessel(1.0, 0.0, -1.01), r"factor at κ = 1 = "),
    (lambda: bs.corrected_vessel(-0.1, 2.0, 0.0), r"factor at κ = 0 = "),
    (lambda: bs.corrected_vessel(np.inf, 0.0, 0.0), "a0 = inf is not allowed"),
    (lambda: bs.corrected_vessel(1.0, np.nan, 0.0), "a1 = nan is not allowed"),
    (lambda: bs.polynomial(-1.0, 1.0, 1.0), "c1 = -1 is not allowed"),
    (lambda: bs.polynomial(0.0, 0.0, 0.0), r"c1 \+ c2 \+ c3 = 0 is not allowed"),
    (lambda: bs.constant(0.0), "modulus = 0 is not allowed"),
    (lambda: bs.AdhesiveSocket(work_of_adhesion=-1.0), "work_of_adhesion = -1 is not allowed"),
    (lambda: bs.LiuReconstruction(coefficient=0.0), "coefficient = 0 is not allowed"),
    (lambda: bs.Steuermann(exponent=0), "exponent = 0 is not allowed: it must be an integer of 1 or more"),
    (lambda: bs.Steuermann(exponent=True), "exponent = True is not allowed"),
    (lambda: bs.Steuermann(exponent=1.5), "exponent = 1.5 is not allowed"),
    (lambda: bs.PinInHole().press(PLATE, line_load=-1.0), "line_load = -1 is not allowed"),
    (lambda: bs.PinInHole().press(PLATE, half_angle=1.5), "below 1.480527 .perfect fit."),
    (lambda: bs.PinInHole().press(PLATE), "exactly one of line_load, half_angle is needed"),
)


def test_constants_at_the_end_of_their_range_are_accepted():
    assert bs.corrected_vessel(0.01, 0.0, 0.0).constants == (0.01, 0.0, 0.0)
    assert bs.corrected_vessel(1.0, 0.0, -0.95).constants == (1.0, 0.0, -0.95)  # below 0 only beyond κ = 1
    assert bs.corrected_vessel(0.5, -1.9, 1.9).constants == (0.5, -1.9, 1.9)  # least at κ = 1/2, where it is 0.025
    assert bs.polynomial(0.0, 0.0, 1.0).constants == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_pressure_of_steuermann_is_that_of_his_formula(order):
    """p(r) from direct integration of Abel's formula for the gap A r^(2n)."""
    model = bs.Steuermann(exponent=order)
    contact = model.press(HIP, indentation=0.01)
    a, R2 = contact.half_angle * HIP.socket_radius, HIP.socket_radius
    A = HIP.clearance / (2 * HIP.ball_radius * R2) * R2 ** (2 - 2 * order)
    kappa = 4**order / np.prod([(2 * k) * (2 * k - 1) / k**2 for k in range(1, order + 1)])
    assert contact.indentation == pytest.approx(kappa * A * a ** (2 * order), rel=1e-10)
    E = HIP.effective_modulus
    nodes, weight = map(np.array, gauss_legendre(60))
    for share in (0.0, 0.4, 0.8):
        r = share * a
        y = np.sqrt(a * a - r * r) * nodes
        integral = np.sum(weight * np.sqrt(a * a - r * r) * (y * y + r * r) ** (order - 1))
        assert contact.pressure(r / R2) == pytest.approx(E / pi * kappa * A * 2 * order * integral, rel=1e-9)


def test_adhesion_holds_the_ball_until_the_pull_off_and_an_adhering_patch_without_indentation():
    """At d = 0 the patch of cos ε = 1 - η adheres; a smaller one belongs to a ball that is pulled."""
    model = bs.AdhesiveSocket(work_of_adhesion=1e-3)
    stretch, eta = model.critical_stretch(HIP), model.adhesion_number(HIP)
    K = bs.hess_forsbach(HIP)
    assert stretch == pytest.approx(np.sqrt(2e-3 / K), rel=1e-12)
    assert eta == pytest.approx(stretch / 0.1, rel=1e-12)
    contact = model.press(HIP, indentation=0.02)
    assert contact.pressure(contact.half_angle * (1 - 1e-9)) == pytest.approx(-K * stretch, rel=1e-6)
    assert contact.pressure(contact.half_angle * 1.001) == 0.0
    depths = np.linspace(-0.02, 0.02, 8001)
    forces = model.force(HIP.with_numbers([np.array([float(x)]) for x in HIP.numbers()]), depths)
    assert -forces.min() == pytest.approx(model.pull_off(HIP), rel=1e-6)
    patch = np.arccos(1 - model.adhesion_number(HIP))
    assert model.press(HIP, indentation=0.0).half_angle == pytest.approx(patch, rel=1e-9)
    contact = model.press(HIP, half_angle=patch * np.array([0.99, 1.01]))
    np.testing.assert_array_equal(contact.status, [bs.Status.NOT_REACHED, bs.Status.OK])
    assert contact.indentation[1] > 0


def test_half_space_fails_exactly_beyond_a_quarter_turn():
    radius = HIP.ball_radius * HIP.socket_radius / HIP.clearance
    for angle, status in ((1.2, bs.Status.OK), (1.570, bs.Status.OK), (1.572, bs.Status.BEYOND_EQUATOR)):
        contact = bs.Hertz().press(HIP, indentation=(angle * HIP.socket_radius) ** 2 / radius)
        assert contact.half_angle == pytest.approx(angle, rel=1e-12)
        assert contact.status is status


@pytest.mark.parametrize(
    ("poisson", "thickness", "width", "holds"),
    [(0.48, 12.0, 0.98 * 0.8, True), (0.48, 12.0, 1.02 * 0.8, False), (0.4, 3.0, 5.5, True)],
)
def test_nearly_incompressible_liner_limits_the_contact_width(poisson, thickness, width, holds):
    """(ν - 0.43) a/L is at most 0.04: at ν = 0.48 a contact of 0.8 liner thicknesses."""
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=poisson), liner_thickness=thickness)
    contact = bs.HessForsbach().press(joint, half_angle=np.arcsin(width * thickness / 18.0))
    assert contact.width_ratio == pytest.approx(width, rel=1e-12)
    assert any("(ν - 0.43) a/L" in note for note in contact.notes) is not holds


def test_pressure_of_a_pin_is_even_and_ends_at_its_edge():
    contact = bs.PinInHole().press(PLATE, line_load=500.0)
    angle = np.linspace(0.0, 0.999, 7) * contact.half_angle
    np.testing.assert_allclose(contact.pressure(-angle), contact.pressure(angle), rtol=1e-14)
    assert np.all(np.diff(contact.pressure(angle)) < 0)
    np.testing.assert_array_equal(contact.pressure(np.array([1.001 * contact.half_angle, 2.0, np.pi, -3.0])), 0.0)
