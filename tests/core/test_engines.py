"""Who computes makes no difference, and a process that dies costs its piece once more."""

import os
import signal
import subprocess
import sys
import time
from importlib import import_module

import pytest

from ballsocket.core.executors import Processes, Serial

PIECES = """
import os, signal
from dataclasses import dataclass
from pathlib import Path

KILL = getattr(signal, "SIGKILL", signal.SIGTERM)  # Windows ends a process by any signal


@dataclass(frozen=True)
class Square:
    def __call__(self, number):
        return number * number


@dataclass(frozen=True)
class DiesOnce:
    folder: Path
    at: int
    times: int

    def __call__(self, number):
        marks = len(list(self.folder.iterdir()))
        if number == self.at and marks < self.times:
            (self.folder / str(marks)).touch()
            os.kill(os.getpid(), KILL)
        return os.environ["OPENBLAS_NUM_THREADS"]


@dataclass(frozen=True)
class Fails:
    def __call__(self, number):
        raise ValueError(f"piece {number} = {number} is not allowed")
"""


@pytest.fixture
def pieces(tmp_path, monkeypatch):
    """Work that other processes can import."""
    (tmp_path / "some_pieces.py").write_text(PIECES, encoding="utf-8")
    (tmp_path / "marks").mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    return import_module("some_pieces")


def test_every_engine_gives_every_number_once(pieces):
    expected = [(number, number * number) for number in range(20)]
    assert list(Serial().run(pieces.Square(), range(20))) == expected
    assert sorted(Processes(workers=2).run(pieces.Square(), range(20))) == expected
    assert list(Processes(workers=2).run(pieces.Square(), [])) == []


def test_a_killed_process_costs_a_retry(tmp_path, pieces, monkeypatch):
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    found = dict(Processes(workers=2).run(pieces.DiesOnce(tmp_path / "marks", at=3, times=2), range(8)))
    assert sorted(found) == list(range(8))
    assert set(found.values()) == {"1"}  # one thread of linear algebra each
    assert "OPENBLAS_NUM_THREADS" not in os.environ


def test_a_piece_that_always_kills_is_an_error(tmp_path, pieces):
    with pytest.raises(RuntimeError, match="lost its process"):
        list(Processes(workers=1, retries=1).run(pieces.DiesOnce(tmp_path / "marks", at=0, times=100), range(1)))


def test_an_error_of_a_piece_is_raised_as_it_is(pieces):
    with pytest.raises(ValueError, match="piece 5 = 5 is not allowed"):
        list(Processes(workers=1).run(pieces.Fails(), [5]))
    with pytest.raises(ValueError, match="at least one process"):
        Processes(workers=0)


def killed_after(pieces, words, data):
    """Starts a reproduction and kills it, with all that it started, when so many of its pieces are there."""
    running = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    while len(list(data.glob("*.json"))) < pieces and running.poll() is None:
        time.sleep(0.02)
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="groups of processes of a system like Unix")
def test_a_killed_reproduction_goes_on_where_it_was(tmp_path):
    """The whole command, killed after its first pieces, and then to its end."""
    out = tmp_path / "out"
    words = [sys.executable, "-m", "ballsocket", "reproduce", "--quick", "--workers", "1", "--out", str(out)]
    data = out / "data" / "quick"
    killed_after(3, words, data)
    kept = {path: path.stat().st_mtime_ns for path in data.glob("*.json")}
    assert len(kept) >= 3
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    assert (out / "report.html").stat().st_size > 100_000
    assert len(list(data.glob("*.json"))) >= len(kept) + 2
    assert all(path.stat().st_mtime_ns == when for path, when in kept.items())
