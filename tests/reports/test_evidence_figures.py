"""Figures of a pack: what they show is what the record says."""

import json

import numpy
import pytest

from ballsocket import read_joint
from ballsocket.evidence.matrix import NAMES, WEAR
from ballsocket.problem import presets
from ballsocket.reports import evidence_parts as figures

from ..places import EXAMPLES


def row(diameter, clearance, force, pressure):
    numbers = {"max_pressure": pressure, "half_angle_deg": 40.0, WEAR.key: 30.0 + diameter}
    case = {"head_diameter": diameter, "clearance": clearance, "force": force}
    return {"case": case, "numbers": numbers, "errors": {}, "status": "OK", "valid": True}


CASES = [(d, c, f) for d in (28.0, 32.0) for c in (0.05, 0.1) for f in (1000.0, 2000.0, 3000.0)]
ROWS = [row(*case, pressure) for case, pressure in zip(CASES, numpy.linspace(8.0, 19.0, 12), strict=True)]
METHODS = [
    {"name": name, "numbers": {"max_pressure": p, "area": 100 * p}, "errors": {}, "valid": True, "aligned": True}
    for name, p in (("exact", 10.0), ("sphere", 10.1), ("finite elements", 9.8))
]
RECORD = {
    "matrix": ROWS,
    "worst": {"max_pressure": ROWS[-1]},
    "limits": [{"name": "max_pressure", "low": None, "high": 15.0}],
    "required": {"accuracy": 0.05},
    "drawn": {"joint": presets.joints["hip-36"].summary(), "arc_of_cover_deg": 160.0, "half_angle_deg": 40.0},
    "calculation": [{"methods": METHODS, "deviation": {"max_pressure": 0.02, "area": 0.02}}],
    "uncertainty": {
        "bands": {"max_pressure": {"low": 9.0, "median": 10.0, "high": 12.0}},
        "sobol": {"max_pressure": {"clearance": 0.8, "liner_young": 0.2}},
    },
    "wear": {
        "history": [{"cycles": 1e6, "volume": 30.0}, {"cycles": 2e6, "volume": 61.0}],
        "bands": [{"cycles": 2e6, "volume": {"low": 20.0, "median": 61.0, "high": 100.0}}],
    },
}


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_the_matrix_marks_the_worst_cell_and_what_is_beyond_a_limit():
    axes = figures.matrix_figure(RECORD).axes[0]
    pressures = [row["numbers"]["max_pressure"] for row in ROWS]
    assert sorted(map(float, texts(axes))) == pytest.approx(sorted(pressures), abs=0.05)
    (frame,) = [patch for patch in axes.patches if not patch.fill]
    corner = numpy.round(numpy.add(frame.get_xy(), 0.47)).astype(int)
    assert axes.images[0].get_array()[corner[1], corner[0]] == pytest.approx(19.0)
    crosses = [line for line in axes.lines if line.get_marker() == "x"]
    assert len(crosses) == sum(pressure > 15 for pressure in pressures)
    assert axes.get_ylabel() == "head diameter [mm]"
    assert axes.get_xlabel() == "radial clearance [mm] | normal force [N]"


def test_a_matrix_without_a_result_in_a_case_and_of_any_number_is_drawn():
    gone = {**ROWS[0], "numbers": {**ROWS[0]["numbers"], "max_pressure": None}}
    axes = figures.matrix_figure({**RECORD, "matrix": [gone, *ROWS[1:]]}).axes[0]
    assert numpy.isnan(axes.images[0].get_array().filled(numpy.nan)).sum() == 1
    wear = figures.matrix_figure({**RECORD, "worst": {WEAR.name: ROWS[-1]}}, WEAR.name)
    assert wear.axes[1].get_ylabel() == "[mm³/10⁶]"
    assert NAMES[WEAR.name] is WEAR


def test_the_joint_is_drawn_with_a_contact_about_its_axis():
    axes = figures.joint_figure(RECORD).axes[0]
    contact = axes.lines[-1].get_xydata()
    assert numpy.hypot(*contact.T) == pytest.approx(18.1)
    assert numpy.degrees(numpy.arctan2(contact[-1, 0], -contact[-1, 1])) == pytest.approx(40.0)
    assert {"cross-linked PE, 5 mm", "contact to 40°"} <= set(texts(axes))
    off_axis = figures.joint_figure({**RECORD, "drawn": {**RECORD["drawn"], "half_angle_deg": None}})
    assert not any("contact" in text for text in texts(off_axis.axes[0]))


@pytest.mark.parametrize("name", ["metal_backed_hip.toml", "hip.toml"])
def test_a_joint_is_restored_from_its_summary(name):
    joint = read_joint(EXAMPLES / name).joint
    drawn = {**RECORD["drawn"], "joint": json.loads(json.dumps(joint.summary()))}
    assert figures._joint(drawn["joint"]).summary() == joint.summary()
    assert figures.joint_figure({**RECORD, "drawn": drawn}).axes


def test_methods_bands_and_wear_are_drawn_at_their_numbers():
    methods = figures.methods_figure(RECORD).axes[0]
    deviations = {line.get_label(): line.get_xdata() for line in methods.lines if line.get_marker() in "os"}
    assert deviations["sphere"] == pytest.approx([1.0, 1.0])
    assert deviations["finite elements"] == pytest.approx([-2.0, -2.0])
    left, right = figures.bands_figure(RECORD).axes
    (bar,) = left.patches
    assert (bar.get_x(), bar.get_x() + bar.get_width()) == pytest.approx((-10.0, 20.0))
    assert [bar.get_width() for bar in right.patches] == [0.8, 0.2]
    wear = figures.wear_figure(RECORD).axes[0]
    assert wear.lines[0].get_ydata()[-1] == 61.0
    assert wear.collections[0].get_paths()[0].vertices[:, 1].max() == 100.0
    assert figures.wear_figure({"wear": {"history": RECORD["wear"]["history"]}}).axes[0].collections[:] == []
