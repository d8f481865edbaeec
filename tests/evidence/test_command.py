"""The command `evidence`: resumed runs, digests and exit statuses."""

import copy
import json
import shutil

import pytest
from typer.testing import CliRunner

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.cli import evidence as command
from ballsocket.cli.root import app
from ballsocket.evidence import comparison
from ballsocket.evidence.folder import PAGE, RECORD, SUMS

from .small_pack import page


@pytest.fixture
def run(pack, monkeypatch):
    """Run the command in this process; its question is computed once for all tests."""
    monkeypatch.setattr(comparison, "gather_evidence", lambda *arguments: copy.deepcopy(pack[1]))
    monkeypatch.setattr(command, "evidence_page", page)
    return lambda *words: CliRunner().invoke(app, ["evidence", *map(str, words)])


def test_a_stopped_run_is_resumed_and_leaves_only_the_pack(pack, run, tmp_path):
    out = tmp_path / "new"
    shutil.copytree(pack[2] / "data", out / "data")
    result = run(pack[2] / "asked.toml", "--out", out)
    stored = len(list((pack[2] / "data").rglob("*.json")))
    assert f"{stored} results were read from an earlier, stopped run and not computed" in result.stdout
    assert sorted(path.name for path in out.iterdir()) == sorted([PAGE, RECORD, SUMS, "question.toml"])
    for name in (PAGE, RECORD, SUMS):
        assert (out / name).read_bytes() == (pack[2] / "out" / name).read_bytes()  # the same bytes, drawn again
    comparison = json.loads(run("--check", out, "--json").stdout)
    assert comparison["digest"] in result.stdout
    assert (comparison["valid"], comparison["differences"], comparison["notes"]) == (True, [], [])
    assert result.stdout.startswith("largest pressure at most 15 MPa: exceeded: ")
    strict = run("--check", out, "--strict")
    assert (strict.exit_code, "largest pressure at most 15 MPa: exceeded: " in strict.stdout) == (1, True)


def test_a_folder_with_other_files_is_refused(pack, run, tmp_path):
    (tmp_path / "notes.txt").touch()
    result = run(pack[2] / "asked.toml", "--out", tmp_path)
    assert "holds other files ('notes.txt'): a pack needs an empty folder" in str(result.exception)
