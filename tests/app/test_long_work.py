"""Answers that take long: processes that wait their turn and can be ended, and the views that show their results."""

import operator
import os
import re
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest

import ballsocket as bs
from ballsocket.app import long_view, results, running, session, solving
from ballsocket.app.jobs import Job
from ballsocket.app.long_view import LongView, long_body
from ballsocket.app.pressing import pressed
from ballsocket.app.results import ResultStore
from ballsocket.app.running import Reached, Run, RunFinished, RunRefused
from ballsocket.app.session import Page
from ballsocket.app.solving import heavy, solved_curve
from ballsocket.app.state.screen import START
from ballsocket.app.state.use import Use
from ballsocket.app.view import Document
from ballsocket.app.views.contact import Press
from ballsocket.app.views.hip_runs import gait_key, wear_key
from ballsocket.app.views.real_cup import bore_of, orientation_key
from ballsocket.comparison import THIN_LINER_RATIO
from ballsocket.design_checks import checks_of
from ballsocket.elasticity.exact.model import Exact
from ballsocket.files.joint_file import JointFile
from ballsocket.model_catalogue import JUDGE
from ballsocket.models.plane_layer import PlaneLayer
from ballsocket.problem.cup import Cup

from ..extent import some
from ..processes import PATIENCE, wait_until
from .asking import does, edits, numbers, read_message, saved, told

HIP = bs.joints["hip-28"]


def link(ratio, poisson=0.3, clearance=0.1, **more):
    joint = {"ball_radius": 20 - clearance, "clearance": clearance, "liner_thickness": 20 / ratio}
    words = {f"joint.{name}": value for name, value in joint.items()}
    words |= {"liner.young": 800, "liner.poisson": poisson, "load.half_angle": 60, **more}
    return "&".join(f"{name}={value}" for name, value in words.items())


def waited_for(page):
    """Until nothing is being solved for a page."""
    job = page._slow_presses.job
    wait_until(lambda: job.hear() or not job.works)


@pytest.fixture(autouse=True)
def nothing_is_left_running():
    results.RESULTS._results.clear()
    yield
    assert not running.QUEUE


def presses_of(monkeypatch):
    seen = []
    for kind in (Exact, PlaneLayer):
        own = kind._solve
        noted = lambda self, joint, *rest, own=own: seen.append(joint) or own(self, joint, *rest)  # noqa: E731
        monkeypatch.setattr(kind, "_solve", noted)
    return seen


SLOW = [
    link(190, 0.4999, **{"load.half_angle": 80}),
    link(99, shown=",".join(bs.catalogue)),
    link(150, view="compare"),
    "view=compare&" + link(THIN_LINER_RATIO * 1.01, **{"beside1.preset": "hip-36"}),
]


@pytest.mark.parametrize("query", some(SLOW))
def test_a_link_to_thin_liners_does_not_hold_the_server(query, monkeypatch):
    seen = presses_of(monkeypatch)
    page = Page(query)
    page.leave()
    assert not page.channel.shown_value("#trouble")
    assert all(float(joint.thickness_ratio) <= THIN_LINER_RATIO for joint in seen)
    said = told(page, "press-table") or told(page, "compare-table")
    assert "Computing exact: at R2/L = " in said


def test_joints_as_people_make_them_are_pressed_at_once_but_a_thin_sheet():
    waited = {preset for preset, joint in bs.joints.items() for name in bs.catalogue if heavy(joint, name)}
    assert waited == {"spherical-bearing"}


@pytest.mark.long
def test_what_was_solved_elsewhere_is_what_a_press_answers():
    page = Page(link(THIN_LINER_RATIO * 1.2, answered_by="plane-layer"))
    waited_for(page)
    joint = page.screen.file.joint
    for name in ("exact", "plane-layer"):
        seen, own = pressed(page.screen.file, (name,))[name], bs.catalogue[name].press(joint, **page.screen.file.load)
        for quantity in ("force", "indentation", "max_pressure", "area", "stiffness", "energy", "foundation_modulus"):
            assert getattr(seen, quantity) == pytest.approx(getattr(own, quantity), rel=1e-10)
        for share in (0.0, 0.3, 0.9, 1.1):
            angle = share * own.half_angle
            assert seen.pressure(angle) == pytest.approx(own.pressure(angle), abs=2e-3 * own.max_pressure)
        assert seen.notes == own.notes
        assert solved_curve(seen).half_angle[-1] > own.half_angle
    assert numbers(page, "press-numbers")["max_pressure"] == seen.max_pressure
    assert saved(page, "PNG").startswith(b"\x89PNG")
    assert b"exact" in saved(page, "CSV")


def test_what_takes_too_long_is_ended_and_said(monkeypatch):
    monkeypatch.setattr(solving, "PRESS_SECONDS", 0.01)
    page = Page(link(190))
    waited_for(page)
    words = "exact has no result here: stopped after 0.01 s of processor time, the limit of a run"
    assert words in told(page, "press-numbers")
    assert "hess-forsbach" in told(page, "press-table")
    again = Page(link(190))
    assert not again._slow_presses.job.works
    assert words in told(again, "press-numbers")


BUSY = partial(operator.countOf, range(10**18))
"""Work of hours."""


def test_a_run_that_waits_for_the_processor_goes_on_and_one_that_hangs_ends(monkeypatch):
    """The clock and the processor time are stated here: 60 s are a limit of the processor, 660 s one of the clock."""
    now, used = [0.0], [0.0]
    monkeypatch.setattr(running, "time", SimpleNamespace(monotonic=lambda: now[0]))
    monkeypatch.setattr(running, "processor_seconds", lambda pid: used[0])
    ends = (61.0, 61.0, "60 s of processor time, the"), (661.0, 59.0, "661 s without a result")
    for seconds, processor, why in ends:
        run, now[0], used[0] = Run(BUSY), 0.0, 0.0
        assert run.news() is None
        now[0], used[0] = 659.0, 59.0
        assert run.news() is None
        now[0], used[0] = seconds, processor
        assert why in run.news().why


def test_a_worker_that_waits_takes_the_next_run_and_one_that_has_ended_takes_none():
    workers = running.Workers()
    workers.prepare()
    waiting, _ = workers._ready
    workers.prepare()  # one is enough
    process, pipe = workers.take()
    assert process is waiting
    pipe.send(partial(operator.add, 1))  # a run calls its work with a function for news
    assert isinstance(pipe.recv(), RunRefused)
    process.join()
    workers.prepare()
    ended = workers._ready[0]
    ended.kill()
    ended.join()
    process, _ = workers.take()
    assert process.is_alive()
    assert process is not ended
    process.kill()
    process.join()
    workers.prepare()
    waiting = workers._ready[0]
    workers.close()
    assert not waiting.is_alive()


def test_the_process_of_a_finished_run_waits_for_the_next_unless_it_has_grown_large(monkeypatch):
    run = Run(callable)
    run.news()
    process = run._process
    assert isinstance(until_the_end(run)[-1], RunFinished)
    ready, pipe = running.WORKERS.take()
    assert ready is process
    pipe.send(callable)
    assert isinstance(pipe.recv(), RunFinished)
    monkeypatch.setattr(running, "MAX_KEPT_MEMORY", 1_000_000)
    running.WORKERS.give_back(process, pipe)
    assert not process.is_alive()


def test_processor_time_includes_that_of_children():
    before = running.processor_seconds(os.getpid()) - time.process_time()
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as busy:
        wait_until(lambda: running.processor_seconds(os.getpid()) - time.process_time() > before + 0.2)
        busy.kill()
    assert running.processor_seconds(busy.pid) == 0.0


def test_only_what_is_on_the_screen_is_solved():
    """A slider that moves on, or leads back, ends what was asked for before."""
    page = Page(link(190))
    first = page._slow_presses.job._run
    page._slow_presses.job.hear()
    page.ask(file=JointFile(page.screen.file.joint, {"force": 100.0}))
    assert page._slow_presses.job._run is not first
    assert not first._process.is_alive()
    page.ask(file=JointFile(HIP, {"force": 100.0}))
    assert not page._slow_presses.job.works


def test_a_client_that_only_looks_makes_nothing_work(served, monkeypatch):
    """The answer to a request is a page without numbers; they are computed when a browser has opened it."""
    shown, seen = [], presses_of(monkeypatch)
    monkeypatch.setattr(Press, "show", lambda self, screen: shown.append(screen))
    address = f"http://127.0.0.1:{served.port}/?{link(190)}"
    for method in ("HEAD", "GET"):
        request = HTTPRequest(address, method=method, request_timeout=PATIENCE)
        served.io_loop.run_sync(lambda request=request: AsyncHTTPClient().fetch(request, raise_error=False))
    assert [*served.pages, *shown, *seen] == []


def until_the_end(run):
    heard = []
    wait_until(lambda: heard.append(run.news()) or isinstance(heard[-1], RunFinished | RunRefused))
    return [news for news in heard if news is not None]


def judging(force, yields=False, **cup):
    from ballsocket.app.views.finite_elements import run_finite_elements

    return Run(partial(run_finite_elements, JointFile(HIP, {"force": force}, Cup(**cup)), yields=yields))


@pytest.mark.long
def test_a_run_with_a_yielding_liner_has_its_set_and_its_checks():
    found = until_the_end(judging(6000.0, yields=True))[-1].value
    contact = bs.FiniteElement(plastic=True).press(HIP, force=6000.0)
    assert found.numbers["permanent_set"] == pytest.approx(contact.permanent_set, rel=1e-3)  # rounded for JSON
    assert "collapse load" in [row.limit for row in found.checks]
    assert found.numbers.keys() - found.exact.keys() >= {"permanent_set", "plastic_fraction", "repeated_work"}
    page = Page("view=judge&liner_law=yielding")
    assert page.channel.shown_value("=judge.liner_law")["value"] == "yielding"
    edits(page, "judge.liner_law", "elastic")
    assert "liner_law" not in page.screen.link


@pytest.mark.long
def test_a_run_beyond_the_collapse_load_says_how_far():
    sentence = until_the_end(judging(2e5, yields=True))[-1].why
    share = float(re.search(r"Exceeded: normal force is ([\d.]+) times the collapse load", sentence)[1])
    safe = bs.FiniteElement(plastic=True).press(HIP, force=6000.0)
    collapse = next(row.capacity for row in checks_of(safe, Cup()) if row.limit == "collapse load")
    assert share == pytest.approx(2e5 / collapse, rel=0.01)


@pytest.mark.long
def test_a_run_answers_what_a_press_answers():
    *on_the_way, last = until_the_end(judging(3000.0))
    found = last.value
    shares = [news.share for news in on_the_way]
    assert shares == sorted(shares)
    assert all(isinstance(news, Reached) for news in on_the_way)
    contact = bs.FiniteElement().press(HIP, force=3000.0)
    assert found.numbers["max_pressure"] == pytest.approx(contact.max_pressure, rel=1e-3)
    assert found.exact["max_pressure"] == pytest.approx(bs.Exact().press(HIP, force=3000.0).max_pressure)
    angle, pressure = found.pressures[JUDGE]
    assert pressure[0] == pytest.approx(contact.pressure(0.0), rel=1e-3)
    assert angle[-1] == pytest.approx(contact.half_angle, rel=1e-3)
    assert all(drawn.startswith(b"\x89PNG") for drawn in found.figures["png"].values())
    assert all(b"<svg" in drawn for drawn in found.figures["svg"].values())
    assert len(found.drawing) == 2
    for drawing in found.drawing.values():  # on the page: no style of its own, and ink of its theme
        assert "<style" not in drawing
        assert "var(--text)" in drawing
    refused = until_the_end(judging(3000.0, arc_of_cover=0.75, chamfer=9.0))[-1]  # cannot be meshed
    assert isinstance(refused, RunRefused)
    assert "chamfer" in refused.why


def test_a_process_that_dies_or_cannot_be_started_is_said_and_one_that_is_stopped_gives_its_place_back(monkeypatch):
    died, stopped = (Run(BUSY) for _ in range(2))
    died.news()
    died._process.kill()
    assert "the process ended unexpectedly, perhaps for lack of memory" in until_the_end(died)[-1].why
    stopped.news()
    stopped.stop()
    stopped.stop()
    assert not stopped._process.is_alive()

    def take():
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(running.WORKERS, "take", take)
    assert Run(callable).news() == RunRefused(why="no process could be started: Resource temporarily unavailable")


def test_runs_wait_their_turn_in_the_order_in_which_they_came(monkeypatch):
    monkeypatch.setattr(running, "MAX_AT_WORK", 1)
    first, second, third = (Run(callable) for _ in range(3))
    first.news()
    for run in (second, third):
        assert run.news().words == "waiting: other computations are running"
    second.stop()
    assert isinstance(until_the_end(first)[-1], RunFinished)
    assert isinstance(until_the_end(third)[-1], RunFinished)


def square(force, report):
    report(Reached(share=0.5, words="squaring"))
    if force > 5000:
        raise ValueError("force must be at most 5000 N")
    return force**2


class Square(LongView):
    """View whose result is the square of the force."""

    name, title, run_label = "press", "Square", "Square the force"
    body = long_body("press", "<div id='press-numbers'></div>")

    def question_of(self, screen):
        return screen.file.load["force"]

    def work(self, screen):
        return partial(square, screen.file.load["force"])

    def document(self, screen):
        return Document(rows=list, sections=dict)

    def show_result(self, screen, result):
        self.page.channel.put("#press-numbers", "" if result is None else f"{result:g}")


@pytest.fixture
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


def opened(monkeypatch, automatic=False):
    monkeypatch.setattr(session, "view_class", lambda name: Square)
    monkeypatch.setattr(Square, "automatic", automatic)
    return Page("")


def shown(page, element):
    return page.channel.shown_value(f"#press-{element}") or ""


def test_work_runs_once_for_all_pages_and_a_change_of_inputs_keeps_the_result_with_a_mark(monkeypatch, jobs):
    page = opened(monkeypatch)
    assert page.channel.shown_value("=press.run")["label"] == "Square the force"
    assert len(jobs) == 1  # the first result comes by itself
    with pytest.raises(ValueError, match="press 'Square the force' first"):
        page.view.result(page.screen)
    assert page.channel.shown_value("=press.run")["share"] == 0.0
    messages, seen = [], dict(page.channel._sent)
    page.channel.write = lambda text: messages.append(read_message(text, seen))
    finish(*jobs[-1])
    assert "squaring" in messages[0]["=press.run"]["words"]
    assert shown(page, "numbers") == "9e+06"
    assert page.channel.shown_value("=press.run")["share"] is None
    edits(page, "load", 2000)
    assert "belong to earlier inputs" in shown(page, "earlier")
    assert shown(page, "numbers") == "9e+06"
    assert len(jobs) == 1
    edits(page, "load", 3000)
    assert shown(page, "earlier") == ""
    assert page.view.result(page.screen) == 9e6
    assert len(jobs) == 1
    page = Page("")  # the next that asks for it
    assert shown(page, "numbers") == "9e+06"
    edits(page, "press.run", True)
    assert len(jobs) == 1
    assert page.channel.shown_value("=press.run")["share"] is None


def test_work_that_is_cancelled_ends_and_is_not_begun_again_by_itself(monkeypatch, jobs):
    page = opened(monkeypatch, automatic=True)
    assert len(jobs) == 1
    answer = edits(page, "press.run", False)["=press.run"]
    assert (answer["share"], answer["words"]) == (None, "Cancelled.")
    does(page, "edit", name="size", value="radius")
    assert len(jobs) == 1
    edits(page, "press.run", True)
    assert len(jobs) == 2


def test_work_that_is_refused_says_why_and_keeps_the_result(monkeypatch, jobs):
    page = opened(monkeypatch, automatic=True)
    finish(*jobs[-1])
    edits(page, "load", 6000)
    finish(*jobs[-1])
    assert "force must be at most 5000 N" in shown(page, "trouble")
    assert shown(page, "numbers") == "9e+06"
    assert "earlier inputs" in shown(page, "earlier")


def test_the_time_left_is_that_of_the_share_so_far(monkeypatch, jobs):
    page, now = opened(monkeypatch), [100.0]
    monkeypatch.setattr(long_view, "time", SimpleNamespace(monotonic=lambda: now[0]))
    edits(page, "press.run", True)
    job, key, _ = jobs[-1]
    for elapsed, share, left in ((0.5, 0.5, ""), (10.0, 0.25, ", about 30 s left"), (10.0, 0.99, "")):
        now[0] = 100.0 + elapsed
        job._heard(key, Reached(share=share, words="wear"))
        assert page.channel.shown_value("=press.run")["words"] == f"wear{left}"


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
