"""The same questions through the three doors: command line, tools for assistants, and explorer."""

import csv
import io
import math

import pytest

from ballsocket.cli.root import load_commands
from ballsocket.files.joint_file import parse_joint
from ballsocket.mcp.call import command_line
from ballsocket.question import PressQuestion, complete, real_cup_reason
from ballsocket.question import answer as answer_question

from .cli.command import answer
from .extent import some
from .places import EXAMPLES

HIP = '[joint]\nhead_diameter = 28\nclearance = 0.1\nliner_thickness = 5\n[liner]\nmaterial = "uhmwpe"\n[load]\n'
TIGHT = '[joint]\nball_radius = 16\ninterference = 0.1\nliner_thickness = 8\n[liner]\nmaterial = "pom"\n'
QUESTIONS = {
    "hip": (EXAMPLES / "hip.toml").read_text("utf-8"),
    "metal backing": (EXAMPLES / "metal_backed_hip.toml").read_text("utf-8"),
    "indentation": HIP + "indentation = 0.04\n",
    "half angle": HIP + "half_angle = 40\n",
    "oriented cup": (EXAMPLES / "tilted_hip.toml").read_text("utf-8"),
    "tilt of zero": HIP + "force = 3000\ntilt = 0\n",
    "tilt": HIP + "force = 3000\ntilt = 20\n",
    "direction": HIP + "force = 3000\ndirection = [-0.3, 0.0, 1.0]\n",
    "near the rim": HIP + "force = 3000\n[cup]\narc_of_cover = 110\n",
    "beyond the strength": HIP + "force = 60000\n",
    "preloaded": (EXAMPLES / "ball_joint.toml").read_text("utf-8"),
    "preloaded, half socket": TIGHT + "[load]\nforce = 1000\n[cup]\narc_of_cover = 180\n",
    "preloaded, at rest, without a cup": TIGHT,
}


def by_model(results):
    """Return pressure and validity by model, of the models with a result."""
    return {row["model"]: (row["max_pressure"], row["valid"]) for row in results if row["max_pressure"] is not None}


@pytest.mark.parametrize("name", some(QUESTIONS))
def test_a_question_has_one_answer_at_every_door(name, tmp_path):
    pytest.importorskip("tornado")
    from ballsocket.app.state.designs import read_upload
    from ballsocket.app.state.screen import START, link_of

    from .app.asking import numbers, opened, saved, told

    (tmp_path / "joint.toml").write_text(QUESTIONS[name], encoding="utf-8")
    file = parse_joint(QUESTIONS[name].encode(), name)
    solved, needs_cup = answer_question(PressQuestion(file=file)), bool(real_cup_reason(file))
    printed, every = (answer("press", "joint.toml", *words, folder=tmp_path) for words in ((), ("--all",)))
    assert by_model(printed["results"]) == {
        model: (pytest.approx(float(contact.max_pressure), rel=1e-12), bool(contact.valid))
        for model, contact in solved.comparison.items()
    }
    assert printed["results"][0]["model"] == ("sphere" if needs_cup else "hess-forsbach")
    assert printed.get("assumptions", []) == list(solved.assumptions)
    assert by_model(printed["results"]).items() <= by_model(every["results"]).items()
    for tool, results in (("press", printed), ("compare", every)):
        words = command_line(tool, {"joint": "joint.toml"}, tmp_path, load_commands())
        called = answer(*words[:-1], folder=tmp_path)
        assert (called["results"], called.get("assumptions")) == (results["results"], results.get("assumptions"))
    (screen,) = read_upload(QUESTIONS[name], START)
    page = opened(link_of(screen))
    rows = csv.DictReader(io.StringIO(saved(page, "CSV").decode()))
    shown = {row["model"]: (float(row["max_pressure_MPa"]), row["valid"] == "True") for row in rows}
    assert {
        model: (pytest.approx(pressure, rel=1e-6), valid)
        for model, (pressure, valid) in by_model(every["results"]).items()
    } == {model: each for model, each in shown.items() if not math.isnan(each[0])}
    leading = float(solved.comparison[solved.leading].max_pressure)
    assert numbers(page, "press-numbers")["max_pressure"] == leading
    written = told(page, "press-numbers")
    assert ("(sphere)" in written) == needs_cup
    assert all(sentence in written for sentence in complete(page.screen.file)[1].values())
