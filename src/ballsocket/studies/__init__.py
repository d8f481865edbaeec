"""Questions asked of many joints: which points, what each is answered, and what follows.

`study` presses one joint at every point of a design; `pareto`, `optimise` and `sensitivity` ask for the best points and
for what matters; `design_map` and its kin draw.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..core.checks import nearest
from ..core.plotting import load_plot
from .axes import Method, Span
from .design import Design, grid, sample
from .distributions import LogNormal, Normal, Rectangular, tolerance
from .export import export
from .limits import Limit, allowed
from .optimum import Optimum, optimise
from .parameters import PARAMETERS
from .pareto import pareto
from .phrases import limit_of
from .rows import table
from .run import Progress, read, study
from .sensitivity import sensitivity
from .slopes import elasticities

__all__ = [  # noqa: RUF022, grouped as they are used
    # which points
    "PARAMETERS",
    "Design",
    "LogNormal",
    "Method",
    "Normal",
    "Rectangular",
    "Span",
    "grid",
    "sample",
    "table",
    "tolerance",
    # presses
    "Progress",
    "export",
    "read",
    "read_study",
    "study",
    # questions
    "Limit",
    "Optimum",
    "allowed",
    "elasticities",
    "limit_of",
    "optimise",
    "pareto",
    "sensitivity",
    # pictures
    "band_figure",
    "design_map",
    "front_figure",
    "sensitivity_figure",
]

_PLOTS = ("band_figure", "design_map", "front_figure", "sensitivity_figure")
band_figure: Callable[..., Any]
design_map: Callable[..., Any]
front_figure: Callable[..., Any]
sensitivity_figure: Callable[..., Any]

if TYPE_CHECKING:
    from .file import read_study
else:  # a checker of types would take any name for an offered one

    def __getattr__(name: str) -> Any:
        if name in _PLOTS:
            return load_plot(name)
        if name == "read_study":  # the schema of study files takes time to load
            return import_module("ballsocket.studies.file").read_study
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{nearest(name, __all__)}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
