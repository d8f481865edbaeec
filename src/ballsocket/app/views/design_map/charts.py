"""Design map with contours, limits, marks of doubtful points, and the joint on the screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy
from bokeh.models import ColumnDataSource, HoverTool, LinearColorMapper, PointDrawTool
from bokeh.plotting.contour import contour_data

from ...state.screen import Screen
from ...style import Palette, bokeh_chart, colour_bar
from .worker import (
    MapPoint,
    allowed_points,
    axis_label,
    current_value,
    limit_handles,
    limit_text,
    longest_line_middle,
    margin,
)

_LEVELS = 14
_NO_WORDS: dict[str, list[Any]] = {"x": [], "y": [], "words": []}
_ON_COLOUR: dict[str, Any] = {
    "text_color": "white",
    "text_font_size": "12px",
    "background_fill_color": "#1d2328",
    "background_fill_alpha": 0.6,
    "padding": 2,
    "border_radius": 3,
    "text_baseline": "middle",
}
_NO_IMAGE: dict[str, list[Any]] = {"image": [], "x": [], "y": [], "dw": [], "dh": []}


class MapChart:
    """Coloured design map; the callbacks receive values in the units of a study."""

    def __init__(
        self,
        palette: Palette,
        tapped: Callable[[float, float], None],
        dragged: Callable[[int, MapPoint], None] = lambda number, point: None,
    ) -> None:
        self.figure = bokeh_chart("", "", palette, 440)
        self._colours = LinearColorMapper("Viridis256", low=0.0, high=1.0)
        self._image, self._pale = ColumnDataSource(dict(_NO_IMAGE)), ColumnDataSource(dict(_NO_IMAGE))
        box = {"x": "x", "y": "y", "dw": "dw", "dh": "dh"}
        image: Any = self.figure.image("image", source=self._image, color_mapper=self._colours, **box)
        self._hover = HoverTool(renderers=[image], tooltips=[("", "@image{0.000}")])
        self.figure.add_tools(self._hover)
        veil = LinearColorMapper([palette.paper], low=0.5, high=1.5, low_color="#00000000")
        self.figure.image("image", source=self._pale, color_mapper=veil, global_alpha=0.65, **box)
        flat = numpy.add.outer(numpy.arange(3.0), numpy.arange(3.0))
        self._lines = self.figure.contour(
            *(numpy.arange(3.0),) * 2, flat, levels=[1.0, 2.0], line_color="white", line_width=0.8
        )
        self._ends = self.figure.contour(
            *(numpy.arange(3.0),) * 2, flat, levels=[1.0, 2.0], line_color="white", line_width=2.0, line_dash="dotted"
        )
        self._doubt = ColumnDataSource({"x": [], "y": []})
        self.figure.scatter("x", "y", source=self._doubt, marker="x", size=5, color="white", line_width=1.2)
        self._here = ColumnDataSource({"x": [], "y": []})
        self.figure.scatter(
            "x", "y", source=self._here, size=11, fill_color="white", line_color="black", line_width=1.5
        )
        self._values = ColumnDataSource(dict(_NO_WORDS))
        self.figure.text("x", "y", "words", source=self._values, **_ON_COLOUR)
        self._handles = ColumnDataSource(dict(_NO_WORDS))
        points = self.figure.scatter(
            "x", "y", source=self._handles, marker="square", size=13, fill_color="#d55e00", line_color="white"
        )
        self.figure.text("x", "y", "words", source=self._handles, x_offset=11, text_align="left", **_ON_COLOUR)
        drag = PointDrawTool(renderers=[points], add=False, description="Move a limit")
        self.figure.add_tools(drag)
        self.figure.toolbar.active_drag = drag
        self._dragged, self._put, self._numbers = dragged, dict(_NO_WORDS), list[int]()
        self._handles.on_change("data", lambda attribute, old, new: self._moved(new))
        self._bar = colour_bar(self._colours, palette)
        self.figure.add_layout(self._bar, "right")
        self._turns = (1.0, 1.0)  # from the units of a study to those of the axes
        self.figure.on_event("tap", lambda event: tapped(event.x / self._turns[0], event.y / self._turns[1]))

    def _moved(self, data: dict[str, Any]) -> None:
        """Report the handle that a user has moved, if any."""
        if len(data["x"]) != len(self._put["x"]):
            self._handles.data = self._put  # one was taken away by a key: limits are taken away as text
            return
        for number, (x, y) in enumerate(zip(data["x"], data["y"], strict=True)):
            if (x, y) != (self._put["x"][number], self._put["y"][number]):
                self._dragged(self._numbers[number], (x / self._turns[0], y / self._turns[1]))
                return

    def clear(self) -> None:
        """Remove the drawing."""
        for source in (self._image, self._pale):
            source.data = dict(_NO_IMAGE)
        self._doubt.data = self._here.data = {"x": [], "y": []}
        self._values.data = self._put = self._handles.data = dict(_NO_WORDS)
        nothing = numpy.zeros((3, 3))
        for lines in (self._lines, self._ends):
            lines.set_data(contour_data(*(numpy.arange(3.0),) * 2, nothing, [1.0], want_fill=False))

    def show(self, results: Any, screen: Screen) -> None:
        """Draw a map; raise ValueError if it has no result anywhere."""
        across, up, name = screen.across, screen.up, screen.quantity
        title, factor = axis_label(name, screen)
        values = results[name].transpose(up.name, across.name).values * factor
        if numpy.isnan(values).all():
            raise ValueError(f"{results.attrs['model']} has no answer anywhere on this map: choose another model")
        fine = allowed_points(results, screen).transpose(up.name, across.name).values
        valid = results.valid.transpose(up.name, across.name).values
        heads, self._turns = zip(*(axis_label(axis.name, screen) for axis in (across, up)), strict=True)
        x, y = (results[axis.name].values * factor for axis, factor in zip((across, up), self._turns, strict=True))
        box = _box(x, y)
        self._colours.update(low=float(numpy.nanmin(values)), high=float(numpy.nanmax(values)))
        self._image.data = {"image": [values], **box}
        self._pale.data = {"image": [(~fine).astype(float)], **box}
        levels = _levels(values)
        self._lines.set_data(contour_data(x, y, values, levels, want_fill=False))
        self._values.data = _labelled(x, y, values, levels)
        self._put_handles(results, screen)
        self._ends.set_data(contour_data(x, y, margin(results, screen), [0.0], want_fill=False))
        grid_x, grid_y = numpy.meshgrid(x, y)
        thinned = (~valid) & (numpy.add.outer(numpy.arange(len(y)), numpy.arange(len(x))) % 4 == 0)
        self._doubt.data = {"x": grid_x[thinned], "y": grid_y[thinned]}
        here = (
            current_value(screen.file, axis.name) * factor
            for axis, factor in zip((across, up), self._turns, strict=True)
        )
        self._here.data = {coordinate: [value] for coordinate, value in zip("xy", here, strict=True)}
        self.figure.x_range.update(start=box["x"][0], end=box["x"][0] + box["dw"][0])
        self.figure.y_range.update(start=box["y"][0], end=box["y"][0] + box["dh"][0])
        self.figure.xaxis.axis_label, self.figure.yaxis.axis_label = heads
        self._bar.title = title
        tooltips = [(label, f"${coordinate}{{0.000}}") for label, coordinate in zip(heads, "xy", strict=True)]
        self._hover.tooltips = [*tooltips, (title, "@image{0.000}")]

    def _put_handles(self, results: Any, screen: Screen) -> None:
        """Place a handle on each limit whose line is on the map."""
        points = limit_handles(results, screen)
        self._numbers = [number for number, (x, _) in enumerate(points) if not numpy.isnan(x)]
        self._put = {
            "x": [points[number][0] * self._turns[0] for number in self._numbers],
            "y": [points[number][1] * self._turns[1] for number in self._numbers],
            "words": [limit_text(screen.limits[number], screen.reading) for number in self._numbers],
        }
        self._handles.data = self._put


def _labelled(x: numpy.ndarray, y: numpy.ndarray, values: numpy.ndarray, levels: list[float]) -> dict[str, list[Any]]:
    """Label every second contour at the middle of its longest line."""
    middles = [(level, longest_line_middle(x, y, values, level)) for level in levels[1::2]]
    visible = [(level, point) for level, point in middles if not numpy.isnan(point[0])]
    return {
        "x": [point[0] for _, point in visible],
        "y": [point[1] for _, point in visible],
        "words": [f"{level:.4g}" for level, _ in visible],
    }


def _box(x: numpy.ndarray, y: numpy.ndarray) -> dict[str, list[float]]:
    """Return the edges of an image whose pixels are centred on the points."""
    dx, dy = x[1] - x[0], y[1] - y[0]
    return {
        "x": [float(x[0] - dx / 2)],
        "y": [float(y[0] - dy / 2)],
        "dw": [float(x[-1] - x[0] + dx)],
        "dh": [float(y[-1] - y[0] + dy)],
    }


def _levels(values: numpy.ndarray) -> list[float]:
    from matplotlib.ticker import MaxNLocator

    low, high = float(numpy.nanmin(values)), float(numpy.nanmax(values))
    if not low < high:
        return [low, low + max(abs(low), 1.0)]
    return [float(level) for level in MaxNLocator(_LEVELS).tick_values(low, high)]
