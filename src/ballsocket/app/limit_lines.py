"""Lines of a map: where a limit runs, what it becomes when its line is moved, and sizes of a catalogue."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import isfinite, nan
from typing import Any

import numpy

from ..core.quantities import QUANTITIES
from ..problem.dimensions import DIAMETERS
from ..studies.limits import Limit, margin_on_plane
from .contours import Contours
from .mapping import limits_of
from .numbers import NUMBERS
from .reading import Reading
from .screen import Screen

Place = tuple[float, float]


def longest(x: numpy.ndarray, y: numpy.ndarray, values: numpy.ndarray, level: float) -> Place:
    """The middle of the longest line on which a field (y, x) has a value; NaN where it has it nowhere."""
    grid_x, grid_y = numpy.meshgrid(x, y)
    lines = Contours(grid_x, grid_y, values).lines(level)
    if not lines:
        return nan, nan
    line = max(lines, key=len)
    across, up = line[len(line) // 2]
    return float(across), float(up)


def handles(found: Any, screen: Screen) -> list[Place]:
    """Where each limit of the screen can be taken hold of, in the units of a study; NaN for one beside the map."""
    across, up = screen.across.name, screen.up.name
    x, y = found[across].values, found[up].values
    return [longest(x, y, margin_on_plane(found, limit, across, up), 0.0) for limit in limits_of(screen)]


def moved(found: Any, screen: Screen, number: int, place: Place) -> tuple[Limit, ...]:
    """The limits of the screen, one of which runs through another place of the map.

    Raises
    ------
    ValueError
        There is no answer there, or nothing of the map.
    """
    limit = limits_of(screen)[number]
    across, up = screen.across, screen.up
    x, y = (min(max(at, axis.low), axis.high) for at, axis in zip(place, (across, up), strict=True))
    field = limit.evaluate(found) + 0.0 * found[across.name] + 0.0 * found[up.name]
    value = float(field.interp({across.name: x, up.name: y}))
    if not isfinite(value):
        raise ValueError(f"{limit.name} has no number there: the limit stays where it was")
    end = float(f"{value:.3g}")
    old = screen.limits[number]
    other = replace(old, high=end) if isfinite(limit.high) else replace(old, low=end)
    return (*screen.limits[:number], other, *screen.limits[number + 1 :])


def said(limit: Limit, reading: Reading) -> str:
    """A limit as a sign on the map says it, with its unit."""
    sign, end = ("≤", limit.high) if isfinite(limit.high) else ("≥", limit.low)
    quantity = QUANTITIES[limit.name]
    return f"{quantity.title} {sign} {reading.said(quantity, end)}"


def sold(point: Mapping[str, float]) -> dict[str, float]:
    """A point of a map in the sizes of catalogues, the nearest of each number that has such."""
    return {name: _nearest(name, value) for name, value in point.items()}


def _nearest(name: str, value: float) -> float:
    single, times = (DIAMETERS[name], 2) if name in DIAMETERS else (name, 1)
    sizes = NUMBERS[single].sizes if single in NUMBERS else ()
    return min((times * size for size in sizes), key=lambda size: abs(size - value), default=value)
