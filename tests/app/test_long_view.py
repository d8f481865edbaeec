"""Long work of a view: its button, its progress, and results that stay."""

import json
from dataclasses import replace
from functools import partial

import pytest

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
from ballsocket.app import long_view, results, session
from ballsocket.app.jobs import Job
from ballsocket.app.long_view import LongView, long_body
from ballsocket.app.results import ResultStore
from ballsocket.app.running import Reached, RunFinished, RunRefused
from ballsocket.app.session import Page
from ballsocket.app.state.screen import START
from ballsocket.app.state.use import Use
from ballsocket.app.views.cup.worker import bore_of, orientation_key
from ballsocket.app.views.gait.worker import gait_key
from ballsocket.app.views.wear.worker import wear_key

from .asking import does, edits


def square(force, report):
    report(Reached(share=0.5, words="squaring"))
    if force > 5000:
        raise ValueError("force must be at most 5000 N")
    return force**2


class Square(LongView):
    """View whose result is the square of the force."""

    name, title, run_label = "press", "Square", "Square the force"
    body = long_body("press", "", "<div id='press-numbers'></div>")

    def question_of(self, screen):
        return screen.file.load["force"]

    def work(self, screen):
        return partial(square, screen.file.load["force"])

    def show_result(self, screen, result):
        self.page.channel.put("#press-numbers", "" if result is None else f"{result:g}")


class Automatic(Square):
    """View that runs without a click."""

    automatic = True


@pytest.fixture(autouse=True)
def jobs(monkeypatch):
    """Jobs that run when they are told to; the works that were asked for."""
    asked = []

    def ask(self, key, work):
        self._run, self._key = asked, key
        asked.append((self, key, work))

    def stop(self):
        self._run = None

    monkeypatch.setattr(Job, "ask", ask)
    monkeypatch.setattr(Job, "stop", stop)
    monkeypatch.setattr(results, "RESULTS", ResultStore())
    return asked


def finish(job, key, work):
    try:
        value = work(partial(job._heard, key))
    except ValueError as error:
        job.stop()
        job._heard(key, RunRefused(why=str(error)))
    else:
        job.stop()
        job._heard(key, RunFinished(value))


def opened(monkeypatch, kind):
    monkeypatch.setattr(session, "view_class", lambda name: kind)
    return Page("")


def shown(page, element):
    return page.channel.shown_value(f"#press-{element}") or ""


def button(page):
    return page.channel.shown_value("=press.run")


def test_a_click_runs_and_a_change_of_inputs_keeps_the_result_with_a_mark(monkeypatch, jobs):
    page = opened(monkeypatch, Square)
    assert button(page)["label"] == "Square the force"
    assert not jobs
    with pytest.raises(ValueError, match="press 'Square the force' first"):
        page.view.result(page.screen)
    assert edits(page, "press.run", True)["=press.run"]["share"] == 0.0
    messages = []
    page.channel.write = lambda text: messages.append(json.loads(text))
    finish(*jobs[-1])
    assert "squaring" in messages[0]["=press.run"]["words"]
    assert shown(page, "numbers") == "9e+06"
    assert button(page)["share"] is None
    edits(page, "load", 2000)
    assert "belong to an earlier design" in shown(page, "earlier")
    assert shown(page, "numbers") == "9e+06"
    edits(page, "load", 3000)
    assert shown(page, "earlier") == ""
    assert page.view.result(page.screen) == 9e6
    assert len(jobs) == 1


def test_a_result_is_shown_to_the_next_page_that_asks_for_it(monkeypatch, jobs):
    edits(opened(monkeypatch, Square), "press.run", True)
    finish(*jobs[-1])
    page = Page("")
    assert shown(page, "numbers") == "9e+06"
    edits(page, "press.run", True)
    assert len(jobs) == 1
    assert button(page)["share"] is None


def test_work_that_is_cancelled_ends_and_is_not_begun_again_by_itself(monkeypatch, jobs):
    page = opened(monkeypatch, Automatic)
    assert len(jobs) == 1
    answer = edits(page, "press.run", False)["=press.run"]
    assert (answer["share"], answer["words"]) == (None, "Cancelled.")
    does(page, "choose", name="size", value="radius")
    assert len(jobs) == 1
    edits(page, "press.run", True)
    assert len(jobs) == 2


def test_work_that_is_refused_says_why_and_keeps_the_result(monkeypatch, jobs):
    page = opened(monkeypatch, Automatic)
    finish(*jobs[-1])
    edits(page, "load", 6000)
    finish(*jobs[-1])
    assert "force must be at most 5000 N" in shown(page, "trouble")
    assert shown(page, "numbers") == "9e+06"
    assert "earlier design" in shown(page, "earlier")


@pytest.mark.parametrize(
    ("elapsed", "share", "left"), [(0.5, 0.5, ""), (10.0, 0.25, ", about 30 s left"), (10.0, 0.99, "")]
)
def test_the_time_left_is_that_of_the_share_so_far(elapsed, share, left):
    assert long_view._with_time_left(Reached(share=share, words="wear"), elapsed) == f"wear{left}"


def test_a_store_of_results_is_bounded_in_number_bytes_and_time(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(results.time, "monotonic", lambda: now[0])
    store = ResultStore(max_count=2, max_bytes=1000, seconds=10.0)
    for name in "abc":
        store.put(name, name)
    assert [store.get(name) for name in "abc"] == [None, "b", "c"]
    store.get("b")
    store.put("d", "x" * 500)
    assert store.get("c") is None  # shown longest ago
    store.put("e", "x" * 600)
    assert (store.get("d"), store.get("b")) == (None, None)
    now[0] = 11.0
    assert store.get("e") is None


def test_results_do_not_depend_on_the_name_of_a_design():
    named = replace(START.file, joint=replace(START.file.joint, name="Anna", source="a drawing"))
    for key in (bore_of, orientation_key, partial(gait_key, use=Use(), upload=None), partial(wear_key, use=Use())):
        assert key(named) == key(START.file)
        assert key(replace(named, joint=replace(named.joint, clearance=0.3))) != key(START.file)
