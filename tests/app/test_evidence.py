"""The view of evidence without a browser: what is typed becomes a question, and a pack is what the command writes."""

import io
import zipfile
from html import unescape
from math import radians
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.app import results
from ballsocket.app.jobs import Job
from ballsocket.app.running import RunFinished
from ballsocket.app.state.evidence_question import DEFAULT_QUESTION, EvidenceQuestion
from ballsocket.app.state.use import DEFAULT_USE, Use
from ballsocket.app.views.evidence import view as evidence
from ballsocket.app.views.evidence.worker import EvidencePack, gather_pack, write_question
from ballsocket.evidence.question import read_question
from ballsocket.files.joint_file import JointFile
from ballsocket.hip.config import read_hip

from .asking import does, edits, opened, saved, trouble

LINK = "view=evidence&preset=hip-36&load.force=3000"
CUP = bs.Cup(inclination=radians(40.0))
FILE = JointFile(bs.joints["hip-36"], {"force": 3000.0})


def told(page, name):
    return unescape(page.channel.shown_value(f"#evidence-{name}") or "")


def test_what_is_typed_is_a_question_file(tmp_path):
    limits, tolerances = "max_pressure <= 20 MPa; half_angle <= 60 deg", "clearance = 0.1 +- 0.02 mm"
    matrix = "force = 2, 3 kN; inclination = 30, 45 deg; clearance = 0.1 mm"
    more = {"tolerances": tolerances, "friction": "0.06", "elements": "yes", "wear": "yes"}
    asked = EvidenceQuestion(limits=limits, matrix=matrix, **more)
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
    page = opened(LINK)
    assert "2 cases" in told(page, "found")
    assert "2000 N, 3000 N" in told(page, "found")
    edits(page, "evidence.matrix", "force = 2, 3 kN; clearance = 0.05, 0.1, 0.15 mm")
    assert "6 cases" in told(page, "found")
    assert "ask.matrix=" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen
    edits(page, "evidence.matrix", "clearance = 0.05, 0.1 mm")
    assert "[matrix] needs a load" in told(page, "found")
    edits(page, "evidence.run", True)
    assert "[matrix] needs a load" in told(page, "trouble")


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("matrix", "force", "needs a name and ="),
        ("matrix", "liner = uhmwpe, pom", "'liner' in the matrix"),
        ("tolerances", "clearance", "needs a name and ="),
        ("tolerances", "clearance = wide", "clearance"),
        ("accuracy", "half", "accuracy"),
        ("friction", "5", "a coefficient of friction is 0 to 2"),
        ("question", "/etc/passwd", "is a path, and words are needed"),
    ],
)
def test_what_is_wrong_with_a_question_is_said_in_the_view(name, value, sentence):
    page = opened(LINK)
    edits(page, f"evidence.{name}", value)
    assert sentence in told(page, "found")


def test_limits_are_rows():
    page = opened(LINK)
    edits(page, "evidence.limits", [["max_pressure", "<=", "20"], ["half_angle", "<=", "60"]])
    assert page.screen.asked.limits.startswith("max_pressure<=20.0; half_angle<=1.047")
    assert page.channel.shown_value("=evidence.limits")["value"][1] == ["half_angle", "<=", "60"]
    assert opened(page.channel.shown_value("link")).screen == page.screen
    does(page, "choose", name="units", value="imperial")
    edits(page, "evidence.limits", [["max_pressure", "<=", "3000"]])
    (limit,) = evidence._limits(page.screen.asked)
    assert limit.high == pytest.approx(20.68, rel=1e-3)


def test_a_limit_is_asked_for_before_anything_runs(asked):
    page = opened(LINK)
    assert "✗ No limit is stated" in told(page, "found")
    edits(page, "evidence.run", True)
    assert "Evidence needs a limit to decide on" in told(page, "trouble")
    edits(page, "evidence.allowable", True)
    assert "the liner has no allowable pressure" in trouble(page)
    edits(page, "allowable", 20)
    edits(page, "evidence.allowable", True)
    assert page.screen.asked.limits == "max_pressure <= 20 MPa"
    assert asked == []
    edits(page, "evidence.run", True)
    assert len(asked) == 1
    page.leave()


def test_the_pack_that_was_gathered_is_taken(monkeypatch):
    folders = []
    limits = [
        {"name": "max_pressure", "low": None, "high": high, "verdict": verdict, "beyond": beyond, "unknown": 0}
        for high, verdict, beyond in ((20.0, "kept", 0), (10.0, "not kept", 2))
    ]

    def ask(self, key, work):
        folders.append(Path(work.args[-1]))
        assert folders[-1].is_dir()
        worst = {"max_pressure": {"numbers": {"max_pressure": 11.2}, "errors": {}, "case": {"force": 2000.0}}}
        record = {"worst": worst, "limits": limits}
        pack = EvidencePack(conclusions=("one: kept", "two: not kept", "accurate"), record=record, content=b"a pack")
        self._heard(key, RunFinished(pack))

    monkeypatch.setattr(Job, "ask", ask)
    monkeypatch.setattr(results, "RESULTS", results.ResultStore())
    page = opened(f"{LINK}&ask.limits=max_pressure <= 20 MPa")
    edits(page, "evidence.take", True)
    assert "there is no result for this design yet" in trouble(page)
    edits(page, "evidence.run", True)
    found = told(page, "found")
    assert "11.2 MPa" in found
    assert found.startswith("<p class='verdict no'>✗ largest pressure at most 10 MPa: not kept</p>")
    assert "✓ largest pressure at most 20 MPa: kept" in found
    assert edits(page, "evidence.take", True)["file"]["name"] == "evidence.zip"
    assert b"largest pressure,11.2 MPa" in saved(page, "CSV")
    edits(page, "liner_young", 900)
    assert told(page, "found") == found
    assert "belong to an earlier design" in told(page, "earlier")
    edits(page, "evidence.take", True)
    assert "there is no result for this design yet" in trouble(page)
    page.leave()
    assert not folders[0].exists()


@pytest.mark.long
def test_a_pack_is_what_the_command_writes(tmp_path):
    news, asked = [], EvidenceQuestion(matrix="force = 2000 N")
    found = gather_pack(asked, FILE, DEFAULT_USE, str(tmp_path), lambda reached: news.append(reached.share))
    assert news == sorted(news)
    with zipfile.ZipFile(io.BytesIO(found.content)) as pack:
        assert pack.namelist() == ["checksums.txt", "evidence.html", "evidence.json", "question.toml"]
        pack.extractall(tmp_path / "again")
    assert read_question(tmp_path / "again" / "question.toml").axes == {"force": (2000.0,)}
    exact = bs.Exact().press(FILE.joint, force=2000.0).max_pressure
    assert found.record["worst"]["max_pressure"]["numbers"]["max_pressure"] == pytest.approx(exact, rel=1e-6)
