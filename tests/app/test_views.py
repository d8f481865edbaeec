"""Views of cup, gait and more in a browser: what moves is moved, by mouse and by keyboard."""

import time
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from .user import WAIT

pytestmark = pytest.mark.long

HIP = "preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"


def picture(canvas):
    """Pixels of a canvas as the reader sees them."""
    return np.asarray(Image.open(BytesIO(canvas.screenshot())).convert("RGB")).astype(int)


def share_of_colours(pixels):
    """Share of pixels with the colours of a pressure: the cup and the page are nearly grey."""
    return float((pixels.max(axis=2) - pixels.min(axis=2) > 90).mean())


def difference(one, other):
    """Mean difference of two pictures."""
    return float(np.abs(one - other).mean())


def seen(canvas, condition):
    """Take pictures until one meets a condition and the next is equal, as a moving canvas is drawn sharp at its end."""
    deadline, before = time.monotonic() + WAIT / 1000, picture(canvas)
    while True:
        pixels = picture(canvas)
        if condition(pixels) and difference(pixels, before) == 0.0:
            return pixels
        assert time.monotonic() < deadline, "the canvas never looks so"
        before = pixels


def test_the_cup_turns_and_a_place_on_the_map_is_taken(user):
    user.open(f"?view=cup&{HIP}")
    viewer = user.page.locator("#cup-viewer .viewer")
    canvas = viewer.locator("canvas")
    canvas.wait_for()
    before = seen(canvas, lambda pixels: share_of_colours(pixels) > 0.04)  # the contact is seen at first
    assert {"medial", "anterior", "up"} == set(viewer.locator(".triad text").all_text_contents())
    assert viewer.locator(".scale-bar p").inner_text().split() == ["12", "10", "8", "6", "4", "2", "0"]
    assert "[MPa]" in viewer.locator(".scale-bar").inner_text()
    canvas.focus()
    for _ in range(20):  # half a turn: the wall hides the pressure
        canvas.press("ArrowLeft")
    seen(canvas, lambda pixels: share_of_colours(pixels) < 0.01)
    viewer.get_by_text("Show the contact").click()
    straight = seen(canvas, lambda pixels: share_of_colours(pixels) > 0.04)
    box = canvas.bounding_box()
    user.page.mouse.move(box["x"] + 100, box["y"] + 100)
    user.page.mouse.down()
    user.page.mouse.move(box["x"] + 180, box["y"] + 120)
    user.page.mouse.up()
    turned = seen(canvas, lambda pixels: difference(pixels, straight) > 3)
    canvas.press("+")
    seen(canvas, lambda pixels: difference(pixels, turned) > 3)
    viewer.get_by_text("Reset").click()
    seen(canvas, lambda pixels: difference(pixels, before) < 0.5)
    section = viewer.get_by_label("Section plane")
    section.fill("0")  # the plane through the load and the cup's axis
    few = 0.7 * share_of_colours(before)  # half of the contact is cut away
    cut = seen(canvas, lambda pixels: share_of_colours(pixels) < few)
    viewer.get_by_label("Ball").check()
    seen(canvas, lambda pixels: difference(pixels, cut) > 3)
    stood = user.page.locator("#cup-stood svg")
    stood.scroll_into_view_if_needed()
    place = stood.bounding_box()
    user.page.mouse.click(place["x"] + 0.5 * place["width"], place["y"] + 0.4 * place["height"])
    user.until("!location.search.includes('cup.inclination=45.0')")
    user.answered()
    inclination = float(user.page.locator("[data-field='cup.inclination'] input[type=text]").input_value())
    assert 40 < inclination < 46


def test_a_cycle_is_played_and_stops_where_it_is(user):
    user.open(f"?view=gait&{HIP}")
    button = user.page.locator(".transport button")
    button.wait_for()
    output, canvas = user.page.locator(".player output"), user.page.locator(".player canvas")
    few = 0.7 * share_of_colours(seen(canvas, lambda pixels: share_of_colours(pixels) > 0))
    button.click()
    user.until("(bar => bar.value > 0.7 * bar.max)(document.querySelector('.transport input'))")  # the leg swings
    button.click()
    user.until("location.search.includes('use.instant=')")
    seen(canvas, lambda pixels: share_of_colours(pixels) < few)  # the swinging leg presses less
    bar = user.page.locator(".transport input")
    bar.focus()
    bar.press("Home")
    assert output.inner_text().startswith("0.5 % of the cycle: load ")
    user.until("location.search.includes('use.instant=0')")
    user.page.locator(".player .spot").nth(5).wait_for()  # the film follows: load, pressure, distance, two films and λ
    smallest = user.page.evaluate("""() => Math.min(...[...document.querySelectorAll('.courses text')].map((text) =>
        parseFloat(getComputedStyle(text).fontSize) *
        Math.hypot(text.getScreenCTM().a, text.getScreenCTM().b)))""")
    assert smallest >= 11.5


NO_WEBGL = """HTMLCanvasElement.prototype.getContext = ((get) => function (kind, ...more) {
    return kind === "webgl2" ? null : get.call(this, kind, ...more); })(HTMLCanvasElement.prototype.getContext)"""


def test_a_browser_without_webgl_is_shown_the_flat_view(user):
    user.page.add_init_script(NO_WEBGL)
    user.open(f"?view=cup&{HIP}")
    assert user.says("This browser has no WebGL 2")
    assert "from the rim" in user.page.locator("#cup-map svg").get_attribute("aria-label")


def test_a_lost_context_is_restored(user):
    user.open(f"?view=cup&{HIP}")
    canvas = user.page.locator("#cup-viewer canvas")
    canvas.wait_for()
    before = seen(canvas, lambda pixels: share_of_colours(pixels) > 0.04)
    lose = "canvas => (window.lost = canvas.getContext('webgl2').getExtension('WEBGL_lose_context')).loseContext()"
    canvas.evaluate(lose)
    seen(canvas, lambda pixels: share_of_colours(pixels) < 0.01)
    canvas.press("ArrowLeft")  # nothing breaks
    canvas.press("ArrowRight")
    user.page.evaluate("window.lost.restoreContext()")
    seen(canvas, lambda pixels: difference(pixels, before) < 0.5)
