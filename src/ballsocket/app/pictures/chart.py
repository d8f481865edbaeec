"""Several named curves in one chart, which the page draws from their numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy

from ...reports.style import LineStyle
from ..widgets.blocks import Block, plain_line

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
            "line": plain_line(self.line),
            "x": plain_numbers(self.x),
            "y": plain_numbers(self.y),
            "trusted": numpy.asarray(self.trusted, dtype=int).tolist(),
            "mark": self.mark and plain_numbers(numpy.array(self.mark)),
            "band": self.band and [plain_numbers(ends) for ends in self.band],
        }


def plain_numbers(values: numpy.ndarray, digits: int = _DIGITS) -> list[float | None]:
    """Return numbers with few digits; None for a missing one."""
    return [float(f"{value:.{digits}g}") if numpy.isfinite(value) else None for value in values.tolist()]


def chart(
    label: str,
    x: str,
    y: str,
    curves: Mapping[str, Curve],
    ends: tuple[float, float],
    size: tuple[float, float] = _SIZE,
    flagged: Sequence[tuple[float, float]] = (),
    start: float = 0.0,
    caption: Sequence[str] = (),
) -> Block:
    """Return curves over axes to `ends`, x from `start`, for `charts`; `x` and `y` label them.

    Curves are thick where they can be trusted, and thin all the way where not; one without gaps lies below the others.
    Flagged ranges of x are red. The `caption` has a sentence, and one in red.
    """
    ordered = sorted(curves.items(), key=lambda named: bool(named[1].line.dash))
    axes = {"label": label, "x": x, "y": y, "start": start, "ends": list(ends), "size": list(size)}
    plain = [curve.plain(name) for name, curve in ordered]
    return {**axes, "flagged": [list(ends) for ends in flagged], "caption": list(caption), "curves": plain}


def charts(*drawn: Block, legend: Sequence[str] | None = None) -> Block:
    """Show charts beside each other, with the names of the first one's curves and further words unless it is None."""
    return {"kind": "charts", "charts": list(drawn), "legend": None if legend is None else list(legend)}


def spans(x: numpy.ndarray, marked: numpy.ndarray) -> list[tuple[float, float]]:
    """List the ranges of increasing values in which points are marked, each half a step wider."""
    steps = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], marked, [0]])))
    half = 0.5 * float(x[-1] - x[0]) / max(len(x) - 1, 1)
    ends = zip(steps[::2], steps[1::2], strict=True)
    return [(float(x[first]) - half, float(x[last - 1]) + half) for first, last in ends]
