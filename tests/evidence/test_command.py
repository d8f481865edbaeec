"""The command `evidence`: resumed runs, digests, signatures and exit statuses."""

import copy
import json
import shutil

import pytest
from typer.testing import CliRunner

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.cli import evidence as command
from ballsocket.cli.root import app
from ballsocket.evidence import comparison
from ballsocket.evidence.folder import PAGE, RECORD, SIGNATURE, SUMS

from .small_pack import page


@pytest.fixture
def run(pack, monkeypatch):
    """Run the command in this process; its question is computed once for all tests."""
    monkeypatch.setattr(comparison, "gather_evidence", lambda *arguments: copy.deepcopy(pack[1]))
    monkeypatch.setattr(command, "evidence_page", page)
    return lambda *words: CliRunner().invoke(app, ["evidence", *map(str, words)])


@pytest.fixture
def key(tmp_path):
    pytest.importorskip("cryptography", reason="the extra for signatures is not installed")
    from cryptography.hazmat.primitives import serialization as form
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    private_key = Ed25519PrivateKey.from_private_bytes(b"7" * 32)
    path = tmp_path / "key"
    path.write_bytes(private_key.private_bytes(form.Encoding.PEM, form.PrivateFormat.OpenSSH, form.NoEncryption()))
    public = private_key.public_key().public_bytes(form.Encoding.OpenSSH, form.PublicFormat.OpenSSH)
    (tmp_path / "key.pub").write_bytes(public + b" someone\n")
    return path


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
    assert (comparison["valid"], comparison["differences"], comparison["signature"]) == (True, [], None)
    assert result.stdout.startswith("largest pressure at most 15 MPa: exceeded: ")
    strict = run("--check", out, "--strict")
    assert (strict.exit_code, "largest pressure at most 15 MPa: exceeded: " in strict.stdout) == (1, True)


def test_only_a_pack_that_agrees_is_signed_and_its_signature_is_verified(pack, run, key, tmp_path):
    out = shutil.copytree(pack[2] / "out", tmp_path / "out")
    assert "not signed: author, question and date are not confirmed" in run("--check", out).stdout
    assert "checksums.txt.sig is missing" in run("--check", out, "--verify", f"{key}.pub").stdout
    assert "signed with SHA256:" in run("--check", out, "--sign", key).stdout
    result = run("--check", out, "--verify", f"{key}.pub")
    assert (result.exit_code, "signature verified: by SHA256:" in result.stdout) == (0, True)
    comparison = json.loads(run("--check", out, "--json").stdout)
    assert (comparison["valid"], comparison["signature"]["verified"]) == (True, None)
    (out / SIGNATURE).write_text("nothing")
    result = run("--check", out)
    assert (result.exit_code, "signature: the signature is damaged" in result.stdout) == (3, True)
    (out / SIGNATURE).unlink()
    (out / PAGE).write_bytes((out / PAGE).read_bytes().replace(b"exceeded", b"kept"))
    result = run("--check", out, "--sign", key)
    assert (result.exit_code, "not signed: the pack differs" in result.stdout) == (3, True)
    assert not (out / SIGNATURE).exists()


def test_commands_that_cannot_run_are_refused(pack, run, tmp_path):
    (tmp_path / "notes.txt").touch()
    for words, sentence in (
        (("q.toml", "--verify", "key.pub"), "--verify needs --check"),
        (("--check", "pack", "--verify", "a", "--sign", "b"), "--verify and --sign exclude each other"),
        ((pack[2] / "asked.toml", "--out", tmp_path), "holds other files ('notes.txt'): a pack needs an empty folder"),
    ):
        assert sentence in str(run(*words).exception)


@pytest.mark.long
def test_a_signed_pack_is_computed_in_one_run(pack, key, tmp_path):
    out = tmp_path / "new"
    shutil.copytree(pack[2] / "data", out / "data")
    (matrix,) = out.rglob("matrix_block_0.json")
    piece = json.loads(matrix.read_text("utf-8"))
    piece["result"][0]["numbers"]["max_pressure"] = 1.0
    matrix.write_text(json.dumps(piece), "utf-8")
    result = CliRunner().invoke(app, ["evidence", str(pack[2] / "asked.toml"), "--out", str(out), "--sign", str(key)])
    assert result.exit_code == 0
    assert "were read from an earlier" not in result.output
    assert (out / RECORD).read_bytes() == (pack[2] / "out" / RECORD).read_bytes()
    assert (out / SIGNATURE).exists()
