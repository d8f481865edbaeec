"""Executors: every piece is computed once, and a worker process that dies costs another attempt at its piece."""

import gc
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module

import numpy as np
import pytest

from ballsocket.core.executors import Processes, Serial
from ballsocket.core.executors.dask import Distributed, local_cluster
from ballsocket.core.executors.processes import available_cores

from ..processes import PATIENCE, is_running, wait_until

KINDS = Processes, Distributed
WORK = """
import os, signal
from dataclasses import dataclass
from pathlib import Path

KILL = getattr(signal, "SIGKILL", signal.SIGTERM)  # Windows ends a process by any signal


def square(number):
    return number * number


@dataclass(frozen=True)
class Dies:
    folder: Path
    at: int
    times: int

    def __call__(self, number):
        deaths = len(list(self.folder.iterdir()))
        if number == self.at and deaths < self.times:
            (self.folder / str(deaths)).touch()
            os.kill(os.getpid(), KILL)
        return {os.environ[f"{name}_NUM_THREADS"] for name in ("OPENBLAS", "MKL", "OMP")}


def fail(number):
    raise ValueError(f"piece {number} = {number} is not allowed")
"""


@pytest.fixture
def work(tmp_path, monkeypatch):
    """Return a module of work that other processes can import."""
    (tmp_path / "some_work.py").write_text(WORK, encoding="utf-8")
    (tmp_path / "deaths").mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "some_work", raising=False)
    return import_module("some_work")


def test_every_executor_computes_every_piece_once_and_raises_its_error(work):
    expected = [(number, number * number) for number in range(20)]
    assert list(Serial().run(work.square, range(20))) == expected
    assert list(Processes(workers=2).run(work.square, [])) == []
    assert sorted(Processes(workers=2).run(work.square, range(20))) == expected
    for executor in (Serial(), Processes(workers=1)):
        with pytest.raises(ValueError, match="piece 5 = 5 is not allowed"):
            list(executor.run(work.fail, [5]))


def test_a_killed_process_costs_an_attempt_and_has_one_thread(tmp_path, work, monkeypatch):
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    executor = Processes(workers=1, retries=1)
    results = dict(executor.run(work.Dies(tmp_path / "deaths", at=1, times=1), range(3)))
    assert results == {number: {"1"} for number in range(3)}
    assert (os.environ.get("OPENBLAS_NUM_THREADS"), os.environ["OMP_NUM_THREADS"]) == (None, "7")


def test_a_piece_that_always_kills_its_process_is_an_error(tmp_path, work):
    with pytest.raises(RuntimeError, match="the worker process of piece 0 died 2 times; run again to resume"):
        list(Processes(workers=1, retries=1).run(work.Dies(tmp_path / "deaths", at=0, times=100), range(1)))
    assert len(list((tmp_path / "deaths").iterdir())) == 2


@pytest.mark.parametrize(
    ("make", "options", "message"),
    [
        *((kind, {"workers": n}, f"workers = {n} is not .* 1 to 1000") for kind in KINDS for n in (0, 1001)),
        *((Distributed, {"workers": n}, f"workers = {n} is not allowed: a whole number") for n in (1.5, True)),
        (Distributed, {"retries": -1}, "retries = -1 is not allowed: a whole number from 0"),
        (Distributed, {"retries": "x"}, "retries = 'x' is not allowed: a whole number"),
        (Distributed, {"address": "tcp://host:1", "workers": 2}, "workers = 2 is not allowed for the scheduler at"),
        *(
            (Distributed, {"address": address}, f"address = {address!r} is not allowed: a Dask scheduler has")
            for address in ("", "nonsense", "tcp://", "udp://10.0.0.1:1", 8786)
        ),
        (Distributed, {"security": object()}, "security needs the address of a scheduler"),
    ],
)
def test_options_that_are_not_allowed_are_refused(make, options, message):
    with pytest.raises(ValueError, match=message):
        make(**options)
    assert [make(workers=workers).workers for workers in (1, 1000, None)] == [1, 1000, None]


def test_available_cores_are_those_of_this_process(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0: {3, 4, 7}}[process], raising=False)
    assert available_cores() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    for count, cores in ((5, 5), (None, 1)):
        monkeypatch.setattr(os, "cpu_count", lambda count=count: count)
        assert available_cores() == cores


PARENT = """
import subprocess, sys, time
subprocess.Popen([sys.executable, "-c", {child!r}], stdin=subprocess.PIPE)
time.sleep(3600)
"""

WORKER = """
import os, time
from ballsocket.core.executors import processes
processes._PARENT_CHECK_INTERVAL = 0.02
{before}
processes.exit_with_parent()
print(os.getpid(), flush=True)
time.sleep(3600)
"""


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="processes are listed in /proc")
@pytest.mark.parametrize("before", ["", "processes.fcntl = None"], ids=["signal", "thread"])
def test_a_worker_ends_with_its_parent(before):
    script = PARENT.format(child=WORKER.format(before=before))
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as parent:
        worker = int(parent.stdout.readline())
        assert is_running(worker)
        parent.kill()
    wait_until(lambda: not is_running(worker))


CLUSTER = {"threads_per_worker": 1, "dashboard_address": "127.0.0.1:0", "silence_logs": 50, "processes": False}


@pytest.fixture(scope="module")
def scheduler():
    """Return the address of a Dask scheduler with a worker in this process."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=1, **CLUSTER) as cluster:
        yield cluster.scheduler_address


def test_dask_workers_compute_every_piece_once_and_raise_its_error(scheduler):
    executor = Distributed(address=scheduler)
    assert sorted(executor.run(abs, [-3, 1, -2])) == [(-3, 3), (-2, 2), (1, 1)]
    assert sorted(executor.run(hex, [16])) == [(16, "0x10")]
    assert list(executor.run(np.zeros(2_000_000).take, [7])) == [(7, 0.0)]  # a large function is sent without a warning
    with pytest.raises(TypeError):
        list(Distributed(address=scheduler, retries=0).run(len, [1]))


def test_a_piece_is_a_task_of_dask_and_nothing_is_left_after_the_run(scheduler):
    from distributed import Client

    def tasks(dask_scheduler):
        return [str(key) for key in dask_scheduler.tasks], list(dask_scheduler.worker_plugins)

    executor = Distributed(address=scheduler)
    with Client(scheduler) as client:
        _, plugins = client.run_on_scheduler(tasks)
        results = executor.run(abs, range(5))
        next(results)
        during, _ = client.run_on_scheduler(tasks)
        results.close()
        wait_until(lambda: client.run_on_scheduler(tasks) == ([], plugins))
    assert 1 < len(during) <= 6
    assert sum(key.endswith("-work") for key in during) == 1


def test_missing_workers_are_reported_within_seconds(monkeypatch, caplog):
    """The work waits for the first worker, which it then uses."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("ballsocket.core.executors.dask._WORKER_CHECK_INTERVAL", 0.1)

    def warnings():
        return [record.getMessage() for record in caplog.records if record.name == "ballsocket.executors"]

    with distributed.LocalCluster(n_workers=0, **CLUSTER) as cluster, ThreadPoolExecutor() as pool:
        waiting = pool.submit(list, Distributed(address=cluster.scheduler_address).run(abs, [-1]))
        wait_until(warnings)
        assert not waiting.done()
        cluster.scale(1)
        assert waiting.result(PATIENCE) == [(-1, 1)]
    (warning,) = warnings()
    assert warning.startswith(f"the Dask scheduler at {cluster.scheduler_address} has no workers")


@pytest.mark.long
def test_tls_needs_the_certificates():
    dask, distributed = pytest.importorskip("dask"), pytest.importorskip("distributed")
    pytest.importorskip("cryptography")
    security = distributed.Security.temporary()
    with distributed.LocalCluster(n_workers=1, security=security, protocol="tls", **CLUSTER) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tls://")
        assert list(Distributed(address=address, security=security).run(abs, [-1])) == [(-1, 1)]
        with pytest.raises(ConnectionError, match="needs certificates"):
            list(Distributed(address=address).run(abs, [-1]))
        plain = address.replace("tls://", "tcp://")
        with pytest.raises(ConnectionError, match="address, scheduler and security differ in their encryption"):
            list(Distributed(address=plain, security=security).run(abs, [-1]))
    assert dask.config.get("scheduler", None) is None, "a client that is not connected must not compute for others"
    clients = [thing for thing in gc.get_objects() if issubclass(type(thing), distributed.Client)]
    assert {client.status for client in clients} <= {"closed", "newly-created"}  # a start under way would wait for them


def test_a_local_cluster_has_one_thread_a_worker_and_is_not_reachable():
    pytest.importorskip("distributed")
    with local_cluster(2, retries=2) as cluster:
        workers = cluster.scheduler_info["workers"]
        assert [worker["nthreads"] for worker in workers.values()] == [1, 1]
        for address in (cluster.scheduler_address, cluster.dashboard_link.partition("//")[2], *workers):
            assert address.removeprefix("tcp://").startswith("127.0.0.1:")
        assert cluster.scheduler.allowed_failures == 2


def test_a_scheduler_that_cannot_be_reached_is_an_error_of_one_sentence(monkeypatch):
    pytest.importorskip("distributed")
    with pytest.raises(ConnectionError, match="needs certificates: 'tls://127.0.0.1:1'"):
        list(Distributed(address="tls://127.0.0.1:1").run(abs, [1]))
    monkeypatch.setattr("ballsocket.core.executors.dask._CONNECTION_TIMEOUT", 0.2)
    with pytest.raises(ConnectionError, match="the Dask scheduler does not respond: 'tcp://127.0.0.1:1'"):
        list(Distributed(address="tcp://127.0.0.1:1").run(abs, [1]))
