"""Forged packs with consistent checksums: each fails the check with a reason."""

import copy
import json
import os
import re
import shutil
import subprocess
from base64 import b64decode, b64encode
from datetime import date, timedelta
from functools import reduce
from importlib import import_module
from operator import getitem
from pathlib import Path

import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.core.executors import Serial
from ballsocket.evidence import comparison, folder
from ballsocket.evidence.comparison import compare
from ballsocket.evidence.credibility import assess
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, SIGNATURE, SUMS, digest_of, sign_pack, signature_of

from ..places import symlink_or_skip
from .small_pack import page

FIGURE = re.compile(rb"(?<=data:image/svg\+xml;base64,)[A-Za-z0-9+/=]+")


@pytest.fixture
def out(pack, tmp_path, monkeypatch):
    """Copy the pack. Its question is computed once for all forgeries; another test computes it completely."""
    monkeypatch.setattr(comparison, "gather_evidence", lambda *arguments: copy.deepcopy(pack[1]))
    return Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))


def record_of(out):
    return json.loads((out / RECORD).read_bytes())


def seal(out):
    names = [name for name in (QUESTION, RECORD, PAGE, "addendum.html") if (out / name).exists()]
    (out / SUMS).write_bytes(folder.sums_bytes({name: (out / name).read_bytes() for name in names}))


def plain_page(record, digest):
    """Make a page with two small figures, which is fast."""
    pressures = [row["numbers"]["max_pressure"] for row in record["matrix"]]
    figures = [b64encode(f"<svg fill='#000000'>{content}</svg>".encode()).decode() for content in ("joint", pressures)]
    images = "".join(f"<img src='data:image/svg+xml;base64,{figure}'>" for figure in figures)
    return f"<html lang='en'>{digest}{images}{json.dumps(record)}</html>\n"


def redraw(out, record):
    (out / RECORD).write_bytes(folder.record_bytes(record))
    sums = folder.digest({name: (out / name).read_bytes() for name in (QUESTION, RECORD)})
    (out / PAGE).write_text(plain_page(record, sums), "utf-8")


def replace_bytes(name, change):
    return lambda out: (out / name).write_bytes(change((out / name).read_bytes()))


def in_page(old, new):
    return replace_bytes(PAGE, lambda text: text.replace(old, new, 1))


def in_record(change, judged_again=False):

    def forge(out):
        record = record_of(out)
        change(record)
        redraw(out, {**record, **assess(record)} if judged_again else record)

    return forge


def updated(*path, **entries):
    return in_record(lambda record: reduce(getitem, path, record).update(entries))


SWAPPED = b64encode(b"<svg>All limits kept, 3 MPa</svg>")
swap_figure = replace_bytes(PAGE, lambda text: FIGURE.sub(SWAPPED, text, count=1))


def change_a_letter_of_a_figure(out):
    (_, figure) = FIGURE.findall((out / PAGE).read_bytes())
    in_page(figure, b64encode(b64decode(figure).replace(b"#000000", b"#000001", 1)))(out)


def add(name):
    def forge(out):
        if (out / name).exists():
            pytest.skip("the file system ignores case")
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_bytes(b"<h1>All limits are kept</h1>")

    return forge


def both(*forgeries):
    return lambda out: [forge(out) for forge in forgeries]


def link_the_page(out):
    target = out.parent / "elsewhere.html"
    (out / PAGE).rename(target)
    symlink_or_skip(out / PAGE, target)


def verdict(record):
    record["limits"][0]["verdict"] = "kept"


def reorder(record):
    record["worst"] = dict(reversed(record["worst"].items()))


def without_gaps(record):
    record["requirements"] = [row for row in record["requirements"] if row["status"] == "met"]


HIDDEN = b"data:image/><style>main,body>*{display:none}</style><h1 style=display:block>All limits are kept</h1>"
OTHER_VERSION = both(updated(version="1.0.0+deadbeef"), in_page(b"exceeded", b"kept"))
OTHER_LIBRARY = both(updated("made_with", matplotlib="3.4.1"), swap_figure)
DIGEST_DIFFERS = "the page differs from the page made from evidence.json"
NOT_CANONICAL = "evidence.json: differs from the canonical form"

FORGERIES = {
    "a figure that was swapped": (swap_figure, "figure 1 of the page differs from the figure made from evidence.json"),
    "one colour of a figure": (change_a_letter_of_a_figure, "figure 2 of the page differs from the figure"),
    "a page that hides itself": (in_page(b"<html lang=", b"<html lang=" + HIDDEN), "instead of"),
    "a verdict on the page": (in_page(b"exceeded", b"kept"), "instead of"),
    "text of no width on the page": (in_page(b"exceeded", "excee\u200bded".encode()), "instead of"),
    "a mark before the page": (replace_bytes(PAGE, lambda text: b"\xef\xbb\xbf" + text), "instead of"),
    "line ends of the page": (replace_bytes(PAGE, lambda text: text.replace(b"\n", b"\r\n")), "instead of"),
    "another digest on the page": (lambda out: in_page(digest_of(out).encode(), b"0" * 64)(out), "instead of"),
    "another version": (OTHER_VERSION, r"version: cannot be verified by this version of ballsocket, .*deadbeef"),
    "another library of figures": (OTHER_LIBRARY, "cannot be verified with matplotlib .*made with matplotlib 3.4.1"),
    "an added file": (add("addendum.html"), "addendum.html: does not belong to the pack"),
    "a name in capitals": (add("EVIDENCE.html"), "EVIDENCE.html: does not belong to the pack"),
    "a file in a folder": (add("more/addendum.html"), "more/addendum.html: does not belong to the pack"),
    "an empty folder": (lambda out: (out / "more").mkdir(), "more: does not belong to the pack"),
    "a link": (link_the_page, "evidence.html: is a symbolic link"),
    "a link to a folder": (lambda out: symlink_or_skip(out / "more", out.parent), "more: is a symbolic link"),
    "no page": (lambda out: (out / PAGE).unlink(), "evidence.html: written 'not listed', now 'missing'"),
    "a verdict in both": (in_record(verdict), r"limits\[0\].verdict: written 'kept', now 'exceeded'"),
    "a verdict in both, judged again": (in_record(verdict, True), r"limits\[0\].verdict: written 'kept'"),
    "a level of a factor": (updated("credibility", 7, reached="d"), r"credibility\[7\].reached: written 'd', now 'a'"),
    "gaps that were left out": (in_record(without_gaps), "requirements: written"),
    "an empty word more": (updated(approved=None), "approved: written None, now 'absent'"),
    "the word for nothing": (updated("limits", 0, certified="absent"), r"limits\[0\].certified: written 'absent'"),
    "a word less": (in_record(lambda record: record.pop("recentred")), "recentred: written 'absent'"),
    "another order": (in_record(reorder), "worst: has its keys in another order"),
    "a number as text": (updated("limits", 0, beyond="1"), r"limits\[0\].beyond: written '1', now 1"),
    "words behind the date": (updated(made_on="2026-01-01, approved"), "made_on: must be"),
    "a date to come": (updated(made_on=str(date.today() + timedelta(days=9))), "made_on: must be a date that is not"),
    "words among the libraries": (updated("made_with", numpy="2.4.6 and approved"), "made_with: holds more than"),
    "another library": (updated("made_with", approved="yes"), "made_with: holds more than the names and versions"),
    "a key twice": (replace_bytes(RECORD, lambda text: b'{"approved":"yes",' + text[1:]), NOT_CANONICAL),
    "line ends of the record": (replace_bytes(RECORD, lambda text: text.replace(b"\n", b"\r\n")), NOT_CANONICAL),
    "a comment in the question": (replace_bytes(QUESTION, lambda text: text + b"# approved\n"), DIGEST_DIFFERS),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_pack_is_reported_with_the_reason(name, out):
    forge, sentence = FORGERIES[name]
    redraw(out, record_of(out))
    seal(out)
    forge(out)
    seal(out)
    differences = compare(out, plain_page).differences
    assert any(re.search(sentence, str(difference)) for difference in differences), list(map(str, differences))
    assert all(difference.summary() for difference in differences)


def test_an_unchanged_pack_passes_and_a_record_without_a_possible_page_does_not(out):
    result = compare(out, page)
    assert (result.differences, result.digest) == ((), digest_of(out))
    assert result.digest in (out / PAGE).read_text("utf-8")
    record = record_of(out)
    del record["recentred"]
    (out / RECORD).write_bytes(folder.record_bytes(record))
    assert any("no page can be made of it" in str(difference) for difference in compare(out, page).differences)


def test_only_the_canonical_form_of_checksums_passes(out):
    text = (out / SUMS).read_bytes()
    lines = text.splitlines(keepends=True)
    forms = [text.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + text, b"".join(reversed(lines)), text + text]
    for form in [*forms, text.upper(), text.rstrip()]:
        (out / SUMS).write_bytes(form)
        assert compare(out, page).differences, form


@pytest.mark.parametrize(
    ("factor", "added", "equal"),  # a thousandth of the allowed error is 1e-16
    [(1 + 9e-10, 0.0, True), (1 + 1.1e-9, 0.0, False), (1.0, 9e-17, True), (1.0, 1.1e-16, False)],
)
def test_numbers_of_another_machine_may_differ_within_a_tolerance(out, factor, added, equal):
    def change(record):
        record["matrix"][3]["numbers"]["max_pressure"] *= factor
        record["code_verification"][0]["observed"] += added

    in_record(change, judged_again=True)(out)
    seal(out)
    where = {difference.where for difference in compare(out, plain_page).differences}
    assert where <= {"code_verification[0].observed", "matrix[3].numbers.max_pressure", "worst.max_pressure"}
    assert (not where) == equal


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_is_reported_and_not_opened(out):
    os.mkfifo(out / "wait")
    assert "wait: does not belong to the pack" in map(str, compare(out, page).differences)


def test_a_folder_with_many_files_is_refused(out):
    for number in range(196):
        (out / f"{number}.txt").touch()
    assert len(compare(out, page).differences) == 196
    (out / "another.txt").touch()
    with pytest.raises(ValueError, match="holds more than 200 files"):
        compare(out, page)


@pytest.fixture
def keys():
    pytest.importorskip("cryptography", reason="the extra for signatures is not installed")
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    return [Ed25519PrivateKey.from_private_bytes(bytes([number]) * 32) for number in (1, 2)]


def public(key):
    return import_module("ballsocket.evidence.signature").public_key_of(key)


def test_a_signature_is_verified_by_its_key_and_no_other(out, keys):
    sign_pack(out, keys[0])
    fingerprint = public(keys[0]).fingerprint
    assert signature_of(out, public(keys[0])).summary() == {"fingerprint": fingerprint, "verified": True}
    assert signature_of(out).expected is None
    assert compare(out, page).differences == ()
    with pytest.raises(ValueError, match="the signature is by another key, SHA256:.* not by SHA256:"):
        signature_of(out, public(keys[1]))


def of_another_pack(out):
    signature = (out / SIGNATURE).read_bytes()
    in_record(verdict, True)(out)
    seal(out)
    (out / SIGNATURE).write_bytes(signature)


def in_signature(change):

    def forge(out):
        first, *lines, last = (out / SIGNATURE).read_text("ascii").splitlines()
        blob = change(b64decode("".join(lines)))
        (out / SIGNATURE).write_bytes("\n".join([first, b64encode(blob).decode(), last, ""]).encode())

    return forge


@pytest.mark.parametrize(
    ("forge", "sentence"),
    [
        (replace_bytes(SIGNATURE, lambda text: text[:-60]), "the signature is damaged: its file is cut off"),
        (replace_bytes(SIGNATURE, lambda text: text.replace(b"A", b"B")), "the signature is"),
        (in_signature(lambda blob: blob + b"\0"), "bytes follow its end"),
        (in_signature(lambda blob: blob.replace(b"ballsocket", b"softballet")), "is for the purpose b'softballet'"),
        (of_another_pack, "is of other checksums: the pack was changed after it was signed"),
        (replace_bytes(SUMS, lambda text: text + b"\n"), "is of other checksums"),
        (lambda out: (out / SIGNATURE).unlink(), "checksums.txt.sig is missing: the pack is not signed"),
    ],
)
def test_invalid_signatures_are_refused_with_the_reason(out, keys, forge, sentence):
    sign_pack(out, keys[0])
    forge(out)
    with pytest.raises(ValueError, match=sentence):
        signature_of(out, public(keys[0]))


def test_a_check_signs_and_verifies_only_the_compared_checksums(out, keys, monkeypatch, capsys):
    """Checksums that replace the compared ones during a check are neither signed nor verified."""
    command = import_module("ballsocket.cli.evidence")
    sums, comparison = (out / SUMS).read_bytes(), compare(out, page)
    (out / SUMS).write_bytes(b"others")
    monkeypatch.setattr(command, "compare", lambda *words: comparison)
    command._check(out, Serial(), False, keys[0], None)
    assert signature_of(out, public(keys[0]), sums).expected
    with pytest.raises(ValueError, match="is of other checksums"):
        signature_of(out, public(keys[0]))
    command._check(out, Serial(), False, None, public(keys[0]))
    assert "signature verified: by SHA256:" in capsys.readouterr().out


@pytest.mark.skipif(shutil.which("ssh-keygen") is None, reason="ssh-keygen is not installed")
def test_signatures_are_exchangeable_with_ssh_keygen(out, keys, tmp_path):
    from ballsocket.evidence.signature import read_private_key, read_public_key

    key = tmp_path / "key"
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", "someone", "-f", key], check=True)
    sign_pack(out, read_private_key(key))
    assert signature_of(out, read_public_key(tmp_path / "key.pub")).expected
    allowed = tmp_path / "allowed"
    allowed.write_text(f"someone {(tmp_path / 'key.pub').read_text()}")
    command = ["ssh-keygen", "-Y", "verify", "-f", allowed, "-I", "someone", "-n", "ballsocket", "-s", out / SIGNATURE]
    process = subprocess.run(command, input=(out / SUMS).read_bytes(), capture_output=True, check=True)
    fingerprint = read_public_key(tmp_path / "key.pub").fingerprint
    assert fingerprint in process.stdout.decode()
    ours = (out / SIGNATURE).read_bytes()
    (out / SIGNATURE).unlink()
    subprocess.run(["ssh-keygen", "-q", "-Y", "sign", "-n", "ballsocket", "-f", key, out / SUMS], check=True)
    assert (out / SIGNATURE).read_bytes() == ours
    assert signature_of(out).key.fingerprint == fingerprint
    subprocess.run(["ssh-keygen", "-q", "-p", "-N", "secret", "-f", key], check=True)
    with pytest.raises(ValueError, match="is protected by a passphrase: sign with ssh-keygen -Y sign"):
        read_private_key(key)


@pytest.mark.parametrize("text", ["", "ssh-rsa AAAA me", "ssh-ed25519", "ssh-ed25519 AAAA", "ssh-ed25519 ?", "\xff"])
def test_a_file_without_a_key_is_refused(tmp_path, keys, text):
    from ballsocket.evidence.signature import read_private_key, read_public_key

    path = tmp_path / "key"
    path.write_text(text, "latin-1")
    with pytest.raises(ValueError, match="key must be a public Ed25519 key"):
        read_public_key(path)
    with pytest.raises(ValueError, match="key must be a private key of OpenSSH"):
        read_private_key(path)
