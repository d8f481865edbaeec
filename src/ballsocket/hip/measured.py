"""What the columns of a table mean: time, force and angles of a hip, in s, N and rad."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import pi
from types import MappingProxyType

from ..core.arrays import Numbers
from ..core.checks import check_names, shown
from ..problem.cup import Side
from .resampled import at_times
from .tables import Table, parted_head

FORCES = ("force_x", "force_y", "force_z")
ANGLES = ("flexion", "adduction", "rotation")
_NEWTON: Mapping[str, float] = MappingProxyType({"n": 1.0, "kn": 1e3, "%bw": 0.01, "bw": 1.0})
_RADIAN: Mapping[str, float] = MappingProxyType({"deg": pi / 180, "°": pi / 180, "rad": 1.0})
_UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
        "phase": {"%": 0.01, "1": 1.0},
        **dict.fromkeys(("force", *FORCES), _NEWTON),
        **dict.fromkeys(ANGLES, _RADIAN),
    }
)
_ORTHOLOAD = MappingProxyType({"fx": "force_x", "fy": "force_y", "fz": "force_z", "cycle": "phase"})
_BESIDE = ("f", "fres", "fr", "mx", "my", "mz", "m", "mres", "mr")
"""Columns of OrthoLoad that say nothing new, or nothing of wear."""

_COORDINATE = re.compile(r"(?:.*/)?hip_(flexion|adduction|rotation)_([rl])(?:/value)?")
_REACTION = re.compile(r"hip_([rl])_on_(femur|pelvis)(?:_[rl])?_in_(femur|pelvis|ground)(?:_[rl])?_f([xyz])")
_AXES = MappingProxyType({"z": "force_x", "x": "force_y", "y": "force_z"})
"""OpenSim's, to the right, to the front and upwards."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """Columns of a hip.

    Attributes
    ----------
    columns : dict of arrays
        "time" in s or "phase", "force" or "force_x", "force_y", "force_z" in N, angles in rad.
    force_on : str, optional
        "ball" or "socket": what the force acts on, where the columns' names say it.
    frame : str, optional
        "body" or "femur": whose directions it has.
    """

    columns: dict[str, Numbers] = field(default_factory=dict)
    force_on: str | None = None
    frame: str | None = None


def measured(table: Table, body_weight: float | None, side: Side) -> Measured:
    """What a table holds of the hip on a side.

    Raises
    ------
    ValueError
        One sentence: a column without its unit, one that is not known or there twice, a header that leaves angles open.
    """
    return _of_opensim(table, side) if table.storage else _of_text(table, body_weight)


def _of_text(table: Table, body_weight: float | None) -> Measured:
    found: dict[str, Numbers] = {}
    named = [parted_head(head) for head in table.heads]
    ortho = any(name in _ORTHOLOAD and name != "cycle" for name, _ in named)
    for head, (written, unit) in zip(table.heads, named, strict=True):
        if ortho and written in _BESIDE:
            continue
        name = _ORTHOLOAD.get(written, written) if ortho else written
        factor = _factor(name, unit, written, body_weight)
        if name in found:
            raise ValueError(f"the column {name} is there twice")
        found[name] = factor * table.column(head, name)
    if ortho and "time" in found:
        found.pop("phase", None)  # which says the same
    return Measured(columns=found, force_on="ball" if ortho else None, frame="femur" if ortho else None)


def _factor(name: str, unit: str | None, written: str, body_weight: float | None) -> float:
    """From a unit to s, N or rad."""
    check_names([name], _UNITS, "as a column")
    known = _UNITS[name]
    if unit is None:
        raise ValueError(f"the column {written} has no unit: write '{written} [{_first(known)}]' as its head")
    plain = unit.replace(" ", "").lower().replace("degrees", "deg")
    if plain not in known:
        raise ValueError(f"the unit {shown(unit)} of the column {written} is not known; known: {', '.join(known)}")
    if "bw" not in plain:
        return known[plain]
    if body_weight is None:
        raise ValueError(f"the column {written} is in {unit}, and no body_weight is given")
    return known[plain] * body_weight


def _first(units: Mapping[str, float]) -> str:
    unit = next(iter(units))
    return {"n": "N"}.get(unit, unit)


def _of_opensim(table: Table, side: Side) -> Measured:
    """Coordinates and reactions of one hip; all other columns are passed over."""
    mine = side.value[0]
    found = {"time": table.column("time", "time")} if "time" in table.heads else {}
    said: set[tuple[str, str]] = set()
    for head in table.heads:
        if (angle := _COORDINATE.fullmatch(head)) and angle[2] == mine:
            found[angle[1]] = _radian(table) * table.column(head, head)
        elif (force := _REACTION.fullmatch(head)) and force[1] == mine:
            said.add((force[2], force[3]))
            found[_AXES[force[4]]] = table.column(head, head)
    if len(found) < 2:
        raise ValueError(f"no column of the {side.value} hip, such as hip_flexion_{mine} or hip_{mine}_on_femur_...")
    return Measured(columns=found, **_told(said))


def _radian(table: Table) -> float:
    if table.degrees is None:
        raise ValueError("the header does not say in what the angles are: it needs inDegrees=yes or inDegrees=no")
    return pi / 180 if table.degrees else 1.0


def _told(said: set[tuple[str, str]]) -> dict[str, str]:
    """What reactions act on, and whose directions they have."""
    if not said:
        return {}
    if len(said) > 1:
        raise ValueError("the joint's reaction is there more than once: on other bodies, or in other frames")
    body, frame = said.pop()
    if frame == "ground":
        raise ValueError("the joint's reaction is in the ground's frame: let OpenSim express it in pelvis or femur")
    return {"force_on": "ball" if body == "femur" else "socket", "frame": "femur" if frame == "femur" else "body"}


def together(parts: Sequence[Measured]) -> Measured:
    """Several tables of one walk as one, at the times of the first."""
    if len(parts) == 1:
        return parts[0]
    columns = dict(parts[0].columns)
    for part in parts[1:]:
        for name, values in at_times(part.columns, columns).items():
            if name in columns:
                raise ValueError(f"the column {name} is in two files")
            columns[name] = values
    said = next((part for part in parts if part.frame is not None), Measured())
    return Measured(columns=columns, force_on=said.force_on, frame=said.frame)
