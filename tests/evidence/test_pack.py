"""Evidence for a question: what is refused, what is gathered, and whether it still says the same."""

import json
import shutil
from functools import partial
from importlib.util import find_spec
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.evidence import matrix
from ballsocket.evidence.code_checks import CHECKS
from ballsocket.evidence.folder import PAGE, QUESTION, RECORD, SUMS, contradictions, differences, made_by, write
from ballsocket.evidence.inputs import inputs
from ballsocket.evidence.pack import gathered
from ballsocket.evidence.question import read_question
from ballsocket.evidence.wear import rates, worn
from ballsocket.paper.plan import Plan

from ..places import EXAMPLES, ROOT

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.output.evidence_page import evidence_page

ASKED = """
question = "May it be?"
context_of_use = "A test."
joint = "hip-36"

[risk]
influence = "low"
consequence = "high"

[required]
accuracy = "5 %"
limits = ["max_pressure <= 15 MPa", "edge_distance >= 1 mm"]

[matrix]
clearance = ["0.05 mm", "0.15 mm"]
force = ["2 kN", "4 kN"]

[tolerances]
liner_young = "750 +- 75 MPa"

[friction]
coefficient = 0.06
"""


@pytest.fixture
def asked(tmp_path):
    path = tmp_path / "asked.toml"
    path.write_text(ASKED, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def pack(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pack")
    (folder / "asked.toml").write_text(ASKED, encoding="utf-8")
    question = read_question(folder / "asked.toml")
    record = gathered(question, folder / "data")
    write(question, record, evidence_page(record), folder / "out")
    return question, record, folder


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
    asked.write_text(ASKED.replace(old, new), encoding="utf-8")
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
    asked.write_text(ASKED.replace("hip-36", "metal.toml"), encoding="utf-8")
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
    count, found = differences(out, page=evidence_page)
    assert count > 200
    assert sorted(each.where for each in found) == sorted(
        [
            RECORD,
            PAGE,  # not listed
            PAGE,  # says what the record said
            "matrix[1].numbers.max_pressure",
            "matrix[0].valid",
            "limits[0].verdict",
            "approved",
        ]
    )
    assert made_by(out) == record["version"]


def test_a_pack_that_disagrees_with_itself_is_told(pack, tmp_path):
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    record = json.loads((out / RECORD).read_text("utf-8"))
    assert list(contradictions(record, out, evidence_page)) == []
    record["code_verification"][0]["observed"] = 3.0
    record["credibility"][0]["missing"] = "nothing at all"
    assert [each.where for each in contradictions(record, out, None)] == [
        "code_verification[0].observed",
        "credibility[0].missing",
    ]
    text = (out / PAGE).read_text("utf-8")
    (out / PAGE).write_text(text.replace("not kept", "kept"), encoding="utf-8")
    whole = json.loads((out / RECORD).read_text("utf-8"))
    assert [each.where for each in contradictions(whole, out, evidence_page)] == [PAGE]
    assert list(contradictions({**whole, "version": "9.9"}, out, evidence_page)) == []  # its words may be others


def test_sums_that_are_no_text_are_told(pack, tmp_path):
    out = Path(shutil.copytree(pack[2] / "out", tmp_path / "out"))
    (out / SUMS).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"holds no pack of evidence: checksums.txt is not text"):
        differences(out)


def test_wear_stands_in_the_matrix_and_the_joint_that_wears_most_is_worn_to_the_end(asked):
    """A larger head slides farther under the same load."""
    hip = "[joint]\nhead_diameter = 28\nclearance = 0.1\nliner_thickness = 8\n[liner]\nyoung = 1000\npoisson = 0.4\n"
    hip = "cycles = 1e5\n" + hip + "[cup]\ntilt = 30\n[cycle]\nname = 'iso-14242-1'\ninstants = 16\n"
    hip += "[wear]\nlaw = 'archard'\ncoefficient = '1e-6 mm^3/(N m)'\nring_width = 8\n"
    hip += "[uncertainty]\ncoefficient = {median = '1e-6 mm^3/(N m)', factor = 1.5}\ncount = 4\n"
    (asked.parent / "hip.toml").write_text(hip, encoding="utf-8")
    text = ASKED.replace('clearance = ["0.05 mm", "0.15 mm"]', 'head_diameter = ["32 mm", "36 mm"]')
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
        differences(tmp_path)
    (tmp_path / "checksums.txt").write_text("0  ../../etc/passwd\n", encoding="utf-8")
    with pytest.raises(ValueError, match="which is no file of the pack"):
        differences(tmp_path)


def test_the_page_needs_nothing_beside_it_and_takes_words_as_text(pack, asked):
    _, record, folder = pack
    page = (folder / "out" / "evidence.html").read_text("utf-8")
    assert "http" not in page.replace("http-equiv", "")
    assert (folder / "out" / QUESTION).read_text("utf-8") == ASKED
    assert "<script>" not in evidence_page({**record, "question": "<script>alert(1)</script>"})


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
    turned = ASKED.replace('clearance = ["0.05 mm", "0.15 mm"]', 'inclination = ["40 deg", "60 deg"]')
    asked.write_text(turned.replace("[tolerances]", "[cup]\narc_of_cover = 160\n[tolerances]"), encoding="utf-8")
    with pytest.raises(ValueError, match="belongs to a table"):
        read_question(asked)
    asked.write_text(turned.replace('force = ["2 kN", "4 kN"]', 'force = ["4 kN"]'), encoding="utf-8")
    question = read_question(asked)
    assert question.model.name == "sphere"
    steep, flat = (matrix.rows(question, [case])[0] for case in reversed(matrix.cases(question)))
    assert steep.numbers["edge_distance"] < flat.numbers["edge_distance"]
    assert matrix.worst([steep, flat])["edge_distance"] is steep
