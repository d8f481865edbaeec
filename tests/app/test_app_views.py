"""The other views in a real browser: maps, joints side by side, finite elements; and that every page fits."""

import os
import re
from dataclasses import replace
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

import ballsocket as bs

from ..extent import some
from .user import AT_REST, NARROW, PICTURES, WIDE, User, opened_profile

pytest.importorskip("panel", reason="the explorer's extra is not installed")
from ballsocket.app.state.screen import VIEWS

expect = pytest.importorskip("playwright.sync_api", reason="playwright is not installed").expect

HIP = bs.joints["hip-28"]
pytestmark = pytest.mark.xdist_group("browser")  # one server and one browser for all of them


@pytest.mark.long
def test_a_click_on_the_map_presses_the_joint_that_is_there(user):
    user.open("?view=map&limit=outer_radius<=26")
    box = user.map()
    user.page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    user.page.locator("dd[data-name=max_pressure]").wait_for()
    user.page.wait_for_function("!window.location.search.includes('view=map')")
    words = parse_qs(urlsplit(user.page.url).query)
    radius, thickness = (float(words[f"joint.{name}"][0]) for name in ("ball_radius", "liner_thickness"))
    assert 11 < radius < 23
    assert 3 < thickness < 15
    there = replace(HIP, ball_radius=radius, liner_thickness=thickness)
    assert user.shows("max_pressure", bs.Exact().press(there, force=3000.0).max_pressure)


@pytest.mark.long
def test_the_best_joint_of_a_map_is_pressed(user):
    user.open("?view=map&limit=outer_radius<=26")
    box = user.map()
    user.page.mouse.click(box["x"] + 5, box["y"] + 0.5 * box["height"])  # beside the map: nothing there
    user.page.locator(".bk-btn", has_text="Press the best joint").click()
    user.page.locator("dd[data-name=max_pressure]").wait_for()
    assert user.number("max_pressure") < 10.5


def test_a_cup_that_is_none_is_refused_and_the_box_shows_what_is_meant(user):
    user.open("?view=judge")
    box = user.page.get_by_label("Arc of cover [°]")
    box.fill("20")
    box.press("Enter")
    assert user.says("arc_of_cover = 20")
    expect(box).to_have_value("180")


def test_a_limit_that_is_none_is_refused_in_words(user):
    user.open("?view=map")
    box = user.page.get_by_label("Limits, with commas")
    box.fill("outer_radios<=26 mm")
    box.press("Enter")
    assert user.says("did you mean 'outer_radius'?")


@pytest.mark.long
def test_joints_stand_side_by_side(user):
    user.open("?view=compare")
    user.page.get_by_label("Put beside").select_option("hip-36")
    assert user.says("Take hip-36 away")
    cells = user.page.locator("tr", has_text="largest pressure pmax").locator("td")
    expected = bs.Exact().press(bs.joints["hip-36"], force=3000.0).max_pressure
    share = bs.Exact().press(HIP, force=3000.0).max_pressure / expected - 1
    expect(cells.nth(2)).to_have_text(f"{expected:.4g}")
    expect(cells.nth(1)).to_have_text(re.compile(re.escape(f"({100 * share:+.0f} %)") + "$"))
    user.page.locator(".bk-btn", has_text="Put this joint beside").click()
    assert user.says("Take hip-28 away")
    user.page.locator(".bk-btn", has_text="Take hip-36 away").click()
    user.page.locator("text=Take hip-36 away").wait_for(state="hidden")


@pytest.mark.long
def test_elements_run_beside_others_who_go_on(user, other):
    """A run answers, another is stopped, and somebody else's page answers before the run does."""
    pytest.importorskip("skfem")
    user.open("?view=judge")
    other.open()
    user.page.locator(".bk-btn", has_text="Run finite elements").click()
    user.page.locator(".bk-btn", has_text="Stop").wait_for()
    other.nudge("clearance")
    assert other.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    picture = user.page.locator("img[alt^='mesh, von Mises']")
    assert not picture.is_visible()
    picture.wait_for()
    row = user.page.locator("tr", has_text="largest pressure pmax").locator("td")
    contact = bs.FiniteElement().press(HIP, force=3000.0)
    assert float(row.nth(1).inner_text()) == pytest.approx(contact.max_pressure, rel=1e-3)
    assert user.saved("PNG").startswith(b"\x89PNG")
    user.nudge("clearance")
    assert user.says("The joint has changed since this run.")
    user.page.locator(".bk-btn", has_text="Run finite elements").click()
    user.page.locator(".bk-btn", has_text="Stop").click()
    assert user.says("Stopped.")


def test_elements_that_cannot_be_built_say_why(user):
    pytest.importorskip("skfem")
    user.open("?view=judge&preset=hip-28&load.force=3000&cup.arc_of_cover=60&cup.chamfer=9")
    user.page.locator(".bk-btn", has_text="Run finite elements").click()
    user.page.locator("[role=alert]:visible").first.wait_for()


PAGES = [
    *(("user", view) for view in ("press", "compare", "judge", "map")),
    *(("reader", view) for view in ("press", "cup", "gait", "wear", "evidence", "compare", "judge", "map")),
]


@pytest.mark.parametrize(("someone", "view"), some(PAGES, 2))
def test_pages_fit_and_are_kept_as_pictures(request, someone, view):
    who, dark = request.getfixturevalue(someone), someone == "reader"
    who.open(f"?view={view}&beside1.preset=hip-36")
    who.page.wait_for_function(f"!!document.querySelector('.app.dark') === {str(dark).lower()}")
    width = who.page.evaluate(AT_REST)
    assert width <= (NARROW if dark else WIDE)
    PICTURES.mkdir(parents=True, exist_ok=True)
    who.page.screenshot(path=PICTURES / f"{view}_{width}_{'dark' if dark else 'light'}.png", full_page=True)
    assert not who.errors


AXE = Path(os.environ.get("BALLSOCKET_AXE", "node_modules/axe-core/axe.min.js"))
FAULTS = """async () => (await axe.run(document, { resultTypes: ["violations"] })).violations
  .filter((one) => ["serious", "critical"].includes(one.impact))
  .map((one) => `${one.id}: ${one.nodes[0].html}`)"""


@pytest.mark.long
@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm install axe-core")
@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("dark", [False, True])
def test_no_page_has_a_serious_fault_of_accessibility(browser, address, view, dark):
    with opened_profile(browser, address, NARROW if dark else WIDE, dark, bypass_csp=True) as one:
        who = User(one, address).open(f"?view={view}&beside1.preset=hip-36")
        who.page.locator(".side").evaluate("(side) => { side.open = true; }")
        assert who.page.evaluate(AT_REST) == (NARROW if dark else WIDE)
        who.page.evaluate(AXE.read_text())
        assert who.page.evaluate(FAULTS) == []


@pytest.mark.long
def test_on_a_telephone_no_column_of_the_models_lies_beside_the_screen(reader):
    reader.open()
    table = reader.page.locator(".models")
    table.wait_for()
    assert table.evaluate("(one) => one.scrollWidth <= one.clientWidth")
    assert "pmax" in table.locator("td[data-head*=pmax]").first.evaluate(
        "(one) => getComputedStyle(one, '::before').content"
    )
