"""The explorer in a real browser: what is seen is what `press` answers, and nothing leaves the machine."""

import csv
import io
from dataclasses import replace
from urllib.parse import parse_qs, urlsplit

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile, parse_joint

from ..extent import some
from ..places import EXAMPLES

expect = pytest.importorskip("playwright.sync_api", reason="playwright is not installed").expect

HIP = bs.joints["hip-28"]


def test_a_fresh_page_shows_what_press_answers(user):
    user.open()
    contact = bs.Exact().press(HIP, force=3000.0)
    for name, factor in (("max_pressure", 1.0), ("indentation", 1e3), ("half_angle", 180 / 3.141592653589793)):
        assert user.number(name) == pytest.approx(getattr(contact, name) * factor, rel=1e-9)
    rows = user.page.locator("#press-table tr:has(th[scope=row])")
    rows.first.wait_for()
    assert rows.count() == len(bs.catalogue)


@pytest.mark.parametrize("model", some(["exact", "hess-forsbach", "tabulated"], 1))
def test_a_slider_that_moves_presses_again(user, model):
    user.open(f"?answered_by={model}")
    user.nudge("clearance")
    moved = bs.catalogue[model].press(replace(HIP, clearance=0.105), force=3000.0)
    assert user.shows("max_pressure", moved.max_pressure)
    user.nudge("load", "ArrowLeft", 2)
    assert user.shows(
        "max_pressure", bs.catalogue[model].press(replace(HIP, clearance=0.105), force=2900.0).max_pressure
    )


@pytest.mark.long
def test_a_number_can_be_typed_beyond_the_slider(user):
    user.open()
    user.types("load", "12000")
    assert user.shows("max_pressure", bs.Exact().press(HIP, force=12000.0).max_pressure)


def test_a_number_that_no_joint_has_is_refused_in_words_and_the_page_goes_on(user):
    user.open()
    box = user.types("liner_poisson", "0.7")
    assert user.says("must be -0.999 to 0.5 (the limits of an isotropic solid), got 0.7; 0.4 stays in use")
    assert user.answered()
    assert box.input_value() == "0.7"
    user.nudge("clearance")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)


@pytest.mark.long
def test_the_load_keeps_the_contact_when_it_is_given_otherwise(user):
    user.open()
    before = user.number("max_pressure")
    user.page.locator("[data-name=kind] label", has_text="indentation").click()
    assert user.says("Indentation")
    assert user.shows("max_pressure", before, 1e-4)


@pytest.mark.long
def test_a_link_brings_back_what_was_seen(user, other):
    user.open()
    user.nudge("ball_radius", times=3)
    user.page.locator("[data-name=size] label", has_text="radius").click()
    assert user.says("Ball radius")
    expected = bs.Exact().press(replace(HIP, ball_radius=14.3), force=3000.0).max_pressure
    assert user.shows("max_pressure", expected)
    user.until("window.location.search.includes('size=radius')")
    user.page.locator("#share").click()
    assert user.says("copied")
    link = user.page.evaluate("navigator.clipboard.readText()")
    assert parse_qs(urlsplit(link).query)["joint.ball_radius"] == ["14.3"]
    other.open(link.removeprefix(user.address))
    assert other.shows("max_pressure", expected)
    assert other.says("Ball radius")


def test_a_link_that_cannot_be_read_says_so(user):
    user.open("?joint.ball_radiuss=3")
    assert user.says("This link cannot be read: 'ball_radiuss' in [joint] is not known; did you mean 'ball_radius'?")
    user.nudge("clearance")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)


def test_names_in_a_link_are_text(user):
    user.open(
        "?name=<img src=x onerror=alert(1)>&joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5"
        "&liner.material=uhmwpe&view=compare"
    )
    user.page.locator(".designs th", has_text="this design").wait_for()
    assert user.page.locator("[data-name=name] input").input_value() == "<img src=x onerror=alert(1)>"
    assert user.page.locator("img[src=x]").count() == 0


@pytest.mark.long
def test_what_is_seen_can_be_saved(user):
    user.open("?preset=hip-32&load.force=2500")
    joint = bs.joints["hip-32"]
    assert user.saved("PNG").startswith(b"\x89PNG")
    assert b"<svg" in user.saved("SVG")
    rows = list(csv.DictReader(io.StringIO(user.saved("CSV").decode())))
    exact = next(row for row in rows if row["model"] == "exact")
    assert float(exact["max_pressure_MPa"]) == pytest.approx(
        bs.Exact().press(joint, force=2500.0).max_pressure, rel=1e-9
    )
    report = user.saved("HTML").decode()
    assert "data:image/png;base64" in report
    assert "src='http" not in report
    assert f"{user.address}?preset=hip-32" in report
    assert parse_joint(user.saved("TOML"), "saved") == JointFile(joint, {"force": 2500.0})


def upload(user, name, content):
    user.page.locator("#joint-file").set_input_files({"name": name, "mimeType": "text/plain", "buffer": content})


def test_joint_files_are_read_by_the_strict_reader(user):
    user.open()
    upload(user, "broken.toml", b"[joint]\nball_radius = 14\nclearence = 0.1\n")
    assert user.says("'clearence' in [joint] is not known; did you mean 'clearance'?")
    upload(user, "broken.toml", b"[joint\n")
    assert user.says("is not TOML")
    upload(user, "large.toml", b"#" * 200_000)
    assert user.says("large.toml is larger than 100000 bytes")
    upload(user, "deep.toml", b"a=" + b"[" * 30_000)
    assert user.says("its brackets are nested too deeply")
    upload(user, "binary.toml", bytes(range(128, 256)))
    assert user.says("is not TOML")
    good = EXAMPLES / "metal_backed_hip.toml"
    upload(user, "good.toml", good.read_bytes())
    assert user.says("3 mm of titanium")
    joint = bs.read_joint(good).joint if hasattr(bs, "read_joint") else parse_joint(good.read_bytes(), "good").joint
    assert user.shows("max_pressure", bs.Exact().press(joint, force=3000.0).max_pressure)


@pytest.mark.long
def test_two_users_do_not_see_each_other(user, other):
    user.open()
    other.open("?preset=hip-36")
    user.nudge("clearance")
    other.nudge("clearance", "ArrowLeft")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    expected = bs.Exact().press(replace(bs.joints["hip-36"], clearance=0.095), force=3000.0).max_pressure
    assert other.shows("max_pressure", expected)


def drags(user, handle, across, down):
    """Drag the middle of a handle; return the load in the link then."""
    box = user.page.locator(handle).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    user.page.mouse.move(x, y)
    user.page.mouse.down()
    user.page.mouse.move(x + across, y + down, steps=4)
    user.page.mouse.up()
    user.answered()
    return {
        name: float(values[0])
        for name, values in parse_qs(urlsplit(user.page.url).query).items()
        if name.startswith("load.")
    }


def test_the_arrow_can_be_dragged_and_moved_by_keys(user):
    """The shaft changes the force alone, the knob the tilt alone; a handle moved by a key moves on with the next."""
    user.open()
    force = drags(user, "[data-drag=load][tabindex]", 0, -20)["load.force"]
    assert force != 3000.0
    turned = drags(user, "[data-drag=tilt]", 80, 0)
    assert 10 < turned["load.tilt"] < 45
    assert turned["load.force"] == force
    user.page.locator("[data-drag=load][tabindex]").focus()
    for _ in range(2):
        user.page.keyboard.press("ArrowDown")
        user.answered()
    assert user.shows("force", force - 100.0)


@pytest.mark.long
def test_the_keyboard_is_enough(user):
    """The first stop leads past the controls; every slider is a stop that says what it is."""
    user.open()
    user.page.keyboard.press("Tab")
    assert user.page.evaluate("document.activeElement.textContent") == "Go to the results"
    bars = user.page.locator(".side").get_by_role("slider")
    assert bars.count() == user.page.locator(".side input[type=range]:visible").count() > 5
    user.page.get_by_role("slider", name="Diametral clearance mm").focus()
    user.page.keyboard.press("ArrowUp")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    user.page.get_by_role("textbox", name="Normal force N").focus()
    user.page.keyboard.press("ArrowDown")
    assert user.shows("force", 2950.0)


@pytest.mark.long
def test_on_a_narrow_screen_the_answers_come_first_and_stay_in_sight(reader):
    someone = reader.open()
    assert someone.page.locator("dd[data-name=max_pressure]").bounding_box()["y"] < 400
    someone.page.locator("summary", has_text="The joint").click()
    someone.nudge("clearance")
    assert someone.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    someone.answered()
    assert someone.page.locator("dd[data-name=max_pressure]").bounding_box()["y"] < 800
