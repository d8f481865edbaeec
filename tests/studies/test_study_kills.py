"""A study as a process of the system: killed, interrupted, out of room. The result is that of an undisturbed one."""

import os
import random
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.studies.run import read
from ballsocket.studies.store import CHECKSUM

from ..processes import PATIENCE, stopped_program, wait_until
from .servers import cluster

COUNTS = {"clearances": 24, "radii": 13, "model": "exact"}
"""Four blocks of a little less than half a second."""

KILLS = min(5, int(os.environ.get("BALLSOCKET_KILLS", "2")))
HIP = bs.joints["hess-forsbach"]
MAIN = "from ballsocket.cli import main; main()"
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="no processes in /proc"),
]
STUDY = """
joint = "hess-forsbach"
model = "{model}"
store = "s.zarr"
quantities = ["max_pressure", "half_angle"]
[axes]
clearance = {{ from = 0.05, to = 0.2, count = {clearances} }}
ball_radius = {{ from = 14, to = 20, count = {radii} }}
force = ["1 kN", "3 kN"]
[engine]
kind = "{engine}"
"""


@pytest.fixture
def start(tmp_path):
    """Function that starts the study of a file in a group of processes, which ends with the test."""
    processes = []

    def start(*options, code=MAIN, **counts):
        (tmp_path / "s.toml").write_text(STUDY.format(**{**COUNTS, **counts}), encoding="utf-8")
        process = subprocess.Popen(
            [sys.executable, "-c", code, "study", "s.toml", *options],
            cwd=tmp_path,
            env={name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"},  # as users
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background jobs ignore it
        )
        processes.append(process)
        return process

    yield start
    for process in processes:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def stored_blocks(store):
    return len(list((store / CHECKSUM / "c").glob("*")))


@cache
def undisturbed():
    return bs.study(
        bs.catalogue[COUNTS["model"]],
        HIP,
        quantities=["max_pressure", "half_angle"],
        clearance=np.linspace(0.05, 0.2, COUNTS["clearances"]),
        ball_radius=np.linspace(14, 20, COUNTS["radii"]),
        force=[1000.0, 3000.0],
    )


def equal_to_undisturbed(store):
    found, whole = read(store).load(), undisturbed()
    names = ("max_pressure", "half_angle", "status")
    return all(found[name].values.tobytes() == whole[name].values.tobytes() for name in names)


def test_a_study_stopped_at_random_changes_of_its_store_is_that_of_an_undisturbed_one(tmp_path, start):
    """The first stop is Ctrl-C, the others are kills, each among the 24 changes of the next block."""
    store, draw = tmp_path / "s.zarr", random.Random(1)
    process = start(code=stopped_program(3, f"{CHECKSUM}/c", "SIGINT"), engine="serial")
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "in s.zarr: run the command again to resume" in " ".join(errors.split())
    for _ in range(KILLS):
        before = stored_blocks(store)
        assert start(code=stopped_program(draw.randrange(1, 25), "s.zarr"), engine="serial").wait(PATIENCE) != 0
        assert stored_blocks(store) >= before >= 1
    assert start(engine="serial").wait(PATIENCE) == 0
    assert equal_to_undisturbed(store)


def test_killed_workers_of_dask_cost_retries(tmp_path, start):
    process, moments, killed = start(engine="dask"), random.Random("dask"), []
    while len(killed) < 2 and process.poll() is None:
        if stored_blocks(tmp_path / "s.zarr") > len(killed):
            victims = [pid for pid in workers_of(process) if pid not in killed]
            if victims:
                killed.append(moments.choice(victims))
                with suppress(ProcessLookupError):
                    os.kill(killed[-1], signal.SIGKILL)
        time.sleep(0.02)
    assert killed
    assert process.wait(timeout=PATIENCE) == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr")


def workers_of(process):
    pids, workers = [process.pid], []
    for pid in pids:
        for path in Path(f"/proc/{pid}/task").glob("*/children"):
            with suppress(OSError):  # a thread that has ended
                pids += map(int, path.read_text(encoding="ascii").split())
        with suppress(OSError):
            if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes():
                workers.append(pid)
    return workers


@pytest.mark.parametrize("end", ["interrupted", "scheduler killed"])
def test_a_study_on_the_users_workers_ends_without_tracebacks_and_leaves_nothing(tmp_path, start, end):
    """The workers belong to the user: they go on, without tasks of a study that has ended."""
    distributed = pytest.importorskip("distributed")

    def tasks(dask_scheduler):
        return list(dask_scheduler.tasks)

    with (tmp_path / "worker.log").open("w") as log, cluster(tmp_path, 1, log) as ((scheduler, worker), address):
        process = start("--scheduler", address, engine="dask", clearances=60, radii=30)
        wait_until(lambda: stored_blocks(tmp_path / "s.zarr") > 1 or process.poll() is not None)
        ended = scheduler if end == "scheduler killed" else process
        ended.send_signal(signal.SIGINT if end == "interrupted" else signal.SIGKILL)
        _, errors = process.communicate(timeout=PATIENCE)
        assert "Traceback" not in errors
        if end == "scheduler killed":
            assert process.returncode == 2
            assert "blocks stored; run the study again to resume" in " ".join(errors.split())
            return
        assert worker.poll() is None
        with distributed.Client(address) as client:
            wait_until(lambda: not client.run_on_scheduler(tasks))
    log = (tmp_path / "worker.log").read_text("utf-8")
    assert f"{os.sep}ballsocket{os.sep}" not in log
    logged_errors = set(re.findall(r"^\s*([\w.]+(?:Error|Exception))\b", log, flags=re.MULTILINE))
    assert logged_errors <= {"distributed.comm.core.CommClosedError"}  # Dask's report of a client that has ended
    assert stored_blocks(tmp_path / "s.zarr") >= 2
