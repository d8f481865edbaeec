"""Distances to the rim over how a cup may stand, as SVG: where the edge of the contact stays on the bore."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import Any

import numpy

from ..core.quantities import CUP, QUANTITIES
from ..problem.cup import Cup
from . import svg
from .bore_map import SHOWN
from .contours import Contours, levels_of, scale
from .cupping import LEWINNEK, Stood
from .reading import Reading

_WIDE, _HIGH = 440.0, 400.0
_LEFT, _RIGHT, _TOP, _FOOT = 58.0, 14.0, 12.0, 92.0
_SPAN, _RISE = _WIDE - _LEFT - _RIGHT, _HIGH - _TOP - _FOOT


def angle_map(found: Stood, cup: Cup, quantity: str, reading: Reading = SHOWN) -> str:
    """One field over inclination and anteversion, with the cup as it stands and Lewinnek's zone."""
    x, y = numpy.degrees(found.inclination), numpy.degrees(found.anteversion)
    factor = reading.unit(QUANTITIES[quantity]).factor
    values = numpy.where(found.held, getattr(found, quantity), numpy.nan).T * factor
    finite = numpy.where(numpy.isfinite(values), values, numpy.nan)
    across, up = numpy.meshgrid(_across(x, x), _up(y, y))
    contours = Contours(across, up, finite)
    low = min(float(numpy.nanmin(finite, initial=0.0)), 0.0)
    levels = _levels(quantity, finite, low)
    rim = Contours(across, up, numpy.where(found.held, found.edge_distance, numpy.nan).T)
    label = reading.label(QUANTITIES[quantity])
    parts = [
        f'<rect class="void" x="{_LEFT}" y="{_TOP}" width="{_SPAN}" height="{_RISE}"/>',
        *contours.bands(levels),
        *(part for level in levels[1:-1] for part in contours.named(level, f"{level:g}")),
        *(_twice("path", "limit", f'd="{svg.path(*line.T)}"') for line in rim.lines(0.0)),
        *_zone(x, y),
        *_axes(x, y),
        *_here(cup, x, y),
        *scale(levels, label, _LEFT, _HIGH - 26, _SPAN),
    ]
    ends = f' data-pick="{x[0]:g} {x[-1]:g} {y[0]:g} {y[-1]:g}"'
    place = f' data-box="{_LEFT:g} {_TOP:g} {_LEFT + _SPAN:g} {_TOP + _RISE:g}"'
    return svg.picture((_WIDE, _HIGH), _said(found, label, reading), parts, f"{ends}{place}")


def _levels(quantity: str, values: numpy.ndarray, low: float) -> list[float]:
    high = float(numpy.nanmax(values, initial=0.0))
    if quantity == "max_pressure":
        least = float(numpy.nanmin(values, initial=high))
        step = svg.ticks(max(high - least, 1e-9), 6)[1]
        start = numpy.floor(least / step) * step
        return [
            float(start + step * number) for number in range(max(int(numpy.ceil((high - start) / step - 1e-9)), 1) + 1)
        ]
    step = levels_of(max(high - low, 1e-9), 7)[1]
    first, last = int(numpy.floor(low / step)), max(int(numpy.ceil(high / step)), 1)
    return [step * number for number in range(first, last + 1)]


def _across(value: Any, x: numpy.ndarray) -> Any:
    return _LEFT + _SPAN * (value - x[0]) / (x[-1] - x[0])


def _up(value: Any, y: numpy.ndarray) -> Any:
    return _TOP + _RISE * (y[-1] - value) / (y[-1] - y[0])


def _axes(x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    foot, right = _TOP + _RISE, _LEFT + _SPAN
    for value in x[::2]:
        yield svg.line(_across(value, x), foot, _across(value, x), foot + 4, "axis")
        yield svg.text(_across(value, x), foot + 17, f"{value:g}", "tick")
    for value in y[::2]:
        yield svg.line(_LEFT - 4, _up(value, y), _LEFT, _up(value, y), "axis")
        yield svg.text(_LEFT - 7, _up(value, y) + 4, f"{value:g}", "tick", "end")
    yield f'<rect class="frame" x="{_LEFT}" y="{_TOP}" width="{_SPAN}" height="{_RISE}"/>'
    yield svg.text((_LEFT + right) / 2, foot + 34, CUP["inclination"].label(), "label")
    middle = (_TOP + foot) / 2
    yield svg.text(14, middle, CUP["anteversion"].label(), "label", more=f' transform="rotate(-90 14 {middle:g})"')


def _zone(x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    left, right, low, high = LEWINNEK
    at = f'x="{_across(left, x):.1f}" y="{_up(high, y):.1f}"'
    size = f'width="{_across(right, x) - _across(left, x):.1f}" height="{_up(low, y) - _up(high, y):.1f}"'
    yield _twice("rect", "zone", f"{at} {size}")


def _twice(shape: str, kind: str, where: str) -> str:
    """A dark line on a light one: it is seen on every colour."""
    return f'<{shape} class="{kind} below" {where}/><{shape} class="{kind}" {where}/>'


def _here(cup: Cup, x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    inclination, anteversion = degrees(cup.inclination), degrees(cup.anteversion)
    if x[0] <= inclination <= x[-1] and y[0] <= anteversion <= y[-1]:
        yield f'<circle class="here" cx="{_across(inclination, x):.1f}" cy="{_up(anteversion, y):.1f}" r="6"/>'


def _said(found: Stood, label: str, reading: Reading) -> str:
    """The map in a sentence for whoever does not see it."""
    free = found.held & (found.edge_distance > 0)
    if not free.any():
        return f"{label}: in every orientation of the map the contact reaches the rim"
    best = numpy.where(free, found.edge_distance, -numpy.inf)
    row, column = numpy.unravel_index(int(best.argmax()), best.shape)
    place = f"inclination {degrees(found.inclination[row]):.3g}°, anteversion {degrees(found.anteversion[column]):.3g}°"
    share = f"{100 * free.mean():.0f} % of the orientations keep the contact off the rim"
    apart = reading.said(QUANTITIES["edge_distance"], float(best.max()))
    return f"{label} over inclination and anteversion: {share}; furthest, {apart}, at {place}"
