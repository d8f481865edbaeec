"""A figure as numbers: panels of curves, and maps. What is drawn, written as CSV and kept in files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from itertools import groupby
from typing import Any

from ..core.deprecation import renamed_names


@dataclass(frozen=True, kw_only=True)
class FigureLine:
    """One curve: `model` says who, `case` what is varied; numbers with the units of the panel's axes."""

    model: str
    case: str
    x: list[float]
    y: list[float]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One part of a figure; `highest` is where its upright axis ends, None a little above its lines."""

    title: str
    x: str
    y: str
    lines: list[FigureLine]
    highest: float | None = None


@dataclass(frozen=True, kw_only=True)
class Map:
    """A quantity over two axes; `z` has a row for each y, None where there is nothing.

    `about_zero` says that its sign matters: a deviation.
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
    """One figure: panels, or maps, so many in a row."""

    title: str
    caption: str
    columns: int
    panels: list[Panel] = field(default_factory=list)
    maps: list[Map] = field(default_factory=list)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, summary: Mapping[str, Any]) -> Figure:
        """From its dictionary."""
        panels = [
            Panel(**{**panel, "lines": [FigureLine(**line) for line in panel["lines"]]}) for panel in summary["panels"]
        ]
        return cls(**{**summary, "panels": panels, "maps": [Map(**each) for each in summary["maps"]]})

    @classmethod
    def joined(cls, parts: Iterable[Figure]) -> Figure:
        """One figure of several: panels of one title get the lines of all, in the order of the parts."""
        figures = list(parts)
        return replace(
            figures[0],
            panels=list(_merged(panel for figure in figures for panel in figure.panels)),
            maps=[each for figure in figures for each in figure.maps],
        )


def _merged(panels: Iterable[Panel]) -> Iterator[Panel]:
    kept = list(panels)
    order = {title: place for place, title in enumerate(dict.fromkeys(panel.title for panel in kept))}
    for _, group in groupby(sorted(kept, key=lambda panel: order[panel.title]), key=lambda panel: panel.title):
        same = list(group)
        yield replace(same[0], lines=[line for panel in same for line in panel.lines])


__getattr__ = renamed_names(__name__, {"Line": "FigureLine"})
