"""Systems of units: sentences and tables in inches and pounds, and commands that print them."""

import re
from io import StringIO

import pytest

import ballsocket as bs
from ballsocket.reports.hip_tables import table_with_units
from ballsocket.reports.terminal import Terminal, print_columns
from ballsocket.reports.unit_systems import Units

from ..cli.command import run

METRIC = r"\d (?:mm|µm|MPa|kN|N)\b|\[(?:mm|MPa|µm|N)\]"


@pytest.mark.parametrize(
    ("metric", "imperial"),
    [
        ("25.4 mm from the rim", "1 in from the rim"),
        ("1 to 2 kN, or 4.4482216 N", "224.8 to 449.6 lbf, or 1 lbf"),
        ("E 750 MPa, p 1 MPa", "E 108.8 ksi, p 145 psi"),
        ("25.4 µm, Ra 0.0254 µm, 25.4 nm", "1 mil, Ra 1 µin, 1 µin"),
        ("16387.064 mm³ after 2 million cycles, 1 N m", "1 in³ after 2 million cycles, 8.851 lbf in"),
        ("inf mm of a liner, 645.16 mm²", "inf in of a liner, 1 in²"),
        ("R2/L ≥ 1 at 40°, 3 m, 5 Nm, v1.2 mmx", "R2/L ≥ 1 at 40°, 3 m, 5 Nm, v1.2 mmx"),
    ],
)
def test_numbers_with_units_in_a_sentence_are_converted(metric, imperial):
    assert Units.IMPERIAL.sentence(metric) == imperial
    assert Units.SI.sentence(metric) == metric


def test_the_name_of_a_joint_stays():
    joint = bs.joints["hip-36"].replace(name="36 mm, 3 kN")
    assert Units.IMPERIAL.joint(joint).startswith("36 mm, 3 kN: R1 0.7087 in")


def test_columns_below_a_metric_unit_are_converted():
    table = table_with_units({"cycles": "million", "depth": "mm", "band": "mm³"})
    table.add_row("5", "0.254*", "16.39 to 32.77")
    table.add_column("pmax [MPa]")
    table.columns[-1]._cells = ["", "1"]
    terminal = Terminal(Units.IMPERIAL)
    terminal.file = StringIO()
    print_columns(terminal, table)
    heads, units, row = (re.split(r"  +", line.strip()) for line in terminal.file.getvalue().splitlines()[:3])
    assert heads == ["cycles", "depth", "band", "pmax [psi]"]
    assert units == ["million", "in", "in³"]
    assert row == ["5", "0.01*", "0.001 to 0.002", "145"]


STUDY = """
joint = {ball_radius = "14 mm", clearance = "0.1 mm", liner_thickness = "8 mm"}
liner = {material = "uhmwpe"}
[axes]
clearance = ["0.05 mm", "0.2 mm"]
force = ["4.4482216152605 N", "2 kN"]
"""


def test_a_study_prints_and_draws_in_inches_and_pounds(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    done = run("study", "study.toml", "--units", "imperial", "--figure", "study.svg", folder=tmp_path)
    assert (done.returncode, re.findall(METRIC, done.stdout)) == (0, []), done.stderr
    assert re.search(r"F 1\s", done.stdout)
    refused = run("hip", "hip.toml", "--units", "imperial", "--report", "hip.html", folder=tmp_path)
    assert refused.returncode == 2


@pytest.mark.long
def test_orientations_print_and_draw_in_inches_and_pounds(tmp_path):
    angles = ("--inclination", "40..50", "--anteversion", "10..20", "--step", "10 deg", "--ring-width", "6 deg")
    limit = ("--limit", "max_pressure<=10 MPa", "--figure", "orient.svg")
    done = run("orient", "hip-36", "--force", "2 kN", *angles, *limit, "--units", "imperial", folder=tmp_path)
    assert (done.returncode, re.findall(METRIC, done.stdout)) == (0, []), done.stderr
    assert "limit: max_pressure <= 1450 psi" in done.stdout
    assert (tmp_path / "orient.svg").stat().st_size > 1000
