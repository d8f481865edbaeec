"""Measurements from CSV: heads that end in units, uncertainties beside values, gaps named."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from math import inf
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..core.kinds import Kind
from ..core.quantities import FIELD, LOADS, Quantity
from ..io.units import parse
from ..studies.columns import read_columns
from .measured import MEASURED, PERFECT, Machine, Measured

_KNOWN = {**MEASURED, "angle": FIELD["angle"]}
_LOADS = ("force", "indentation", "half_angle")
_BESIDE = "_uncertainty"


class Gaps(Enum):
    """What is done with rows in which a number is missing."""

    REFUSE = "refuse"
    LEAVE_OUT = "leave-out"


@dataclass(frozen=True)
class Head:
    """The head of a column: what it holds, and what its numbers are multiplied by."""

    name: str
    factor: float


def head_of(text: str) -> Head:
    """A head such as "force_N", "indentation_um", "area [mm2]", "max_pressure_uncertainty_MPa".

    Raises
    ------
    ValueError
        A name that is not known; no unit, or one of something else.
    """
    plain = _without_brackets(text.strip()).replace(" ", "_")
    known = [name for name in _KNOWN if plain == name or plain.startswith(f"{name}_")]
    if not known:
        raise ValueError(
            f"column {shown(text)} is not known: heads are names and units, such as force_N, indentation_um"
        )
    name = max(known, key=len)
    unit, kind = plain[len(name) :], _KNOWN[name].kind
    if unit.startswith(_BESIDE):
        name, unit = name + _BESIDE, unit[len(_BESIDE) :]
    unit = unit.removeprefix("_").replace("_per_", "/").replace("_", " ")
    if kind is Kind.NUMBER:
        return Head(name, parse(text, f"1 {unit}".strip(), kind))
    if not unit:
        raise ValueError(f"column {shown(text)} has no unit: write {name}_{kind.suffix}, or another unit")
    return Head(name, parse(f"the unit of {text}", f"1 {unit}", kind))


def _without_brackets(head: str) -> str:
    """Rewrite a unit in brackets at the end of a head as a part of its name."""
    begin = min((head.index(bracket) for bracket in "[(" if bracket in head), default=-1)
    if begin < 0 or head[-1] not in "])":
        return head
    return f"{head[:begin].rstrip()}_{head[begin + 1 : -1].strip()}"


def read_measured(
    path: str | Path,
    *,
    quantities: Sequence[str] = (),
    load: str = "",
    uncertainty: float | str | None = None,
    load_uncertainty: float = 0.0,
    saturation: float = inf,
    machine: Machine = PERFECT,
    gaps: Gaps = Gaps.REFUSE,
) -> tuple[Measured, ...]:
    """Sets of measurements from a CSV (or Parquet) file, one for each quantity in it.

    Heads are names of `ballsocket.identify.MEASURED` with units: "force_N", "indentation_um", "half_angle_deg",
    "area_mm2", "max_pressure_MPa", "pressure_MPa" beside "angle_deg"; uncertainties (k = 1) have columns such as
    "indentation_uncertainty_um". Lines that begin with # before the heads are passed over.

    Parameters
    ----------
    path : str or Path
    quantities : sequence of str
        Which columns are measured; without any, all that are no load.
    load : str
        Which column is the load; without a word the force, where there is one.
    uncertainty : float or str
        Of quantities without a column for it, in mm, N, MPa, rad; or text, "2 %" of each value, "1 um".
    load_uncertainty, saturation, machine
        As of `Measured`.
    gaps : Gaps
        Whether rows in which a number is missing are left out, or refused by their numbers.

    Raises
    ------
    ValueError
        A head without a unit, a column too few, a gap, a number that is not allowed: named with file and row.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    columns = _columns(path)
    kind = _load_of(columns, load, path.name)
    chosen = list(quantities) or [name for name in columns if name in MEASURED and name != kind]
    if not chosen:
        raise ValueError(f"{path.name} has no column of something measured beside {kind or 'nothing'}")
    sets = []
    for name in chosen:
        if name not in columns:
            raise ValueError(f"{path.name} has no column of {name}: it has {', '.join(columns)}")
        wanted = [each for each in (kind, name, name + _BESIDE, kind + _BESIDE, "angle") if each in columns]
        rows, order = _whole(path.name, {each: columns[each] for each in wanted}, gaps)
        sets.append(
            Measured(
                quantity=name,
                values=rows[name],
                uncertainty=_uncertainty(path.name, name, rows, uncertainty),
                saturation=saturation,
                machine=machine if "indentation" in (name, kind) else PERFECT,
                order=order,
                name=path.name,
                **_beside(kind, rows, load_uncertainty),
                angle=rows["angle"] if name == "pressure" and "angle" in rows else None,
            )
        )
    return tuple(sets)


def _columns(path: Path) -> dict[str, Numbers]:
    """Columns by their names, in mm, N, MPa, rad."""
    heads: dict[str, Head] = {}

    def check(texts: Sequence[str]) -> None:
        for text in texts:
            try:
                heads[text] = head_of(text)
            except ValueError as error:
                raise ValueError(f"{path.name}: {error}") from error
        names = [head.name for head in heads.values()]
        if len(names) < len(texts) or len(set(names)) < len(names):
            raise ValueError(f"{path.name} has two columns of one name: {', '.join(texts)}")

    return {heads[text].name: heads[text].factor * column for text, column in read_columns(path, check).items()}


def _load_of(columns: Mapping[str, Numbers], load: str, title: str) -> str:
    if load:
        if load not in LOADS or load not in columns:
            raise ValueError(f"{title} has no load {shown(load)}: a column of {', '.join(_LOADS)} is needed")
        return load
    return next((name for name in _LOADS if name in columns), "")


def _whole(title: str, columns: dict[str, Numbers], gaps: Gaps) -> tuple[dict[str, Numbers], Numbers]:
    """Select the rows without gaps, and return their numbers from 0."""
    missing = numpy.isnan(numpy.stack(list(columns.values())))
    rows = missing.any(axis=0)
    if rows.any() and gaps is Gaps.REFUSE:
        which = ", ".join(str(row + 1) for row in numpy.flatnonzero(rows)[:8])
        names = ", ".join(name for name, bad in zip(columns, missing, strict=True) if bad.any())
        raise ValueError(
            f"{title}: no number for {names} in row {which}{' ...' if rows.sum() > 8 else ''}; give it, or have such "
            'rows left out (gaps = "leave-out")'
        )
    if rows.all():
        raise ValueError(f"{title} has no row without a gap")
    return {name: column[~rows] for name, column in columns.items()}, numpy.flatnonzero(~rows).astype(float)


def _uncertainty(title: str, name: str, rows: Mapping[str, Numbers], given: float | str | None) -> Any:
    if name + _BESIDE in rows:
        return rows[name + _BESIDE]
    if given is None:
        raise ValueError(f"{title}: how uncertain is {name}? give it a column {name}{_BESIDE}_..., or an uncertainty")
    return uncertainty_of(_KNOWN[name], given, rows[name])


def uncertainty_of(quantity: Quantity, given: float | str, values: Numbers) -> Any:
    """An uncertainty from "2 %" of each value, or from a quantity of the values' kind."""
    name = f"{quantity.name}{_BESIDE}"
    share = re.fullmatch(r"\s*([-+.\deE]+)\s*%\s*", given) if isinstance(given, str) else None
    if share:
        return parse(name, share[1], Kind.NUMBER) / 100 * abs(values)
    return parse(name, given, quantity.kind)


def _beside(kind: str, rows: Mapping[str, Numbers], load_uncertainty: float) -> dict[str, Any]:
    if not kind:
        return {}
    return {kind: rows[kind], "load_uncertainty": rows.get(kind + _BESIDE, load_uncertainty)}
