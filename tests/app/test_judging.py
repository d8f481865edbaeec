"""Finite elements behind the explorer: a process of their own that answers, waits its turn, and can be ended."""

import time
from functools import partial

import pytest

import ballsocket as bs
from ballsocket.catalogue import judge
from ballsocket.files.joint_file import JointFile
from ballsocket.problem.cup import Cup

pytest.importorskip("skfem")
from ballsocket.app import running
from ballsocket.app.running import Reached, Run, RunFinished, RunRefused
from ballsocket.app.views.finite_elements.worker import run_finite_elements

HIP = JointFile(bs.joints["hip-28"], {"force": 3000.0})


def judging(file, **limits):
    return Run(partial(run_finite_elements, file), **limits)


def until_the_end(run, seconds=600.0):
    heard, start = [], time.monotonic()
    while time.monotonic() - start < seconds:
        news = run.news()
        if news is not None:
            heard.append(news)
        if isinstance(news, RunFinished | RunRefused):
            return heard
        time.sleep(0.02)
    pytest.fail("the run said nothing for ten minutes")


@pytest.fixture(autouse=True)
def all_places_are_given_back():
    yield
    assert len(running.QUEUE) == 0


@pytest.mark.long
def test_a_run_answers_what_a_press_answers():
    *on_the_way, last = until_the_end(judging(HIP))
    found = last.value
    shares = [news.share for news in on_the_way]
    assert shares == sorted(shares)
    assert all(isinstance(news, Reached) for news in on_the_way)
    contact = bs.FiniteElement().press(HIP.joint, force=3000.0)
    assert found.numbers["max_pressure"] == pytest.approx(contact.max_pressure, rel=1e-3)
    assert found.exact["max_pressure"] == pytest.approx(bs.Exact().press(HIP.joint, force=3000.0).max_pressure)
    angle, pressure = found.pressures[judge.name]
    assert pressure[0] == pytest.approx(contact.pressure(0.0), rel=1e-3)
    assert angle[-1] == pytest.approx(contact.half_angle, rel=1e-3)
    assert found.png.startswith(b"\x89PNG")
    assert b"<svg" in found.svg


def test_a_run_that_takes_too_long_is_ended():
    refused = until_the_end(judging(HIP, longest=0.2))[-1]
    assert refused.why == "stopped after 0.2 s, the time limit of a run"


def test_a_run_whose_process_dies_says_so():
    run = judging(HIP)
    run.news()
    run._process.kill()
    assert "the process ended unexpectedly, perhaps for lack of memory" in until_the_end(run)[-1].why


def test_a_run_that_is_stopped_gives_its_place_back():
    run = judging(HIP)
    run.news()
    run.stop()
    run.stop()
    assert not run._process.is_alive()


def test_runs_wait_their_turn_in_the_order_in_which_they_came(monkeypatch):
    monkeypatch.setattr(running, "QUEUE", running.RunQueue(1))
    first, second, third = (Run(callable) for _ in range(3))  # work of an instant: it returns True
    first.news()
    for run in (second, third):
        assert run.news().words == "waiting: other computations are running"
    second.stop()
    assert isinstance(until_the_end(first)[-1], RunFinished)
    assert isinstance(until_the_end(third)[-1], RunFinished)


def test_a_process_that_cannot_be_started_is_said(monkeypatch):
    def begin(self):
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(Run, "_begin", begin)
    assert judging(HIP).news() == RunRefused(why="no process could be started: Resource temporarily unavailable")


@pytest.mark.long
def test_what_cannot_be_meshed_is_said():
    cup = Cup(arc_of_cover=0.75, chamfer=9.0)
    refused = until_the_end(judging(JointFile(HIP.joint, HIP.load, cup)))[-1]
    assert isinstance(refused, RunRefused)
    assert "chamfer" in refused.why


@pytest.mark.long
def test_a_contact_as_wide_as_its_cup_is_answered_with_a_note():
    found = until_the_end(judging(JointFile(HIP.joint, {"force": 3e4}, Cup(arc_of_cover=0.75))))[-1].value
    assert any("rim" in note for note in found.notes)
