"""Study files: TOML with units that describes a model, a joint and a design of cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

from ..contact import Model
from ..core.checks import check_filled, check_names, shown
from ..core.executors.dask import Distributed
from ..core.executors.processes import Engine, Processes, Serial
from ..core.quantities import YIELD_LIMITS
from ..core.storage.atomic_files import address_of, check_local
from ..files.columns import HeadKeys
from ..files.joint_file import JointTables, joint_in
from ..files.schema import (
    QUANTITIES_SCHEMA,
    QUANTITY_SCHEMA,
    FileTable,
    Parsed,
    Text,
    WholeNumber,
    Word,
    meaning,
    quantity_keys,
    with_keys,
)
from ..files.tables import parsed_values, read_table
from ..files.toml import read_toml
from ..files.units import as_given, parse
from ..model_catalogue import named_models, with_gap, with_yielding
from ..problem import Joint
from ..problem.gaps import GAP_KINDS
from ..problem.presets import materials, named_material
from .axes import Span
from .design import Design, grid, sample, table
from .distributions import Distribution, Method
from .expressions import DISTRIBUTION_SCHEMA, distribution_of, parse_correlations
from .parameters import LOADS, PARAMETERS
from .task import QUANTITIES


class ScatteredNumber(Parsed):
    """Distribution `{low, high}`, `{mean, deviation}`, `{median, factor}` or `{nominal, plus_minus}`."""

    schema: ClassVar[Mapping[str, Any]] = DISTRIBUTION_SCHEMA

    @classmethod
    def parse(cls, name: str, value: Any) -> Distribution:
        return distribution_of(name, value, lambda key, number: parse(key, number, cls.kind))


class ModelName(Word):
    """Name of a model."""

    noun, choices = "model", tuple(named_models)


class GapName(Word):
    """Name of a gap."""

    noun, choices = "gap", tuple(GAP_KINDS)


ModelGap = Annotated[
    GapName | None,
    meaning(
        "gap of exact, fem and sphere: linear, Eq. (6), or circular, Eq. (5); linear up to a clearance of 0.01 R2, "
        "else circular by default"
    ),
]
"""Gap of the model of a file."""


class AxisValues(Parsed):
    """Number, list of numbers, or equal steps `{from, to, count}`."""

    schema: ClassVar[Mapping[str, Any]] = {
        "anyOf": [
            *QUANTITIES_SCHEMA["anyOf"],
            {
                "type": "object",
                "properties": {"from": QUANTITY_SCHEMA, "to": QUANTITY_SCHEMA, "count": WholeNumber.json_schema()},
                "required": ["from", "to", "count"],
                "additionalProperties": False,
            },
        ]
    }

    @classmethod
    def parse(cls, name: str, value: Any) -> float | list[float] | Span:
        if isinstance(value, list):
            return [parse(f"{name}[{i}]", number, cls.kind) for i, number in enumerate(value)]
        if isinstance(value, str) and ".." in value:
            raise ValueError(f"{name} = {shown(value)} must be a list, or equal steps such as {{from, to, count}}")
        if not isinstance(value, Mapping):
            return parse(name, value, cls.kind)
        check_names(value, ("from", "to", "count"), f"in {name}")
        missing = [key for key in ("from", "to", "count") if key not in value]
        if missing:
            raise ValueError(f"{name} needs from, to and count; missing: {', '.join(missing)}")
        low, high = (parse(f"{name}.{key}", value[key], cls.kind) for key in ("from", "to"))
        with as_given(value, f"{name}."):
            return Span(low, high, WholeNumber.read(f"{name}.count", value["count"]))


class AxisMaterials(Parsed):
    """Name of a material, or list of names."""

    schema: ClassVar[Mapping[str, Any]] = {
        "type": ["string", "array"],
        "items": {"type": "string", "examples": list(materials)},
    }

    @classmethod
    def parse(cls, name: str, value: Any) -> list[Any]:
        return [named_material(name, material) for material in (value if isinstance(value, list) else [value])]


class MethodName(Word):
    """Method of sampling."""

    choices = tuple(method.value for method in Method)


class EngineKind(Word):
    """Kind of executor."""

    choices = ("serial", "processes", "dask")


@with_keys(quantity_keys(PARAMETERS, AxisValues))
class AxesTable(FileTable, frozen=True, kw_only=True):
    """Axes of a grid: values of parameters, and materials."""

    liner: Annotated[AxisMaterials | None, meaning("materials of the liner")] = None
    ball: Annotated[AxisMaterials | None, meaning("materials of the ball")] = None


@with_keys(quantity_keys(PARAMETERS, ScatteredNumber))
class SamplesTable(FileTable, frozen=True, kw_only=True):
    """Samples: their number, and a distribution for each parameter that varies."""

    count: Annotated[WholeNumber, meaning("number of samples")]
    seed: Annotated[WholeNumber, meaning("seed of the samples")] = WholeNumber(0)
    method: Annotated[MethodName, meaning("method of sampling")] = MethodName(Method.SOBOL.value)
    correlation: Annotated[
        list[Text] | None, meaning("rank correlations of pairs, such as 'clearance, liner_young = 0.5'")
    ] = None


class RowsTable(HeadKeys, frozen=True, kw_only=True):
    """Table of cases."""

    path: Annotated[Text, meaning("table in a file with a column for each parameter")]


class EngineTable(FileTable, frozen=True, kw_only=True):
    """Executor of a study."""

    qualified: ClassVar[bool] = True

    kind: Annotated[EngineKind, meaning("kind of executor")]
    workers: Annotated[WholeNumber | None, meaning("number of worker processes")] = None
    address: Annotated[Text | None, meaning("address of a Dask scheduler")] = None


class StudyTable(JointTables, frozen=True, kw_only=True):
    """Study file."""

    model: Annotated[ModelName, meaning("name of the model")] = ModelName("hess-forsbach")
    gap: ModelGap = None
    plastic: Annotated[bool, meaning("true for finite elements whose liner may yield")] = False
    axes: AxesTable | None = None
    samples: SamplesTable | None = None
    table: RowsTable | None = None
    quantities: Annotated[list[Text] | None, meaning("quantities of the contact; all by default")] = None
    store: Annotated[Text | None, meaning("folder of the results")] = None
    engine: EngineTable = EngineTable(kind=EngineKind("serial"))


@dataclass(frozen=True, eq=False)
class StudyFile:
    """Contents of a study file."""

    model: Model
    joint: Joint
    design: Design
    quantities: tuple[str, ...]  # empty by default, see `quantities_of`
    store: str | Path | None
    engine: Engine

    def quantities_of(self, model: Model) -> tuple[str, ...]:
        """Return the requested quantities; by default all of a model, but for the limits of yielding."""
        return self.quantities or tuple(
            name for name in (*QUANTITIES, *model.further_quantities) if name not in YIELD_LIMITS
        )


def read_study(path: str | Path) -> StudyFile:
    """Read a study file.

    The design is the product of `[axes]`, `[samples]` and the rows of a `[table]`. The joint is described as in joint
    files, or named. A design without a load has that of the joint file. The page "Keys of files" of the reference lists
    all tables and keys. Paths are relative to the folder of the file.

    Raises ValueError: one sentence: the error, and the nearest allowed name.
    Raises OSError: a file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "study", lambda content: _study(content, path.parent))


def _study(content: Mapping[str, Any], folder: Path) -> StudyFile:
    tables = read_table(content, StudyTable)
    file = joint_in(tables, folder)
    model = with_gap(named_models[tables.model], tables.gap).in_cup(file.cup, **file.aim)
    model = with_yielding(model) if tables.plastic else model
    design = _design(tables, content, folder)
    if not any(name in LOADS for name in design.names):
        design = design * grid(**file.load)
    store = None if tables.store is None else str(check_filled("store", tables.store))
    return StudyFile(
        model=model,
        joint=file.joint,
        design=design,
        quantities=tuple(map(str, tables.quantities or ())),
        store=store if store is None or address_of(store) is not None else folder / store,
        engine=_engine(tables.engine),
    )


def _engine(table: EngineTable) -> Engine:
    if table.kind == "serial" and table.workers is not None:
        raise ValueError("engine kind 'serial' has no workers: 'processes' and 'dask' have")
    if table.kind != "dask" and table.address is not None:
        raise ValueError(f"engine kind {str(table.kind)!r} has no address: 'dask' has")
    workers = None if table.workers is None else int(table.workers)
    if table.kind == "dask":
        address = None if table.address is None else check_filled("address", table.address)
        return Distributed(address=address, workers=workers)
    return Processes(workers=workers) if table.kind == "processes" else Serial()


def _design(tables: StudyTable, content: Mapping[str, Any], folder: Path) -> Design:
    axes = content.get("axes", {})
    values = parsed_values(tables.axes, axes)
    texts: dict[str, Any] = {}  # as the file writes them, by name and index; of equal steps both ends
    for name, stated in axes.items():
        ends = [stated.get("from"), stated.get("to")] if isinstance(stated, Mapping) else stated
        texts |= {f"{name}[{i}]": text for i, text in enumerate(ends if isinstance(ends, list) else [ends])}
    with as_given(texts, "axes."):
        design = grid(**values)
    if tables.samples is not None:
        samples = tables.samples
        spreads = parsed_values(samples, content["samples"])
        drawn = sample(
            int(samples.count),
            seed=int(samples.seed),
            method=Method(samples.method),
            correlation=parse_correlations(samples.correlation or ()),
            **spreads,
        )
        design = drawn * design
    if tables.table is not None:
        path = check_filled("path", tables.table.path)
        check_local(path)
        design = table(folder / path, tables.table.choice()) * design
    if not design.names:
        raise ValueError("nothing varies: a table [axes], [samples] or [table] is needed")
    return design
