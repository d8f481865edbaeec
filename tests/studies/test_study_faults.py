"""What can go wrong with a stored study, and that nothing done is lost and nothing wrong is kept."""

import json
import os
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.storage.atomic_files import write_atomically, write_text
from ballsocket.models.modulus import Modulus
from ballsocket.studies import store as store_module
from ballsocket.studies.run import _create_task, read
from ballsocket.studies.store import CHECKSUM, NOT_COMPUTED, StudyStore

from ..cli.command import run

HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": np.linspace(0.05, 0.2, 12).tolist(), "force": [500.0, 1500.0, 3000.0, 4000.0]}
ASKED = {"model": bs.HessForsbach(), "joint": HIP, "quantities": ["max_pressure"], **AXES}


@pytest.fixture(autouse=True, scope="module")
def small_blocks():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ballsocket.studies.run.points_per_block", lambda model: 8)
        yield


def presses(store, **change):
    """Runs the study and counts the blocks that were computed."""
    progress, asked = [], {**ASKED, **change}
    found = bs.study(asked.pop("model"), asked.pop("joint"), store=store, listen=progress.append, **asked).load()
    return found, len(progress) - 1


@pytest.fixture(scope="module")
def finished(small_blocks, tmp_path_factory):
    """The folder of a study whose six blocks are stored, and its results."""
    folder = tmp_path_factory.mktemp("finished") / "s.zarr"
    results, blocks = presses(folder)
    assert blocks == 6
    return folder, results


@pytest.fixture
def store(finished, tmp_path):
    """A copy of the finished study."""
    return copytree(finished[0], tmp_path / "s.zarr")


def chunks(store, name):
    return sorted(path for path in (store / name / "c").rglob("*") if path.is_file())


def test_a_finished_study_is_not_computed_again_even_on_a_full_disk(store, finished, monkeypatch):
    monkeypatch.setattr("ballsocket.core.storage.folders.available_disk_space", lambda path: 0)
    again, blocks = presses(store)
    assert blocks == 0
    assert again.identical(finished[1])


@pytest.mark.parametrize(
    ("part", "damage", "blocks"),
    [
        ("max_pressure/c/2/0", "truncated", 1),
        ("max_pressure/c/2/0", "garbage", 1),
        ("max_pressure/c/2/0", "removed", 1),
        ("max_pressure/c/2/0", "that of another block", 1),
        (f"{CHECKSUM}/c", "truncated", 6),  # the checksums are read together
        ("clearance/c", "removed", 0),
        ("clearance/zarr.json", "removed", 0),
        ("clearance/zarr.json", "garbage", 0),
        ("max_pressure/zarr.json", "removed", 0),
        ("max_pressure/zarr.json", "garbage", 0),
    ],
)
def test_a_damaged_part_is_found_and_mended(store, finished, part, damage, blocks):
    path = store / part
    if path.is_dir():
        path = min(file for file in path.rglob("*") if file.is_file())
    if damage == "removed":
        path.unlink()
    else:
        other = (store / "max_pressure" / "c" / "3" / "0").read_bytes()
        path.write_bytes({"truncated": path.read_bytes()[:-5], "garbage": b"{"}.get(damage, other))
    again, computed = presses(store)
    assert computed == blocks
    assert again.identical(finished[1])


def test_the_store_of_another_study_or_other_code_is_refused_with_what_differs(store, monkeypatch):
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


def test_custom_models_are_distinguished_by_what_their_formula_encloses(tmp_path):
    def enclosing(value):
        def formula(radius, thickness, young, poisson):
            return value + 0.0 * radius

        return bs.RadialFoundation(modulus=Modulus(name="mine", title="mine", formula=formula))

    bs.study(enclosing(100.0), HIP, store=tmp_path / "s.zarr", force=[1000.0])
    with pytest.raises(ValueError, match=r"encloses\[0\] is 100.0 there and 300.0 here"):
        bs.study(enclosing(300.0), HIP, store=tmp_path / "s.zarr", force=[1000.0])


def test_points_of_an_unfinished_store_have_a_status(store):
    chunks(store, "status")[0].unlink()
    assert (read(store).status.values == NOT_COMPUTED).any()


def test_a_folder_that_is_no_study_is_left_alone(tmp_path):
    (tmp_path / "precious.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(ValueError, match="exists and is not a study"):
        presses(tmp_path)
    assert [path.read_text("utf-8") for path in tmp_path.iterdir()] == ["mine"]


LABEL = b'{"zarr_format": 3, "node_type": "group", "attributes": '


def test_a_store_whose_label_has_no_study_is_no_study(store):
    for content in (
        *(b"null", b"[]", b'"a"', b"3", b"", b"\xff", b"[" * 100_000, LABEL + b"[]}"),
        *(LABEL + b'{"study": ' + entry + b"}}" for entry in (b"null", b'"a"', b"[]", b"[" * 2000 + b"]" * 2000)),
    ):
        (store / "zarr.json").write_bytes(content)
        for opened in (presses, read):
            with pytest.raises(ValueError, match=r"s.zarr exists and is not a study$"):
                opened(store)


def test_of_a_store_that_differs_in_everything_a_few_differences_are_named(store):
    other = {f"{number}{'x' * 100}": "y" * 1000 for number in range(1000)}
    (store / "zarr.json").write_bytes(LABEL + f'{{"study": {json.dumps(other)}}}}}'.encode())
    with pytest.raises(ValueError, match="has another study: 0x+[.]{3} is y+[.]{3} there and missing here; 1x") as no:
        presses(store)
    assert len(str(no.value)) < 2000


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
    assert blocks == 0
    assert found.identical(presses(store)[0])
    assert np.array_equal(found.max_pressure.values, finished[1].max_pressure.values)


def test_drafts_of_a_killed_process_are_removed_by_the_next_that_makes_the_store(tmp_path):
    old, young, other = (tmp_path / name for name in (".s.zarr.abc.draft", ".s.zarr.def.draft", ".mine.draft"))
    for folder in (old, young, other):
        folder.mkdir()
        (folder / "part").write_text("half", encoding="utf-8")
    for folder in (old, other):
        os.utime(folder, (0, 0))
    presses(tmp_path / "s.zarr")
    assert sorted(path.name for path in tmp_path.iterdir()) == [".mine.draft", ".s.zarr.def.draft", "s.zarr"]


def test_a_draft_that_is_being_written_stays(tmp_path):
    with write_atomically(tmp_path / "a.txt") as draft:
        os.utime(draft.parent, (0, 0))
        write_text(tmp_path / "a.txt", "theirs")
        draft.write_text("ours", encoding="utf-8")
    assert (tmp_path / "a.txt").read_text(encoding="utf-8") == "ours"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_a_full_disk_is_reported_with_the_name_of_the_requested_file(tmp_path):
    with pytest.raises(OSError, match="No space left on device: .*a.txt") as no, write_atomically(tmp_path / "a.txt"):
        raise OSError(28, "No space left on device")
    assert no.value.filename == str(tmp_path / "a.txt")
    assert not list(tmp_path.iterdir())


def test_a_full_disk_stops_with_one_sentence_and_keeps_the_stored_blocks(tmp_path, finished, monkeypatch):
    write, written = StudyStore.write, []

    def full(self, task, number, answers):
        if len(written) == 3:
            raise OSError(28, "No space left on device")
        written.append(number)
        write(self, task, number, answers)

    monkeypatch.setattr(StudyStore, "write", full)
    with pytest.raises(OSError, match="No space left on device; 3 of 6 blocks are stored; run the study again"):
        presses(tmp_path / "s.zarr")
    monkeypatch.setattr(StudyStore, "write", write)
    found, blocks = presses(tmp_path / "s.zarr")
    assert blocks == 3
    assert np.array_equal(found.max_pressure.values, finished[1].max_pressure.values)


def test_control_c_keeps_the_stored_blocks_and_the_command_resumes(tmp_path, finished, monkeypatch):
    (tmp_path / "s.toml").write_text(
        'joint = "hess-forsbach"\nmodel = "hess-forsbach"\nstore = "s.zarr"\nquantities = ["max_pressure"]\n'
        f"[axes]\nclearance = {{from = 0.05, to = 0.2, count = 12}}\nforce = {AXES['force']}\n"
    )
    write = StudyStore.write

    def interrupted(self, task, number, answers):
        if number == 2:
            raise KeyboardInterrupt
        write(self, task, number, answers)

    monkeypatch.setattr(StudyStore, "write", interrupted)
    stopped = run("study", "s.toml", folder=tmp_path)
    assert stopped.returncode == 130
    assert "points are stored in s.zarr: run the command again to resume" in " ".join(stopped.stderr.split())
    monkeypatch.setattr(StudyStore, "write", write)
    assert (read(tmp_path / "s.zarr").status.values != NOT_COMPUTED).sum() == 16
    assert run("study", "s.toml", folder=tmp_path).returncode == 0
    assert np.array_equal(read(tmp_path / "s.zarr").max_pressure.values, finished[1].max_pressure.values)


@contextmanager
def nobody():
    """Root may write everywhere: for a while this process is nobody."""
    if os.geteuid() != 0:
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
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
            assert blocks == 0
            assert again.identical(finished[1])
            chunk = chunks(store, CHECKSUM)[0]
            chunk.parent.chmod(0o755)
            chunk.unlink()
            chunk.parent.chmod(0o555)
            with nobody(), pytest.raises(OSError, match="Permission denied; 5 of 6 blocks are stored"):
                presses(store)
        finally:
            for path in paths:
                if path.is_dir():
                    path.chmod(0o755)
