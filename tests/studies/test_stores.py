"""Stores of studies, in local folders and at addresses: nothing done is lost and nothing wrong is kept."""

import json
import os
from contextlib import contextmanager
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory

import numpy as np
import pytest
import xarray as xr

import ballsocket as bs
from ballsocket.core.executors import Processes
from ballsocket.models.modulus import Modulus
from ballsocket.studies import store as store_module
from ballsocket.studies.file import read_study
from ballsocket.studies.file_formats import export
from ballsocket.studies.run import _create_task, read
from ballsocket.studies.store import CHECKSUM, NOT_COMPUTED, StudyStore

from ..cli.command import run
from ..hip.test_uncertainty import short_file

HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": np.linspace(0.05, 0.2, 12).tolist(), "force": [500.0, 1500.0, 3000.0, 4000.0]}
LABEL = b'{"zarr_format": 3, "node_type": "group", "attributes": '
STUDY = "joint = 'hip-36'\nstore = '{}'\n[axes]\nforce = [1, 2]\n"


@pytest.fixture(autouse=True, scope="module")
def small_blocks():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ballsocket.studies.run.points_per_block", lambda model: 8)
        yield


def presses(store, model=bs.HessForsbach(), joint=HIP, **change):  # noqa: B008
    """Run the study; return its results and the number of computed blocks."""
    progress, asked = [], {"quantities": ["max_pressure"], **AXES, **change}
    return bs.study(model, joint, store=store, listen=progress.append, **asked).load(), len(progress) - 1


@pytest.fixture(scope="module")
def finished(small_blocks, tmp_path_factory):
    """The folder of a study whose six blocks are stored, and its results."""
    folder = tmp_path_factory.mktemp("finished") / "s.zarr"
    return folder, presses(folder)[0]


@pytest.fixture
def store(finished, tmp_path):
    return copytree(finished[0], tmp_path / "s.zarr")


def first_chunk(store, name):
    return min(path for path in (store / name / "c").rglob("*") if path.is_file())


def test_a_finished_study_is_read_on_a_full_disk_and_missing_points_have_a_status(store, finished, monkeypatch):
    monkeypatch.setattr("ballsocket.core.storage.folders.available_disk_space", lambda path: 0)
    again, blocks = presses(store)
    assert (blocks, again.identical(finished[1])) == (0, True)
    assert xr.open_zarr(store, consolidated=False).max_pressure.identical(again.max_pressure)
    first_chunk(store, "status").unlink()
    assert (read(store).status.values == NOT_COMPUTED).any()


@pytest.mark.parametrize(
    ("part", "damage", "blocks"),
    [
        ("max_pressure/c/2/0", "truncated", 1),
        ("max_pressure/c/2/0", "garbage", 1),
        ("max_pressure/c/2/0", "removed", 1),
        ("max_pressure/c/2/0", "another", 1),
        (CHECKSUM, "truncated", 6),  # the checksums are read together
        ("clearance", "removed", 0),
        ("clearance/zarr.json", "removed", 0),
        ("clearance/zarr.json", "garbage", 0),
        ("max_pressure/zarr.json", "removed", 0),
        ("max_pressure/zarr.json", "garbage", 0),
    ],
)
def test_a_damaged_part_is_found_and_mended(store, finished, part, damage, blocks):
    path = first_chunk(store, part) if (store / part).is_dir() else store / part
    another = (store / "max_pressure" / "c" / "3" / "0").read_bytes()
    if damage == "removed":
        path.unlink()
    else:
        path.write_bytes({"truncated": path.read_bytes()[:-5], "garbage": b"{", "another": another}[damage])
    again, computed = presses(store)
    assert (computed, again.identical(finished[1])) == (blocks, True)


def test_the_store_of_another_study_or_other_code_is_refused_with_a_few_of_the_differences(store, monkeypatch):
    for change, message in (
        ({"clearance": [0.1]}, r"axes.clearance.clearance is \[0.05.* there and \[0.1\] here"),
        ({"quantities": ["energy"]}, r"quantities\[0\] is max_pressure there and energy here"),
        ({"model": bs.Bartel()}, "model.modulus"),
        ({"joint": bs.joints["hip-28"]}, r"joint.ball_radius is 17.9 there and 14.0 here"),
    ):
        with pytest.raises(ValueError, match=message):
            presses(store, **change)
    assert presses(store)[1] == 0
    monkeypatch.setattr("ballsocket.studies.metadata.fingerprint", lambda: "9.9.9+other")
    with pytest.raises(ValueError, match="code is .* there and 9.9.9[+]other here"):
        presses(store)
    task = replace(_create_task(bs.HessForsbach(), HIP, None, {"force": [1000.0]}, ()), code="0.0.0+old")
    with pytest.raises(ValueError, match="this worker has ballsocket .*, but the run was started by 0.0.0.old"):
        task(0)
    other = {f"{number}{'x' * 100}": "y" * 1000 for number in range(1000)}
    (store / "zarr.json").write_bytes(LABEL + f'{{"study": {json.dumps(other)}}}}}'.encode())
    with pytest.raises(ValueError, match="has another study: 0x+[.]{3} is y+[.]{3} there and missing here; 1x") as no:
        presses(store)
    assert len(str(no.value)) < 2000


def test_custom_models_are_distinguished_by_what_their_formula_encloses(tmp_path):
    def enclosing(value):
        def formula(radius, thickness, young, poisson):
            return value + 0.0 * radius

        return bs.RadialFoundation(modulus=Modulus(name="mine", title="mine", formula=formula))

    bs.study(enclosing(100.0), HIP, store=tmp_path / "s.zarr", force=[1000.0])
    with pytest.raises(ValueError, match=r"encloses\[0\] is 100.0 there and 300.0 here"):
        bs.study(enclosing(300.0), HIP, store=tmp_path / "s.zarr", force=[1000.0])


def test_a_store_whose_label_has_no_study_is_no_study_and_left_alone(store, tmp_path):
    for content in (
        *(b"null", b'"a"', b"", b"\xff", b"[" * 100_000, LABEL + b"[]}"),
        *(LABEL + b'{"study": ' + entry + b"}}" for entry in (b"null", b'"a"', b"[]", b"[" * 2000 + b"]" * 2000)),
    ):
        (store / "zarr.json").write_bytes(content)
        for opened in (presses, read):
            with pytest.raises(ValueError, match=r"s.zarr exists and is not a study$"):
                opened(store)
        assert (store / "zarr.json").read_bytes() == content
    with pytest.raises(ValueError, match="exists and is not a study"):
        presses(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["s.zarr"]


def test_two_studies_that_begin_together_share_their_store(tmp_path, finished, monkeypatch):
    """While one makes the store, another has made it: both have the results."""
    store, make = tmp_path / "s.zarr", store_module._write_group

    def make_slowly(path, task, asked):
        make(path, task, asked)
        if not store.exists():
            monkeypatch.setattr(store_module, "_write_group", make)
            presses(store)

    monkeypatch.setattr(store_module, "_write_group", make_slowly)
    found, blocks = presses(store)
    assert (blocks, found.identical(finished[1])) == (0, True)


@contextmanager
def stopped_at(block, error):
    """Let the store raise an error instead of writing a block."""
    save = StudyStore.save

    def stop(self, number, answers):
        with self.folder.errors():
            if number == block:
                raise error
            save(self, number, answers)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(StudyStore, "save", stop)
        yield


def test_a_full_disk_stops_with_one_sentence_and_keeps_the_stored_blocks(tmp_path, finished):
    message = "No space left on device; 3 of 6 blocks stored; run the study again"
    with stopped_at(3, OSError(28, "No space left on device")), pytest.raises(OSError, match=message):
        presses(tmp_path / "s.zarr")
    found, blocks = presses(tmp_path / "s.zarr")
    assert (blocks, found.identical(finished[1])) == (3, True)


def test_control_c_keeps_the_stored_blocks_and_the_command_resumes(tmp_path, finished):
    (tmp_path / "s.toml").write_text(
        'joint = "hess-forsbach"\nmodel = "hess-forsbach"\nstore = "s.zarr"\nquantities = ["max_pressure"]\n'
        f"[axes]\nclearance = {{from = 0.05, to = 0.2, count = 12}}\nforce = {AXES['force']}\n"
    )
    with stopped_at(2, KeyboardInterrupt):
        stopped = run("study", "s.toml", folder=tmp_path)
    assert stopped.returncode == 130
    assert "in s.zarr: run the command again to resume" in " ".join(stopped.stderr.split())
    assert (read(tmp_path / "s.zarr").status.values != NOT_COMPUTED).sum() == 16
    assert run("study", "s.toml", folder=tmp_path).returncode == 0
    assert np.array_equal(read(tmp_path / "s.zarr").max_pressure.values, finished[1].max_pressure.values)


@contextmanager
def nobody():
    """Root may write everywhere: for a while this process is nobody."""
    if root := os.geteuid() == 0:
        os.seteuid(65534)
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="no permissions as of Unix")
def test_a_read_only_store_is_opened_and_cannot_be_mended(finished):
    with TemporaryDirectory() as folder:  # nobody may go there, as it may not to tmp_path
        Path(folder).chmod(0o755)
        store = copytree(finished[0], Path(folder) / "s.zarr")
        paths = [store, *store.rglob("*")]
        for path in paths:
            path.chmod(0o555 if path.is_dir() else 0o444)
        try:
            with nobody():
                again, blocks = presses(store)
            assert (blocks, again.identical(finished[1])) == (0, True)
            chunk = first_chunk(store, CHECKSUM)
            chunk.parent.chmod(0o755)
            chunk.unlink()
            chunk.parent.chmod(0o555)
            with nobody(), pytest.raises(OSError, match="Permission denied; 5 of 6 blocks stored"):
                presses(store)
        finally:
            for path in paths:
                if path.is_dir():
                    path.chmod(0o755)


@pytest.fixture
def bucket(monkeypatch, tmp_path):
    """Store of fsspec in the memory, which stands for a bucket; the working folder stays empty."""
    fsspec = pytest.importorskip("fsspec")
    monkeypatch.chdir(tmp_path)
    system = fsspec.filesystem("memory")
    yield system
    if system.exists("/bucket"):
        system.rm("/bucket", recursive=True)
    assert not list(tmp_path.iterdir())


def test_a_study_at_an_address_is_that_of_the_memory_and_resumes(bucket, finished):
    address, whole = "memory://bucket/s.zarr", finished[1]
    assert presses(address)[0].equals(whole)
    found, blocks = presses(Path(address))
    assert (blocks, found.equals(whole)) == (0, True)
    chunks = [path for path in bucket.find("/bucket/s.zarr") if "/max_pressure/c/" in path]
    bucket.pipe_file(chunks[1], b"nonsense")
    bucket.rm("/bucket/s.zarr/clearance/zarr.json")
    found, blocks = presses(address)
    assert (blocks, found.equals(whole)) == (1, True)
    assert xr.open_zarr(address, consolidated=False).max_pressure.equals(whole.max_pressure)
    with pytest.raises(ValueError, match="memory://bucket/s.zarr has another study: axes.clearance"):
        presses(address, clearance=[0.1])
    bucket.pipe_file("/bucket/other/precious.txt", b"mine")
    with pytest.raises(ValueError, match="memory://bucket/other exists and is not a study"):
        presses("memory://bucket/other")
    message = "the remote store failed: slow down; 2 of 6 blocks stored; run the study"
    with stopped_at(2, RuntimeError("slow down")), pytest.raises(OSError, match=message) as no:
        presses("memory://bucket/slow.zarr")
    assert no.value.filename == "memory://bucket/slow.zarr"


def test_a_store_of_a_file_or_a_command_is_an_address_or_a_path_beside_the_file(tmp_path):
    fsspec = pytest.importorskip("fsspec")
    for store, expected in (("s.zarr", tmp_path / "s.zarr"), ("s3://bucket/s.zarr", "s3://bucket/s.zarr")):
        (tmp_path / "study.toml").write_text(STUDY.format(store), encoding="utf-8")
        assert read_study(tmp_path / "study.toml").store == expected
    done = run("study", "study.toml", "--store", "memory://bucket/c.zarr", folder=tmp_path)
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "memory://bucket/c.zarr")
    fsspec.filesystem("memory").rm("/bucket", recursive=True)
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_exports_to_addresses_are_complete(bucket):
    pressed = presses(None)[0]
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
        (lambda: presses("unknown://bucket/s.zarr"), "unknown://bucket/s.zarr: Protocol not known: unknown"),
        (lambda: export(presses(None)[0], "unknown://bucket/s.csv"), "unknown://bucket/s.csv: Protocol not known"),
        (lambda: bs.studies.table("s3://bucket/rows.csv"), "'s3://bucket/rows.csv' is the address of a remote store"),
        pytest.param(
            lambda: presses("s3://bucket/s.zarr"),
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
def test_a_remote_store_has_the_study_and_the_cohort_of_processes(monkeypatch, tmp_path, finished):
    """Files of fsspec in the working folder, which other processes reach too."""
    fsspec = pytest.importorskip("fsspec")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match="no such file or bucket: 'local://bucket/s.zarr'"):
        presses("local://bucket/s.zarr")
    monkeypatch.setenv("FSSPEC_LOCAL_AUTO_MKDIR", "true")
    monkeypatch.setitem(fsspec.config.conf, "local", {"auto_mkdir": True})
    found, blocks = presses("local://bucket/s.zarr", engine=Processes(workers=2))
    assert (blocks, found.equals(finished[1])) == (6, True)
    assert presses("local://bucket/s.zarr")[1] == 0
    assert len(list((tmp_path / "bucket" / "s.zarr" / CHECKSUM / "c").iterdir())) == 6
    short_file(tmp_path)
    words = ("hip", "hip.toml", "--patients", "2", "--store", "local://bucket/patients")
    for workers in ((), ("--workers", "1")):
        done = run(*words, *workers, folder=tmp_path)
        assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "local://bucket/patients/patients.csv")
    written = {path.name: path for path in (tmp_path / "bucket" / "patients").iterdir()}
    assert written.keys() == {"patients.json", "patients.csv", "patients_000000.npz"}
    assert len(written["patients.csv"].read_text(encoding="utf-8").splitlines()) == 3  # a head, two patients
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bucket", "hip.toml"]
