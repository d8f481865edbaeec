"""A lost connection in a real browser: it is seen, nothing typed is lost, and it heals."""

import signal
import time
from dataclasses import replace
from urllib.parse import urlsplit

import pytest

import ballsocket as bs

from .browser import explorer_process
from .user import User, opened_profile

HIP = bs.joints["hip-28"]
LOST = "Connection lost. These numbers may not belong to the inputs"


def pressure(force, **changes):
    return bs.Exact().press(replace(HIP, **changes), force=force).max_pressure


@pytest.fixture
def alone(browser):
    """Somebody with a server of their own, and its process."""
    with explorer_process() as (address, process), opened_profile(browser, address) as profile:
        yield User(profile, address).open(), process


def see_loss(user):
    """Wait until the answers are marked and grey."""
    user.until("document.body.dataset.lost === 'yes'")
    user.says(LOST)
    opacity = user.page.locator("#view").evaluate("(view) => Number(getComputedStyle(view).opacity)")
    assert opacity < 0.6


def pause(user, process, seconds):
    """Stop the server for a time, in which the user types; its answer follows."""
    user.types("load", "2500")
    assert user.answered().shows("max_pressure", pressure(2500.0))
    process.send_signal(signal.SIGSTOP)
    start = time.monotonic()
    try:
        see_loss(user)
        box = user.types("load", "2000")
        user.types("clearance", "0.3")
        time.sleep(max(0.0, seconds - (time.monotonic() - start)))
        assert box.input_value() == "2000"
        assert user.number("max_pressure") == pytest.approx(pressure(2500.0))
    finally:
        process.send_signal(signal.SIGCONT)
    assert user.answered().shows("max_pressure", pressure(2000.0, clearance=0.15))
    assert not user.page.locator("#lost").inner_text()
    assert "load.force=2000" in user.page.url


def test_a_server_that_pauses_is_seen_and_heals(alone):
    pause(*alone, 4.0)


@pytest.mark.long
def test_a_pause_longer_than_a_ping_of_the_server_heals(alone):
    """After 20 s without a browser's answer the server closes the connection; the page has opened others before."""
    pause(*alone, 25.0)


def test_a_server_that_is_killed_and_started_again_heals(alone):
    """The page comes back by itself with all that the link holds, and applies what was typed meanwhile."""
    user, process = alone
    user.nudge("clearance")
    assert user.answered().shows("max_pressure", pressure(3000.0, clearance=0.105))
    user.view("Cup")
    process.kill()
    process.wait()
    see_loss(user)
    box = user.types("load", "2600")
    port = str(urlsplit(user.address).port)
    with explorer_process("--port", port):
        user.answered()
        assert box.input_value() == "2600"
        assert "load.force=2600" in user.page.url
        user.view("Contact")
        assert user.shows("max_pressure", pressure(2600.0, clearance=0.105))
        assert not user.errors


@pytest.mark.long
def test_an_uploaded_cycle_is_sent_again(alone):
    """A link does not hold it: the browser does."""
    user, process = alone
    user.view("Gait")
    table = b"phase [%], force [N]\n0, 300\n50, 1500\n100, 300\n"
    user.page.locator("#gait-own").set_input_files({"name": "walk.csv", "mimeType": "text/csv", "buffer": table})
    assert user.says("walk.csv: a link does not hold it")
    process.kill()
    process.wait()
    see_loss(user)
    with explorer_process("--port", str(urlsplit(user.address).port)):
        user.until("!document.body.dataset.lost")
        user.answered()
        assert user.says("walk.csv: a link does not hold it")
        user.page.reload()  # this window keeps the table
        user.answered()
        assert user.says("walk.csv: a link does not hold it")
        user.open("?view=gait")  # another link does not get it
        assert user.page.locator("text=walk.csv").count() == 0
        assert not user.errors


@pytest.mark.long
def test_a_loss_is_seen_after_two_seconds_and_a_busy_server_is_none(alone):
    """Measured on the page: from the last answer of a stopped server to the mark."""
    user, process = alone
    for _ in range(3):
        user.page.evaluate("""() => {
          window.lostAt = 0;
          new MutationObserver(() => { window.lostAt = window.lostAt || performance.now(); })
            .observe(document.body, { attributeFilter: ["data-lost"] });
        }""")
        before = user.page.evaluate("performance.now()")
        process.send_signal(signal.SIGSTOP)
        after = user.page.evaluate("performance.now()")  # a busy machine may take its time for the signal
        user.until("window.lostAt > 0")
        lost = user.page.evaluate("window.lostAt")
        assert lost - before > 1500
        assert lost - after < 2300
        process.send_signal(signal.SIGCONT)
        user.until("!document.body.dataset.lost")
        user.page.evaluate("window.lostAt = 0")
        process.send_signal(signal.SIGSTOP)
        time.sleep(1.0)
        process.send_signal(signal.SIGCONT)
        user.nudge("clearance")
        user.answered()
        assert user.page.evaluate("window.lostAt") == 0
