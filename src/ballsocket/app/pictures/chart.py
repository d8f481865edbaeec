"""Several named curves in one chart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ...reports.style import INK, THICK, THIN, LineStyle
from . import svg

_WIDE, _HIGH = 440.0, 300.0
_X_LEFT, _RIGHT, _TOP, _FOOT = 58.0, 12.0, 10.0, 44.0
_INSIDE = (
    f'x="{_X_LEFT:g}" y="{_TOP:g}" width="{_WIDE - _X_LEFT - _RIGHT:g}" height="{_HIGH - _TOP - _FOOT:g}" '
    f'viewBox="{_X_LEFT:g} {_TOP:g} {_WIDE - _X_LEFT - _RIGHT:g} {_HIGH - _TOP - _FOOT:g}"'
)
"""Area of the curves, which are cut off at its edges."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Points of one curve, where they can be trusted, how it is drawn, a point to mark on it and a band, if any."""

    x: numpy.ndarray
    y: numpy.ndarray
    trusted: numpy.ndarray
    line: LineStyle
    mark: tuple[float, float] | None = None
    band: tuple[numpy.ndarray, numpy.ndarray] | None = None


def colour_of(line: LineStyle) -> str:
    """Return the CSS colour of a line; ink follows the theme."""
    return "var(--text)" if line.colour == INK else line.colour


def dash_of(line: LineStyle, width: float = THICK) -> str:
    """Width and dashes of a line, as attributes; no dashes for one drawn through."""
    lengths = " ".join(f"{THICK * length:g}" for length in line.dash)
    return f'stroke-width="{width:g}"' + (f' stroke-dasharray="{lengths}"' if lengths else "")


def chart(label: str, x: str, y: str, curves: Mapping[str, Curve], ends: tuple[float, float]) -> str:
    """Draw curves over axes from zero to `ends`, as SVG; `x` and `y` label them.

    Curves are thick where they can be trusted, and thin all the way where not; one without gaps lies below the others.
    """
    across, up = ends
    ordered = sorted(curves.items(), key=lambda named: bool(named[1].line.dash))
    lines = "".join(part for name, curve in ordered for part in _drawn(name, curve, across, up))
    parts = [*_axes(x, y, across, up), f"<svg {_INSIDE}>{lines}</svg>"]
    scale = f' data-x="{across!r}" data-y="{up!r}" data-box="{_X_LEFT:g} {_TOP:g} {_WIDE - _RIGHT:g} {_HIGH - _FOOT:g}"'
    labels = f' data-across="{escape(x)}" data-up="{escape(y)}"'
    return svg.picture((_WIDE, _HIGH), label, parts, f"{scale}{labels}")


def _across(value: Any, end: float) -> Any:
    return _X_LEFT + (_WIDE - _X_LEFT - _RIGHT) * value / end


def _up(value: Any, end: float) -> Any:
    return _HIGH - _FOOT - (_HIGH - _FOOT - _TOP) * value / end


def _axes(x: str, y: str, across: float, up: float) -> Iterator[str]:
    foot, right = _HIGH - _FOOT, _WIDE - _RIGHT
    for value in svg.ticks(across):
        position = _across(value, across)
        yield svg.line(position, _TOP, position, foot, "grid")
        yield svg.text(position, foot + 16, f"{value:g}", "tick")
    for value in svg.ticks(up):
        position = _up(value, up)
        yield svg.line(_X_LEFT, position, right, position, "grid")
        yield svg.text(_X_LEFT - 6, position + 4, f"{value:g}", "tick", "end")
    yield svg.line(_X_LEFT, foot, right, foot, "axis")
    yield svg.line(_X_LEFT, _TOP, _X_LEFT, foot, "axis")
    yield svg.text((_X_LEFT + right) / 2, _HIGH - 8, x, "label")
    middle = (_TOP + foot) / 2
    yield svg.text(14, middle, y, "label", more=f' transform="rotate(-90 14 {middle:g})"')


def _drawn(name: str, curve: Curve, across: float, up: float) -> Iterator[str]:
    x, y = _across(curve.x, across), _up(curve.y, up)
    if curve.band is not None:
        low, high = (_up(ends, up) for ends in curve.band)
        outline = svg.closed(numpy.concatenate([x, x[::-1]]), numpy.concatenate([low, high[::-1]]))
        yield f'<path d="{outline}" fill="{colour_of(curve.line)}" opacity="0.2"/>'
    stroke = f'fill="none" stroke="{colour_of(curve.line)}" data-name="{escape(name)}"'
    if curve.trusted.any():
        yield f'<path d="{svg.path(x, numpy.where(curve.trusted, y, numpy.nan))}" {stroke} {dash_of(curve.line)}/>'
    if not curve.trusted.all():
        yield f'<path d="{svg.path(x, y)}" {stroke} {dash_of(curve.line, THIN)}/>'
    if curve.mark is not None:
        centre = f'cx="{_across(curve.mark[0], across):.1f}" cy="{_up(curve.mark[1], up):.1f}"'
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
