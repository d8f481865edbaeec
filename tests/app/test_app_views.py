"""The other views in a real browser: maps, joints side by side, finite elements; and that every page fits."""

import re
from pathlib import Path

import pytest

import ballsocket as bs

from .user import AT_REST, NARROW, PICTURES, WIDE, expect, pressure

pytestmark = pytest.mark.long
HIP = bs.joints["hip-28"]


def spot(user, across, up):
    """The point of the screen at two shares of the map."""
    frame = user.page.locator("#map-picture .frame")
    frame.wait_for()
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    return box["x"] + across * box["width"], box["y"] + (1 - up) * box["height"]


def test_a_click_on_the_map_shows_a_design_that_is_used_in_one_step(user):
    user.open("?view=map&limit=outer_radius<=26")
    user.page.mouse.click(*spot(user, 0.25, 0.25))
    user.page.locator("button", has_text="Use this design").click()
    user.until("location.search.includes('joint.ball_radius')")
    taken = [float(user.link()[f"joint.{name}"]) for name in ("ball_radius", "liner_thickness")]
    assert taken == pytest.approx([14.0, 6.0], abs=0.1)
    assert user.page.locator(".app[data-view=map]").count() == 1
    user.answered()
    user.page.go_back()
    user.until("location.search.includes('preset=hip-28')")
    user.answered()
    expect(user.page.locator("[data-name=ball_radius] input[type=text]")).to_have_value("28")


def test_everything_on_the_map_is_done_by_keys(user):
    user.open("?view=map&limit=outer_radius<=26")
    user.page.mouse.move(*spot(user, 0.25, 0.75))
    cursor = user.page.locator("#map-picture .cursor")
    head, liner = map(float, re.findall(r"([\d.]+) mm", cursor.locator("text").first.text_content()))
    assert (head, liner) == pytest.approx((28.0, 12.0), abs=0.1)
    cursor.focus()
    cursor.press("Shift+ArrowRight")
    cursor.press("ArrowDown")
    numbers = re.findall(r"\]: ([\d.]+)", cursor.get_attribute("aria-label"))
    assert tuple(map(float, numbers[:2])) == pytest.approx((head + 2.4, liner - 0.24), abs=0.02)
    largest = pressure(ball_radius=float(numbers[0]) / 2, liner_thickness=float(numbers[1]))
    assert float(numbers[2]) == pytest.approx(largest, rel=0.01)
    cursor.press("Enter")
    user.page.locator("#map-point table").wait_for()
    user.answered()
    expect(cursor).to_be_focused()
    square = user.page.locator("#map-picture [data-limit]")
    square.focus()
    for _ in range(3):
        square.press("ArrowUp")
        user.answered()
    user.until("location.search.includes('limit=outer_radius%3C%3D29.0')")
    user.answered()
    expect(square).to_be_focused()
    expect(user.page.locator(".limit-rows input")).to_have_value("29")


def test_a_limit_is_dragged_and_undone_as_one_step(user):
    user.open("?view=map&limit=outer_radius<=26")
    spot(user, 0, 0)
    user.drags("#map-picture .square", (-36, 34), (-30, 20))
    user.until("!location.search.includes('%3D26.0')")
    user.answered()
    dragged = float(user.page.locator(".limit-rows input").input_value())
    assert 15 < dragged < 25.5
    assert user.page.locator("#map-point table").count() == 0  # it was no click
    user.page.go_back()
    user.until("location.search.includes('%3D26.0')")
    user.answered()
    expect(user.page.locator(".limit-rows input")).to_have_value("26")


def test_rows_of_limits_are_added_refused_and_taken_away(user):
    user.open("?view=map")
    user.page.locator("button", has_text="Add a limit").click()
    row = user.page.locator(".limit-rows > div")
    box = row.locator("input")
    expect(box).to_be_focused()
    row.locator("select").first.select_option(label="Outer diameter")
    expect(box).to_have_value("38.2")
    box.fill("52,x")
    box.press("Enter")
    assert user.says("Outer diameter must be a number in mm")
    expect(box).to_have_value("52,x")
    box.fill("52")
    box.press("Enter")
    user.until("location.search.includes('limit=outer_diameter%3C%3D52.0')")
    row.locator("button").click()
    user.until("!location.search.includes('limit=')")
    assert row.count() == 0


def test_designs_stand_side_by_side(user):
    user.open("?view=compare")
    assert user.says("a preset is shown beside this design as an example")
    user.page.get_by_label("Add a preset").select_option("hip-36")
    user.page.get_by_role("button", name="Remove hip-36").wait_for()
    cells = user.page.locator(".designs tr", has_text="largest pressure [").locator("td")
    expected = pressure("hip-36")
    share = pressure() / expected - 1
    expect(cells.nth(1)).to_have_text(f"{expected:.4g}")
    expect(cells.nth(0)).to_have_text(re.compile(re.escape(f"{100 * share:+.0f} %") + "$"))
    user.page.locator("button", has_text="Add this design").click()
    user.page.get_by_role("button", name="Remove hip-28").wait_for()
    user.page.get_by_role("button", name="Remove hip-36").click()
    user.page.get_by_role("button", name="Remove hip-36").wait_for(state="hidden")


def test_elements_run_beside_others_who_go_on(user, other):
    """A run answers, another is cancelled, and somebody else's page answers before the run does."""
    pytest.importorskip("skfem")
    user.open("?view=judge")
    other.open()
    button = user.page.locator("[data-name='judge.run'] button")
    button.click()
    expect(button).to_have_text("Cancel")
    other.nudge("clearance")
    assert other.shows("max_pressure", pressure(clearance=0.105))
    picture = user.page.locator("svg[aria-label^='mesh and von Mises']")
    assert not picture.is_visible()
    picture.wait_for()
    row = user.page.locator("#judge-numbers tr", has_text="largest pressure [").locator("td")
    contact = bs.FiniteElement().press(HIP, force=3000.0)
    assert float(row.nth(1).inner_text()) == pytest.approx(contact.max_pressure, rel=1e-3)
    assert user.saved("PNG").startswith(b"\x89PNG")
    user.nudge("clearance")
    assert user.says("belong to an earlier design")
    assert picture.is_visible()
    button.click()
    button.click()
    assert user.says("Cancelled.")
    user.page.reload()
    user.answered()
    user.nudge("clearance", "ArrowLeft")
    picture.wait_for()  # the result of the first question is still stored


PAGES = [
    *(("user", view) for view in ("press", "compare", "judge", "map")),
    *(("reader", view) for view in ("press", "cup", "gait", "wear", "evidence", "compare", "judge", "map")),
]


@pytest.mark.parametrize(("someone", "view"), PAGES)
def test_pages_fit_and_are_kept_as_pictures(user, reader, someone, view, tmp_path):
    who, dark = (reader, True) if someone == "reader" else (user, False)
    who.open(f"?view={view}&beside1.preset=hip-36")
    who.until(f"!!document.querySelector('.app.dark') === {str(dark).lower()}")
    width = who.page.evaluate(AT_REST)
    assert width <= (NARROW if dark else WIDE)
    name = f"{view}_{width}_{'dark' if dark else 'light'}.png"
    who.page.screenshot(path=Path(PICTURES or tmp_path) / name, full_page=True)
    assert not who.errors
