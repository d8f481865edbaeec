"""Orientations of a cup: each one equals the press of a cup in that orientation."""

import json
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.finite_elements.progress import progress_to
from ballsocket.reports.orientation_results import orientation_figure
from ballsocket.studies.expressions import parse_limit

from ...joints import HIP

CUP = bs.Cup(arc_of_cover=radians(120.0), side=bs.Side.LEFT)
SPHERE = bs.Sphere(cup=CUP, direction=(0.3, 0.1, 1.0), ring_width=radians(5.0))
INCLINATION, ANTEVERSION = np.radians([20.0, 45.0, 85.0]), np.radians([-10.0, 30.0])


@pytest.fixture(scope="module")
def oriented():
    return bs.orient(HIP, model=SPHERE, force=1500.0, inclination=INCLINATION, anteversion=ANTEVERSION)


def test_progress_counts_the_inclinations_from_one():
    messages = []
    with progress_to(messages.append):
        bs.orient(HIP, model=SPHERE, force=100.0, inclination=[0.3, 0.5, 0.7], anteversion=0.1)
    assert [text for text in messages if text.startswith("inclination")] == [
        f"inclination {number} of 3" for number in (1, 2, 3)
    ]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()] if figure.legends else []


def test_orientation_equals_the_press_of_a_cup_in_it(oriented):
    for i, inclination in enumerate(INCLINATION[:2]):
        for j, anteversion in enumerate(ANTEVERSION):
            cup = replace(CUP, inclination=inclination, anteversion=anteversion)
            alone = replace(SPHERE, cup=cup).press(HIP, force=1500.0)
            for name in ("edge_distance", "max_pressure", "half_angle", "tilt"):
                assert getattr(oriented, name)[i, j] == pytest.approx(getattr(alone, name), rel=1e-4, abs=1e-4)
            assert oriented.contacts[i].force_vector[j] == pytest.approx(alone.force_vector, abs=0.01)


def test_mirrored_load_on_the_other_side_gives_the_same_contact(oriented):
    right = replace(SPHERE, cup=replace(CUP, side=bs.Side.RIGHT), direction=(-0.3, 0.1, 1.0))
    mirrored = bs.orient(HIP, model=right, force=1500.0, inclination=INCLINATION[:1], anteversion=ANTEVERSION)
    assert mirrored.edge_distance == pytest.approx(oriented.edge_distance[:1], abs=0.05)  # cells are not quite mirrored
    assert mirrored.max_pressure == pytest.approx(oriented.max_pressure[:1], rel=2e-3)


def test_orientation_that_does_not_hold_the_ball_has_a_status_and_nan(oriented):
    assert oriented.status[-1].tolist() == [int(bs.Status.DISLOCATED)] * 2
    assert oriented.held.tolist() == [[True, True], [True, True], [False, False]]
    assert np.isnan(oriented.edge_distance[-1]).all()
    assert oriented.best(oriented.edge_distance)[:2] == (INCLINATION[0], ANTEVERSION[0])
    summary = json.loads(json.dumps(oriented.summary(), allow_nan=False))
    assert summary["status"][-1] == ["DISLOCATED", "DISLOCATED"]
    assert summary["edge_loaded"][-1] == [None, None]
    assert summary["edge_loaded"][0] == [False, True]
    assert summary["inclination_deg"] == pytest.approx([20, 45, 85])


def test_map_is_hatched_without_a_number(oriented):
    assert "the load leaves the bore" in legend(orientation_figure(oriented))
    held = bs.orient(HIP, model=SPHERE, force=1500.0, inclination=[0.2, 0.4], anteversion=[0.0, 0.1])
    assert legend(orientation_figure(held)) == []
    dug = replace(SPHERE, cup=replace(CUP, chamfer=1.0))
    over = bs.orient(HIP, model=dug, force=1500.0, inclination=[0.2, 1.1], anteversion=[0.0, 0.1])
    assert np.isposinf(over.max_pressure[1]).all()
    assert np.isfinite(over.max_pressure[0]).all()
    assert legend(orientation_figure(over)) == [
        "the contact reaches the rim",
        "the rim digs in: unbounded pressure",
    ]
    with pytest.raises(ValueError, match="two values of an angle, got one orientation"):
        orientation_figure(bs.orient(HIP, model=SPHERE, force=1500.0, inclination=0.2, anteversion=0.1))


def test_figure_of_one_changing_angle_is_a_curve_with_its_limits(oriented):
    limits = [parse_limit("edge_distance>=1 mm"), parse_limit("max_pressure<=1 GPa")]
    row = bs.orient(HIP, model=SPHERE, force=1500.0, inclination=INCLINATION, anteversion=ANTEVERSION[1])
    figure = orientation_figure(row, limits=limits)
    distance, pressure = figure.axes
    assert "anteversion 30°" in figure.get_suptitle()
    x, y = distance.lines[0].get_xydata().T
    assert x == pytest.approx([20, 45, 85])
    assert y[:2] == pytest.approx(row.edge_distance[:2, 0])
    assert np.isnan(y[2])  # the ball is not held
    assert distance.lines[1].get_ydata() == pytest.approx([1.0, 1.0])
    assert pressure.lines[1].get_ydata() == pytest.approx([1000.0, 1000.0])
    assert "edge_distance >= 1 mm" in legend(figure)
    assert "edge_distance >= 1 mm" in legend(orientation_figure(oriented, limits=limits))


def test_map_shows_its_fields_and_the_original_cup():
    cup = replace(CUP, inclination=0.7, anteversion=0.1)
    model = replace(SPHERE, cup=cup)
    angles = {"inclination": np.linspace(0.5, 0.9, 3), "anteversion": np.linspace(0.0, 0.3, 3)}
    left, right = orientation_figure(bs.orient(HIP, model=model, force=1500.0, **angles)).axes
    assert "edge distance [mm]" in left.get_title()
    assert "largest pressure pmax [MPa]" in right.get_title()
    assert left.get_xlabel() == "inclination [°]"
    marked = [line.get_xydata()[0] for line in left.lines if line.get_label() == "this cup"]
    assert marked[0] == pytest.approx(np.degrees([0.7, 0.1]))


@pytest.mark.parametrize(("angles", "count"), [({}, 0), ({"inclination": 0.0}, 1), ({"anteversion": 0.1}, 1)])
def test_map_marks_a_stated_orientation_also_at_zero(angles, count):
    model = replace(SPHERE, cup=replace(CUP, **angles))
    oriented = bs.orient(HIP, model=model, force=1500.0, inclination=[0.0, 0.2], anteversion=[0.0, 0.2])
    axes = orientation_figure(oriented).axes[0]
    assert sum(line.get_label() == "this cup" for line in axes.lines) == count


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inclination": [45.0]}, r"inclination\[0\] = 45 is not allowed"),
        ({"anteversion": [[0.1, 0.2]]}, "give a row of angles"),
        (
            {"model": replace(SPHERE, direction=[(0, 0, 1), (0, 1, 1)])},
            "directions of the model = 2 .* give one direction",
        ),
        ({"force": -1.0}, "force = -1"),
        ({"anteversion": [0.2, 0.1]}, "angles .rad. rise"),
    ],
)
def test_invalid_orientations_raise(change, message):
    valid = {"force": 1500.0, "model": SPHERE, "inclination": [0.5], "anteversion": [0.1]}
    with pytest.raises(ValueError, match=message):
        bs.orient(HIP, **{**valid, **change})
