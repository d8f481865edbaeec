"""Packs by the command, and changed ones: each change is found with one sentence, with the checksums written again."""

import copy
import json
import os
import re
import shutil
from datetime import date, timedelta
from functools import reduce
from hashlib import sha256
from operator import getitem
from pathlib import Path

import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.evidence import comparison
from ballsocket.evidence.comparison import compare
from ballsocket.evidence.credibility import assess
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, SIGNATURES, SUMS, digest

from ..cli.command import answer, refusal, run


@pytest.fixture
def out(pack, tmp_path, monkeypatch):
    """Copy the pack. Its question is computed once for all changes; another test computes it completely."""
    monkeypatch.setattr(comparison, "gather_evidence", lambda *arguments: copy.deepcopy(pack[1]))
    return Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))


def change_record(out, change, judged_again=False):
    record = json.loads((out / RECORD).read_bytes())
    change(record)
    (out / RECORD).write_text(json.dumps({**record, **assess(record)} if judged_again else record), "utf-8")
    names = sorted((PAGE, RECORD, QUESTION))
    (out / SUMS).write_text("".join(f"{sha256((out / name).read_bytes()).hexdigest()}  {name}\n" for name in names))


def updated(*path, **entries):
    return lambda out: change_record(out, lambda record: reduce(getitem, path, record).update(entries))


def removed(*path):
    return lambda out: change_record(out, lambda record: reduce(getitem, path[:-1], record).pop(path[-1]))


def add(name):
    def change(out):
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_bytes(b"<h1>All limits are kept</h1>")

    return change


CHANGES = {
    "a page": (lambda out: (out / PAGE).write_text("All limits are kept"), "evidence.html: was changed: checksums.txt"),
    "an unlisted page": (lambda out: (out / SUMS).write_bytes(b""), "evidence.html: is not listed in checksums.txt"),
    "no page": (lambda out: (out / PAGE).unlink(), "evidence.html: is missing"),
    "a record": (
        lambda out: (out / RECORD).write_bytes((out / RECORD).read_bytes() + b" "),
        "evidence.json: was changed: checksums.txt",
    ),
    "another file": (add("addendum.html"), "addendum.html: does not belong to the pack"),
    "a file in a folder": (add("more/addendum.html"), "more/addendum.html: does not belong to the pack"),
    "a number": (updated("worst", "area", "numbers", area=1.0), r"worst.area.numbers.area: written 1.0, now 8\d\d"),
    "a number as text": (updated("limits", 0, beyond="1"), r"limits\[0\].beyond: written '1', now 1"),
    "a verdict": (updated("limits", 0, verdict="kept"), r"limits\[0\].verdict: written 'kept', now 'exceeded'"),
    "a level": (updated("credibility", 7, reached="d"), r"credibility\[7\].reached: written 'd', now 'a'"),
    "a case less": (removed("matrix", 1), "matrix: has 3 rows, computed 4"),
    "a requirement less": (removed("requirements", 0), r"requirements: has \d+ rows, computed \d+"),
    "a key less": (removed("recentred"), "recentred: is missing"),
    "an assessment less": (removed("adequacy"), "adequacy: is missing"),
    "a key more": (updated(approved=None), "approved: was added: no computation results in it"),
    "a key with the word for nothing": (updated("limits", 0, proven="absent"), r"limits\[0\].proven: was added"),
    "another library": (updated("made_with", approved="absent"), "made_with: has other names than python, system"),
    "words behind the date": (updated(made_on="2026-01-01, approved"), "made_on: must be a date"),
    "a date to come": (updated(made_on=str(date.today() + timedelta(days=9))), "made_on: must be a date that is not"),
    "another version": (updated(version="1.0.0+deadbeef"), "version: cannot be verified by this version .*deadbeef"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_pack_is_reported_with_one_sentence(name, out):
    change, sentence = CHANGES[name]
    change(out)
    result = compare(out)
    assert any(re.match(sentence, str(difference)) for difference in result.differences), result.differences
    assert len(result.differences) == (3 if name == "an unlisted page" else 1)


def test_an_unchanged_pack_passes_signed_or_not_and_other_libraries_are_notes(out):
    result = compare(out)
    assert (result.differences, result.notes) == ((), ())
    assert result.count > 200
    for name in SIGNATURES:
        (out / name).touch()
    assert compare(out).differences == ()
    assert result.digest == digest((out / SUMS).read_bytes())
    assert result.digest in (out / PAGE).read_text("utf-8")
    updated("made_with", numpy="1.2.3")(out)
    result = compare(out)
    assert result.differences == ()
    (note,) = result.notes
    assert note.startswith("made_with.numpy: written '1.2.3', now ")


@pytest.mark.parametrize(
    ("factor", "added", "equal"),  # a thousandth of the allowed error is 1e-16
    [(1 + 9e-10, 0.0, True), (1 + 1.1e-9, 0.0, False), (1.0, 9e-17, True), (1.0, 1.1e-16, False)],
)
def test_numbers_of_another_machine_may_differ_within_a_tolerance(out, factor, added, equal):
    def change(record):
        record["matrix"][3]["numbers"]["max_pressure"] *= factor
        record["code_verification"][0]["observed"] += added

    change_record(out, change, judged_again=True)
    where = {difference.where for difference in compare(out).differences}
    assert where <= {"code_verification[0].observed", "matrix[3].numbers.max_pressure"}
    assert (not where) == equal


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_is_reported_and_not_opened(out):
    for name in ("wait", PAGE):
        (out / name).unlink(missing_ok=True)
        os.mkfifo(out / name)
    assert list(map(str, compare(out).differences)) == [f"{PAGE}: is missing", "wait: does not belong to the pack"]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        (SUMS, None, "holds no pack of evidence: checksums.txt is missing"),
        (QUESTION, None, "holds no pack of evidence: question.toml is missing"),
        (RECORD, None, "holds no pack of evidence: evidence.json is missing"),
        (RECORD, b"{", "evidence.json cannot be read: 'Expecting property name"),
        (RECORD, b'{"limit": {"verdict": "kept", "verdict": "exceeded"}}', "key 'verdict' is there 2 times"),
        (RECORD, b"[]", "evidence.json holds no record of a pack"),
    ],
)
def test_a_folder_without_a_pack_is_refused(out, name, content, message):
    (out / name).unlink()
    if content is not None:
        (out / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        compare(out)


@pytest.mark.long
def test_a_stopped_run_is_resumed_and_leaves_only_the_pack(pack, out):
    for path in out.iterdir():
        path.unlink()
    shutil.copytree(pack[2] / "data", out / "data")
    words = "evidence", str(pack[2] / "asked.toml"), "--out", str(out)
    result = run(*words)
    stored = len(list((pack[2] / "data").rglob("*.json")))
    assert f"{stored} results of an earlier, stopped run not computed but read" in result.stdout
    assert result.stdout.startswith("largest pressure at most 15 MPa: exceeded: ")
    assert sorted(path.name for path in out.iterdir()) == sorted([PAGE, RECORD, SUMS, QUESTION])
    for name in (PAGE, RECORD, SUMS):
        assert (out / name).read_bytes() == (pack[2] / "out" / name).read_bytes()  # the same bytes, drawn again
    check = "evidence", "--check", str(out)
    said = answer(*check)
    assert said["digest"] in result.stdout
    assert (said["valid"], said["differences"], said["notes"]) == (True, [], [])
    strict = run(*check, "--strict")
    assert (strict.returncode, "largest pressure at most 15 MPa: exceeded: " in strict.stdout) == (1, True)
    (out / "notes.txt").touch()
    changed = run(*check)
    assert (changed.returncode, "notes.txt: does not belong to the pack" in changed.stdout) == (3, True)
    assert "holds other files ('notes.txt'): a pack needs an empty folder" in refusal(*words)
