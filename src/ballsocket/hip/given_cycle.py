"""What a file says of cycles: one in [cycle], or a mix of activities, each in an [[activity]]."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..core.checks import check_names, check_text, known_name, require, shown
from ..core.kinds import Kind
from ..io.toml import table_of
from ..io.units import parse
from ..problem.cup import Side
from .cycle import DEFAULT_STEPS, Cycle, check_step_count, order_of
from .cycle_file import Reading, read_cycle
from .in_vivo import IN_VIVO, check_weight
from .mix import Activity, Mix
from .named_cycles import CYCLES, named_cycle

_OF_ALL = ("instants", "rotation_order", "times_body_weight")
_OF_MACHINES: Mapping[str, Mapping[str, tuple[str, Kind]]] = MappingProxyType(
    {
        "biaxial-rocking": {"force": ("peak", Kind.FORCE), "amplitude": ("amplitude", Kind.ANGLE)},
        "constant-load": {"force": ("force", Kind.FORCE), "amplitude": ("amplitude", Kind.ANGLE)},
        "two-axis": {"force": ("peak", Kind.FORCE)},
        "iso-14242-4": {
            "mismatch": ("mismatch", Kind.LENGTH),
            "stiffness": ("stiffness", Kind.STIFFNESS),
            "swing_load": ("swing", Kind.FORCE),
        },
    }
)
_OF_FILES = ("side", "frame", "force_on", "from", "to", "closing", "motion")
_WORDS = tuple(dict.fromkeys(word for words in _OF_MACHINES.values() for word in words))
KEYS = ("name", "file", "body_weight", *_OF_ALL, *_OF_FILES, *_WORDS)
"""Of [cycle]."""

COUNTS = ("per_year", "share")
"""What an activity has beside."""


def given_cycle(content: Mapping[str, Any], folder: Path) -> Cycle | Mix:
    """The cycle of a file, or its activities.

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        A table cannot be read.
    """
    weight = _weight(content)
    if "activity" not in content:
        return _cycle(table_of(content, "cycle"), folder, weight, "[cycle]")
    if "cycle" in content:
        raise ValueError("[cycle] and [[activity]] are one too many: either says what the hip goes through")
    tables = content["activity"]
    if not isinstance(tables, list) or not all(isinstance(table, Mapping) for table in tables):
        raise ValueError(f"activity = {shown(tables)} must be an array of tables: [[activity]] before each")
    return Mix(activities=tuple(_activity(table, folder, weight, content) for table in tables))


def _activity(table: Mapping[str, Any], folder: Path, weight: float | None, content: Mapping[str, Any]) -> Activity:
    check_names(table, (*KEYS, *COUNTS), "in [[activity]]")
    if ("per_year" in table) == ("share" in table):
        raise ValueError("an [[activity]] needs per_year, how many cycles, or its share of cycles_per_year")
    cycle = _cycle({name: each for name, each in table.items() if name not in COUNTS}, folder, weight, "[[activity]]")
    if "per_year" in table:
        return Activity(cycle=cycle, per_year=parse("per_year", table["per_year"], Kind.NUMBER))
    if "cycles_per_year" not in content:
        raise ValueError("a share is one of cycles_per_year, which is missing at the top")
    whole = parse("cycles_per_year", content["cycles_per_year"], Kind.NUMBER)
    return Activity(cycle=cycle, per_year=whole * parse("share", table["share"], Kind.NUMBER))


def _weight(table: Mapping[str, Any]) -> float | None:
    return check_weight(parse("body_weight", table["body_weight"], Kind.FORCE)) if "body_weight" in table else None


def _cycle(table: Mapping[str, Any], folder: Path, weight: float | None, where: str) -> Cycle:
    if ("name" in table) == ("file" in table):
        raise ValueError(f"{where} needs a name or a file, and not both; names: {', '.join(CYCLES)}")
    weight = weight if "body_weight" not in table else _weight(table)
    n_steps = check_step_count(table.get("instants", DEFAULT_STEPS), "instants")
    order = order_of(table.get("rotation_order", "flexion, adduction, rotation"))
    made = (_of_file if "file" in table else _of_name)(table, folder, weight, where, n_steps, order)
    if "times_body_weight" not in table:
        return made
    if weight is None:
        raise ValueError("times_body_weight needs a body_weight")
    times = parse("times_body_weight", table["times_body_weight"], Kind.NUMBER)
    require("times_body_weight", times, 0 < times <= 100, "a load is above 0 and at most 100 times the body's weight")
    return made.scaled(times * weight / made.largest_force)


def _of_name(
    table: Mapping[str, Any], folder: Path, weight: float | None, where: str, n_steps: int, order: str
) -> Cycle:
    name = known_name("cycle", table["name"], CYCLES)
    words = _OF_MACHINES.get(name, {})
    patients = name in IN_VIVO
    own = ("body_weight",) if patients or "times_body_weight" in table else ()
    check_names(table, ("name", *_OF_ALL, *own, *words), f"beside the name {name!r} in {where}")
    given = {word: parse(key, table[key], kind) for key, (word, kind) in words.items() if key in table}
    return named_cycle(name, n_steps, order, weight if patients else None, **given)


def _of_file(
    table: Mapping[str, Any], folder: Path, weight: float | None, where: str, n_steps: int, order: str
) -> Cycle:
    check_names(table, ("file", "body_weight", *_OF_ALL, *_OF_FILES), f"beside a file in {where}")
    files = table["file"] if isinstance(table["file"], list) else [table["file"]]
    if not files or not all(files):
        raise ValueError(f"file = {shown(table['file'])} names no table")
    paths = [folder / check_text("file", each) for each in files]
    return read_cycle(paths, n_steps, order, weight, _reading(table, weight, order))


def _reading(table: Mapping[str, Any], weight: float | None, order: str) -> Reading:
    words: dict[str, Any] = {name: check_text(name, table[name]) for name in ("frame", "force_on") if name in table}
    if "side" in table:
        words["side"] = Side(known_name("side", table["side"], [side.value for side in Side]))
    for key, word in (("from", "begin"), ("to", "end"), ("closing", "closing")):
        if key in table:
            words[word] = parse(key, table[key], Kind.NUMBER)
    if "motion" in table:
        name = known_name("motion", table["motion"], CYCLES)
        words["motion"] = named_cycle(name, DEFAULT_STEPS, order, (weight or 1.0) if name in IN_VIVO else None)
    return Reading(**words)
