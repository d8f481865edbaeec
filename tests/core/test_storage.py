"""Input files of a server; atomic files, named arrays and their cache, fingerprints, and resumable runs of pieces."""

import os
import stat
import struct
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from ballsocket.core.executors import Serial
from ballsocket.core.input_files import open_input, record_inputs, resolve_input, resolve_inside, restriction_variables
from ballsocket.core.storage import atomic_files
from ballsocket.core.storage.atomic_files import is_draft_folder, make_draft_folder, read_arrays, write_arrays
from ballsocket.core.storage.pieces import PieceRun, PieceStore, hash_inputs

from ..places import symlink_or_skip


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def interrupted(path, error):
    with atomic_files.write_atomically(path) as draft:
        draft.write_text("half", encoding="utf-8")
        raise error(draft)


def test_a_file_of_a_name_of_any_length_is_written_completely_or_not_at_all(tmp_path):
    path = tmp_path / "a.txt"
    mask = os.umask(0o022)
    try:
        with atomic_files.write_atomically(path) as draft:
            draft.write_text("new", encoding="utf-8")
            assert (draft.name, draft.parent.parent) == ("a.txt", tmp_path)
            assert is_draft_folder(draft.parent.name)
            assert not path.exists()
    finally:
        os.umask(mask)
    if os.name == "posix":
        assert stat.S_IMODE(path.stat().st_mode) == 0o644
    with pytest.raises(KeyboardInterrupt):
        interrupted(path, lambda draft: KeyboardInterrupt())
    assert path.read_text(encoding="utf-8") == "new"
    assert names(tmp_path) == ["a.txt"]
    assert atomic_files.write_text(path, "µ", "latin-1").read_bytes() == b"\xb5"
    assert atomic_files.write_text(path, "µ").read_bytes() == b"\xc2\xb5"
    with atomic_files.write_atomically(tmp_path / "store") as draft:
        draft.mkdir()
        atomic_files.write_text(draft / "part", "1")
    assert names(tmp_path / "store") == ["part"]
    name = "n" * 255
    assert atomic_files.write_text(tmp_path / name, "x").read_text(encoding="utf-8") == "x"
    with make_draft_folder(tmp_path / name) as folder:
        assert folder.name.startswith(f".{'n' * 40}.")


def test_errors_name_the_requested_file_and_those_of_other_files_their_own(tmp_path):
    path, missing = tmp_path / "a.txt", tmp_path / "missing" / "a.txt"
    with pytest.raises(FileNotFoundError) as error:
        atomic_files.write_text(missing, "x")
    assert error.value.filename == str(missing)
    with pytest.raises(OSError, match="No space left on device") as error:
        interrupted(path, lambda draft: OSError(28, "No space left on device", str(draft)))
    assert error.value.filename == str(path)
    with pytest.raises(OSError, match="other") as error:
        interrupted(path, lambda draft: OSError(2, "No such file", "other"))
    assert error.value.filename == "other"


def test_only_old_unlocked_draft_folders_of_the_same_file_are_removed(tmp_path, monkeypatch):
    monkeypatch.setattr(atomic_files, "_MIN_AGE", 6e4)  # no machine is as slow as the difference from this
    for name, seconds in (("a.txt.young", 3e4), ("a.txt.old", 9e4), ("b.txt.old", 1e9)):
        folder = tmp_path / f".{name}.draft"
        folder.mkdir()
        then = max(os.stat(tmp_path).st_mtime - seconds, 0.0)
        os.utime(folder, (then, then))
    with make_draft_folder(tmp_path / "a.txt") as locked:
        os.utime(locked, (0, 0))
        atomic_files.write_text(tmp_path / "a.txt", "x")
        assert locked.is_dir()
    assert names(tmp_path) == [".a.txt.young.draft", ".b.txt.old.draft", "a.txt"]
    assert not any(map(is_draft_folder, ("a.draft", ".a", "a")))


def test_arrays_are_read_as_they_were_written(tmp_path):
    path = tmp_path / "a.npz"
    write_arrays(path, table=np.arange(6.0).reshape(2, 3), count=3, text="µ", empty=np.zeros((0, 2)))
    arrays = read_arrays(path)
    assert list(arrays) == ["table", "count", "text", "empty"]
    np.testing.assert_array_equal(arrays["table"], [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]])
    assert (int(arrays["count"]), str(arrays["text"]), arrays["empty"].shape) == (3, "µ", (0, 2))


def without_a_member(content):
    """Return an archive whose directory does not list its first member."""
    size, begin = struct.unpack("<LL", content[-10:-2])
    entry = 46 + sum(struct.unpack("<HHH", content[begin + 28 : begin + 34]))
    return content[:-10] + struct.pack("<LL", size - entry, begin + entry) + content[-2:]


DAMAGE = {
    "empty": lambda content: b"",
    "cut": lambda content: content[:-5],
    "half": lambda content: content[: len(content) // 2],
    "changed": lambda content: content[:100] + bytes([content[100] ^ 255]) + content[101:],
    "more members": lambda content: content[:-12] + b"\x03" + content[-11:],
    "fewer members": lambda content: content[:-12] + b"\x01" + content[-11:],
    "member not listed": without_a_member,
    "no archive": lambda content: b"PK" + bytes(100),
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_damaged_arrays_and_objects_are_refused(tmp_path, damage):
    path = tmp_path / "a.npz"
    write_arrays(path, x=np.arange(9.0), y=np.ones(2))
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises((ValueError, OSError)):
        read_arrays(path)
    np.savez(path, x=np.array([{}], dtype=object))
    with pytest.raises(ValueError, match="Object arrays"):
        read_arrays(path)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("BALLSOCKET_CACHE", str(tmp_path))
    return tmp_path


def counted(value):
    """Return a function that returns an array, and the list of its calls."""
    calls = []

    def compute():
        calls.append(value)
        return np.full((2, 3), value)

    return compute, calls


def test_a_cached_array_is_computed_once_for_each_key_and_again_if_damaged(cache):
    compute, calls = counted(2.0)
    atomic_files.cached_array("key", compute)
    (file,) = cache.iterdir()
    content = file.read_bytes()
    for damage in (content.replace(b"(2, 3)", b"(1, 3)"), b"", b"short"):
        file.write_bytes(damage)
        assert (atomic_files.cached_array("key", compute) == 2.0).all()
    assert len(calls) == 4
    assert file.read_bytes() == content
    compute, calls = counted(1.5)
    for key in ((1.0, "a"), (1.0, "a"), (2.0, "a")):
        np.testing.assert_array_equal(atomic_files.cached_array(key, compute), np.full((2, 3), 1.5))
    assert len(calls) == 2
    digest = sha256(b"3 (1.0, 'a')").hexdigest()[:32]
    assert f"cup-{digest}.npz" in names(cache)


def test_the_oldest_cached_arrays_are_removed_above_the_size_limit(cache, monkeypatch):
    for number in range(4):
        atomic_files.cached_array(number, lambda: np.zeros(100))
        newest = max(cache.glob("cup-*"), key=lambda path: path.stat().st_mtime_ns)
        os.utime(newest, (1000.0 + number, 1000.0 + number))
    size = newest.stat().st_size
    (cache / "mine.txt").write_bytes(bytes(10 * size))
    monkeypatch.setattr(atomic_files, "_MAX_CACHE_SIZE", 2 * size)
    atomic_files.cached_array("new", lambda: np.zeros(100))
    times = sorted(path.stat().st_mtime for path in cache.glob("cup-*"))
    assert len(times) == 2
    assert times[0] == 1003.0
    assert (cache / "mine.txt").exists()


def test_the_cache_folder_follows_the_environment_and_need_not_be_writable(tmp_path, monkeypatch):
    atomic_files.write_text(tmp_path / "file", "")
    monkeypatch.setenv("BALLSOCKET_CACHE", str(tmp_path / "file" / "folder"))
    compute, calls = counted(1.0)
    for _ in range(2):
        assert (atomic_files.cached_array("key", compute) == 1.0).all()
    assert len(calls) == 2
    monkeypatch.setenv("BALLSOCKET_CACHE", "/here")
    monkeypatch.setenv("XDG_CACHE_HOME", "/cache")
    assert atomic_files.cache_folder() == Path("/here")
    monkeypatch.delenv("BALLSOCKET_CACHE")
    assert atomic_files.cache_folder() == Path("/cache/ballsocket")
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", lambda: Path("/home/me"))
    assert atomic_files.cache_folder() == Path("/home/me/.cache/ballsocket")


def test_digests_differ_by_value_type_and_order():
    inputs = [(1, 2), (2, 1), (1.0, 2), ("1", 2), ((1, 2),), (12,)]
    digests = {hash_inputs(*values) for values in inputs}
    assert len(digests) == len(inputs)
    assert {len(digest) for digest in digests} == {64}
    assert hash_inputs(1, "a") == hash_inputs(1, "a")


class MemoryStore(PieceStore):
    def __init__(self, **results):
        self.results = {int(number.strip("_")): result for number, result in results.items()}

    def load(self, numbers):
        return {number: self.results[number] for number in numbers if number in self.results}

    def save(self, number, result):
        self.results[number] = result
        return f"stored {result}"


def square(number):
    if number == 13:
        raise ValueError("thirteen")
    return number * number


def test_a_run_computes_and_stores_the_missing_pieces_and_all_of_them_without_a_store():
    store = MemoryStore(_1="one", _3=None, _9="other run")
    run = PieceRun(square, range(5), store)
    assert run.stored == {1: "one", 3: None}
    assert run.missing == [0, 2, 4]
    assert list(run.compute_missing(Serial())) == [(0, "stored 0"), (2, "stored 4"), (4, "stored 16")]
    assert store.results == {0: 0, 1: "one", 2: 4, 3: None, 4: 16, 9: "other run"}
    again = PieceRun(square, range(5), store)
    assert again.missing == []
    assert list(again.compute_missing(Serial())) == []
    run = PieceRun(square, [2, 1])
    assert (run.stored, run.missing) == ({}, [2, 1])
    assert list(run.compute_missing(Serial())) == [(2, 4), (1, 1)]
    store = MemoryStore()
    with pytest.raises(ValueError, match="thirteen"):
        list(PieceRun(square, [11, 12, 13, 14], store).compute_missing(Serial()))
    assert PieceRun(square, [11, 12, 13, 14], store).missing == [13, 14]


def test_opened_inputs_are_recorded_once(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    for path in (first, second):
        path.write_text("text", encoding="utf-8")
    with record_inputs() as outer:
        open_input(first).close()
        with record_inputs() as inner:
            open_input(first).close()
            open_input(second).close()
            open_input(second).close()
        assert inner == [first, second]
    assert outer == [first, second]
    open_input(first).close()
    assert outer == [first, second]


def test_inputs_are_limited_to_allowed_folders(tmp_path, monkeypatch):
    folder = tmp_path / "allowed"
    folder.mkdir()
    (folder / "joint.toml").write_text("inside", encoding="utf-8")
    (tmp_path / "other.toml").write_text("outside", encoding="utf-8")
    symlink_or_skip(folder / "link.toml", tmp_path / "other.toml")
    assert resolve_input(tmp_path / "other.toml") == tmp_path / "other.toml"
    for name, value in restriction_variables([folder]).items():
        monkeypatch.setenv(name, value)
    with open_input(folder / "joint.toml") as stream:
        assert stream.read() == b"inside"
    for path in (tmp_path / "other.toml", folder / "link.toml", folder / ".." / "other.toml"):
        with pytest.raises(ValueError, match="lies outside the folder of this server"):
            open_input(path)
    with pytest.raises(ValueError, match="is not a regular file"):
        open_input(folder)
    with pytest.raises(FileNotFoundError):
        open_input(folder / "missing.toml")
    assert resolve_inside((tmp_path.resolve(),), folder, "folder") == folder.resolve()
