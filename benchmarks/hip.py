"""A hip in use: one cycle and five million, on springs and in a real cup; beside a loop by hand in NumPy.

The loop is what one writes without the package: instant by instant, Newton's method for the ball's place on the same
springs and cells, geometry updated in blocks of 50 000 cycles. Both wear one million cycles for the comparison.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from time import process_time
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.hip import Archard, Cycle, HipSimulation, iso_14242_1

from .report import Report, Rows
from .timing import Work, interleaved, one_core

REPEATS, BLOCK, MILLION = 2, 5e4, 1e6
K = 1.066e-6


def swinging(cycle: Cycle) -> Cycle:
    """A cycle whose load swings to the front and back: no two of its loads have one direction."""

    def force(phases: Any) -> Any:
        lean = radians(12.0) * numpy.sin(2 * numpy.pi * phases)
        return numpy.asarray(cycle.force(phases)) * numpy.stack([0 * lean, numpy.sin(lean), numpy.cos(lean)])

    return replace(cycle, force=force)


JOINT = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.Material(young=1000.0, poisson=0.4))
SPRINGS = HipSimulation(
    joint=JOINT, cup=bs.Cup(inclination=radians(30.0)), cycle=iso_14242_1(100), wear=Archard(coefficient=K)
)
CUP = replace(SPRINGS, surface=bs.RealCup())
SWINGING = replace(CUP, cycle=swinging(iso_14242_1(50)))


def measure() -> Report:
    volumes: dict[str, float] = {}
    quick: dict[str, tuple[Work, str]] = {
        "a cycle of 100 instants, springs": (_cycle, "0.020"),
        "5 million cycles, springs": (_worn(volumes, "ours, springs", SPRINGS, 5 * MILLION), "3"),
        "1 million cycles, springs": (_worn(volumes, "ours, springs, a million", SPRINGS, MILLION), ""),
        "1 million cycles, a loop by hand": (_by_hand(volumes), ""),
        "5 million cycles, real cup": (_worn(volumes, "ours, real cup", CUP, 5 * MILLION), "120"),
        "the same under a load that swings by 12°, 50 instants": (
            _worn(volumes, "ours, real cup, swinging", SWINGING, 5 * MILLION),
            "120",
        ),
    }
    rows = Rows("Seconds of a core", ("what", "takes", "aim"))
    assert SWINGING.unworn.converged
    assert CUP.unworn.converged  # the rings of the cup are made once, and kept
    with one_core() as pinned:
        _, seconds = interleaved(REPEATS, {name: work for name, (work, _) in quick.items()}, process_time)
    for name, (_, aim) in quick.items():
        rows.add(name, seconds[name], aim)
    said = [f"{name}: {volume:.2f} mm³." for name, volume in volumes.items()]
    return Report([rows], ["On one core." if pinned else "Not held to one core.", *said])


def _cycle() -> object:
    """All of a first cycle, with nothing kept from others."""
    use = replace(SPRINGS)
    return use.wear.depth(use.exposure(use.unworn))


def _worn(volumes: dict[str, float], name: str, use: HipSimulation, cycles: float) -> Callable[[], object]:
    def work() -> None:
        volumes[name] = use.after(cycles).last.volume

    return work


def _by_hand(volumes: dict[str, float]) -> Callable[[], object]:
    bed: Any = SPRINGS.foundation
    loads = SPRINGS.loads
    steps, outward = SPRINGS.sliding.distances, (bed.normals * bed.areas).T

    def work() -> None:
        depth, places = numpy.zeros(len(bed.areas)), SPRINGS.unworn.displacement.copy()
        for _ in range(round(MILLION / BLOCK)):
            worn = numpy.zeros_like(depth)
            for i, load in enumerate(loads):
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
        volumes["by hand, a million"] = float(depth @ bed.areas)

    return work
