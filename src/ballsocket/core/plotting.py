"""Registry of plots: methods such as `contact.plot()` find the functions that rooms above register here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Plot = Callable[..., Any]
"""A function that returns a matplotlib figure."""

_LOADERS: dict[str, Callable[[], Plot]] = {}


def register_plot(name: str, loader: Callable[[], Plot]) -> None:
    """Register a function that imports and returns a plot function, by the name of the plot.

    Matplotlib is thus imported only when a plot is made.
    """
    _LOADERS[name] = loader


def load_plot(name: str) -> Plot:
    """Import and return the plot function registered under a name.

    Raises
    ------
    LookupError
        A name that no room has registered.
    """
    if name not in _LOADERS:
        known = ", ".join(sorted(_LOADERS)) or "none"
        raise LookupError(f"plot {name!r} is not registered; registered plots: {known}")
    return _LOADERS[name]()
