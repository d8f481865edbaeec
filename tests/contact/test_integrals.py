"""Integrals and vectors of a contact: friction torque, force vector, pressure in directions, area and ratios."""

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

CONTACT = bs.HessForsbach().press(HIP, force=3000.0)
MODELS = pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Bartel(), bs.Exact()], ids=lambda model: model.name)


def sphere_integral(contact, function, planar=False):
    """Integrate pressure times a function of angle and azimuth over the contact by a fine midpoint rule."""
    count, turns = 2000, 720
    s = (np.arange(count) + 0.5) / count
    angle = contact.half_angle * np.sin(pi / 2 * s)
    width = contact.half_angle * pi / 2 * np.cos(pi / 2 * s) / count
    azimuth = 2 * pi * (np.arange(turns) + 0.5) / turns
    mean = function(angle[:, None], azimuth).mean(axis=1)
    arc = angle if planar else np.sin(angle)
    return 2 * pi * contact.joint.socket_radius**2 * np.sum(contact.pressure(angle) * arc * width * mean)


@MODELS
def test_vertical_component_of_the_pressure_is_the_force(model):
    contact = model.press(HIP, force=3000.0)
    total = sphere_integral(contact, lambda angle, azimuth: np.cos(angle) + 0.0 * azimuth)
    assert total == pytest.approx(3000.0, rel=1e-4)
    assert sphere_integral(contact, lambda angle, azimuth: 1.0 + 0.0 * angle * azimuth) == pytest.approx(
        contact.pressure_integral, rel=1e-4
    )


@pytest.mark.parametrize("axis", [0.0, 0.4, 1.1, pi / 2, 2.5])
def test_friction_torque_is_the_integral_of_pressure_times_lever(axis):
    def lever(angle, azimuth):
        cosine = np.cos(angle) * cos(axis) + np.sin(angle) * np.cos(azimuth) * sin(axis)
        return np.sqrt(1 - cosine**2)

    expected = 0.1 * HIP.ball_radius * sphere_integral(CONTACT, lever)
    assert CONTACT.friction_torque(0.1, axis) == pytest.approx(expected, rel=1e-4)


def test_spin_torque_of_hertz_is_three_sixteenths_pi():
    """τ = 3π/16 μ F a for spin about the axis of a flat circle of radius a, here on the radius of the ball."""
    joint = replace(HIP, clearance=2.0)
    contact = bs.Hertz().press(joint, force=10.0)
    radius = joint.ball_radius * contact.half_angle
    assert contact.friction_torque(0.2, 0.0) == pytest.approx(3 * pi / 16 * 0.2 * 10.0 * radius, rel=2e-3)


def test_friction_torque_has_the_shape_of_contact_and_coefficient():
    contact = bs.HessForsbach().press(HIP, force=np.array([1000.0, 3000.0]))
    torque = contact.friction_torque(0.1)
    assert torque.shape == (2,)
    assert torque[1] == pytest.approx(CONTACT.friction_torque(0.1), rel=1e-12)
    assert type(CONTACT.friction_torque(0.1)) is float
    assert CONTACT.friction_torque(0.0) == 0.0
    with pytest.raises(ValueError, match="axis_angle = 90 is not allowed: it is in radians; 90 degrees are 1.571"):
        CONTACT.friction_torque(0.1, 90.0)
    for angle in (-6.3, 6.3):
        with pytest.raises(ValueError, match="axis_angle = -?6.3 is not allowed"):
            CONTACT.friction_torque(0.1, angle)
    for coefficient in (-0.1, np.inf, np.nan):
        with pytest.raises(ValueError, match="a coefficient of friction is 0 or more and finite"):
            CONTACT.friction_torque(coefficient)


def test_friction_torque_is_the_same_after_half_and_full_turns_of_the_axis():
    torque = CONTACT.friction_torque(0.1, 0.7)
    for angle in (-0.7, pi - 0.7, pi + 0.7, 2 * pi - 0.7, 0.7 - 2 * pi):
        assert CONTACT.friction_torque(0.1, angle) == pytest.approx(torque, rel=1e-12)
    assert CONTACT.friction_torque(0.1, 2 * pi) == pytest.approx(CONTACT.friction_torque(0.1, 0.0), rel=1e-12)


def test_force_vector_is_zero_within_the_clearance():
    displacement = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0999], [0.05, 0.0, 0.05], [0.0, 0.1001, 0.0]])
    force = bs.HessForsbach().force_vector(HIP, displacement)
    np.testing.assert_array_equal(force[:3], 0.0)
    assert force[3, 1] < 0.0
    fitted = replace(HIP, clearance=0.0)
    np.testing.assert_array_equal(bs.HessForsbach().force_vector(fitted, np.zeros(3)), 0.0)


def test_pressure_in_directions_is_that_of_their_angle():
    angle = np.array([0.0, 0.2, 0.5, 1.2])
    direction = np.stack([np.sin(angle) * 0.6, np.sin(angle) * 0.8, np.cos(angle)], axis=-1)
    np.testing.assert_allclose(CONTACT.pressure_at(direction), CONTACT.pressure(angle), rtol=1e-12)
    assert CONTACT.pressure_at(direction)[3] == 0.0
    for wrong in (2.0 * direction, 1.001 * direction, 0.999 * direction):
        with pytest.raises(ValueError, match="a direction is a unit vector"):
            CONTACT.pressure_at(wrong)
    CONTACT.pressure_at((1 + 1e-7) * direction)


def test_pressure_of_angles_in_degrees_is_rejected():
    with pytest.raises(ValueError, match="angle = 45 is not allowed: .* 45 degrees are 0.7854 radians"):
        CONTACT.pressure(45.0)
    assert CONTACT.pressure(-0.3) == CONTACT.pressure(0.3)
    assert type(CONTACT.pressure(0.3)) is float


def test_area_is_at_most_that_of_the_ball():
    deep = bs.Hertz().press(HIP, indentation=0.1 * 18.0 * 4.0**2 / 17.9)
    assert deep.half_angle == pytest.approx(4.0, rel=1e-12)
    assert deep.area == pytest.approx(4 * pi * 17.9**2, rel=1e-12)
