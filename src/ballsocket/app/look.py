"""Colours of light and dark pages, and the same style for every chart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from bokeh.models import ColorBar, LinearColorMapper
from bokeh.plotting import figure


@dataclass(frozen=True, kw_only=True)
class Palette:
    """What a theme is made of."""

    text: str
    grid: str
    paper: str


PALETTES = {
    "light": Palette(text="#1d2328", grid="#e3e6e8", paper="#ffffff"),
    "dark": Palette(text="#e6e9ec", grid="#3a4249", paper="#191e23"),
}


def chart(x: str, y: str, palette: Palette, height: int = 300, **options: Any) -> Any:
    """An empty Bokeh figure as wide as its place, without a frame, transparent."""
    made = figure(
        height=height,
        sizing_mode="stretch_width",
        x_axis_label=x,
        y_axis_label=y,
        tools="pan,wheel_zoom,box_zoom,reset",
        active_scroll=None,
        toolbar_location="above",
        background_fill_alpha=0.0,
        border_fill_alpha=0.0,
        outline_line_color=None,
        min_border_left=10,
        **options,
    )
    made.toolbar.logo = None
    made.toolbar.autohide = True
    made.grid.grid_line_color = palette.grid
    for axis in made.axis:
        axis.axis_line_color = axis.major_tick_line_color = palette.text
        axis.minor_tick_line_color = None
        axis.major_label_text_color = axis.axis_label_text_color = palette.text
        axis.axis_label_text_font_style = "normal"
    return made


def colour_bar(mapper: LinearColorMapper, palette: Palette, title: str = "") -> Any:
    """The scale of a colour map, for the right of a chart."""
    return ColorBar(
        color_mapper=mapper,
        title=title,
        width=11,
        background_fill_alpha=0.0,
        title_text_color=palette.text,
        major_label_text_color=palette.text,
        title_text_font_style="normal",
    )
