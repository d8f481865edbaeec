"""The points of a study from a file: the rows of a CSV or Parquet table."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..core.checks import check_names
from .axes import TableAxis, column
from .columns import read_columns
from .design import Design
from .parameters import PARAMETERS


def table(path: str | Path) -> Design:
    """The rows of a CSV or Parquet file, whose columns are named like parameters, in mm, N, MPa and rad.

    A name may end in its unit as in the CSV of a study: `ball_radius_mm`, `force_N`, `half_angle_deg` (in degrees).

    Raises
    ------
    ValueError
        A column that is not known; a value that is missing or no number, named with its row; what is no such file,
        or has more rows than there is memory for.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    columns = {}
    for head, values in read_columns(path, lambda heads: _check_heads(heads, path.name)).items():
        name = _NAMES.get(head, head)
        found = column(name, values, row=f" in row {{}} of {path.name}")
        columns[name] = found if name == head else found / PARAMETERS[name].written.factor
    return Design((TableAxis(columns),))


_NAMES = {quantity.column: name for name, quantity in PARAMETERS.items()}


def _check_heads(heads: Sequence[str], title: str) -> None:
    """Raise ValueError unless every column is a parameter, and each of them comes once."""
    seen: set[str] = set()
    for name in (_NAMES.get(head, head) for head in heads):
        check_names([name], PARAMETERS, f"among the columns of {title}")
        if name in seen:
            raise ValueError(f"{title} has {name} twice")
        seen.add(name)
    if not seen:
        raise ValueError(f"{title} has no columns")
