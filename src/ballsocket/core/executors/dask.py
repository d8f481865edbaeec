"""Executor on Dask workers: a cluster on this machine, or a scheduler at an address."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy

from ..checks import needs, require
from .processes import MAX_WORKERS, Work, available_cores

if TYPE_CHECKING:
    import xarray
    from distributed import Client, LocalCluster

_CONNECTION_TIMEOUT = 10
"""Seconds to wait for a scheduler."""


@dataclass(frozen=True, kw_only=True)
class Distributed:
    """Executor that distributes pieces of work over Dask workers.

    `xarray.map_blocks` makes one Dask task of each piece.

    If a worker dies, its pieces are computed again. Workers on other machines need the same version of this package.
    They must reach the store under the same path.

    Parameters
    ----------
    address : str, optional
        Address of a scheduler, such as "tcp://10.0.0.1:8786". Without an address, a cluster is started on this machine
        and ended after the run. A script that does so needs the guard `if __name__ == "__main__":`.
    workers : int, optional
        Number of workers of the cluster on this machine, each with one thread. Default: number of available cores.
    retries : int
        Number of times that a piece is computed again after an error. A cluster on this machine also tolerates as many
        deaths of the workers of one piece. Elsewhere this is the scheduler's setting
        `distributed.scheduler.allowed-failures`.

    Raises
    ------
    ValueError
        Both an address and workers, fewer than one worker, or more than 1000.
    """

    address: str | None = None
    workers: int | None = None
    retries: int = 3

    def __post_init__(self) -> None:
        if self.workers is not None:
            require("workers", self.workers, 1 <= self.workers <= MAX_WORKERS, f"it must be 1 to {MAX_WORKERS}")
            if self.address is not None:
                raise ValueError(
                    f"workers = {self.workers} is not allowed for the scheduler at {self.address}, which has its own "
                    "workers: give an address or a number of workers"
                )

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Compute pieces of work on the workers; yield (number, result) in the order of completion.

        Raises
        ------
        ImportError
            Dask is not installed.
        ConnectionError
            The scheduler does not respond.
        RuntimeError
            The workers of a piece died more often than the scheduler allows.
        """
        if not len(numbers):
            return
        needs("study", "dask", "distributed", "xarray")
        from distributed import KilledWorker, as_completed, futures_of

        with self._connect_client() as client, _send_work(client, work) as plugin_name:
            blocks = client.persist(_build_dataset(plugin_name, numbers), retries=self.retries)
            completed = as_completed(futures_of(blocks), with_results=True)
            del blocks  # a worker frees each result after it has been received
            try:
                for future, results in completed:
                    yield from results.tolist()
                    future.release()
            except KilledWorker as error:
                raise RuntimeError(f"the workers of a piece died too often: {error}") from error

    @contextmanager
    def _connect_client(self) -> Iterator[Client]:
        """Yield a Dask client of the scheduler at `address`, or of a new cluster on this machine."""
        from distributed import Client

        if self.address is not None:
            try:
                client = Client(self.address, timeout=_CONNECTION_TIMEOUT)
            except OSError as error:
                raise ConnectionError(None, "the Dask scheduler does not respond", self.address) from error
            with client:
                yield client
            return
        with local_cluster(self.workers or available_cores(), self.retries) as cluster, Client(cluster) as client:
            yield client


@contextmanager
def local_cluster(workers: int, retries: int = 3) -> Iterator[LocalCluster]:
    """Start a Dask cluster on this machine with single-threaded workers, until the end of the block.

    By default, Dask workers return freed memory to the system at once, which makes exact solutions a third slower. This
    cluster disables that. Other clusters can set a large `MALLOC_TRIM_THRESHOLD_` in the environment of their workers.
    """
    import dask
    from distributed import LocalCluster

    settings = {
        "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": None,
        "distributed.scheduler.allowed-failures": retries,
    }
    options: dict[str, Any] = {"dashboard_address": "127.0.0.1:0", "host": "127.0.0.1", "silence_logs": logging.ERROR}
    with dask.config.set(settings), LocalCluster(n_workers=workers, threads_per_worker=1, **options) as cluster:
        yield cluster


@contextmanager
def _send_work(client: Client, work: Work) -> Iterator[str]:
    """Send the work function once to all workers, and yield the name of its Dask plugin.

    Workers that join later receive it too.
    """
    from distributed import WorkerPlugin

    class WorkPlugin(WorkerPlugin):
        """Dask plugin that stores the work function on a worker."""

        def __init__(self) -> None:
            self.work = work

    name = f"ballsocket-{uuid4()}"
    client.register_plugin(WorkPlugin(), name=name)
    try:
        yield name
    finally:
        client.unregister_worker_plugin(name)


def _build_dataset(plugin_name: str, numbers: Sequence[int]) -> xarray.Dataset:
    """Build a Dask dataset with one piece per chunk, whose computed elements are (number, result)."""
    import xarray

    pieces = xarray.Dataset({"result": ("block", numpy.array(numbers))}).chunk(block=1)
    return xarray.map_blocks(
        _compute_block, pieces, kwargs={"plugin_name": plugin_name}, template=pieces.astype(object)
    )


def _compute_block(block: xarray.Dataset, plugin_name: str) -> xarray.Dataset:
    """Compute the pieces of one chunk on a worker."""
    from distributed import get_worker

    plugin: Any = get_worker().plugins[plugin_name]
    results = numpy.empty(block.sizes["block"], dtype=object)
    for index, number in enumerate(block.result.values.tolist()):
        results[index] = (number, plugin.work(number))
    return block.assign(result=("block", results))
