"""The lubricating film: its three methods, their cost against cells, and the obvious finite differences in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from time import process_time
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, Lubricant, iso_14242_1
from ballsocket.lubrication import film as films
from ballsocket.lubrication.mesh import graded_rings, polar_mesh
from ballsocket.lubrication.reynolds import FilmProblem, FilmState
from ballsocket.lubrication.transient import LoadStep, solve_cycle

from .report import Report, Rows

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
VISCOSITY, SPEED = 2.5e-9, (1.5, 0.0, 0.0)


def timed(function: Callable[..., Any], *words: Any, **named: Any) -> tuple[float, Any]:
    """Seconds of one core for a call, the best of three, and its result."""
    seconds = []
    for _ in range(3):
        begun = process_time()
        result = function(*words, **named)
        seconds.append(process_time() - begun)
    return min(seconds), result


def loop_in_numpy(contact: Any, rings: int, meridians: int, duration: float) -> float:
    """Carry a film over the dry pressure by upwind differences on a polar grid, explicit in time: central film in nm.

    This is the wave as a first program has it: no Godunov flux, no thinning near the pole.
    """
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


def measure() -> Report:
    springs = bs.RadialFoundation(modulus=bs.constant(276.67)).press(JOINT, force=1500.0)
    exact = bs.Exact().press(JOINT, force=1500.0)
    methods = Rows("Steady film of one contact", ("contact", "method", "cells", "s", "central nm", "minimum nm"))
    for contact, names in ((springs, films.METHODS), (exact, films.METHODS)):
        for method in names:
            seconds, film = timed(bs.film, contact, spin=SPEED, method=method)
            row = (f"{seconds:.3f}", f"{1e6 * film.central:.1f}", f"{1e6 * film.minimum:.1f}")
            methods.add(contact.model.name, method, len(film.areas), *row)
    seconds, central = timed(loop_in_numpy, springs, 19, 72, 4.0)
    methods.add("constant-linear", "upwind loop in NumPy", 19 * 72, f"{seconds:.3f}", f"{central:.1f}", "")
    cost = Rows("Cost of the wave against cells", ("cell width", "cells", "s", "central nm"))
    for width in (4.0, 2.0, 1.0):
        seconds, film = timed(bs.film, springs, spin=SPEED, cell_width=radians(width))
        cost.add(f"{width:g} deg", len(film.areas), f"{seconds:.3f}", f"{1e6 * film.central:.1f}")
    return Report(
        [methods, cost, _reynolds_cycle(springs), _cycles()],
        [
            "The loop in NumPy has the inlet film prescribed; its differences are of first order.",
            "Times are those of one core (process time).",
        ],
    )


def _reynolds_cycle(contact: Any) -> Rows:
    """A swing that reverses, from 300 to 2000 N and back twice, in 100 steps of Reynolds' equation."""
    rows = Rows("A reversing cycle by Reynolds' equation on springs", ("cells", "steps", "not converged", "s"))
    modulus, clearance, meridians = 276.67, 0.1, 64
    pressed = [contact.model.press(JOINT, force=force) for force in (300.0, 2000.0)]
    low, high = (float(each.half_angle) for each in pressed)
    mesh = polar_mesh(18.0, graded_rings(low, finest=radians(0.2), coarsest=radians(1.5), last_edge=high), meridians)
    depth = clearance + float(pressed[0].indentation)
    problem = FilmProblem(
        mesh=mesh,
        viscosity=VISCOSITY,
        spin=numpy.zeros(3),
        gap=numpy.full(mesh.cells, clearance),
        compliance=numpy.full(mesh.cells, 1 / modulus),
        rim_pressure=numpy.zeros(meridians),
        force=numpy.zeros(3),
    )
    start = FilmState(
        pressure=modulus * numpy.maximum(depth * mesh.direction[:, 2] - clearance, 0.0),
        void=numpy.zeros(mesh.cells),
        eccentricity=numpy.array([0.0, 0.0, depth - 5e-4]),
    )
    phase = (numpy.arange(100) + 0.5) / 100
    steps = [
        LoadStep(
            force=numpy.array([0.0, 0.0, 1150 - 850 * numpy.cos(4 * numpy.pi * time)]),
            spin=numpy.array([5.0 * numpy.cos(2 * numpy.pi * time), 0.0, 0.0]),
            duration=0.01,
        )
        for time in phase
    ]
    begun = process_time()
    film = solve_cycle(problem, start, steps)
    rows.add(mesh.cells, len(steps), int((film.status != 0).sum()), f"{process_time() - begun:.0f}")
    return rows


def _cycles() -> Rows:
    rows = Rows("A cycle of ISO 14242-1 by the wave, until it repeats", ("cells", "instants", "s", "smallest nm"))
    joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    for width in (3.0, 2.0):
        use = HipSimulation(
            joint=joint, cycle=iso_14242_1(100), wear=Archard(coefficient=1e-6), ring_width=radians(width)
        )
        _ = use.unworn
        begun = process_time()
        film = use.film(Lubricant(), method="wave")
        seconds = process_time() - begun
        rows.add(f"{width:g} deg", len(film.phases), f"{seconds:.2f}", f"{1e6 * film.least.min():.1f}")
    return rows
