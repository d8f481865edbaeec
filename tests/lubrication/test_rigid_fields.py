"""Closed pressures in a rigid spherical cavity satisfy Reynolds' equation."""

import numpy as np
import pytest

from .rigid_fields import squeeze_pressure, wedge_pressure

RADIUS, CLEARANCE, ECCENTRICITY, VISCOSITY, RATE = 18.0, 0.1, 0.08, 2.5e-9, 10.0
STEP = 1e-3
"""Step of the central differences in rad; they are of second order."""


def film(theta):
    """Film thickness in mm."""
    return CLEARANCE - ECCENTRICITY * np.cos(theta)


def poiseuille_divergence(pressure, theta, phi):
    """Divergence of h³/(12 η) grad p on the sphere in mm/s, by central differences."""

    def along_meridian(t):
        slope = (pressure(t + STEP, phi) - pressure(t - STEP, phi)) / (2 * STEP)
        return np.sin(t) * film(t) ** 3 * slope

    meridional = (along_meridian(theta + STEP) - along_meridian(theta - STEP)) / (2 * STEP) / np.sin(theta)
    around = (pressure(theta, phi + STEP) - 2 * pressure(theta, phi) + pressure(theta, phi - STEP)) / STEP**2
    return (meridional + film(theta) ** 3 * around / np.sin(theta) ** 2) / (12 * VISCOSITY * RADIUS**2)


def test_squeeze_balances_the_volume_of_the_film():
    theta = np.linspace(0.2, 1.4, 7)

    def pressure(t, _):
        return squeeze_pressure(
            t, radius=RADIUS, clearance=CLEARANCE, eccentricity=ECCENTRICITY, speed=RATE, viscosity=VISCOSITY, rim=1.5
        )

    expected = -RATE * np.cos(theta)  # growth rate of the film
    assert poiseuille_divergence(pressure, theta, 0.0) == pytest.approx(expected, rel=1e-4)


def test_a_centred_ball_is_squeezed_as_well():
    words = {"radius": RADIUS, "clearance": CLEARANCE, "speed": RATE, "viscosity": VISCOSITY, "rim": np.pi / 2}
    near = squeeze_pressure(0.3, eccentricity=1e-7, **words)
    assert squeeze_pressure(0.3, eccentricity=0.0, **words) == pytest.approx(near, rel=1e-5)


def test_wedge_balances_the_flow_that_the_ball_drags():
    theta, phi = np.meshgrid(np.linspace(0.2, 1.4, 5), np.linspace(0.1, 6.0, 5))

    def pressure(t, p):
        return wedge_pressure(
            t, p, radius=RADIUS, clearance=CLEARANCE, eccentricity=ECCENTRICITY, spin=RATE, viscosity=VISCOSITY
        )

    # ½ U · grad h with U = R ω × n about y: its part along the meridian is R ω cos φ
    expected = 0.5 * RATE * np.cos(phi) * ECCENTRICITY * np.sin(theta)
    assert poiseuille_divergence(pressure, theta, phi) == pytest.approx(expected, rel=1e-3, abs=1e-6)
