"""A file about measurements: TOML with units in; model, joint, unknowns and data out. Strict, as joint files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy

from ..contact import Model
from ..core.checks import check_names, check_text, known_name, shown
from ..core.kinds import Kind
from ..core.quantities import LOADS
from ..io.joint_file import KEYS, check_keys
from ..io.named_joint import PARTS, joint_in
from ..io.toml import read_toml, table_of
from ..io.units import parse
from ..problem import Joint
from ..studies.file import named_model
from ..studies.parameters import PARAMETERS
from ..studies.phrases import ends_of
from ..studies.scatter import distribution_of
from .columns import Gaps, read_measured, uncertainty_of
from .measured import MACHINE, MEASURED, PERFECT, Machine, Measured, Own
from .oscillation import FREQUENCY, oscillation
from .parameters import Identified, identify
from .scatter import HeavyTailed, NormalScatter, Scatter
from .unknowns import Given

_OF_FILE = ("file", "quantities", "load", "gaps")
_OF_VALUES = ("quantity", "values", "angle", "mass", "order", *LOADS)
_OF_BOTH = ("name", "uncertainty", "load_uncertainty", "saturation", "machine")
_TABLES: Mapping[str, tuple[str, ...]] = {
    "": (*PARTS, "model", "scatter", "free", "machine", "data"),
    "data": (*_OF_FILE, *_OF_VALUES, *_OF_BOTH),
}
FILE_KEYS = {**{name: KEYS[name] for name in PARTS}, **_TABLES}
_READ = {**MEASURED, FREQUENCY.name: FREQUENCY}
_SCATTERS = ("normal", "heavy-tailed")


@dataclass(frozen=True, kw_only=True, eq=False)
class IdentifyFile:
    """What a file about measurements says."""

    model: Model
    joint: Joint
    data: tuple[Measured, ...]
    free: dict[str, Given]
    scatter: Scatter

    def identified(self) -> Identified:
        """What the measurements tell."""
        return identify(self.model, self.joint, self.data, self.free, scatter=self.scatter)


def read_identify(path: str | Path) -> IdentifyFile:
    """Read a file about measurements.

    At the top: `model` (by name; "tabulated" without a word), `scatter` ("normal", or "heavy-tailed" against
    outliers), and the joint as in study files. `free` has the unknowns: text with two ends, "0.02..0.3 mm", or what
    was known, `{mean, deviation}`, `{median, factor}`. Each `[[data]]` has a `file` (CSV, heads with units), and
    which of its columns are `quantities` and which the `load`, and `gaps` ("refuse", "leave-out"); or a `quantity`
    with `values` (one or a list) and its load, a "frequency" also its `mass`; for either `uncertainty` ("1 um", "2
    %"), `load_uncertainty`, `saturation`, `machine`. `[machine.NAME]` has `compliance` and `offset`, numbers or two
    ends, and `drift` per reading, counted by the rows of the file or by `order`. Paths are taken from the file's own
    folder.

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "measurement", lambda content: _file(content, path.parent))


def _file(content: Mapping[str, Any], folder: Path) -> IdentifyFile:
    check_keys(content, "", "at the top", FILE_KEYS)
    given = joint_in(content, folder)
    machines = {name: _machine(name, table) for name, table in table_of(content, "machine").items()}
    return IdentifyFile(
        model=named_model(content.get("model", "tabulated")).in_cup(given.cup),
        joint=given.joint,
        data=_data(content.get("data", []), machines, folder),
        free=_free(table_of(content, "free")),
        scatter=_scatter(content.get("scatter", "normal")),
    )


def _scatter(name: Any) -> Scatter:
    return HeavyTailed() if known_name("scatter", name, _SCATTERS) == "heavy-tailed" else NormalScatter()


def _free(table: Mapping[str, Any]) -> dict[str, Given]:
    """Unknowns; those of a material may stand in a table of its own, `liner.young`."""
    flat: dict[str, Any] = {}
    for name, value in table.items():
        of_part = name in ("liner", "ball") and isinstance(value, Mapping)
        flat |= {f"{name}_{number}": each for number, each in value.items()} if of_part else {name: value}
    check_names(flat, PARAMETERS, "in [free]")
    return {name: _given(name, value) for name, value in flat.items()}


def _given(name: str, value: Any) -> Given:
    if isinstance(value, str):
        return ends_of(name, value, PARAMETERS[name].kind)
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} = {shown(value)} must be two ends, such as '0.02..0.3 mm', or {{mean, deviation}}")
    return distribution_of(name, value, lambda key, number: parse(key, number, PARAMETERS[name].kind))


def _machine(name: str, table: Any) -> Machine:
    if not isinstance(table, Mapping):
        raise ValueError(f"machine.{name} = {shown(table)} must be a table: [machine.{name}]")
    check_names(table, MACHINE, f"in [machine.{name}]")
    return Machine(name=name, **{part: _between(f"{name}.{part}", value, part) for part, value in table.items()})


def _between(name: str, value: Any, part: str) -> float | tuple[float, float]:
    kind = MACHINE[part].kind
    return ends_of(name, value, kind) if isinstance(value, str) and ".." in value else parse(name, value, kind)


def _data(tables: Any, machines: Mapping[str, Machine], folder: Path) -> tuple[Measured, ...]:
    if not isinstance(tables, list) or not tables or not all(isinstance(table, Mapping) for table in tables):
        raise ValueError("measurements are needed: [[data]] before each set")
    return tuple(each for table in tables for each in _set(table, machines, folder))


def _set(table: Mapping[str, Any], machines: Mapping[str, Machine], folder: Path) -> tuple[Measured, ...]:
    check_keys(table, "data", "in [[data]]", FILE_KEYS)
    if ("file" in table) == ("values" in table):
        raise ValueError("[[data]] needs a file, or a quantity with its values, and not both")
    machine = machines[known_name("machine", table["machine"], machines)] if "machine" in table else PERFECT
    return _of_file(table, machine, folder) if "file" in table else (_of_values(table, machine),)


def _of_file(table: Mapping[str, Any], machine: Machine, folder: Path) -> tuple[Measured, ...]:
    check_names(table, (*_OF_FILE, *_OF_BOTH), "beside a file in [[data]]")
    listed = table.get("quantities", [])
    quantities = [listed] if isinstance(listed, str) else listed
    gaps = known_name("gaps", table.get("gaps", Gaps.REFUSE.value), [each.value for each in Gaps])
    load = check_text("load", table.get("load", ""))
    return read_measured(
        folder / check_text("file", table["file"]),
        quantities=quantities,
        load=load,
        uncertainty=table.get("uncertainty"),
        load_uncertainty=_load_uncertainty(table, load or "force"),
        machine=machine,
        gaps=Gaps(gaps),
        **_saturation(table),
    )


def _of_values(table: Mapping[str, Any], machine: Machine) -> Measured:
    check_names(table, (*_OF_VALUES, *_OF_BOTH), "beside values in [[data]]")
    for key in ("quantity", "uncertainty"):
        if key not in table:
            raise ValueError(f"[[data]] with values needs its {key}")
    name = known_name("quantity", table["quantity"], _READ)
    values = _numbers(name, table["values"], _READ[name].kind)
    loads: dict[str, Any] = {kind: _numbers(kind, table[kind], LOADS[kind].kind) for kind in LOADS if kind in table}
    if "order" in table:
        loads["order"] = _numbers("order", table["order"], Kind.NUMBER)
    if "angle" in table:
        loads["angle"] = _numbers("angle", table["angle"], Kind.ANGLE)
    return Measured(
        quantity=name,
        values=values,
        uncertainty=uncertainty_of(_READ[name], table["uncertainty"], values),
        own=_own(name, table),
        load_uncertainty=_load_uncertainty(table, next((kind for kind in LOADS if kind in table), "force")),
        machine=machine,
        name=check_text("name", table.get("name", "")),
        **loads,
        **_saturation(table),
    )


def _own(name: str, table: Mapping[str, Any]) -> Own | None:
    """What is not a quantity of a contact itself: a frequency, of its mass."""
    if (name == FREQUENCY.name) != ("mass" in table):
        raise ValueError("[[data]] of a frequency needs its mass, and no other has one")
    return oscillation(parse("mass", table["mass"], Kind.MASS)) if "mass" in table else None


def _saturation(table: Mapping[str, Any]) -> dict[str, Any]:
    return {"saturation": parse("saturation", table["saturation"], Kind.MODULUS)} if "saturation" in table else {}


def _load_uncertainty(table: Mapping[str, Any], load: str) -> float:
    return (
        parse("load_uncertainty", table["load_uncertainty"], LOADS[load].kind) if "load_uncertainty" in table else 0.0
    )


def _numbers(name: str, given: Any, kind: str) -> numpy.ndarray:
    listed = given if isinstance(given, list) else [given]
    return numpy.array([parse(name, each, kind) for each in listed])
