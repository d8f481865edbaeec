"""Several named curves in one chart, which the page draws from their numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ...reports.style import INK, THICK, LineStyle
from ...reports.svg import attribute

_SIZE = (440.0, 300.0)
_DIGITS = 4  # digits of the numbers of a curve: a pixel is more


@dataclass(frozen=True, eq=False)
class Curve:
    """Points of one curve, how it is drawn, where it can be trusted, a point to mark on it and a band, if any."""

    x: numpy.ndarray
    y: numpy.ndarray
    line: LineStyle
    trusted: Any = True
    mark: tuple[float, float] | None = None
    band: tuple[numpy.ndarray, numpy.ndarray] | None = None

    def plain(self, name: str) -> dict[str, Any]:
        """Return the curve as numbers; None for a gap."""
        return {
            "name": name,
            "colour": _colour_of(self.line),
            "dash": _dash_of(self.line),
            "x": plain_numbers(self.x),
            "y": plain_numbers(self.y),
            "trusted": numpy.asarray(self.trusted, dtype=int).tolist(),
            "mark": self.mark and plain_numbers(numpy.array(self.mark)),
            "band": self.band and [plain_numbers(ends) for ends in self.band],
        }


def plain_numbers(values: numpy.ndarray, digits: int = _DIGITS) -> list[float | None]:
    """Return numbers with few digits; None for a missing one."""
    return [float(f"{value:.{digits}g}") if numpy.isfinite(value) else None for value in values.tolist()]


def _colour_of(line: LineStyle) -> str:
    """Return the CSS colour of a line; ink follows the theme."""
    return "var(--text)" if line.colour == INK else line.colour


def _dash_of(line: LineStyle) -> str:
    """Return the dashes of a line in pixels; empty for a solid line."""
    return " ".join(f"{THICK * length:g}" for length in line.dash)


def chart(
    label: str,
    x: str,
    y: str,
    curves: Mapping[str, Curve],
    ends: tuple[float, float],
    size: tuple[float, float] = _SIZE,
    flagged: Sequence[tuple[float, float]] = (),
    start: float = 0.0,
) -> str:
    """Return the element in which a script draws curves over axes to `ends`, x from `start`; `x` and `y` label them.

    Curves are thick where they can be trusted, and thin all the way where not; one without gaps lies below the others.
    Flagged ranges of x are red.
    """
    ordered = sorted(curves.items(), key=lambda named: bool(named[1].line.dash))
    red = [list(ends) for ends in flagged]
    data = {"label": label, "x": x, "y": y, "start": start, "ends": ends, "size": size, "flagged": red}
    return f"<div {attribute('chart', {**data, 'curves': [curve.plain(name) for name, curve in ordered]})}></div>"


def spans(x: numpy.ndarray, marked: numpy.ndarray) -> list[tuple[float, float]]:
    """List the ranges of increasing values in which points are marked, each half a step wider."""
    steps = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], marked, [0]])))
    half = 0.5 * float(x[-1] - x[0]) / max(len(x) - 1, 1)
    ends = zip(steps[::2], steps[1::2], strict=True)
    return [(float(x[first]) - half, float(x[last - 1]) + half) for first, last in ends]


def swatch(line: LineStyle) -> str:
    """Draw a short piece of a line."""
    return (
        f"<svg class='swatch' viewBox='0 0 32 8' aria-hidden='true'><path d='M0 4H32' stroke='{_colour_of(line)}' "
        f"stroke-width='{THICK:g}' stroke-dasharray='{_dash_of(line)}'/></svg>"
    )


def legend(lines: Mapping[str, LineStyle]) -> str:
    """List the names of curves beside a piece of each, as HTML."""
    return "".join(f"<span class='key'>{swatch(line)}{escape(name)}</span>" for name, line in lines.items())
