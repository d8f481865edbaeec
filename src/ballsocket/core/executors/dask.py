"""Dask as an engine: a cluster of one's own, or any scheduler by its address."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy

from ..checks import needs, require
from .local import MOST, Work, available_cores

if TYPE_CHECKING:
    import xarray
    from distributed import Client, LocalCluster


@dataclass(frozen=True, kw_only=True)
class Distributed:
    """Dask workers. Blocks are cut by `xarray.map_blocks`: a task of Dask's for each block, not for each press.

    A worker that dies costs its blocks once more. Workers on other machines need this package in the same version,
    and a store that they reach under the same path.

    Parameters
    ----------
    address : str, optional
        Of a scheduler, such as "tcp://10.0.0.1:8786"; without one a cluster is started on this machine, and ended
        with the study. A script that does so needs the guard `if __name__ == "__main__":`.
    workers : int, optional
        Of a cluster of one's own: as many as there are cores. Each has one thread.
    retries : int
        How often a block is tried anew after an error. Of workers that die under a block a cluster of one's own
        forgives as many; elsewhere it is the scheduler that says how many (`distributed.scheduler.allowed-failures`).

    Raises
    ------
    ValueError
        An address and workers, or not 1 to 1000 workers.
    """

    address: str | None = None
    workers: int | None = None
    retries: int = 3

    def __post_init__(self) -> None:
        if self.workers is not None:
            require("workers", self.workers, 1 <= self.workers <= MOST, f"at least one worker, at most {MOST}")
            if self.address is not None:
                raise ValueError(f"{self.address} has workers of its own: give an address or a number of workers")

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Each number with what its work returned, as soon as it is there.

        Raises
        ------
        ImportError
            Dask is not installed.
        ConnectionError
            There is no scheduler at the address.
        RuntimeError
            A block that lost its worker too often.
        """
        if not len(numbers):
            return
        needs("study", "dask", "distributed", "xarray")
        from distributed import KilledWorker, as_completed, futures_of

        with self._client() as client, _given(client, work) as name:
            blocks = client.persist(_blocks(name, numbers), retries=self.retries)
            coming = as_completed(futures_of(blocks), with_results=True)
            del blocks  # an answer is let go by its worker once it is here
            try:
                for future, answers in coming:
                    yield from answers.tolist()
                    future.release()
            except KilledWorker as error:
                raise RuntimeError(f"a block lost its worker too often: {error}") from error

    @contextmanager
    def _client(self) -> Iterator[Client]:
        from distributed import Client

        if self.address is not None:
            try:
                client = Client(self.address, timeout=10)
            except OSError as error:
                raise ConnectionError(None, "no scheduler answers", self.address) from error
            with client:
                yield client
            return
        with local_cluster(self.workers or available_cores(), self.retries) as cluster, Client(cluster) as client:
            yield client


@contextmanager
def local_cluster(workers: int, retries: int = 3) -> Iterator[LocalCluster]:
    """Workers on this machine, of one thread each, which keep the memory that they will need again.

    Dask has its workers hand memory back to the system at every turn, which makes exact presses a third slower;
    workers elsewhere do without if `MALLOC_TRIM_THRESHOLD_` is large in their environment.
    """
    import dask
    from distributed import LocalCluster

    settings = {
        "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": None,
        "distributed.scheduler.allowed-failures": retries,
    }
    options: dict[str, Any] = {"dashboard_address": "127.0.0.1:0", "host": "127.0.0.1", "silence_logs": 40}
    with dask.config.set(settings), LocalCluster(n_workers=workers, threads_per_worker=1, **options) as cluster:
        yield cluster


@contextmanager
def _given(client: Client, work: Work) -> Iterator[str]:
    """Give the work to every worker once, to those that come later too, and not with every block; its name there."""
    from distributed import WorkerPlugin

    class Works(WorkerPlugin):
        def __init__(self) -> None:
            self.work = work

    name = f"ballsocket-{uuid4()}"
    client.register_plugin(Works(), name=name)
    try:
        yield name
    finally:
        client.unregister_worker_plugin(name)


def _blocks(name: str, numbers: Sequence[int]) -> xarray.Dataset:
    """A dataset along `block` whose one element per chunk is (number, answer)."""
    import xarray

    plan = xarray.Dataset({"answer": ("block", numpy.array(numbers))}).chunk(block=1)
    return xarray.map_blocks(_answers, plan, kwargs={"name": name}, template=plan.astype(object))


def _answers(block: xarray.Dataset, name: str) -> xarray.Dataset:
    from distributed import get_worker

    given: Any = get_worker().plugins[name]
    answers = numpy.empty(block.sizes["block"], dtype=object)
    for place, number in enumerate(block.answer.values.tolist()):
        answers[place] = (number, given.work(number))
    return block.assign(answer=("block", answers))
