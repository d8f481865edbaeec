"""A ball that wears too: what it loses, where, and what that does to the contact."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Archard, Cycle, flexion, iso_14242_1
from ballsocket.hip.ball_wear import ball_directions, map_counterface
from ballsocket.reports.hip_report import write_hip_report

from .hips import QUICK, K, hip, report_after

COARSE = {"ring_width": radians(4.0)}
BOTH = {"wear": Archard(coefficient=K / 2), "ball_wear": Archard(coefficient=K / 2), **COARSE}


def spinning(count=24):
    """About the line of the load alone: socket and ball are then worn alike."""
    return Cycle(
        name="spin",
        force=lambda t: 2000.0 + 0 * t,
        angles=lambda t: radians(30.0) * np.stack([0 * t, 0 * t, np.cos(2 * pi * t)]),
        n_steps=count,
    )


def test_ball_volume_equals_the_work_of_friction():
    report = report_after(hip(**QUICK, wear=Archard(coefficient=K), ball_wear=Archard(coefficient=3e-7)), 5e5)
    assert report.volume == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert report.ball_volume == pytest.approx(1e-3 * 3e-7 * report.work, rel=1e-6)


def test_ball_spinning_about_its_load_wears_as_the_socket():
    """And both together leave the contact as twice the wear of the socket alone does."""
    pair = report_after(hip(cycle=spinning(), cup=bs.Cup(), **BOTH), 2e6)
    alone = report_after(hip(cycle=spinning(), cup=bs.Cup(), **COARSE), 2e6)
    assert pair.volume == pytest.approx(pair.ball_volume, rel=1e-9)
    assert pair.ball_depth == pytest.approx(pair.depth, rel=0.02)
    assert pair.volume + pair.ball_volume == pytest.approx(alone.volume, rel=2e-3)
    assert pair.penetration == pytest.approx(alone.penetration, rel=1e-2)
    assert pair.max_pressure == pytest.approx(alone.max_pressure, rel=5e-2)  # a spike where nothing slides


def test_flexion_spreads_the_wear_of_the_ball_over_its_track():
    """The load stands still on the socket, and goes to and fro on the ball."""
    use = hip(cycle=flexion(40), **BOTH)
    report = report_after(use, 1e6)
    assert report.ball_volume == pytest.approx(report.volume, rel=1e-9)
    assert report.ball_depth < 0.95 * report.depth
    to_front = ball_directions(use.ball_grid)[1]
    share = report.ball_wear * use.ball_areas
    reach = np.sqrt((share * to_front**2).sum() / share.sum())
    assert reach > 1.08 * np.sqrt(
        ((report.wear.ravel() * use.foundation.areas) @ use.foundation.directions[1] ** 2) / report.volume
    )


def test_ball_and_socket_have_the_same_work_in_each_instant():
    use = hip(cycle=iso_14242_1(40), **BOTH)
    ours = map_counterface(use, np.arange(len(use.foundation.areas)))
    given = (use.unworn.pressure * use.sliding.distances) @ use.foundation.areas
    found = ours.ball_exposure(use.exposure(use.unworn))
    assert (found.pressure * found.sliding.distances) @ ours.areas == pytest.approx(given, rel=1e-9)
    smaller = (use.joint.socket_radius / use.joint.ball_radius) ** 2  # is the ball, under the same force
    assert found.pressure.max() == pytest.approx(smaller * use.unworn.pressure.max(), rel=2e-3)


@pytest.mark.long
def test_report_page_has_a_map_of_the_ball_wear(tmp_path):
    history = hip(
        cycle=iso_14242_1(20), ring_width=radians(8.0), wear=Archard(coefficient=K), ball_wear=Archard(coefficient=K)
    ).after(1e4)
    page = write_hip_report(history, tmp_path / "ball.html").read_text(encoding="utf-8")
    assert "Wear of the ball" in page
    assert page.count("data:image/png;base64") == 7
