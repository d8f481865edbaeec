"""Pictures of the page as SVG: short numbers, paths, texts; colours are the page's own, so that it may be dark."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from math import floor, log10

import numpy


def path(x: numpy.ndarray, y: numpy.ndarray) -> str:
    """Points joined by lines, to a twentieth of a pixel; gaps where one is NaN."""
    words, pen = [], "M"
    for here, there in zip(x.tolist(), y.tolist(), strict=True):
        if here != here or there != there:
            pen = "M"
            continue
        words.append(f"{pen}{here:.1f},{there:.1f}")
        pen = "L"
    return "".join(words)


def closed(x: numpy.ndarray, y: numpy.ndarray) -> str:
    """An outline."""
    return f"{path(x, y)}Z"


def text(x: float, y: float, words: str, kind: str = "", anchor: str = "middle", more: str = "") -> str:
    """Words at a place; `kind` is a class of the page's style."""
    marked = f' class="{kind}"' if kind else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{marked}{more}>{escape(words)}</text>'


def line(x1: float, y1: float, x2: float, y2: float, kind: str, more: str = "") -> str:
    """A straight line."""
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"{more}/>'


def ticks(high: float, most: int = 6) -> list[float]:
    """Round numbers from 0 to `high`, at most so many steps."""
    scale = 10.0 ** floor(log10(high / most))
    step = next(factor * scale for factor in (1, 2, 2.5, 5, 10) if factor * scale * most >= high * (1 - 1e-9))
    return [number * step for number in range(int(high / step * (1 + 1e-9)) + 1)]


def picture(size: tuple[float, float], said: str, parts: Iterable[str], more: str = "") -> str:
    """A whole picture as wide as its place, with what a screen reader says of it."""
    return _whole(size, f'role="img" aria-label="{escape(said)}"{more}', parts)


def group_picture(size: tuple[float, float], said: str, parts: Iterable[str], more: str = "") -> str:
    """A picture whose parts can be used: a screen reader goes into it."""
    return _whole(size, f'role="group" aria-label="{escape(said)}"{more}', parts)


def _whole(size: tuple[float, float], marks: str, parts: Iterable[str]) -> str:
    return f'<svg class="picture" viewBox="0 0 {size[0]:g} {size[1]:g}" {marks}>{"".join(parts)}</svg>'
