"""The explorer in a browser, in short; with --long every view: its tables at all widths, axe-core, and keys."""

import gzip
from pathlib import Path
from urllib.parse import quote

import pytest

from ballsocket.app.state.screen import VIEWS

from ..places import ROOT
from .browser import AT_REST, NARROW, PICTURES, WIDE, User, opened_profile, pressure, script

AXE = ROOT / "tests" / "data" / "axe" / "axe.min.js.gz"
_VIOLATIONS = script("violations.js")

WIDTHS = (390, 768, 900, 1100, 1280, 1440, 1920)
SIX = "&".join(f"beside{number}.preset=hip-36" for number in range(1, 7))
LONG_NAME = "Acetabular-Component-With-A-Name-Without-Any-Blank-In-It-0123456789"
SCRIPT = quote("<img src=x onerror=ran=1> <script>ran=1</script>")
OWN = "joint.ball_radius=14&joint.clearance=0.1&joint.liner_thickness=5&liner.material=UHMWPE&liner.young=900"
BESIDE = f"beside1.{OWN}&name={SCRIPT}".replace("&", "&beside1.")
NAMED = f"{OWN}&name={LONG_NAME}+{SCRIPT}"
DESIGNS = {
    "failing": f"{NAMED}&load.force=9000&units=imperial&use.cycle=iso-14242-1&{SIX}",
    "invalid": f"{NAMED}&load.force=5000&load.tilt=60+deg&{BESIDE}",
}
FAILING = [(view, "failing") for view in VIEWS]
INVALID = [(view, "invalid") for view in VIEWS if view not in ("gait", "wear", "evidence")]  # whose work takes seconds
MORE = {
    "map": "&limit=max_pressure<=12&limit=outer_diameter<=52&picked=30.5,7.25",
    "evidence": "&ask.limits=max_pressure+<=+12+MPa",
    "wear": "&use.millions=0.1",
}
FITTED = script("fitted.js")
CUT = script("cut.js")


@pytest.fixture(scope="module")
def shown(request, examined_page):
    """A view of a design on one page for all its tests, with the results of its work."""
    view, design = request.param
    examined_page.page.set_viewport_size({"width": WIDE, "height": 900})
    page = examined_page.open(f"?view={view}&{DESIGNS[design]}{MORE.get(view, '')}").page
    finish_work(page, view)
    yield examined_page
    assert not examined_page.errors
    page.evaluate("localStorage.clear()")


def finish_work(page, view):
    """Run the work of a view, and wait for it, but not for the map of orientations, which has no table."""
    run = f"section[data-view={view}] [data-name$='.run']:not([data-name='cup-stood.run'])"
    buttons = f'[...document.querySelectorAll("{run} button")]'
    page.evaluate(  # at once, because a view may begin by itself
        f"{buttons}.filter((one) => one.checkVisibility() && one.innerText != 'Cancel').forEach((one) => one.click())"
    )
    bars = f'[...document.querySelectorAll("{run} progress")]'
    page.wait_for_function(f"() => !{bars}.some((bar) => bar.checkVisibility())")


def pages(cases):
    return pytest.mark.parametrize("shown", cases, indirect=True, ids="-".join, scope="module")


@pytest.mark.long
@pages(FAILING + INVALID)
def test_no_table_is_cut_or_scrolls_sideways_and_script_in_names_is_text(shown):
    page = shown.page
    assert page.locator("#trouble").inner_text() == ""
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(FITTED, width) == width
        assert page.evaluate(CUT) == [], width
        if PICTURES:
            page.screenshot(path=Path(PICTURES) / f"{shown.link()['view']}_{width}.png", full_page=True)
    assert page.evaluate("window.ran") is None
    assert page.locator("img[src=x]").count() == 0


def violations(user):
    """Rules of axe-core that the page breaks; its profile lets scripts pass."""
    user.page.evaluate(gzip.decompress(AXE.read_bytes()).decode())
    return user.page.evaluate(_VIOLATIONS)


@pytest.mark.long
@pages(FAILING)
def test_axe_finds_no_violation_in_either_size_and_theme(shown):
    page = shown.page
    page.locator(".side").evaluate("(side) => { side.open = true; }")
    for width, theme in ((WIDE, "light"), (NARROW, "dark")):
        page.set_viewport_size({"width": width, "height": 900})
        if not page.locator(f".app.{theme}").count():
            page.get_by_role("button", name="Light or dark").click()
        assert page.evaluate(AT_REST) == width
        assert violations(shown) == [], (width, theme)


_REACH = script("reach.js")
_UNREACHED = script("unreached.js")


def reach_all(user):
    """Press Tab until the focus returns to an element that it has been on."""
    user.page.evaluate("document.body.tabIndex = -1, document.body.focus(), document.body.removeAttribute('tabindex')")
    while True:
        user.page.keyboard.press("Tab")
        if not user.page.evaluate(_REACH):
            return


@pytest.mark.long
@pages(FAILING)
def test_everything_that_a_pointer_can_do_has_a_key(shown):
    """Each element to click or drag is a stop of Tab, or has a twin that is; an arrow key moves each handle."""
    page = shown.page
    page.set_viewport_size({"width": WIDE, "height": 900})
    reach_all(shown)
    assert page.locator("[data-reached]").first.text_content() == "Go to the results"
    assert page.locator("[data-reached]").count() > 10
    assert page.evaluate(_UNREACHED) == []
    handles = page.locator("[data-drag][tabindex]:visible")
    for name in dict.fromkeys(handle.get_attribute("data-drag") for handle in handles.all()):
        before = page.url
        page.locator(f"[data-drag='{name}'][tabindex]:visible").first.focus()
        page.keyboard.press("ArrowUp")
        shown.answered()
        assert page.url != before, name


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
