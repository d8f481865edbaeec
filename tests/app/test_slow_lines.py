"""Late and cut connections in a browser: an answer stands unmarked only beside the inputs that it belongs to."""

from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache

import pytest

import ballsocket as bs

from ..extent import either
from .proxy import opened_proxy
from .sampling import longest_contradiction, longest_pause, record, samples_of
from .user import User, opened_profile

_SLACK = 1000
"""ms that a busy machine may add."""


@contextmanager
def opened_line(browser, address):
    """Somebody with an open page, behind a proxy of their own."""
    with opened_proxy(address) as proxy, opened_profile(browser, proxy.address) as profile:
        yield proxy, User(profile, proxy.address).open()


@lru_cache
def pressure(load, clearance):
    """Largest pressure of the hip for the texts of two boxes, a force and a diametral clearance."""
    joint = replace(bs.joints["hip-28"], clearance=float(clearance) / 2)
    return float(bs.Exact().press(joint, force=float(load)).max_pressure)


@pytest.mark.parametrize("seconds", either((4,), (4, 15)))  # a page gives up its line after 10 s
def test_a_line_that_is_cut_or_silent_heals_and_never_contradicts(browser, address, seconds):
    """Cut connections end; silent ones stay open without data, as those of a network without signal."""
    with opened_line(browser, address) as (cut, one), opened_line(browser, address) as (silent, other):
        users, before = (one, other), []
        for user in users:
            user.nudge("clearance")
            assert user.shows("max_pressure", pressure("3000", "0.21"))
            before.append(user.answered().page.url)
            record(user.page)
        cut.cut()
        silent.stop()
        for user in users:
            user.page.locator(".app[data-lost]").wait_for()
            assert user.page.locator("#lost").inner_text()
            user.nudge("load")
        one.page.wait_for_timeout(1000 * seconds)
        for proxy in (cut, silent):
            proxy.go_on()
        for user, url in zip(users, before, strict=True):
            assert user.answered().shows("max_pressure", pressure("3050", "0.21"))
            assert user.page.url == url.replace("3000", "3050")
            assert longest_contradiction(samples_of(user.page), pressure) < 100 + _SLACK


def test_quick_keys_on_a_handle_add_up_and_a_number_keeps_its_unit(browser, address):
    """With answers 0.4 s late: six steps of 50 N, then inches are chosen and millimetres are typed before they come."""
    with opened_line(browser, address) as (proxy, user):
        proxy.delay = 0.4
        user.page.locator("[tabindex][data-drag=load]").first.focus()
        for _ in range(6):
            user.page.keyboard.press("ArrowUp")
        assert user.answered().number("force") == 3300
        user.page.locator("[data-name=units] label", has_text="in, lbf, psi").click()
        user.types("ball_radius", "30")
        user.answered()
        assert "units=imperial" in user.page.url
        assert "joint.ball_radius=15.0" in user.page.url


def test_late_answers_are_marked_until_they_belong_to_the_inputs(browser, address):
    """With answers 0.4 s late, numbers are marked as updating from 0.1 s after a change on."""
    with opened_line(browser, address) as (proxy, user):
        page = user.page
        proxy.delay = 0.4
        record(page)
        for number in range(either(9, 30)):
            user.nudge(("load", "clearance")[number % 2], ("ArrowRight", "ArrowLeft")[number // 3 % 2])
            page.wait_for_timeout((50, 150, 700)[number % 3])
        user.answered()
        samples = samples_of(page)
        assert any(sample.updating for sample, _ in samples)
        assert longest_contradiction(samples, pressure) < 100 + 200 + longest_pause(page)
