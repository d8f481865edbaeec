"""A hip over millions of cycles, on springs and in a real cup; beside a loop by hand in NumPy.

The loop is what one writes without the package: instant by instant, Newton's method for the ball's place on the same
springs and cells, geometry updated in blocks of 50 000 cycles.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from typing import Any
from unittest.mock import patch

import numpy

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1, socket_foundation
from ballsocket.hip.socket_foundation import NO_LATERAL_SPRING
from ballsocket.hip.spring_equilibrium import join_contacts, solve_in_blocks, solve_patients, spring_solver

from .report import Pair, Row, compare
from .timing import Job

BLOCK, MILLION, K = 5e4, 1e6, 1.066e-6
JOINT = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.Material(young=1000.0, poisson=0.4))
SPRINGS = HipSimulation(
    joint=JOINT, cup=bs.Cup(inclination=radians(30.0)), cycle=iso_14242_1(100), wear=Archard(coefficient=K)
)
CUP = replace(SPRINGS, surface=bs.RealCup())
RINGS = ((8, 32), (2, 100))
"""Rings in degrees, and instants of a cycle."""


def measure() -> list[Row]:
    assert CUP.unworn.converged  # the rings of the cup are made once, and kept
    rows = compare(
        [
            Pair("hip, first cycle on springs", Job(_first_cycle)),
            Pair(
                "hip, a million cycles on springs, with error estimate",
                _worn(SPRINGS, MILLION),
                "a loop by hand in NumPy",
                Job(_by_hand),
            ),
            Pair("hip, 5 million cycles on springs", _worn(SPRINGS, 5 * MILLION)),
            Pair("hip, 5 million cycles in a real cup", _worn(CUP, 5 * MILLION)),
        ],
        repeats=2,
    )
    pairs = []
    for width, instants in RINGS:
        use = replace(SPRINGS, ring_width=radians(width), cycle=iso_14242_1(instants))
        name = f"hip, a million cycles, rings of {width}°, {instants} instants"
        pairs.append(Pair(name, _integrated(use, spring_solver()), "without numba", _integrated(use, solve_in_blocks)))
    return rows + compare(pairs, repeats=2)


def _first_cycle() -> object:
    use = replace(SPRINGS)  # nothing is kept from others
    return use.wear.depth(use.exposure(use.unworn))


def _worn(use: HipSimulation, cycles: float) -> Job:
    return Job(lambda: use.after(cycles).last.volume)


def _integrated(use: HipSimulation, solver: Any) -> Job:
    """Wear by one solver, without the error estimate."""
    from ballsocket.hip.wear_integrator import WearIntegrator

    @patch.object(socket_foundation, "spring_solver", lambda: solver)
    def call() -> object:
        return WearIntegrator(setup=use).run_until(MILLION, lambda cycles: None)

    return Job(call)


def _by_hand() -> float:
    bed: Any = SPRINGS.foundation
    steps, outward = SPRINGS.sliding.distances, (bed.normals * bed.areas).T
    depth, places = numpy.zeros(len(bed.areas)), SPRINGS.unworn.displacement.copy()
    for _ in range(round(MILLION / BLOCK)):
        worn = numpy.zeros_like(depth)
        for i, load in enumerate(SPRINGS.frame.loads):
            for _ in range(30):
                overlap = places[i] @ bed.normals - bed.clearance - depth
                pressure = bed.modulus * numpy.maximum(overlap, 0.0)
                missing = load - pressure @ outward
                if numpy.linalg.norm(missing) < 1e-8 * numpy.linalg.norm(load):
                    break
                touching = bed.normals * (overlap > 0)
                places[i] += numpy.linalg.solve(bed.modulus * (touching @ outward), missing)
            worn += pressure * steps[i]
        depth += 1e-3 * K * BLOCK * worn
    return float(depth @ bed.areas)


def patients_jobs(number: int) -> tuple[Job, Job]:
    """A cycle of 32 instants of patients with forces of 60 to 140 %: together in JAX, and one by one by numba."""
    import jax

    use = replace(SPRINGS, ring_width=radians(8.0), cycle=iso_14242_1(32))
    springs: Any = use.foundation
    worn, factors = numpy.zeros(len(springs.areas)), numpy.linspace(0.6, 1.4, number)
    loads = use.frame.loads
    contacts = [springs.contact(factor * loads, worn, NO_LATERAL_SPRING) for factor in factors]
    start = numpy.ascontiguousarray(numpy.broadcast_to(use.unworn.displacement, (number, *use.frame.loads.shape)))
    solver, pressure = spring_solver(), numpy.empty((len(use.frame.loads), len(springs.areas)))
    with jax.enable_x64(True):
        joined, started = jax.tree.map(jax.numpy.asarray, (join_contacts(contacts), start))

    def one_by_one() -> None:
        for contact, displacement in zip(contacts, start, strict=True):
            solver(contact, displacement.copy(), pressure)

    together = Job(lambda: jax.block_until_ready(solve_patients(joined, started)), number)
    return together, Job(one_by_one, number)
