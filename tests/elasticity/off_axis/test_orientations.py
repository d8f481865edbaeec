"""Orientations of a cup: each one equals the press of a cup in that orientation."""

import json
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.bounded import Verdict
from ballsocket.reports.orientation_plots import orientation_figure
from ballsocket.studies.expressions import parse_limit
from ballsocket.studies.orientation_answer import describe_orientations, limits_summary, verdicts

from ...joints import HIP

CUP = bs.Cup(arc_of_cover=np.radians(120.0), side=bs.Side.LEFT)
SPHERE = bs.Sphere(cup=CUP, direction=(0.3, 0.1, 1.0), ring_width=np.radians(5.0))
INCLINATION, ANTEVERSION = np.radians([20.0, 45.0, 85.0]), np.radians([-10.0, 30.0])


def orient(inclination=INCLINATION, anteversion=ANTEVERSION, model=SPHERE):
    return bs.orient(HIP, model=model, force=1500.0, inclination=inclination, anteversion=anteversion)


@pytest.fixture(scope="module")
def oriented():
    return orient()


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()] if figure.legends else []


def test_orientation_equals_the_press_of_a_cup_in_it(oriented):
    for i, j in np.ndindex(2, 2):
        cup = replace(CUP, inclination=INCLINATION[i], anteversion=ANTEVERSION[j])
        alone = replace(SPHERE, cup=cup).press(HIP, force=1500.0)
        for name in ("edge_distance", "max_pressure", "half_angle", "tilt"):
            assert getattr(oriented, name)[i, j] == pytest.approx(getattr(alone, name), rel=1e-4, abs=1e-4)
        assert oriented.contacts[i].force_vector[j] == pytest.approx(alone.force_vector, abs=0.01)


def test_mirrored_load_on_the_other_side_gives_the_same_contact(oriented):
    right = replace(SPHERE, cup=replace(CUP, side=bs.Side.RIGHT), direction=(-0.3, 0.1, 1.0))
    mirrored = orient(INCLINATION[:1], model=right)
    assert mirrored.edge_distance == pytest.approx(oriented.edge_distance[:1], abs=0.05)  # cells are not quite mirrored
    assert mirrored.max_pressure == pytest.approx(oriented.max_pressure[:1], rel=2e-3)


def test_orientation_that_does_not_hold_the_ball_has_a_status_and_nan(oriented):
    assert oriented.status[-1].tolist() == [int(bs.Status.DISLOCATED)] * 2
    assert oriented.held.tolist() == [[True, True], [True, True], [False, False]]
    assert np.isnan(oriented.edge_distance[-1]).all()
    assert oriented.best(oriented.edge_distance)[:2] == (INCLINATION[0], ANTEVERSION[0])
    summary = json.loads(json.dumps(oriented.summary(), allow_nan=False))
    assert summary["status"][-1] == ["DISLOCATED", "DISLOCATED"]
    assert summary["edge_loaded"] == [[False, True], summary["edge_loaded"][1], [None, None]]
    assert summary["inclination_deg"] == pytest.approx([20, 45, 85])


def test_map_states_why_an_orientation_has_no_number(oriented):
    assert "the load leaves the bore" in legend(orientation_figure(oriented))
    assert legend(orientation_figure(orient([0.2, 0.4], [0.0, 0.1]))) == []
    over = orient([0.2, 1.1], [0.0, 0.1], replace(SPHERE, cup=replace(CUP, chamfer=1.0)))
    assert np.isposinf(over.max_pressure[1]).all()
    assert np.isfinite(over.max_pressure[0]).all()
    shown = legend(orientation_figure(over))
    assert shown == ["the contact reaches the rim", "the rim digs in: unbounded pressure"]
    with pytest.raises(ValueError, match="two values of an angle, got one orientation"):
        orientation_figure(orient(0.2, 0.1))


def test_a_limit_of_the_distance_is_undecided_without_a_contact():
    unloaded = bs.orient(HIP, model=SPHERE, force=0.0, inclination=0.4, anteversion=0.1)
    assert verdicts(unloaded, [parse_limit("edge_distance>=1 mm")]) == Verdict.UNDECIDED


def test_figure_of_one_changing_angle_is_a_curve_with_its_limits(oriented):
    limits = [parse_limit("edge_distance>=1 mm"), parse_limit("max_pressure<=1 GPa")]
    row = orient(anteversion=ANTEVERSION[1])
    figure = orientation_figure(row, limits=limits)
    distance, pressure = figure.axes
    assert "anteversion 30°" in figure.get_suptitle()
    x, y = distance.lines[0].get_xydata().T
    assert x == pytest.approx([20, 45, 85])
    assert y[:2] == pytest.approx(row.edge_distance[:2, 0])
    assert np.isnan(y[2])  # the ball is not held
    for axes, bound in ((distance, 1.0), (pressure, 1000.0)):
        dashed = [line for line in axes.lines if line.get_linestyle() == "--"]
        assert [list(line.get_ydata()) for line in dashed] == [pytest.approx([bound, bound])]
    for drawn in (figure, orientation_figure(oriented, limits=limits)):
        assert "edge_distance ≥ 1 mm" in legend(drawn)


@pytest.mark.parametrize(
    ("angles", "marked"),
    [
        ({}, []),
        ({"inclination": 0.0}, [[0.0, 0.0]]),
        ({"anteversion": 0.1}, [[0.0, 0.1]]),
        ({"inclination": 0.1, "anteversion": 0.05}, [[0.1, 0.05]]),
    ],
)
def test_map_marks_a_stated_orientation_also_at_zero(angles, marked):
    model = replace(SPHERE, cup=replace(CUP, **angles))
    left, _ = orientation_figure(orient([0.0, 0.2], [0.0, 0.2], model)).axes
    shown = [line.get_xydata()[0] for line in left.lines if line.get_label() == "this cup"]
    assert np.reshape(shown, (-1, 2)) == pytest.approx(np.degrees(np.reshape(marked, (-1, 2))))


def test_each_limit_marks_the_table_of_its_quantity(oriented):
    """85° does not hold the ball; 45° loads the rim; the largest pressure is below 100 MPa in all others."""
    limits = [parse_limit(text) for text in ("edge_distance>=0.1 mm", "max_pressure<=100 MPa", "half_angle<=1 deg")]
    described = describe_orientations(oriented, limits)
    marks = {table.key: [[cell.verdict for cell in row.cells[1:]] for row in table.rows] for table in described.tables}
    kept, exceeded = Verdict.KEPT, Verdict.EXCEEDED
    assert list(marks) == ["edge_distance", "max_pressure", "half_angle_deg"]
    assert marks["max_pressure"] == [[kept, kept, exceeded]] * 2
    assert marks["edge_distance"] == [[kept, exceeded, exceeded], [exceeded] * 3]
    assert marks["half_angle_deg"] == [[exceeded] * 3] * 2
    summary = limits_summary(oriented, limits)
    assert summary["verdicts_by_limit"]["max_pressure ≤ 100 MPa"] == [["kept"] * 2] * 2 + [["exceeded"] * 2]
    assert "max_pressure ≤ 100 MPa: kept in 4, exceeded in 2" in described.notes
    keys = [table.key for table in describe_orientations(oriented, limits[:1]).tables]
    assert keys == ["edge_distance", "max_pressure"]
