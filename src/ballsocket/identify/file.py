"""Identification files: TOML with units to model, joint, unknowns and data. Unknown keys are errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy

from ..contact import Model
from ..core.checks import check_names, known_name, shown
from ..core.kinds import Kind
from ..core.quantities import FIELD, LOADS, MATERIAL
from ..files.joint_file import JointTables
from ..files.named_joint import joint_in
from ..files.schema import (
    QUANTITY_SCHEMA,
    Mass,
    Modulus,
    Table,
    Text,
    Texts,
    Value,
    meaning,
    read_table,
    table_of_quantities,
    values_of,
)
from ..files.toml import read_toml
from ..files.units import parse
from ..problem import Joint
from ..studies.file import named_model
from ..studies.phrases import ends_of
from ..studies.scatter import distribution_of
from .columns import Gaps, parse_uncertainty, read_measured
from .identification import identify
from .machine import IDEAL_MACHINE, Machine, NumberOrRange
from .measured import MEASURED, Measured
from .observables import FREQUENCY, CustomObservable, oscillation
from .registry import FREE_NUMBERS, MACHINE_ERRORS
from .result import IdentificationResult
from .scatter import HeavyTailed, NormalScatter, ScatterModel
from .unknowns import Prior

_QUANTITIES = {**MEASURED, FREQUENCY.name: FREQUENCY}
_SCATTER_MODELS: Mapping[str, ScatterModel] = {"normal": NormalScatter(), "heavy-tailed": HeavyTailed()}
_NUMBERS_SCHEMA = {"anyOf": [QUANTITY_SCHEMA, {"type": "array", "items": QUANTITY_SCHEMA}]}


class Readings(Value, list[Any]):
    """Number or list of numbers, with units."""

    kind: ClassVar[Kind]
    schema: ClassVar[Mapping[str, Any]] = _NUMBERS_SCHEMA

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert one number or a list of numbers, as floats if the class has a kind of quantity."""
        values = value if isinstance(value, list) else [value]
        return cls(parse(name, number, cls.kind) for number in values) if hasattr(cls, "kind") else cls(values)


class OrderReadings(Readings):
    """Numbers of the readings."""

    kind = Kind.NUMBER


class Uncertainty(Value):
    """Number, text with a unit, or percentage of each value."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA

    def __init__(self, stated: float | str) -> None:
        self.stated = stated

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Accept the value of a file; the quantity of the data determines its unit."""
        return cls(value)


class PriorValue(Value):
    """Two ends, such as '0.02..0.3 mm', or a distribution `{mean, deviation}`, `{median, factor}`, `{low, high}`."""

    kind: ClassVar[Kind]
    schema: ClassVar[Mapping[str, Any]] = {"type": ["string", "object"], "additionalProperties": QUANTITY_SCHEMA}

    def __init__(self, prior: Prior) -> None:
        self.prior = prior

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert the prior of an unknown."""
        if isinstance(value, str):
            return cls(ends_of(name, value, cls.kind))
        if not isinstance(value, Mapping):
            raise ValueError(
                f"{name} = {shown(value)} must be two ends, such as '0.02..0.3 mm', or {{mean, deviation}}"
            )
        return cls(distribution_of(name, value, lambda key, number: parse(key, number, cls.kind)))


class ErrorSize(Value):
    """Size of an error of a machine: a number, or two ends such as '0..20 um'."""

    kind: ClassVar[Kind]
    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA

    def __init__(self, size: NumberOrRange) -> None:
        self.size = size

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert the size of an error."""
        is_range = isinstance(value, str) and ".." in value
        return cls(ends_of(name, value, cls.kind) if is_range else parse(name, value, cls.kind))


_LINER_NUMBERS, _BALL_NUMBERS = (
    {key: FREE_NUMBERS[f"{body}_{key}"] for key in MATERIAL if f"{body}_{key}" in FREE_NUMBERS}
    for body in ("liner", "ball")
)
FreeLiner = table_of_quantities("FreeLiner", _LINER_NUMBERS, PriorValue)
"""Unknowns of the liner."""

FreeBall = table_of_quantities("FreeBall", _BALL_NUMBERS, PriorValue)
"""Unknowns of the ball."""


class FreeMaterials(Table, kw_only=True):
    """Unknowns of materials."""

    liner: FreeLiner | None = None  # type: ignore[valid-type]
    ball: FreeBall | None = None  # type: ignore[valid-type]


FreeTable = table_of_quantities("FreeTable", FREE_NUMBERS, PriorValue, (FreeMaterials,))
"""Unknowns with their priors."""

class MachineKeys(Table, kw_only=True):
    """Machine."""

    qualified: ClassVar[bool] = True


MachineTable = table_of_quantities(
    "MachineTable", {name: error.quantity for name, error in MACHINE_ERRORS.items()}, ErrorSize, (MachineKeys,)
)
"""Errors of a machine."""


class DataKeys(Table, kw_only=True):
    """Set of data: columns of a file, or a quantity with its values."""

    file: Annotated[Text | None, meaning("CSV or Parquet file, whose heads have units")] = None
    quantities: Annotated[Texts | None, meaning("measured columns; all by default")] = None
    load: Annotated[Text | None, meaning("column of the load; force by default")] = None
    gaps: Annotated[Literal["refuse", "leave-out"], meaning("rows with a missing number")] = "refuse"
    quantity: Annotated[Text | None, meaning("measured quantity of the values")] = None
    values: Annotated[Readings | None, meaning("measured values")] = None
    mass: Annotated[Mass | None, meaning("mass of the ball, for a frequency")] = None
    order: Annotated[OrderReadings | None, meaning("numbers of the readings, for a drift")] = None
    name: Annotated[Text | None, meaning("name of the data in tables and notes")] = None
    uncertainty: Annotated[Uncertainty | None, meaning("standard uncertainty of the values")] = None
    load_uncertainty: Annotated[Uncertainty | None, meaning("standard uncertainty of the loads")] = None
    saturation: Annotated[Modulus | None, meaning("largest reading of a film or sensor")] = None
    machine: Annotated[Text | None, meaning("name of the machine: [machine.NAME]")] = None


DataTable = table_of_quantities("DataTable", {**LOADS, "angle": FIELD["angle"]}, Readings, (DataKeys,))
"""Set of data with its loads and angles."""

_FILE_KEYS = ("file", "quantities", "load", "gaps")
_VALUE_KEYS = ("quantity", "values", "angle", "mass", "order", *LOADS)
_COMMON_KEYS = ("name", "uncertainty", "load_uncertainty", "saturation", "machine")


class IdentifyTable(JointTables, kw_only=True):
    """Identification file."""

    model: Annotated[Text | None, meaning("name of the model; tabulated by default")] = None
    scatter: Annotated[Literal["normal", "heavy-tailed"], meaning("scatter of the data: heavy-tailed for outliers")] = (
        "normal"
    )
    free: FreeTable | None = None  # type: ignore[valid-type]
    machine: dict[str, MachineTable] | None = None  # type: ignore[valid-type]
    data: Annotated[list[DataTable] | None, meaning("sets of data")] = None  # type: ignore[valid-type]


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
    - `[[data]]` with a `quantity`, `values` (one or a list) and its load; a "frequency" needs its `mass`.
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
    """Convert the tables of a file to model, joint, data and unknowns."""
    tables = read_table(content, IdentifyTable)
    joint_file = joint_in(tables, folder)
    machines = {name: _parse_machine(name, table) for name, table in (tables.machine or {}).items()}
    if not tables.data:
        raise ValueError("the file has no measurements: add [[data]] before each set")
    sets = [
        measured
        for table, keys in zip(tables.data, content["data"], strict=True)
        for measured in _parse_data_table(table, keys, machines, folder)
    ]
    return IdentifyFile(
        model=named_model(tables.model or "tabulated").in_cup(joint_file.cup),
        joint=joint_file.joint,
        data=tuple(sets),
        free=_parse_unknowns(tables.free, content.get("free", {})),
        scatter=_SCATTER_MODELS[tables.scatter],
    )


def _parse_unknowns(table: Any, content: Mapping[str, Any]) -> dict[str, Prior]:
    """Return the priors of the unknowns by name; those of a material may have their own table, `liner.young`."""
    priors: dict[str, Prior] = {}
    for name in content:
        if name in ("liner", "ball"):
            of_material = values_of(getattr(table, name), PriorValue, content[name])
            priors |= {f"{name}_{number}": entry.prior for number, entry in of_material.items()}
        else:
            priors[name] = getattr(table, name).prior
    return priors


def _parse_machine(name: str, table: Any) -> Machine:
    """Create a machine with its errors."""
    sizes = {error: entry.size for error in MACHINE_ERRORS if (entry := getattr(table, error)) is not None}
    return Machine(name=name, **sizes)


def _parse_data_table(
    table: Any, keys: Mapping[str, Any], machines: Mapping[str, Machine], folder: Path
) -> tuple[Measured, ...]:
    """Create the sets of data of one table; `keys` are those that the file states."""
    if ("file" in keys) == ("values" in keys):
        raise ValueError("[[data]] needs either a file, or a quantity with its values")
    machine = IDEAL_MACHINE if table.machine is None else machines[known_name("machine", table.machine, machines)]
    if "file" in keys:
        check_names(keys, (*_FILE_KEYS, *_COMMON_KEYS), "in [[data]] with a file")
        return _data_from_file(table, machine, folder)
    check_names(keys, (*_VALUE_KEYS, *_COMMON_KEYS), "in [[data]] with values")
    return (_data_from_values(table, machine),)


def _data_from_file(table: Any, machine: Machine, folder: Path) -> tuple[Measured, ...]:
    """Read the sets of data of a table that names a CSV or Parquet file."""
    load = str(table.load or "")
    return read_measured(
        folder / table.file,
        quantities=table.quantities or [],
        load=load,
        uncertainty=None if table.uncertainty is None else table.uncertainty.stated,
        load_uncertainty=_parse_load_uncertainty(table, load or "force"),
        machine=machine,
        gaps=Gaps(table.gaps),
        **_saturation_argument(table),
    )


def _data_from_values(table: Any, machine: Machine) -> Measured:
    """Create the set of data of a table that lists its values."""
    for key in ("quantity", "uncertainty"):
        if getattr(table, key) is None:
            raise ValueError(f"[[data]] with values needs its {key}")
    name = known_name("quantity", table.quantity, _QUANTITIES)
    values = numpy.array([parse(name, number, _QUANTITIES[name].kind) for number in table.values])
    loads: dict[str, Any] = {
        key: numpy.array(numbers) for key in (*LOADS, "order", "angle") if (numbers := getattr(table, key)) is not None
    }
    return Measured(
        quantity=name,
        values=values,
        uncertainty=parse_uncertainty(_QUANTITIES[name], table.uncertainty.stated, values),
        observable=_parse_observable(name, table),
        load_uncertainty=_parse_load_uncertainty(table, next((kind for kind in LOADS if kind in loads), "force")),
        machine=machine,
        name=str(table.name or ""),
        **loads,
        **_saturation_argument(table),
    )


def _parse_observable(name: str, table: Any) -> CustomObservable | None:
    """Return the custom observable of a frequency; None for a quantity of a contact."""
    if (name == FREQUENCY.name) != (table.mass is not None):
        raise ValueError("[[data]] of a frequency needs its mass, and other data take none")
    return None if table.mass is None else oscillation(float(table.mass))


def _saturation_argument(table: Any) -> dict[str, float]:
    """Return the saturation as an argument of `Measured`, if it is stated."""
    return {} if table.saturation is None else {"saturation": float(table.saturation)}


def _parse_load_uncertainty(table: Any, load: str) -> float:
    """Return the uncertainty of the loads; 0 by default."""
    if table.load_uncertainty is None:
        return 0.0
    return parse("load_uncertainty", table.load_uncertainty.stated, LOADS[load].kind)
