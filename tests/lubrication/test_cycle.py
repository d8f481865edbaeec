"""Film over a cycle of load and motion, on springs under an axial load."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.lubrication.cycle_film import CycleInstant, LoadStep, carry_over_cycle, solve_cycle
from ballsocket.lubrication.inlet import SpringEdge
from ballsocket.lubrication.mesh import graded_rings, polar_mesh, thinned_meridians
from ballsocket.lubrication.reynolds import FilmProblem, FilmState

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
MODULUS, VISCOSITY = 276.67, 2.5e-9
CONTACT = bs.RadialFoundation(modulus=bs.constant(MODULUS)).press(JOINT, force=1500.0)
EDGES = np.arange(0.0, radians(60.0), radians(2.0))
MESH = polar_mesh(18.0, EDGES, thinned_meridians(EDGES, 120))


def swing(amplitude, count=40):
    """Instants of a swing of the ball by an amplitude in rad, once a second, at a constant load."""
    phase = (np.arange(count) + 0.5) / count
    rate = 2 * pi * amplitude * np.cos(2 * pi * phase)
    height = MESH.direction[:, 2]
    pressure = MODULUS * np.maximum((0.1 + CONTACT.indentation) * height - 0.1, 0.0)
    edge = SpringEdge(slope=CONTACT.edge_slope, modulus=MODULUS)
    return [
        CycleInstant(
            pressure=pressure, axis=np.array([0.0, 0.0, 1.0]), edge=edge, spin=np.array([w, 0, 0]), duration=1 / count
        )
        for w in rate
    ]


def test_a_long_swing_repeats_and_its_two_strokes_are_alike():
    film = carry_over_cycle(MESH, VISCOSITY, swing(1.5))
    assert film.converged
    assert film.unreached < 0.02
    half = len(film.central) // 2
    assert film.central[half:] == pytest.approx(film.central[:half], rel=0.04)
    assert film.minimum[half:] == pytest.approx(film.minimum[:half], rel=0.04)


def test_a_short_swing_does_not_refresh_the_middle_which_is_squeezed():
    """As at rest, 1/h² grows with time: 26 nm after 100 s."""
    film = carry_over_cycle(MESH, VISCOSITY, swing(0.1))
    assert film.unreached > 0.3
    assert 98 <= film.cycles <= 109
    assert 1e6 * film.central.mean() == pytest.approx(26.0, rel=0.05)


def test_a_ball_that_does_not_move_has_no_film():
    film = carry_over_cycle(MESH, VISCOSITY, swing(0.0))
    assert film.central == pytest.approx(0.0)


@pytest.mark.long
def test_reynolds_equation_confirms_the_carried_film():
    """The third cycle from a flooded bore. The front of fresh lubricant arrives up to two instants earlier."""
    rings = graded_rings(CONTACT.half_angle, finest=radians(0.15), coarsest=radians(2.0))
    mesh = polar_mesh(18.0, rings, 32)
    cells = mesh.cells
    start = FilmState(
        pressure=MODULUS * np.maximum((0.1 + CONTACT.indentation) * mesh.direction[:, 2] - 0.1, 0.0),
        void=np.zeros(cells),
        eccentricity=np.array([0.0, 0.0, 0.1 + CONTACT.indentation - 5e-4]),
    )
    problem = FilmProblem(
        mesh=mesh,
        viscosity=VISCOSITY,
        spin=np.zeros(3),
        gap=np.full(cells, 0.1),
        compliance=np.full(cells, 1 / MODULUS),
        rim_pressure=np.zeros(32),
        force=np.array([0.0, 0.0, 1500.0]),
    )
    instants = swing(1.5)
    steps = [LoadStep(force=problem.force, spin=each.spin, duration=each.duration) for each in instants]
    states, _ = solve_cycle(problem, start, steps, cycles=3)
    judge = np.array([problem.thickness(state)[:32].mean() for state in states])
    wave = carry_over_cycle(MESH, VISCOSITY, instants)
    assert wave.central.max() == pytest.approx(judge.max(), rel=0.07)
    assert np.abs(wave.central / judge - 1).mean() < 0.08
