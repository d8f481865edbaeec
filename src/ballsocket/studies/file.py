"""Study files: TOML with units that describes a model, a joint and a design of cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from ..catalogue import catalogue, judge, off_axis
from ..contact import Model
from ..core.checks import check_names, check_text, known_name
from ..core.executors.dask import Distributed
from ..core.executors.processes import Engine, Processes, Serial
from ..core.kinds import Kind
from ..elasticity.exact.exact_curve import ExactCurve
from ..files.joint_file import JointTables, named_material
from ..files.named_joint import joint_in
from ..files.schema import (
    QUANTITY_SCHEMA,
    Table,
    Text,
    Value,
    Whole,
    meaning,
    read_table,
    table_of_quantities,
    values_of,
)
from ..files.toml import read_toml
from ..files.units import parse
from ..problem import Joint, Material
from .axes import Method, Span
from .design import Design, grid, sample
from .distributions import Distribution
from .parameters import PARAMETERS
from .rows import table
from .scatter import distribution_of

models: dict[str, Model] = {**catalogue, "exact-curve": ExactCurve(), judge.name: judge, off_axis.name: off_axis}
"""By the names that files and the command line use."""


class AxisValues(Value):
    """Values of an axis: a number, a list of numbers, or equal steps `{from, to, count}`."""

    kind: ClassVar[Kind]
    schema: ClassVar[Mapping[str, Any]] = {
        "anyOf": [
            QUANTITY_SCHEMA,
            {"type": "array", "items": QUANTITY_SCHEMA},
            {
                "type": "object",
                "properties": {"from": QUANTITY_SCHEMA, "to": QUANTITY_SCHEMA, "count": {"type": "integer"}},
                "required": ["from", "to", "count"],
                "additionalProperties": False,
            },
        ]
    }

    def __init__(self, values: float | list[float] | Span) -> None:
        self.values = values

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert the values of an axis."""
        if isinstance(value, list):
            return cls([parse(f"{name}[{i}]", number, cls.kind) for i, number in enumerate(value)])
        if not isinstance(value, Mapping):
            return cls(parse(name, value, cls.kind))
        check_names(value, ("from", "to", "count"), f"in {name}")
        missing = [key for key in ("from", "to", "count") if key not in value]
        if missing:
            raise ValueError(f"{name} needs from, to and count; missing: {', '.join(missing)}")
        low, high = (parse(f"{name}.{key}", value[key], cls.kind) for key in ("from", "to"))
        return cls(Span(low, high, Whole.read(f"{name}.count", value["count"])))


class AxisMaterials(Value):
    """Materials of an axis: the name of a preset, or a list of names."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["string", "array"], "items": {"type": "string"}}

    def __init__(self, materials: list[Material]) -> None:
        self.values = materials

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert the names of materials."""
        return cls([named_material(name, each) for each in (value if isinstance(value, list) else [value])])


class SampledNumber(Value):
    """Distribution of a number: `{low, high}`, `{mean, deviation}`, `{median, factor}` or `{nominal, plus_minus}`."""

    kind: ClassVar[Kind]
    schema: ClassVar[Mapping[str, Any]] = {"type": "object", "additionalProperties": QUANTITY_SCHEMA}

    def __init__(self, distribution: Distribution) -> None:
        self.distribution = distribution

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a distribution."""
        return cls(distribution_of(name, value, lambda key, number: parse(key, number, cls.kind)))


class MaterialAxes(Table, kw_only=True):
    """Axes of materials."""

    liner: Annotated[AxisMaterials | None, meaning("materials of the liner")] = None
    ball: Annotated[AxisMaterials | None, meaning("materials of the ball")] = None


class SamplesTable(Table, kw_only=True):
    """Samples of distributions."""

    count: Annotated[Whole, meaning("number of samples")]
    seed: Annotated[Whole | None, meaning("seed of the samples; 0 by default")] = None
    method: Annotated[Method, meaning("how samples fill the space: sobol or latin-hypercube")] = Method.SOBOL


class RowsTable(Table, kw_only=True):
    """Table of cases."""

    path: Annotated[Text, meaning("CSV or Parquet file with a column for each parameter")]


class EngineTable(Table, kw_only=True):
    """Executor of a study."""

    kind: Annotated[Literal["serial", "processes", "dask"], meaning("executor: serial, processes or dask")]
    workers: Annotated[Whole | None, meaning("number of worker processes")] = None
    address: Annotated[Text | None, meaning("address of a Dask scheduler")] = None


AxesTable = table_of_quantities("AxesTable", PARAMETERS, AxisValues, (MaterialAxes,))
"""Axes of a grid, by parameter."""

SampledTable = table_of_quantities("SampledTable", PARAMETERS, SampledNumber, (SamplesTable,))
"""Samples with a distribution for each parameter that varies."""


class StudyTable(JointTables, kw_only=True):
    """Study file."""

    model: Annotated[Text | None, meaning("name of the model; hess-forsbach by default")] = None
    axes: AxesTable | None = None  # type: ignore[valid-type]
    samples: SampledTable | None = None  # type: ignore[valid-type]
    table: RowsTable | None = None
    quantities: Annotated[list[Text] | None, meaning("quantities of the contact; all by default")] = None
    store: Annotated[Text | None, meaning("folder of the results")] = None
    engine: EngineTable | None = None


@dataclass(frozen=True, eq=False)
class StudyFile:
    """What a study file says."""

    model: Model
    joint: Joint
    design: Design
    quantities: tuple[str, ...]
    store: Path | None
    engine: Engine


def read_study(path: str | Path) -> StudyFile:
    """Read a study file.

    Tables: `axes`, a parameter each, with a number, a list, or `{from, to, count}`, and `liner` or `ball` with a list
    of materials by name; `samples`, with `count`, `seed`,
    `method` ("sobol", "latin-hypercube") and for each parameter that scatters `{low, high}`, `{mean, deviation}` (with
    `low` and `high` where it is cut off), `{median, factor}` (a factor of one standard deviation) or
    `{nominal, plus_minus}`; `table`, with the `path` of a CSV or Parquet file.
    At the top: `model` (by name), `joint` (a joint file or a preset by name, or a table as in joint files, with
    `liner`, `ball`, `backing`), `quantities`, `store` (a folder), and a table `engine` with `kind` ("serial",
    "processes", "dask"), `workers`, `address`. Numbers are text with a unit or bare in mm, N, MPa, degrees. Paths are
    taken from the file's own folder.

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "study", lambda content: _study(content, path.parent))


def _study(content: Mapping[str, Any], folder: Path) -> StudyFile:
    """Create the study of a file in a folder."""
    tables = read_table(content, StudyTable)
    file = joint_in(tables, folder)
    return StudyFile(
        model=named_model(tables.model or "hess-forsbach").in_cup(file.cup),
        joint=file.joint,
        design=_design(tables, content, folder),
        quantities=tuple(map(str, tables.quantities or [])),
        store=None if tables.store is None else folder / _filled("store", tables.store),
        engine=Serial() if tables.engine is None else _engine(tables.engine),
    )


def named_model(name: Any) -> Model:
    """Return a model by its name in the catalogue, or the finite elements.

    Raises
    ------
    ValueError
        A name that is not known, with the nearest one.
    """
    return models[known_name("model", name, models)]


def _engine(table: EngineTable) -> Engine:
    """Create an executor."""
    if table.kind == "serial" and table.workers is not None:
        raise ValueError("engine kind 'serial' has no workers: 'processes' and 'dask' have")
    if table.kind != "dask" and table.address is not None:
        raise ValueError(f"engine kind {table.kind!r} has no address: 'dask' has")
    workers = None if table.workers is None else int(table.workers)
    if table.kind == "dask":
        return Distributed(
            address=None if table.address is None else _filled("address", table.address), workers=workers
        )
    return Processes(workers=workers) if table.kind == "processes" else Serial()


def _design(tables: StudyTable, content: Mapping[str, Any], folder: Path) -> Design:
    """Create the design of a study: the product of samples, rows of a table and a grid."""
    axes = values_of(tables.axes, AxisValues | AxisMaterials, content.get("axes", {}))
    design = grid(**{name: axis.values for name, axis in axes.items()})
    if tables.samples is not None:
        design = _samples(tables.samples, content["samples"]) * design
    if tables.table is not None:
        design = table(folder / _filled("path", tables.table.path)) * design
    if not design.names:
        raise ValueError("nothing varies: a table [axes], [samples] or [table] is needed")
    return design


def _samples(samples: Any, content: Mapping[str, Any]) -> Design:
    """Create samples of distributions."""
    sampled = {name: entry.distribution for name, entry in values_of(samples, SampledNumber, content).items()}
    return sample(int(samples.count), seed=int(samples.seed or 0), method=samples.method, **sampled)


def _filled(name: str, text: str) -> str:
    """Return a text that is not empty as plain text.

    Raises
    ------
    ValueError
        An empty text.
    """
    if not check_text(name, text):
        raise ValueError(f"{name} is empty")
    return str(text)
