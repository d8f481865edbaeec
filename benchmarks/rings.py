"""Cost and error over the number of rings: set up, by displacement, by force; the finest rings are the judge.

The cup is that of `off_axis`. Errors are the largest of five tilts from the dome's axis to over the rim, all of them
displaced by as much, so that a number that happens to be right at one tilt does not count.
"""

from __future__ import annotations

import os
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any
from unittest import mock

import numpy

import ballsocket as bs
from ballsocket.elasticity.off_axis.grid import rim_grid

from .off_axis import INDENTATION, JOINT, displaced, forced, set_up
from .report import Report, Rows
from .timing import Spread, interleaved, one_core

WIDTHS = (6.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.75, 0.5)
"""Of the rings in degrees; the last is the judge."""

TILTS = numpy.radians([0.0, 15.0, 30.0, 45.0, 60.0])
REPEATS = 5
WORKS = {"set up": set_up, "by force": forced, "by displacement": displaced}
DRAWN = Path(__file__).parents[1] / "docs" / "rings_cost.png"


def measure() -> Report:
    rows = Rows("Milliseconds, and largest differences from the finest", ("rings", "cells", *WORKS, "force", "pmax"))
    with TemporaryDirectory() as folder, mock.patch.dict(os.environ, BALLSOCKET_CACHE=folder), one_core() as pinned:
        models = [bs.Sphere(ring_width=radians(width)) for width in WIDTHS]
        found = [_answers(model) for model in models]
        seconds = [_seconds(model) for model in models]
    load = os.getloadavg()[0]
    grids = [rim_grid(bs.Cup().rim, radians(width)) for width in WIDTHS]
    off = [_off(each, found[-1]) for each in found[:-1]]
    for width, cells, times in zip(WIDTHS, grids, seconds, strict=True):
        name, count = f"{cells.rings} of {width:g}°", cells.rings * cells.meridians
        rows.add(name, count, *(time.per(1e-3) for time in times.values()))
    rows.rows = [(*row, *shares) for row, shares in zip(rows.rows, [*map(_percent, off), ("", "")], strict=True)]
    _draw(numpy.array([each.rings for each in grids]), seconds, numpy.array(off))
    where = "on one core" if pinned else "not held to one core"
    notes = [f"{where.capitalize()}, seconds of the processor; {load:.1f} programs ran at the end, this one included."]
    return Report([rows], [*notes, "docs/rings_cost.png shows them."], ("scipy",))


def _seconds(model: bs.Sphere) -> dict[str, Spread]:
    """Of the processor: one thread that does not wait, whatever else runs."""
    _, again = interleaved(REPEATS, {name: work(model) for name, work in WORKS.items()}, process_time)
    return again


def _answers(model: bs.Sphere) -> Any:
    return model.press(JOINT, indentation=INDENTATION, tilt=TILTS)


def _off(contact: Any, judge: Any) -> tuple[float, float]:
    """Of the vector of the force, and of the largest pressure."""
    force = numpy.linalg.norm(contact.force_vector - judge.force_vector, axis=-1) / judge.force
    return float(force.max()), float(abs(contact.max_pressure / judge.max_pressure - 1).max())


def _percent(shares: tuple[float, float]) -> tuple[str, ...]:
    return tuple(f"{100 * share:.2g} %" for share in shares)


def _draw(rings: numpy.ndarray, seconds: list[dict[str, Spread]], off: numpy.ndarray) -> None:
    from matplotlib.figure import Figure

    from ballsocket.reports.figure_files import save
    from ballsocket.reports.style import LEGEND, finish, in_matplotlib, numbered

    figure = Figure(figsize=(8.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for number, name in enumerate(WORKS):
        values = numpy.array([each[name].values for each in seconds])
        style = {**in_matplotlib(numbered(number)), "marker": "o"}
        left.loglog(rings, numpy.median(values, axis=1), label=name, **style)
        left.vlines(rings, values.min(axis=1), values.max(axis=1), color=style["color"])
    for number, name in enumerate(("force by displacement", "largest pressure")):
        style = {**in_matplotlib(numbered(number + len(WORKS))), "marker": "o"}
        right.loglog(rings[:-1], 100 * off[:, number], label=name, **style)
    for axes, what in ((left, "seconds on one core"), (right, f"off {rings[-1]} rings, at most [%]")):
        finish(axes, "rings from the pole to the rim", what)
        ticks = [(count, f"{count}\n{width:g}°") for count, width in zip(rings, WIDTHS, strict=True)]
        axes.set_xticks([count for count, _ in ticks], [text for _, text in ticks])
        axes.minorticks_off()
        axes.legend(**LEGEND)
    save(figure, DRAWN)
