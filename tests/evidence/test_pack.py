"""Evidence for a question: what is refused, what is gathered, and whether it still says the same."""

import copy
import json
import shutil
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.evidence import matrix
from ballsocket.evidence.code_checks import CHECKS
from ballsocket.evidence.comparison import compare, contradictions
from ballsocket.evidence.credibility import FACTORS, model_risk
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, SUMS, source_files
from ballsocket.evidence.inputs import inputs
from ballsocket.evidence.pack import gathered
from ballsocket.evidence.question import read_question
from ballsocket.evidence.requirements import assessed, gaps
from ballsocket.evidence.scatter import scattered
from ballsocket.evidence.wear import rates, worn
from ballsocket.paper.plan import Plan

from ..places import EXAMPLES, ROOT

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.reports.evidence_page import evidence_page

from .small_pack import QUESTION_TEXT, page

pytestmark = pytest.mark.xdist_group("evidence")  # the pack is gathered once


@pytest.fixture
def asked(tmp_path):
    path = tmp_path / "asked.toml"
    path.write_text(QUESTION_TEXT, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('accuracy = "5 %"', "", r'\[required\] accuracy is missing: how far off the numbers may be, such as "10 %"'),
        ('accuracy = "5 %"', 'accuracy = "0 %"', "accuracy = 0 is not allowed: above 0, at most 100 %"),
        ('accuracy = "5 %"', 'accuracy = "soon"', "accuracy = 'soon' is not a number"),
        ('question = "May it be?"', "", "question is missing: what is to be decided"),
        ('influence = "low"', 'influence = "lo"', "influence = 'lo' is not known.*low"),
        ('influence = "low"', "", r"\[risk\] influence is missing"),
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
        ('question = "May it be?"', 'question = " "', "question is empty: what is to be decided"),
        ('force = ["2 kN", "4 kN"]', 'force = ["2 kN", "2000 N"]', r"\[matrix\] force has '2000 N' twice"),
        ("[friction]", 'tilt = "10 +- 5 deg"\n[friction]', r"tilt in \[tolerances\] cannot scatter"),
        (
            "[friction]",
            'clearance = "0.1 +- 0.5 mm"\n[friction]',
            r"\[tolerances\] reaches too far: clearance\[0\] = -0",
        ),
    ],
)
def test_a_question_that_is_wrong_is_told_how(asked, old, new, message):
    asked.write_text(QUESTION_TEXT.replace(old, new), encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_question(asked)


def test_every_case_is_what_a_press_answers(pack):
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


def test_limits_are_judged_over_all_cases(pack):
    _, record, _ = pack
    pressure, edge = record["limits"]
    beyond = [row for row in record["matrix"] if row["numbers"]["max_pressure"] > 15]
    assert pressure["beyond"] == len(beyond) > 0
    assert pressure["verdict"] == "not kept"
    assert edge["verdict"].startswith("kept")


def test_methods_that_share_nothing_agree_at_the_worst_cases(pack):
    _, record, _ = pack
    for piece in record["calculation"]:
        names = [method["name"] for method in piece["methods"]]
        assert {"exact", "tabulated", "sphere (along the axis)"} <= set(names)
        assert piece["deviation"]["max_pressure"] < 0.005
    assert record["accurate"]["holds"]


def test_a_tolerance_becomes_a_band(pack):
    _, record, _ = pack
    band = record["uncertainty"]["bands"]["max_pressure"]
    assert band["low"] < record["worst"]["max_pressure"]["numbers"]["max_pressure"] < band["high"]
    assert record["uncertainty"]["sobol"]["max_pressure"]["liner_young"] == pytest.approx(1.0, abs=0.05)


def test_every_factor_says_what_supports_it_and_what_is_missing(pack):
    _, record, _ = pack
    assert len(record["credibility"]) == 13
    assert all(each["supported_by"] and each["missing"] for each in record["credibility"])


def test_what_is_kept_is_not_computed_anew(pack):
    question, record, folder = pack
    told = []
    assert gathered(question, folder / "data", told.append) == json.loads(json.dumps(record))
    assert len(told) > 10
    for path in (folder / "data").rglob("matrix_block_0.json"):
        path.write_text("{", encoding="utf-8")  # a piece that was cut off
    assert gathered(question, folder / "data") == json.loads(json.dumps(record))


def test_an_angle_and_its_opposite_are_not_taken_for_each_other(tmp_path):
    """Their files' names are alike, since these have no signs."""
    parts = {"turned": {f"anteversion {angle}": partial(float, angle) for angle in (-0.2, 0.2)}}
    plan = Plan(name="signs", parts=parts)
    assert plan.results(tmp_path) == plan.results(tmp_path) == {"turned": [-0.2, 0.2]}


def test_layers_have_the_sources_of_their_materials(asked):
    asked.write_text(QUESTION_TEXT.replace("hip-36", "metal.toml"), encoding="utf-8")
    file = EXAMPLES / "metal_backed_hip.toml"
    (asked.parent / "metal.toml").write_bytes(file.read_bytes())
    question = read_question(asked)
    found = {each["name"]: each["source"] for each in inputs(question)}
    assert found["backing[0].young"] == question.file.joint.backing[0].material.source != ""


def test_a_pack_is_computed_again_and_what_was_changed_is_named(pack, tmp_path):
    """Also by somebody who wrote new sums for what was changed."""
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    record = json.loads((out / RECORD).read_text("utf-8"))
    record["matrix"][1]["numbers"]["max_pressure"] *= 0.9
    record["matrix"][0]["valid"] = 1
    record["limits"][0]["verdict"] = "kept"
    record["approved"] = "by nobody"
    (out / RECORD).write_text(json.dumps(record), encoding="utf-8")
    lines = (out / SUMS).read_text("utf-8").splitlines()
    (out / SUMS).write_text("\n".join(line for line in lines if PAGE not in line), encoding="utf-8")
    found = compare(out, page)
    assert found.count > 200
    assert (
        sorted(each.where for each in found.differences)
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
    assert found.made_by == record["version"]


def test_a_pack_that_disagrees_with_itself_is_reported(pack):
    out = pack[2] / "out"
    record = json.loads((out / RECORD).read_text("utf-8"))
    files = {name: (out / name).read_bytes() for name in (QUESTION, RECORD, PAGE)}
    assert list(contradictions(record, files, page)) == []
    record["credibility"][0]["missing"] = "nothing at all"
    record["adequacy"]["met"] = 13
    assert [each.where for each in contradictions(record, {RECORD: files[RECORD]}, page)] == [
        RECORD,
        "credibility[0].missing",
        "adequacy.met",
    ]


def test_sums_that_are_no_text_are_told(pack, tmp_path):
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    (out / SUMS).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"holds no pack of evidence: checksums.txt is not text"):
        compare(out, page)


def test_wear_stands_in_the_matrix_and_the_joint_that_wears_most_is_worn_to_the_end(asked):
    """A larger head slides farther under the same load."""
    hip = "[joint]\nhead_diameter = 28\nclearance = 0.1\nliner_thickness = 8\n[liner]\nyoung = 1000\npoisson = 0.4\n"
    hip = "cycles = 1e5\n" + hip + "[cup]\ntilt = 30\n[cycle]\nname = 'iso-14242-1'\ninstants = 16\n"
    hip += "[wear]\nlaw = 'archard'\ncoefficient = '1e-6 mm^3/(N m)'\nring_width = 8\n"
    hip += "[uncertainty]\ncoefficient = {median = '1e-6 mm^3/(N m)', factor = 1.5}\ncount = 4\n"
    (asked.parent / "hip.toml").write_text(hip, encoding="utf-8")
    text = QUESTION_TEXT.replace('clearance = ["0.05 mm", "0.15 mm"]', 'head_diameter = ["32 mm", "36 mm"]')
    asked.write_text(text + '\n[wear]\nfile = "hip.toml"\n', encoding="utf-8")
    question = read_question(asked)
    cases = matrix.cases(question)
    found = rates(question, cases)
    assert found[0] == found[1] < found[2] == found[3]
    rows = [row.with_wear(rate) for row, rate in zip(matrix.rows(question, cases), found, strict=True)]
    assert matrix.Row.of(rows[0].summary()).numbers["wear_rate"] == pytest.approx(found[0])
    worst = matrix.worst(rows)["wear_rate"]
    assert worst.case["head_diameter"] == 36.0
    told = worn(question, worst.case)
    assert told["history"][-1]["volume"] == pytest.approx(0.1 * found[2], rel=0.05)
    band = told["bands"][-1]["volume"]
    assert band["low"] < told["history"][-1]["volume"] < band["high"]


def test_a_folder_without_a_pack_is_told(tmp_path):
    with pytest.raises(ValueError, match="holds no pack of evidence"):
        compare(tmp_path, page)
    (tmp_path / "checksums.txt").write_text("0  ../../etc/passwd\n", encoding="utf-8")
    with pytest.raises(ValueError, match="question.toml is missing"):
        compare(tmp_path, page)
    (tmp_path / QUESTION).touch()
    with pytest.raises(ValueError, match="which is not a file of the pack"):
        compare(tmp_path, page)


def test_the_page_needs_nothing_beside_it_and_takes_words_as_text(pack, asked):
    _, record, folder = pack
    page = (folder / "out" / "evidence.html").read_text("utf-8")
    assert "http" not in page.replace("http-equiv", "")
    assert (folder / "out" / QUESTION).read_text("utf-8") == QUESTION_TEXT
    assert "<script>" not in evidence_page({**record, "question": "<script>alert(1)</script>"})


def test_a_note_of_several_methods_stands_once_after_their_names(pack):
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


@pytest.mark.parametrize("name", CHECKS)
def test_checks_pass_or_say_why_they_were_not_run(name):
    found = CHECKS[name]()
    if name in ("patch-test", "order-of-elements") and find_spec("skfem") is None:
        assert found.passed is None
        assert "is not installed" in found.why
    else:
        assert found.passed is True


def test_the_example_is_a_question():
    question = read_question(ROOT / "examples" / "evidence.toml")
    assert question.model.name == "exact"
    assert len(matrix.cases(question)) == 8


def test_where_the_cup_turns_the_load_is_off_its_axis(asked, tmp_path):
    turned = QUESTION_TEXT.replace('clearance = ["0.05 mm", "0.15 mm"]', 'inclination = ["40 deg", "60 deg"]')
    asked.write_text(turned.replace("[tolerances]", "[cup]\narc_of_cover = 160\n[tolerances]"), encoding="utf-8")
    with pytest.raises(ValueError, match="belongs to a table"):
        read_question(asked)
    asked.write_text(turned.replace('force = ["2 kN", "4 kN"]', 'force = ["4 kN"]'), encoding="utf-8")
    question = read_question(asked)
    assert question.model.name == "sphere"
    steep, flat = (matrix.rows(question, [case])[0] for case in reversed(matrix.cases(question)))
    assert steep.numbers["edge_distance"] < flat.numbers["edge_distance"]
    assert matrix.worst([steep, flat])["edge_distance"] is steep


@pytest.mark.parametrize(
    ("tolerance", "used"),
    [
        ('liner_young = "700 +- 100 MPa"', 700.0),  # the preset has 1000 MPa, outside
        ('liner_young = "900 +- 150 MPa"', 900.0),  # inside, but not where the tolerance says
        ('liner_young = "600 .. 800 MPa"', 700.0),  # a range states no nominal value: the middle
        ('liner_young = "900 .. 1200 MPa"', 1000.0),  # which the joint's value may have
    ],
)
def test_a_tolerance_states_the_nominal_value(asked, tolerance, used):
    text = QUESTION_TEXT.replace("hip-36", "hip-28").replace('liner_young = "750 +- 75 MPa"', tolerance)
    asked.write_text(text, encoding="utf-8")
    question = read_question(asked)
    assert question.file.joint.liner.young == used
    assert [(each.name, each.stated, each.used) for each in question.recentred] == (
        [] if used == 1000.0 else [("liner_young", 1000.0, used)]
    )
    row = next(each for each in inputs(question) if each["name"] == "liner_young")
    assert row["value"] == used
    assert (row["source"] == "nominal value of its tolerance in the question") == (used != 1000.0)


def test_the_worst_case_lies_in_the_band_of_its_tolerance(asked):
    """The joint of the preset has 1000 MPa, whose pressure lies above the band."""
    text = QUESTION_TEXT.replace("hip-36", "hip-28").replace("750 +- 75 MPa", "700 +- 100 MPa")
    asked.write_text(text, encoding="utf-8")
    question = read_question(asked)
    worst = matrix.worst(matrix.rows(question, matrix.cases(question)))["max_pressure"]
    band = scattered(question, worst.case)["bands"]["max_pressure"]
    assert band["low"] < worst.numbers["max_pressure"] < band["high"]
    assert band["median"] == pytest.approx(worst.numbers["max_pressure"], rel=1e-3)


def test_a_tolerance_of_a_diameter_is_that_of_its_radius(asked):
    asked.write_text(
        QUESTION_TEXT.replace('liner_young = "750', 'head_diameter = "36.4 +- 0.2 mm"\nliner_young = "750')
    )
    question = read_question(asked)
    assert question.file.joint.ball_radius == pytest.approx(18.2)
    row = next(each for each in inputs(question) if each["name"] == "ball_radius")
    assert (row["value"], row["tolerance"]) == (pytest.approx(18.2), "18.1 to 18.3")


def test_a_case_outside_its_tolerance_is_noted(asked):
    asked.write_text(QUESTION_TEXT.replace('liner_young = "750', 'clearance = "0.1 +- 0.02 mm"\nliner_young = "750'))
    question = read_question(asked)
    found = scattered(question, {"clearance": 0.15, "force": 4000.0})
    assert found["notes"] == [
        "radial clearance 0.15 mm of the worst case lies outside its tolerance of 0.08 to 0.12 mm: the bands "
        "cover the tolerance and do not include the worst case"
    ]
    assert scattered(question, {"clearance": 0.11, "force": 4000.0})["notes"] == []


def test_invisible_characters_are_refused(asked):
    asked.write_text(QUESTION_TEXT.replace("May it be?", "May \u202eti be?"), encoding="utf-8")
    with pytest.raises(ValueError, match=r"asked.toml has the invisible character U\+202E in line 2"):
        read_question(asked)


def test_a_named_file_cannot_take_the_place_of_the_pieces(asked):
    (asked.parent / "data").mkdir()
    (asked.parent / "data" / "joint.toml").write_bytes((EXAMPLES / "hip.toml").read_bytes())
    asked.write_text(QUESTION_TEXT.replace("hip-36", "data/joint.toml"), encoding="utf-8")
    with pytest.raises(ValueError, match="'data/joint.toml' is reserved for a file of the pack"):
        source_files(read_question(asked))


# risk and credibility


def risky(record, influence, consequence="medium"):
    return assessed({**record, "risk": model_risk(influence, consequence)})


def test_risk_sets_the_goals_and_so_what_is_adequate(pack):
    record = pack[1]
    low, medium, high = (risky(record, influence) for influence in ("low", "medium", "high"))
    goals = [[each["goal"] for each in found["credibility"]] for found in (low, medium, high)]
    assert goals[0] < goals[1] < goals[2]
    assert low["adequacy"]["met"] > medium["adequacy"]["met"] > high["adequacy"]["met"]
    reached = [[each["reached"] for each in found["credibility"]] for found in (low, medium, high)]
    assert reached[0] == reached[1] == reached[2]
    assert model_risk("high", "low")["rank"] == model_risk("low", "high")["rank"] == 3
    assert (model_risk("low", "low")["level"], model_risk("high", "high")["level"]) == ("low", "high")


def test_goals_grow_with_the_risk_and_are_levels_of_their_gradation():
    assert len(FACTORS) == 13
    for factor in FACTORS:
        assert list(factor.goals) == sorted(factor.goals)
        assert len(factor.goals) == 5
        assert ord(factor.goals[-1]) - ord("a") < len(factor.gradation)


def level(record, factor):
    found = {each["factor"]: each for each in assessed(record)["credibility"]}[factor]
    return found["reached"], found["missing"]


def test_levels_follow_from_the_results(pack):
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


def test_failed_checks_lower_the_levels(pack):
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
    for each in (*record["claims"], *record["comparators"]):
        each["applicability"]["verdict"] = "does not apply"
    for name in ("test conditions", "equivalency of input parameters", "output comparison"):
        assert level(record, name)[0] == "a", name


def test_every_requirement_is_a_row_and_gaps_are_rows_too(pack):
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
