"""Measurements from tables in files, whose column heads are names and units."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from math import inf
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import number_of_percent, shown
from ..core.kinds import Kind
from ..core.quantities import FIELD, LOADS, Quantity
from ..files.cells import UNCERTAINTY
from ..files.columns import ALL_COLUMNS, HeadChoice, NumberTable, read_columns
from ..files.units import parse
from .measured import IDEAL_MACHINE, MEASURED, Machine, Measured

_QUANTITIES = {**MEASURED, "angle": FIELD["angle"]}
_KINDS = {name + end: quantity.kind for name, quantity in _QUANTITIES.items() for end in ("", UNCERTAINTY)}
_LOADS = ("force", "indentation", "half_angle")
_MAX_ROWS = 8  # rows that a message names


class Gaps(Enum):
    """Treatment of rows with a missing number: refuse, or leave out."""

    REFUSE = "refuse"
    LEAVE_OUT = "leave-out"


def read_measured(
    path: str | Path,
    *,
    quantities: Sequence[str] = (),
    load: str = "",
    uncertainty: float | str | None = None,
    load_uncertainty: float = 0.0,
    saturation: float = inf,
    machine: Machine = IDEAL_MACHINE,
    gaps: Gaps = Gaps.REFUSE,
    heads: HeadChoice = ALL_COLUMNS,
) -> tuple[Measured, ...]:
    """Read measurements from a table in a file, one data set for each measured quantity.

    Heads are names of `ballsocket.identification.MEASURED` with units: "force_N", "indentation [um]", "half_angle_deg",
    "area_mm2", "max_pressure_MPa". A column "pressure_MPa" needs a column "angle_deg". Columns of uncertainties (k = 1)
    have heads such as "indentation_uncertainty_um". The forms of tables are those of `ballsocket.files.columns`.

    Parameters
    ----------
    path : str or Path
    quantities : sequence of str
        Measured columns; by default all columns except loads.
    load : str
        Column of the load; by default the force if there is one.
    uncertainty : float or str
        Uncertainty of quantities without a column for it, in mm, N, MPa, rad, or as text: "2 %" of each value, "1 um".
        Without either, `identify` estimates it from the scatter.
    load_uncertainty : float
        Standard uncertainty of the loads.
    saturation : float
        Largest reading of a film or sensor.
    machine : Machine
        Machine that reads the indentations.
    gaps : Gaps
        Treatment of rows in which a number is missing: an error, or omission.
    heads : HeadChoice
        Columns of the file that get another name, or that are not used.

    Raises
    ------
    ValueError
        A head without a unit, a missing column, a gap, or a number that is not allowed, with file and row.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    table = read_columns(path, _KINDS, heads)
    columns = table.in_units(_KINDS)
    kind = load or next((name for name in _LOADS if name in columns), "")  # empty without a load
    if load and (load not in LOADS or load not in columns):
        raise ValueError(f"{path.name} has no load {shown(load)}: it needs a column of {', '.join(_LOADS)}")
    chosen = list(quantities) or [name for name in columns if name in MEASURED and name != kind]
    if not chosen:
        raise ValueError(f"{path.name} has no column of a measured quantity{f' besides {kind}' if kind else ''}")
    sets = []
    for name in chosen:
        if name not in columns:
            raise ValueError(f"{path.name} has no column of {name}; its columns are {', '.join(columns)}")
        needed = (kind, name, name + UNCERTAINTY, kind + UNCERTAINTY, "angle")
        rows, order = _complete_rows(table, {head: columns[head] for head in needed if head in columns}, gaps)
        column = rows.get(name + UNCERTAINTY)
        load_values: dict[str, Any] = {kind: rows[kind]} if kind else {}
        noise = parse_uncertainty(_QUANTITIES[name], uncertainty) if column is None else {"uncertainty": column}
        sets.append(
            Measured(
                quantity=name,
                values=rows[name],
                **noise,
                saturation=saturation,
                machine=machine if "indentation" in (name, kind) else IDEAL_MACHINE,
                order=order,
                name=path.name,
                remark=table.remark({"with a gap": len(table) - len(order)}),
                **load_values,
                load_uncertainty=rows.get(kind + UNCERTAINTY, load_uncertainty),
                angle=rows["angle"] if name == "pressure" and "angle" in rows else None,
            )
        )
    return tuple(sets)


def _complete_rows(table: NumberTable, columns: dict[str, Numbers], gaps: Gaps) -> tuple[dict[str, Numbers], Numbers]:
    """Select the rows without gaps, and return the columns with the row numbers, which start at 0."""
    missing = numpy.isnan(numpy.stack(list(columns.values())))
    rows = missing.any(axis=0)
    if rows.any() and gaps is Gaps.REFUSE:
        numbers = ", ".join(str(table.lines[row]) for row in numpy.flatnonzero(rows)[:_MAX_ROWS])
        names = ", ".join(name for name, absent in zip(columns, missing, strict=True) if absent.any())
        more = " ..." if rows.sum() > _MAX_ROWS else ""
        raise ValueError(
            f"{table.title}: no number for {names} in line {numbers}{more}; add it, or omit such lines with "
            'gaps = "leave-out"'
        )
    if rows.all():
        raise ValueError(f"{table.title} has no row without a gap")
    return {name: column[~rows] for name, column in columns.items()}, numpy.flatnonzero(~rows).astype(float)


def parse_uncertainty(quantity: Quantity, stated: float | str | None) -> dict[str, Any]:
    """Parse an uncertainty, "2 %" of each value, a text with a unit or a number, to arguments of `Measured`."""
    name = f"{quantity.name}{UNCERTAINTY}"
    if stated is None:
        return {}
    percent = number_of_percent(stated)
    if percent is None:
        return {"uncertainty": parse(name, stated, quantity.kind)}
    share = parse(name, percent, Kind.NUMBER) / 100
    if not 0 < share < inf:
        raise ValueError(f"{name} = {shown(stated)} is not allowed: a share of each value is above 0 and finite")
    return {"relative_uncertainty": share}
