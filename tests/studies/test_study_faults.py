"""What can go wrong with a stored study, and that nothing done is lost and nothing wrong is kept."""

import json
import os
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.studies.run import read
from ballsocket.studies.store import CHECKSUM

HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": np.linspace(0.05, 0.2, 12).tolist(), "force": [500.0, 1500.0, 3000.0, 4000.0]}


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    monkeypatch.setattr("ballsocket.studies.run.points_per_block", lambda model: 8)


@pytest.fixture
def store(tmp_path):
    return tmp_path / "s.zarr"


def reference():
    return bs.study(bs.HessForsbach(), HIP, **AXES)


def presses(store):
    """Runs the study and counts the blocks that were computed."""
    told = []
    found = bs.study(bs.HessForsbach(), HIP, store=store, listen=told.append, **AXES).load()
    return found, len(told) - 1


def test_a_finished_study_is_not_computed_again(store):
    first, blocks = presses(store)
    assert blocks == 6
    again, blocks = presses(store)
    assert blocks == 0
    assert again.identical(first)


def chunks(store, name):
    return sorted(path for path in (store / name / "c").rglob("*") if path.is_file())


@pytest.mark.parametrize("damage", ["truncated", "garbage", "removed", "changed"])
def test_a_damaged_chunk_is_found_and_mended(store, damage):
    whole, _ = presses(store)
    chunk = chunks(store, "max_pressure")[2]
    if damage == "truncated":
        chunk.write_bytes(chunk.read_bytes()[:-5])
    elif damage == "garbage":
        chunk.write_bytes(b"nonsense")
    elif damage == "removed":
        chunk.unlink()
    else:
        chunk.write_bytes(chunks(store, "max_pressure")[3].read_bytes())
    again, blocks = presses(store)
    assert blocks == 1
    assert again.identical(whole)


def test_damaged_checksums_cost_their_blocks_only(store):
    whole, _ = presses(store)
    chunks(store, CHECKSUM)[0].write_bytes(b"")
    again, blocks = presses(store)
    assert 1 <= blocks <= 6
    assert again.identical(whole)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"clearance": [0.1]}, r"axes.clearance.clearance is \[0.05.* there and \[0.1\] here"),
        ({"quantities": ["energy"]}, "quantities is"),
        ({"model": bs.Bartel()}, "model.modulus"),
        ({"joint": bs.joints["hip-28"]}, r"joint.ball_radius is 17.9 there and 14.0 here"),
    ],
)
def test_the_store_of_another_study_is_refused_with_what_differs(store, change, message):
    presses(store)
    asked = {"model": bs.HessForsbach(), "joint": HIP, "quantities": (), **AXES, **change}
    with pytest.raises(ValueError, match=message):
        bs.study(asked.pop("model"), asked.pop("joint"), store=store, **asked)
    _, blocks = presses(store)
    assert blocks == 0


def test_the_store_of_other_code_is_refused(store, monkeypatch):
    presses(store)
    monkeypatch.setattr("ballsocket.studies.metadata.fingerprint", lambda: "9.9.9+other")
    with pytest.raises(ValueError, match="code is .* there and 9.9.9[+]other here"):
        presses(store)


def enclosing(value):
    def formula(radius, thickness, young, poisson):
        return value + 0.0 * radius

    return formula


def test_models_of_ones_own_are_told_apart(store):
    from ballsocket.models.modulus import Modulus

    def model(value):
        return bs.RadialFoundation(modulus=Modulus(name="mine", title="mine", formula=enclosing(value)))

    bs.study(model(100.0), HIP, store=store, force=[1000.0])
    with pytest.raises(ValueError, match=r"encloses\[0\] is 100.0 there and 300.0 here"):
        bs.study(model(300.0), HIP, store=store, force=[1000.0])


def test_a_finished_study_is_opened_on_a_full_disk(store, monkeypatch):
    presses(store)
    monkeypatch.setattr("ballsocket.core.storage.folders.available_disk_space", lambda path: 0)
    _, blocks = presses(store)
    assert blocks == 0


def test_damaged_axes_are_mended(store):
    whole, _ = presses(store)
    chunks(store, "clearance")[0].unlink()
    again, blocks = presses(store)
    assert blocks == 0
    assert again.identical(whole)


@pytest.mark.parametrize("name", ["clearance", "max_pressure"])
@pytest.mark.parametrize("damage", ["removed", "garbage"])
def test_damaged_labels_are_mended(store, name, damage):
    whole, _ = presses(store)
    label = store / name / "zarr.json"
    if damage == "removed":
        label.unlink()
    else:
        label.write_text("{", encoding="utf-8")
    again, blocks = presses(store)
    assert blocks == 0
    assert again.identical(whole)


def test_points_of_an_unfinished_store_say_so(store, monkeypatch):
    from ballsocket.studies.store import NOT_COMPUTED

    presses(store)
    chunk = chunks(store, "status")[0]
    chunk.unlink()
    assert (read(store).status.values == NOT_COMPUTED).any()


def test_a_worker_of_another_version_is_refused():
    from dataclasses import replace

    from ballsocket.studies.design import grid
    from ballsocket.studies.run import _create_task

    task = replace(_create_task(bs.HessForsbach(), HIP, None, {"force": [1000.0]}, ()), code="0.0.0+old")
    with pytest.raises(ValueError, match="this worker has ballsocket .*, but the run was started by 0.0.0.old"):
        task(0)
    assert grid(force=[1.0]).size == 1


def test_what_is_no_study_is_left_alone(store):
    store.mkdir()
    (store / "precious.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(ValueError, match="exists and is not a study"):
        presses(store)
    assert (store / "precious.txt").read_text(encoding="utf-8") == "mine"


LABEL = b'{"zarr_format": 3, "node_type": "group", "attributes": '


@pytest.mark.parametrize(
    "content",
    [
        b"null",
        b"[]",
        b'"a"',
        b"3",
        b"",
        b"\xff",
        b"[" * 100_000,
        LABEL + b"[]}",
        LABEL + b'{"study": null}}',
        LABEL + b'{"study": "a"}}',
        LABEL + b'{"study": []}}',
        LABEL + b'{"study": ' + b"[" * 2000 + b"]" * 2000 + b"}}",
    ],
    ids=range(12),
)
def test_a_store_whose_label_says_nothing_is_no_study(store, content):
    presses(store)
    (store / "zarr.json").write_bytes(content)
    with pytest.raises(ValueError, match=r"s.zarr exists and is not a study$"):
        presses(store)
    with pytest.raises(ValueError, match=r"s.zarr exists and is not a study$"):
        read(store)


def test_of_a_store_that_differs_in_everything_a_few_differences_are_told(store):
    presses(store)
    other = {f"{number}{'x' * 100}": "y" * 1000 for number in range(1000)}
    (store / "zarr.json").write_bytes(LABEL + f'{{"study": {json.dumps(other)}}}}}'.encode())
    with pytest.raises(ValueError, match="has another study: 0x+[.]{3} is y+[.]{3} there and missing here; 1x") as no:
        presses(store)
    assert len(str(no.value)) < 2000


def test_two_studies_that_begin_together_share_their_store(store, monkeypatch):
    """While one makes the store, another has made it: both have the answers."""
    from ballsocket.studies import store as module

    make = module._write_group

    def make_slowly(path, task, asked):
        make(path, task, asked)
        if not store.exists():
            monkeypatch.setattr(module, "_write_group", make)
            presses(store)

    monkeypatch.setattr(module, "_write_group", make_slowly)
    found, blocks = presses(store)
    assert blocks == 0
    assert found.identical(presses(store)[0])
    assert np.array_equal(found.max_pressure.values, reference().max_pressure.values)


def test_what_a_killed_process_was_writing_goes_with_the_next(store):
    old = store.parent / ".s.zarr.abc.draft"
    young, other = store.parent / ".s.zarr.def.draft", store.parent / ".mine.draft"
    for folder in (old, young, other):
        folder.mkdir()
        (folder / "part").write_text("half", encoding="utf-8")
    for folder in (old, other):
        os.utime(folder, (0, 0))
    presses(store)
    assert sorted(path.name for path in store.parent.iterdir()) == [".mine.draft", ".s.zarr.def.draft", "s.zarr"]


def test_what_is_being_written_stays(tmp_path):
    from ballsocket.core.storage.atomic_files import write_atomically, write_text

    with write_atomically(tmp_path / "a.txt") as draft:
        os.utime(draft.parent, (0, 0))
        write_text(tmp_path / "a.txt", "theirs")
        draft.write_text("ours", encoding="utf-8")
    assert (tmp_path / "a.txt").read_text(encoding="utf-8") == "ours"
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_a_full_disk_is_said_of_the_file_that_was_asked_for(tmp_path):
    from ballsocket.core.storage.atomic_files import write_atomically

    with pytest.raises(OSError, match="No space left on device: .*a.txt") as told, write_atomically(tmp_path / "a.txt"):
        raise OSError(28, "No space left on device")
    assert told.value.filename == str(tmp_path / "a.txt")
    assert not list(tmp_path.iterdir())


def test_a_disk_that_is_full_stops_with_one_sentence_and_keeps_what_is_done(store, monkeypatch):
    from ballsocket.studies.store import StudyStore

    write, written = StudyStore.write, []

    def full(self, task, number, answers):
        if len(written) == 3:
            raise OSError(28, "No space left on device")
        written.append(number)
        write(self, task, number, answers)

    monkeypatch.setattr(StudyStore, "write", full)
    with pytest.raises(OSError, match="No space left on device; 3 of 6 blocks are stored; run the study again"):
        presses(store)
    monkeypatch.setattr(StudyStore, "write", write)
    found, blocks = presses(store)
    assert blocks == 3
    assert np.array_equal(found.max_pressure.values, reference().max_pressure.values)


def read_only(store):
    for path in (store, *store.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)


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


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions of a system like Unix")
def test_a_read_only_store_is_one_sentence():
    with TemporaryDirectory() as folder:  # nobody may go there, as it may not to tmp_path
        store = Path(folder) / "s.zarr"
        Path(folder).chmod(0o755)
        whole, _ = presses(store)
        read_only(store)
        with nobody():
            again, blocks = presses(store)
            assert blocks == 0
            assert again.identical(whole)
        chunks(store, CHECKSUM)[0].unlink()
        with nobody(), pytest.raises(OSError, match="Permission denied; 5 of 6 blocks are stored"):
            presses(store)
