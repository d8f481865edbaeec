"""A million cycles of wear on springs against rings and instants: compiled, in NumPy's blocks, and in one block.

One block of all loads is what earlier versions computed: arrays (instants, cells) that leave the processor's cache.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from time import process_time
from unittest.mock import patch

from ballsocket.hip import HipSimulation, iso_14242_1, socket_foundation, spring_equilibrium
from ballsocket.hip.spring_equilibrium import Solver, solve_in_blocks, spring_solver
from ballsocket.hip.wear_integrator import WearIntegrator

from .hip import MILLION, SPRINGS
from .report import Report, Rows
from .timing import Work, interleaved, one_core

REPEATS = 2
SIZES = (8, 32), (8, 100), (4, 100), (2, 100), (3, 64), (3, 128), (3, 256)
"""Rings in degrees, and instants of a cycle."""


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
    notes = ["Processor time, on one core." if pinned else "Processor time, not held to one core."]
    notes += [f"{name}: {volume:.9g} mm³." for name, volume in volumes.items() if name.startswith("2°")]
    return Report([rows], notes)


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
