"""Map of a contact over the orientations of its cup."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import Any

import numpy

from ....core.quantities import CUP, QUANTITIES
from ....problem.cup import Cup
from ...pictures import svg
from ...pictures.bore import METRIC
from ...pictures.svg import Contours, levels_of, scale
from ...widgets.reading import Reading
from .worker import LEWINNEK, Stood

_ANGLES_WIDTH, _ANGLES_HEIGHT = 440.0, 400.0
_X_LEFT, _RIGHT, _TOP, _FOOT = 58.0, 14.0, 12.0, 92.0
_SPAN, _RISE = _ANGLES_WIDTH - _X_LEFT - _RIGHT, _ANGLES_HEIGHT - _TOP - _FOOT


def angle_map(orientations: Stood, cup: Cup, quantity: str, reading: Reading = METRIC) -> str:
    """Draw a field over inclination and anteversion, with the present cup and Lewinnek's zone."""
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    factor = reading.unit(QUANTITIES[quantity]).factor
    values = numpy.where(orientations.held, getattr(orientations, quantity), numpy.nan).T * factor
    finite = numpy.where(numpy.isfinite(values), values, numpy.nan)
    across, up = numpy.meshgrid(_across(x, x), _up(y, y))
    contours = Contours(across, up, finite)
    low = min(float(numpy.nanmin(finite, initial=0.0)), 0.0)
    levels = _levels(quantity, finite, low)
    rim = Contours(across, up, numpy.where(orientations.held, orientations.edge_distance, numpy.nan).T)
    label = reading.label(QUANTITIES[quantity])
    parts = [
        f'<rect class="void" x="{_X_LEFT}" y="{_TOP}" width="{_SPAN}" height="{_RISE}"/>',
        *contours.bands(levels),
        *(part for level in levels[1:-1] for part in contours.named(level, f"{level:g}")),
        *(_outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in rim.lines(0.0)),
        *_lewinnek_zone(x, y),
        *_axes(x, y),
        *_current_cup(cup, x, y),
        *scale(levels, label, _X_LEFT, _ANGLES_HEIGHT - 26, _SPAN),
    ]
    ends = f' data-pick="{x[0]:g} {x[-1]:g} {y[0]:g} {y[-1]:g}"'
    box = f' data-box="{_X_LEFT:g} {_TOP:g} {_X_LEFT + _SPAN:g} {_TOP + _RISE:g}"'
    return svg.picture(
        (_ANGLES_WIDTH, _ANGLES_HEIGHT), _map_description(orientations, label, reading), parts, f"{ends}{box}"
    )


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
    return _X_LEFT + _SPAN * (value - x[0]) / (x[-1] - x[0])


def _up(value: Any, y: numpy.ndarray) -> Any:
    return _TOP + _RISE * (y[-1] - value) / (y[-1] - y[0])


def _axes(x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    foot, right = _TOP + _RISE, _X_LEFT + _SPAN
    for value in x[::2]:
        yield svg.line(_across(value, x), foot, _across(value, x), foot + 4, "axis")
        yield svg.text(_across(value, x), foot + 17, f"{value:g}", "tick")
    for value in y[::2]:
        yield svg.line(_X_LEFT - 4, _up(value, y), _X_LEFT, _up(value, y), "axis")
        yield svg.text(_X_LEFT - 7, _up(value, y) + 4, f"{value:g}", "tick", "end")
    yield f'<rect class="frame" x="{_X_LEFT}" y="{_TOP}" width="{_SPAN}" height="{_RISE}"/>'
    yield svg.text((_X_LEFT + right) / 2, foot + 34, CUP["inclination"].label(), "label")
    middle = (_TOP + foot) / 2
    yield svg.text(14, middle, CUP["anteversion"].label(), "label", more=f' transform="rotate(-90 14 {middle:g})"')


def _lewinnek_zone(x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    x_low, x_high, low, high = LEWINNEK
    at = f'x="{_across(x_low, x):.1f}" y="{_up(high, y):.1f}"'
    size = f'width="{_across(x_high, x) - _across(x_low, x):.1f}" height="{_up(low, y) - _up(high, y):.1f}"'
    yield _outlined("rect", "zone", f"{at} {size}")


def _outlined(shape: str, kind: str, where: str) -> str:
    """Draw a dark line on a light one, visible on every colour."""
    return f'<{shape} class="{kind} below" {where}/><{shape} class="{kind}" {where}/>'


def _current_cup(cup: Cup, x: numpy.ndarray, y: numpy.ndarray) -> Iterator[str]:
    inclination, anteversion = degrees(cup.inclination), degrees(cup.anteversion)
    if x[0] <= inclination <= x[-1] and y[0] <= anteversion <= y[-1]:
        yield f'<circle class="here" cx="{_across(inclination, x):.1f}" cy="{_up(anteversion, y):.1f}" r="6"/>'


def _map_description(orientations: Stood, label: str, reading: Reading) -> str:
    """Describe the map in a sentence for screen readers."""
    free = orientations.held & (orientations.edge_distance > 0)
    if not free.any():
        return f"{label}: in every orientation of the map the contact reaches the rim"
    best = numpy.where(free, orientations.edge_distance, -numpy.inf)
    row, column = numpy.unravel_index(int(best.argmax()), best.shape)
    inclination, anteversion = degrees(orientations.inclination[row]), degrees(orientations.anteversion[column])
    share = f"{100 * free.mean():.0f} % of the orientations keep the contact off the rim"
    apart = reading.with_unit(QUANTITIES["edge_distance"], float(best.max()))
    return (
        f"{label} over inclination and anteversion: {share}; furthest, {apart}, at "
        f"inclination {inclination:.3g}°, anteversion {anteversion:.3g}°"
    )
