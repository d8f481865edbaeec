"""Fields over a plane as bands of colour and lines, for pictures in SVG."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy
from contourpy import FillType, LineType, contour_generator

from . import svg
from .drawing import heat

Numbers = numpy.ndarray


class Contours:
    """A field by its values at places of a picture.

    Parameters
    ----------
    x, y : array (rows, columns)
        In pixels.
    values : array (rows, columns)
        NaN where there are none.
    """

    def __init__(self, x: Numbers, y: Numbers, values: Numbers) -> None:
        masked = numpy.ma.masked_invalid(values)
        kinds: Any = {"fill_type": FillType.OuterOffset, "line_type": LineType.Separate}
        self._made: Any = contour_generator(x, y, masked, corner_mask=True, **kinds)

    def area(self, low: float, high: float) -> str:
        """The outline of where values lie between two numbers, as the data of a path; empty where none does."""
        points, offsets = self._made.filled(low, high)
        rings = (ring for each, ends in zip(points, offsets, strict=True) for ring in numpy.split(each, ends[1:-1]))
        return "".join(svg.closed(*ring.T) for ring in rings)

    def lines(self, level: float) -> list[Numbers]:
        """The lines on which a field has a value, each (points, 2)."""
        return list(self._made.lines(level))

    def bands(self, levels: Sequence[float]) -> Iterator[str]:
        """A path for each pair of neighbours among the levels, in colours from low to high."""
        last = len(levels) - 2
        for number, (low, high) in enumerate(pairwise(levels)):
            if outline := self.area(low, high):
                yield f'<path fill="{heat(number / max(last, 1))}" fill-rule="evenodd" d="{outline}"/>'

    def named(self, level: float, words: str) -> Iterator[str]:
        """The lines of a level, each long one with its value."""
        for line in self.lines(level):
            yield f'<path class="level" d="{svg.path(*line.T)}"/>'
            length = numpy.hypot(*numpy.diff(line, axis=0).T).sum()
            if length > 60:
                x, y = line[len(line) // 2]
                yield svg.text(x, y + 4, words, "on")


def scale(levels: Sequence[float], label: str, x: float, y: float, wide: float) -> Iterator[str]:
    """A row of colours with the numbers between them, and what they are above it."""
    count = len(levels) - 1
    yield svg.text(x, y - 6, label, "tick", "start")
    for number in range(count):
        fill = heat(number / max(count - 1, 1))
        size = f'width="{wide / count + 0.4:.1f}" height="9"'
        yield f'<rect x="{x + wide * number / count:.1f}" y="{y:.1f}" {size} fill="{fill}"/>'
    for number, level in enumerate(levels):
        yield svg.text(x + wide * number / count, y + 22, f"{level:.4g}", "tick")


def levels_of(high: float, most: int = 8) -> list[float]:
    """Round levels from 0 to at least `high`."""
    found = svg.ticks(high, most)
    return found if found[-1] >= high * (1 - 1e-9) else [*found, found[-1] + found[1]]
