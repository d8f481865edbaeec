"""Texts, totals and defaults of commands: positions, errors, progress, identifiers."""

import json
from contextlib import nullcontext
from importlib import import_module
from math import inf
from pathlib import Path
from types import SimpleNamespace

import pytest

import ballsocket as bs
from ballsocket.cli import design, elasticity_options, export, hip, json_answers, reproduce, root, study
from ballsocket.cli.press_files import ReportOptions
from ballsocket.files.joint_file import JointFile

from .command import run


@pytest.mark.parametrize(
    ("distance", "loaded", "clearance", "text"),
    [
        (1.26, False, 0.1, "contact 1.3 mm from the rim"),
        (-2.34, True, 0.1, "contact cut off by 2.3 mm at the rim"),
        (0.2, True, 0.0, "contact cut off by 0.0 mm at the rim"),
        (-9.4, True, -0.03, "contact up to the rim"),
    ],
)
def test_the_distance_from_the_rim_is_positive_on_both_sides(distance, loaded, clearance, text):
    contact = SimpleNamespace(edge_distance=distance, edge_loaded=loaded, joint=SimpleNamespace(clearance=clearance))
    assert elasticity_options._rim_text(contact) == text


def test_estimated_errors_are_in_percent_without_those_of_other_quantities():
    contact = SimpleNamespace(error={"force": 0.0, "indentation": 0.0149, "max_pressure": 3e-4, "area": 0.5})
    assert elasticity_options._error_text(contact) == "d ±1 %, pmax ±0.03 %"


def test_a_timed_model_measures_seconds_of_its_last_press():
    timed = elasticity_options.TimedModel(bs.Hertz())
    contact = timed.press(bs.joints["hip-36"], force=3000.0)
    assert contact.max_pressure == bs.Hertz().press(bs.joints["hip-36"], force=3000.0).max_pressure
    assert 0.0 < timed.seconds < 60.0


@pytest.mark.parametrize(("model", "points"), [(bs.Hertz(), 41), (bs.FiniteElement(), 21)], ids=["fast", "slow"])
def test_a_map_of_a_slow_model_has_fewer_points(model, points):
    assert design._default_points(model) == points


@pytest.mark.parametrize(
    ("vary", "count"), [(["clearance=50..200 um"], 1), (["clearance=50..200 um", "liner=uhmwpe,pom"], 1)]
)
def test_a_figure_of_an_optimum_needs_two_ranges(vary, count, tmp_path):
    options = [option for phrase in vary for option in ("--vary", phrase)]
    done = run("optimise", "hip-36", "--force", "3 kN", *options, "--figure", str(tmp_path / "a.png"))
    assert (done.returncode, done.stderr) == (
        2,
        f"ballsocket: a map has two axes, and {count} numbers vary: no figure\n",
    )


def test_an_optimum_of_two_ranges_is_drawn_as_a_map(tmp_path):
    ranges = ("--vary", "clearance=50..200 um", "--vary", "liner_thickness=4..8 mm", "--points", "3")
    done = run("optimise", "hip-36", "--force=3 kN", "--model=bartel", *ranges, "--figure", str(tmp_path / "a.png"))
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "a.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("stem", "name"),
    [
        ("left-hip", "left_hip"),
        ("a" * 60, "a" * 40),
        ("1" * 60, "joint_" + "1" * 34),
        ("while", "joint_while"),
        ("model", "joint_model"),
    ],
)
def test_an_identifier_has_at_most_40_characters_and_is_no_keyword(stem, name):
    assert export.identifier(Path(f"{stem}.fmu")) == name


def test_a_long_message_shows_its_beginning_and_its_end():
    text = root._one_line("begin " + "x " * 1000 + "end")
    assert text.startswith("begin x x")
    assert text.endswith("x end")
    assert (len(text), text.count(" ... ")) == (300 + 5 + 150, 1)
    assert root._one_line("x" * 600) == "x" * 600


@pytest.mark.parametrize(
    ("left", "text"),
    [(0.0, "3 of 12, 1.5/s"), (inf, "3 of 12, 1.5/s"), (0.01, "3 of 12, 1.5/s, 0:00:01 left")],
)
def test_progress_of_a_study_shows_the_remaining_time_when_it_is_known(left, text):
    assert study._progress_text(SimpleNamespace(n_done=3, n_points=12, rate=1.5, seconds_left=left)) == text


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ({"force": 3}, "this study has force"),
        ({"force": 1, "clearance": 1}, "this study has none"),
        ({"force": 2, "clearance": 2, "liner_thickness": 2}, "this study has force, clearance, liner_thickness"),
    ],
)
def test_a_figure_of_a_study_needs_two_axes(axes, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        study._choose_plot(study_file(axes), tmp_path / "a.png")


def test_a_figure_of_a_study_is_a_map_or_bands_of_samples(tmp_path):
    path = tmp_path / "a.png"
    assert study._choose_plot(study_file({"force": 2, "clearance": 3, "young": 1}), path).__name__ == "design_map"
    assert study._choose_plot(study_file({"sample": 64, "force": 2}), path).__name__ == "band_figure"


def study_file(axes):
    """Return a study file with axes of some lengths."""

    class Axis(SimpleNamespace):
        def __len__(self):
            return self.length

    return SimpleNamespace(design=SimpleNamespace(axes=[Axis(name=name, length=n) for name, n in axes.items()]))


def test_json_is_indented_by_two_spaces(capsys):
    json_answers.echo_json({"version": "1"})
    text = capsys.readouterr().out
    assert text.startswith('{\n  "version": "1",\n  "valid": null,\n')
    assert json.loads(text)["next"] == []


@pytest.mark.parametrize(
    ("load", "studied"), [({"indentation": 0.04}, True), ({"half_angle": 0.7}, True), ({"force": 0.0}, False)]
)
def test_tolerances_are_studied_for_a_load_with_contact(load, studied):
    joint = bs.joints["hip-36"]
    comparison = bs.compare(joint, **load)
    options = ReportOptions(report=Path("press.html"))
    assert (options._tolerance_study(comparison, JointFile(joint, load)) is not None) == studied


def test_uncertainty_of_a_hip_simulates_count_times_parameters_plus_two_patients(monkeypatch):
    """A Saltelli design has n + 2 blocks of samples for n parameters."""
    bars = []
    monkeypatch.setattr(hip, "_progress_bar", lambda *words: bars.append(words) or nullcontext(print))
    module = import_module("ballsocket.hip.uncertainty")
    monkeypatch.setattr(module, "uncertainty", lambda variability, history, **options: options["count"])
    distributions = {"clearance": None, "force": None, "wear": None}
    variability = SimpleNamespace(distributions=distributions, noun="patients")
    scatter = SimpleNamespace(count=16, seed=1, variability=variability)
    assert hip._uncertainty_bands(SimpleNamespace(uncertain=scatter), None, None) == 16
    assert bars == [("other patients", 80, "patients")]


def test_reproduce_advances_once_per_result_and_then_draws(monkeypatch, tmp_path):
    steps = []

    class Plan:
        def __len__(self):
            return 2

        def results(self, folder, listen, engine):
            listen("one")
            listen("two")
            return folder

    class Bar(SimpleNamespace):
        __enter__ = lambda self: self  # noqa: E731
        __exit__ = lambda self, *error: None  # noqa: E731

        def add_task(self, name, total):
            steps.append((name, total))
            return 0

        def update(self, task, advance, description):
            steps.append((description, advance))

    monkeypatch.setattr(reproduce, "Progress", lambda console: Bar())
    monkeypatch.setattr("ballsocket.paper.plan.quick_plan", Plan)
    page = "report.html"
    monkeypatch.setattr("ballsocket.reports.paper_report.write_report", lambda results, out, engine: out / page)
    done = run("reproduce", "--quick", "--out", str(tmp_path))
    assert (done.returncode, done.stdout) == (0, f"{tmp_path}/report.html\n")
    assert steps == [("reproducing", 2), ("one", 1), ("two", 1), ("drawing", 0)]
