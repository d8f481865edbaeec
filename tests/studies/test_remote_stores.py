"""Stores at addresses of fsspec: studies, exports and cohorts there are those of a local folder, or one sentence."""

from importlib.util import find_spec
from pathlib import Path

import pytest
import xarray as xr

import ballsocket as bs
from ballsocket.core.executors import Processes
from ballsocket.hip.cohort import CohortRun, cohort_store, sample_patients, write_csv
from ballsocket.studies.export import export
from ballsocket.studies.file import read_study
from ballsocket.studies.store import CHECKSUM, StudyStore

from ..cli.command import run
from ..hip.test_cohort import FEW_CYCLES, quick_variability
from ..hip.test_uncertainty import short_file

fsspec = pytest.importorskip("fsspec")
HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": [0.05, 0.1, 0.2, 0.3], "force": [1000.0, 2000.0, 3000.0]}


@pytest.fixture
def bucket(monkeypatch, tmp_path):
    """Return the store of fsspec in the memory, which stands for a bucket; the working folder stays empty."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("ballsocket.studies.run.points_per_block", lambda model: 4)
    system = fsspec.filesystem("memory")
    yield system
    if system.exists("/bucket"):
        system.rm("/bucket", recursive=True)
    assert not list(tmp_path.iterdir())


def study(store, told=None, **axes):
    listen = (lambda progress: None) if told is None else told.append
    return bs.study(bs.HessForsbach(), HIP, store=store, listen=listen, **(axes or AXES))


def test_a_study_at_an_address_is_that_of_the_memory_and_resumes(bucket):
    address, whole = "memory://bucket/s.zarr", study(None)
    assert study(address).load().equals(whole)
    told = []
    assert study(Path(address), told).load().equals(whole)
    assert [progress.n_done for progress in told] == [12]
    chunks = [path for path in bucket.find("/bucket/s.zarr") if "/max_pressure/c/" in path]
    bucket.pipe_file(chunks[1], b"nonsense")
    bucket.rm("/bucket/s.zarr/clearance/zarr.json")
    told.clear()
    assert study(address, told).load().equals(whole)
    assert [progress.n_done for progress in told] == [9, 12]
    assert xr.open_zarr(address, consolidated=False).max_pressure.equals(whole.max_pressure)
    with pytest.raises(ValueError, match="memory://bucket/s.zarr has another study: axes.clearance"):
        study(address, force=[1000.0])
    bucket.pipe_file("/bucket/other/precious.txt", b"mine")
    with pytest.raises(ValueError, match="memory://bucket/other exists and is not a study"):
        study("memory://bucket/other")


def test_a_remote_store_that_fails_says_how_many_blocks_are_stored(bucket, monkeypatch):
    write = StudyStore.write

    def fail(self, task, number, results):
        with self.folder.errors():
            if number == 2:
                raise RuntimeError("slow down")
            write(self, task, number, results)

    monkeypatch.setattr(StudyStore, "write", fail)
    message = "the remote store failed: slow down; 2 of 4 blocks are stored; run the study"
    with pytest.raises(OSError, match=message) as no:
        study("memory://bucket/s.zarr")
    assert no.value.filename == "memory://bucket/s.zarr"


STUDY = "joint = 'hip-36'\nstore = '{}'\n[axes]\nforce = [1, 2]\n"


def test_a_store_of_a_file_or_a_command_is_an_address_or_a_path_beside_the_file(tmp_path):
    for store, expected in (("s.zarr", tmp_path / "s.zarr"), ("s3://bucket/s.zarr", "s3://bucket/s.zarr")):
        (tmp_path / "study.toml").write_text(STUDY.format(store), encoding="utf-8")
        assert read_study(tmp_path / "study.toml").store == expected
    done = run("study", "study.toml", "--store", "memory://bucket/c.zarr", folder=tmp_path)
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "memory://bucket/c.zarr")
    fsspec.filesystem("memory").rm("/bucket", recursive=True)
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_exports_to_addresses_are_complete(bucket):
    pressed = study(None)
    for name in ("s.parquet", "s.zarr", "s.csv"):
        export(pressed, f"memory://bucket/{name}")
    assert {path.split("/")[2] for path in bucket.find("/bucket")} == {"s.parquet", "s.zarr", "s.csv"}
    with xr.open_zarr("memory://bucket/s.zarr", consolidated=False) as again:
        assert again.load().identical(pressed)
    with pytest.raises(ValueError, match="memory://bucket/s.zarr exists: choose another name"):
        export(pressed, "memory://bucket/s.zarr")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: study("unknown://bucket/s.zarr"), "unknown://bucket/s.zarr: Protocol not known: unknown"),
        (lambda: export(study(None), "unknown://bucket/s.csv"), "unknown://bucket/s.csv: Protocol not known: unknown"),
        (lambda: bs.studies.table("s3://bucket/rows.csv"), "'s3://bucket/rows.csv' is the address of a remote store"),
        pytest.param(
            lambda: study("s3://bucket/s.zarr"),
            "s3://bucket/s.zarr: Install s3fs",
            marks=pytest.mark.skipif(find_spec("s3fs") is not None, reason="s3fs is installed"),
        ),
    ],
)
def test_addresses_without_a_store_are_one_sentence(bucket, call, message):
    with pytest.raises((ValueError, ImportError), match=message):
        call()


@pytest.mark.parametrize(
    "words",
    [
        ("study", "study.toml", "--store", "unknown://bucket/s.zarr"),
        ("study", "study.toml", "--figure", "s3://bucket/s.png"),
        pytest.param(("hip", "hip.toml", "--store", "s3://bucket/run"), marks=pytest.mark.long),
        pytest.param(("deck", "hip-36", "--force", "3 kN", "--out", "s3://bucket/deck"), marks=pytest.mark.long),
        ("export", "c", "hip-36", "--out", "s3://bucket/c"),
        ("reproduce", "--quick", "--out", "s3://bucket/paper"),
    ],
    ids=lambda words: words[0],
)
def test_commands_refuse_addresses_that_they_cannot_use(tmp_path, words):
    (tmp_path / "study.toml").write_text(STUDY.format("s.zarr"), encoding="utf-8")
    short_file(tmp_path)
    files = set(tmp_path.iterdir())
    done = run(*words, folder=tmp_path)
    sentence = done.stderr.splitlines()[-1]  # after a progress bar
    assert (done.returncode, words[-1] in sentence, len(sentence) < 200) == (2, True, True), done.stderr
    assert set(tmp_path.iterdir()) == files


@pytest.mark.long
def test_a_cohort_at_an_address_resumes(bucket):
    one = quick_variability()
    cohort = CohortRun(variability=one, counts=(FEW_CYCLES,), values=sample_patients(one, 2, 0))
    store = cohort_store("memory://bucket/patients", one, [FEW_CYCLES], 0)
    first = cohort.simulate(store=store)
    assert {path.rpartition("/")[2] for path in bucket.find("/bucket")} == {"patients.json", "patients_000000.npz"}
    done = []
    again = cohort.simulate(store=store, progress=done.append)
    assert done == [2]
    assert again.table.tobytes() == first.table.tobytes()
    path = write_csv(Path("memory://bucket/patients") / "patients.csv", cohort, first)
    assert bucket.cat_file("/bucket/patients/patients.csv").startswith(b"clearance_mm,")
    assert path.name == "patients.csv"
    with pytest.raises(ValueError, match="memory://bucket/patients has another cohort"):
        cohort_store("memory://bucket/patients", one, [FEW_CYCLES], 1)


@pytest.mark.long
def test_a_remote_store_has_the_study_and_the_cohort_of_processes(monkeypatch, tmp_path):
    """Files of fsspec in the working folder, which other processes reach too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("ballsocket.studies.run.points_per_block", lambda model: 4)
    with pytest.raises(FileNotFoundError, match="no such file or bucket: 'local://bucket/s.zarr'"):
        study("local://bucket/s.zarr")
    monkeypatch.setenv("FSSPEC_LOCAL_AUTO_MKDIR", "true")
    monkeypatch.setitem(fsspec.config.conf, "local", {"auto_mkdir": True})
    whole, told = study(None), []
    stored = bs.study(bs.HessForsbach(), HIP, store="local://bucket/s.zarr", engine=Processes(workers=2), **AXES)
    assert stored.load().equals(whole)
    assert study("local://bucket/s.zarr", told).load().equals(whole)
    assert len(told) == 1
    assert len(list((tmp_path / "bucket" / "s.zarr" / CHECKSUM / "c").iterdir())) == 4
    short_file(tmp_path)
    words = ("hip", "hip.toml", "--patients", "2", "--store", "local://bucket/patients")
    for workers in ((), ("--workers", "1")):
        done = run(*words, *workers, folder=tmp_path)
        assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "local://bucket/patients/patients.csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bucket", "hip.toml"]
