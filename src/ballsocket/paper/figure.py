"""Figures as numbers: panels of curves, and maps, for plots, CSV and JSON files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from ..core.deprecation import renamed_names


@dataclass(frozen=True, kw_only=True)
class FigureLine:
    """Curve of a model and a case; numbers in the units of the axes of its panel."""

    model: str
    case: str
    x: list[float]
    y: list[float]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """Panel of a figure: axis labels and curves; `highest` is the end of the vertical axis, None for automatic."""

    title: str
    x: str
    y: str
    lines: list[FigureLine]
    highest: float | None = None


@dataclass(frozen=True, kw_only=True)
class Map:
    """Map of a quantity over two axes; `z` has a row for each y, and None for a missing value.

    `about_zero` is true for a deviation, whose sign matters.
    """

    title: str
    x_label: str
    y_label: str
    x: list[float]
    y: list[float]
    z: list[list[float | None]]
    about_zero: bool = False


@dataclass(frozen=True, kw_only=True)
class Figure:
    """Figure of panels or maps; `columns` is their number in a row."""

    title: str
    caption: str
    columns: int
    panels: list[Panel] = field(default_factory=list)
    maps: list[Map] = field(default_factory=list)

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, summary: Mapping[str, Any]) -> Figure:
        """Create a figure from its dictionary."""
        panels = [
            Panel(**{**panel, "lines": [FigureLine(**line) for line in panel["lines"]]}) for panel in summary["panels"]
        ]
        return cls(**{**summary, "panels": panels, "maps": [Map(**entry) for entry in summary["maps"]]})

    @classmethod
    def joined(cls, parts: Iterable[Figure]) -> Figure:
        """Join several figures into one: panels with the same title get the lines of all, in the order of the parts."""
        figures = list(parts)
        return replace(
            figures[0],
            panels=list(_merged(panel for figure in figures for panel in figure.panels)),
            maps=[entry for figure in figures for entry in figure.maps],
        )


def _merged(panels: Iterable[Panel]) -> Iterator[Panel]:
    """Merge panels with the same title."""
    groups: dict[str, list[Panel]] = {}
    for panel in panels:
        groups.setdefault(panel.title, []).append(panel)
    for group in groups.values():
        yield replace(group[0], lines=[line for panel in group for line in panel.lines])


__getattr__ = renamed_names(__name__, {"Line": "FigureLine"})
