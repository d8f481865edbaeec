"""Every command that answers: fields of its JSON, suggested next steps, tables in narrow terminals, and films."""

import re
import shlex
from inspect import signature
from typing import get_args

import pytest

from ballsocket.cli.json_answers import FLAGS
from ballsocket.cli.root import load_commands
from ballsocket.core.quantities import CONTACT

from ..extent import some
from ..places import EXAMPLES
from .command import answer, printed, run

FIELDS = ("valid", "error", "notes", "sources", "next")
HIP = ("hip-36", "--force", "3 kN")
SPRINGS = ("--model", "hess-forsbach")
PLANNING = EXAMPLES / "planning"
STUDY = f"""
joint = "{(EXAMPLES / "hip.toml").as_posix()}"
model = "tabulated"
[axes]
ball_radius = {{ from = "11 mm", to = "20 mm", count = 2 }}
liner = ["uhmwpe", "crosslinked-pe"]
force = [1000, 3000]
"""
CALLS = {
    "press": (*HIP, "--all"),
    "film": (*HIP, *SPRINGS, "--model", "exact"),
    "curve": (*HIP, "--points", "3"),
    "map": (*HIP, "--points", "3", *SPRINGS, "--limit", "max_pressure<=20 MPa"),
    "optimise": (
        *(*HIP, "--vary", "clearance=50..200 um", "--points", "3", *SPRINGS),
        *("--minimise", "max_pressure", "--minimise", "indentation"),
    ),
    "sensitivity": (*HIP, "--spread", "clearance=0.1+-0.05 mm", "--count", "16", *SPRINGS),
    "orient": (f"{EXAMPLES / 'tilted_hip.toml'}", "--points", "3", "--ring-width", "6"),
    "study": ("study.toml",),
    "identify": (f"{EXAMPLES / 'measured_areas.toml'}",),
    "calibrate": ("hip-36",),
    "models": ("exact",),
    "presets": ("hip-36",),
}
"""Commands with JSON, and arguments that take little time."""

TABLES = CALLS | {
    "planning": (
        *("--landmarks", f"{PLANNING / 'pelvis.mrk.json'}", "--vertical", "0,0,1"),
        *("--liner", f"{PLANNING / 'liner.stl'}", "--head", f"{PLANNING / 'head.stl'}"),
    ),
    "hip": (f"{EXAMPLES / 'hip_in_use.toml'}",),
    "calibrate": (),
    "models": (),
    "presets": (),
}
SLOW = {"hip", "calibrate"}
WITHOUT_TABLE = {
    *("app", "serve-mcp"),  # servers
    *("cite", "schema", "build-tables"),  # BibTeX, JSON
    *("deck", "fmu", "export", "evidence", "reproduce"),  # names of files
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def test_all_commands_are_tested_here_or_in_their_room():
    spoken = {name for name, command in load_commands().items() if "as_json" in signature(command).parameters}
    assert spoken == {*CALLS, "hip", "evidence", "planning"}  # these take seconds: their own tests look
    assert {*TABLES, *WITHOUT_TABLE} == {*load_commands()}


@pytest.mark.parametrize("name", CALLS)
def test_an_answer_has_validity_sources_and_next_steps(name, folder):
    said = answer(name, *CALLS[name], folder=folder)
    assert [each for each in FIELDS if each not in said] == []
    assert said["sources"]
    assert all(each["key"] and each["text"] for each in said["sources"])
    for step in said["next"]:
        command, *words = shlex.split(step["command"])
        assert (command, step["why"] != "") == ("ballsocket", True)
        assert words[0] in load_commands()


@pytest.mark.parametrize(
    "command", [pytest.param(key, marks=pytest.mark.long if key in SLOW else ()) for key in TABLES]
)
def test_tables_fit_narrow_terminals_without_cut_numbers(command, folder):
    for columns in some((60, 80), 1):
        done = run(command, *TABLES[command], columns=columns, folder=folder)
        assert done.returncode == 0, done.stderr
        assert max(map(len, done.stdout.splitlines())) <= columns
        assert "…" not in done.stdout


@pytest.mark.long
def test_all_numbers_of_a_wide_table_are_in_a_narrow_one(folder):
    for command in ("curve", "study", "calibrate", "identify"):
        wide, narrow = (run(command, *TABLES[command], columns=width, folder=folder).stdout for width in (200, 40))
        assert {*re.findall(r"\d\S*", wide)} <= {*re.findall(r"\d\S*", narrow)}


@pytest.mark.long
def test_a_narrow_press_table_names_the_columns_that_it_omits():
    symbols = {quantity.symbol for quantity in CONTACT.values()} - {"p0", "φmax"}  # same as pmax, and zero
    for columns in (80, 60, 40):
        text = run("press", "hip-36", "--force", "3 kN", columns=columns).stdout
        heads = next(line.split() for line in text.splitlines() if line.startswith("model "))
        omitted = " ".join(text.split()).partition("not shown, the terminal is too narrow: ")[2]
        assert all((symbol in heads) != (f"{symbol} " in omitted) for symbol in symbols)
        assert ("U energy" in omitted) == (columns < 80)


def test_the_next_step_has_a_model_that_is_valid_and_the_joint_wherever_it_stands_in_the_command():
    said = answer("press", "hip-36", "--force", "3 kN", "--model", "hertz")
    assert not said["valid"]
    assert any("half-space" in note for note in said["notes"])
    words = shlex.split(said["next"][0]["command"])[1:]
    assert words == ["press", "hip-36", "--force", "3 kN", "--model", "exact"]
    better = answer(*words)
    assert better["valid"]
    assert 0 < better["error"]["exact"]["max_pressure"] < 1e-6
    words = ("--force=2 kN", "--liner", "pom", "hip-36", "--spread", "clearance=0.10+-0.05 mm")
    said = answer("sensitivity", *words, "--count", "4", "--intervals", "none", "--second-order")
    assert said["next"][0]["command"] == "ballsocket press hip-36 --liner pom --force '2 kN' --all"


def test_every_requested_model_decides_on_the_validity_and_sphere_under_a_tilted_load():
    for words in (("--model", "exact", "--model", "hertz"), ("--model=exact", "--model=hertz")):
        assert not answer("press", "hip-36", "--force", "3 kN", *words)["valid"]
    said = answer("press", "hip-36", "--force", "3 kN", "--tilt", "45 deg", "--ring-width", "6 deg")
    assert said["valid"]
    assert not next(each["valid"] for each in said["results"] if each["model"] == "exact")


def test_options_without_a_value_are_known():
    tables = (signature(command, eval_str=True).parameters for command in load_commands().values())
    answering = (part for parameters in tables if "as_json" in parameters for part in parameters.values())
    switches = {part.name for part in answering if get_args(part.annotation)[:1] == (bool,)}
    named = {"every": "all", "as_json": "json"}
    assert {f"--{named.get(name, name)}".replace("_", "-") for name in switches} == FLAGS


@pytest.mark.long
def test_the_next_step_after_optimise_presses_the_best_joint():
    said = answer("optimise", "hip-36", "--force", "3 kN", "--vary", "clearance=50..200 um")
    step = shlex.split(said["next"][0]["command"])[1:]
    exact = next(each for each in answer(*step)["results"] if each["model"] == "exact")
    assert exact["max_pressure"] == pytest.approx(said["value"], rel=1e-3)


@pytest.mark.parametrize("command", ["press", "curve"])
def test_gap_of_the_command_line_reaches_the_exact_solution(command):
    """At c/R2 0.0054 the linear gap lowers pmax by about half a percent; it is the default there."""
    named, circular = (answer(command, *HIP, "--model", "exact", *gap) for gap in ((), ("--gap", "circular")))
    low, high = (found["results"][0] if command == "press" else found for found in (named, circular))
    ends = [number["max_pressure"] for number in (low, high)]
    first, last = ends if command == "press" else (values[-1] for values in ends)
    assert 0.003 < last / first - 1 < 0.007


def test_the_last_point_of_a_curve_equals_a_press():
    said = answer("curve", "hip-36", "--force", "3 kN", "--points", "4", "--model", "hertz")
    assert said["force"] == [0.0, 1000.0, 2000.0, 3000.0]
    assert said["valid"] is all(said["valid_at"]) is False
    last = answer("press", "hip-36", "--force", "3 kN", "--model", "hertz")["results"][0]
    assert said["max_pressure"][-1] == pytest.approx(last["max_pressure"], rel=1e-12)
    assert "Hertz 1882" in [each["text"] for each in said["sources"]]


@pytest.mark.long
def test_several_joints_have_an_answer_and_next_steps_each():
    names = ("hip-32", "hip-36")
    said = answer("press", *names, "--force", "3 kN")
    assert [each for each in FIELDS if each not in said] == []
    for name, joint in zip(names, said["joints"], strict=True):
        alone = answer("press", name, "--force", "3 kN")
        assert joint == alone
        assert all(step in said["next"] for step in alone["next"])
        assert all(f"{name}: {note}" in said["notes"] for note in alone["notes"])
    assert said["sources"]


@pytest.mark.long
def test_the_command_writes_figures_and_samples(tmp_path):
    pytest.importorskip("emcee")
    pictures = ("--figure", "fit.png", "--corner", "corner.png", "--experiment", "next.png")
    words = ("identify", str(EXAMPLES / "measured_joint.toml"), "--samples", "200", *pictures)
    assert "R-hat 1.0" in printed(*words, folder=tmp_path)
    assert all((tmp_path / name).stat().st_size > 10_000 for name in pictures[1::2])


FILM = ("film", f"{EXAMPLES / 'hip.toml'}", "--force", "1500 N")


def test_rates_have_units_and_an_axis():
    (fast,) = answer(*FILM, "--spin", "180 deg/s", "--method", "Inlet")["results"]
    assert fast["method"] == "inlet"
    assert fast["spin_rad_per_s"] == pytest.approx([3.14159, 0.0, 0.0], abs=1e-4)
    (turned,) = answer(*FILM, "--spin", "1.5", "--spin-axis", "0,2,0", "--method", "inlet")["results"]
    assert turned["spin_rad_per_s"] == pytest.approx([0.0, 1.5, 0.0])
    (about_load,) = answer(*FILM, "--spin-axis", "0,0,1")["results"]
    assert (about_load["central_nm"], about_load["valid"]) == (0.0, False)


@pytest.mark.long
def test_a_tilted_load_turns_the_ball_across_it_and_a_film_is_drawn(tmp_path):
    (tilted,) = answer(*FILM, "--tilt", "30 deg")["results"]
    (axial,) = answer(*FILM, "--model", "exact", "--figure", str(tmp_path / "film.svg"))["results"]
    assert tilted["model"] == "sphere"
    assert tilted["central_nm"] == pytest.approx(axial["central_nm"], rel=0.05)
    assert "film thickness" in (tmp_path / "film.svg").read_text("utf-8")
