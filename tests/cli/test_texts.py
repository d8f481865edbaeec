"""Texts, totals and defaults of commands: positions, errors, progress, identifiers."""

from pathlib import Path
from types import SimpleNamespace

import pytest

import ballsocket as bs
from ballsocket.cli import elasticity_options, export, root
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


@pytest.mark.long
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
    ("load", "studied"), [({"indentation": 0.04}, True), ({"half_angle": 0.7}, True), ({"force": 0.0}, False)]
)
def test_tolerances_are_studied_for_a_load_with_contact(load, studied):
    joint = bs.joints["hip-36"]
    comparison = bs.compare(joint, **load)
    options = ReportOptions(report=Path("press.html"))
    assert (options._tolerance_study(comparison, JointFile(joint, load)) is not None) == studied
