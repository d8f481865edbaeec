"""The explorer in a real browser: files, handles, undo and redo, and a narrow screen."""

import tomllib

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import parse_joint

from ..places import EXAMPLES
from .browser import NARROW, User, opened_profile, pressure

pytestmark = pytest.mark.long


def test_joint_files_are_read_by_the_strict_reader(user):
    user.open()
    good = (EXAMPLES / "metal_backed_hip.toml").read_bytes()
    for name, content, words in (
        ("broken", b"[joint]\nball_radius = 14\nclearence = 0.1\n", "'clearence' in [joint] is not known"),
        ("large", b"#" * 200_000, "large.toml is larger than 100000 bytes"),
        ("binary", bytes(range(128, 256)), "is not TOML"),
        ("good", good, "3 mm of titanium"),
    ):
        file = {"name": f"{name}.toml", "mimeType": "text/plain", "buffer": content}
        user.page.locator("#joint-file").set_input_files(file)
        assert user.says(words)
    assert user.shows("max_pressure", bs.Exact().press(parse_joint(good, "good").joint, force=3000.0).max_pressure)


def test_the_arrow_can_be_dragged_and_moved_by_keys(user):
    """The shaft changes the force alone, the knob the tilt alone; a handle moved by a key moves on with the next."""
    user.open()
    force = float(user.drags("[data-drag=load][tabindex]", (0, -20)).link()["load.force"])
    assert force != 3000.0
    turned = user.drags("[data-drag=tilt]", (80, 0)).link()
    assert 10 < float(turned["load.tilt"]) < 45
    assert float(turned["load.force"]) == force
    user.page.locator("[data-drag=load][tabindex]").focus()
    for _ in range(2):
        user.page.keyboard.press("ArrowDown")
        user.answered()
    assert user.shows("force", force - 100.0)


def test_on_a_narrow_screen_the_answers_come_first_and_no_column_lies_beside_it(browser, address):
    with opened_profile(browser, address, NARROW, dark=True) as profile:
        reader = User(profile, address).open()
        page, largest = reader.page, reader.page.locator("dd[data-name=max_pressure]")
        page.locator(".app.dark").wait_for()  # as the reader's system is
        assert largest.bounding_box()["y"] < 400
        page.locator("summary", has_text="The joint").click()
        reader.nudge("clearance")
        assert reader.answered().shows("max_pressure", pressure(clearance=0.105))
        assert largest.bounding_box()["y"] < 800
        table = page.locator(".models")
        table.wait_for()
        assert table.evaluate("(one) => one.scrollWidth <= one.clientWidth")
        cell = table.locator("td[data-head*=pmax]").first
        assert "pmax" in cell.evaluate("(one) => getComputedStyle(one, '::before').content")
        assert not reader.errors


_SLOW_CLOCK = "performance.now = ((now) => () => now() / 10)(performance.now.bind(performance))"
"""A page whose pause of 0.6 s between two steps lasts 6 s: a busy machine answers four keys in that time."""


def test_changes_are_undone_and_done_again(user):
    """A preset, keys of a slider, and a view are a step each; text in a box has its own undo."""

    def shows(*joint, **changes):
        return user.answered().shows("max_pressure", pressure(*joint, **changes))

    def press(keys):
        user.page.evaluate("document.activeElement.blur()")
        user.page.keyboard.press(keys)

    user.page.add_init_script(_SLOW_CLOCK)
    user.open()
    user.page.get_by_label("Start from").select_option("hip-36")
    assert shows("hip-36")
    user.nudge("load", "ArrowLeft", 4)
    assert shows("hip-36", 2800.0)
    user.view("Cup")
    press("Control+z")
    user.page.locator("[data-view=press]:is(section)").wait_for()
    press("Control+z")
    assert shows("hip-36")
    press("Control+z")
    assert shows("hip-28")
    assert user.page.get_by_label("Start from").input_value() == "hip-28"
    press("Control+z")  # there is nothing before: the page stays
    press("Control+y")
    assert shows("hip-36")
    user.page.go_forward()
    assert shows("hip-36", 2800.0)
    user.nudge("clearance")
    assert shows("hip-36", 2800.0, clearance=0.105)
    press("Control+Shift+z")
    assert shows("hip-36", 2800.0, clearance=0.105)


def test_a_drag_is_one_step_and_the_theme_is_none(user):
    page = user.open().page
    steps = page.evaluate("history.length")
    knob = page.locator("[data-drag=tilt]").bounding_box()
    page.mouse.move(knob["x"] + knob["width"] / 2, knob["y"] + knob["height"] / 2)
    page.mouse.down()
    for sideways in (20, 90):
        page.mouse.move(knob["x"] + sideways, knob["y"] + 10)
        user.answered()
        page.wait_for_timeout(700)  # longer than the pause that ends a step of keys
    page.mouse.up()
    page.get_by_role("button", name="Light or dark").click()
    page.locator(".app.dark").wait_for()
    assert page.evaluate("history.length") == steps + 1
    assert page.url.endswith("theme=dark")
    page.reload()
    user.answered()
    page.locator(".app.dark").wait_for()
    assert page.locator("[data-name=tilt] input[type=text]").input_value() != "0"
    assert page.locator("[data-name=load] input[type=text]").input_value() == "3000"


def names(user):
    return user.page.locator("#design-list li > button:not([data-design])").all_text_contents()


def does(user, action):
    user.page.locator(f"[data-design={action}]").click()
    return user.answered()


def test_designs_are_named_kept_compared_saved_and_opened(user, profile, tmp_path):
    page = user.open().page
    user.enters("name", "hip 36 a")
    page.locator("#designs summary").click()
    assert names(user) == ["hip 36 a"]
    does(user, "duplicate")
    user.enters("ball_radius", "36")
    assert names(user) == ["hip 36 a", "hip 36 a copy"]
    assert user.link()["joint.ball_radius"] == "18.0"

    other = User(profile, user.address).open()  # a second window adds one, and changes no other
    other.page.locator("#designs summary").click()
    other.enters("name", "from the other window")
    other.page.close()
    page.locator("#design-list li", has_text="from the other window").wait_for()
    user.enters("clearance", "0.3")

    page.locator("#design-list button", has_text="hip 36 a").first.click()
    user.answered()
    assert user.link()["joint.ball_radius"] == "14.0"
    page.get_by_label("Compare hip 36 a copy").check()
    does(user, "compare")
    compared = user.link()
    assert (compared["view"], compared["beside1.name"]) == ("compare", "hip 36 a copy")
    assert (compared["beside1.joint.ball_radius"], compared["beside1.joint.clearance"]) == ("18.0", "0.15")
    page.go_back()
    page.wait_for_function("!location.search.includes('beside1')")
    user.answered()

    user.saves(".files button:has-text('TOML')", tmp_path / "hip-36-a.toml")
    user.saves("[data-design=save]", saved := tmp_path / "designs.toml")
    assert [design["name"] for design in tomllib.loads(saved.read_text("utf-8"))["design"]] == names(user)

    does(user, "remove")
    page.reload()
    user.answered()
    page.locator("#designs summary").click()
    assert names(user) == ["hip 36 a copy", "from the other window"]
    page.locator("#joint-file").set_input_files(saved)
    page.locator("#design-list button[aria-current]", has_text="hip 36 a").wait_for()
    user.answered()
    assert names(user) == ["hip 36 a copy", "from the other window", "hip 36 a"]  # two were still there
    assert user.link()["name"] == "hip 36 a"


def test_a_refused_number_stays_in_its_box_with_the_reason(user):
    page, box = user.open().page, user.types("ball_radius", "-5")
    error = page.locator("#error-ball_radius")
    error.wait_for()
    assert error.text_content() == "Head diameter must be positive, got -5 mm; 28 mm stays in use"
    user.enters("clearance", "0,3")
    assert box.input_value() == "-5"
    assert (box.get_attribute("aria-invalid"), box.get_attribute("aria-describedby")) == ("true", "error-ball_radius")
    assert user.link()["joint.ball_radius"] == "14.0"
    box.fill("")
    box.press("Enter")
    error.wait_for(state="hidden")
    assert box.input_value() == "28"
    box.press("ArrowUp")
    user.answered()
    assert user.link()["joint.ball_radius"] == "14.1"
    sliders = page.locator(".side input[type=range]:visible")
    assert {slider.get_attribute("tabindex") for slider in sliders.all()} == {"-1"}
