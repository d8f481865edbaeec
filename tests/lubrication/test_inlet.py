"""Film at the inlet edge: the coefficient of elastic contacts, and the closed forms."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.lubrication.inlet import INLET_COEFFICIENT, OUTLET_RATIO, ElasticEdge, SpringEdge

from ..extent import either
from .inlet_problem import inlet_coefficient, solve_inlet
from .line_contact import contact_films
from .test_film import CONTACT, ELASTIC


def test_coefficient_is_that_of_the_inlet_problem():
    """The error falls with the square of the spacing: 8e-5, 2e-5, 4e-6."""
    spacing, error = either(quick=(0.05, 1e-4), long=(0.0125, 1e-5))
    eigenvalue, change = solve_inlet(spacing)
    assert change < 1e-9
    assert inlet_coefficient(eigenvalue) == pytest.approx(INLET_COEFFICIENT, rel=error)


def test_outlet_is_the_limit_of_line_contacts():
    """Centre and constriction of a whole contact of two edges tend to inlet and outlet of a half-space."""
    least, error = either(quick=(1e-2, 0.04), long=(1e-5, 3e-3))
    rows = contact_films(least)
    assert rows[-1, 1] == pytest.approx(INLET_COEFFICIENT, rel=error)
    assert rows[-1, 2] == pytest.approx(OUTLET_RATIO, rel=error / 2)
    assert (np.diff(np.abs(rows[:, 1:] - (INLET_COEFFICIENT, OUTLET_RATIO)), axis=0) < 0).all()


def test_elastic_film_of_the_exact_solution():
    """Independent values of the streamline across the contact in nm."""
    for rate, expected in ((1.5, 173.8), (10.0, 542.0)):
        film = bs.film(ELASTIC, spin=(rate, 0.0, 0.0), method="inlet")
        assert 1e6 * film.central == pytest.approx(expected, rel=2e-3)


def test_lubricant_enters_on_the_circles_of_the_motion():
    """On springs h ~ sqrt(U); a circle at the distance x from the load enters at U = ω R sqrt(1 - (x/sin ε)²)."""
    film = bs.film(CONTACT, spin=(10.0, 0.0, 0.0), method="inlet", cell_width=np.radians(4.0))
    offset = film.directions[film.dry.inside, 0] / np.sin(CONTACT.half_angle)
    assert film.thickness[film.dry.inside] == pytest.approx(film.central * (1 - offset**2) ** 0.25, rel=1e-9)


def test_spring_film_has_the_largest_flow_that_the_edge_lets_through():
    edge, viscosity, speed = SpringEdge(slope=1.2, modulus=277.0), 2.5e-9, 27.0
    film = np.linspace(0.0, 1e-3, 100_001)
    flow = speed / 2 * film - film**3 * edge.slope / (12 * viscosity)
    assert speed / 2 * edge.inlet_film(viscosity, speed) == pytest.approx(flow.max(), rel=1e-6)


@pytest.mark.parametrize("edge", [SpringEdge(slope=1.2, modulus=277.0), ElasticEdge(coefficient=2.0, modulus=1190.0)])
def test_films_and_errors_vanish_with_the_speed(edge):
    speed = np.array([0.0, 1e-6, 1.0])
    assert (np.diff(edge.inlet_film(2.5e-9, speed)) > 0).all()
    assert edge.inlet_film(2.5e-9, -speed) == pytest.approx(0.0)
    assert edge.wave_error(2.5e-9, 0.0, 10.0) == 0.0


def point_contact_film(viscosity, speed, force, radius, modulus):
    """Central film in mm of a round isoviscous point contact by the fit of Nijenbanning, Venner and Moes.

    `speed` is the sum of those of both surfaces. Source: Wear 176 (1994) 217, doi:10.1016/0043-1648(94)90150-3. Formula
    and definitions were read in a later program, not in the paper, and the DOI was not followed (unverified).
    """
    speed_number = viscosity * speed / (2 * modulus * radius)  # U of E' = 2 E*
    moes = force / (2 * modulus * radius**2) * speed_number**-0.75
    rigid = 145 * (1 + 0.796) ** (-15 / 7) * moes**-2  # H_RI of a round contact
    elastic = 3.18 * (1 + 0.63) ** -0.56 * moes ** (-2 / 15)  # H_EI
    height = (rigid**1.5 + (elastic**-4 + 1.8**-4) ** -0.375) ** (2 / 3)  # H_00 = 1.8
    return float(radius * height * speed_number**0.5)


def hertzian_film(speed_number, moes):
    """Film of the wave over R sqrt(U), and that of the fit for point contacts."""
    joint = bs.Joint(ball_radius=10.0, clearance=9.0, liner_thickness=np.inf, liner=bs.Material(young=1e3, poisson=0.4))
    radius, modulus, viscosity = 190 / 9, float(joint.effective_modulus), 1e-8
    load = moes * speed_number**0.75 * 2 * modulus * radius**2
    contact = bs.Hertz().press(joint, force=load)
    speed = speed_number * 2 * modulus * radius / viscosity  # mean of both surfaces
    film = bs.film(contact, spin=(2 * speed / 19, 0, 0), lubricant=bs.Lubricant(viscosity=1e6 * viscosity))
    fit = point_contact_film(viscosity, 2 * speed, load, radius, modulus)
    return film.central / radius / np.sqrt(speed_number), fit / radius / np.sqrt(speed_number)


def test_films_of_hertzian_contacts_are_similar():
    """h/(R sqrt(U)) depends on the Moes number alone, as M^(-2/15)."""
    films = [hertzian_film(*numbers)[0] for numbers in ((1e-9, 1e3), (1e-13, 1e3), (1e-17, 1e3), (1e-13, 1e4))]
    assert films[1:3] == pytest.approx([films[0]] * 2, rel=1e-3)
    assert films[3] / films[1] == pytest.approx(10 ** (-2 / 15), rel=0.04)


@pytest.mark.parametrize("moes", [1e3, 1e4])
def test_films_of_point_contacts_agree_with_the_published_fit(moes):
    """An independent numerical study, fitted by its authors; both have the same power of the Moes number."""
    wave, fit = hertzian_film(1e-13, moes)
    assert wave == pytest.approx(fit, rel=0.05)
