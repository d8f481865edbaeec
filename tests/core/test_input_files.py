"""Input files: folders of a server, and records of the files that were read."""

import pytest

from ballsocket.core.input_files import open_input, record_inputs, resolve_input, resolve_inside, restriction_variables

from ..places import symlink_or_skip


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
