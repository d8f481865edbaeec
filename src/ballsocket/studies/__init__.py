"""Studies: many joints and loads pressed with one model, and questions about them.

`study` presses one joint at every point of a design. `pareto`, `optimise` and `sensitivity` find the best designs and
the parameters that matter. `design_map` and similar functions plot studies.

Data take this way: a `file` or Python makes a `design` of `axes`; `run` makes it a `task`, whose blocks an executor
computes into memory or into a `store`; `metadata` labels the dataset, `limits` judges it, `study_answer` describes it,
and `file_formats` exports it.
"""

from typing import Any

from ..core.checks import nearest
from ..core.display import load_plot
from ..core.lazy import names_of_stub

_PLOTS = ("band_figure", "design_map", "front_figure", "sensitivity_figure")
_import_name, _, _NAMES = names_of_stub(__name__, __file__)

__all__ = [*_NAMES, *_PLOTS]


def __getattr__(name: str) -> Any:
    """Load a name or a plot function on its first use."""
    if name in _PLOTS:
        return load_plot(name)
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{nearest(name, __all__)}")
    return _import_name(name)


def __dir__() -> list[str]:
    """List the names of the module, with the plot functions."""
    return sorted({*globals(), *__all__})
