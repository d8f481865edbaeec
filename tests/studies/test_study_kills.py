"""A study as a process of the system: killed, interrupted, out of room. The result is that of an undisturbed one."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.studies.run import read
from ballsocket.studies.store import CHECKSUM

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


def test_files_that_may_not_grow_stop_the_command_with_one_sentence(tmp_path):
    """A real failure of the system's: no file may be larger than 20 kB."""
    (tmp_path / "s.toml").write_text(
        STUDY.format(model="hess-forsbach", clearances=300, radii=300, engine="serial"), encoding="utf-8"
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


def started(folder, stderr=subprocess.DEVNULL):
    return subprocess.Popen(
        [sys.executable, "-m", "ballsocket", "study", "s.toml"],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=stderr,
        encoding="utf-8",
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background jobs ignore it
    )


def done_blocks(store):
    return len(list((store / CHECKSUM / "c").glob("*"))) if store.exists() else 0


def equal_to_undisturbed(store, **counts):
    found = read(store).load()
    axes = {
        "clearance": np.linspace(0.05, 0.2, counts["clearances"]),
        "ball_radius": np.linspace(14, 20, counts["radii"]),
        "force": [1000.0, 3000.0],
    }
    whole = bs.study(bs.catalogue[counts["model"]], HIP, **axes)
    return all(
        found[name].values.tobytes() == whole[name].values.tobytes()
        for name in ("max_pressure", "half_angle", "status")
    )


@pytest.mark.parametrize(("engine", "times"), [("serial", 10), ("processes", 10), ("dask", 3)])
def test_a_study_killed_many_times_is_that_of_an_undisturbed_one(tmp_path, engine, times):
    counts = {"clearances": 70, "radii": 25, "model": "exact"}
    (tmp_path / "s.toml").write_text(STUDY.format(engine=engine, **counts), encoding="utf-8")
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
    assert equal_to_undisturbed(tmp_path / "s.zarr", **counts)


@pytest.mark.parametrize("engine", ["processes", "dask"])
def test_killed_workers_cost_retries(tmp_path, engine):
    """Two of them, at random moments."""
    counts = {"clearances": 50, "radii": 25, "model": "exact"}
    (tmp_path / "s.toml").write_text(STUDY.format(engine=engine, **counts), encoding="utf-8")
    process, moments, killed = started(tmp_path), random.Random(engine), []
    while len(killed) < 2 and process.poll() is None:
        if done_blocks(tmp_path / "s.zarr") > len(killed):
            time.sleep(moments.uniform(0.0, 0.3))
            victims = [int(pid) for pid in _descendants(process.pid) if _is_worker(pid) and int(pid) not in killed]
            killed += [moments.choice(victims)] if victims else []
            os.kill(killed[-1], signal.SIGKILL)
        time.sleep(0.02)
    assert len(killed) == 2
    assert process.wait(timeout=120) == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr", **counts)


def test_workers_leave_when_the_study_is_killed_alone(tmp_path):
    counts = {"clearances": 60, "radii": 30, "model": "exact"}
    (tmp_path / "s.toml").write_text(STUDY.format(engine="processes", **counts), encoding="utf-8")
    process, workers = started(tmp_path), []
    while done_blocks(tmp_path / "s.zarr") < 1 and process.poll() is None:
        time.sleep(0.02)
    workers = [int(pid) for pid in _descendants(process.pid) if _is_worker(pid)]
    assert workers
    process.kill()
    process.wait()
    deadline = time.time() + 20
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


def test_control_c_leaves_a_store_that_resumes(tmp_path):
    counts = {"clearances": 60, "radii": 20, "model": "exact"}
    (tmp_path / "s.toml").write_text(STUDY.format(engine="processes", **counts), encoding="utf-8")
    process = started(tmp_path, subprocess.PIPE)
    while done_blocks(tmp_path / "s.zarr") < 1 and process.poll() is None:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "points are kept in s.zarr: run it again to go on" in " ".join(said.split())
    before = done_blocks(tmp_path / "s.zarr")
    assert before >= 1
    assert started(tmp_path).wait() == 0
    assert equal_to_undisturbed(tmp_path / "s.zarr", **counts)
