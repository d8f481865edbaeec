"""The lubricating film: its three methods and a cycle; beside upwind differences in a loop of NumPy.

The loop is the wave as a first program has it: explicit in time, no thinning near the pole, the film at the inlet is
prescribed. Its central film is 168 nm where the wave has 191 nm and Reynolds' equation 194 nm.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import radians
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, Lubricant, iso_14242_1
from ballsocket.lubrication.mesh import graded_rings, polar_mesh
from ballsocket.lubrication.reynolds import FilmProblem, FilmState
from ballsocket.lubrication.transient import LoadStep, solve_cycle

from .report import Pair, Row, compare
from .timing import Job

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
MODULUS, CLEARANCE, MERIDIANS = 276.67, 0.1, 64
VISCOSITY, SPEED = 2.5e-9, (1.5, 0.0, 0.0)
SPRINGS = bs.RadialFoundation(modulus=bs.constant(MODULUS))


def measure() -> list[Row]:
    contact = SPRINGS.press(JOINT, force=1500.0)
    loop = Job(lambda: loop_in_numpy(contact, 19, 72, 4.0))
    pairs = [
        Pair(f"steady film on springs, {method}", Job(partial(bs.film, contact, spin=SPEED, method=method)), rival, job)
        for method, rival, job in (("inlet", "", None), ("wave", "upwind loop in NumPy", loop), ("reynolds", "", None))
    ]
    use = HipSimulation(
        joint=bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE),
        cycle=iso_14242_1(100),
        wear=Archard(coefficient=1e-6),
        ring_width=radians(3.0),
    )
    cycle = Job(lambda: replace(use).film(Lubricant(), method="wave"))  # nothing is kept from before
    pairs.append(Pair("cycle of ISO 14242-1 on springs, wave", cycle))
    reversing = compare([Pair("reversing cycle of 100 steps, reynolds", Job(reversing_cycle()))], repeats=0)
    return [*compare(pairs, repeats=3), *reversing]


def loop_in_numpy(contact: Any, rings: int, meridians: int, duration: float) -> float:
    """Carry a film over the dry pressure by upwind differences on a polar grid; return the central film in nm."""
    radius, edge = 18.0, contact.half_angle
    theta = (numpy.arange(rings) + 0.5) * edge / rings
    phi = (numpy.arange(meridians) + 0.5) * 2 * numpy.pi / meridians
    pressure = numpy.asarray(contact.pressure(theta))[:, None] + 0 * phi
    slope = numpy.gradient(pressure[:, 0], radius * theta)[:, None]
    spread = numpy.gradient(numpy.sin(theta) * slope[:, 0], radius * theta)[:, None] / numpy.sin(theta)[:, None]
    along = -radius * SPEED[0] * numpy.sin(phi)[None, :] + 0 * theta[:, None]
    around = -radius * SPEED[0] * numpy.cos(theta)[:, None] * numpy.cos(phi)[None, :]
    film = numpy.full((rings, meridians), 2e-4)
    inlet = 4 / 3 * numpy.sqrt(VISCOSITY * 0.5 * numpy.maximum(-along[-1], 0.0) / contact.edge_slope)
    ring, step = radius * edge / rings, radius * numpy.sin(theta)[:, None] * 2 * numpy.pi / meridians
    time_step = 0.3 * float(step.min()) / (0.5 * radius * SPEED[0])
    for _ in range(int(duration / time_step)):
        outer = numpy.vstack([film[1:], inlet])
        inner = numpy.vstack([numpy.roll(film[:1], meridians // 2, axis=1), film[:-1]])
        velocity = 0.5 * along - 3 * film**2 * slope / (12 * VISCOSITY)
        radial = numpy.where(velocity > 0, film - inner, outer - film) / ring
        turning = numpy.where(around > 0, film - numpy.roll(film, 1, 1), numpy.roll(film, -1, 1) - film) / step
        squeezed = film**3 * spread / (12 * VISCOSITY)
        film = numpy.maximum(film + time_step * (squeezed - velocity * radial - 0.5 * around * turning), 0.0)
    return float(1e6 * film[0].mean())


def reversing_cycle(steps: int = 100) -> partial[Any]:
    """A swing that reverses under 300 to 2000 N and back twice, by Reynolds' equation on springs."""
    pressed = [SPRINGS.press(JOINT, force=force) for force in (300.0, 2000.0)]
    low, high = (float(contact.half_angle) for contact in pressed)
    mesh = polar_mesh(18.0, graded_rings(low, finest=radians(0.2), coarsest=radians(1.5), last_edge=high), MERIDIANS)
    depth = CLEARANCE + float(pressed[0].indentation)
    problem = FilmProblem(
        mesh=mesh,
        viscosity=VISCOSITY,
        spin=numpy.zeros(3),
        gap=numpy.full(mesh.cells, CLEARANCE),
        compliance=numpy.full(mesh.cells, 1 / MODULUS),
        rim_pressure=numpy.zeros(MERIDIANS),
        force=numpy.zeros(3),
    )
    start = FilmState(
        pressure=MODULUS * numpy.maximum(depth * mesh.direction[:, 2] - CLEARANCE, 0.0),
        void=numpy.zeros(mesh.cells),
        eccentricity=numpy.array([0.0, 0.0, depth - 5e-4]),
    )
    loads = [
        LoadStep(
            force=numpy.array([0.0, 0.0, 1150 - 850 * numpy.cos(4 * numpy.pi * phase)]),
            spin=numpy.array([5.0 * numpy.cos(2 * numpy.pi * phase), 0.0, 0.0]),
            duration=1 / steps,
        )
        for phase in (numpy.arange(steps) + 0.5) / steps
    ]
    return partial(solve_cycle, problem, start, loads)
