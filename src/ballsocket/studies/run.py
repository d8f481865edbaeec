"""Run of a study: one joint with varied parameters, pressed with any model, and its default model."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..contact.assembly import check_joint
from ..core import arrays
from ..core.checks import check_names, needs, shown
from ..core.display import counted
from ..core.executors.processes import Engine, Serial, available_memory, count_text, size_text
from ..core.storage.folders import ResultFolder, folder_at
from ..core.storage.pieces import PieceRun
from ..core.validity import OutsideDomainError, check_domain
from ..model_catalogue import catalogue, named_models, reference
from ..problem import Joint
from ..problem.gaps import MAX_LINEAR_CLEARANCE_RATIO
from .axes import CACHED_CHUNKS, Axis, SampleAxis
from .design import Design, check_samples, grid, is_number
from .distributions import CHUNK_SIZE
from .metadata import make_dataset
from .parameters import LOADS, check_aims, press_arguments
from .store import StudyStore, read
from .task import (
    DEFAULT_QUANTITIES,
    DTYPES,
    QUANTITIES,
    STRESSES,
    Task,
    divide_study,
    points_per_block,
    quantity_of_bound,
    with_bounds,
)

if TYPE_CHECKING:
    import xarray

__all__ = ["Listener", "Progress", "read", "study"]
_SERIAL = Serial()
_MANY_HOURS = 100.0  # number of hours that is written without digits after the point


@dataclass(frozen=True)
class Progress:
    """Progress of a study.

    Attributes
    ----------
    n_done : int
        Number of points with a result.
    n_points : int
        Total number of points.
    n_stored : int
        Number of points with a stored result at the start.
    seconds : float
        Time since the start in s.
    """

    n_done: int
    n_points: int
    n_stored: int
    seconds: float

    @property
    def rate(self) -> float:
        """Points per second since the start."""
        return (self.n_done - self.n_stored) / self.seconds if self.seconds > 0 else 0.0

    @property
    def seconds_left(self) -> float:
        """Remaining time in s at this rate; infinite before the first block."""
        return (self.n_points - self.n_done) / self.rate if self.rate > 0 else float("inf")


Listener = Callable[[Progress], None]
"""Function that is called with the progress of a study."""


def study(
    model: Model,
    joint: Joint,
    design: Design | None = None,
    *,
    quantities: Iterable[str] = (),
    store: str | Path | None = None,
    engine: Engine = _SERIAL,
    listen: Listener = lambda progress: None,
    **axes: Any,
) -> xarray.Dataset:
    """Press a joint at every point of a design.

    Parameters
    ----------
    model : Model
        Any model.
    joint : Joint
        Joint of plain numbers; the design replaces those that it names.
    design : Design, optional
        Result of `grid`, `sample`, `table`, or a product of these.
    quantities : iterable of str
        Quantities of a `Contact`. By default indentation, half angle, peak pressure, area, and the force unless it is
        the load. `status` and `valid` are always included. `max_pressure_low` and `max_pressure_high` are the ends of
        the error bar of a quantity. Stresses have them without a request, and the utilisation also has a `verdict`.
    store : path or str, optional
        Folder for a Zarr group, or its address in a remote store that fsspec knows, such as "s3://bucket/hips.zarr".
        Blocks of the same study in this folder are not computed again.
    engine : Engine
        Executor: `Serial()`, `Processes()`, `Distributed()`. The results are bit-identical.
    listen : callable
        Function that is called with the `Progress` after every block.
    **axes : number or sequence of numbers
        A grid, in place of a design or in addition: parameters by name (`PARAMETERS`) in mm, N, MPa, rad.

    Returns
    -------
    xarray.Dataset
        Arrays along the axes by name; `sample` or `row` for samples and tables. Units, names and publications are in
        `attrs`. A point without a result is NaN with a status; an impossible joint has the status `NO_JOINT`. With a
        store, the numbers are read when they are used.

    Raises
    ------
    ValueError
        An unknown name, a number that is not allowed, no load or two, a store of another study, or more points than
        fit into the memory or on the disk.
    OSError
        The store cannot be written; stored blocks remain.

    Examples
    --------
    >>> import ballsocket as bs
    >>> hip = bs.joints["hess-forsbach"]
    >>> pressed = bs.study(bs.HessForsbach(), hip, clearance=[0.05, 0.1, 0.2], force=[1000.0, 3000.0])
    >>> pressed.max_pressure.sel(clearance=0.1, force=3000.0).item().__round__(2)
    11.27
    """
    needs("study", "xarray", "zarr")
    if not isinstance(model, Model):
        hint = f"; bs.catalogue[{model!r}] is one" if isinstance(model, str) and model in catalogue else ""
        raise TypeError(f"model must be a Model, got {shown(model)}{hint}")
    check_joint(joint)
    if not (design is None or isinstance(design, Design)):
        raise TypeError(f"design must be a Design, from grid, sample or table, got {shown(design)}; loads have names")
    if not callable(getattr(engine, "run", None)) or isinstance(engine, type):
        raise TypeError(f"engine must be an Engine, such as Serial() or Processes(workers=2), got {shown(engine)}")
    task = _create_task(model, joint, design, axes, tuple(quantities))
    folder = None if store is None else folder_at(store)
    if folder is None or not folder.exists():
        _check_space(task, folder)
    check_samples(task.design)
    if folder is None:
        return make_dataset(task, _compute_in_memory(task, engine, listen))
    numbers = range(len(task.blocks))
    study_store = StudyStore(task, folder)
    study_store.prepare()
    run = PieceRun(task, numbers, study_store)
    _check_space(task, folder, sum(map(task.blocks.n_points, run.missing)))
    n_stored = len(run.stored)
    try:
        for _ in _report_progress(run.compute_missing(engine), task, run.missing, listen):
            n_stored += 1
    except ConnectionError:
        raise
    except OSError as error:
        state = f"{n_stored} of {counted(len(numbers), 'block')} stored; run the study again to resume"
        raise OSError(error.errno, f"{error.strerror or error}; {state}", str(folder)) from error
    return read(str(folder))


def _create_task(
    model: Model, joint: Joint, design: Design | None, axes: dict[str, Any], quantities: tuple[str, ...]
) -> Task:
    points = (grid(**axes) if design is None else design * grid(**axes)).holding(joint)
    loads = [name for name in LOADS if name in points.names]
    if not loads:
        raise ValueError(f"one load is needed, as an axis or a number: {', '.join(LOADS)}")
    check_aims(model, points.names)
    known = (*QUANTITIES, *model.further_quantities)
    check_names([quantity_of_bound(name) for name in quantities], known, "among the quantities")
    if not all(is_number(number) for number in (*joint.numbers(), *model.parameters)):
        raise ValueError("joint and model of a study have plain numbers: use an axis for a number that varies")
    names = quantities or tuple(name for name in ("force", *DEFAULT_QUANTITIES) if name not in loads)
    names = (*names, *with_bounds(name for name in names if name in STRESSES))
    computed = tuple(dict.fromkeys(name for name in names if quantity_of_bound(name) not in loads))
    return Task(model, joint, points, computed, divide_study(points.shape, points_per_block(model)))


def _check_space(task: Task, folder: ResultFolder | None, n_points: int | None = None) -> None:
    """Check that the results of some points, all by default, fit into the memory, or on the disk of the store."""
    count = task.design.size if n_points is None else n_points
    results = count * _result_size(task)
    hours = count * task.model.seconds_a_press / 3600
    if hours < 1 / 60:
        duration = f"{3600 * hours:.2g} s"
    elif hours < 1:
        duration = f"{60 * hours:.2g} min"
    else:
        duration = f"{hours:.3g} hours" if hours < _MANY_HOURS else f"{count_text(round(hours))} hours"

    def check(size: float, free: float, hint: str) -> None:
        if size > free:
            raise ValueError(
                f"{count_text(count)} points take about {size_text(size)} and {duration} on one core, and there are "
                f"{size_text(free)} {hint}"
            )

    if folder is None:
        check(memory_size(task), available_memory(), "of memory; use a store, or fewer points")
        return
    axes = [axis for axis in task.design.axes if not isinstance(axis, SampleAxis)]
    check(sum(map(_axis_size, axes)), available_memory(), "of memory for the values along its axes; use fewer")
    labels = 8 * sum(len(axis) * len(axis.names) for axis in task.design.axes) if n_points is None else 0
    check(results + labels, folder.free_space(), "on the disk of the store")


def memory_size(task: Task) -> int:
    """Estimate the largest memory in bytes of a study without a store.

    These are its results and the values along its axes, and first two blocks, one computed and one received, then the
    indices of a grid.
    """
    axes, size = task.design.axes, _result_size(task)
    blocks = min(2, len(task.blocks)) * prod(task.blocks.size) * size
    indices = 8 * sum(len(axis) for axis in axes if axis.name in axis.names)
    return task.design.size * size + sum(map(_axis_size, axes)) + max(blocks, indices)


def _result_size(task: Task) -> int:
    return sum(numpy.dtype(DTYPES[name]).itemsize for name in task.variables)


def _axis_size(axis: Axis) -> int:
    """Return the size in bytes of the values along an axis, and of the cached samples."""
    cached = min(len(axis), CACHED_CHUNKS * CHUNK_SIZE) if isinstance(axis, SampleAxis) else 0
    return 8 * (len(axis) + cached) * len(axis.names)


def _compute_in_memory(task: Task, engine: Engine, listen: Listener) -> dict[str, numpy.ndarray]:
    """Compute all blocks; no block is held when this returns."""
    arrays = {name: numpy.empty(task.design.shape, dtype=DTYPES[name]) for name in task.variables}
    numbers = range(len(task.blocks))
    for number, results in _report_progress(engine.run(task, numbers), task, numbers, listen):
        for name, values in results.items():
            arrays[name][task.blocks[number]] = values
    return arrays


def _report_progress(
    results: Iterable[tuple[int, Any]], task: Task, numbers: Iterable[int], listen: Listener
) -> Iterable[tuple[int, Any]]:
    n_points = prod(task.design.shape)
    n_stored = n_done = n_points - sum(task.blocks.n_points(number) for number in numbers)
    start = time.perf_counter()
    listen(Progress(n_done, n_points, n_stored, 0.0))
    for number, result in results:
        yield number, result
        n_done += task.blocks.n_points(number)
        listen(Progress(n_done, n_points, n_stored, time.perf_counter() - start))


def default_model(joint: Joint, ranges: Mapping[str, Any]) -> Model:
    """Choose the model for a joint and the ends or values of its varied parameters; materials by `liner` or `ball`.

    It is `tabulated` unless none of the joints is in its domain. Otherwise it is `exact`, or `exact-curve` for a
    single joint. Joints of a clearance for which the circular gap is the default are solved by `exact`.
    """
    if arrays.all_true(joint_of_arrays(joint, ranges).clearance_ratio > MAX_LINEAR_CLEARANCE_RATIO):
        return reference
    try:
        check_model_domain(named_models["tabulated"], joint, ranges)
    except OutsideDomainError:
        return named_models["exact-curve"] if all(name in LOADS for name in ranges) else reference
    return named_models["tabulated"]


def check_model_domain(model: Model, joint: Joint, ranges: Mapping[str, Any]) -> None:
    """Check that some joint of a range is in the domain of a model.

    Raises OutsideDomainError: no joint is in the domain; the message has the reason.
    """
    check_domain((*model.fits, *model.domain), joint_of_arrays(joint, ranges), model.name)


def joint_of_arrays(joint: Joint, ranges: Mapping[str, Any]) -> Joint:
    """Return all joints of a range as one joint of arrays; parameters are those of `default_model`."""
    design = grid(**ranges)
    return press_arguments(joint, design.values_in([slice(None)] * len(design.axes)))[0]
