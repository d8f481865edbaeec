"""Registry of the views of the page."""

from functools import cache
from importlib import import_module
from typing import Any

VIEW_CLASSES = {
    "press": "contact.Press",
    "cup": "cup.CupView",
    "gait": "gait.Gait",
    "wear": "wear.Wear",
    "curve": "one_input.OneInput",
    "map": "design_map.DesignMap",
    "compare": "compare.Compare",
    "judge": "finite_elements.ElementCheck",
    "evidence": "evidence.Evidence",
}
"""Module and class of each view by its name in links, in the order of the page."""


@cache
def view_class(name: str) -> Any:
    """Import the class of a view."""
    module, _, kind = VIEW_CLASSES[name].partition(".")
    return getattr(import_module(f".{module}", __package__), kind)
