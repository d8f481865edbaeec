"""Executor on Dask workers: a cluster on this machine, or a scheduler at an address."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Event, Thread
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from ..checks import check_whole_number, needs, require, shown
from .processes import MAX_WORKERS, Work, available_cores

if TYPE_CHECKING:
    from distributed import Client, LocalCluster
    from distributed.security import Security

_LOG = logging.getLogger("ballsocket.executors")

_ADDRESS = re.compile(r"((tcp|tls|ws|wss|ucx)://)?[^\s/]+:\d{1,5}|inproc://\S+")
"""Addresses of a scheduler that Dask connects to."""

_CONNECTION_TIMEOUT = 10  # seconds to wait for a scheduler
_WORKER_CHECK_INTERVAL = 3.0  # seconds between two checks that the scheduler has workers


@dataclass(frozen=True, kw_only=True)
class Distributed:
    """Executor that distributes pieces of work over Dask workers.

    Each piece is one Dask task. The work function is a task too, whose result each worker receives once. Both leave the
    cluster with the client, also if the client is killed.

    If a worker dies, its pieces are computed again. Without any worker, the pieces wait for the first one, and a
    warning is logged within a few seconds. Workers on other machines need the same version of this package. They must
    reach the store under the same path or address.

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
    security : distributed.Security, optional
        Certificates for a scheduler at a "tls://" address. Default: those of Dask's configuration.

    Raises
    ------
    ValueError
        Both an address and workers, fewer than one worker, more than 1000, certificates without an address, another
        address than Dask has, or retries that are not a whole number.
    """

    address: str | None = None
    workers: int | None = None
    retries: int = 3
    security: Security | None = None

    def __post_init__(self) -> None:
        if self.security is not None and self.address is None:
            raise ValueError("security needs the address of a scheduler: a cluster on this machine is not reachable")
        if self.address is not None and not (isinstance(self.address, str) and _ADDRESS.fullmatch(self.address)):
            raise ValueError(
                f"address = {shown(self.address)} is not allowed: a Dask scheduler has an address such as "
                "tcp://10.0.0.1:8786, or one that begins with tls://"
            )
        check_whole_number("retries", self.retries)
        if self.workers is not None:
            check_whole_number("workers", self.workers, -MAX_WORKERS)
            require("workers", self.workers, 1 <= self.workers <= MAX_WORKERS, f"it must be 1 to {MAX_WORKERS}")
            if self.address is not None:
                raise ValueError(
                    f"workers = {self.workers} is not allowed for the scheduler at {self.address}, which has its own "
                    "workers: give an address or a number of workers"
                )

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Compute pieces of work on the workers; yield (number, result) in the order of completion.

        Raises ImportError: dask is not installed.
        Raises ConnectionError: the scheduler does not respond, needs certificates, or is not encrypted as the address
        states.
        Raises OSError: the scheduler ends during the run.
        Raises RuntimeError: the workers of a piece died more often than the scheduler allows.
        """
        if not len(numbers):
            return
        needs("study", "dask", "distributed")
        from concurrent.futures import CancelledError

        from distributed import KilledWorker

        with _without_tracebacks(), self._connect_client() as client, _report_missing_workers(client):
            try:
                yield from _compute_pieces(client, work, numbers, self.retries)
            except KilledWorker as error:
                raise RuntimeError(f"the workers of a piece died too often: {error}") from error
            except CancelledError as error:
                raise OSError(None, "the Dask scheduler ended", self.address) from error

    @contextmanager
    def _connect_client(self) -> Iterator[Client]:
        """Yield a Dask client of the scheduler at `address`, or of a new cluster on this machine."""
        from distributed import Client

        if self.address is not None:
            try:
                client = _open_client(self.address, self.security)
            except OSError as error:
                raise ConnectionError(None, "the Dask scheduler does not respond", self.address) from error
            except TypeError as error:  # of Dask, for an encrypted address alone
                raise ConnectionError(None, "the Dask scheduler needs certificates", self.address) from error
            except (RuntimeError, ValueError) as error:  # of Dask, for encryption on one side alone
                raise ConnectionError(
                    None, "address, scheduler and security differ in their encryption (tcp:// or tls://)", self.address
                ) from error
            with client:
                yield client
            return
        with local_cluster(self.workers or available_cores(), self.retries) as cluster, Client(cluster) as client:
            yield client


def _open_client(address: str, security: Any) -> Client:
    """Connect a Dask client, and close it at once if that fails, which also restores Dask's default scheduler.

    The garbage collector would close it later, perhaps while another client starts: both wait for one lock then.
    """
    from distributed import Client

    class ClosingClient(Client):
        def start(self, **options: Any) -> None:
            try:
                super().start(**options)
            except BaseException:
                self.close()
                raise

    return ClosingClient(address, timeout=_CONNECTION_TIMEOUT, security=security)


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


def _compute_pieces(client: Client, work: Work, numbers: Sequence[int], retries: int) -> Iterator[tuple[int, Any]]:
    """Compute pieces of work as Dask tasks; yield (number, result) in the order of completion.

    The work function is a task, not scattered data: if the workers that have it die, it is sent again.
    """
    from concurrent.futures import CancelledError

    import dask
    from distributed import as_completed

    name = f"ballsocket-{uuid4()}"
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 PB"}):  # columns of a large table
        shared_work = client.submit(_return_work, work, key=f"{name}-work", retries=retries)
    pieces = client.map(_compute_piece, numbers, work=shared_work, key=name, retries=retries, pure=False)
    completed = as_completed(pieces, with_results=True)
    del pieces  # a worker frees each result after it has been received
    for piece, result in completed:
        if isinstance(result, CancelledError):  # of all pieces, when the connection is lost
            raise result
        yield result
        piece.release()


def _return_work(work: Work) -> Work:
    return work


def _compute_piece(number: int, work: Work) -> tuple[int, Any]:
    return number, work(number)


@contextmanager
def _without_tracebacks() -> Iterator[None]:
    """Suppress log messages of Dask's client until the end of the block; a lost scheduler is raised as an error."""
    loggers = list(map(logging.getLogger, ("distributed.batched", "distributed.client", "tornado.application")))
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


@contextmanager
def _report_missing_workers(client: Client) -> Iterator[None]:
    """Log a warning each time that the scheduler has lost all its workers, or has none, until the end of the block."""
    ended = Event()

    def watch() -> None:
        had_workers = True
        while not ended.wait(_WORKER_CHECK_INTERVAL):
            try:
                has_workers = bool(client.ncores())
            except Exception:  # the connection is lost, which the main thread reports
                return
            if had_workers and not has_workers:
                _LOG.warning(
                    "the Dask scheduler at %s has no workers: the work waits for the first one; Ctrl-C stops it",
                    client.scheduler.address,
                )
            had_workers = has_workers

    thread = Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
