"""Film over a cycle of load and motion, on springs under an axial load."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.core.validity import Status
from ballsocket.lubrication.cycle_film import CycleInstant, carry_over_cycle
from ballsocket.lubrication.inlet import SpringEdge
from ballsocket.lubrication.mesh import graded_rings, polar_mesh, thinned_meridians
from ballsocket.lubrication.reynolds import FilmProblem, FilmState, solve_steady
from ballsocket.lubrication.transient import LoadStep, film_over_steps, solve_cycle

from ..extent import some
from .test_film import CONTACT, JOINT, LINER, SPRINGS

MODULUS, VISCOSITY = 276.67, 2.5e-9
AXIS = np.array([0.0, 0.0, 1.0])
EDGES = np.arange(0.0, radians(60.0), radians(2.0))
MESH = polar_mesh(18.0, EDGES, thinned_meridians(EDGES, 120))


def cycle_instants(mesh, contact, spins, duration, axis=AXIS, modulus=MODULUS):
    """Instants (s) of a contact on springs under a constant load along an axis."""
    clearance = contact.joint.clearance
    pressure = modulus * np.maximum((clearance + contact.indentation) * (mesh.direction @ axis) - clearance, 0.0)
    edge = SpringEdge(slope=contact.edge_slope, modulus=modulus)
    still = CycleInstant(pressure=pressure, axis=axis, edge=edge, spin=np.zeros(3), duration=duration)
    return [replace(still, spin=spin) for spin in spins]


def swing(amplitude, count=40):
    """Instants of a swing of the ball by an amplitude in rad, once a second, at a constant load."""
    rate = 2 * pi * amplitude * np.cos(2 * pi * (np.arange(count) + 0.5) / count)
    return cycle_instants(MESH, CONTACT, np.outer(rate, (1.0, 0.0, 0.0)), 1 / count)


def rocking_motion(amplitude, tilt, count):
    """Rotations (count, 3) of a ball that rocks on a circle, and a load at an angle in degrees from its axis."""
    phase = 2 * pi * np.arange(count + 1) / count
    ball = Rotation.from_rotvec(amplitude * np.stack([np.cos(phase), np.sin(phase), 0 * phase], axis=1))
    load = np.array([np.sin(radians(tilt)), 0.0, np.cos(radians(tilt))])
    return (ball[1:] * ball[:-1].inv()).as_rotvec(), load


def rocking(joint, modulus, force, amplitude, tilt, count):
    """Cells of the bore, and instants of a ball that rocks once a second under a constant load."""
    spins, load = rocking_motion(amplitude, tilt, count)
    contact = bs.RadialFoundation(modulus=bs.constant(modulus)).press(joint, force=force)
    rings = np.arange(0.0, radians(86.0), radians(3.0))
    mesh = polar_mesh(joint.socket_radius, rings, thinned_meridians(rings, 120))
    return mesh, cycle_instants(mesh, contact, spins * count, 1 / count, load, modulus)


def reynolds_on_springs(mesh, pressure, eccentricity, force, modulus=MODULUS, ambient=0.0, clearance=0.1):
    """Reynolds' equation of a ball at rest on springs, and its start."""
    gap, compliance = np.full(mesh.cells, clearance - ambient / modulus), np.full(mesh.cells, 1 / modulus)
    outside = {"rim_pressure": np.full(len(mesh.rim_cell), ambient), "spin": np.zeros(3), "force": force}
    problem = FilmProblem(mesh=mesh, viscosity=VISCOSITY, gap=gap, compliance=compliance, **outside)
    return problem, FilmState(pressure=pressure, void=np.zeros(mesh.cells), eccentricity=eccentricity)


def solve_in_frame_of_the_film(joint, modulus, force, amplitude, tilt, count, cycles, viscosity, ambient=0.1):
    """Film at the load in mm at the end of each cycle, by Reynolds' equation.

    On uniform springs the surfaces rest in the frame that turns with the film, by half of the ball's rotation.
    """
    spins, load = rocking_motion(amplitude, tilt, count)
    clearance, radius = joint.clearance, joint.socket_radius
    mesh = polar_mesh(radius, np.linspace(0.0, pi / 2, 22), 32)
    depth = clearance + bs.RadialFoundation(modulus=bs.constant(modulus)).press(joint, force=force).indentation
    turned, films = Rotation.identity(), []
    pressure = modulus * np.maximum(depth * (mesh.direction @ load) - clearance, 0.0) + ambient
    start = (depth - 1.5e-3) * load
    problem, state = reynolds_on_springs(mesh, pressure, start, np.zeros(3), modulus, ambient, clearance)
    problem = replace(problem, viscosity=viscosity)
    for _ in range(cycles):
        steps = []
        for spin in spins:
            turned = Rotation.from_rotvec(spin / 2) * turned
            push = force * turned.inv().apply(load) + ambient * pi * radius**2 * AXIS
            steps.append(LoadStep(force=push, spin=np.zeros(3), duration=1 / count))
        film = solve_cycle(problem, state, steps)
        assert film.converged
        state = film.states[-1]
        films.append(film.thickness[-1, np.argmax(mesh.direction @ turned.inv().apply(load))])
    return np.array(films)


@pytest.mark.long
def test_a_long_swing_repeats_and_its_two_strokes_are_alike():
    film = carry_over_cycle(MESH, VISCOSITY, swing(1.5), 300)
    assert film.converged
    assert film.settled
    assert film.refreshed_share.min() > 0.98
    half = len(film.central) // 2
    for films in (film.central, film.minimum):
        assert films[half:] == pytest.approx(films[:half], rel=0.04)


def test_a_short_swing_about_one_axis_squeezes_the_middle():
    """As at rest, 1/h² grows with time: 26 nm after 100 s, half of it after 400 s."""
    films = {cycles: carry_over_cycle(MESH, VISCOSITY, swing(0.1, 10), cycles) for cycles in (100, 400)}
    assert films[100].drift == pytest.approx(0.0, abs=1e-12)
    assert films[100].refreshed_share.max() < 0.6
    assert (films[400].converged, films[400].settled) == (True, False)
    central = [1e6 * films[cycles].central.mean() for cycles in (100, 400)]
    assert central[0] == pytest.approx(26.0, rel=0.03)
    assert central[0] / central[1] == pytest.approx(2.0, rel=0.02)


@pytest.mark.long
def test_reynolds_equation_confirms_the_core_of_another_joint():
    """Reynolds' equation has 164 and 168 nm after 10 and 20 cycles. Without drift 20 cycles leave 121 nm."""
    joint = bs.Joint(ball_radius=14.0, clearance=0.06, liner_thickness=8.0, liner=LINER)
    case = {"joint": joint, "modulus": 250.0, "force": 800.0, "amplitude": 0.45, "tilt": 45.0, "count": 20}
    mesh, instants = rocking(**case)
    judge = 1e6 * solve_in_frame_of_the_film(**case, cycles=3, viscosity=1e-8)[-1]
    assert judge == pytest.approx(315.0, rel=0.01)
    for cycles, expected in ((3, judge), (10, 164.0), (20, 168.0)):
        film = carry_over_cycle(mesh, 1e-8, instants, cycles)
        assert 1e6 * film.central[-1] == pytest.approx(expected, rel=film.error[-1])


REVERSING_PARTS = np.array([0.0, 0.025, 0.05, 0.1, 0.15, 0.25, 0.35, 0.4, 0.45, 0.475])
REVERSING_FILMS = np.array([139.0, 153.0, 186.0, 233.0, 236.0, 200.0, 169.0, 156.5, 145.0, 139.0])
"""Central film in nm by the part of the cycle: Reynolds' equation, extrapolated (`docs/explanation/film.md`), ±3 nm."""


@pytest.mark.parametrize(("width", "count"), some([(2.0, 40), (1.0, 160)], 1))
def test_the_stated_error_covers_a_cycle_that_reverses_load_and_motion(width, count):
    """The ball swings by 86° in 6 s while the load goes from 300 to 2000 N and back, twice."""
    phase = (np.arange(count) + 0.5) / count
    contacts = SPRINGS.press(JOINT, force=1150 - 850 * np.cos(4 * pi * phase))
    rings = np.arange(0.0, radians(58.0), radians(width))
    mesh = polar_mesh(18.0, rings, thinned_meridians(rings, round(240 / width)))
    depth = 0.1 + np.asarray(contacts.indentation)
    pressures = MODULUS * (depth[:, None] * mesh.direction[:, 2] - 0.1)
    spins = np.outer(pi / 2 * np.cos(2 * pi * phase), (1.0, 0.0, 0.0))
    instants = []
    for pressure, slope, spin in zip(pressures, contacts.edge_slope, spins, strict=True):
        words = {"continuation": pressure, "axis": AXIS, "spin": spin, "duration": 6.0 / count}
        edge = SpringEdge(slope=slope, modulus=MODULUS)
        instants.append(CycleInstant(pressure=np.maximum(pressure, 0.0), edge=edge, **words))
    film = carry_over_cycle(mesh, VISCOSITY, instants, 3)
    central, error = (np.interp(REVERSING_PARTS + 0.5, phase, values) for values in (1e6 * film.central, film.error))
    assert (np.abs(central / REVERSING_FILMS - 1) < error).all()


def springs_problem(finest, coarsest, meridians, low=1500.0, high=1500.0):
    """Reynolds' equation on springs, and its start: the dry contact with the ball lifted by 500 nm."""
    contacts = [SPRINGS.press(JOINT, force=force) for force in (low, high)]
    widths = {"finest": radians(finest), "coarsest": radians(coarsest)}
    rings = graded_rings(contacts[0].half_angle, last_edge=contacts[1].half_angle, **widths)
    mesh = polar_mesh(18.0, rings, meridians)
    depth = 0.1 + contacts[0].indentation
    pressure = MODULUS * np.maximum(depth * mesh.direction[:, 2] - 0.1, 0.0)
    return reynolds_on_springs(mesh, pressure, (depth - 5e-4) * AXIS, low * AXIS)


def load_steps(forces, rates, duration):
    """Steps of axial loads in N and rotations about x in rad/s."""
    steps = zip(forces, np.outer(rates, (1.0, 0.0, 0.0)), strict=True)
    return [LoadStep(force=force * AXIS, spin=spin, duration=duration) for force, spin in steps]


def test_a_step_without_a_solution_keeps_the_last_film_and_its_status():
    """The second load pulls the ball out of the socket."""
    problem, start = springs_problem(1.0, 3.0, 12)
    film = solve_cycle(problem, start, load_steps([1500.0, -1500.0, 1500.0], [5.0, 5.0, 5.0], 0.02))
    assert film.status.tolist() == [Status.OK, Status.NOT_CONVERGED, Status.OK]
    assert not film.converged
    assert film.thickness[1] == pytest.approx(film.thickness[0])
    assert np.isfinite(film.thickness).all()


@pytest.mark.long
def test_every_step_of_an_elastic_cycle_is_solved():
    """Load and motion reverse; the bodies are those of `exact`."""
    phase = (np.arange(6) + 0.5) / 12
    forces = 1150 - 850 * np.cos(4 * pi * phase)
    motion = np.outer(5.0 * np.cos(2 * pi * phase), (1.0, 0.0, 0.0))
    oil = bs.Lubricant(viscosity=1e-2)
    film = film_over_steps(bs.Exact(), JOINT, forces=forces, spins=motion, durations=1 / 12, lubricant=oil)
    assert film.film.converged
    loads = film.pressure * film.case.problem.mesh.area @ film.case.problem.mesh.direction
    assert loads[:, 2] == pytest.approx(forces, rel=1e-4)
    assert np.abs(loads[:, :2]).max() < 0.5
    assert (film.minimum > 100e-6).all()
    assert (film.central >= film.minimum).all()


def test_parts_of_a_step_ramp_load_and_motion():
    """Two parts of a step are two steps along a straight line of loads."""
    problem, start = springs_problem(1.0, 3.0, 12, low=1000.0, high=1500.0)
    parts = solve_cycle(problem, start, load_steps([1000.0, 1500.0], [5.0, 5.0], 0.04), parts=2)
    steps = load_steps([1250.0, 1000.0, 1250.0, 1500.0], np.full(4, 5.0), 0.02)
    assert parts.converged
    assert parts.thickness == pytest.approx(solve_cycle(problem, start, steps).thickness[[1, 3]], rel=1e-6)
    steady = solve_steady(replace(problem, spin=steps[3].spin, force=steps[3].force), parts.states[-1])
    assert steady.converged
    assert steady.iterations < 12  # the number of right digits doubles from step to step


def test_steps_are_resolved_if_the_edge_moves_less_than_an_inlet_length():
    """The edge of springs lies at cos θ = c/(c + d); the inlet length is K h/G."""
    oil, forces = bs.Lubricant(viscosity=1.0), [1400.0, 1500.0]
    film = film_over_steps(SPRINGS, JOINT, forces=forces, spins=[(5.0, 0.0, 0.0)] * 2, durations=0.05, lubricant=oil)
    low, high = (SPRINGS.press(JOINT, force=force) for force in forces)
    inlet = MODULUS * 4 / 3 * np.sqrt(1e-6 * 5.0 * 18.0 / 2 / high.edge_slope) / high.edge_slope
    travel = 18.0 * (np.arccos(0.1 / (0.1 + high.indentation)) - np.arccos(0.1 / (0.1 + low.indentation)))
    assert film.edge_travel == pytest.approx([travel / inlet] * 2, rel=1e-6)
    assert film.resolved.tolist() == [True, True]
    assert not replace(film, edge_travel=20 * film.edge_travel).resolved.any()


@pytest.mark.long
def test_start_up_ends_at_the_steady_film_and_rest_squeezes_it_out():
    problem, start = springs_problem(0.5, 2.5, 16)
    moving = load_steps(np.full(20, 1500.0), np.full(20, 10.0), 0.045)
    film = solve_cycle(problem, start, moving)
    steady = solve_steady(replace(problem, spin=moving[0].spin), film.states[-1])
    assert steady.converged
    inner = problem.mesh.direction[:, 2] > np.cos(0.8 * CONTACT.half_angle)
    assert film.thickness[-1, inner] == pytest.approx(problem.thickness(steady)[inner], rel=0.02)
    at_rest = solve_cycle(problem, film.states[-1], load_steps(np.full(12, 1500.0), np.zeros(12), 2.0))
    central = at_rest.thickness[:, :16].mean(axis=1)
    assert at_rest.converged
    assert (np.diff(central) < 0).all()
    # on springs h ~ t^(-1/2) once the first film is forgotten
    assert central[5] / central[11] == pytest.approx(np.sqrt(2), rel=0.12)
