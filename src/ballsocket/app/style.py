"""The page's style, for the page itself and inside its parts."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

import panel as pn


@cache
def asset(name: str) -> str:
    """A text file of the page."""
    return (files("ballsocket") / "app" / "assets" / name).read_text(encoding="utf-8")


def html(content: str = "") -> Any:
    """A place for HTML in the page's style."""
    return pn.pane.HTML(content, sizing_mode="stretch_width", stylesheets=[asset("parts.css")])


def inputs() -> list[str]:
    """The style of lists, boxes and rows of buttons: readable on dark pages too, and what is chosen stands out."""
    return [asset("inputs.css")]
