"""Late, silent and cut lines in a browser: a loss is seen and heals, and unmarked numbers belong to their inputs."""

from functools import lru_cache
from itertools import pairwise
from urllib.parse import urlsplit

import pytest

from .browser import User, explorer_process, opened_line, opened_profile, opened_proxy, pressure, script

pytestmark = pytest.mark.long


@lru_cache
def pressure_of(load, clearance):
    """Largest pressure of the hip for the texts of two boxes, a force and a diametral clearance."""
    return pressure(force=float(load), clearance=float(clearance) / 2)


_RECORD = script("record.js")
"""Record inputs, headline, and the mark that qualifies it, frame by frame."""


def never_contradicts(page):
    """Check that unmarked numbers belong to the inputs, or are marked 0.1 s later.

    The timer of the mark, the frame that shows it and the one before may each be late by a pause of the machine.
    """
    samples, longest, running = page.evaluate("[...window.samples, [performance.now()]]"), 0.0, 0.0
    for (moment, load, clearance, mark, value), (end, *_) in pairwise(samples):
        agrees = mark or float(value) == pytest.approx(pressure_of(load, clearance), rel=1e-6)
        running = 0.0 if agrees else running + end - moment
        longest = max(longest, running)
    return longest < 100 + 3 * page.evaluate("window.longestPause")


def see_loss(user):
    """Wait until the answers are marked and grey."""
    user.page.locator(".app[data-lost]").wait_for()
    assert user.says("Connection lost. These numbers may not belong to the inputs")
    user.until("getComputedStyle(document.querySelector('#view')).opacity < 0.6")


@pytest.mark.parametrize("seconds", [3, 11])  # a page gives up its line after 10 s
def test_a_line_that_is_cut_or_silent_heals_and_never_contradicts(browser, address, seconds):
    """Cut connections end; silent ones stay open without data, as those of a network without signal."""
    with opened_line(browser, address) as (cut, one), opened_line(browser, address) as (silent, other):
        users, before = (one, other), []
        for user in users:
            user.nudge("clearance")
            assert user.shows("max_pressure", pressure_of("3000", "0.21"))
            before.append(user.answered().page.url)
            user.page.evaluate(_RECORD)
        cut.cut()
        silent.stop()
        for user in users:
            see_loss(user)
            box = user.types("load", "3050")
        one.page.wait_for_timeout(1000 * seconds)
        assert box.input_value() == "3050"
        assert other.number("max_pressure") == pytest.approx(pressure_of("3000", "0.21"))
        for proxy in (cut, silent):
            proxy.go_on()
        for user, url in zip(users, before, strict=True):
            assert user.answered().shows("max_pressure", pressure_of("3050", "0.21"))
            assert user.page.url == url.replace("3000", "3050")
            assert not user.page.locator("#lost").inner_text()
            assert never_contradicts(user.page)


_HELD_CLOCK = "performance.now = ((now) => () => window.moment ?? now())(performance.now.bind(performance))"
_MOVE_CLOCK = script("move_clock.js")


def test_a_loss_is_seen_after_two_seconds_of_silence_by_the_clock_of_the_page(browser, address):
    with opened_proxy(address) as proxy, opened_profile(browser, proxy.address) as profile:
        user = User(profile, proxy.address)
        user.page.add_init_script(_HELD_CLOCK)
        user.open()
        start = 1e6
        user.page.evaluate(_MOVE_CLOCK, start)
        user.nudge("clearance")
        assert user.answered().shows("max_pressure", pressure(clearance=0.105))
        proxy.stop()
        assert [user.page.evaluate(_MOVE_CLOCK, start + ms) for ms in (500, 1900, 2100)] == [False, False, True]
        proxy.go_on()
        user.page.evaluate("window.moment = undefined")
        user.answered()


def test_quick_keys_on_a_handle_add_up_and_a_number_keeps_its_unit(browser, address):
    with opened_line(browser, address) as (proxy, user):
        proxy.stop()
        user.page.locator("[tabindex][data-drag=load]").first.focus()
        for _ in range(6):
            user.page.keyboard.press("ArrowUp")
        proxy.go_on()
        assert user.answered().number("force") == 3300
        proxy.stop()
        user.page.locator("[data-name=units] label", has_text="in, lbf, psi").click()
        user.types("ball_radius", "30")
        proxy.go_on()
        user.answered()
        assert "units=imperial" in user.page.url
        assert "joint.ball_radius=15.0" in user.page.url


def test_late_answers_are_marked_until_they_belong_to_the_inputs(browser, address):
    """With answers 0.4 s late, numbers are marked as updating from 0.1 s after a change on."""
    with opened_line(browser, address) as (proxy, user):
        page = user.page
        proxy.delay = 0.4
        page.evaluate(_RECORD)
        for number in range(9):
            user.nudge(("load", "clearance")[number % 2], ("ArrowRight", "ArrowLeft")[number // 3 % 2])
            page.wait_for_timeout((50, 150, 700)[number % 3])
        user.answered()
        assert any(mark == "updating" for _, _, _, mark, *_ in page.evaluate("window.samples"))
        assert never_contradicts(page)


def test_a_server_that_is_killed_and_started_again_heals(browser):
    """The page comes back by itself with all that the link holds, and applies what was typed meanwhile."""
    with explorer_process() as (address, process), opened_profile(browser, address) as profile:
        user = User(profile, address).open()
        user.nudge("clearance")
        assert user.answered().shows("max_pressure", pressure(clearance=0.105))
        user.view("Gait")
        table = b"phase [%], force [N]\n0, 300\n25, 900\n50, 1500\n75, 900\n100, 300\n"
        user.page.locator("#gait-own").set_input_files({"name": "walk.csv", "mimeType": "text/csv", "buffer": table})
        assert user.says("A link does not hold walk.csv")
        process.kill()
        process.wait()
        see_loss(user)
        box = user.types("load", "2600")
        with explorer_process("--port", str(urlsplit(address).port)):
            user.answered()
            assert box.input_value() == "2600"
            assert "load.force=2600" in user.page.url
            largest = user.page.locator("#gait-numbers", has_text="1500")
            largest.wait_for()  # the browser sent the table again
            user.page.reload()
            user.answered()
            largest.wait_for()
            user.view("Contact")
            assert user.shows("max_pressure", pressure(force=2600.0, clearance=0.105))
            user.open("?view=gait")  # another link does not get it
            assert user.page.locator("text=walk.csv").count() == 0
            assert not user.errors


def test_a_load_slider_is_answered_from_the_curve_of_the_joint_until_the_server_confirms(browser, address):
    with opened_line(browser, address) as (proxy, user):
        user.page.locator("#press-charts svg").first.wait_for()  # the curve comes with them
        numbers = user.page.locator("#press-numbers")
        cell = numbers.locator("dd[data-name=max_pressure]")

        def shown():
            return float(cell.evaluate("(cell) => cell.firstChild.nodeValue"))

        proxy.stop()
        user.nudge("load", times=3)
        assert shown() == pytest.approx(pressure(force=3150.0), rel=1e-3)  # between 40 points
        assert numbers.get_attribute("data-quick") == "yes"
        user.nudge("clearance")
        user.nudge("load")  # now of another joint, whose curve is not here
        assert shown() == pytest.approx(pressure(force=3150.0), rel=1e-3)
        proxy.go_on()
        assert user.answered().shows("max_pressure", pressure(force=3200.0, clearance=0.105))
        assert numbers.get_attribute("data-quick") is None
