"""The explorer in a browser, in short; with --long its accessibility: axe-core, and keys for what a pointer does."""

import gzip
from itertools import cycle
from pathlib import Path

import pytest

from ballsocket.app.state.screen import VIEWS

from ..places import ROOT
from .browser import AT_REST, NARROW, PICTURES, WIDE, User, opened_profile, pressure, script

AXE = ROOT / "tests" / "data" / "axe" / "axe.min.js.gz"
_VIOLATIONS = """async () => (await axe.run(document, { resultTypes: ["violations"], runOnly: ["wcag2a", "wcag2aa",
  "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] })).violations
  .map((rule) => `${rule.id} (${rule.impact}): ${rule.nodes.map((node) => node.html.slice(0, 200)).join(" | ")}`)"""

_LOOKS = [[(WIDE, "light"), (NARROW, "dark")], [(WIDE, "dark"), (NARROW, "light")]]
"""Both sizes and both themes of each view; every second view has the other pairs of them."""


def violations(user):
    """Rules of axe-core that the page breaks; its profile lets scripts pass."""
    user.page.evaluate(gzip.decompress(AXE.read_bytes()).decode())
    return user.page.evaluate(_VIOLATIONS)


@pytest.mark.long
@pytest.mark.parametrize(("view", "looks"), list(zip(VIEWS, cycle(_LOOKS), strict=False)))
def test_a_page_fits_and_axe_finds_no_violation(examiner, view, looks):
    page = examiner.open(f"?view={view}&beside1.preset=hip-36&use.cycle=iso-14242-1").page
    page.locator(".side").evaluate("(side) => { side.open = true; }")
    for width, theme in looks:
        page.set_viewport_size({"width": width, "height": 900})
        if not page.locator(f".app.{theme}").count():
            page.get_by_role("button", name="Light or dark").click()
        assert page.evaluate(AT_REST) == width
        if PICTURES:
            page.screenshot(path=Path(PICTURES) / f"{view}_{width}_{theme}.png", full_page=True)
        assert violations(examiner) == [], (width, theme)


_REACH = """() => {
  const element = document.activeElement;
  if (!element || element === document.body || element.dataset.reached) return false;
  element.dataset.reached = "yes";
  return true;
}"""
_UNREACHED = script("unreached.js")


def reach_all(user):
    """Press Tab until the focus returns to an element that it has been on."""
    user.page.locator("body").evaluate("() => document.activeElement.blur()")
    while True:
        user.page.keyboard.press("Tab")
        if not user.page.evaluate(_REACH):
            return


@pytest.mark.long
@pytest.mark.parametrize("view", VIEWS)
def test_everything_that_a_pointer_can_do_has_a_key(reader, view):
    """Each element to click or drag is a stop of Tab, or has a twin that is; an arrow key moves each handle."""
    reader.open(f"?view={view}&beside1.preset=hip-36&limit=outer_diameter<=52")
    reach_all(reader)
    assert reader.page.locator("[data-reached]").first.text_content() == "Go to the results"
    assert reader.page.locator("[data-reached]").count() > 10
    assert reader.page.evaluate(_UNREACHED) == []
    handles = reader.page.locator("[data-drag][tabindex]:visible")
    for name in dict.fromkeys(handle.get_attribute("data-drag") for handle in handles.all()):
        before = reader.page.url
        reader.page.locator(f"[data-drag='{name}'][tabindex]:visible").first.focus()
        reader.page.keyboard.press("ArrowUp")
        reader.answered()
        assert reader.page.url != before, name


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
