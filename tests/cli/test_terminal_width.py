"""Tables in narrow terminals: no line is too long, no number is cut, and no column is lost in silence."""

import re

import pytest

from ballsocket.cli.root import load_commands
from ballsocket.core.quantities import CONTACT

from ..extent import some
from ..places import EXAMPLES
from .command import run

LOAD = ("--force", "3 kN")
STUDY = f"""
joint = "{(EXAMPLES / "hip.toml").as_posix()}"
model = "tabulated"
[axes]
ball_radius = {{ from = "11 mm", to = "20 mm", count = 2 }}
liner = ["uhmwpe", "crosslinked-pe"]
force = "3 kN"
"""
TABLES = {
    "press": ("hip-28", *LOAD, "--all"),
    "curve": ("hip-28", *LOAD, "--points", "3"),
    "film": ("hip-36", *LOAD, "--model", "hess-forsbach", "--model", "exact"),
    "orient": (f"{EXAMPLES / 'tilted_hip.toml'}", "--points", "3", "--ring-width", "6"),
    "map": ("hip-36", *LOAD, "--points", "3", "--model", "hess-forsbach", "--limit", "max_pressure<=20 MPa"),
    "optimise": (
        *("hip-36", *LOAD, "--vary", "clearance=50..200 um", "--points", "3", "--model", "hess-forsbach"),
        *("--minimise", "max_pressure", "--minimise", "indentation"),
    ),
    "sensitivity": ("hip-36", *LOAD, "--spread", "clearance=0.1+-0.05 mm", "--count", "16", "--model", "hess-forsbach"),
    "study": ("study.toml",),
    "hip": (f"{EXAMPLES / 'hip_in_use.toml'}",),
    "planning": (
        *("--landmarks", f"{EXAMPLES / 'planning' / 'pelvis.mrk.json'}", "--vertical", "0,0,1"),
        *("--liner", f"{EXAMPLES / 'planning' / 'liner.stl'}", "--head", f"{EXAMPLES / 'planning' / 'head.stl'}"),
    ),
    "models": (),
    "presets": (),
    "identify": (f"{EXAMPLES / 'measured_areas.toml'}",),
    "calibrate": (),
}
"""Commands that print a table, with arguments that take little time."""

SLOW = {"hip", "calibrate"}

WITHOUT_TABLE = {
    *("app", "serve-mcp"),  # servers
    *("cite", "schema", "build-tables"),  # BibTeX, JSON
    *("deck", "fmu", "export", "evidence", "reproduce"),  # names of files
}


@pytest.fixture
def folder(tmp_path):
    """Folder with the file of the study."""
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def test_every_command_is_measured_or_has_no_table():
    assert {*TABLES, *WITHOUT_TABLE} == {*load_commands()}


@pytest.mark.parametrize(
    "command", [pytest.param(name, marks=pytest.mark.long if name in SLOW else ()) for name in TABLES]
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
        text = run("press", "hip-36", *LOAD, columns=columns).stdout
        heads = next(line.split() for line in text.splitlines() if line.startswith("model "))
        omitted = " ".join(text.split()).partition("not shown, the terminal is too narrow: ")[2]
        assert all((symbol in heads) != (f"{symbol} " in omitted) for symbol in symbols)
        assert (omitted == "") == (columns == 80)


def test_heads_keep_their_units_in_brackets():
    assert "F [N]  d [mm] ε [°] pmax [MPa] A [mm²] dF/dd [N/mm] valid\n" in run("curve", *TABLES["curve"]).stdout
