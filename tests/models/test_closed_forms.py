"""Laws of the closed-form models: slopes, integrals of the pressure, inverses and published values."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.models import table_3
from ballsocket.models.closed_form import ClosedForm
from ballsocket.models.kinematics import angle_of, versine_of

from ..joints import HIP

CORRECTED = bs.corrected_vessel(0.9, 0.2, -0.1)
MODELS = {
    **{name: bs.catalogue[name] for name in bs.catalogue if name not in ("exact", "tabulated", "pin-in-hole")},
    "steuermann of order 3": bs.Steuermann(exponent=3),
    "constant modulus": bs.RadialFoundation(modulus=bs.constant(250.0)),
    "polynomial modulus": bs.RadialFoundation(modulus=bs.polynomial(1.0, 2.0, 0.1)),
    "corrected vessel, exact kinematics": bs.RadialFoundation(modulus=CORRECTED, kinematics=bs.exact_kinematics),
    "strong adhesion": bs.AdhesiveSocket(work_of_adhesion=1e-3),
}
EVERY = pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
DEPTHS = np.array([0.004, 0.02, 0.05])
PLANAR = {name for name, model in MODELS.items() if model.planar}


def quadrature(count=400):
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (1 + nodes) / 2, weights / 2


@EVERY
def test_force_is_the_slope_of_energy_and_stiffness_that_of_force(model):
    step = 1e-4 * DEPTHS
    above, here, below = (model.press(HIP, indentation=d) for d in (DEPTHS + step, DEPTHS, DEPTHS - step))
    np.testing.assert_allclose((above.energy - below.energy) / (2 * step), here.force, rtol=1e-6)
    np.testing.assert_allclose((above.force - below.force) / (2 * step), here.stiffness, rtol=1e-6)


@EVERY
def test_pressure_integrates_to_the_force_and_to_the_pressure_integral(model):
    contact = model.press(HIP, indentation=0.03)
    x, weight = quadrature()
    edge = contact.half_angle
    angle = edge * np.sin(pi / 2 * x)
    jacobian = edge * pi / 2 * np.cos(pi / 2 * x) * weight
    pressure, R2 = contact.pressure(angle), HIP.socket_radius
    if model.planar:
        force = total = 2 * pi * R2**2 * np.sum(pressure * angle * jacobian)
    else:
        total = 2 * pi * R2**2 * np.sum(pressure * np.sin(angle) * jacobian)
        force = 2 * pi * R2**2 * np.sum(pressure * np.sin(angle) * np.cos(angle) * jacobian)
    within = 0.02 if model.name == "liu-reconstruction" else 2e-4
    if model.name != "liu-reconstruction":  # its force is that of a plane contact circle
        assert force == pytest.approx(contact.force, rel=within)
    assert total == pytest.approx(contact.pressure_integral, rel=within)


@EVERY
def test_pressure_ends_at_the_edge_and_is_largest_where_stated(model):
    contact = model.press(HIP, indentation=0.03)
    edge = contact.half_angle
    angles = np.linspace(0.0, min(edge, pi / 2) * (1 - 1e-9), 3001)
    pressure = contact.pressure(angles)
    assert pressure.max() == pytest.approx(contact.max_pressure, rel=1e-4)
    assert contact.pressure(contact.max_pressure_angle) == pytest.approx(contact.max_pressure, rel=1e-4)
    assert contact.pressure(0.0) == pytest.approx(contact.pole_pressure, rel=1e-9)
    assert contact.foundation_modulus == pytest.approx(contact.pole_pressure / 0.03, rel=1e-9)
    outside = np.array([edge * (1 + 1e-6) + 1e-9, 1.2 * edge + 0.01, 2.0, 3.0])
    np.testing.assert_array_equal(contact.pressure(outside), 0.0)


@EVERY
def test_force_indentation_and_half_angle_are_inverse(model):
    contact = model.press(HIP, indentation=DEPTHS)
    np.testing.assert_allclose(model.press(HIP, force=contact.force).indentation, DEPTHS, rtol=1e-8)
    if model.name != "cosine-limit":
        by_angle = model.press(HIP, half_angle=contact.half_angle)
        np.testing.assert_allclose(by_angle.indentation, DEPTHS, rtol=1e-8)
        np.testing.assert_allclose(by_angle.force, contact.force, rtol=1e-8)


@EVERY
def test_plain_numbers_give_the_results_of_arrays(model):
    array, number = model.press(HIP, force=np.array([1500.0])), model.press(HIP, force=1500.0)
    for name in ("indentation", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral"):
        assert getattr(number, name) == pytest.approx(getattr(array, name)[0], rel=1e-12), name


@EVERY
def test_zero_load_gives_zero_contact(model):
    contact = model.press(HIP, force=0.0)
    if model.name == "adhesive":
        assert contact.indentation > 0
        return
    for name in ("indentation", "max_pressure", "energy", "pressure_integral", "stiffness"):
        assert getattr(contact, name) == pytest.approx(0.0, abs=1e-12), name


def test_vessel_modulus_is_the_thick_sphere_under_uniform_pressure():
    E, nu, a, b = 1000.0, 0.35, 18.0, 24.75
    # u = A r + B/r² with u(b) = 0 and σ_rr(a) = -p
    lame, shear = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    stress_per_A = (3 * lame + 2 * shear) + 4 * shear * b**3 / a**3
    displacement_per_A = a - b**3 / a**2
    joint = replace(HIP, liner=bs.Material(young=E, poisson=nu))
    assert bs.spherical_vessel(joint) == pytest.approx(stress_per_A / -displacement_per_A, rel=1e-12)


def test_moduli_have_their_formulas():
    E, nu, R2, L = 1000.0, 0.4, 18.0, 6.75
    kappa = R2 / (R2 + L)
    liner = bs.Material(young=E, poisson=nu)
    joint = replace(HIP, liner=liner)
    assert bs.bonded_layer(joint) == pytest.approx((1 - nu) * E / ((1 + nu) * (1 - 2 * nu) * L), rel=1e-12)
    assert CORRECTED(joint) == pytest.approx(
        bs.spherical_vessel(joint) * (0.9 + 0.2 * kappa - 0.1 * kappa**2), rel=1e-12
    )
    ratio = R2 / L
    assert bs.polynomial(1.0, 2.0, 0.1)(joint) == pytest.approx(E / R2 * (1 + 2 * ratio + 0.1 * ratio**2), rel=1e-12)
    assert bs.constant(123.0)(joint) == 123.0
    np.testing.assert_array_equal(
        bs.constant(np.array([1.0, 2.0]))(replace(joint, clearance=np.array([0.1, 0.2]))), [1.0, 2.0]
    )


def test_table_3_is_interpolated_through_its_columns_and_constant_beyond():
    columns = table_3.table_3()
    ratio = 18.0 / 6.75
    for nu, c1, c2, c3 in zip(columns["poisson"], columns["C1"], columns["C2"], columns["C3"], strict=True):
        K = bs.hess_forsbach(replace(HIP, liner=bs.Material(young=1000.0, poisson=nu)))
        assert pytest.approx(1000.0 / 18.0 * (c1 + c2 * ratio + c3 * ratio**2), rel=1e-9) == K, nu
    low, lower, high, higher = (
        bs.hess_forsbach(replace(HIP, liner=bs.Material(young=1000.0, poisson=nu)))
        for nu in (min(columns["poisson"]), 0.0, max(columns["poisson"]), 0.499)
    )
    assert lower == pytest.approx(low, rel=1e-12)
    assert higher == pytest.approx(high, rel=1e-12)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bs.corrected_vessel(1.0, -1.5, 0.0), r"factor at κ = 0\.7 = .* must be above 0"),
        (lambda: bs.corrected_vessel(1.0, 0.0, -1.01), r"factor at κ = 1 = "),
        (lambda: bs.corrected_vessel(-0.1, 2.0, 0.0), r"factor at κ = 0 = "),
        (lambda: bs.corrected_vessel(np.inf, 0.0, 0.0), "a0 = inf is not allowed"),
        (lambda: bs.corrected_vessel(1.0, np.nan, 0.0), "a1 = nan is not allowed"),
        (lambda: bs.polynomial(-1.0, 1.0, 1.0), "c1 = -1 is not allowed"),
        (lambda: bs.polynomial(0.0, 0.0, 0.0), r"c1 \+ c2 \+ c3 = 0 is not allowed"),
        (lambda: bs.constant(0.0), "modulus = 0 is not allowed"),
        (lambda: bs.AdhesiveSocket(work_of_adhesion=-1.0), "work_of_adhesion = -1 is not allowed"),
        (lambda: bs.AdhesiveSocket(work_of_adhesion=np.inf), "work_of_adhesion = inf is not allowed"),
        (lambda: bs.LiuReconstruction(coefficient=0.0), "coefficient = 0 is not allowed"),
        (lambda: bs.Steuermann(exponent=0), "exponent = 0 is not allowed: it must be an integer of 1 or more"),
        (lambda: bs.Steuermann(exponent=True), "exponent = True is not allowed"),
        (lambda: bs.Steuermann(exponent=1.5), "exponent = 1.5 is not allowed"),
    ],
)
def test_numbers_outside_their_range_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_constants_at_the_end_of_their_range_are_accepted():
    assert bs.corrected_vessel(0.01, 0.0, 0.0).constants == (0.01, 0.0, 0.0)
    assert bs.corrected_vessel(1.0, 0.0, -0.95).constants == (1.0, 0.0, -0.95)  # below 0 only beyond κ = 1
    assert bs.corrected_vessel(0.5, -1.9, 1.9).constants == (0.5, -1.9, 1.9)  # least at κ = 1/2, where it is 0.025
    assert bs.polynomial(0.0, 0.0, 1.0).constants == (0.0, 0.0, 1.0)
    assert bs.AdhesiveSocket(work_of_adhesion=0.0).work_of_adhesion == 0.0
    assert bs.Steuermann(exponent=1).exponent == 1


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
    nodes, weight = quadrature(60)
    for share in (0.0, 0.4, 0.8):
        r = share * a
        y = np.sqrt(a * a - r * r) * nodes
        integral = np.sum(weight * np.sqrt(a * a - r * r) * (y * y + r * r) ** (order - 1))
        assert contact.pressure(r / R2) == pytest.approx(E / pi * kappa * A * 2 * order * integral, rel=1e-9)


def test_pressure_of_plane_layer_has_the_foundation_modulus_of_its_pole():
    contact = bs.PlaneLayer().press(HIP, indentation=np.array([0.0, 0.02]))
    assert contact.foundation_modulus[0] == np.inf
    assert contact.foundation_modulus[1] == pytest.approx(contact.pole_pressure[1] / 0.02, rel=1e-12)
    np.testing.assert_array_equal(contact.max_pressure_angle, 0.0)


def test_adhesion_holds_the_ball_until_the_pull_off():
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
    strong = bs.AdhesiveSocket(work_of_adhesion=10.0)
    assert np.isnan(strong.pull_off(HIP))
    assert strong.press(HIP, indentation=0.02).half_angle == pytest.approx(pi / 2)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, 1.5, 3.0])
def test_versine_and_angle_are_inverse(angle):
    assert angle_of(versine_of(angle)) == pytest.approx(angle, rel=1e-12)
    assert versine_of(angle) == pytest.approx(1 - np.cos(angle), abs=1e-15)


def test_a_pin_carries_its_line_load():
    joint = bs.Joint(ball_radius=10.0, clearance=0.02, liner_thickness=np.inf, liner=bs.STEEL, ball=bs.STEEL)
    pin = bs.PinInHole()
    contact = pin.press(joint, line_load=np.array([100.0, 2000.0]))
    x, weight = quadrature()
    for index in (0, 1):
        edge = contact.half_angle[index]
        angle = edge * np.sin(pi / 2 * x)
        one = pin.press(joint, line_load=float(contact.line_load[index]))
        p = one.pressure(angle) * np.cos(angle) * edge * pi / 2 * np.cos(pi / 2 * x) * weight
        assert 2 * joint.socket_radius * p.sum() == pytest.approx(one.line_load, rel=1e-6)
        assert one.pressure(edge * 1.0001) == 0.0
        assert one.max_pressure == one.pressure(0.0)
    again = pin.press(joint, half_angle=contact.half_angle)
    np.testing.assert_allclose(again.line_load, contact.line_load, rtol=1e-9)


def test_validity_ends_where_stated():
    """Each range of a model holds just inside of its ends and not just outside, for quantities of the joint."""
    for name in ("hess-forsbach", "vessel", "bonded-layer", "refined", "plane-layer", "tabulated"):
        model = bs.catalogue[name]
        for limit in model.validity:
            if limit.quantity == "joint.liner.poisson":
                inside, outside = limit.high - 1e-6, limit.high + 1e-6
                contacts = [
                    model.press(replace(HIP, ball=None, liner=bs.Material(young=1000.0, poisson=nu)), force=2000.0)
                    for nu in (inside, outside)
                ]
                assert bool(limit.holds(contacts[0])), (name, limit)
                assert not bool(limit.holds(contacts[1])), (name, limit)
                assert not contacts[1].valid


@pytest.mark.parametrize("name", ["hess-forsbach", "bartel", "hertz", "liu-reconstruction", "adhesive", "refined"])
def test_largest_pressure_of_most_models_is_exactly_at_the_pole(name):
    contact = bs.catalogue[name].press(HIP, indentation=0.03)
    assert contact.max_pressure_angle == 0.0
    assert contact.max_pressure == pytest.approx(contact.pole_pressure, rel=1e-12)


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz(), bs.LiuReconstruction()], ids=lambda model: model.name)
def test_common_inversion_finds_the_indentation_of_the_closed_one(model):
    joint = HIP.with_floats()
    forces = [1e-9, 1e-3, 0.5, 30.0, 3000.0, 1e6]
    for force in forces:
        assert ClosedForm.indentation(model, joint, force) == pytest.approx(model.indentation(joint, force), rel=1e-10)
    assert ClosedForm.indentation(model, joint, 0.0) == 0.0
    together = ClosedForm.indentation(model, joint, np.array([0.0, *forces]))
    np.testing.assert_allclose(together[1:], model.indentation(joint, np.array(forces)), rtol=1e-10)
    assert together[0] == 0.0


@pytest.mark.parametrize("name", ["hess-forsbach", "bartel", "hertz", "liu-reconstruction", "adhesive"])
def test_law_of_a_closed_form_is_zero_without_contact_and_that_of_a_press_in_contact(name):
    law = bs.catalogue[name].law(HIP)
    assert law(-1e-12) == law(-2.0) == (0.0, 0.0)
    for depth in (1e-3, 0.5):
        contact = bs.catalogue[name].press(HIP, indentation=depth)
        assert law(depth) == pytest.approx((contact.force, contact.stiffness), rel=1e-12)


def test_half_space_fails_exactly_beyond_a_quarter_turn():
    radius = HIP.ball_radius * HIP.socket_radius / HIP.clearance
    for angle, status in ((1.2, bs.Status.OK), (1.570, bs.Status.OK), (1.572, bs.Status.BEYOND_EQUATOR)):
        contact = bs.Hertz().press(HIP, indentation=(angle * HIP.socket_radius) ** 2 / radius)
        assert contact.half_angle == pytest.approx(angle, rel=1e-12)
        assert contact.status is status


def test_no_indentation_has_a_half_angle_below_that_of_the_adhering_patch():
    """At d = 0 the patch of cos ε = 1 - η adheres; a smaller one belongs to a ball that is pulled."""
    model = bs.AdhesiveSocket(work_of_adhesion=1e-3)
    patch = np.arccos(1 - model.adhesion_number(HIP))
    assert model.press(HIP, indentation=0.0).half_angle == pytest.approx(patch, rel=1e-9)
    contact = model.press(HIP, half_angle=patch * np.array([0.99, 1.01]))
    np.testing.assert_array_equal(contact.status, [bs.Status.NOT_REACHED, bs.Status.OK])
    assert contact.indentation[1] > 0


@pytest.mark.parametrize("seed", range(6))
def test_monotone_slopes_are_those_of_scipy(seed):
    """Of rough data too, whose slopes at the ends are limited."""
    from scipy.interpolate import PchipInterpolator

    random = np.random.default_rng(seed)
    knots, values = np.cumsum(random.uniform(0.1, 2.0, 6)), random.normal(size=(30, 6))
    expected = PchipInterpolator(knots, values, axis=1).derivative()(knots)
    np.testing.assert_allclose(table_3._monotone_slopes(knots, values), expected, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize(("share", "holds"), [(0.98, True), (1.02, False)])
def test_nearly_incompressible_liner_limits_the_contact_width(share, holds):
    """(ν - 0.43) a/L is at most 0.04: at ν = 0.48 a contact of 0.8 liner thicknesses."""
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=0.48), liner_thickness=12.0)
    contact = bs.HessForsbach().press(joint, half_angle=np.arcsin(share * 0.8 * 12.0 / 18.0))
    assert contact.width_ratio == pytest.approx(share * 0.8, rel=1e-12)
    assert any("(ν - 0.43) a/L" in note for note in contact.notes) is not holds


def test_compressible_liner_does_not_limit_the_contact_width():
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=0.4), liner_thickness=3.0)
    contact = bs.HessForsbach().press(joint, half_angle=1.2)
    assert contact.width_ratio > 5.0
    assert not any("(ν - 0.43) a/L" in note for note in contact.notes)


def test_pressure_of_a_pin_is_even_and_ends_at_its_edge():
    joint = bs.Joint(ball_radius=10.0, clearance=0.02, liner_thickness=np.inf, liner=bs.STEEL, ball=bs.STEEL)
    contact = bs.PinInHole().press(joint, line_load=500.0)
    angle = np.linspace(0.0, 0.999, 7) * contact.half_angle
    np.testing.assert_allclose(contact.pressure(-angle), contact.pressure(angle), rtol=1e-14)
    assert np.all(np.diff(contact.pressure(angle)) < 0)
    np.testing.assert_array_equal(contact.pressure(np.array([1.001 * contact.half_angle, 2.0, np.pi, -3.0])), 0.0)


def test_text_of_a_pin_has_load_half_angle_in_degrees_and_pressure():
    joint = bs.Joint(ball_radius=10.0, clearance=0.02, liner_thickness=np.inf, liner=bs.STEEL, ball=bs.STEEL)
    contact = bs.PinInHole().press(joint, half_angle=np.radians(30.0))
    first, *lines = repr(contact).splitlines()
    assert first.startswith("pin-in-hole on R1 10 mm")
    numbers = {line.split()[0]: (float(line.split()[1]), line.split()[2]) for line in lines[:3]}
    assert numbers["line_load"] == (pytest.approx(contact.line_load), "N/mm")
    assert numbers["half_angle"] == (pytest.approx(30.0), "deg")
    assert numbers["max_pressure"] == (pytest.approx(contact.max_pressure), "MPa")


def test_blocks_of_contacts_of_a_plane_layer_do_not_change_their_results(monkeypatch):
    depths = np.array([[0.004, 0.02, 0.05], [0.001, 0.01, 0.03]])
    together = bs.PlaneLayer().press(HIP, indentation=depths)
    force, energy = together.force, together.energy
    monkeypatch.setattr("ballsocket.models.plane_layer._BLOCK", 8000)
    apart = bs.PlaneLayer().press(HIP, indentation=depths)
    np.testing.assert_allclose(apart.force, force, rtol=1e-10)
    np.testing.assert_allclose(apart.energy, energy, rtol=1e-10)
    np.testing.assert_allclose(apart.pressure(0.1), together.pressure(0.1), rtol=1e-10)
