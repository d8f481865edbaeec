"""Looking at a run: after which cycles, what is seen, and on from what was kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .blocks import Run
from .checkpoint import Checkpoint
from .facing import facing
from .history import Report
from .set_up import SetUp
from .springs import Rest

_LINERS = 10.0
"""May be worn through by the rate of the first cycle: later ones wear less deep, and a run beyond has no meaning."""


def check_cycles(cycles: float, report_at: Sequence[float]) -> list[float]:
    """Numbers of cycles in order, the last one at the end.

    Raises
    ------
    ValueError
        Not positive and finite, or a look beyond the end.
    """
    require("cycles", cycles, 0 < cycles < inf, "a number of cycles is positive and finite")
    for count in report_at:
        require("report_at", count, 0 <= count <= cycles, f"it lies between 0 and the {cycles:g} cycles of the run")
    return sorted({float(count) for count in (*report_at, cycles)})


def check_meant(use: SetUp, cycles: float) -> None:
    """Whether so many cycles can be meant.

    Raises
    ------
    ValueError
        By what the first of them wears, all of them would wear the liner through many times over.
    """
    done = use.passed(use.unworn)
    whole = float(min(use.joint.liner_thickness, use.joint.socket_radius))
    worn = cycles * max(float(law.depth(done).max(initial=0.0)) for law in (use.wear, use.ball_wear) if law is not None)
    if not worn <= _LINERS * whole:
        raise ValueError(
            f"{cycles:g} cycles as the first one would wear {worn:.3g} mm away, and {whole:g} mm are there: "
            "a coefficient of wear or a number of cycles is not what was meant"
        )


def looks(
    run: Run, counts: Sequence[float], listen: Callable[[float], None], kept: Checkpoint | None
) -> tuple[Report, ...]:
    """What is seen after these counts of cycles, on from what was kept."""
    reports: tuple[Report, ...] = ()
    found = kept.read() if kept else None
    if found is not None:
        state, reports = found
        run.resume(state)
        reports = tuple(report for report in reports if report.cycles in counts)
    seen = {report.cycles for report in reports}
    for count in counts:
        if count in seen:
            continue
        if count < run.cycles:
            raise ValueError(f"the store is {run.cycles:g} cycles on and has not seen {count:g}; give another folder")

        def listening(done: float) -> None:
            if kept is not None and done < count:  # noqa: B023 (called before the next)
                kept.write(run.state, reports)  # noqa: B023
            listen(done)

        reports = (*reports, report_of(run.until(count, listening)))
        if kept is not None:
            kept.write(run.state, reports)
    return reports


def report_of(run: Run) -> Report:
    """What is seen of a run as far as it is."""
    use, crept, shape = run.use, run.crept, (run.use.grid.rings, -1)
    depth = run.depth + crept
    if use.ball_wear is not None:
        depth = depth + facing(use, numpy.arange(len(depth))).on_socket.of(run.ball[None])
    rest = use.rest(depth, run.rest)
    only = [rest if use.creep is None else _only(use, run.depth), _only(use, crept)]
    moved = [(each.displacement - use.unworn.displacement)[use.largest].sum(axis=0) for each in (rest, *only)]
    edge = use.edge(rest, depth)
    return Report(
        cycles=run.cycles,
        wear=run.depth.reshape(shape),
        volume=run.volume,
        depth=float(run.depth.max()),
        work=run.work,
        displacement=moved[0],
        worn_in=moved[1],
        crept_in=moved[2],
        max_pressure=float(rest.pressure.max(initial=0.0)),
        edge_distance=edge.distance,
        edge_place=edge.azimuth,
        edge_pressure=edge.pressure,
        crept=crept.reshape(shape),
        creep_depth=float(crept.max()),
        ball_wear=run.ball,
        ball_volume=run.ball_volume,
        ball_depth=float(run.ball.max(initial=0.0)),
        worst_contacts=use.worst_contacts(rest, depth),
        settled=run.settled and all(each.settled for each in (rest, *only)),
    )


def _only(use: SetUp, depth: Numbers) -> Rest:
    return use.rest(depth) if depth.any() else use.unworn
