"""The explorer in a real browser: what is seen is what `press` answers, and nothing leaves the machine."""

import csv
import io
import os
import re
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest

import ballsocket as bs
from ballsocket.io.joint_file import JointFile, parse_joint

from ..extent import some
from ..places import EXAMPLES
from .browser import opened_browser, served_explorer

pytest.importorskip("panel", reason="the explorer's extra is not installed")
expect = pytest.importorskip("playwright.sync_api", reason="playwright is not installed").expect

HIP = bs.joints["hip-28"]
PICTURES = Path(os.environ.get("BALLSOCKET_SCREENSHOTS", "build/screenshots"))
WIDE, NARROW = 1280, 390
WAIT = 90_000
"""Milliseconds until something that does not happen is taken for a fault: a machine may be slow."""

expect.set_options(timeout=WAIT)
pytestmark = pytest.mark.xdist_group("browser")  # one server and one browser for all of them


@pytest.fixture(scope="module")
def browser():
    with opened_browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def address():
    with served_explorer() as served:
        yield served


@contextmanager
def opened_profile(browser, address, width=WIDE, dark=False):
    """A browser of one user, who has opened nothing yet."""
    scheme = "dark" if dark else "light"
    profile = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme, accept_downloads=True)
    profile.grant_permissions(["clipboard-read", "clipboard-write"], origin=address)
    profile.set_default_timeout(WAIT)
    yield profile
    profile.close()


@pytest.fixture(scope="module")
def profile(browser, address):
    """One for all tests of a single user: it reads the scripts of the page once."""
    with opened_profile(browser, address) as one:
        yield one


@pytest.fixture
def other(browser, address):
    """Somebody else, on another machine as far as the explorer can tell."""
    with opened_profile(browser, address) as one:
        yield User(one, address)


@pytest.fixture
def reader(browser, address):
    """Whoever holds a telephone, in the dark."""
    with opened_profile(browser, address, NARROW, dark=True) as one:
        yield User(one, address)


class User:
    """One browser window, which notes every request and every error of the page."""

    def __init__(self, profile, address):
        self.page, self.address = profile.new_page(), address
        self.requests, self.errors = [], []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))

    def open(self, query=""):
        self.page.goto(self.address + query)
        self.page.locator("#view .bk-btn").first.wait_for()
        return self

    def number(self, name):
        return float(self.page.locator(f"dd[data-name={name}]").get_attribute("data-value"))

    def shows(self, name, value, tolerance=1e-9):
        """Wait until a number on the page is this one."""
        deadline = time.monotonic() + WAIT / 1000
        while time.monotonic() < deadline:
            if self.number(name) == pytest.approx(value, rel=tolerance):
                return True
            time.sleep(0.02)
        return False

    def nudge(self, slider, key="ArrowRight", times=1):
        handle = self.page.locator(f".{slider} .noUi-handle")
        handle.focus()
        for _ in range(times):
            handle.press(key)

    def view(self, title):
        self.page.locator("#view .bk-btn", has_text=title).first.click()

    def says(self, words):
        self.page.locator(f"text={words}").first.wait_for()
        return True

    def map(self):
        """The chart of the map that is seen, as a box on the screen."""
        assert self.says("of the map is allowed by the limits")
        return self.page.locator("#view .bk-Figure:visible").first.bounding_box()

    def saved(self, kind):
        with self.page.expect_download() as coming:
            self.page.locator(".side a", has_text=kind).click()
        return Path(coming.value.path()).read_bytes()


@pytest.fixture
def user(profile, address):
    someone = User(profile, address)
    yield someone
    assert not someone.errors
    assert all(urlsplit(url).hostname == "127.0.0.1" for url in someone.requests if url.startswith(("http", "ws")))
    someone.page.close()


def test_a_fresh_page_shows_what_press_answers(user):
    user.open()
    contact = bs.Exact().press(HIP, force=3000.0)
    for name, factor in (("max_pressure", 1.0), ("indentation", 1e3), ("half_angle", 180 / 3.141592653589793)):
        assert user.number(name) == pytest.approx(getattr(contact, name) * factor, rel=1e-9)
    rows = user.page.locator("tr:has(th[scope=row])")
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
    box = user.page.locator(".load input")
    box.fill("12000")
    box.press("Enter")
    assert user.shows("max_pressure", bs.Exact().press(HIP, force=12000.0).max_pressure)


def test_a_number_that_no_joint_has_is_refused_in_words_and_the_page_goes_on(user):
    user.open()
    box = user.page.locator(".liner_poisson input")
    box.fill("0.7")
    box.press("Enter")
    assert user.says("poisson = 0.7 is not allowed")
    assert box.input_value() == "0.4"
    user.nudge("clearance")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)


@pytest.mark.long
def test_the_load_keeps_the_contact_when_it_is_given_otherwise(user):
    user.open()
    before = user.number("max_pressure")
    user.page.locator(".side .bk-btn", has_text="indentation").click()
    assert user.says("Indentation d [µm]")
    assert user.shows("max_pressure", before, 1e-4)


@pytest.mark.long
def test_a_link_brings_back_what_was_seen(user, other):
    user.open()
    user.nudge("ball_radius", times=3)
    user.page.locator(".side .bk-btn", has_text="diameter").click()
    assert user.says("Head diameter 2 R1 [mm]")
    expected = bs.Exact().press(replace(HIP, ball_radius=14.3), force=3000.0).max_pressure
    assert user.shows("max_pressure", expected)
    user.page.wait_for_function("window.location.search.includes('size=diameter')")
    user.page.locator("#share").click()
    assert user.says("copied")
    link = user.page.evaluate("navigator.clipboard.readText()")
    assert parse_qs(urlsplit(link).query)["joint.ball_radius"] == ["14.3"]
    other.open(link.removeprefix(user.address))
    assert other.shows("max_pressure", expected)
    assert other.says("Head diameter 2 R1 [mm]")


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
    assert user.says("this joint")
    assert user.page.locator("img[src=x]").count() == 0


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
    assert f"{user.address}?preset=hip-32" in report.replace("&amp;", "&")
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


def test_two_users_do_not_see_each_other(user, other):
    user.open()
    other.open("?preset=hip-36")
    user.nudge("clearance")
    other.nudge("clearance", "ArrowLeft")
    assert user.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    expected = bs.Exact().press(replace(bs.joints["hip-36"], clearance=0.095), force=3000.0).max_pressure
    assert other.shows("max_pressure", expected)


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


AT_REST = """async () => {
  const frame = () => new Promise(requestAnimationFrame);
  const place = document.documentElement;
  const size = () => `${place.scrollWidth} ${place.scrollHeight} ${Bokeh.documents.every((one) => one.is_idle)}`;
  for (let same = 0, last = ""; same < 20; await frame()) {
    [same, last] = size() === last ? [same + 1, last] : [0, size()];
  }
  return place.scrollWidth;
}"""
"""The width of what is on the page, once twenty frames have changed nothing."""


PAGES = [(someone, view) for someone in ("user", "reader") for view in ("press", "compare", "judge", "map")]


@pytest.mark.parametrize(("someone", "view"), some(PAGES, 2))
def test_pages_fit_and_are_kept_as_pictures(request, someone, view):
    who, dark = request.getfixturevalue(someone), someone == "reader"
    who.open(f"?view={view}&beside1.preset=hip-36")
    who.page.wait_for_function(f"!!document.querySelector('.app.dark') === {str(dark).lower()}")
    who.page.locator("#view .bk-btn").first.wait_for()
    width = who.page.evaluate(AT_REST)
    assert width <= (NARROW if dark else WIDE)
    PICTURES.mkdir(parents=True, exist_ok=True)
    who.page.screenshot(path=PICTURES / f"{view}_{width}_{'dark' if dark else 'light'}.png", full_page=True)
    assert not who.errors


@pytest.mark.long
def test_the_keyboard_is_enough(user):
    """The first stop leads past the controls; every slider is a stop that says what it is."""
    user.open()
    user.page.keyboard.press("Tab")
    assert user.page.evaluate("document.activeElement.textContent") == "Go to the answers"
    handles = user.page.locator(".side .noUi-handle:visible")
    expect(handles.last).to_have_attribute("aria-label", re.compile("."))
    names = [handles.nth(number).get_attribute("aria-label") for number in range(handles.count())]
    assert "Radial clearance c [mm]" in names
    assert all(names)
    assert all(handles.nth(number).get_attribute("tabindex") == "0" for number in range(handles.count()))


@pytest.mark.long
def test_on_a_narrow_screen_the_answers_come_first_and_stay_in_sight(reader):
    someone = reader.open()
    assert someone.page.locator("dd[data-name=force]").bounding_box()["y"] < 500
    someone.page.locator("summary", has_text="The joint").click()
    someone.nudge("clearance")
    assert someone.shows("max_pressure", bs.Exact().press(replace(HIP, clearance=0.105), force=3000.0).max_pressure)
    assert someone.page.locator("dd[data-name=force]").bounding_box()["y"] < 800


def test_nobody_can_choose_the_name_of_anothers_session(address):
    from urllib.error import HTTPError
    from urllib.request import urlopen

    with pytest.raises(HTTPError, match="403"):
        urlopen(f"{address}?bokeh-session-id=chosen")


def test_other_machines_names_do_not_reach_it(address):
    """A page of somebody else's that resolves to this machine is refused by its name."""
    from http.client import HTTPConnection

    parts = urlsplit(address)
    connection = HTTPConnection(parts.hostname, parts.port)
    handshake = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        "Origin": "http://evil.example",
    }
    connection.request("GET", "/ws", headers=handshake)
    assert connection.getresponse().status == 403
    connection.close()
