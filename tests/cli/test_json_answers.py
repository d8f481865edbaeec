"""Fields of every JSON answer, and the next steps that it suggests."""

import json
import shlex
from inspect import signature

import pytest

from ballsocket.cli.root import load_commands

from ..places import EXAMPLES
from .command import run

FIELDS = ("valid", "error", "notes", "sources", "next")
STUDY = "joint = 'hip-28'\nmodel = 'hess-forsbach'\n[axes]\nforce = [1000, 2000]\n"

ASKED = {
    "press": ("press", "hip-36", "--force", "3 kN"),
    "film": ("film", "hip-36", "--force", "3 kN"),
    "curve": ("curve", "hip-36", "--force", "3 kN", "--points", "3"),
    "map": ("map", "hip-36", "--force", "3 kN", "--points", "2"),
    "optimise": ("optimise", "hip-36", "--force", "3 kN", "--vary", "clearance=50..200 um"),
    "sensitivity": (
        "sensitivity",
        "hip-36",
        "--force",
        "3 kN",
        "--spread",
        "liner_poisson=0.38..0.46",
        "--count",
        "64",
    ),
    "orient": ("orient", "hip-36", "--force", "3 kN", "--inclination", "40..50 deg", "--points", "2"),
    "study": ("study", "study.toml"),
    "identify": ("identify", str(EXAMPLES / "measured_areas.toml")),
    "calibrate": ("calibrate", "hip-36"),
    "models": ("models", "exact"),
    "presets": ("presets", "hip-36"),
}
ELSEWHERE = {"hip", "evidence", "planning"}  # these take seconds: their own tests look


def said(*words, folder=None):
    return json.loads(run(*words, "--json", folder=folder).stdout)


def test_all_commands_with_json_are_tested_here_or_in_their_room():
    spoken = {name for name, command in load_commands().items() if "as_json" in signature(command).parameters}
    assert spoken == {*ASKED, *ELSEWHERE}


@pytest.mark.parametrize("name", ASKED)
def test_an_answer_has_validity_sources_and_next_steps(name, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    answer = said(*ASKED[name], folder=tmp_path)
    assert [each for each in FIELDS if each not in answer] == []
    assert all(each["key"] and each["text"] for each in answer["sources"])
    assert answer["sources"]
    for step in answer["next"]:
        command, *words = shlex.split(step["command"])
        assert (command, step["why"] != "") == ("ballsocket", True)
        assert words[0] in load_commands()


def test_the_next_step_after_an_invalid_model_gives_a_valid_result():
    answer = said("press", "hip-36", "--force", "3 kN", "--model", "hertz")
    assert not answer["valid"]
    assert any("half-space" in note for note in answer["notes"])
    words = shlex.split(answer["next"][0]["command"])[1:]
    assert words == ["press", "hip-36", "--force", "3 kN", "--model", "exact"]
    better = said(*words)
    assert better["valid"]
    assert 0 < better["error"]["exact"]["max_pressure"] < 1e-6


@pytest.mark.long
def test_the_next_step_after_optimise_presses_the_best_joint():
    answer = said(*ASKED["optimise"])
    step = shlex.split(answer["next"][0]["command"])[1:]
    exact = next(each for each in said(*step)["results"] if each["model"] == "exact")
    assert exact["max_pressure"] == pytest.approx(answer["value"], rel=1e-3)


def test_validity_of_a_tilted_load_is_that_of_sphere_not_of_exact():
    answer = said("press", "hip-36", "--force", "3 kN", "--tilt", "45 deg", "--ring-width", "6 deg")
    assert answer["valid"]
    assert not next(each["valid"] for each in answer["results"] if each["model"] == "exact")


def test_the_last_point_of_a_curve_equals_a_press():
    answer = said("curve", "hip-36", "--force", "3 kN", "--points", "4", "--model", "hertz")
    assert answer["force"] == [0.0, 1000.0, 2000.0, 3000.0]
    assert answer["valid"] is all(answer["valid_at"]) is False
    last = said("press", "hip-36", "--force", "3 kN", "--model", "hertz")["results"][0]
    assert answer["max_pressure"][-1] == pytest.approx(last["max_pressure"], rel=1e-12)
    assert "Hertz 1882" in [each["text"] for each in answer["sources"]]


def test_json_of_a_small_study_has_extremes_and_all_values(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    answer = said("study", "study.toml", folder=tmp_path)
    assert answer["values"]["force"] == [1000.0, 2000.0]
    assert answer["quantities"]["max_pressure"]["largest"]["at"]["force"] == 2000.0
    assert answer["values"]["max_pressure"][1] == answer["quantities"]["max_pressure"]["largest"]["value"]


@pytest.mark.long
def test_several_joints_have_an_answer_and_next_steps_each():
    names = ("hip-32", "hip-36")
    answer = said("press", *names, "--force", "3 kN")
    assert [each for each in FIELDS if each not in answer] == []
    for name, joint in zip(names, answer["joints"], strict=True):
        alone = said("press", name, "--force", "3 kN")
        assert joint == alone
        assert all(step in answer["next"] for step in alone["next"])
        assert all(f"{name}: {note}" in answer["notes"] for note in alone["notes"])
    assert answer["sources"]
