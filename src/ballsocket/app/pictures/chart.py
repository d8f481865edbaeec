"""Several named curves in one chart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ...reports.style import INK, THICK, THIN, LineStyle
from . import svg

_SIZE = (440.0, 300.0)
_X_LEFT, _RIGHT, _TOP, _FOOT = 58.0, 12.0, 10.0, 44.0


@dataclass(frozen=True)
class _ChartArea:
    """Size of a chart in pixels and ends of its axes, which begin at zero."""

    size: tuple[float, float]
    ends: tuple[float, float]

    @property
    def right(self) -> float:
        return self.size[0] - _RIGHT

    @property
    def foot(self) -> float:
        return self.size[1] - _FOOT

    def across(self, value: Any) -> Any:
        return _X_LEFT + (self.right - _X_LEFT) * value / self.ends[0]

    def up(self, value: Any) -> Any:
        return self.foot - (self.foot - _TOP) * value / self.ends[1]


@dataclass(frozen=True, eq=False)
class Curve:
    """Points of one curve, how it is drawn, where it can be trusted, a point to mark on it and a band, if any."""

    x: numpy.ndarray
    y: numpy.ndarray
    line: LineStyle
    trusted: Any = True
    mark: tuple[float, float] | None = None
    band: tuple[numpy.ndarray, numpy.ndarray] | None = None


def colour_of(line: LineStyle) -> str:
    """Return the CSS colour of a line; ink follows the theme."""
    return "var(--text)" if line.colour == INK else line.colour


def dash_of(line: LineStyle, width: float = THICK) -> str:
    """Return width and dashes of a line as attributes; a solid line has no dashes."""
    lengths = " ".join(f"{THICK * length:g}" for length in line.dash)
    return f'stroke-width="{width:g}"' + (f' stroke-dasharray="{lengths}"' if lengths else "")


def chart(
    label: str,
    x: str,
    y: str,
    curves: Mapping[str, Curve],
    ends: tuple[float, float],
    size: tuple[float, float] = _SIZE,
    flagged: Sequence[tuple[float, float]] = (),
) -> str:
    """Draw curves over axes from zero to `ends`, as SVG; `x` and `y` label them.

    Curves are thick where they can be trusted, and thin all the way where not; one without gaps lies below the others.
    Flagged ranges of x are red.
    """
    frame = _ChartArea(size, ends)
    ordered = sorted(curves.items(), key=lambda named: bool(named[1].line.dash))
    lines = "".join(part for name, curve in ordered for part in _drawn(name, curve, frame))
    wide, high = frame.right - _X_LEFT, frame.foot - _TOP
    inside = f'x="{_X_LEFT:g}" y="{_TOP:g}" width="{wide:g}" height="{high:g}"'
    red = (
        f'<rect class="flagged" x="{frame.across(low):.1f}" y="{_TOP:g}" '
        f'width="{max(frame.across(top) - frame.across(low), 1):.1f}" height="{high:g}"/>'
        for low, top in flagged
    )
    area = f'<svg {inside} viewBox="{_X_LEFT:g} {_TOP:g} {wide:g} {high:g}">{lines}</svg>'
    box = f' data-box="{_X_LEFT:g} {_TOP:g} {frame.right:g} {frame.foot:g}"'
    scale = f' data-x="{ends[0]!r}" data-y="{ends[1]!r}" data-across="{escape(x)}" data-up="{escape(y)}"'
    return svg.picture(size, label, [*red, *_axes(x, y, frame), area], f"{scale}{box}")


def _axes(x: str, y: str, frame: _ChartArea) -> Iterator[str]:
    foot, right = frame.foot, frame.right
    for value in svg.ticks_between(0.0, frame.ends[0]):
        position = frame.across(value)
        yield svg.line(position, _TOP, position, foot, "grid")
        yield svg.text(position, foot + 16, f"{value:g}", "tick")
    for value in svg.ticks_between(0.0, frame.ends[1], max(2, round((foot - _TOP) / 40))):
        position = frame.up(value)
        yield svg.line(_X_LEFT, position, right, position, "grid")
        yield svg.text(_X_LEFT - 6, position + 4, f"{value:g}", "tick", "end")
    yield svg.line(_X_LEFT, foot, right, foot, "axis")
    yield svg.line(_X_LEFT, _TOP, _X_LEFT, foot, "axis")
    yield svg.text((_X_LEFT + right) / 2, foot + _FOOT - 8, x, "label")
    middle = (_TOP + foot) / 2
    yield svg.text(14, middle, y, "label", more=f' transform="rotate(-90 14 {middle:g})"')


def _drawn(name: str, curve: Curve, frame: _ChartArea) -> Iterator[str]:
    x, y = frame.across(curve.x), frame.up(curve.y)
    if curve.band is not None:
        low, high = (frame.up(ends) for ends in curve.band)
        outline = svg.closed(numpy.concatenate([x, x[::-1]]), numpy.concatenate([low, high[::-1]]))
        yield f'<path d="{outline}" fill="{colour_of(curve.line)}" opacity="0.2"/>'
    stroke = f'fill="none" stroke="{colour_of(curve.line)}" data-name="{escape(name)}"'
    if numpy.any(curve.trusted):
        yield f'<path d="{svg.path(x, numpy.where(curve.trusted, y, numpy.nan))}" {stroke} {dash_of(curve.line)}/>'
    if not numpy.all(curve.trusted):
        yield f'<path d="{svg.path(x, y)}" {stroke} {dash_of(curve.line, THIN)}/>'
    if curve.mark is not None:
        centre = f'cx="{frame.across(curve.mark[0]):.1f}" cy="{frame.up(curve.mark[1]):.1f}"'
        yield f'<circle {centre} r="4" fill="{colour_of(curve.line)}"/>'


def swatch(line: LineStyle) -> str:
    """Draw a short piece of a line."""
    return (
        f"<svg class='swatch' viewBox='0 0 32 8' aria-hidden='true'><path d='M0 4H32' stroke='{colour_of(line)}' "
        f"{dash_of(line)}/></svg>"
    )


def legend(lines: Mapping[str, LineStyle]) -> str:
    """List the names of curves beside a piece of each, as HTML."""
    return "".join(f"<span class='key'>{swatch(line)}{escape(name)}</span>" for name, line in lines.items())
