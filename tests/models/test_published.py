"""Numbers that others printed, or that follow by hand."""

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

TABLE_3 = {0.30: (1.14, 0.97, 0.04), 0.35: (1.10, 1.07, 0.06), 0.40: (1.06, 1.23, 0.09)}
TABLE_3 |= {0.45: (0.99, 1.51, 0.16), 0.49: (0.96, 1.79, 0.33)}


@pytest.mark.parametrize(("poisson", "constants"), TABLE_3.items(), ids=map(str, TABLE_3))
def test_modulus_follows_table_3(poisson, constants):
    liner = bs.Material(young=800.0, poisson=poisson)
    joint = bs.Joint(ball_radius=19.9, clearance=0.1, liner_thickness=5.0, liner=liner)
    expected = sum(constant * 4.0**power for power, constant in enumerate(constants)) * 800.0 / 20.0
    assert bs.hess_forsbach(joint) == pytest.approx(expected, rel=1e-13)


def test_outside_table_3_the_last_column_is_used_and_noted():
    for poisson, inside in ((0.25, 0.30), (0.5, 0.49)):
        outer, inner = (HIP.replace(liner=bs.Material(young=1e3, poisson=nu)) for nu in (poisson, inside))
        assert bs.hess_forsbach(outer) == pytest.approx(bs.hess_forsbach(inner))
        contact = bs.HessForsbach().press(outer, force=3000.0)
        assert contact.valid == (poisson < 0.3), "measured down to 0.15"
        assert any("outside ν 0.15 to 0.47" in note for note in contact.notes) == (poisson > 0.47)


def test_bartel_has_the_reference_values_at_3000_newton_and_the_published_overestimates():
    """Heß & Forsbach 2021, Fig. 4, ν 0.45: pmax of Bartel and of the bonded layer is far above the paper's model."""
    contact = bs.Bartel().press(HIP, force=3000.0)
    assert contact.indentation == pytest.approx(0.03872, abs=5e-6)
    assert contact.max_pressure == pytest.approx(11.7168, abs=5e-5)
    assert np.degrees(contact.half_angle) == pytest.approx(43.718, abs=5e-4)
    joint = HIP.replace(liner=bs.Material(young=1e3, poisson=0.45))
    models = bs.HessForsbach(), bs.Bartel(), bs.BondedLayer()
    paper, bartel, bonded = (model.press(joint, force=3000.0).max_pressure for model in models)
    assert bartel > 1.08 * paper
    assert bonded > 1.15 * paper


@pytest.mark.parametrize(("poisson", "indentation", "pressure"), [(0.40, 0.0333, 8.49), (0.45, 0.0293, 9.23)])
def test_plane_layer_has_the_reference_values(poisson, indentation, pressure):
    joint = HIP.replace(liner=bs.Material(young=1000.0, poisson=poisson), ball=None)
    contact = bs.PlaneLayer().press(joint, force=3000.0)
    assert contact.indentation == pytest.approx(indentation, abs=5e-5)
    assert contact.max_pressure == pytest.approx(pressure, abs=6e-3)


@pytest.mark.parametrize(("eta", "share"), [(0.05, 0.00242253), (0.2, 0.0359431), (0.5, 0.2062995), (0.9, 0.6963411)])
def test_pull_off_force_has_the_reference_values(eta, share):
    K = bs.hess_forsbach(HIP)
    socket = bs.AdhesiveSocket(work_of_adhesion=K * (eta * HIP.clearance) ** 2 / 2)
    assert socket.adhesion_number(HIP) == pytest.approx(eta)
    assert socket.pull_off(HIP) == pytest.approx(np.pi * 18.0**2 * K * HIP.clearance * share, rel=2.5e-6)


def test_weak_adhesion_has_the_pull_off_force_of_a_sphere_and_a_strong_one_sticks_a_hemisphere():
    w = 1e-9
    expected = 2 * np.pi * w * 18.0**2 / 0.1
    assert bs.AdhesiveSocket(work_of_adhesion=w).pull_off(HIP) == pytest.approx(expected, rel=1e-3)
    K = bs.hess_forsbach(HIP)
    socket = bs.AdhesiveSocket(work_of_adhesion=K * (1.2 * HIP.clearance) ** 2 / 2)
    contact = socket.press(HIP, force=10.0)
    assert np.degrees(contact.half_angle) == pytest.approx(90.0)
    assert np.isnan(socket.pull_off(HIP))
    assert not contact.valid


ALUMINIUM = bs.Material(young=70_000.0, poisson=0.3)
PLATE = bs.Joint(ball_radius=10.0, clearance=0.1, liner_thickness=np.inf, liner=ALUMINIUM, ball=ALUMINIUM)


@pytest.mark.parametrize(
    ("degrees", "flexibility", "pressure"),
    [(10, 82.2206, 3.6616), (40, 3.90504, 0.97388), (60, 1.06720, 0.71172), (80, 0.12615, 0.61161)],
)
def test_pin_in_hole_has_the_values_of_persson(degrees, flexibility, pressure):
    contact = bs.PinInHole().press(PLATE, half_angle=np.radians(degrees))
    stiffness = 70_000.0 / (1 - 0.09)
    assert stiffness * 0.1 / contact.line_load == pytest.approx(flexibility, rel=5e-5)
    assert contact.max_pressure * 10.1 / contact.line_load == pytest.approx(pressure, rel=2e-5)
    assert contact.valid
    back = bs.PinInHole().press(PLATE, line_load=contact.line_load)
    assert np.degrees(back.half_angle) == pytest.approx(degrees, rel=1e-12)


def test_pin_in_hole_has_the_perfect_fit_angle_balances_its_load_and_begins_as_a_hertz_cylinder():
    """b² = 4 Q R*/(π E*) with E* = E1/2 for equal materials, p0 = 2Q/(π b)."""
    fit = bs.Joint(ball_radius=10.0, clearance=0.0, liner_thickness=np.inf, liner=ALUMINIUM, ball=ALUMINIUM)
    contact = bs.PinInHole().press(fit, line_load=np.array([1.0, 1000.0]))
    np.testing.assert_allclose(np.degrees(contact.half_angle), 84.83, atol=5e-3)
    loose = bs.PinInHole().press(PLATE, line_load=2000.0)
    angle = np.linspace(-loose.half_angle, loose.half_angle, 400_001)
    total = np.trapezoid(loose.pressure(angle) * np.cos(angle), angle) * 10.1
    assert total == pytest.approx(2000.0, rel=1e-6)
    contact = bs.PinInHole().press(PLATE, line_load=1e-3)
    half_width = np.sqrt(8 * 1e-3 * (10.1**2 / 0.1) / (np.pi * 70_000.0 / (1 - 0.09)))
    assert contact.max_pressure == pytest.approx(2e-3 / (np.pi * half_width), rel=1e-4)


def test_pin_in_hole_has_statuses_and_notes_like_a_ball():
    """The first point has no clearance: all loads have one half angle."""
    joint = bs.Joint(ball_radius=10.0, clearance=np.array([0.0, 0.1]), liner_thickness=np.inf, liner=ALUMINIUM)
    contact = bs.PinInHole().press(joint, half_angle=0.5)
    assert [bs.Status(code).name for code in contact.status] == ["NOT_REACHED", "OK"]
    assert contact.notes[0] == "1 of 2: the model does not reach this load"
    assert "pin and plate of one material" in contact.notes[1]
    assert contact.valid.tolist() == [False, False]
    assert np.isnan(contact.pressure(0.0)).tolist() == [True, False]
