"""Contour map of a field over two numbers, on which a point is picked by mouse or keyboard."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ...core.checks import check_number, shown
from ...reports import svg
from ...reports.svg import Contours

_WIDTH, _HEIGHT = 440.0, 400.0
_LEFT, _RIGHT, _TOP, _FOOT = 58.0, 14.0, 12.0, 92.0
_SPAN, _RISE = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _FOOT
_FRAME = f'x="{_LEFT:g}" y="{_TOP:g}" width="{_SPAN:g}" height="{_RISE:g}"'
_MAX_SAMPLES = 31  # values an axis that the browser receives for the number under the pointer


@dataclass(frozen=True, kw_only=True, eq=False)
class MapPlane:
    """Increasing values of two numbers and the labels of their axes, in the units of the page."""

    x: numpy.ndarray
    y: numpy.ndarray
    x_label: str
    y_label: str

    def across(self, value: Any) -> Any:
        """Return the horizontal picture coordinate of a value."""
        return _LEFT + _SPAN * (value - self.x[0]) / (self.x[-1] - self.x[0])

    def up(self, value: Any) -> Any:
        """Return the vertical picture coordinate of a value."""
        return _TOP + _RISE * (self.y[-1] - value) / (self.y[-1] - self.y[0])

    def contours(self, values: numpy.ndarray) -> Contours:
        """Return the contours of values (y, x) in picture coordinates; NaN cuts them off."""
        x, y = numpy.meshgrid(self.across(self.x), self.up(self.y))
        return Contours(x, y, values)

    def ring(self, x: float, y: float, kind: str) -> Iterator[str]:
        """Draw a ring around a point on the map."""
        if self.x[0] <= x <= self.x[-1] and self.y[0] <= y <= self.y[-1]:
            yield f'<circle class="{kind}" cx="{self.across(x):.1f}" cy="{self.up(y):.1f}" r="6"/>'

    def crosses(self, marked: numpy.ndarray) -> Iterator[str]:
        """Draw crosses on some of the marked points of a mask (y, x)."""
        rows, columns = (numpy.arange(size)[size // 30 :: max(1, round(size / 15))] for size in marked.shape)
        which = numpy.nonzero(marked[numpy.ix_(rows, columns)])
        points = zip(self.across(self.x[columns[which[1]]]), self.up(self.y[rows[which[0]]]), strict=True)
        lines = "".join(f"M{x - 3:.1f},{y - 3:.1f}l6,6m0,-6l-6,6" for x, y in points)
        if lines:
            yield outlined("path", "doubt", f'd="{lines}"')


def read_point(value: Any, count: int) -> list[float]:
    """Read the numbers that a browser reports of a point of a map; raise ValueError for other values."""
    numbers = value if isinstance(value, list) else []
    if len(numbers) != count or not all(isinstance(number, int | float) for number in numbers):
        raise ValueError(f"{shown(value)} is not a point of the map")
    return [check_number("a number of the point", number) for number in numbers]


def outlined(shape: str, kind: str, attributes: str) -> str:
    """Draw a dark line on a light one, visible on every colour."""
    return f'<{shape} class="{kind} below" {attributes}/><{shape} class="{kind}" {attributes}/>'


def contour_map(
    plane: MapPlane,
    values: numpy.ndarray,
    levels: Sequence[float],
    labels: tuple[str, str],
    marks: Iterable[str],
    event: str,
    veils: Iterable[str] = (),
) -> str:
    """Draw values (y, x) in colours, below veils, with axes, a colour scale and marks on top.

    `labels` are the label of the values and a sentence for screen readers. The browser reports a picked point as the
    `event` with its two numbers.
    """
    contours = plane.contours(values)
    samples = [numpy.linspace(0, size - 1, min(size, _MAX_SAMPLES)).round().astype(int) for size in values.shape]
    rows = [
        [float(f"{value:.4g}") if numpy.isfinite(value) else None for value in row]
        for row in values[numpy.ix_(*samples)]
    ]
    ends = " ".join(f"{end:.9g}" for end in (plane.x[0], plane.x[-1], plane.y[0], plane.y[-1]))
    names = escape(json.dumps([plane.x_label, plane.y_label, labels[0]], ensure_ascii=False))
    data = (  # from which a script finds the numbers of a point
        f' data-pick="{event}" data-ends="{ends}" data-values="{json.dumps(rows, separators=(",", ":"))}"'
        f' data-frame="{_LEFT:g} {_TOP:g} {_LEFT + _SPAN:g} {_TOP + _RISE:g}" data-labels="{names}"'
    )
    parts = [
        f'<rect class="void" {_FRAME}/>',
        *contours.bands(levels),
        *veils,
        *(part for level in levels[1:-1] if level for part in contours.named(level, f"{level:.4g}")),  # 0 is a limit
        *_axes(plane),
        *marks,
        '<g class="cursor" tabindex="0" role="button"><path class="cross halo" d="M-9,0H9M0,-9V9"/>'
        '<path class="cross" d="M-9,0H9M0,-9V9"/></g>',
        *svg.scale(levels, labels[0], _LEFT, _HEIGHT - 26, _SPAN),
    ]
    return svg.picture((_WIDTH, _HEIGHT), labels[1], parts, data, "group")


def _axes(plane: MapPlane) -> Iterator[str]:
    foot, right, middle = _TOP + _RISE, _LEFT + _SPAN, _TOP + _RISE / 2
    for value in svg.ticks_between(plane.x[0], plane.x[-1]):
        x = plane.across(value)
        yield svg.line(x, foot, x, foot + 4, "axis")
        yield svg.text(x, foot + 17, f"{value:.6g}", "tick")
    for value in svg.ticks_between(plane.y[0], plane.y[-1]):
        y = plane.up(value)
        yield svg.line(_LEFT - 4, y, _LEFT, y, "axis")
        yield svg.text(_LEFT - 7, y + 4, f"{value:.6g}", "tick", "end")
    yield f'<rect class="frame" {_FRAME}/>'
    yield svg.text((_LEFT + right) / 2, foot + 34, plane.x_label, "label")
    yield svg.text(14, middle, plane.y_label, "label", more=f' transform="rotate(-90 14 {middle:g})"')
