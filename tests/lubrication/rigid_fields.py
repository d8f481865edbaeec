"""Pressure of a rigid ball that moves in a full rigid spherical cavity, in closed form.

The film is h = c - e cos θ, where θ is measured from the direction of the eccentricity e. Reynolds' equation on the
sphere then has the solutions below [derived; `docs/explanation/film.md`].
"""

import numpy


def squeeze_pressure(theta, *, radius, clearance, eccentricity, speed, viscosity, rim):
    """Compute the pressure in MPa of a ball that approaches the pole at `speed` (mm/s); zero at the rim.

    p = 3 η R² (ė/e) (1/h² - 1/h_rim²); angles in rad, lengths in mm, viscosity in MPa s. It also holds for e = 0.
    """
    film = clearance - eccentricity * numpy.cos(theta)
    rim_film = clearance - eccentricity * numpy.cos(rim)
    # (1/h² - 1/h_rim²)/e without division by e
    fall = (numpy.cos(theta) - numpy.cos(rim)) * (film + rim_film) / (film * rim_film) ** 2
    return 3 * viscosity * radius**2 * speed * fall


def wedge_pressure(theta, phi, *, radius, clearance, eccentricity, spin, viscosity):
    """Compute the pressure in MPa of a ball that turns about y at `spin` (rad/s), across its eccentricity along z.

    p = -6 η ω R² e sin θ cos φ (2c - e cos θ) / [(4c² + e²)(c - e cos θ)²]; no cavitation.
    """
    reach = eccentricity * numpy.cos(theta)
    share = eccentricity * numpy.sin(theta) * numpy.cos(phi) * (2 * clearance - reach)
    return -6 * viscosity * spin * radius**2 * share / ((4 * clearance**2 + eccentricity**2) * (clearance - reach) ** 2)
