"""Studies: many joints and loads pressed with one model, and questions about them.

`study` presses one joint at every point of a design. `pareto`, `optimise` and `sensitivity` find the best designs and
the parameters that matter. `design_map` and similar functions plot studies.

Data take this way: a `file` or Python makes a `design` of `axes`; `run` makes it a `task`, whose blocks an executor
computes into memory or into a `store`; `metadata` labels the dataset, `limits` judges it, `study_answer` describes it,
and `file_formats` exports it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..core.checks import nearest
from ..core.display import load_plot
from ..core.lazy import imported_names

if TYPE_CHECKING:
    from .axes import Span as Span
    from .derivatives import elasticities as elasticities
    from .design import Design as Design
    from .design import grid as grid
    from .design import sample as sample
    from .design import table as table
    from .distributions import LogNormal as LogNormal
    from .distributions import Normal as Normal
    from .distributions import Rectangular as Rectangular
    from .distributions import tolerance as tolerance
    from .expressions import parse_limit as parse_limit
    from .file import read_study as read_study
    from .file_formats import export as export
    from .limits import Limit as Limit
    from .limits import allowed as allowed
    from .optimisation import Optimum as Optimum
    from .optimisation import optimise as optimise
    from .optimisation import pareto as pareto
    from .parameters import PARAMETERS as PARAMETERS
    from .run import Progress as Progress
    from .run import study as study
    from .sampling import Method as Method
    from .store import read as read
    from .variance_shares import sensitivity as sensitivity

_PLOTS = ("band_figure", "design_map", "front_figure", "sensitivity_figure")
band_figure: Callable[..., Any]
design_map: Callable[..., Any]
front_figure: Callable[..., Any]
sensitivity_figure: Callable[..., Any]

_NAMES_BY_MODULE = {
    "axes": "Span",
    "derivatives": "elasticities",
    "design": "Design grid sample table",
    "distributions": "LogNormal Normal Rectangular tolerance",
    "expressions": "parse_limit",
    "file": "read_study",
    "file_formats": "export",
    "limits": "Limit allowed",
    "optimisation": "Optimum optimise pareto",
    "parameters": "PARAMETERS",
    "run": "Progress study",
    "sampling": "Method",
    "store": "read",
    "variance_shares": "sensitivity",
}
"""Names for users by module. A module is imported on the first use of one of its names."""

__all__ = [*(name for names in _NAMES_BY_MODULE.values() for name in names.split()), *_PLOTS]

_import_name = imported_names(__name__, _NAMES_BY_MODULE)

if not TYPE_CHECKING:

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
