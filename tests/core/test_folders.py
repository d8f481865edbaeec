"""Folders of results, on a local disk and in remote stores: files, drafts, errors and addresses."""

import pytest

from ballsocket.core.storage.folders import LocalFolder, RemoteFolder, folder_at

fsspec = pytest.importorskip("fsspec")


@pytest.fixture(params=["local", "memory"])
def folder(request, tmp_path):
    """Return an empty folder; the store of fsspec in the memory stands for a bucket."""
    yield folder_at(tmp_path / "results" if request.param == "local" else "memory://bucket/results")
    system = fsspec.filesystem("memory")
    if system.exists("/bucket"):
        system.rm("/bucket", recursive=True)


def test_files_are_read_as_they_were_written(folder):
    assert not folder.exists()
    assert folder.names() == set()
    folder.write("a.json", b"one")
    folder.write("a.json", b"two")
    folder.write("b.npz", bytes(100))
    assert folder.exists()
    assert folder.names() == {"a.json", "b.npz"}
    assert (folder.read("a.json"), folder.read("a.json", 2)) == (b"two", b"tw")
    with pytest.raises(FileNotFoundError):
        folder.read("c.json")


def write_draft(path):
    (path / "array").mkdir(parents=True)
    (path / "label").write_text("label", encoding="utf-8")
    (path / "array" / "part").write_text("part", encoding="utf-8")


def test_a_remote_folder_has_its_label_first(monkeypatch):
    written = []
    monkeypatch.setattr(RemoteFolder, "write", lambda self, name, content: written.append(name))
    folder_at("memory://bucket/results").create(write_draft)
    assert written == ["label", "array/part"]


def test_addresses_and_paths_are_folders_of_their_kind(tmp_path):
    assert folder_at("s3://bucket/a.zarr/") == RemoteFolder("s3://bucket/a.zarr")
    assert folder_at(f"file://{tmp_path}") == folder_at(tmp_path) == LocalFolder(tmp_path)
    assert folder_at(tmp_path).free_space() < folder_at("s3://bucket/a").free_space()
