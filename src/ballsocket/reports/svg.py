"""SVG pictures: paths, texts, ticks, colours and contours; other colours are those of the style of a page."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from itertools import pairwise
from math import ceil, floor, log10
from typing import Any

import numpy

Numbers = numpy.ndarray
_STEPS = 240
_DIGIT_WIDTH = 12.0  # pixels of a digit in a number below a row of colours in the largest type, with space between


def attribute(name: str, data: Any) -> str:
    """Return plain data as the attribute "data-<name>" of an element, for a script."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("&", "&amp;").replace("'", "&#39;")
    return f"data-{name}='{text}'"


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


def rounded_up(value: float, factors: Iterable[float] = (1, 2, 2.5, 5, 10)) -> float:
    """Round a positive number up to one of some factors, from 1 to 10, times a power of ten."""
    scale = 10.0 ** floor(log10(value))
    return next(factor * scale for factor in factors if factor * scale >= value * (1 - 1e-9))


def ticks_between(low: float, high: float, max_steps: int = 6) -> list[float]:
    """Return the multiples of a round step from `low` to `high`."""
    step = rounded_up((high - low) / max_steps)
    first, last = ceil(low / step - 1e-9), floor(high / step * (1 + 1e-9))
    return [number * step for number in range(first, last + 1)]


def levels_between(low: float, high: float, max_steps: int = 8) -> list[float]:
    """Return at least two round levels that enclose the values from `low` to `high`."""
    step = rounded_up((high - low or abs(high) or 1.0) / max_steps)
    first, last = floor(low / step + 1e-9), ceil(high / step - 1e-9)
    return [number * step for number in range(first, max(last, first + 1) + 1)]


def picture(size: tuple[float, float], label: str, parts: Iterable[str], more: str = "", role: str = "img") -> str:
    """Return a picture of full width with a label for screen readers, which can enter one of the role "group"."""
    marks = f'role="{role}" aria-label="{escape(label)}"{more}'
    return f'<svg class="picture" viewBox="0 0 {size[0]:g} {size[1]:g}" {marks}>{"".join(parts)}</svg>'


_THEMED = {"#000000": "var(--text)", "#333333": "var(--quiet)", "#ffffff": "var(--paper)"}
_DIGITS = re.compile(r"(\d\.\d\d)\d+")  # a hundredth of a point is enough
_OUTSIDE = re.compile(r"^.*?(?=<svg )|<metadata>.*?</metadata>|<style.*?</style>|<!--.*?-->", re.DOTALL)


def themed(document: bytes, label: str) -> str:
    """Return an SVG document of matplotlib as a picture of a page whose ink and paper follow the theme."""
    text = _DIGITS.sub(r"\1", _OUTSIDE.sub("", document.decode("utf-8")))
    for colour, variable in _THEMED.items():
        text = text.replace(colour, variable)
    marks = f'class="picture" role="img" aria-label="{escape(label)}" style="fill: var(--text)"'
    return text.replace("<svg ", f"<svg {marks} ", 1)


def _colours(*stops: tuple[int, int, int]) -> list[str]:
    """List colours in even steps from the first of five stops (red, green, blue) to the last."""
    place = numpy.linspace(0.0, len(stops) - 1, _STEPS + 1)
    parts = (numpy.interp(place, range(len(stops)), part).round().astype(int) for part in zip(*stops, strict=True))
    return ["#{:02x}{:02x}{:02x}".format(*colour) for colour in zip(*parts, strict=True)]


_HEAT = _colours((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))
"""Colours of viridis, from low to high."""

_SIGNED = _colours((178, 24, 43), (244, 165, 130), (247, 247, 247), (146, 197, 222), (33, 102, 172))
"""Colours from red for negative values over white to blue for positive ones."""


def heat(share: float, colours: Sequence[str] = _HEAT) -> str:
    """Return a colour for a value from 0 to 1."""
    return colours[round(_STEPS * min(max(share, 0.0), 1.0))]


def band_colours(levels: Sequence[float]) -> list[str]:
    """Return the colour of each band between levels: white at zero where the levels have both signs."""
    if levels[0] < 0 < levels[-1]:
        end = max(-levels[0], levels[-1])
        return [heat(0.5 + 0.25 * (low + high) / end, _SIGNED) for low, high in pairwise(levels)]
    last = len(levels) - 2
    return [heat(number / max(last, 1)) for number in range(len(levels) - 1)]


class Contours:
    """Contours of `values` (rows, columns) at pixels `x` and `y` of the same shape; NaN cuts them off."""

    def __init__(self, x: Numbers, y: Numbers, values: Numbers) -> None:
        from contourpy import FillType, LineType, contour_generator

        masked = numpy.ma.masked_invalid(values)
        kinds: Any = {"fill_type": FillType.OuterOffset, "line_type": LineType.Separate}
        self._made: Any = contour_generator(x, y, masked, corner_mask=True, **kinds)

    def area(self, low: float, high: float) -> str:
        """Return the outline of values between two levels as path data; empty without such values."""
        areas = zip(*self._made.filled(low, high), strict=True)
        rings = (ring for points, ends in areas for ring in numpy.split(points, ends[1:-1]))
        return "".join(closed(*ring.T) for ring in rings)

    def lines(self, level: float) -> list[Numbers]:
        """Return the lines of a level, each (points, 2)."""
        return list(self._made.lines(level))

    def bands(self, levels: Sequence[float]) -> Iterator[str]:
        """Draw a path for each pair of neighbouring levels, coloured from low to high."""
        for colour, (low, high) in zip(band_colours(levels), pairwise(levels), strict=True):
            if outline := self.area(low, high):
                yield f'<path fill="{colour}" fill-rule="evenodd" d="{outline}"/>'

    def named(self, level: float, words: str) -> Iterator[str]:
        """Draw the lines of a level, with its value on each long one."""
        for line in self.lines(level):
            yield f'<path class="level" d="{path(*line.T)}"/>'
            length = numpy.hypot(*numpy.diff(line, axis=0).T).sum()
            if length > 60:
                x, y = line[len(line) // 2]
                yield text(x, y + 4, words, "on")


def scale(levels: Sequence[float], label: str, x: float, y: float, wide: float) -> Iterator[str]:
    """Draw a row of colours with numbers between them and a label above; every second number where they are long."""
    count, numbers = len(levels) - 1, [f"{level:.4g}" for level in levels]
    stride = 1 if max(map(len, numbers)) * _DIGIT_WIDTH < wide / count else 2
    yield text(x, y - 6, label, "tick", "start")
    for number, fill in enumerate(band_colours(levels)):
        size = f'width="{wide / count + 0.4:.1f}" height="9"'
        yield f'<rect x="{x + wide * number / count:.1f}" y="{y:.1f}" {size} fill="{fill}"/>'
    for number, words in [*enumerate(numbers)][::stride]:
        yield text(x + wide * number / count, y + 22, words, "tick")
