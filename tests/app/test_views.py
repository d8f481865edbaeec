"""Views of cup, gait and more in a browser: what moves is moved, by mouse and by keyboard."""

import pytest

pytestmark = [pytest.mark.long, pytest.mark.xdist_group("browser")]  # one server and one browser for all

HIP = "preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"


def drawn(canvas):
    return canvas.evaluate("canvas => canvas.toDataURL()")


def test_the_cup_turns_and_a_place_on_the_map_is_taken(user):
    user.open(f"?view=cup&{HIP}")
    canvas = user.page.locator("#cup-bowl canvas")
    canvas.wait_for()
    before = drawn(canvas)
    canvas.focus()
    canvas.press("ArrowLeft")
    turned = drawn(canvas)
    assert turned != before
    box = canvas.bounding_box()
    user.page.mouse.move(box["x"] + 100, box["y"] + 100)
    user.page.mouse.down()
    user.page.mouse.move(box["x"] + 180, box["y"] + 120)
    user.page.mouse.up()
    assert drawn(canvas) != turned
    stood = user.page.locator("#cup-stood svg")
    stood.wait_for()
    place = stood.bounding_box()
    user.page.mouse.click(place["x"] + 0.5 * place["width"], place["y"] + 0.4 * place["height"])
    user.page.wait_for_function("!location.search.includes('cup.inclination=45.0')")
    user.answered()
    inclination = float(user.page.locator("[data-field='cup.inclination'] input[type=text]").input_value())
    assert 40 < inclination < 46


def test_a_cycle_is_played_and_stops_where_it_is(user):
    user.open(f"?view=gait&{HIP}")
    button = user.page.locator(".player button")
    button.wait_for()
    output, canvas = user.page.locator(".player output"), user.page.locator(".player canvas")
    before, picture = output.inner_text(), drawn(canvas)
    button.click()
    user.page.wait_for_function("words => document.querySelector('.player output').textContent !== words", arg=before)
    button.click()
    user.page.wait_for_function("location.search.includes('use.instant=')")
    assert drawn(canvas) != picture
    bar = user.page.locator(".player input[type=range]")
    bar.focus()
    bar.press("Home")
    assert output.inner_text().startswith("0.5 % of the cycle: load ")
    user.page.wait_for_function("location.search.includes('use.instant=0')")
    assert user.page.locator(".player .spot").count() == 4
