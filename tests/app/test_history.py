"""Undo and redo in a real browser: one step for each settled change."""

import pytest

from .user import pressure

pytestmark = pytest.mark.long


def press(user, keys):
    user.page.evaluate("document.activeElement.blur()")
    user.page.keyboard.press(keys)


_SLOW_CLOCK = "performance.now = ((now) => () => now() / 10)(performance.now.bind(performance))"
"""A page whose pause of 0.6 s between two steps lasts 6 s: a busy machine answers four keys in that time."""


def test_changes_are_undone_and_done_again(user):
    """A preset, keys of a slider, and a view are a step each; text in a box has its own undo."""

    def shows(*joint, **changes):
        return user.answered().shows("max_pressure", pressure(*joint, **changes))

    user.page.add_init_script(_SLOW_CLOCK)
    user.open()
    user.page.get_by_label("Start from").select_option("hip-36")
    assert shows("hip-36")
    user.nudge("load", "ArrowLeft", 4)
    assert shows("hip-36", 2800.0)
    user.view("Cup")
    press(user, "Control+z")
    user.page.locator("[data-view=press]:is(section)").wait_for()
    press(user, "Control+z")
    assert shows("hip-36")
    press(user, "Control+z")
    assert shows("hip-28")
    assert user.page.get_by_label("Start from").input_value() == "hip-28"
    press(user, "Control+z")  # there is nothing before: the page stays
    press(user, "Control+y")
    assert shows("hip-36")
    user.page.go_forward()
    assert shows("hip-36", 2800.0)
    user.nudge("clearance")
    assert shows("hip-36", 2800.0, clearance=0.105)
    press(user, "Control+Shift+z")
    assert shows("hip-36", 2800.0, clearance=0.105)


def test_a_drag_is_one_step_and_the_theme_is_none(user):
    user.open()
    steps = user.page.evaluate("history.length")
    knob = user.page.locator("[data-drag=tilt]").bounding_box()
    user.page.mouse.move(knob["x"] + knob["width"] / 2, knob["y"] + knob["height"] / 2)
    user.page.mouse.down()
    for sideways in (20, 90):
        user.page.mouse.move(knob["x"] + sideways, knob["y"] + 10)
        user.answered()
        user.page.wait_for_timeout(700)  # longer than the pause that ends a step of keys
    user.page.mouse.up()
    assert user.page.evaluate("history.length") == steps + 1
    user.page.get_by_role("button", name="Light or dark").click()
    user.page.locator(".app.dark").wait_for()
    assert user.page.evaluate("history.length") == steps + 1
    assert user.page.url.endswith("theme=dark")
    user.page.reload()
    user.answered()
    user.page.locator(".app.dark").wait_for()
    assert user.page.locator("[data-name=tilt] input[type=text]").input_value() != "0"
    assert user.page.locator("[data-name=load] input[type=text]").input_value() == "3000"
