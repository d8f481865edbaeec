"""The view of evidence without a browser: what is typed becomes a question, and a pack is what the command writes."""

import io
import zipfile
from html import unescape
from math import radians
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.evidence.question import read_question
from ballsocket.files.joint_file import JointFile
from ballsocket.hip.config import read_hip

from .asking import edits, saved, trouble

pytest.importorskip("panel", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app.jobs import Job
from ballsocket.app.running import RunFinished
from ballsocket.app.session import Page
from ballsocket.app.state.evidence_question import DEFAULT_QUESTION, EvidenceQuestion
from ballsocket.app.state.use import DEFAULT_USE, Use
from ballsocket.app.views.evidence import view as evidence
from ballsocket.app.views.evidence.worker import EvidencePack, gather_pack, write_question

LINK = "view=evidence&preset=hip-36&load.force=3000"
CUP = bs.Cup(inclination=radians(40.0))
FILE = JointFile(bs.joints["hip-36"], {"force": 3000.0})


def opened(link=LINK):
    page = Page(link)
    page._refresh()  # the page has loaded
    return page


def told(page, name):
    return unescape(page.channel.shown_value(f"#evidence-{name}") or "")


def test_what_is_typed_is_a_question_file(tmp_path):
    asked = EvidenceQuestion(
        limits="max_pressure <= 20 MPa; half_angle <= 60 deg",
        matrix="force = 2, 3 kN; inclination = 30, 45 deg; clearance = 0.1 mm",
        tolerances="clearance = 0.1 +- 0.02 mm",
        friction="0.06",
        elements="yes",
        wear="yes",
    )
    use = Use(cycle="walking", body_weight=750.0, millions=2.0, creep="yes")
    found = write_question(asked, JointFile(FILE.joint, FILE.load, CUP), use, tmp_path)
    assert found.axes["force"] == (2000.0, 3000.0)
    assert found.axes["inclination"] == pytest.approx((radians(30.0), radians(45.0)))
    assert (found.file.joint.ball_radius, found.file.cup) == (18.0, CUP)
    assert [str(limit) for limit in found.limits] == ["max_pressure ≤ 20", "half_angle ≤ 1.0472"]
    assert (found.accuracy, found.friction, found.finite_elements) == (0.1, 0.06, True)
    hip = read_hip(found.hip)
    assert (hip.cycles, hip.use.cycle.name, hip.use.creep is not None) == (2e6, "walking", True)
    assert hip.use.cycle.force_magnitudes.max() == pytest.approx(2.47 * 750, rel=0.01)
    plain = write_question(DEFAULT_QUESTION, FILE, DEFAULT_USE, tmp_path)
    assert (plain.file.joint, plain.hip) == (FILE.joint, None)
    assert not (tmp_path / "hip.toml").exists()  # it would be taken along


def test_a_question_is_read_as_it_is_typed():
    page = opened()
    assert "2 cases" in told(page, "said")
    edits(page, "evidence.matrix", "force = 2, 3 kN; clearance = 0.05, 0.1, 0.15 mm")
    assert "6 cases" in told(page, "said")
    assert "ask.matrix=" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen
    edits(page, "evidence.matrix", "clearance = 0.05, 0.1 mm")
    assert "[matrix] needs a load" in told(page, "said")
    edits(page, "evidence.run", True)
    assert "[matrix] needs a load" in unescape(trouble(page))


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("limits", "max_presure <= 20 MPa", "did you mean 'max_pressure'"),
        ("limits", "max_pressure", "is not a limit"),
        ("matrix", "force", "needs a name and ="),
        ("matrix", "liner = uhmwpe, pom", "'liner' in the matrix"),
        ("tolerances", "clearance", "needs a name and ="),
        ("tolerances", "clearance = wide", "clearance"),
        ("accuracy", "half", "accuracy"),
        ("friction", "5", "a coefficient of friction is 0 to 2"),
        ("question", "/etc/passwd", "is a path, and words are needed"),
        ("context", "../../secret.toml", "is a path, and words are needed"),
    ],
)
def test_what_is_wrong_with_a_question_is_said_in_the_view(name, value, sentence):
    page = opened()
    edits(page, f"evidence.{name}", value)
    assert sentence in told(page, "said")


@pytest.mark.parametrize(("name", "value"), [("influence", "huge"), ("elements", True), ("colour", "red")])
def test_what_is_no_input_is_refused(name, value):
    page = opened()
    before = page.screen
    edits(page, f"evidence.{name}", value)
    assert name in trouble(page)
    assert page.screen == before


def test_the_pack_that_was_gathered_is_taken(monkeypatch):
    folders = []

    def ask(self, key, work):
        folders.append(Path(work.args[-1]))
        assert folders[-1].is_dir()
        worst = {"max_pressure": {"numbers": {"max_pressure": 11.2}, "errors": {}, "case": {"force": 2000.0}}}
        self._heard(key, RunFinished(EvidencePack(conclusions=("kept",), record={"worst": worst}, content=b"a pack")))

    monkeypatch.setattr(Job, "ask", ask)
    monkeypatch.setattr(evidence, "_PACKS", evidence.CachedRun(max_size=4))
    page = opened()
    edits(page, "evidence.take", True)
    assert "there is no pack of this yet" in trouble(page)
    edits(page, "evidence.run", True)
    assert "11.2 MPa" in told(page, "found")
    assert edits(page, "evidence.take", True)["file"]["name"] == "evidence.zip"
    assert b"largest pressure,11.2 MPa" in saved(page, "CSV")
    edits(page, "liner_young", 900)
    assert told(page, "found") == ""  # another joint
    page.leave()
    assert not folders[0].exists()


@pytest.mark.long
def test_a_pack_is_what_the_command_writes(tmp_path):
    news = []
    asked = EvidenceQuestion(matrix="force = 2000 N")
    found = gather_pack(asked, FILE, DEFAULT_USE, str(tmp_path), news.append)
    shares = [each.share for each in news]
    assert shares == sorted(shares)
    with zipfile.ZipFile(io.BytesIO(found.content)) as pack:
        assert pack.namelist() == ["checksums.txt", "evidence.html", "evidence.json", "question.toml"]
        pack.extractall(tmp_path / "again")
    assert read_question(tmp_path / "again" / "question.toml").axes == {"force": (2000.0,)}
    exact = bs.Exact().press(FILE.joint, force=2000.0).max_pressure
    assert found.record["worst"]["max_pressure"]["numbers"]["max_pressure"] == pytest.approx(exact, rel=1e-6)
