"""A study as a process of the system: killed, interrupted, out of room. The result is that of an undisturbed one."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.studies.run import read
from ballsocket.studies.store import CHECKSUM

from ..extent import either, some

COUNTS = {"clearances": either(quick=20, long=70), "radii": 25, "model": "exact"}
"""Blocks of half a second: two in a quick run, seven in a long one."""

KILLS = min(5, int(os.environ.get("BALLSOCKET_KILLS", "5")))
TIMES = {"serial": KILLS, "processes": KILLS, "dask": 1}
PATIENCE = 600  # seconds, for a slow machine
HIP = bs.joints["hess-forsbach"]
pytestmark = pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="finds processes in /proc")
STUDY = """
joint = "hess-forsbach"
model = "{model}"
store = "s.zarr"

[axes]
clearance = {{ from = 0.05, to = 0.2, count = {clearances} }}
ball_radius = {{ from = 14, to = 20, count = {radii} }}
force = ["1 kN", "3 kN"]

[engine]
kind = "{engine}"
"""


@pytest.mark.long
def test_files_that_may_not_grow_stop_the_command_with_one_sentence(tmp_path):
    """A real failure of the system's: no file may be larger than 20 kB."""
    (tmp_path / "s.toml").write_text(
        STUDY.format(model="hess-forsbach", clearances=100, radii=100, engine="serial"), encoding="utf-8"
    )
    code = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000)); "
        "from ballsocket.cli import main; sys.argv = ['ballsocket', 'study', 's.toml']; main()"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, encoding="utf-8")
    assert done.returncode == 2
    assert "File too large; 0 of" in done.stderr
    assert "Traceback" not in done.stderr
    subprocess.run(
        [sys.executable, "-m", "ballsocket", "study", "s.toml"], cwd=tmp_path, check=True, capture_output=True
    )


def started(folder, stderr=subprocess.DEVNULL, *options):
    return subprocess.Popen(
        [sys.executable, "-m", "ballsocket", "study", "s.toml", *options],
        cwd=folder,
        env={name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"},  # as users have it
        stdout=subprocess.DEVNULL,
        stderr=stderr,
        encoding="utf-8",
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background jobs ignore it
    )


def done_blocks(store):
    return len(list((store / CHECKSUM / "c").glob("*"))) if store.exists() else 0


@cache
def undisturbed():
    return bs.study(
        bs.catalogue[COUNTS["model"]],
        HIP,
        clearance=np.linspace(0.05, 0.2, COUNTS["clearances"]),
        ball_radius=np.linspace(14, 20, COUNTS["radii"]),
        force=[1000.0, 3000.0],
    )


def equal_to_undisturbed(store):
    found, whole = read(store).load(), undisturbed()
    return all(
        found[name].values.tobytes() == whole[name].values.tobytes()
        for name in ("max_pressure", "half_angle", "status")
    )


@pytest.mark.long
@pytest.mark.parametrize(("engine", "times"), list(TIMES.items()))
def test_a_study_killed_many_times_is_that_of_an_undisturbed_one(tmp_path, engine, times):
    (tmp_path / "s.toml").write_text(STUDY.format(engine=engine, **COUNTS), encoding="utf-8")
    moments, before = random.Random(engine), 0
    for _ in range(times):
        process, more = started(tmp_path), moments.choice([0, 1, 1, 2])
        while process.poll() is None and done_blocks(tmp_path / "s.zarr") < before + more:
            time.sleep(0.005)
        time.sleep(moments.uniform(0.0, 0.6))
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        assert done_blocks(tmp_path / "s.zarr") >= before + more
        before = done_blocks(tmp_path / "s.zarr")
    assert started(tmp_path).wait() == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr")


@pytest.mark.long
@pytest.mark.parametrize("engine", some(["processes", "dask"], 1))
def test_killed_workers_cost_retries(tmp_path, engine):
    """One or two of them, at random moments."""
    (tmp_path / "s.toml").write_text(STUDY.format(engine=engine, **COUNTS), encoding="utf-8")
    process, moments, killed, wanted = started(tmp_path), random.Random(engine), [], either(quick=1, long=2)
    while len(killed) < wanted and process.poll() is None:
        if done_blocks(tmp_path / "s.zarr") > len(killed):
            time.sleep(moments.uniform(0.0, 0.3))
            victims = [int(pid) for pid in _descendants(process.pid) if _is_worker(pid) and int(pid) not in killed]
            if victims:
                killed.append(moments.choice(victims))
                os.kill(killed[-1], signal.SIGKILL)
        time.sleep(0.02)
    assert len(killed) == wanted
    assert process.wait(timeout=PATIENCE) == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr")


@pytest.mark.long
def test_workers_leave_when_the_study_is_killed_alone(tmp_path):
    counts = {"clearances": 60, "radii": 30, "model": "exact"}  # more than it will be given time for
    (tmp_path / "s.toml").write_text(STUDY.format(engine="processes", **counts), encoding="utf-8")
    process, workers = started(tmp_path), []
    while done_blocks(tmp_path / "s.zarr") < 1 and process.poll() is None:
        time.sleep(0.02)
    workers = [int(pid) for pid in _descendants(process.pid) if _is_worker(pid)]
    assert workers
    process.kill()
    process.wait()
    deadline = time.time() + PATIENCE
    while any(_alive(pid) for pid in workers) and time.time() < deadline:
        time.sleep(0.1)
    assert not any(_alive(pid) for pid in workers)


def _alive(pid):
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text(encoding="ascii").split(")")[-1].split()[0]
    except FileNotFoundError:
        return False


def _descendants(pid):
    found = []
    for path in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in path.read_text(encoding="ascii").split():
            found += [child, *_descendants(child)]
    return found


def _is_worker(pid):
    return b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()


@pytest.mark.long
@pytest.mark.parametrize("end", ["interrupted", "killed", "scheduler killed"])
def test_a_study_on_the_users_workers_ends_without_tracebacks_and_leaves_nothing(tmp_path, end):
    """The workers belong to the user: they go on, without tasks of a study that has ended."""
    distributed = pytest.importorskip("distributed")
    (tmp_path / "s.toml").write_text(STUDY.format(engine="dask", clearances=60, radii=30, model="exact"), "utf-8")
    file = tmp_path / "scheduler.json"
    common = ("--no-dashboard", "--host", "127.0.0.1", "--scheduler-file", str(file))
    with ExitStack() as stack:
        log = stack.enter_context((tmp_path / "worker.log").open("w"))
        scheduler, worker = (
            stack.enter_context(server(words, tmp_path, log))
            for words in (("scheduler", *common, "--port", "0"), ("worker", *common, "--no-nanny", "--nthreads", "1"))
        )
        while not file.exists() or not file.read_text("utf-8"):
            time.sleep(0.05)
        address = json.loads(file.read_text("utf-8"))["address"]
        process = started(tmp_path, subprocess.PIPE, "--scheduler", address)
        while done_blocks(tmp_path / "s.zarr") < 2 and process.poll() is None:
            time.sleep(0.02)
        ended = scheduler if end == "scheduler killed" else process
        ended.send_signal(signal.SIGINT if end == "interrupted" else signal.SIGKILL)
        _, said = process.communicate(timeout=PATIENCE)
        assert "Traceback" not in said
        if end == "scheduler killed":
            assert process.returncode == 2
            assert "blocks are stored; run the study again to resume" in " ".join(said.split())
            return
        assert worker.poll() is None
        with distributed.Client(address) as client:
            deadline = time.time() + 60
            while client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)) and time.time() < deadline:
                time.sleep(0.2)
            assert client.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.tasks)) == []
    log = (tmp_path / "worker.log").read_text("utf-8")
    assert f"{os.sep}ballsocket{os.sep}" not in log  # Dask's scheduler may report the connection of a killed client
    assert end == "killed" or "Traceback" not in log
    assert done_blocks(tmp_path / "s.zarr") >= 2


@contextmanager
def server(words, folder, log):
    """A command of Dask's that runs until it is no longer needed."""
    with subprocess.Popen([sys.executable, "-m", "dask", *words], cwd=folder, stdout=log, stderr=log) as running:
        try:
            yield running
        finally:
            running.terminate()


def test_control_c_and_a_kill_leave_a_store_that_resumes(tmp_path):
    engine = either(quick="serial", long="processes")  # three starts of two workers take six seconds
    (tmp_path / "s.toml").write_text(STUDY.format(engine=engine, **COUNTS), encoding="utf-8")
    process = started(tmp_path, subprocess.PIPE)
    while done_blocks(tmp_path / "s.zarr") < 1 and process.poll() is None:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "points are stored in s.zarr: run the command again to resume" in " ".join(said.split())
    before = done_blocks(tmp_path / "s.zarr")
    assert before >= 1
    process = started(tmp_path)
    while done_blocks(tmp_path / "s.zarr") == before and process.poll() is None:
        time.sleep(0.02)
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert done_blocks(tmp_path / "s.zarr") > before
    assert started(tmp_path).wait() == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr")
