"""Design map with contours, limits that are dragged, marks of doubtful points, and the design on the screen."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Any

import numpy

from ....core.quantities import QUANTITIES
from ....studies.limits import Limit, margin_on_plane, relative_margins
from ...pictures import svg
from ...pictures.contour_map import MapPlane, contour_map, outlined
from ...state.screen import Screen
from ...widgets.limit_rows import limit_text, present_value
from ...widgets.reading import Reading
from .worker import allowed_points, axis_label, limits_of

_BELOW_ZERO = -1e300
_MAX_LEVELS = 12


def map_picture(results: Any, screen: Screen) -> str:
    """Draw a map with a ring at the picked point; raise ValueError if it has no result anywhere."""
    axes = screen.across.name, screen.up.name
    label, factor = axis_label(screen.quantity, screen)
    values = results[screen.quantity].transpose(*axes[::-1]).values * factor
    if numpy.isnan(values).all():
        raise ValueError(f"{results.attrs['model']} has no result anywhere on this map: choose another model")
    (x_label, x_factor), (y_label, y_factor) = (axis_label(name, screen) for name in axes)
    plane = MapPlane(
        x=results[axes[0]].values * x_factor, y=results[axes[1]].values * y_factor, x_label=x_label, y_label=y_label
    )
    picked = screen.picked
    x, y = (present_value(screen.file, name) for name in axes)
    marks = [
        *_veil(results, screen, plane),
        *plane.crosses(~results.valid.transpose(*axes[::-1]).values),
        *plane.ring(x * x_factor, y * y_factor, "here"),
        *(() if picked is None else plane.ring(picked[0] * x_factor, picked[1] * y_factor, "picked")),
        *_limit_lines(results, screen, plane),
    ]
    levels = svg.levels_between(float(numpy.nanmin(values)), float(numpy.nanmax(values)), _MAX_LEVELS)
    share = 100 * float(allowed_points(results, screen).mean())
    sentence = f"{label} over {x_label} and {y_label}; {share:.3g} % of the map keep the limits"
    return contour_map(plane, values, levels, (label, sentence), marks, "map.pick")


def _veil(results: Any, screen: Screen, plane: MapPlane) -> Iterator[str]:
    """Fade the part of the map that is undecided, and once more the part that exceeds a limit."""
    for values in relative_margins(results, limits_of(screen), screen.across.name, screen.up.name):
        if outline := plane.contours(values).area(_BELOW_ZERO, 0.0):
            yield f'<path class="veil" fill-rule="evenodd" d="{outline}"/>'


def _limit_lines(results: Any, screen: Screen, plane: MapPlane) -> Iterator[str]:
    """Draw each limit that crosses the map as a line with a handle at its middle."""
    for number, limit in enumerate(limits_of(screen)):
        lines = plane.contours(margin_on_plane(results, limit, screen.across.name, screen.up.name).value).lines(0.0)
        yield from (outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in lines)
        if lines:
            longest = max(lines, key=len)
            yield _handle(number, screen.limits[number], longest[len(longest) // 2], screen.reading)


def _handle(number: int, limit: Limit, point: numpy.ndarray, reading: Reading) -> str:
    """Draw the square of a limit, a slider for mouse, keyboard and screen readers."""
    quantity, text = QUANTITIES[limit.name], limit_text(limit, reading)
    value = (limit.high if numpy.isfinite(limit.high) else limit.low) * reading.unit(quantity).factor
    step = svg.round_step(abs(value) or 1.0, 50)
    right = point[0] < 240
    slider = f'role="slider" aria-label="{escape(quantity.title)}" aria-valuenow="{value:.6g}"'
    return (
        f'<g tabindex="0" {slider} aria-valuetext="{escape(text)}" data-limit="{number}" data-step="{step:g}"'
        f' transform="translate({point[0]:.1f} {point[1]:.1f})">'
        f'<rect class="square" x="-6" y="-6" width="12" height="12"/>'
        f"{svg.text(11 if right else -11, -6, text, 'on', 'start' if right else 'end')}</g>"
    )
