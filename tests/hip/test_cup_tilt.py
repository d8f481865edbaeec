"""Orientation of the cup: an explicit orientation, 0 included, replaces the tilt of the cycle's standard."""

import pickle
from dataclasses import replace
from math import degrees, radians
from urllib.parse import parse_qs

import pytest

import ballsocket as bs
from ballsocket.app.state.screen import DEFAULT_QUESTION, START, link_of, read_link
from ballsocket.app.state.use import Use, hip_of
from ballsocket.app.views.evidence import write_question
from ballsocket.app.views.hip_runs import gait_key, wear_key
from ballsocket.files.joint_file import JointFile
from ballsocket.files.joint_toml import tables_of
from ballsocket.hip import PatientVariability
from ballsocket.hip.config import read_hip
from ballsocket.studies import Normal

from .hips import hip, report_after, write_edited_file

TILT = 'tilt = "30 deg" # between the load and the cup\'s axis'


def tilt_of(use):
    return round(degrees(use.frame.placed.inclination), 9)


def test_a_cup_with_an_explicit_zero_angle_is_upright():
    for words in ({"inclination": 0}, {"anteversion": 0.0}):
        use = hip(cup=bs.Cup(**words))
        assert tilt_of(use) == 0
        assert not any("standard requires" in note for note in use.notes)
    assert tilt_of(hip(cup=bs.Cup())) == 30
    scatter = PatientVariability(use=hip(cup=bs.Cup()), distributions={"tilt": Normal(mean=0.2, deviation=0.05)})
    assert [tilt_of(scatter.patient(sample).use) for sample in ({"tilt": 0.0}, {})] == [0, 30]


def test_a_sweep_of_tilts_is_continuous_at_zero():
    zero, tilted = (report_after(hip(cup=bs.Cup(inclination=radians(tilt))), 2e5) for tilt in (0.0, 1e-4))
    assert zero.volume == pytest.approx(tilted.volume, rel=1e-5)
    assert zero.max_pressure == pytest.approx(tilted.max_pressure, rel=1e-4)
    assert zero.edge_distance.min() == pytest.approx(tilted.edge_distance.min(), abs=1e-3)
    assert zero.edge_distance.min() > 4


def test_a_file_with_an_explicit_zero_angle_has_an_upright_cup(tmp_path):
    for words, tilt in (('tilt = "0 deg"', 0), ('inclination = "0 deg"', 0), ("anteversion = 0", 0), ("", 30)):
        assert tilt_of(read_hip(write_edited_file(tmp_path, (TILT, words))).use) == tilt


def test_a_cup_records_that_an_angle_was_set():
    stated, default = bs.Cup(inclination=0.0), bs.Cup()
    assert stated == default
    assert stated.oriented
    assert default.tilted(0.0).oriented
    copies = pickle.loads(pickle.dumps(default)), replace(default, chamfer=0.0)
    assert not any(cup.oriented for cup in (default, *copies))
    left = replace(default, side=bs.Side.LEFT)
    written = [tables_of(JointFile(bs.joints["hip-28"], {}, cup=cup)).get("cup") for cup in (default, left, stated)]
    assert (written[0], written[1]["side"], written[2]["inclination"]) == (None, "left", 0)


def test_the_explorer_preserves_an_explicit_zero_angle(tmp_path):
    upright = replace(START, file=replace(START.file, cup=bs.Cup(inclination=0.0)))
    assert tilt_of(hip_of(START.file, Use())) == 30
    assert tilt_of(hip_of(upright.file, Use())) == 0
    assert read_link(parse_qs(link_of(upright))).file.cup.oriented
    assert not read_link(parse_qs(link_of(START))).file.cup.oriented
    assert gait_key(upright.file, Use(), None) != gait_key(START.file, Use(), None)
    assert wear_key(upright.file, Use()) != wear_key(START.file, Use())
    question = write_question(replace(DEFAULT_QUESTION, wear="yes"), upright.file, Use(), tmp_path)
    assert tilt_of(read_hip(question.hip).use) == 0
