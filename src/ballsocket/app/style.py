"""Styles of the page and of its Bokeh charts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import panel as pn
from bokeh.models import ColorBar, LinearColorMapper
from bokeh.plotting import figure


@cache
def asset(name: str) -> str:
    """Read a text file of the page."""
    return (files("ballsocket") / "app" / "assets" / name).read_text(encoding="utf-8")


def html(content: str = "") -> Any:
    """Return an HTML pane in the page's style."""
    return pn.pane.HTML(content, sizing_mode="stretch_width", stylesheets=[asset("parts.css")])


def inputs() -> list[str]:
    """Return the style of lists, boxes and buttons, for light and dark pages."""
    return [asset("inputs.css")]


@dataclass(frozen=True, kw_only=True)
class Palette:
    """Colours of a theme."""

    text: str
    grid: str
    paper: str


PALETTES = {
    "light": Palette(text="#1d2328", grid="#e3e6e8", paper="#ffffff"),
    "dark": Palette(text="#e6e9ec", grid="#3a4249", paper="#191e23"),
}


def bokeh_chart(x: str, y: str, palette: Palette, height: int = 300, **options: Any) -> Any:
    """Make an empty, transparent Bokeh figure of full width without a frame."""
    figure_model = figure(
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
    figure_model.toolbar.logo = None
    figure_model.toolbar.autohide = True
    figure_model.grid.grid_line_color = palette.grid
    for axis in figure_model.axis:
        axis.axis_line_color = axis.major_tick_line_color = palette.text
        axis.minor_tick_line_color = None
        axis.major_label_text_color = axis.axis_label_text_color = palette.text
        axis.axis_label_text_font_style = "normal"
    return figure_model


def colour_bar(mapper: LinearColorMapper, palette: Palette, title: str = "") -> Any:
    """Make the colour scale for the right side of a chart."""
    return ColorBar(
        color_mapper=mapper,
        title=title,
        width=11,
        background_fill_alpha=0.0,
        title_text_color=palette.text,
        major_label_text_color=palette.text,
        title_text_font_style="normal",
    )
