"""A million cycles of wear on springs against rings and instants: compiled, in NumPy's blocks, and in one block.

One block of all loads is what earlier versions computed: arrays (instants, cells) that leave the processor's cache.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from time import process_time
from typing import Any
from unittest.mock import patch

import numpy

from ballsocket.hip import HipSimulation, iso_14242_1, socket_foundation, spring_equilibrium
from ballsocket.hip.jax_springs import join_contacts, solve_patients
from ballsocket.hip.socket_foundation import NO_LATERAL_SPRING
from ballsocket.hip.spring_equilibrium import Solver, SpringContact, solve_in_blocks, spring_solver
from ballsocket.hip.wear_integrator import WearIntegrator

from .hip import MILLION, SPRINGS
from .report import Report, Rows
from .timing import Clock, Spread, Work, interleaved, one_core

REPEATS = 2
SIZES = (8, 32), (8, 100), (4, 100), (2, 100), (3, 64), (3, 128), (3, 256)
"""Rings in degrees, and instants of a cycle."""

COUNTS = 16, 128
"""Numbers of patients in one block."""


def measure() -> Report:
    compiled = spring_solver()
    if compiled is solve_in_blocks:
        return Report([], ["numba is not installed: nothing to compare."])
    volumes: dict[str, float] = {}
    rows = Rows(
        "A million cycles, ms; in brackets ns a cell, instant and block of cycles",
        ("rings, instants, cells near the contacts", "numba", "NumPy in blocks", "NumPy in one block", "over numba"),
    )
    with one_core() as pinned:
        for width, instants in SIZES:
            use = replace(SPRINGS, ring_width=radians(width), cycle=iso_14242_1(instants))
            label = f"{width}°, {instants}"
            runs: dict[str, Work] = {
                "numba": _worn(volumes, f"{label}, numba", use, compiled, 1),
                "blocks": _worn(volumes, f"{label}, NumPy", use, solve_in_blocks, 1),
                "one": _worn(volumes, f"{label}, NumPy", use, solve_in_blocks, 10**9),
            }
            _, seconds = interleaved(REPEATS, runs, process_time)
            integrator = _integrated(use)
            active = len(integrator._active.cells)
            size = active * len(use.loads) * integrator.steps
            shown = [f"{spread.per(1e-3)} [{1e9 * spread.median / size:.0f}]" for spread in seconds.values()]
            rows.add(f"{label}, {active}", *shown, str(seconds["blocks"].over(seconds["numba"])))
    together = Rows("A cycle of 32 instants on rings of 8°, µs a patient", ("patients at once", "JAX", "numba", "over"))
    with one_core():
        for count in COUNTS:
            jax, one = (spread.per(1e-6 * count) for spread in patients_in_jax(count, process_time))
            together.add(count, jax, one, str(jax.over(one)))
    notes = ["Processor time, on one core." if pinned else "Processor time, not held to one core."]
    notes += [f"{name}: {volume:.9g} mm³." for name, volume in volumes.items() if name.startswith("2°")]
    return Report([rows, together], notes, ("jax",))


def _integrated(use: HipSimulation) -> WearIntegrator:
    return WearIntegrator(setup=use).run_until(MILLION, lambda cycles: None)


def _worn(
    volumes: dict[str, float], name: str, use: HipSimulation, solver: Solver, blocks: int
) -> Callable[[], object]:
    """Wear by one solver; `blocks` multiplies the size of NumPy's blocks."""
    size = blocks * spring_equilibrium._BLOCK_SIZE

    def work() -> None:
        with (
            patch.object(socket_foundation, "spring_solver", lambda: solver),
            patch.object(spring_equilibrium, "_BLOCK_SIZE", size),
        ):
            volumes[name] = _integrated(use).volume

    return work


def block_of_patients(count: int) -> tuple[list[SpringContact], Any]:
    """Contacts of patients with forces of 60 to 140 % on rings of 8° in 32 instants, and starts near their results."""
    use = replace(SPRINGS, ring_width=radians(8.0), cycle=iso_14242_1(32))
    springs: Any = use.foundation
    worn = numpy.zeros(len(springs.areas))
    factors = numpy.linspace(0.6, 1.4, count)
    contacts = [springs.contact(factor * use.loads, worn, NO_LATERAL_SPRING) for factor in factors]
    return contacts, numpy.broadcast_to(use.unworn.displacement, (count, *use.loads.shape))


def solved_together(contacts: list[SpringContact], start: Any) -> Callable[[], object]:
    """Solve the patients in JAX on its default device, with their arrays on the device before."""
    import jax

    with jax.enable_x64(True):
        joined, started = jax.tree.map(jax.numpy.asarray, (join_contacts(contacts), numpy.ascontiguousarray(start)))
    return lambda: jax.block_until_ready(solve_patients(joined, started))


def solved_one_by_one(contacts: list[SpringContact], start: Any) -> Callable[[], object]:
    """Solve the patients one by one, by numba if it is installed."""
    solver, pressure = spring_solver(), numpy.empty((len(start[0]), len(contacts[0].areas)))

    def work() -> None:
        for contact, displacement in zip(contacts, start, strict=True):
            solver(contact, displacement.copy(), pressure)

    return work


def patients_in_jax(count: int, clock: Clock) -> tuple[Spread, Spread]:
    """Seconds for so many patients in JAX, and one by one."""
    contacts, start = block_of_patients(count)
    runs: dict[str, Work] = {"jax": solved_together(contacts, start), "one": solved_one_by_one(contacts, start)}
    _, seconds = interleaved(REPEATS, runs, clock)
    return seconds["jax"], seconds["one"]
