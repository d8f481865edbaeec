"""A study file: TOML with units in; model, joint and design out. Strict, as joint files are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..catalogue import catalogue, judge, off_axis
from ..contact import Model
from ..core.checks import check_names, check_text, known_name, nearest, shown
from ..core.executors.dask import Distributed
from ..core.executors.processes import Engine, Processes, Serial
from ..elasticity.exact.exact_curve import ExactCurve
from ..io.joint_file import KEYS, check_keys, named_material
from ..io.named_joint import PARTS, joint_in
from ..io.toml import read_toml, table_of
from ..io.units import parse
from ..problem import Joint
from .axes import Method, Span
from .design import Design, grid, sample, table
from .parameters import MATERIAL_PARTS, PARAMETERS
from .scatter import Read, distribution_of

_TOP = (
    "model",
    *PARTS,
    "axes",
    "samples",
    "table",
    "quantities",
    "store",
    "engine",
)
FILE_KEYS = {"": _TOP, **{name: KEYS[name] for name in PARTS}, "axes": tuple(PARAMETERS)}
_ENGINES = ("serial", "processes", "dask")
_LARGEST = 1 << 53
models: dict[str, Model] = {**catalogue, "exact-curve": ExactCurve(), judge.name: judge, off_axis.name: off_axis}
"""By the names that files and the command line use."""


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
    check_keys(content, "", "at the top", FILE_KEYS)
    quantities = content.get("quantities", [])
    if not (isinstance(quantities, list) and all(isinstance(name, str) for name in quantities)):
        raise ValueError(f"quantities = {shown(quantities)} must be a list of names")
    given = joint_in(content, folder)
    return StudyFile(
        model=named_model(content.get("model", "hess-forsbach")).in_cup(given.cup),
        joint=given.joint,
        design=_design(content, folder),
        quantities=tuple(quantities),
        store=folder / _text("store", content["store"]) if "store" in content else None,
        engine=read_engine(table_of(content, "engine")),
    )


def named_model(name: Any) -> Model:
    """A model by its name in the catalogue, or the finite elements.

    Raises
    ------
    ValueError
        A name that is not known, with the nearest one.
    """
    return models[known_name("model", name, models)]


def read_engine(content: Mapping[str, Any]) -> Engine:
    """An engine from `kind`, `workers` and `address`."""
    check_names(content, ("kind", "workers", "address"), "in [engine]")
    if content and "kind" not in content:
        raise ValueError(f"[engine] needs a kind: {', '.join(_ENGINES)}")
    kind, workers = content.get("kind", "serial"), content.get("workers")
    if kind == "serial" and workers is not None:
        raise ValueError("engine kind 'serial' has no workers: 'processes' and 'dask' have")
    if kind not in _ENGINES:
        raise ValueError(f"engine kind {shown(kind)} is not known{nearest(kind, _ENGINES)}")
    if workers is not None:
        workers = _whole("workers", workers)
    if kind == "dask":
        address = _text("address", content["address"]) if "address" in content else None
        return Distributed(address=address, workers=workers)
    if "address" in content:
        raise ValueError(f"engine kind {kind!r} has no address: 'dask' has")
    return Processes(workers=workers) if kind == "processes" else Serial()


def _design(content: Mapping[str, Any], folder: Path) -> Design:
    axes, samples, rows = (table_of(content, name) for name in ("axes", "samples", "table"))
    check_names(axes, (*PARAMETERS, *MATERIAL_PARTS), "in [axes]")
    design = grid(**{name: _values(name, value) for name, value in axes.items()})
    if samples:
        design = _samples(samples) * design
    if rows:
        check_names(rows, ("path",), "in [table]")
        design = table(folder / _text("path", rows.get("path", ""))) * design
    if not design.names:
        raise ValueError("nothing varies: a table [axes], [samples] or [table] is needed")
    return design


def _values(name: str, value: Any) -> Any:
    """What an axis takes: one number, several, or a span; materials by their names."""
    if name in MATERIAL_PARTS:
        return [named_material(name, each) for each in (value if isinstance(value, list) else [value])]
    kind = PARAMETERS[name].kind
    if isinstance(value, list):
        return [parse(f"{name}[{place}]", each, kind) for place, each in enumerate(value)]
    if not isinstance(value, Mapping):
        return parse(name, value, kind)
    check_names(value, ("from", "to", "count"), f"in {name}")
    missing = [key for key in ("from", "to", "count") if key not in value]
    if missing:
        raise ValueError(f"{name} needs from, to and count; missing: {', '.join(missing)}")
    low, high = (parse(f"{name}.{key}", value[key], kind) for key in ("from", "to"))
    return Span(low, high, _whole(f"{name}.count", value["count"]))


def _samples(content: Mapping[str, Any]) -> Design:
    own = ("count", "seed", "method")
    check_names(content, (*own, *PARAMETERS), "in [samples]")
    if "count" not in content:
        raise ValueError("samples.count is missing")
    method = content.get("method", Method.SOBOL.value)
    known = [one.value for one in Method]
    if method not in known:
        raise ValueError(f"method {shown(method)} is not known{nearest(method, known)}")
    scattered = {name: distribution_of(name, value, _read(name)) for name, value in content.items() if name not in own}
    count, seed = _whole("count", content["count"]), _whole("seed", content.get("seed", 0))
    return sample(count, seed=seed, method=Method(method), **scattered)


def _read(name: str) -> Read:
    kind = PARAMETERS[name].kind
    return lambda key, value: parse(key, value, kind)


def _whole(name: str, value: Any) -> int:
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(f"{name} = {shown(value)} must be a whole number")
    if not -_LARGEST < value < _LARGEST:
        raise ValueError(f"{name} = {shown(value)} is too large a number")
    return value


def _text(name: str, value: Any) -> str:
    if not check_text(name, value):
        raise ValueError(f"{name} is empty")
    return value
