"""A study: one joint varied along named axes, pressed by any model."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..catalogue import catalogue
from ..contact import Model
from ..contact.assembly import check_joint
from ..core.checks import check_names, needs, shown
from ..core.executors.processes import Engine, Serial
from ..core.storage.pieces import PieceRun
from ..problem import Joint
from .blocks import Blocks
from .design import Design, check_values, grid, is_one
from .labels import arranged, dataset
from .parameters import LOADS, check_aims
from .room import check_room
from .store import BlockStore, Store
from .task import DTYPES, EDGE_DISTANCE, QUANTITIES, USUAL, Task, points_a_block

if TYPE_CHECKING:
    import xarray

_HERE = Serial()


@dataclass(frozen=True)
class Progress:
    """How far a study is: points that are done, points in all, those found done at the start, seconds since then."""

    done: int
    points: int
    found: int
    seconds: float

    @property
    def rate(self) -> float:
        """Points a second since the start."""
        return (self.done - self.found) / self.seconds if self.seconds > 0 else 0.0

    @property
    def left(self) -> float:
        """Seconds that are left at this rate."""
        return (self.points - self.done) / self.rate if self.rate > 0 else float("inf")


Listener = Callable[[Progress], None]


def study(
    model: Model,
    joint: Joint,
    design: Design | None = None,
    *,
    quantities: Iterable[str] = (),
    store: str | Path | None = None,
    engine: Engine = _HERE,
    listen: Listener = lambda progress: None,
    **axes: Any,
) -> xarray.Dataset:
    """Press a joint at every point of a design.

    Parameters
    ----------
    model : Model
        Anything that can press.
    joint : Joint
        Plain numbers; those that the design names are replaced.
    design : Design, optional
        From `grid`, `sample`, `table`, or products of these.
    quantities : iterable of str
        What is answered (names of a `Contact`): by default indentation, half angle, peak pressure, area, and the force
        where it is not given. `status` and `valid` always come along.
    store : path, optional
        A folder for a Zarr group. What lies there of the same study is not computed anew.
    engine : Engine
        Who computes: `Serial()`, `Processes()`, `Distributed()`. The numbers are the same bit for bit.
    listen : callable
        Told the `Progress` after every block.
    **axes : number or sequence of numbers
        A grid, in place of or besides a design: parameters by name (`PARAMETERS`) in mm, N, MPa, rad.

    Returns
    -------
    xarray.Dataset
        Dimensions are the axes, by name; `sample` or `row` for samples and tables. Units, names and sources are in
        `attrs`. A point without an answer is NaN with a status, one whose numbers make no joint has `NO_JOINT`. With a
        store the numbers are read from there when they are asked for.

    Raises
    ------
    ValueError
        A name that is not known, a number that is not allowed, no load or two, a store of another study, more points
        than there is room for.
    OSError
        The store cannot be written; what is done is kept.

    Examples
    --------
    >>> import ballsocket as bs
    >>> hip = bs.joints["hess-forsbach"]
    >>> found = bs.study(bs.HessForsbach(), hip, clearance=[0.05, 0.1, 0.2], force=[1000.0, 3000.0])
    >>> found.max_pressure.sel(clearance=0.1, force=3000.0).item().__round__(2)
    11.27
    """
    needs("study", "xarray", "zarr")
    _check(model, joint, design)
    if not callable(getattr(engine, "run", None)) or isinstance(engine, type):
        raise TypeError(f"engine must be an Engine, such as Serial() or Processes(workers=2), got {shown(engine)}")
    task = _task(model, joint, design, axes, tuple(quantities))
    kept = None if store is None else Store(Path(store).absolute())
    if kept is None or not kept.path.exists():
        check_room(task, None if kept is None else kept.path)
    check_values(task.design)
    if kept is None:
        return dataset(task, _in_memory(task, engine, listen))
    kept.prepare(task)
    run = PieceRun(task, range(len(task.blocks)), BlockStore(task, kept))
    check_room(task, kept.path, sum(map(task.blocks.points, run.missing)))
    _into(kept, task, run, engine, listen)
    return read(kept.path)


def read(path: str | Path) -> xarray.Dataset:
    """A stored study, whose numbers are read when they are asked for.

    Raises
    ------
    OSError
        There is no such store.
    ValueError
        What is there is no study.
    """
    import xarray

    if Path(path).exists():
        Store(Path(path)).study()
    try:
        found = xarray.open_dataset(path, engine="zarr", consolidated=False, chunks=None)
    except UnicodeError as error:
        raise ValueError(f"{path} is a damaged store: {error}; run its study again to mend it") from error
    return arranged(found[[name for name in DTYPES if name in found.data_vars]])


def _check(model: Any, joint: Any, design: Any) -> None:
    """Raise TypeError for what is something else."""
    if not isinstance(model, Model):
        hint = f"; bs.catalogue[{model!r}] is one" if isinstance(model, str) and model in catalogue else ""
        raise TypeError(f"model must be a Model, got {shown(model)}{hint}")
    check_joint(joint)
    if not (design is None or isinstance(design, Design)):
        raise TypeError(f"design must be a Design, from grid, sample or table, got {shown(design)}; loads have names")


def _task(model: Model, joint: Joint, design: Design | None, axes: dict[str, Any], quantities: tuple[str, ...]) -> Task:
    points = grid(**axes) if design is None else design * grid(**axes)
    loads = [name for name in LOADS if name in points.names]
    if not loads:
        raise ValueError(f"one load is needed, as an axis or a number: {', '.join(LOADS)}")
    check_aims(model, points.names)
    known = (*QUANTITIES, EDGE_DISTANCE) if model.off_axis else QUANTITIES
    check_names(quantities, known, "among the quantities")
    if not all(is_one(number) for number in (*joint.numbers(), *model.parameters)):
        raise ValueError("joint and model of a study have plain numbers: what varies is an axis")
    wanted = quantities or tuple(name for name in ("force", *USUAL) if name not in loads)
    chosen = tuple(dict.fromkeys(name for name in wanted if name not in loads))
    return Task(model, joint, points, chosen, Blocks.of(points.shape, points_a_block(model)))


def _in_memory(task: Task, engine: Engine, listen: Listener) -> dict[str, numpy.ndarray]:
    whole = {name: numpy.empty(task.design.shape, dtype=DTYPES[name]) for name in task.variables}
    numbers = range(len(task.blocks))
    for number, answers in _told(engine.run(task, numbers), task, numbers, listen):
        for name, values in answers.items():
            whole[name][task.blocks[number]] = values
    return whole


def _into(store: Store, task: Task, run: PieceRun, engine: Engine, listen: Listener) -> None:
    done = len(run.stored)
    try:
        for _ in _told(run.compute_missing(engine), task, run.missing, listen):
            done += 1
    except ConnectionError:
        raise
    except OSError as error:
        kept = f"{done} of {len(task.blocks)} blocks are kept; run it again to go on"
        raise OSError(error.errno, f"{error.strerror or error}; {kept}", str(store.path)) from error


def _told(
    answers: Iterable[tuple[int, Any]], task: Task, numbers: Iterable[int], listen: Listener
) -> Iterable[tuple[int, Any]]:
    """Passes answers on, and tells how far the study is."""
    points = prod(task.design.shape)
    found = done = points - sum(task.blocks.points(number) for number in numbers)
    start = time.perf_counter()
    listen(Progress(done, points, found, 0.0))
    for number, answer in answers:
        yield number, answer
        done += task.blocks.points(number)
        listen(Progress(done, points, found, time.perf_counter() - start))
