"""SVG pictures of the page: paths, texts, ticks, colours and contours; colours follow the theme."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import pairwise
from math import floor, log10
from typing import Any

import numpy
from contourpy import FillType, LineType, contour_generator


def path(x: numpy.ndarray, y: numpy.ndarray) -> str:
    """Join points by lines, with gaps at NaN."""
    words, pen = [], "M"
    for here, there in zip(x.tolist(), y.tolist(), strict=True):
        if here != here or there != there:
            pen = "M"
            continue
        words.append(f"{pen}{here:.1f},{there:.1f}")
        pen = "L"
    return "".join(words)


def closed(x: numpy.ndarray, y: numpy.ndarray) -> str:
    """Return a closed outline."""
    return f"{path(x, y)}Z"


def text(x: float, y: float, words: str, kind: str = "", anchor: str = "middle", more: str = "") -> str:
    """Write text; `kind` is a class of the page's style."""
    marked = f' class="{kind}"' if kind else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{marked}{more}>{escape(words)}</text>'


def line(x1: float, y1: float, x2: float, y2: float, kind: str, more: str = "") -> str:
    """Draw a straight line."""
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"{more}/>'


def ticks(high: float, max_steps: int = 6) -> list[float]:
    """Return round numbers from 0 to `high`, with a limited number of steps."""
    scale = 10.0 ** floor(log10(high / max_steps))
    step = next(factor * scale for factor in (1, 2, 2.5, 5, 10) if factor * scale * max_steps >= high * (1 - 1e-9))
    return [number * step for number in range(int(high / step * (1 + 1e-9)) + 1)]


def picture(size: tuple[float, float], label: str, parts: Iterable[str], more: str = "") -> str:
    """Return a picture of full width with a label for screen readers."""
    return _svg_element(size, f'role="img" aria-label="{escape(label)}"{more}', parts)


def group_picture(size: tuple[float, float], label: str, parts: Iterable[str], more: str = "") -> str:
    """Return a picture with interactive parts, which screen readers can enter."""
    return _svg_element(size, f'role="group" aria-label="{escape(label)}"{more}', parts)


def _svg_element(size: tuple[float, float], marks: str, parts: Iterable[str]) -> str:
    return f'<svg class="picture" viewBox="0 0 {size[0]:g} {size[1]:g}" {marks}>{"".join(parts)}</svg>'


Numbers = numpy.ndarray


_HEAT = numpy.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])
"""Five colours of viridis, from low to high."""


def heat(share: float) -> str:
    """Return a colour for a value from 0 to 1."""
    stops = numpy.linspace(0.0, 1.0, len(_HEAT))
    red, green, blue = (round(float(numpy.interp(share, stops, column))) for column in _HEAT.T)
    return f"#{red:02x}{green:02x}{blue:02x}"


class Contours:
    """Contours of `values` (rows, columns) at pixels `x` and `y` of the same shape; NaN cuts them off."""

    def __init__(self, x: Numbers, y: Numbers, values: Numbers) -> None:
        masked = numpy.ma.masked_invalid(values)
        kinds: Any = {"fill_type": FillType.OuterOffset, "line_type": LineType.Separate}
        self._made: Any = contour_generator(x, y, masked, corner_mask=True, **kinds)

    def area(self, low: float, high: float) -> str:
        """Return the outline of values between two levels as path data; empty without such values."""
        points, offsets = self._made.filled(low, high)
        rings = (
            ring
            for ring_points, ends in zip(points, offsets, strict=True)
            for ring in numpy.split(ring_points, ends[1:-1])
        )
        return "".join(closed(*ring.T) for ring in rings)

    def lines(self, level: float) -> list[Numbers]:
        """Return the lines of a level, each (points, 2)."""
        return list(self._made.lines(level))

    def bands(self, levels: Sequence[float]) -> Iterator[str]:
        """Draw a path for each pair of neighbouring levels, coloured from low to high."""
        last = len(levels) - 2
        for number, (low, high) in enumerate(pairwise(levels)):
            if outline := self.area(low, high):
                yield f'<path fill="{heat(number / max(last, 1))}" fill-rule="evenodd" d="{outline}"/>'

    def named(self, level: float, words: str) -> Iterator[str]:
        """Draw the lines of a level, with its value on each long one."""
        for line in self.lines(level):
            yield f'<path class="level" d="{path(*line.T)}"/>'
            length = numpy.hypot(*numpy.diff(line, axis=0).T).sum()
            if length > 60:
                x, y = line[len(line) // 2]
                yield text(x, y + 4, words, "on")


def scale(levels: Sequence[float], label: str, x: float, y: float, wide: float) -> Iterator[str]:
    """Draw a row of colours with numbers between them and a label above."""
    count = len(levels) - 1
    yield text(x, y - 6, label, "tick", "start")
    for number in range(count):
        fill = heat(number / max(count - 1, 1))
        size = f'width="{wide / count + 0.4:.1f}" height="9"'
        yield f'<rect x="{x + wide * number / count:.1f}" y="{y:.1f}" {size} fill="{fill}"/>'
    for number, level in enumerate(levels):
        yield text(x + wide * number / count, y + 22, f"{level:.4g}", "tick")


def levels_of(high: float, max_steps: int = 8) -> list[float]:
    """Round levels from 0 to at least `high`."""
    levels = ticks(high, max_steps)
    return levels if levels[-1] >= high * (1 - 1e-9) else [*levels, levels[-1] + levels[1]]
