"""Several named curves in one chart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy
from bokeh.models import ColumnDataSource, HoverTool

from ..output.style import THICK, THIN, Line
from .look import Palette, chart, colour_of, dash_of, from_zero


@dataclass(frozen=True, eq=False)
class Curve:
    """Points of one curve, where they can be trusted, how it is drawn, and a point to mark on it, if any."""

    x: numpy.ndarray
    y: numpy.ndarray
    trusted: numpy.ndarray
    line: Line
    mark: tuple[float, float] | None = None


class CurveChart:
    """A chart whose curves are replaced at every change."""

    def __init__(self, x: str, y: str, palette: Palette, formats: tuple[str, str]) -> None:
        self._palette = palette
        self.figure = chart(x, y, palette)
        self.figure.x_range, self.figure.y_range = from_zero(1.0), from_zero(1.0)
        self._lines = ColumnDataSource(_lines({}, palette))
        self._marks = ColumnDataSource(_marks({}, palette))
        lines: Any = self.figure.multi_line(
            "x",
            "y",
            source=self._lines,
            line_color="colour",
            line_dash="dash",
            line_width="width",
            legend_field="name",
        )
        self.figure.scatter("x", "y", source=self._marks, color="colour", size=7)
        tips = [("", "@name"), (x or "φ", f"$data_x{{{formats[0]}}}"), (y, f"$data_y{{{formats[1]}}}")]
        self.figure.add_tools(HoverTool(renderers=[lines], tooltips=tips, line_policy="interp"))
        legend = self.legend = self.figure.legend[0]
        legend.background_fill_alpha = legend.border_line_alpha = 0.0
        legend.label_text_color = palette.text
        legend.label_text_font_size = "12px"
        legend.spacing, legend.padding = 0, 2
        legend.glyph_width = 36  # a whole dash

    def show(self, curves: Mapping[str, Curve], x: float, y: float) -> None:
        """Draw these; the axes run up to x and y."""
        self._lines.data = _lines(curves, self._palette)
        self._marks.data = _marks(curves, self._palette)
        self.figure.x_range.end, self.figure.y_range.end = x, y


def _lines(curves: Mapping[str, Curve], palette: Palette) -> dict[str, list[Any]]:
    """Thick where a curve can be trusted, thin all the way where it cannot; one without gaps lies below the others."""
    ordered = sorted(curves.items(), key=lambda named: bool(named[1].line.dash))
    rows = [row for name, curve in ordered for row in _rows(name, curve, palette)]
    return {
        head: [row[place] for row in rows] for place, head in enumerate(("name", "x", "y", "width", "colour", "dash"))
    }


def _rows(name: str, curve: Curve, palette: Palette) -> Iterator[tuple[Any, ...]]:
    x, y = curve.x.astype(numpy.float32), curve.y.astype(numpy.float32)
    style = (colour_of(curve.line, palette), dash_of(curve.line))
    if curve.trusted.any():
        yield (name, x, numpy.where(curve.trusted, y, numpy.float32("nan")), THICK, *style)
    if not curve.trusted.all():
        yield (name, x, y, THIN, *style)


def _marks(curves: Mapping[str, Curve], palette: Palette) -> dict[str, list[Any]]:
    marked = [(curve.mark, colour_of(curve.line, palette)) for curve in curves.values() if curve.mark is not None]
    return {
        "x": [mark[0] for mark, _ in marked],
        "y": [mark[1] for mark, _ in marked],
        "colour": [colour for _, colour in marked],
    }
