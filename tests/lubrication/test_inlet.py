"""Film at the inlet edge: the coefficient of elastic contacts, and the closed forms."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.lubrication.inlet import INLET_COEFFICIENT, ElasticEdge, SpringEdge

from ..extent import either
from .inlet_problem import inlet_coefficient, solve_inlet

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))


def test_coefficient_is_that_of_the_inlet_problem():
    """The error falls with the square of the spacing: 8e-5, 2e-5, 4e-6."""
    spacing, error = either(quick=(0.05, 1e-4), long=(0.0125, 1e-5))
    eigenvalue, change = solve_inlet(spacing)
    assert change < 1e-9
    assert inlet_coefficient(eigenvalue) == pytest.approx(INLET_COEFFICIENT, rel=error)


def test_elastic_film_of_the_exact_solution():
    """Independent values of the streamline across the contact in nm."""
    contact = bs.Exact().press(JOINT, force=1500.0)
    for rate, expected in ((1.5, 173.8), (10.0, 542.0)):
        film = bs.film(contact, spin=(rate, 0.0, 0.0), method="inlet")
        assert 1e6 * film.central == pytest.approx(expected, rel=2e-3)


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


def test_films_of_hertzian_contacts_are_similar():
    """h/(R sqrt(U)) depends on the Moes number alone, as M^(-2/15)."""
    joint = bs.Joint(ball_radius=10.0, clearance=9.0, liner_thickness=np.inf, liner=bs.Material(young=1e3, poisson=0.4))
    radius, modulus, viscosity = 190 / 9, 2 * float(joint.effective_modulus), 1e-8
    films = []
    for speed_number, moes in ((1e-9, 1e3), (1e-13, 1e3), (1e-17, 1e3), (1e-13, 1e4)):
        contact = bs.Hertz().press(joint, force=moes * speed_number**0.75 * modulus * radius**2)
        speed = speed_number * modulus * radius / viscosity
        film = bs.film(contact, spin=(2 * speed / 19, 0, 0), lubricant=bs.Lubricant(viscosity=1e6 * viscosity))
        films.append(film.central / radius / np.sqrt(speed_number))
    assert films[1] == pytest.approx(films[0], rel=1e-3)
    assert films[2] == pytest.approx(films[0], rel=1e-3)
    assert films[3] / films[1] == pytest.approx(10 ** (-2 / 15), rel=0.04)
