"""Studies of many presses into a store, and what a study adds to a loop by hand over the same model.

The rival calls the model in chunks of 16384 presses, without labels, store or engine.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy

import ballsocket as bs
from ballsocket.contact import Model
from ballsocket.core.executors.dask import Distributed, local_cluster
from ballsocket.core.executors.processes import Engine, Processes, Serial
from ballsocket.studies.design import Design, Span, grid
from ballsocket.studies.task import DEFAULT_QUANTITIES, DTYPES, Blocks

from .report import Pair, Row, compare
from .timing import Job, wall_time

HIP = bs.joints["hess-forsbach"]


def measure() -> list[Row]:
    closed, tabulated, exact = bs.HessForsbach(), bs.Tabulated(), bs.Exact()
    sizes = ((10**7, 1000), (10**6, 100), (10**6, 1), (10**4, 1), (2500, 1))
    many, hundred, single, few, less = (points(*size) for size in sizes)
    memory, by_hand = _study(closed, many, stored=False), _by_hand(closed, many)
    pairs = [
        Pair("study of 10⁷ presses by the paper's model, in memory", memory, "a loop by hand", by_hand),
        Pair("the same into Zarr", _study(closed, many)),
        Pair("tabulated, 100 loads a joint, into Zarr", _study(tabulated, hundred)),
        Pair("tabulated, a joint a press, into Zarr", _study(tabulated, single)),
    ]
    rows = compare(pairs, repeats=3)
    two, one = _study(exact, few, Processes(workers=2)), _study(exact, few)
    rows += compare([Pair("exact, two processes, by the clock", two, "one process", one)], 1, wall_time)
    with local_cluster(1) as first, local_cluster(2) as second:
        addresses = (str(cluster.scheduler_address) for cluster in (first, second))
        one, two = (_study(exact, less, Distributed(address=address), stored=False) for address in addresses)
        pairs = [
            Pair("exact, Dask with one worker, by the clock", one, "a loop by hand", _by_hand(exact, less, 1 << 7)),
            Pair("exact, Dask with two workers, by the clock", two, "one worker", one),
        ]
        return rows + compare(pairs, 2, wall_time)


def points(count: int, loads: int) -> Design:
    """About `count` points, `loads` of them to a joint."""
    joints = round((count / loads) ** 0.5)
    return grid(
        clearance=Span(0.05, 0.2, joints), ball_radius=Span(11.0, 23.0, joints), force=Span(500.0, 4000.0, loads)
    )


def _study(model: Model, design: Design, engine: Engine | None = None, stored: bool = True) -> Job:
    def call() -> None:
        with TemporaryDirectory() as folder:
            bs.study(model, HIP, design, engine=engine or Serial(), store=Path(folder) / "s.zarr" if stored else None)

    return Job(call, int(numpy.prod(design.shape)))


def _by_hand(model: Model, design: Design, chunk: int = 1 << 14) -> Job:
    """The same quantities into arrays of the same shape."""
    names = (*DEFAULT_QUANTITIES, "status", "valid")

    def call() -> None:
        results = {name: numpy.empty(design.shape, dtype=DTYPES[name]) for name in names}
        blocks = Blocks.divide(design.shape, chunk)
        for number in range(len(blocks)):
            values = design.values_in(blocks[number])
            joint = HIP.replace(ball_radius=values["ball_radius"], clearance=values["clearance"])
            contact = model.press(joint, force=values["force"])
            for name, array in results.items():
                array[blocks[number]] = getattr(contact, name)

    return Job(call, int(numpy.prod(design.shape)))
