"""Identification files: TOML with units to model, joint, unknowns and data. Unknown keys are errors."""

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
from ..studies.expressions import parse_ends
from ..studies.file import named_model
from ..studies.scatter import distribution_of
from .columns import Gaps, parse_uncertainty, read_measured
from .identification import identify
from .machine import IDEAL_MACHINE, Machine, NumberOrRange
from .measured import MEASURED, Measured
from .observables import FILE_OBSERVABLES, CustomObservable
from .registry import FREE_NUMBERS, MACHINE_ERRORS
from .result import IdentificationResult
from .scatter import HeavyTailed, NormalScatter, ScatterModel
from .unknowns import Prior

_FILE_KEYS = ("file", "quantities", "load", "gaps")
_OBSERVABLE_KEYS = {name: observable.argument for name, observable in FILE_OBSERVABLES.items()}
_VALUE_KEYS = ("quantity", "values", "angle", *_OBSERVABLE_KEYS.values(), "order", *LOADS)
_COMMON_KEYS = ("name", "uncertainty", "load_uncertainty", "saturation", "machine")
_TABLES: Mapping[str, tuple[str, ...]] = {
    "": (*PARTS, "model", "scatter", "free", "machine", "data"),
    "data": (*_FILE_KEYS, *_VALUE_KEYS, *_COMMON_KEYS),
}
FILE_KEYS = {**{name: KEYS[name] for name in PARTS}, **_TABLES}
_QUANTITIES = {**MEASURED, **{name: observable.described for name, observable in FILE_OBSERVABLES.items()}}
_SCATTER_MODELS: Mapping[str, ScatterModel] = {"normal": NormalScatter(), "heavy-tailed": HeavyTailed()}


@dataclass(frozen=True, kw_only=True, eq=False)
class IdentifyFile:
    """Parsed contents of an identification file.

    Attributes
    ----------
    model : Model
    joint : Joint
    data : tuple of Measured
    free : dict of str to two ends or a distribution
        Unknowns by name.
    scatter : ScatterModel
    """

    model: Model
    joint: Joint
    data: tuple[Measured, ...]
    free: dict[str, Prior]
    scatter: ScatterModel

    def identify_unknowns(self) -> IdentificationResult:
        """Identify the unknowns of the file from its measurements."""
        return identify(self.model, self.joint, self.data, self.free, scatter=self.scatter)


def read_identify(path: str | Path) -> IdentifyFile:
    """Read an identification file (TOML).

    - At the top: `model` by name, by default "tabulated"; `scatter` ("normal", or "heavy-tailed" for outliers); and the
      joint as in study files.
    - `[free]`: unknowns with two ends, "0.02..0.3 mm", or with a distribution, `{mean, deviation}` or
      `{median, factor}`. The names are those of the joint and of the model.
    - `[[data]]` with a `file` (CSV, heads with units), its measured `quantities`, its `load`, and `gaps` ("refuse",
      "leave-out"). Paths are relative to the folder of the TOML file.
    - `[[data]]` with a `quantity`, `values` (one or a list) and its load. A "frequency" needs its `mass`; a
      "friction_torque" has an `axis_angle` to the load, by default 90 degrees.
    - Both kinds of data have `uncertainty` ("1 um", "2 %"), `load_uncertainty`, `saturation` and `machine`.
    - `[machine.NAME]`: `compliance`, `offset` and `drift` per reading, each a number or two ends. Readings are counted
      by rows of the file, or by `order`.

    Raises
    ------
    ValueError
        One sentence: the error, and the nearest allowed name.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "measurement", lambda content: _parse_file(content, path.parent))


def _parse_file(content: Mapping[str, Any], folder: Path) -> IdentifyFile:
    """Parse the tables of an identification file to model, joint, data and unknowns."""
    check_keys(content, "", "at the top", FILE_KEYS)
    joint_file = joint_in(content, folder)
    machines = {name: _parse_machine(name, table) for name, table in table_of(content, "machine").items()}
    return IdentifyFile(
        model=named_model(content.get("model", "tabulated")).in_cup(joint_file.cup),
        joint=joint_file.joint,
        data=_parse_data(content.get("data", []), machines, folder),
        free=_parse_unknowns(table_of(content, "free")),
        scatter=_SCATTER_MODELS[known_name("scatter", content.get("scatter", "normal"), _SCATTER_MODELS)],
    )


def _parse_unknowns(table: Mapping[str, Any]) -> dict[str, Prior]:
    """Parse the table of unknowns.

    Those of a material may have their own table, `liner.young`.
    """
    flat: dict[str, Any] = {}
    for name, value in table.items():
        is_material = name in ("liner", "ball") and isinstance(value, Mapping)
        flat |= {f"{name}_{number}": entry for number, entry in value.items()} if is_material else {name: value}
    check_names(flat, FREE_NUMBERS, "in [free]")
    return {name: _parse_prior(name, value) for name, value in flat.items()}


def _parse_prior(name: str, value: Any) -> Prior:
    """Parse the prior of an unknown: two ends of a range, or a distribution."""
    kind = FREE_NUMBERS[name].kind
    if isinstance(value, str):
        return parse_ends(name, value, kind)
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} = {shown(value)} must be two ends, such as '0.02..0.3 mm', or {{mean, deviation}}")
    return distribution_of(name, value, lambda key, number: parse(key, number, kind))


def _parse_machine(name: str, table: Any) -> Machine:
    """Parse the table of a machine and its errors."""
    if not isinstance(table, Mapping):
        raise ValueError(f"machine.{name} = {shown(table)} must be a table: [machine.{name}]")
    check_names(table, MACHINE_ERRORS, f"in [machine.{name}]")
    sizes: dict[str, Any] = {
        error: _parse_error_size(f"{name}.{error}", value, error) for error, value in table.items()
    }
    return Machine(name=name, **sizes)


def _parse_error_size(name: str, value: Any, error: str) -> NumberOrRange:
    """Parse the size of a machine error: a number, or two ends."""
    kind = MACHINE_ERRORS[error].quantity.kind
    return parse_ends(name, value, kind) if isinstance(value, str) and ".." in value else parse(name, value, kind)


def _parse_data(tables: Any, machines: Mapping[str, Machine], folder: Path) -> tuple[Measured, ...]:
    """Parse all data sets of a file."""
    if not isinstance(tables, list) or not tables or not all(isinstance(table, Mapping) for table in tables):
        raise ValueError("the file has no measurements: add [[data]] before each set")
    return tuple(measured for table in tables for measured in _parse_data_table(table, machines, folder))


def _parse_data_table(table: Mapping[str, Any], machines: Mapping[str, Machine], folder: Path) -> tuple[Measured, ...]:
    """Parse the data sets of one [[data]] table."""
    check_keys(table, "data", "in [[data]]", FILE_KEYS)
    if ("file" in table) == ("values" in table):
        raise ValueError("[[data]] needs either a file, or a quantity with its values")
    machine = machines[known_name("machine", table["machine"], machines)] if "machine" in table else IDEAL_MACHINE
    return _read_data_file(table, machine, folder) if "file" in table else (_parse_listed_values(table, machine),)


def _read_data_file(table: Mapping[str, Any], machine: Machine, folder: Path) -> tuple[Measured, ...]:
    """Read the data sets of a [[data]] table that names a CSV or Parquet file."""
    check_names(table, (*_FILE_KEYS, *_COMMON_KEYS), "in [[data]] with a file")
    listed = table.get("quantities", [])
    quantities = [listed] if isinstance(listed, str) else listed
    gaps = known_name("gaps", table.get("gaps", Gaps.REFUSE.value), [choice.value for choice in Gaps])
    load = check_text("load", table.get("load", ""))
    return read_measured(
        folder / check_text("file", table["file"]),
        quantities=quantities,
        load=load,
        uncertainty=table.get("uncertainty"),
        load_uncertainty=_parse_load_uncertainty(table, load or "force"),
        machine=machine,
        gaps=Gaps(gaps),
        **_parse_saturation(table),
    )


def _parse_listed_values(table: Mapping[str, Any], machine: Machine) -> Measured:
    """Parse the data set of a [[data]] table that lists its values."""
    check_names(table, (*_VALUE_KEYS, *_COMMON_KEYS), "in [[data]] with values")
    for key in ("quantity", "uncertainty"):
        if key not in table:
            raise ValueError(f"[[data]] with values needs its {key}")
    name = known_name("quantity", table["quantity"], _QUANTITIES)
    values = _parse_numbers(name, table["values"], _QUANTITIES[name].kind)
    loads: dict[str, Any] = {
        kind: _parse_numbers(kind, table[kind], LOADS[kind].kind) for kind in LOADS if kind in table
    }
    if "order" in table:
        loads["order"] = _parse_numbers("order", table["order"], Kind.NUMBER)
    if "angle" in table:
        loads["angle"] = _parse_numbers("angle", table["angle"], Kind.ANGLE)
    return Measured(
        quantity=name,
        values=values,
        uncertainty=parse_uncertainty(_QUANTITIES[name], table["uncertainty"], values),
        observable=_parse_observable(name, table),
        load_uncertainty=_parse_load_uncertainty(table, next((kind for kind in LOADS if kind in table), "force")),
        machine=machine,
        name=check_text("name", table.get("name", "")),
        **loads,
        **_parse_saturation(table),
    )


def _parse_observable(name: str, table: Mapping[str, Any]) -> CustomObservable | None:
    """Return the custom observable of a quantity such as a frequency; None for a quantity of a contact."""
    for quantity, argument in _OBSERVABLE_KEYS.items():
        if argument in table and quantity != name:
            raise ValueError(f"{argument} belongs to [[data]] of a {quantity}, not of {name}")
    if name not in FILE_OBSERVABLES:
        return None
    observable = FILE_OBSERVABLES[name]
    if observable.argument in table:
        return observable.make(parse(observable.argument, table[observable.argument], observable.kind))
    if observable.default is None:
        raise ValueError(f"[[data]] of a {name} needs its {observable.argument}")
    return observable.make(observable.default)


def _parse_saturation(table: Mapping[str, Any]) -> dict[str, Any]:
    """Parse the saturation to a keyword argument of `Measured`; empty if it is not stated."""
    return {"saturation": parse("saturation", table["saturation"], Kind.MODULUS)} if "saturation" in table else {}


def _parse_load_uncertainty(table: Mapping[str, Any], load: str) -> float:
    """Parse the uncertainty of the loads; 0 by default."""
    return (
        parse("load_uncertainty", table["load_uncertainty"], LOADS[load].kind) if "load_uncertainty" in table else 0.0
    )


def _parse_numbers(name: str, value: Any, kind: str) -> numpy.ndarray:
    """Parse a number or a list of numbers with units to an array."""
    numbers = value if isinstance(value, list) else [value]
    return numpy.array([parse(name, number, kind) for number in numbers])
