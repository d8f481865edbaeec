"""Identification files: TOML with units to model, joint, unknowns and data. Unknown keys are errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy

from ..contact import Model
from ..core.checks import check_names, known_name, shown
from ..core.quantities import FIELD, LOADS, MATERIAL
from ..files.columns import HeadKeys
from ..files.joint_file import JointTables, joint_in
from ..files.schema import (
    QUANTITIES_SCHEMA,
    QUANTITY_SCHEMA,
    FileTable,
    Parsed,
    Pressure,
    QuantityValue,
    Text,
    Texts,
    Word,
    meaning,
    quantity_keys,
    with_keys,
)
from ..files.tables import parsed_values, quantities_of, read_table
from ..files.toml import read_toml
from ..files.units import parse
from ..model_catalogue import named_models, with_gap
from ..problem import Joint
from ..studies.expressions import DISTRIBUTION_SCHEMA, distribution_of, parse_ends
from ..studies.file import ModelGap, ModelName
from .columns import Gaps, parse_uncertainty, read_measured
from .maximum_likelihood import identify
from .measured import ALIASES, IDEAL_MACHINE, MEASURED, Machine, Measured, NumberOrRange
from .observables import FILE_OBSERVABLES, CustomObservable
from .registry import FREE_NUMBERS, MACHINE_ERRORS
from .result import IdentificationResult
from .scatter import HeavyTailed, NormalScatter, ScatterModel
from .unknowns import Prior

_QUANTITIES = {
    **MEASURED,
    **{alias: MEASURED[name] for alias, name in ALIASES.items()},
    **{name: observable.described for name, observable in FILE_OBSERVABLES.items()},
}
_SCATTER_MODELS: Mapping[str, ScatterModel] = {"normal": NormalScatter(), "heavy-tailed": HeavyTailed()}
_FILE_KEYS = ("quantities", "load", "gaps", "columns", "skip")  # keys of data in a file only


class Numbers(Parsed):
    """Number, or list of numbers."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITIES_SCHEMA

    @classmethod
    def parse(cls, name: str, value: Any) -> numpy.ndarray:
        return numpy.array(
            [parse(name, number, cls.kind) for number in (value if isinstance(value, list) else [value])]
        )


class Readings(Parsed):
    """Number, or list of numbers, in the unit of the quantity."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITIES_SCHEMA


class Uncertainty(Parsed):
    """Number in the unit of the quantity, or percentage of each value."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA


class PriorValue(Parsed):
    """Two ends, such as '0.02..0.3 mm', or distribution `{mean, deviation}`, `{median, factor}`."""

    schema: ClassVar[Mapping[str, Any]] = {"anyOf": [{"type": "string"}, DISTRIBUTION_SCHEMA]}

    @classmethod
    def parse(cls, name: str, value: Any) -> Prior:
        if isinstance(value, str):
            return parse_ends(name, value, cls.kind)
        if not isinstance(value, Mapping):
            ends = f"0.02..0.3 {cls.kind.assumed_unit}".strip()
            raise ValueError(
                f"{name} = {shown(value)} must be two ends as text, such as {ends!r}, or {{mean, deviation}}"
            )
        return distribution_of(name, value, lambda key, number: parse(key, number, cls.kind))


class ErrorSize(Parsed):
    """Number, or two ends such as '0..20 um'."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA

    @classmethod
    def parse(cls, name: str, value: Any) -> NumberOrRange:
        is_range = isinstance(value, str) and ".." in value
        return parse_ends(name, value, cls.kind) if is_range else parse(name, value, cls.kind)


class ScatterName(Word):
    """Scatter of data."""

    choices = tuple(_SCATTER_MODELS)


class GapsName(Word):
    """Treatment of rows with a missing number."""

    choices = tuple(gaps.value for gaps in Gaps)


class QuantityName(Word):
    """Name of a measured quantity."""

    noun, choices = "quantity", tuple(_QUANTITIES)


_LINER_NUMBERS, _BALL_NUMBERS = (
    {key: FREE_NUMBERS[f"{body}_{key}"] for key in MATERIAL if f"{body}_{key}" in FREE_NUMBERS}
    for body in ("liner", "ball")
)


@with_keys(quantity_keys(_LINER_NUMBERS, PriorValue))
class FreeLinerTable(FileTable, frozen=True, kw_only=True):
    """Unknowns of the liner with their priors."""


@with_keys(quantity_keys(_BALL_NUMBERS, PriorValue))
class FreeBallTable(FileTable, frozen=True, kw_only=True):
    """Unknowns of the ball with their priors."""


@with_keys(quantity_keys(FREE_NUMBERS, PriorValue))
class FreeTable(FileTable, frozen=True, kw_only=True):
    """Unknowns with their priors."""

    liner: FreeLinerTable | None = None
    ball: FreeBallTable | None = None


@with_keys(quantity_keys({name: error.quantity for name, error in MACHINE_ERRORS.items()}, ErrorSize))
class MachineTable(FileTable, frozen=True, kw_only=True):
    """Errors of a machine."""

    qualified: ClassVar[bool] = True


@with_keys(
    quantity_keys({**LOADS, "angle": FIELD["angle"]}, Numbers)
    | {
        observable.argument: Annotated[
            QuantityValue.of(observable.kind), meaning(f"{observable.argument.replace('_', ' ')}, for data of a {name}")
        ]
        for name, observable in FILE_OBSERVABLES.items()
    }
)
class DataTable(HeadKeys, frozen=True, kw_only=True):
    """Set of data with its loads: columns of a file, or a quantity with its values."""

    file: Annotated[Text | None, meaning("table of measurements, whose heads have units")] = None
    quantities: Annotated[Texts | None, meaning("measured columns; all by default")] = None
    load: Annotated[Text | None, meaning("column of the load; force by default")] = None
    gaps: Annotated[GapsName | None, meaning("rows with a missing number; refuse by default")] = None
    quantity: Annotated[QuantityName | None, meaning("measured quantity of the values")] = None
    values: Annotated[Readings | None, meaning("measured values")] = None
    order: Annotated[Numbers | None, meaning("numbers of the readings, for a drift")] = None
    name: Annotated[Text | None, meaning("name of the data in tables and notes")] = None
    uncertainty: Annotated[Uncertainty | None, meaning("standard uncertainty; from the scatter by default")] = None
    load_uncertainty: Annotated[Uncertainty | None, meaning("standard uncertainty of the loads")] = None
    saturation: Annotated[Pressure | None, meaning("largest reading of a film or sensor")] = None
    machine: Annotated[Text | None, meaning("name of the machine: [machine.NAME]")] = None


class IdentifyTable(JointTables, frozen=True, kw_only=True):
    """Identification file."""

    model: Annotated[ModelName, meaning("name of the model")] = ModelName("tabulated")
    gap: ModelGap = None
    scatter: Annotated[ScatterName, meaning("scatter of the data; heavy-tailed for outliers")] = ScatterName("normal")
    free: FreeTable | None = None
    machine: dict[str, MachineTable] | None = None
    data: Annotated[list[DataTable] | None, meaning("sets of data")] = None


@dataclass(frozen=True, kw_only=True, eq=False)
class IdentifyFile:
    """Parsed contents of an identification file."""

    model: Model
    joint: Joint
    data: tuple[Measured, ...]
    free: dict[str, Prior]  # unknowns by name
    scatter: ScatterModel

    def identify_unknowns(self) -> IdentificationResult:
        """Identify the unknowns of the file from its measurements."""
        return identify(self.model, self.joint, self.data, self.free, scatter=self.scatter)


def read_identify(path: str | Path) -> IdentifyFile:
    """Read an identification file (TOML).

    It has the joint as in study files, the unknowns in `[free]`, and each set of data in `[[data]]`: a `file`, or a
    `quantity` with its `values` and its load. The page "Keys of files" of the reference lists all tables and keys.
    Paths are relative to the folder of the file.

    Raises ValueError: one sentence: the error, and the nearest allowed name.
    Raises OSError: a file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "measurement", lambda content: _parse_file(content, path.parent))


def _parse_file(content: Mapping[str, Any], folder: Path) -> IdentifyFile:
    tables = read_table(content, IdentifyTable)
    joint_file = joint_in(tables, folder)
    if not tables.data:
        raise ValueError("the file has no measurements: add [[data]] before each set")
    machines = {
        name: Machine(name=name, **parsed_values(table, content["machine"][name]))
        for name, table in (tables.machine or {}).items()
    }
    free, free_numbers = tables.free or FreeTable(), content.get("free", {})
    priors, bodies = parsed_values(free, free_numbers), {"liner": free.liner, "ball": free.ball}
    unknowns: dict[str, Prior] = {}
    for name, numbers in free_numbers.items():
        if name in priors:
            unknowns[name] = priors[name]
        else:  # a material with a table of its own
            own = parsed_values(bodies[name], numbers)
            unknowns |= {f"{name}_{number}": prior for number, prior in own.items()}
    return IdentifyFile(
        model=with_gap(named_models[tables.model], tables.gap).in_cup(joint_file.cup, **joint_file.aim),
        joint=joint_file.joint,
        data=tuple(measured for table in tables.data for measured in _parse_data_table(table, machines, folder)),
        free=unknowns,
        scatter=_SCATTER_MODELS[tables.scatter],
    )


def _parse_data_table(table: DataTable, machines: Mapping[str, Machine], folder: Path) -> tuple[Measured, ...]:
    if (table.file is None) == (table.values is None):
        raise ValueError("[[data]] needs either a file, or a quantity with its values")
    machine = IDEAL_MACHINE if table.machine is None else machines[known_name("machine", table.machine, machines)]
    common: dict[str, Any] = {"machine": machine, **quantities_of(table, "saturation")}
    both = ("name", "uncertainty", "load_uncertainty", "saturation", "machine")
    if table.values is None:
        check_names(table.stated(), ("file", *_FILE_KEYS, *both), "in [[data]] with a file")
        load = str(table.load or "")
        return read_measured(
            folder / (table.file or ""),
            quantities=table.quantities or [],
            load=load,
            uncertainty=None if table.uncertainty is None else table.uncertainty.value,
            load_uncertainty=_parse_load_uncertainty(table, load or "force"),
            gaps=Gaps.REFUSE if table.gaps is None else Gaps(table.gaps),
            heads=table.choice(),
            **common,
        )
    own = [key for key in table.__struct_fields__ if key not in ("file", *_FILE_KEYS)]
    check_names(table.stated(), own, "in [[data]] with values")
    if table.quantity is None:
        raise ValueError("[[data]] with values needs its quantity")
    quantity = _QUANTITIES[table.quantity]
    values = Numbers.of(quantity.kind).parse(quantity.name, table.values.value)
    loads = parsed_values(table, dict.fromkeys((*LOADS, "order", "angle")))
    measured = Measured(
        quantity=quantity.name,
        values=values,
        **parse_uncertainty(quantity, None if table.uncertainty is None else table.uncertainty.value),
        observable=_parse_observable(quantity.name, table),
        load_uncertainty=_parse_load_uncertainty(table, next((name for name in LOADS if name in loads), "force")),
        name=str(table.name or ""),
        **loads,
        **common,
    )
    return (measured,)


def _parse_observable(name: str, table: DataTable) -> CustomObservable | None:
    """Return the custom observable of a quantity such as a frequency; None for a quantity of a contact."""
    arguments = quantities_of(table, *(observable.argument for observable in FILE_OBSERVABLES.values()))
    for quantity, observable in FILE_OBSERVABLES.items():
        if observable.argument in arguments and quantity != name:
            raise ValueError(f"{observable.argument} belongs to [[data]] of a {quantity}, not of {name}")
    if name not in FILE_OBSERVABLES:
        return None
    observable = FILE_OBSERVABLES[name]
    argument = arguments.get(observable.argument, observable.default)
    if argument is None:
        raise ValueError(f"[[data]] of a {name} needs its {observable.argument}")
    return observable.make(argument)


def _parse_load_uncertainty(table: DataTable, load: str) -> float:
    if table.load_uncertainty is None:
        return 0.0
    return parse("load_uncertainty", table.load_uncertainty.value, LOADS[load].kind)
