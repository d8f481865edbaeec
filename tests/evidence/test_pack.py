"""Questions, packs of evidence, and their comparison."""

import json
import math
import re
import shutil
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import pytest

from ballsocket.core.storage.pieces import Plan
from ballsocket.core.unit_systems import Units
from ballsocket.evidence import matrix
from ballsocket.evidence import pack as pack_module
from ballsocket.evidence.code_checks import CHECKS
from ballsocket.evidence.comparison import compare
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, source_files
from ballsocket.evidence.pack import gather_evidence, list_inputs
from ballsocket.evidence.question import Recentred, read_question
from ballsocket.evidence.worst_case import propagate_tolerances, wear_history, wear_rates

from ..places import EXAMPLES
from ..refusals import text_tables

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.reports.evidence_page import evidence_page

from .small_pack import CLEARANCE, FORCE, QUESTION_TEXT, YOUNG, question_of

(REFUSED,) = text_tables(Path(__file__).parent / "refused.txt")
TILTED = f"'{EXAMPLES / 'tilted_hip.toml'}'"
REFUSED += [
    (FORCE, f"force = {list(range(1000, 2001))}", "cases of the matrix = 2002"),
    ('"hip-36"', TILTED, r"a direction of the load, and \[matrix\] loads the cup upw"),
    ("May it be?", "May \u202eti be?", r"asked.toml has the invisible character U\+202E in line 2"),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSED)
def test_invalid_questions_are_refused_with_the_reason(tmp_path, old, new, message):
    with pytest.raises(ValueError, match=message):
        question_of(tmp_path, (old, new))


def test_accuracies_are_shares_or_percentages_and_the_largest_questions_are_read(tmp_path):
    for text, accuracy in (('"5 %"', 0.05), ('"100 %"', 1.0), ("0.2", 0.2), ('"1.5e-1"', 0.15)):
        assert question_of(tmp_path, ('"5 %"', text)).accuracy == pytest.approx(accuracy, rel=1e-12)
    for coefficient in (0, 2):
        assert question_of(tmp_path, ("= 0.06", f"= {coefficient}")).friction == coefficient
    assert len(matrix.list_cases(question_of(tmp_path, (FORCE, f"force = {list(range(1000, 2000))}")))) == 2000
    question = read_question(EXAMPLES / "evidence.toml")
    assert (question.model.name, len(matrix.list_cases(question))) == ("exact", 8)


def test_limits_deviations_and_tolerances_of_the_small_pack(record):
    pressure, edge = record["limits"]
    beyond = [row for row in record["matrix"] if row["numbers"]["max_pressure"] > 15]
    assert pressure["beyond"] == len(beyond) > 0
    assert (pressure["verdict"], edge["verdict"][:4]) == ("exceeded", "kept")
    assert all(piece["deviation"]["max_pressure"] < 0.005 for piece in record["calculation"])
    assert record["accurate"]["holds"]
    assert record["worst"]["max_pressure"]["case"] == {"clearance": 0.15, "force": 4000.0}
    band = record["uncertainty"]["bands"]["max_pressure"]
    assert band["low"] < record["worst"]["max_pressure"]["numbers"]["max_pressure"] < band["high"]


def test_stored_results_are_reused_and_damaged_ones_computed_again(pack, record):
    question, _, folder = pack
    names = []
    assert gather_evidence(question, folder / "data", names.append) == json.loads(json.dumps(record))
    assert len(names) > 10
    for path in (folder / "data").rglob("matrix_block_0.json"):
        path.write_text("{", encoding="utf-8")  # a piece that was cut off
    assert gather_evidence(question, folder / "data") == json.loads(json.dumps(record))


def test_results_of_an_angle_and_its_negative_are_stored_apart(tmp_path):
    """Their file names are equal, because these have no signs."""
    parts = {"turned": {f"anteversion {angle}": partial(float, angle) for angle in (-0.2, 0.2)}}
    plan = Plan(name="signs", parts=parts)
    assert plan.results(tmp_path) == plan.results(tmp_path) == {"turned": [-0.2, 0.2]}


def test_inputs_have_the_source_of_a_layers_material_and_half_the_tolerance_of_a_diameter(tmp_path):
    (tmp_path / "metal.toml").write_bytes((EXAMPLES / "metal_backed_hip.toml").read_bytes())
    question = question_of(tmp_path, ("hip-36", "metal.toml"))
    sources = {row["name"]: row["source"] for row in list_inputs(question)}
    assert sources["backing[0].young"] == question.file.joint.backing[0].material.source != ""
    question = question_of(tmp_path, (YOUNG, f'head_diameter = "36.4 +- 0.2 mm"\n{YOUNG}'))
    assert question.file.joint.ball_radius == pytest.approx(18.2)
    row = next(row for row in list_inputs(question) if row["name"] == "ball_radius")
    assert (row["value"], row["tolerance"]) == (pytest.approx(18.2), pytest.approx([18.1, 18.3]))


@pytest.mark.long
def test_the_comparison_computes_the_whole_pack_again(pack, tmp_path):
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    assert compare(out).differences == ()
    record = json.loads((out / RECORD).read_text("utf-8"))
    record["matrix"][1]["numbers"]["max_pressure"] *= 0.9
    record["matrix"][0]["valid"] = 1
    (out / RECORD).write_text(json.dumps(record), encoding="utf-8")
    changed = {difference.where for difference in compare(out).differences}
    assert changed == {RECORD, "matrix[1].numbers.max_pressure", "matrix[0].valid"}


def test_wear_rates_are_in_the_matrix_and_the_largest_is_simulated_to_the_end(tmp_path):
    """A larger head slides farther under the same load and so wears more."""
    hip = "[joint]\nhead_diameter = 28\nclearance = 0.1\nliner_thickness = 8\n[liner]\nyoung = 1000\npoisson = 0.4\n"
    hip = "cycles = 1e5\n" + hip + "[cup]\ntilt = 30\n[cycle]\nname = 'iso-14242-1'\ninstants = 12\n"
    hip += "[wear]\nlaw = 'archard'\ncoefficient = '1e-6 mm^3/(N m)'\nring_width = 10\n"
    hip += "[uncertainty]\ncoefficient = {median = '1e-6 mm^3/(N m)', factor = 1.5}\ncount = 4\n"
    (tmp_path / "hip.toml").write_text(hip, encoding="utf-8")
    wear = ("[friction]", '[wear]\nfile = "hip.toml"\n[friction]')
    question = question_of(tmp_path, (CLEARANCE, 'head_diameter = ["32 mm", "36 mm"]'), wear)
    cases = matrix.list_cases(question)
    rates = wear_rates(question, cases)
    assert rates[0] == rates[1] < rates[2] == rates[3]
    rows = [row.with_wear(rate) for row, rate in zip(matrix.compute_rows(question, cases), rates, strict=True)]
    assert matrix.MatrixRow.of(rows[0].summary()).numbers["wear_rate"] == pytest.approx(rates[0])
    worst = matrix.worst_rows(rows)["wear_rate"]
    assert worst.case["head_diameter"] == 36.0
    result = wear_history(question, worst.case)
    assert result["history"][-1]["volume"] == pytest.approx(0.1 * rates[2], rel=0.05)
    band = result["bands"][-1]["volume"]
    assert band["low"] < result["history"][-1]["volume"] < band["high"]


def test_the_page_has_no_links_escapes_the_question_and_shows_a_shared_note_once(pack, record):
    out = pack[2] / "out"
    text = (out / PAGE).read_text("utf-8")
    assert "http" not in text.replace("http-equiv", "")
    assert (out / QUESTION).read_text("utf-8") == QUESTION_TEXT
    undrawn = {"drawn": None, "calculation": [], "uncertainty": None}  # figures take time
    assert "<script>" not in evidence_page({**record, **undrawn, "question": "<script>alert(1)</script>"})
    (piece, *_), shown = record["calculation"], 0
    for note in piece["methods"][0]["notes"]:
        names = [method["name"] for method in piece["methods"] if note in method["notes"]]
        assert f"<li>{', '.join(names)}: {note}</li>" in text
        shown += len(names) > 1
    assert shown


def test_the_page_in_inches_and_pounds_has_the_numbers_of_the_record(record):
    """Comparisons with publications keep the units of these."""
    page = evidence_page({**record, "drawn": None}, units=Units.IMPERIAL)
    sections = dict(re.findall(r"(?s)<h2 id='(\w+)'>(.*?)(?=<h2 id=|$)", page))
    ours = "".join(sections[name] for name in ("risk", "inputs", "matrix", "calculation", "uncertainty", "limits"))
    assert re.findall(r"\d (?:mm|MPa|kN|N|N mm)(?![\w/])", ours) == []
    worst = record["worst"]["max_pressure"]
    row = re.search(r"<td>largest pressure</td>\s*<td>([\d.]+) psi[^<]*</td>\s*<td>(.*?)</td>", page)
    assert float(row[1]) == pytest.approx(worst["numbers"]["max_pressure"] * 145.0377, rel=1e-4)
    assert f"force {worst['case']['force'] / 4.448222:.4f}"[:10] in row[2]


@pytest.mark.parametrize("name", CHECKS)
def test_code_checks_pass_or_state_why_they_did_not_run(name):
    result = CHECKS[name]()
    assert result.name == name
    assert result.summary()["call"] == f"ballsocket.evidence.code_checks.CHECKS[{name!r}]()"
    if name in ("patch-test", "order-of-elements") and find_spec("skfem") is None:
        assert (result.passed, "is not installed" in result.why) == (None, True)
    else:
        assert result.passed is True


def test_a_matrix_of_cup_angles_uses_the_off_axis_solver(tmp_path):
    angles = (CLEARANCE, 'inclination = ["40 deg", "60 deg"]')
    question = question_of(tmp_path, angles, (FORCE, 'force = ["4 kN"]'))
    assert question.model.name == "sphere"
    steep, flat = (matrix.compute_rows(question, [case])[0] for case in reversed(matrix.list_cases(question)))
    assert steep.numbers["edge_distance"] < flat.numbers["edge_distance"]
    assert matrix.worst_rows([steep, flat])["edge_distance"] is steep


@pytest.mark.parametrize(
    ("tolerance", "used"),
    [
        ("700 +- 100 MPa", 700.0),  # the preset has 1000 MPa, outside
        ("900 +- 150 MPa", 900.0),  # inside, but not where the tolerance says
        ("600 .. 800 MPa", 700.0),  # a range states no nominal value: the middle
        ("900 .. 1200 MPa", 1000.0),  # which the joint's value may have
        ("1005 +- 100 MPa", 1005.0),  # also for a small difference
        ("1000 +- 100 MPa", 1000.0),
    ],
)
def test_nominal_values_are_those_of_the_tolerances(tmp_path, tolerance, used):
    question = question_of(tmp_path, ("hip-36", "hip-28"), ("750 +- 75 MPa", tolerance))
    assert question.file.joint.liner.young == used
    recentred = [(entry.name, entry.stated, entry.used) for entry in question.recentred]
    assert recentred == ([] if used == 1000.0 else [("liner_young", 1000.0, used)])
    row = next(row for row in list_inputs(question) if row["name"] == "liner_young")
    assert row["value"] == used
    assert (row["source"] == "nominal value of its tolerance in the question") == (used != 1000.0)
    summary = Recentred("half_angle", math.radians(30.0), math.radians(40.0)).summary()
    assert summary == {"name": "half_angle", "stated": pytest.approx(30.0), "used": pytest.approx(40.0)}


def test_accuracy_compares_errors_and_deviations_with_the_required_accuracy(record):
    bars = [(row["numbers"]["max_pressure"], row["bars"]["max_pressure"]) for row in record["matrix"]]
    largest = max(max(value - low, high - value) / value for value, (low, high) in bars)
    assert largest > max(row["errors"]["von_mises"] for row in record["matrix"])
    assert largest > max(value for piece in record["calculation"] for value in piece["deviation"].values())
    for required, holds in ((0.05, True), (1e-6, False)):
        record["required"]["accuracy"] = required
        assert pack_module._accuracy(record) == {"largest": largest, "required": required, "holds": holds}
    record["matrix"][0]["errors"]["max_pressure"] = 0.04
    assert pack_module._accuracy(record)["largest"] == 0.04
    record["matrix"][0]["bars"]["max_pressure"][1] = None  # without a bound above
    assert pack_module._accuracy(record) == {"largest": None, "required": 1e-6, "holds": False}


@pytest.mark.parametrize("largest", [0.1, pytest.param(0.15, marks=pytest.mark.long)])  # a linear, a circular gap
def test_the_band_of_a_tolerance_includes_the_worst_case(largest, tmp_path):
    """The joint of the preset has 1000 MPa, whose pressure lies above the band."""
    joint = ("hip-36", "hip-28"), (CLEARANCE, f'clearance = ["0.05 mm", "{largest} mm"]')
    question = question_of(tmp_path, *joint, ("750 +- 75 MPa", "700 +- 100 MPa"))
    worst = matrix.worst_rows(matrix.compute_rows(question, matrix.list_cases(question)))["max_pressure"]
    band = propagate_tolerances(question, worst.case)["bands"]["max_pressure"]
    assert band["low"] < worst.numbers["max_pressure"] < band["high"]
    assert band["median"] == pytest.approx(worst.numbers["max_pressure"], rel=1e-3)


def test_named_files_in_the_folder_of_stored_results_are_refused(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "joint.toml").write_bytes((EXAMPLES / "hip.toml").read_bytes())
    with pytest.raises(ValueError, match="'data/joint.toml' is reserved for a file of the pack"):
        source_files(question_of(tmp_path, ("hip-36", "data/joint.toml")))
