"""Rise of the pressure at the edge of a contact: linear on springs, as a square root in elastic bodies."""

from math import cos, sqrt

import numpy as np
import pytest

import ballsocket as bs

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))


def test_slope_on_springs_is_that_of_linear_kinematics():
    contact = bs.HessForsbach().press(JOINT, force=np.array([10.0, 1500.0, 1e5]))
    d, c = contact.indentation, JOINT.clearance
    expected = contact.foundation_modulus * np.sqrt(d * (2 * c + d)) / JOINT.socket_radius
    assert contact.edge_slope == pytest.approx(expected, rel=1e-8)
    assert np.isnan(contact.edge_coefficient).all()


def test_coefficient_of_a_hertzian_contact_is_that_of_its_half_ellipsoid():
    contact = bs.Hertz().press(JOINT, force=1.0)
    radius = contact.half_angle * JOINT.socket_radius
    assert contact.edge_coefficient == pytest.approx(contact.max_pressure * sqrt(2 / radius), rel=1e-8)
    assert np.isnan(contact.edge_slope)


@pytest.mark.parametrize("model", [bs.Exact(), bs.Tabulated()], ids=lambda model: model.name)
def test_coefficient_of_the_exact_solution(model):
    assert model.press(JOINT, force=1500.0).edge_coefficient == pytest.approx(2.046, abs=5e-4)


def test_closed_models_come_close_to_the_exact_coefficient():
    """Measured: refined 4.2 %, plane layer 14.5 %."""
    exact = bs.Exact().press(JOINT, force=1500.0).edge_coefficient
    for model, error in ((bs.Refined(), 0.05), (bs.PlaneLayer(), 0.15)):
        assert model.press(JOINT, force=1500.0).edge_coefficient == pytest.approx(exact, rel=error)


def test_a_ball_without_load_has_no_edge():
    assert np.isnan(bs.HessForsbach().press(JOINT, force=0.0).edge_slope)


def test_a_full_socket_has_a_slope_at_its_rim():
    """Cosine kinematics: p = K d cos φ has the slope K d/R2 at 90 degrees."""
    contact = bs.CosineLimit().press(JOINT, force=1500.0)
    assert contact.edge_slope == pytest.approx(contact.pole_pressure / JOINT.socket_radius, rel=1e-6)
    assert cos(contact.half_angle) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_mean_coefficient_off_the_axis_is_that_of_the_round_contact(tilt):
    """The cells of 2 degrees resolve the root to 2 %."""
    contact = bs.Sphere(surface=bs.ClosedShell()).press(JOINT, force=1500.0, tilt=tilt)
    assert contact.edge_coefficient == pytest.approx(2.046, rel=0.02)
    assert np.isnan(contact.edge_slope)


def test_mean_slope_of_springs_off_the_axis():
    contact = bs.Sphere(surface=bs.Springs()).press(JOINT, force=np.array([1500.0, 1600.0]), tilt=0.4)
    expected = bs.HessForsbach().press(JOINT, force=np.array([1500.0, 1600.0])).edge_slope
    assert contact.edge_slope == pytest.approx(expected, rel=0.005)
