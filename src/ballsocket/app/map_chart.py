"""A map with its contours, limits, doubts and the joint that is on the screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy
from bokeh.models import ColumnDataSource, HoverTool, LinearColorMapper, PointDrawTool
from bokeh.plotting.contour import contour_data

from .limit_lines import Place, handles, longest, said
from .look import Palette, chart, colour_bar
from .mapping import good, head, margin, now
from .screen import Screen

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
    """A coloured map, in the units of a study for who is told.

    Parameters
    ----------
    palette : Palette
    tapped : callable
        Told where it was clicked.
    dragged : callable
        Told the number of a limit, and where its line was moved to.
    """

    def __init__(
        self,
        palette: Palette,
        tapped: Callable[[float, float], None],
        dragged: Callable[[int, Place], None] = lambda number, place: None,
    ) -> None:
        self.figure = chart("", "", palette, 440)
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
        """Tell which handle is not where it was put, if there is one."""
        if len(data["x"]) != len(self._put["x"]):
            self._handles.data = self._put  # one was taken away by a key: limits are taken away as text
            return
        for number, (x, y) in enumerate(zip(data["x"], data["y"], strict=True)):
            if (x, y) != (self._put["x"][number], self._put["y"][number]):
                self._dragged(self._numbers[number], (x / self._turns[0], y / self._turns[1]))
                return

    def clear(self) -> None:
        """Draw nothing."""
        for source in (self._image, self._pale):
            source.data = dict(_NO_IMAGE)
        self._doubt.data = self._here.data = {"x": [], "y": []}
        self._values.data = self._put = self._handles.data = dict(_NO_WORDS)
        nothing = numpy.zeros((3, 3))
        for lines in (self._lines, self._ends):
            lines.set_data(contour_data(*(numpy.arange(3.0),) * 2, nothing, [1.0], want_fill=False))

    def show(self, found: Any, screen: Screen) -> None:
        """Draw a map.

        Raises
        ------
        ValueError
            It has no answer anywhere.
        """
        across, up, name = screen.across, screen.up, screen.quantity
        title, turn = head(name, screen)
        values = found[name].transpose(up.name, across.name).values * turn
        if numpy.isnan(values).all():
            raise ValueError(f"{found.attrs['model']} has no answer anywhere on this map: choose another model")
        fine = good(found, screen).transpose(up.name, across.name).values
        valid = found.valid.transpose(up.name, across.name).values
        heads, self._turns = zip(*(head(axis.name, screen) for axis in (across, up)), strict=True)
        x, y = (found[axis.name].values * one for axis, one in zip((across, up), self._turns, strict=True))
        box = _box(x, y)
        self._colours.update(low=float(numpy.nanmin(values)), high=float(numpy.nanmax(values)))
        self._image.data = {"image": [values], **box}
        self._pale.data = {"image": [(~fine).astype(float)], **box}
        levels = _levels(values)
        self._lines.set_data(contour_data(x, y, values, levels, want_fill=False))
        self._values.data = _labelled(x, y, values, levels)
        self._put_handles(found, screen)
        self._ends.set_data(contour_data(x, y, margin(found, screen), [0.0], want_fill=False))
        grid_x, grid_y = numpy.meshgrid(x, y)
        thinned = (~valid) & (numpy.add.outer(numpy.arange(len(y)), numpy.arange(len(x))) % 4 == 0)
        self._doubt.data = {"x": grid_x[thinned], "y": grid_y[thinned]}
        here = (now(screen.file, axis.name) * one for axis, one in zip((across, up), self._turns, strict=True))
        self._here.data = {place: [value] for place, value in zip("xy", here, strict=True)}
        self.figure.x_range.update(start=box["x"][0], end=box["x"][0] + box["dw"][0])
        self.figure.y_range.update(start=box["y"][0], end=box["y"][0] + box["dh"][0])
        self.figure.xaxis.axis_label, self.figure.yaxis.axis_label = heads
        self._bar.title = title
        places = [(label, f"${place}{{0.000}}") for label, place in zip(heads, "xy", strict=True)]
        self._hover.tooltips = [*places, (title, "@image{0.000}")]

    def _put_handles(self, found: Any, screen: Screen) -> None:
        """A handle on each limit whose line is on the map."""
        places = handles(found, screen)
        self._numbers = [number for number, (x, _) in enumerate(places) if not numpy.isnan(x)]
        self._put = {
            "x": [places[number][0] * self._turns[0] for number in self._numbers],
            "y": [places[number][1] * self._turns[1] for number in self._numbers],
            "words": [said(screen.limits[number], screen.reading) for number in self._numbers],
        }
        self._handles.data = self._put


def _labelled(x: numpy.ndarray, y: numpy.ndarray, values: numpy.ndarray, levels: list[float]) -> dict[str, list[Any]]:
    """Every second contour with its value, where it is longest."""
    places = [(level, longest(x, y, values, level)) for level in levels[1::2]]
    kept = [(level, place) for level, place in places if not numpy.isnan(place[0])]
    return {
        "x": [place[0] for _, place in kept],
        "y": [place[1] for _, place in kept],
        "words": [f"{level:.4g}" for level, _ in kept],
    }


def _box(x: numpy.ndarray, y: numpy.ndarray) -> dict[str, list[float]]:
    """Pixels are centred on the points."""
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
