"""Limits in which one model becomes another."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.models.plane_layer import kernel_deviation

from ..joints import HIP
from ..refusals import refused_calls

hip = HIP.replace
FOUNDATIONS = [bs.HessForsbach(), bs.Vessel(), bs.BondedLayer()]


@pytest.mark.parametrize("model", FOUNDATIONS, ids=lambda model: model.name)
def test_zero_clearance_gives_a_cosine_pressure(model):
    """c = 0: ε = 90°, F = (2π/3) K R2² d, p = p0 cos φ, and half of the work of a constant force."""
    contact = model.press(hip(clearance=0.0), force=3000.0)
    assert np.degrees(contact.half_angle) == pytest.approx(90.0)
    assert contact.force == pytest.approx(2 * np.pi / 3 * contact.foundation_modulus * 17.9**2 * contact.indentation)
    angle = np.radians([0.0, 30.0, 60.0, 89.0])
    np.testing.assert_allclose(contact.pressure(angle), contact.max_pressure * np.cos(angle), rtol=1e-12)
    assert contact.energy == pytest.approx(contact.force * contact.indentation / 2)
    assert contact.pressure_integral == pytest.approx(1.5 * contact.force)
    np.testing.assert_array_equal(model.force_vector(hip(clearance=0.0, ball_radius=18.0), np.zeros(3)), 0.0)


def test_small_clearance_approaches_the_cosine_limit():
    small = bs.HessForsbach().press(hip(clearance=1e-7), force=3000.0)
    limit = bs.CosineLimit().press(hip(clearance=1e-7), force=3000.0)
    assert limit.valid
    assert small.indentation == pytest.approx(limit.indentation, rel=1e-4)
    assert small.max_pressure == pytest.approx(limit.max_pressure, rel=1e-4)


def test_half_angle_does_not_determine_the_load_without_clearance():
    for model in (bs.HessForsbach(), bs.Bartel(), bs.LiuReconstruction(), bs.AdhesiveSocket(work_of_adhesion=0.0)):
        contact = model.press(hip(clearance=0.0), half_angle=np.array([0.0, 0.5]))
        np.testing.assert_array_equal(contact.status, [bs.Status.OK, bs.Status.NOT_REACHED])
        np.testing.assert_array_equal(contact.force, [0.0, np.nan])


def test_exact_kinematics_have_no_result_at_extreme_loads():
    contact = bs.Bartel().press(HIP, force=np.array([3000.0, 1e12]))
    np.testing.assert_array_equal(contact.status, [bs.Status.OK, bs.Status.NOT_REACHED])
    assert np.isnan(contact.indentation[1])
    assert contact.notes[0] == "1 of 2: the model does not reach this load"


def test_modulus_of_a_thin_liner_is_that_of_a_bonded_layer_and_of_a_massive_socket_finite():
    joint = hip(liner_thickness=1e-3)
    assert bs.spherical_vessel(joint) == pytest.approx(bs.bonded_layer(joint), rel=2e-4)
    joint = hip(liner_thickness=np.inf)
    assert bs.spherical_vessel(joint) == pytest.approx(2 * 1000.0 / (1.4 * 18.0))
    assert bs.hess_forsbach(joint) == pytest.approx(1.06 * 1000.0 / 18.0)


STIFF = hip(liner=bs.Material(young=1000.0, poisson=0.5))
UNBOUNDED = "no answer for ν = 0.5: the modulus is unbounded"


test_joints_without_an_answer_are_refused = refused_calls(
    (lambda: bs.BondedLayer().press(hip(liner_thickness=np.inf), force=1.0), "for L = inf: a layer of infinite"),
    (lambda: bs.PlaneLayer().press(hip(liner_thickness=np.inf), force=1.0), "use hertz"),
    (lambda: bs.Refined().press(hip(liner_thickness=np.inf), force=1.0), "refined has no answer for L = inf"),
    (lambda: bs.Refined().press(hip(clearance=0.0), force=1.0), "no answer for c = 0: .* use cosine-limit"),
    (lambda: bs.Hertz().press(hip(clearance=0.0), force=1.0), "no answer for c = 0: .* infinite without clearance"),
    (lambda: bs.PlaneLayer().press(hip(liner_thickness=0.01), force=1.0), "for R2/L = 1800: .* use bonded-layer"),
    (lambda: bs.spherical_vessel(STIFF), f"spherical-vessel has {UNBOUNDED}"),
    *(
        (lambda model=model: model.press(STIFF, force=3000.0), UNBOUNDED)
        for model in (bs.Vessel(), bs.Bartel(), bs.BondedLayer())
    ),
)


def test_an_incompressible_liner_has_an_answer_by_hess_forsbach_and_a_status_by_bartel():
    assert bs.HessForsbach().press(STIFF, force=3000.0).max_pressure > 0
    poisson = np.full(20_000, 0.4)
    poisson[777] = 0.5
    contact = bs.Bartel().press(hip(liner=bs.Material(young=1000.0, poisson=poisson)), force=3000.0)
    assert contact.status[777] == bs.Status.OUTSIDE_DOMAIN
    assert np.isnan(contact.max_pressure[777])
    assert np.sum(contact.status == bs.Status.OK) == 19_999
    assert contact.notes[0] == "1 of 20000: the model has no formula for this joint"


def test_hertz_has_the_textbook_formulas_and_is_steuermann_of_order_one():
    """F = 4/3 E* a³/R*, d = a²/R*, p0 = 3F/(2π a²)."""
    one, hertz = (model.press(HIP, force=3000.0) for model in (bs.Steuermann(exponent=1), bs.Hertz()))
    angle = np.linspace(0.0, 1.2, 30)
    np.testing.assert_allclose(one.pressure(angle), hertz.pressure(angle), rtol=1e-12)
    assert one.energy == pytest.approx(hertz.energy)
    contact = bs.Hertz().press(HIP, force=100.0)
    R = 17.9 * 18.0 / 0.1
    a = np.sqrt(R * contact.indentation)
    assert contact.force == pytest.approx(4 / 3 * HIP.effective_modulus * a**3 / R)
    assert contact.max_pressure == pytest.approx(1.5 * 100.0 / (np.pi * a**2))
    assert contact.half_angle == pytest.approx(a / 18.0)


def test_plane_layer_is_hertz_in_a_narrow_contact_and_a_row_of_columns_in_a_wide_one():
    """Wide, a >> L, and compressible: p = K_BL u, so d = a²/(2R*) and F = (π/4) K_BL a⁴/R*."""
    joint = hip(liner_thickness=3000.0, ball=None)
    layer, hertz = (model.press(joint, force=1.0) for model in (bs.PlaneLayer(), bs.Hertz()))
    for name in ("indentation", "max_pressure", "half_angle", "stiffness", "energy"):
        assert getattr(layer, name) == pytest.approx(getattr(hertz, name), rel=1e-3), name
    joint = hip(liner_thickness=0.3, liner=bs.Material(young=1000.0, poisson=0.2))
    contact = bs.PlaneLayer().press(joint, half_angle=0.4)
    a, R = 0.4 * 18.0, 17.9 * 18.0 / 0.1
    assert contact.indentation == pytest.approx(a**2 / (2 * R), rel=0.02)
    assert contact.force == pytest.approx(np.pi / 4 * bs.bonded_layer(joint) * a**4 / R, rel=0.04)
    assert contact.max_pressure == pytest.approx(bs.bonded_layer(joint) * contact.indentation, rel=0.02)


def test_layer_kernel_has_its_limits_at_long_and_short_waves():
    """Φ -> 0 at long waves and 1 at short ones; incompressible layers let no long wave through: Φ ~ x³."""
    x = np.array([1e-6, 30.0])
    np.testing.assert_allclose(1 + kernel_deviation(x, np.float64(0.3)), [0.0, 1.0], atol=1e-5)
    small = 1 + kernel_deviation(np.array([1e-2, 2e-2]), np.float64(0.5))
    assert small[1] / small[0] == pytest.approx(8.0, rel=1e-2)


def test_adhesive_socket_without_adhesion_is_hess_forsbach():
    models = bs.AdhesiveSocket(work_of_adhesion=0.0), bs.HessForsbach()
    sticky, paper = (model.press(HIP, force=3000.0) for model in models)
    for name in ("indentation", "half_angle", "max_pressure", "stiffness", "energy"):
        assert getattr(sticky, name) == pytest.approx(getattr(paper, name), rel=1e-10), name
    for clearance in (0.5, 3.0):
        sticky, paper = (model.press(HIP.replace(clearance=clearance), force=3000.0) for model in models)
        linear = ["sin²φ" in " ".join(contact.notes) for contact in (sticky, paper)]
        assert linear == [clearance == 3.0] * 2


@pytest.mark.long
def test_plane_layer_too_thin_to_compute_does_not_change_other_points():
    contact = bs.PlaneLayer().press(hip(liner_thickness=np.array([6.75, 0.01])), half_angle=0.3)
    np.testing.assert_array_equal(contact.status, [bs.Status.OK, bs.Status.OUTSIDE_DOMAIN])
    assert contact.max_pressure[0] == pytest.approx(bs.PlaneLayer().press(HIP, half_angle=0.3).max_pressure, rel=1e-9)


@pytest.mark.parametrize(("clearance", "count"), [(1e-12, 1), (0.0, 0), (0.1, 0)])
def test_a_half_angle_of_two_indentations_has_a_note(clearance, count):
    joint = bs.Joint(ball_radius=70.0, clearance=clearance, liner_thickness=10.0, liner=bs.UHMWPE)
    contact = bs.Bartel().press(joint, force=1000.0)
    assert sum("two indentations" in note for note in contact.notes) == count
