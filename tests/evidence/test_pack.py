"""Questions, packs of evidence, their comparison, and their assessment."""

import copy
import json
import math
import shutil
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.core.storage.pieces import Plan
from ballsocket.evidence import matrix
from ballsocket.evidence import pack as pack_module
from ballsocket.evidence.code_checks import CHECKS
from ballsocket.evidence.comparison import compare, contradictions
from ballsocket.evidence.credibility import FACTORS, assess, gaps, model_risk
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, SUMS, source_files
from ballsocket.evidence.pack import gather_evidence, list_inputs
from ballsocket.evidence.question import Recentred, read_question
from ballsocket.evidence.worst_case import propagate_tolerances, wear_history, wear_rates

from ..places import EXAMPLES, ROOT

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.reports.evidence_page import evidence_page

from .small_pack import QUESTION_TEXT, page


@pytest.fixture
def asked(tmp_path):
    path = tmp_path / "asked.toml"
    path.write_text(QUESTION_TEXT, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('accuracy = "5 %"', "", "required.accuracy is missing: largest relative error of the numbers"),
        ('accuracy = "5 %"', 'accuracy = "0 %"', "accuracy = 0 is not allowed: above 0, at most 100 %"),
        ('accuracy = "5 %"', 'accuracy = "soon"', "accuracy = 'soon' is not a number"),
        ('question = "May it be?"', "", "question is missing: decision that the evidence is for"),
        ('influence = "low"', 'influence = "lo"', "influence = 'lo' is not known.*low"),
        ('influence = "low"', "", "risk.influence is missing: influence of the model on the decision"),
        ("max_pressure <=", "max_presure <=", "did you mean 'max_pressure'"),
        ('force = ["2 kN", "4 kN"]', "", r"\[matrix\] needs a load: force"),
        ('force = ["2 kN", "4 kN"]', "force = []", r"\[matrix\] force is an empty list"),
        ('force = ["2 kN", "4 kN"]', 'force = ["2 mm"]', r"force\[0\] = '2 mm' is not"),
        ('clearance = ["0.05 mm", "0.15 mm"]', 'clearance = ["-1 mm"]', r"clearance\[0\] = -1 is not allowed"),
        ("[matrix]", "[matrixx]", "'matrixx' at the top is not known.*'matrix'"),
        ("coefficient = 0.06", "coefficient = -1", "a coefficient of friction is 0 to 2"),
        ('joint = "hip-36"', 'joint = "hip-63"', "neither a file nor a preset.*hip-36"),
        ("[friction]", '[wear]\nfile = "no.toml"\n[friction]', r"\[wear\] file = 'no.toml' is not there"),
        ("[friction]", '[wear]\nfile = "asked.toml"\n[friction]', "'question' at the top is not known"),
        ('question = "May it be?"', 'question = " "', "question is empty: decision that the evidence is for"),
        ('force = ["2 kN", "4 kN"]', 'force = ["2 kN", "2000 N"]', r"\[matrix\] force has '2000 N' twice"),
        ("[friction]", 'tilt = "10 +- 5 deg"\n[friction]', r"tilt in \[tolerances\] cannot scatter"),
        (
            "[friction]",
            'clearance = "0.1 +- 0.5 mm"\n[friction]',
            r"\[tolerances\] reaches too far: clearance\[0\] = -0",
        ),
    ],
)
def test_invalid_questions_are_refused_with_the_reason(asked, old, new, message):
    asked.write_text(QUESTION_TEXT.replace(old, new), encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_question(asked)


def test_numbers_of_a_case_are_those_of_a_single_press(pack):
    _, record, _ = pack
    assert len(record["matrix"]) == 4
    for row in record["matrix"]:
        joint = bs.joints["hip-36"].replace(clearance=row["case"]["clearance"])
        contact = bs.Exact().press(joint, force=row["case"]["force"])
        assert row["numbers"]["max_pressure"] == pytest.approx(contact.max_pressure, rel=1e-9)
        assert row["numbers"]["friction_torque"] == pytest.approx(contact.friction_torque(0.06), rel=1e-9)
        assert row["valid"]
    assert record["worst"]["max_pressure"]["case"] == {"clearance": 0.15, "force": 4000.0}
    assert matrix.Row.of(record["matrix"][0]).summary() == record["matrix"][0]


def test_limits_are_checked_over_all_cases(pack):
    _, record, _ = pack
    pressure, edge = record["limits"]
    beyond = [row for row in record["matrix"] if row["numbers"]["max_pressure"] > 15]
    assert pressure["beyond"] == len(beyond) > 0
    assert pressure["verdict"] == "not kept"
    assert edge["verdict"].startswith("kept")


def test_independent_methods_agree_at_the_worst_cases(pack):
    _, record, _ = pack
    for piece in record["calculation"]:
        names = [method["name"] for method in piece["methods"]]
        assert {"exact", "tabulated", "sphere (along the axis)"} <= set(names)
        assert piece["deviation"]["max_pressure"] < 0.005
    assert record["accurate"]["holds"]


def test_tolerances_are_propagated_to_a_band(pack):
    _, record, _ = pack
    band = record["uncertainty"]["bands"]["max_pressure"]
    assert band["low"] < record["worst"]["max_pressure"]["numbers"]["max_pressure"] < band["high"]
    assert record["uncertainty"]["sobol"]["max_pressure"]["liner_young"] == pytest.approx(1.0, abs=0.05)


def test_every_factor_states_its_support_and_the_missing_evidence(pack):
    _, record, _ = pack
    assert len(record["credibility"]) == 13
    assert all(factor["supported_by"] and factor["missing"] for factor in record["credibility"])


def test_stored_results_are_reused_and_damaged_ones_computed_again(pack):
    question, record, folder = pack
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


def test_inputs_of_layers_have_the_source_of_their_material(asked):
    asked.write_text(QUESTION_TEXT.replace("hip-36", "metal.toml"), encoding="utf-8")
    file = EXAMPLES / "metal_backed_hip.toml"
    (asked.parent / "metal.toml").write_bytes(file.read_bytes())
    question = read_question(asked)
    sources = {row["name"]: row["source"] for row in list_inputs(question)}
    assert sources["backing[0].young"] == question.file.joint.backing[0].material.source != ""


def test_comparison_names_every_change_of_a_pack(pack, tmp_path):
    """The whole pack is computed again; matching checksums do not hide a change."""
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    record = json.loads((out / RECORD).read_text("utf-8"))
    record["matrix"][1]["numbers"]["max_pressure"] *= 0.9
    record["matrix"][0]["valid"] = 1
    record["limits"][0]["verdict"] = "kept"
    record["approved"] = "by nobody"
    (out / RECORD).write_text(json.dumps(record), encoding="utf-8")
    lines = (out / SUMS).read_text("utf-8").splitlines()
    (out / SUMS).write_text("\n".join(line for line in lines if PAGE not in line), encoding="utf-8")
    result = compare(out, page)
    assert result.count > 200
    assert (
        sorted(difference.where for difference in result.differences)
        == sorted(
            [
                RECORD,  # another sum
                RECORD,  # another form
                PAGE,  # not listed
                PAGE,  # as the record was
                "matrix[1].numbers.max_pressure",
                "matrix[0].valid",
                "limits[0].verdict",
                "approved",
                "requirements[0].evidence",
                "requirements[0].status",
                "requirements[0].gap",
                "matrix",
            ][:-1]
        )
    )
    assert result.made_by == record["version"]


def test_contradictions_within_a_pack_are_reported(pack):
    out = pack[2] / "out"
    record = json.loads((out / RECORD).read_text("utf-8"))
    files = {name: (out / name).read_bytes() for name in (QUESTION, RECORD, PAGE)}
    assert list(contradictions(record, files, page)) == []
    record["credibility"][0]["missing"] = "nothing at all"
    record["adequacy"]["met"] = 13
    assert [difference.where for difference in contradictions(record, {RECORD: files[RECORD]}, page)] == [
        RECORD,
        "credibility[0].missing",
        "adequacy.met",
    ]


def test_checksums_that_are_not_text_are_refused(pack, tmp_path):
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    (out / SUMS).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"holds no pack of evidence: checksums.txt is not text"):
        compare(out, page)


def test_wear_rates_are_in_the_matrix_and_the_largest_is_simulated_to_the_end(asked):
    """A larger head slides farther under the same load and so wears more."""
    hip = "[joint]\nhead_diameter = 28\nclearance = 0.1\nliner_thickness = 8\n[liner]\nyoung = 1000\npoisson = 0.4\n"
    hip = "cycles = 1e5\n" + hip + "[cup]\ntilt = 30\n[cycle]\nname = 'iso-14242-1'\ninstants = 16\n"
    hip += "[wear]\nlaw = 'archard'\ncoefficient = '1e-6 mm^3/(N m)'\nring_width = 8\n"
    hip += "[uncertainty]\ncoefficient = {median = '1e-6 mm^3/(N m)', factor = 1.5}\ncount = 4\n"
    (asked.parent / "hip.toml").write_text(hip, encoding="utf-8")
    text = QUESTION_TEXT.replace('clearance = ["0.05 mm", "0.15 mm"]', 'head_diameter = ["32 mm", "36 mm"]')
    asked.write_text(text + '\n[wear]\nfile = "hip.toml"\n', encoding="utf-8")
    question = read_question(asked)
    cases = matrix.list_cases(question)
    rates = wear_rates(question, cases)
    assert rates[0] == rates[1] < rates[2] == rates[3]
    rows = [row.with_wear(rate) for row, rate in zip(matrix.compute_rows(question, cases), rates, strict=True)]
    assert matrix.Row.of(rows[0].summary()).numbers["wear_rate"] == pytest.approx(rates[0])
    worst = matrix.worst_rows(rows)["wear_rate"]
    assert worst.case["head_diameter"] == 36.0
    result = wear_history(question, worst.case)
    assert result["history"][-1]["volume"] == pytest.approx(0.1 * rates[2], rel=0.05)
    band = result["bands"][-1]["volume"]
    assert band["low"] < result["history"][-1]["volume"] < band["high"]


def test_a_folder_without_a_pack_is_refused(tmp_path):
    with pytest.raises(ValueError, match="holds no pack of evidence"):
        compare(tmp_path, page)
    (tmp_path / "checksums.txt").write_text("0  ../../etc/passwd\n", encoding="utf-8")
    with pytest.raises(ValueError, match="question.toml is missing"):
        compare(tmp_path, page)
    (tmp_path / QUESTION).touch()
    with pytest.raises(ValueError, match="which is not a file of the pack"):
        compare(tmp_path, page)


def test_page_has_no_links_and_escapes_the_question(pack, asked):
    _, record, folder = pack
    page = (folder / "out" / "evidence.html").read_text("utf-8")
    assert "http" not in page.replace("http-equiv", "")
    assert (folder / "out" / QUESTION).read_text("utf-8") == QUESTION_TEXT
    assert "<script>" not in evidence_page({**record, "question": "<script>alert(1)</script>"})


def test_a_note_of_several_methods_is_shown_once_with_their_names(pack):
    _, record, folder = pack
    page = (folder / "out" / "evidence.html").read_text("utf-8")
    shared = [
        (note, [method["name"] for method in piece["methods"] if note in method["notes"]])
        for piece in record["calculation"]
        for note in piece["methods"][0]["notes"]
    ]
    assert any(len(names) > 1 for _, names in shared)
    for note, names in shared:
        assert f"<li>{', '.join(names)}: {note}</li>" in page


ALLOWED = {
    "closed-forms": (0.0, 1e-13),
    "balance": (0.0, 1e-6),
    "slope-of-energy": (0.0, 1e-5),
    "hertz-limit": (0.0, 5e-3),
    "own-tolerance": (0.0, 1.0),
    "along-the-axis": (0.0, 2e-3),
    "patch-test": (0.0, 1e-4),
    "order-of-elements": (3.8, None),
}


@pytest.mark.parametrize("name", CHECKS)
def test_code_checks_pass_or_state_why_they_did_not_run(name):
    result = CHECKS[name]()
    assert result.name == name
    if result.observed is not None:
        assert (result.low, result.summary()["high"]) == ALLOWED[name]
    assert result.summary()["call"] == f"ballsocket.evidence.code_checks.CHECKS[{name!r}]()"
    if name in ("patch-test", "order-of-elements") and find_spec("skfem") is None:
        assert result.passed is None
        assert "is not installed" in result.why
    else:
        assert result.passed is True


@pytest.mark.parametrize(("text", "accuracy"), [('"5 %"', 0.05), ('"100 %"', 1.0), ("0.2", 0.2), ('"1.5e-1"', 0.15)])
def test_accuracy_is_a_share_or_a_percentage(asked, text, accuracy):
    asked.write_text(QUESTION_TEXT.replace('"5 %"', text), encoding="utf-8")
    assert read_question(asked).accuracy == pytest.approx(accuracy, rel=1e-12)


@pytest.mark.parametrize("text", ['"101 %"', '"0 %"', "1.001", "-0.1"])
def test_accuracy_is_above_0_and_at_most_100_percent(asked, text):
    asked.write_text(QUESTION_TEXT.replace('"5 %"', text), encoding="utf-8")
    with pytest.raises(ValueError, match="above 0, at most 100 %"):
        read_question(asked)


@pytest.mark.parametrize(("coefficient", "allowed"), [("0", True), ("2", True), ("2.01", False), ("-0.01", False)])
def test_friction_is_0_to_2(asked, coefficient, allowed):
    asked.write_text(QUESTION_TEXT.replace("coefficient = 0.06", f"coefficient = {coefficient}"), encoding="utf-8")
    if allowed:
        assert read_question(asked).friction == float(coefficient)
    else:
        with pytest.raises(ValueError, match="a coefficient of friction is 0 to 2"):
            read_question(asked)


def test_a_matrix_has_at_most_2000_cases(asked):
    for count, allowed in ((1000, True), (1001, False)):
        forces = str([1000 + number for number in range(count)])
        asked.write_text(QUESTION_TEXT.replace('["2 kN", "4 kN"]', forces), encoding="utf-8")
        if allowed:
            assert len(matrix.list_cases(read_question(asked))) == 2000
        else:
            with pytest.raises(ValueError, match="cases of the matrix = 2002"):
                read_question(asked)


def test_the_example_question_is_valid():
    question = read_question(ROOT / "examples" / "evidence.toml")
    assert question.model.name == "exact"
    assert len(matrix.list_cases(question)) == 8


def test_a_matrix_of_cup_angles_uses_the_off_axis_solver(asked, tmp_path):
    turned = QUESTION_TEXT.replace('clearance = ["0.05 mm", "0.15 mm"]', 'inclination = ["40 deg", "60 deg"]')
    asked.write_text(turned.replace("[tolerances]", "[cup]\narc_of_cover = 160\n[tolerances]"), encoding="utf-8")
    with pytest.raises(ValueError, match="belongs to a table"):
        read_question(asked)
    asked.write_text(turned.replace('force = ["2 kN", "4 kN"]', 'force = ["4 kN"]'), encoding="utf-8")
    question = read_question(asked)
    assert question.model.name == "sphere"
    steep, flat = (matrix.compute_rows(question, [case])[0] for case in reversed(matrix.list_cases(question)))
    assert steep.numbers["edge_distance"] < flat.numbers["edge_distance"]
    assert matrix.worst_rows([steep, flat])["edge_distance"] is steep


@pytest.mark.parametrize(
    ("tolerance", "used"),
    [
        ('liner_young = "700 +- 100 MPa"', 700.0),  # the preset has 1000 MPa, outside
        ('liner_young = "900 +- 150 MPa"', 900.0),  # inside, but not where the tolerance says
        ('liner_young = "600 .. 800 MPa"', 700.0),  # a range states no nominal value: the middle
        ('liner_young = "900 .. 1200 MPa"', 1000.0),  # which the joint's value may have
        ('liner_young = "1005 +- 100 MPa"', 1005.0),  # also for a small difference
        ('liner_young = "1000 +- 100 MPa"', 1000.0),
    ],
)
def test_nominal_values_are_those_of_the_tolerances(asked, tolerance, used):
    text = QUESTION_TEXT.replace("hip-36", "hip-28").replace('liner_young = "750 +- 75 MPa"', tolerance)
    asked.write_text(text, encoding="utf-8")
    question = read_question(asked)
    assert question.file.joint.liner.young == used
    assert [(entry.name, entry.stated, entry.used) for entry in question.recentred] == (
        [] if used == 1000.0 else [("liner_young", 1000.0, used)]
    )
    row = next(row for row in list_inputs(question) if row["name"] == "liner_young")
    assert row["value"] == used
    assert (row["source"] == "nominal value of its tolerance in the question") == (used != 1000.0)


def test_recentred_inputs_are_written_in_the_units_of_files():
    summary = Recentred("half_angle", math.radians(30.0), math.radians(40.0)).summary()
    assert summary == {"name": "half_angle", "stated": pytest.approx(30.0), "used": pytest.approx(40.0)}


@pytest.mark.parametrize(("required", "holds"), [(0.05, True), (1e-6, False)])
def test_accuracy_compares_errors_and_deviations_with_the_required_accuracy(pack, required, holds):
    record = copy.deepcopy(pack[1])
    record["required"]["accuracy"] = required
    result = pack_module._accuracy(record)
    deviations = [value for piece in record["calculation"] for value in piece["deviation"].values()]
    assert result == {"largest": max(deviations), "required": required, "holds": holds}
    record["matrix"][0]["errors"]["max_pressure"] = 0.04
    assert pack_module._accuracy(record)["largest"] == 0.04


def test_the_band_of_a_tolerance_includes_the_worst_case(asked):
    """The joint of the preset has 1000 MPa, whose pressure lies above the band."""
    text = QUESTION_TEXT.replace("hip-36", "hip-28").replace("750 +- 75 MPa", "700 +- 100 MPa")
    asked.write_text(text, encoding="utf-8")
    question = read_question(asked)
    worst = matrix.worst_rows(matrix.compute_rows(question, matrix.list_cases(question)))["max_pressure"]
    band = propagate_tolerances(question, worst.case)["bands"]["max_pressure"]
    assert band["low"] < worst.numbers["max_pressure"] < band["high"]
    assert band["median"] == pytest.approx(worst.numbers["max_pressure"], rel=1e-3)


def test_a_tolerance_of_a_diameter_is_halved_for_the_radius(asked):
    asked.write_text(
        QUESTION_TEXT.replace('liner_young = "750', 'head_diameter = "36.4 +- 0.2 mm"\nliner_young = "750')
    )
    question = read_question(asked)
    assert question.file.joint.ball_radius == pytest.approx(18.2)
    row = next(row for row in list_inputs(question) if row["name"] == "ball_radius")
    assert (row["value"], row["tolerance"]) == (pytest.approx(18.2), "18.1 to 18.3")


def test_a_case_outside_its_tolerance_is_noted(asked):
    asked.write_text(QUESTION_TEXT.replace('liner_young = "750', 'clearance = "0.1 +- 0.02 mm"\nliner_young = "750'))
    question = read_question(asked)
    result = propagate_tolerances(question, {"clearance": 0.15, "force": 4000.0})
    assert result["notes"] == [
        "radial clearance 0.15 mm of the worst case lies outside its tolerance of 0.08 to 0.12 mm: the bands "
        "cover the tolerance and do not include the worst case"
    ]
    assert propagate_tolerances(question, {"clearance": 0.11, "force": 4000.0})["notes"] == []


def test_invisible_characters_are_refused(asked):
    asked.write_text(QUESTION_TEXT.replace("May it be?", "May \u202eti be?"), encoding="utf-8")
    with pytest.raises(ValueError, match=r"asked.toml has the invisible character U\+202E in line 2"):
        read_question(asked)


def test_named_files_in_the_folder_of_stored_results_are_refused(asked):
    (asked.parent / "data").mkdir()
    (asked.parent / "data" / "joint.toml").write_bytes((EXAMPLES / "hip.toml").read_bytes())
    asked.write_text(QUESTION_TEXT.replace("hip-36", "data/joint.toml"), encoding="utf-8")
    with pytest.raises(ValueError, match="'data/joint.toml' is reserved for a file of the pack"):
        source_files(read_question(asked))


# risk and credibility


def assess_risk(record, influence, consequence="medium"):
    return assess({**record, "risk": model_risk(influence, consequence)})


def test_a_higher_risk_sets_higher_goals(pack):
    record = pack[1]
    low, medium, high = (assess_risk(record, influence) for influence in ("low", "medium", "high"))
    goals = [[factor["goal"] for factor in result["credibility"]] for result in (low, medium, high)]
    assert goals[0] < goals[1] < goals[2]
    assert low["adequacy"]["met"] > medium["adequacy"]["met"] > high["adequacy"]["met"]
    reached = [[factor["reached"] for factor in result["credibility"]] for result in (low, medium, high)]
    assert reached[0] == reached[1] == reached[2]
    assert model_risk("high", "low")["rank"] == model_risk("low", "high")["rank"] == 3
    assert (model_risk("low", "low")["level"], model_risk("high", "high")["level"]) == ("low", "high")


def test_goals_rise_with_the_risk_and_exist_in_their_gradation():
    assert len(FACTORS) == 13
    for factor in FACTORS:
        assert list(factor.goals) == sorted(factor.goals)
        assert len(factor.goals) == 5
        assert ord(factor.goals[-1]) - ord("a") < len(factor.gradation)


def level(record, factor):
    result = {row["factor"]: row for row in assess(record)["credibility"]}[factor]
    return result["reached"], result["missing"]


def test_discretization_level_follows_from_the_error_bars(pack):
    record = copy.deepcopy(pack[1])
    record["limits"] = record["limits"][:1]  # of the largest pressure, which has an error bar
    assert level(record, "discretization error") == ("d", "nothing")
    near = copy.deepcopy(record)
    near["matrix"][0]["errors"]["max_pressure"] = 0.04
    near["limits"][0]["high"] = near["matrix"][0]["numbers"]["max_pressure"] * 1.01
    assert level(near, "discretization error")[0] == "c"
    assert "a verdict could change" in level(near, "discretization error")[1]
    far = copy.deepcopy(near)
    far["matrix"][0]["errors"]["max_pressure"] = 0.4
    assert level(far, "discretization error")[0] == "b"
    for row in far["matrix"]:
        row["errors"] = {}
    assert level(far, "discretization error")[0] == "a"
    assert level(pack[1], "discretization error") == (
        "b",
        "an error bar for the edge distance, or a margin to the limit",
    )


def test_failed_checks_and_missing_evidence_lower_the_levels(pack):
    record = copy.deepcopy(pack[1])
    record["code_verification"][0]["passed"] = False
    assert level(record, "numerical code verification")[0] == level(record, "software quality assurance")[0] == "a"
    record["calculation"][0]["deviation"]["max_pressure"] = 0.3
    assert level(record, "numerical solver error")[0] == "b"
    record["matrix"][0]["numbers"]["utilisation"] = 1.2
    assert level(record, "model form")[0] == "b"
    assert "exceeds the yield stress" in level(record, "model form")[1]
    record["uncertainty"] = None
    assert level(record, "model inputs")[0] == "a"
    for comparator in (*record["claims"], *record["comparators"]):
        comparator["applicability"]["verdict"] = "does not apply"
    for name in ("test conditions", "equivalency of input parameters", "output comparison"):
        assert level(record, name)[0] == "a", name


def test_every_requirement_is_a_row_with_a_gap_unless_it_is_met(pack):
    record = pack[1]
    rows = {row["id"]: row for row in record["requirements"]}
    assert len(rows) == len(record["requirements"])
    assert (rows["L1"]["status"], rows["L2"]["status"]) == ("not met", "met")
    assert rows["E2"]["gap"] == "an error bar of the edge distance"
    assert rows["U1"]["status"] == "not met"  # the band reaches beyond 15 MPa
    assert rows["U2"]["status"] == "not known"
    assert sum(name.startswith("F") for name in rows) == 13
    assert {row["gap"] == "" for row in rows.values() if row["status"] == "met"} == {True}
    assert all(row["gap"] for row in rows.values() if row["status"] != "met")
    without = [row for row in rows.values() if row["id"].startswith("I") and row["status"] == "not met"]
    assert [row["requirement"] for row in without] == ["source of the coefficient of friction"]
    assert {row["id"] for row in gaps(record)} == {name for name, row in rows.items() if row["status"] != "met"}


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("calculation.beside", "worst_case.compare_methods"),
        ("scatter.scattered", "worst_case.propagate_tolerances"),
        ("wear.worn", "worst_case.wear_history"),
        ("matrix.rows", "matrix.compute_rows"),
        ("matrix.cases", "matrix.list_cases"),
        ("pack.gathered", "pack.gather_evidence"),
        ("requirements.assessed", "requirements.assess"),
        ("comparison.signature_of", "folder.signature_of"),
        ("comparator.reach_of", "applicability.similarity_ranges"),
        ("code_checks.Checked", "code_checks.CheckResult"),
    ],
)
def test_calls_in_packs_of_version_1_0_still_work(old, new):
    def resolve(path):
        module, _, name = path.partition(".")
        return getattr(import_module(f"ballsocket.evidence.{module}"), name)

    with pytest.warns(DeprecationWarning, match=new.rpartition(".")[2]):
        assert resolve(old) is resolve(new)
