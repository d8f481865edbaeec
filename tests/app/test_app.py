"""The explorer in a real browser: what is seen is what `press` answers, and nothing leaves the machine."""

import csv
import io
from urllib.parse import parse_qs, urlsplit

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile, parse_joint

from ..places import EXAMPLES
from .user import pressure

pytestmark = pytest.mark.long
HIP = bs.joints["hip-28"]


@pytest.mark.parametrize("model", ["exact", "hess-forsbach", "tabulated"])
def test_sliders_and_boxes_press_again_and_a_refused_number_changes_nothing(user, model):
    def largest(clearance, force):
        return bs.catalogue[model].press(HIP.replace(clearance=clearance), force=force).max_pressure

    user.open(f"?answered_by={model}")
    contact = bs.catalogue[model].press(HIP, force=3000.0)
    for name, factor in (("max_pressure", 1.0), ("indentation", 1e3), ("half_angle", 180 / 3.141592653589793)):
        assert user.number(name) == pytest.approx(getattr(contact, name) * factor, rel=1e-9)
    rows = user.page.locator("#press-table tr:has(th[scope=row])")
    rows.first.wait_for()
    assert rows.count() == len(bs.catalogue)
    user.nudge("clearance")
    assert user.shows("max_pressure", largest(0.105, 3000.0))
    user.nudge("load", "ArrowLeft", 2)
    assert user.shows("max_pressure", largest(0.105, 2900.0))
    user.types("load", "12000")  # beyond the slider
    assert user.shows("max_pressure", largest(0.105, 12000.0))
    box = user.types("liner_poisson", "0.7")
    assert user.says("must be -0.999 to 0.5 (the limits of an isotropic solid), got 0.7; 0.4 stays in use")
    assert user.answered().shows("max_pressure", largest(0.105, 12000.0))
    assert box.input_value() == "0.7"


def test_a_link_brings_back_what_was_seen_by_one_of_two_users(user, other):
    user.open()
    other.open("?preset=hip-36")
    user.nudge("ball_radius", times=3)
    other.nudge("clearance", "ArrowLeft")
    user.page.locator("[data-name=size] label", has_text="radius").click()
    assert user.says("Ball radius")
    assert user.shows("max_pressure", pressure(ball_radius=14.3))
    assert other.shows("max_pressure", pressure("hip-36", clearance=0.095))
    user.until("window.location.search.includes('size=radius')")
    user.page.locator("#share").click()
    assert user.says("copied")
    link = user.page.evaluate("navigator.clipboard.readText()")
    assert parse_qs(urlsplit(link).query)["joint.ball_radius"] == ["14.3"]
    other.open(link.removeprefix(user.address))
    assert other.shows("max_pressure", pressure(ball_radius=14.3))
    assert other.says("Ball radius")


def test_what_is_seen_can_be_saved(user):
    user.open("?preset=hip-32&load.force=2500")
    assert user.saved("PNG").startswith(b"\x89PNG")
    assert b"<svg" in user.saved("SVG")
    rows = list(csv.DictReader(io.StringIO(user.saved("CSV").decode())))
    exact = next(row for row in rows if row["model"] == "exact")
    assert float(exact["max_pressure_MPa"]) == pytest.approx(pressure("hip-32", 2500.0), rel=1e-9)
    report = user.saved("HTML").decode()
    assert "data:image/png;base64" in report
    assert "src='http" not in report
    assert f"{user.address}?preset=hip-32" in report
    assert parse_joint(user.saved("TOML"), "saved") == JointFile(bs.joints["hip-32"], {"force": 2500.0})


def test_joint_files_are_read_by_the_strict_reader(user):
    user.open()
    good = (EXAMPLES / "metal_backed_hip.toml").read_bytes()
    for name, content, words in (
        (
            "broken",
            b"[joint]\nball_radius = 14\nclearence = 0.1\n",
            "'clearence' in [joint] is not known",
        ),
        ("large", b"#" * 200_000, "large.toml is larger than 100000 bytes"),
        ("deep", b"a=" + b"[" * 30_000, "its brackets are nested too deeply"),
        ("binary", bytes(range(128, 256)), "is not TOML"),
        ("good", good, "3 mm of titanium"),
    ):
        file = {"name": f"{name}.toml", "mimeType": "text/plain", "buffer": content}
        user.page.locator("#joint-file").set_input_files(file)
        assert user.says(words)
    joint = parse_joint(good, "good").joint
    assert user.shows("max_pressure", bs.Exact().press(joint, force=3000.0).max_pressure)


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


def test_the_keyboard_is_enough(user):
    """The first stop leads past the controls; every slider is a stop that says what it is."""
    user.open()
    user.page.keyboard.press("Tab")
    assert user.page.evaluate("document.activeElement.textContent") == "Go to the results"
    bars = user.page.locator(".side").get_by_role("slider")
    assert bars.count() == user.page.locator(".side input[type=range]:visible").count() > 5
    user.page.get_by_role("slider", name="Diametral clearance mm").focus()
    user.page.keyboard.press("ArrowUp")
    assert user.shows("max_pressure", pressure(clearance=0.105))
    user.page.get_by_role("textbox", name="Normal force N").focus()
    user.page.keyboard.press("ArrowDown")
    assert user.shows("force", 2950.0)


def test_on_a_narrow_screen_the_answers_come_first_and_no_column_lies_beside_it(reader):
    page, largest = reader.open().page, reader.page.locator("dd[data-name=max_pressure]")
    assert largest.bounding_box()["y"] < 400
    page.locator("summary", has_text="The joint").click()
    reader.nudge("clearance")
    assert reader.shows("max_pressure", pressure(clearance=0.105))
    reader.answered()
    assert largest.bounding_box()["y"] < 800
    table = page.locator(".models")
    table.wait_for()
    assert table.evaluate("(one) => one.scrollWidth <= one.clientWidth")
    head = table.locator("td[data-head*=pmax]").first.evaluate("(one) => getComputedStyle(one, '::before').content")
    assert "pmax" in head
