"""Named designs: the session file that holds them all, and files that are named after one."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs

pytest.importorskip("tomli_w")
pytest.importorskip("xarray")
from ballsocket.app.state.designs import MAX_DESIGNS, file_stem, read_upload, session_text
from ballsocket.app.state.screen import START, link_of, read_link
from ballsocket.files.joint_file import read_joint
from ballsocket.files.toml import MAX_FILE_SIZE

from .test_screen import near, screens
from .user import User

EXAMPLE = Path(__file__).parents[2] / "examples" / "designs.toml"
JOINT = (
    '[[design]]\njoint = {ball_radius = "14 mm", clearance = 0.1, liner_thickness = 5}\nliner = {material = "pom"}\n'
)


@given(st.lists(screens(), min_size=1, max_size=3))
def test_a_session_file_brings_every_design_back(designs):
    again = read_upload(session_text([link_of(screen) for screen in designs]), START)
    for screen, read in zip(designs, again, strict=True):
        assert near(screen.file, read.file)
        assert all(near(*pair) for pair in zip(screen.beside, read.beside, strict=True))
        assert replace(screen, file=START.file, beside=(), theme="light") == replace(read, file=START.file, beside=())


def test_a_session_file_is_no_joint_file():
    with pytest.raises(ValueError, match=r"^designs.toml: one joint is needed, .* session file with 2 of"):
        read_joint(EXAMPLE)


def test_toml_and_json_hold_the_same():
    text = EXAMPLE.read_text(encoding="utf-8")
    assert read_upload(json.dumps(tomllib.loads(text)), START) == read_upload(text, START)


def test_the_example_has_two_hips_and_the_settings_of_their_pages():
    small, large = read_upload(EXAMPLE.read_text(encoding="utf-8"), START)
    assert [float(screen.file.joint.ball_radius) for screen in (small, large)] == [14.0, 18.0]
    assert (small.view, large.view, large.units) == ("press", "map", "imperial")
    assert [limit.name for limit in large.limits] == ["outer_diameter", "max_pressure"]
    assert session_text([link_of(small), link_of(large)]) == session_text(
        [link_of(screen) for screen in read_upload(session_text([link_of(small), link_of(large)]), START)]
    )


def test_a_joint_file_keeps_the_page_and_names_no_picture_of_the_server():
    text = '[joint]\nball_radius = 18\nclearance = 0.1\nliner_thickness = 6\n[liner]\nmaterial = "pom"\n'
    screen = read_link(parse_qs("preset=hip-28&load.force=900&units=imperial"))
    (read,) = read_upload(f'{text}[report]\nlogo = "/etc/secret.png"\ncustomer = "A"\n', screen)
    assert (read.units, read.file.load, read.file.report.logo) == ("imperial", {"force": 900.0}, "")
    assert read.file.joint.liner == bs.POM
    assert read_link(parse_qs(link_of(read), keep_blank_values=True)) == read


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the file is empty"),
        ("{", "the file is not JSON"),
        ("[" * 50_000, "the file is not TOML|nested"),
        ('{"a":' * 19_000, "the file is not JSON"),
        ("x" * (MAX_FILE_SIZE + 1), f"the file is larger than {MAX_FILE_SIZE} bytes"),
        ("design = 3", r"the file: design = 3 must be tables \[\[design\]\]"),
        ('{"design": []}', f"the file: a session has 1 to {MAX_DESIGNS} designs, got 0"),
        ("[[design]]\n" * (MAX_DESIGNS + 1), f"a session has 1 to {MAX_DESIGNS} designs, got {MAX_DESIGNS + 1}"),
        (f"name = 'all'\n{JOINT}", "'name' in a session file is not known"),
        ("[[design]]\nname = 'a'\n", "the file: design 1 .'a'.: "),
        (f"{JOINT}\n[[design]]\njoint = 3\n", "the file: design 2: joint = 3 must be a table"),
        (JOINT.replace("14 mm", "-14 mm"), "design 1: ball_radius = '-14 mm' is not allowed"),
        (f"{JOINT}page = 3", r"design 1: page = 3 must be a table"),
        (f"{JOINT}page = {{vew = 'map'}}", r"design 1: 'vew' in \[page\] is not known; did you mean 'view'"),
        (f"{JOINT}page = {{view = 'pres'}}", "design 1: 'pres' as view is not known"),
        (f"{JOINT}page = {{view = ['map', 'cup']}}", r"design 1: 'view' is given 2 times in \[page\]"),
        (f"{JOINT}page = {{load = {{force = 3}}}}", r"design 1: 'load' in \[page\] belongs to the design"),
        (f"{JOINT}page = {{use = {{cycle = 'jog'}}}}", "design 1: 'jog' as cycle is not known"),
    ],
)
def test_a_bad_session_file_is_one_sentence(text, sentence):
    with pytest.raises(ValueError, match=sentence) as refused:
        read_upload(text, START)
    assert len(str(refused.value)) < 400


def test_what_could_not_be_read_is_not_written():
    link = link_of(replace(START, file=replace(START.file, joint=replace(START.file.joint, name="ü" * 900))))
    with pytest.raises(ValueError, match=f"the session file would be larger than {MAX_FILE_SIZE} bytes"):
        session_text([link + "&ask.context=" + "y" * 999] * MAX_DESIGNS)
    with pytest.raises(ValueError, match=f"a session has 1 to {MAX_DESIGNS} designs, got 0"):
        session_text([])
    with pytest.raises(ValueError, match="'frob' in the link is not known"):
        session_text(["frob=1"])


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("hip 36 a", "hip-36-a"),
        ("hip-28 (changed)", "hip-28-changed"),
        ("../../etc/passwd", "etc-passwd"),
        ("a<b>:c|d?*", "a-b-c-d"),
        ("Hüfte 3", "Hüfte-3"),
        ("nul.txt", "design-nul.txt"),
        ("", "ballsocket"),
    ],
)
def test_a_file_has_the_name_of_its_design(name, stem):
    assert file_stem(name) == stem


@pytest.mark.long
@given(st.text(max_size=100))
def test_a_file_name_is_one_that_every_system_takes(name):
    stem = file_stem(name)
    assert stem
    assert len(stem.encode()) < 250
    assert not set(stem) & set('<>:"/\\|?*\0 ')
    assert stem[0] not in ".-"
    assert stem[-1] not in ". "


def names(user):
    return user.page.locator("#design-list li > button:not([data-design])").all_text_contents()


def address(user):
    """Return the link in the address, without its theme."""
    return {name: value for name, (value,) in parse_qs(urlsplit(user.page.url).query).items() if name != "theme"}


def does(user, action):
    user.page.locator(f"[data-design={action}]").click()
    return user.answered()


@pytest.mark.long
def test_designs_are_named_kept_compared_saved_and_opened(user, profile, tmp_path):
    page = user.open().page
    user.types("name", "hip 36 a")
    user.answered()
    page.locator("#designs summary").click()
    assert names(user) == ["hip 36 a"]
    does(user, "duplicate")
    user.types("ball_radius", "36")
    user.answered()
    assert names(user) == ["hip 36 a", "hip 36 a copy"]
    assert address(user)["joint.ball_radius"] == "18.0"

    other = User(profile, user.address).open()  # a second window adds one, and changes no other
    other.page.locator("#designs summary").click()
    other.types("name", "from the other window")
    other.answered()
    other.page.close()
    page.locator("#design-list li", has_text="from the other window").wait_for()
    user.types("clearance", "0.3")
    user.answered()

    page.locator("#design-list button", has_text="hip 36 a").first.click()
    user.answered()
    assert address(user)["joint.ball_radius"] == "14.0"
    page.get_by_label("Compare hip 36 a copy").check()
    does(user, "compare")
    compared = address(user)
    assert (compared["view"], compared["beside1.name"]) == ("compare", "hip 36 a copy")
    assert (compared["beside1.joint.ball_radius"], compared["beside1.joint.clearance"]) == ("18.0", "0.15")
    page.go_back()
    page.wait_for_function("!location.search.includes('beside1')")
    user.answered()

    with page.expect_download() as coming:
        page.locator(".files button", has_text="TOML").click()
    assert coming.value.suggested_filename == "hip-36-a.toml"
    with page.expect_download() as coming:
        page.locator("[data-design=save]").click()
    assert coming.value.suggested_filename == "designs.toml"
    saved = tmp_path / "designs.toml"
    coming.value.save_as(saved)
    assert [design["name"] for design in tomllib.loads(saved.read_text("utf-8"))["design"]] == names(user)

    does(user, "remove")
    assert names(user) == ["hip 36 a copy", "from the other window"]
    page.reload()
    user.answered()
    page.locator("#designs summary").click()
    assert names(user) == ["hip 36 a copy", "from the other window"]
    page.locator("#joint-file").set_input_files(saved)
    page.locator("#design-list button[aria-current]", has_text="hip 36 a").wait_for()
    user.answered()
    assert names(user) == ["hip 36 a copy", "from the other window", "hip 36 a"]  # two were still there
    assert address(user)["name"] == "hip 36 a"


@pytest.mark.long
def test_a_refused_number_stays_in_its_box_with_the_reason(user):
    page = user.open().page
    box = user.types("ball_radius", "-5")
    error = page.locator("#error-ball_radius")
    error.wait_for()
    assert error.text_content() == "Head diameter must be positive, got -5 mm; 28 mm stays in use"
    user.types("clearance", "0,3")
    user.answered()
    assert box.input_value() == "-5"
    assert (box.get_attribute("aria-invalid"), box.get_attribute("aria-describedby")) == ("true", "error-ball_radius")
    assert address(user)["joint.ball_radius"] == "14.0"
    box.fill("")
    box.press("Enter")
    error.wait_for(state="hidden")
    assert box.input_value() == "28"
    box.press("ArrowUp")
    user.answered()
    assert address(user)["joint.ball_radius"] == "14.1"
    sliders = page.locator(".side input[type=range]:visible")
    assert {slider.get_attribute("tabindex") for slider in sliders.all()} == {"-1"}
