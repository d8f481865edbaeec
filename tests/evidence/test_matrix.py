"""Matrix of cases: order of the cases, worst rows, limits, and figures of the record."""

import copy
import json
import math
from xml.etree import ElementTree

import numpy as np
import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
import ballsocket as bs
from ballsocket.core.arrays import to_numpy
from ballsocket.core.unit_systems import Units
from ballsocket.evidence import matrix
from ballsocket.evidence.matrix import WEAR, MatrixRow, check_limit, list_cases
from ballsocket.problem.cup import UP
from ballsocket.reports import evidence_parts as figures
from ballsocket.studies.expressions import parse_limit

from ..places import EXAMPLES
from .small_pack import CLEARANCE, FORCE, question_of

PRESSURES = (10.0, 19.5, 21.0, math.nan)
LIMIT = parse_limit("max_pressure <= 20 MPa")


def row(valid=True, **numbers):
    return MatrixRow({"force": 1.0}, numbers, {}, {}, "OK", valid)


def test_a_limit_counts_violations_missing_results_and_marginal_cases():
    rows = [row(max_pressure=pressure) for pressure in PRESSURES]
    check = check_limit(LIMIT, rows, accuracy=0.05)
    assert (check.beyond, check.unknown, check.marginal, check.row) == (1, 1, 1, rows[2])
    assert [check_limit(LIMIT, rows, accuracy=accuracy).marginal for accuracy in (0.02, 0.03)] == [0, 1]
    assert (check.summary()["low"], check.summary()["high"]) == (None, 20.0)


@pytest.mark.parametrize(
    ("pressures", "verdict"),
    [
        ((10.0, 21.0, math.nan), "exceeded"),
        ((10.0, math.nan), "undecided"),
        ((), "undecided"),
        ((10.0, 19.5), "undecided"),  # nearer than the required accuracy
        ((10.0, 20.0), "undecided"),
        ((10.0,), "kept"),
    ],
)
def test_verdict_of_a_limit(pressures, verdict):
    rows = [row(max_pressure=pressure) for pressure in pressures]
    assert check_limit(LIMIT, rows, accuracy=0.05).verdict.word == verdict


def test_an_error_bar_or_an_invalid_result_leaves_a_limit_undecided():
    states = {((17.9, 18.1), True): "kept", ((20.1, 20.3), False): "exceeded"}
    states |= dict.fromkeys((((17.9, 20.1), True), ((17.9, math.inf), True), ((17.9, 18.1), False)), "undecided")
    for (bar, valid), verdict in states.items():
        case = MatrixRow({"force": 1.0}, {"max_pressure": 18.0}, {}, {"max_pressure": bar}, "OK", valid)
        for row in (case, MatrixRow.of(case.summary())):
            assert check_limit(LIMIT, [row], accuracy=0.05).verdict.word == verdict


def test_a_limit_may_have_a_lower_end_or_limit_a_parameter():
    rows = [row(edge_distance=distance) for distance in (3.0, 0.5, 2.0)]
    check = check_limit(parse_limit("edge_distance >= 1 mm"), rows, accuracy=0.05)
    assert (check.beyond, check.row) == (1, rows[1])
    assert check_limit(parse_limit("force <= 2 N"), rows, accuracy=0.05).verdict.word == "kept"


def test_worst_row_has_the_largest_number_and_the_smallest_edge_distance():
    numbers = ((1.0, 3.0), (5.0, 1.0), (math.nan, 2.0))
    rows = [row(max_pressure=p, edge_distance=distance, wear_rate=math.nan) for p, distance in numbers]
    assert matrix.worst_rows(rows) == {"max_pressure": rows[1], "edge_distance": rows[1]}


def test_the_last_axis_varies_fastest_and_a_case_has_the_numbers_of_a_single_press_in_the_cup(pack):
    cases = list_cases(pack[0])
    assert cases == [{"clearance": c, "force": f} for c in (0.05, 0.15) for f in (2000.0, 4000.0)]
    question, record, _ = pack
    assert len(record["matrix"]) == 4
    for entry in record["matrix"]:
        joint, numbers = bs.joints["hip-36"].replace(clearance=entry["case"]["clearance"]), entry["numbers"]
        contact = bs.Exact().press(joint, force=entry["case"]["force"])
        distance = question.file.cup.edge_distance(joint.socket_radius, contact.half_angle, UP)
        assert numbers["max_pressure"] == pytest.approx(contact.max_pressure, rel=1e-9)
        assert numbers["friction_torque"] == pytest.approx(contact.friction_torque(0.06), rel=1e-9)
        assert numbers["edge_distance"] == pytest.approx(float(to_numpy(distance)))
        assert numbers["half_angle_deg"] == pytest.approx(math.degrees(contact.half_angle))
        assert (entry["status"], entry["valid"]) == ("OK", True)
        assert set(entry["errors"]) == {"force", "half_angle_deg", "indentation", "max_pressure", "von_mises"}
    assert MatrixRow.of(entry).summary() == entry
    errors = dict(matrix.known_errors(bs.Exact(tolerance=1e-3).press(bs.joints["hip-36"], force=2000.0)))
    assert 2e-3 <= errors.pop("von_mises") <= 3.1e-3  # of its sum over the liner, and of the tolerance
    assert all(0 <= error <= 1e-3 for error in map(float, errors.values()))


def test_impossible_joints_have_a_status_and_no_numbers(tmp_path):
    question = question_of(tmp_path, (CLEARANCE, 'head_diameter = "36 mm"\nouter_diameter = ["36.1 mm", "48 mm"]'))
    rows = matrix.compute_rows(question, list_cases(question))
    assert [(row.status, row.valid) for row in rows] == [("NO_JOINT", False)] * 2 + [("OK", True)] * 2
    assert rows[0].summary()["numbers"]["max_pressure"] is None


@pytest.mark.long
def test_off_axis_friction_torque_is_an_upper_bound(tmp_path):
    question = question_of(tmp_path, (CLEARANCE, 'inclination = "40 deg"'), (FORCE, 'force = "4 kN"'))
    (tilted,) = matrix.compute_rows(question, list_cases(question))
    joint = bs.joints["hip-36"]
    aligned = bs.Exact().press(joint, force=4000.0).friction_torque(0.06)
    assert tilted.numbers["friction_torque"] >= 0.06 * joint.ball_radius * 4000.0
    assert tilted.numbers["friction_torque"] == pytest.approx(aligned, rel=0.15)


def texts(axes):
    return {text.get_text() for text in axes.texts}


def test_the_figure_of_three_inputs_marks_the_worst_cell_a_missing_one_and_what_is_beyond_a_limit(record):
    rows = [copy.deepcopy(row) for _ in range(2) for row in record["matrix"]]
    for number, row in enumerate(rows):
        row["case"] = {"head_diameter": 28.0 + number // 4, **row["case"]}
        row["numbers"] |= {"max_pressure": 8.0 + number, WEAR.key: 30.0}
    record |= {"matrix": rows, "worst": {"max_pressure": rows[-1]}}
    axes = figures.matrix_figure(record).axes[0]
    assert sorted(map(float, texts(axes))) == [8.0 + number for number in range(8)]
    (frame,) = [patch for patch in axes.patches if not patch.fill]
    column, line = np.round(np.add(frame.get_xy(), 0.47)).astype(int)
    assert axes.images[0].get_array()[line, column] == 15.0
    record["limits"][0]["high"] = 12.0
    axes = figures.matrix_figure(record).axes[0]
    assert len([line for line in axes.lines if line.get_marker() == "x"]) == 3
    assert axes.get_ylabel() == "head diameter [mm]"
    assert axes.get_xlabel() == "radial clearance [mm] | normal force [N]"
    rows[0]["numbers"]["max_pressure"] = None
    assert np.isnan(figures.matrix_figure(record).axes[0].images[0].get_array().filled(np.nan)).sum() == 1
    wear = figures.matrix_figure({**record, "worst": {WEAR.name: rows[-1]}}, WEAR.name)
    assert wear.axes[1].get_ylabel() == "wear in 10⁶ cycles [mm³]"


def test_the_joint_is_drawn_with_a_contact_about_its_axis(record):
    drawing = ElementTree.fromstring(figures.joint_drawing(record, Units.SI))
    half_angle = record["drawn"]["half_angle_deg"]
    edge = drawing.findall(".//*[@class='edge']")[-1]
    across, down = (float(edge.get(f"{axis}2")) - float(edge.get(f"{axis}1")) for axis in "xy")
    assert np.degrees(np.arctan2(across, down)) == pytest.approx(half_angle, abs=0.05)  # coordinates have one decimal
    written = {text.text for text in drawing.iter("{http://www.w3.org/2000/svg}text")}
    force = record["worst"]["max_pressure"]["numbers"]["force"]
    assert {"cross-linked UHMWPE", f"{force:.4g} N"} <= written
    off_axis = {**record, "drawn": {**record["drawn"], "half_angle_deg": None}}
    assert b" N<" not in figures.joint_drawing(off_axis, Units.SI)
    metal = bs.read_joint(EXAMPLES / "metal_backed_hip.toml").joint.summary()
    backed = {**record, "drawn": {**record["drawn"], "joint": json.loads(json.dumps(metal))}}
    assert b">titanium alloy<" in figures.joint_drawing(backed, Units.SI)


def test_methods_bands_and_wear_are_drawn_at_their_numbers(record):
    methods = figures.methods_figure(record).axes[0]
    exact, *others = (method["numbers"]["max_pressure"] for method in record["calculation"][0]["methods"])
    deviations = [line.get_xdata()[0] for line in methods.lines if line.get_marker() in "os"]
    assert set(np.round([100 * (other / exact - 1) for other in others], 6)) <= set(np.round(deviations, 6))
    left, right = figures.bands_figure(record).axes
    low, median, high = (record["uncertainty"]["bands"]["max_pressure"][end] for end in ("low", "median", "high"))
    ends = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in left.patches]
    assert pytest.approx((100 * (low / median - 1), 100 * (high / median - 1))) in ends
    indices = record["uncertainty"]["sobol"]["max_pressure"].values()
    assert {*indices} <= {bar.get_width() for bar in right.patches}
    history = [{"cycles": 1e6, "volume": 30.0}, {"cycles": 2e6, "volume": 61.0}]
    bands = [{"cycles": 2e6, "volume": {"low": 20.0, "median": 61.0, "high": 100.0}}]
    wear = figures.wear_figure({"wear": {"history": history, "bands": bands}}).axes[0]
    assert wear.lines[0].get_ydata()[-1] == 61.0
    assert wear.collections[0].get_paths()[0].vertices[:, 1].max() == 100.0
    assert figures.wear_figure({"wear": {"history": history}}).axes[0].collections[:] == []
