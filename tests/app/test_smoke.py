"""The explorer in a browser, in short; its other tests with a browser run with --long."""

from .browser import User, opened_profile, pressure
from .test_accessibility import violations


def test_a_slider_moves_the_answer_and_a_link_brings_it_back_on_a_page_for_all(browser, address):
    with opened_profile(browser, address, bypass_csp=True) as profile:
        user = User(profile, address).open()
        assert user.shows("max_pressure", pressure())
        user.nudge("clearance")
        assert user.answered().shows("max_pressure", pressure(clearance=0.105))
        user.page.locator("#share").click()
        assert user.says("copied")
        link = user.page.evaluate("navigator.clipboard.readText()")
        user.open(link.removeprefix(address))
        assert user.shows("max_pressure", pressure(clearance=0.105))
        assert violations(user) == []
        assert not user.errors
