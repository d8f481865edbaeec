"""The explorer in a real browser: files, handles, undo and redo, a narrow screen, maps, and pictures that move."""

import re
import tomllib
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import ballsocket as bs
from ballsocket.files.joint_file import parse_joint

from ..places import EXAMPLES
from ..processes import wait_until
from .browser import NARROW, User, expect, opened_profile, pressure

pytestmark = pytest.mark.long


def test_on_a_narrow_screen_the_answers_come_first_and_no_column_lies_beside_it(browser, address):
    with opened_profile(browser, address, NARROW, dark=True) as profile:
        reader = User(profile, address).open()
        page, top = reader.page, "document.querySelector('dd[data-name=max_pressure]')?.getBoundingClientRect().y"
        page.locator(".app.dark").wait_for()  # as the reader's system is
        reader.until(f"{top} < 400")
        page.locator("summary", has_text="The joint").click()
        reader.nudge("clearance")
        assert reader.answered().shows("max_pressure", pressure(clearance=0.105))
        reader.until(f"{top} < 800")
        table = page.locator(".models")
        table.wait_for()
        assert table.evaluate("(one) => one.scrollWidth <= one.clientWidth")
        assert page.evaluate("document.documentElement.scrollHeight") < 4000  # the models are a compact table
        page.get_by_label("All numbers of each model").check()
        cell = table.locator("td[data-head*=pmax]").first
        assert "pmax" in cell.evaluate("(one) => getComputedStyle(one, '::before').content")
        assert not reader.errors


def test_the_client_view_has_no_button_of_the_evidence_but_shows_it_by_a_link(user):
    user.open("?view=evidence&preset=hip-28")
    section, button = (user.page.locator(f"{place} [data-view=evidence]") for place in ("#view", ".views"))
    expect(button).to_be_visible()
    user.page.get_by_role("button", name="Client view").click()
    user.page.reload()
    user.answered()
    expect(section).to_be_visible()
    expect(button).to_be_hidden()


def test_changes_are_undone_and_done_again(user):
    """A preset, keys of a slider, and a view are a step each; text in a box has its own undo."""

    def shows(*joint, **changes):
        return user.answered().shows("max_pressure", pressure(*joint, **changes))

    def press(keys):
        user.page.evaluate("document.activeElement.blur()")
        user.page.keyboard.press(keys)

    user.page.add_init_script("performance.now = () => 0")  # no pause between two keys ends their step
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


def test_the_history_says_what_each_step_changed_and_did_and_leads_back(user):
    page = user.open("?preset=hip-28&load.force=3000").page
    page.get_by_text("History", exact=True).click()
    user.enters("load", "9000")
    assert user.shows("max_pressure", pressure(force=9000.0))
    user.enters("ball_radius", "36")
    steps = page.locator("#step-list button")
    expect(steps).to_have_count(3)
    first, last = (f"{pressure(force=force):.4g} MPa" for force in (3000.0, 9000.0))
    expect(steps.nth(1)).to_contain_text("Normal force 3000 N → 9000 N")
    expect(steps.nth(1)).to_contain_text(f"{first} ✓ → {last} ✗")
    expect(steps.first).to_contain_text("Head diameter 28 mm → 36 mm")
    steps.last.click()
    assert user.answered().shows("max_pressure", pressure())
    expect(steps).to_have_count(3)
    expect(steps.last).to_have_attribute("aria-current", "true")


def test_a_typed_number_is_marked_counts_as_it_stands_and_is_undone_from_its_box(user):
    box = user.open("?preset=hip-28&load.force=2222&units=imperial").page.locator("[data-name=load] input[type=text]")
    shown = box.input_value()  # 2222 N, rounded
    box.fill(shown)
    expect(box).to_have_attribute("data-typing", "yes")
    box.press("Enter")
    user.until("!location.search.includes('load.force=2222')")
    user.answered()
    assert float(user.link()["load.force"]) == pytest.approx(float(shown) * 4.4482216152605)
    user.page.keyboard.press("Control+z")  # the focus is in the box
    user.until("location.search.includes('load.force=2222')")
    expect(user.page.locator("#undo")).to_be_disabled()
    expect(user.page.locator("#redo")).to_be_enabled()


def test_a_link_with_a_mistake_keeps_its_address_and_greys_the_rest(reader):
    wrong = "?joint.ball_radius=abc&load.force=3000"
    page = reader.open(wrong).page
    assert reader.says("ball_radius = 'abc'")
    page.locator("[data-unread]").wait_for()
    assert page.url.endswith(wrong)
    reader.enters("load", "2000")
    reader.until("location.search.includes('load.force=2000')")
    assert page.locator("[data-unread]").count() == 0


def test_a_border_that_is_held_follows_the_pointer_and_does_not_run_away(reader):
    page = reader.open().page
    field = page.locator("[data-name=liner_thickness] input[type=text]")
    x, y = page.locator("[data-drag=liner_thickness]").evaluate("""(arc) => {
      const { x, y } = arc.getPointAtLength(arc.getTotalLength() / 2).matrixTransform(arc.getScreenCTM());
      return [x, y];
    }""")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y + 11)
    reader.answered()
    thicknesses = []
    for down in (12, 11) * 4:
        page.mouse.move(x, y + down)
        reader.answered()
        thicknesses.append(float(field.input_value()))
    page.mouse.up()
    assert min(thicknesses) > 5.0
    assert max(thicknesses) - min(thicknesses) < 0.25  # a pixel is 0.1 mm, and so is a step


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


def test_a_refused_number_stays_in_its_box_with_the_reason(reader):
    page, box = reader.open().page, reader.types("ball_radius", "-5")
    error = page.locator("#error-ball_radius")
    error.wait_for()
    assert error.text_content() == "Head diameter must be positive, got -5 mm; 28 mm stays in use"
    reader.enters("clearance", "0,3")
    assert box.input_value() == "-5"
    assert (box.get_attribute("aria-invalid"), box.get_attribute("aria-describedby")) == ("true", "error-ball_radius")
    assert reader.link()["joint.ball_radius"] == "14.0"
    box.fill("")
    box.press("Enter")
    error.wait_for(state="hidden")
    assert box.input_value() == "28"
    box.press("ArrowUp")
    reader.answered()
    assert reader.link()["joint.ball_radius"] == "14.1"
    sliders = page.locator(".side input[type=range]:visible")
    assert {slider.get_attribute("tabindex") for slider in sliders.all()} == {"-1"}


MAP = "?view=map&limit=outer_radius<=26"
CUP = "preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"


def spot(user, across, up):
    """The point of the screen at two shares of the map."""
    frame = user.page.locator("#map-picture .frame")
    frame.wait_for()
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    return box["x"] + across * box["width"], box["y"] + (1 - up) * box["height"]


def test_a_click_on_the_map_shows_a_design_that_is_used_in_one_step(user):
    user.open(MAP)
    user.page.mouse.click(*spot(user, 0.25, 0.25))
    user.page.locator("button", has_text="Use this design").click()
    user.until("location.search.includes('joint.head_diameter')")
    taken = [float(user.link()[f"joint.{name}"]) for name in ("head_diameter", "liner_thickness")]
    assert taken == pytest.approx([28.0, 6.0], abs=0.1)
    user.answered()
    user.page.go_back()
    user.until("location.search.includes('preset=hip-28')")
    user.answered()
    expect(user.page.locator("[data-name=ball_radius] input[type=text]")).to_have_value("28")


def test_everything_on_the_map_is_done_by_keys(reader):
    reader.open(MAP)
    reader.page.mouse.move(*spot(reader, 0.25, 0.75))
    cursor = reader.page.locator("#map-picture .cursor")
    head, liner = map(float, re.findall(r"([\d.]+) mm", cursor.locator("text").first.text_content()))
    assert (head, liner) == pytest.approx((28.0, 12.0), abs=0.1)
    cursor.focus()
    cursor.press("Shift+ArrowRight")
    cursor.press("ArrowDown")
    numbers = [float(number) for number in re.findall(r"\]: ([\d.]+)", cursor.get_attribute("aria-label"))]
    assert numbers[:2] == pytest.approx([head + 2.4, liner - 0.24], abs=0.02)
    assert numbers[2] == pytest.approx(pressure(ball_radius=numbers[0] / 2, liner_thickness=numbers[1]), rel=0.01)
    cursor.press("Enter")
    reader.page.locator("#map-point table").wait_for()
    reader.answered()
    expect(cursor).to_be_focused()
    square = reader.page.locator("#map-picture [data-limit]")
    square.focus()
    for _ in range(3):
        square.press("ArrowUp")
        reader.answered()
    reader.until("location.search.includes('limit=outer_radius%3C%3D29.0')")
    reader.answered()
    expect(square).to_be_focused()
    expect(reader.page.locator(".rows input[type=text]")).to_have_value("29")


def share_of_colours(pixels):
    """Share of pixels with the colours of a pressure: the cup and the page are nearly grey."""
    return float((pixels.max(axis=2) - pixels.min(axis=2) > 90).mean())


def difference(one, other):
    """Mean difference where both pictures lie: a box between two pixels is rounded to either, in size and in place."""
    height, width = np.minimum(one.shape, other.shape)[:2] - 2
    middle = one[1 : height + 1, 1 : width + 1]
    shifted = (other[down : down + height, right : right + width] for down in range(3) for right in range(3))
    return min(float(np.abs(middle - picture).mean()) for picture in shifted)


def seen(canvas, condition):
    """Take pictures until one meets a condition and the next is equal, as a moving canvas is drawn sharp at its end."""
    pictures = [None]

    def picture():
        pictures.append(np.asarray(Image.open(BytesIO(canvas.screenshot())).convert("RGB")).astype(int))
        return condition(pictures[-1]) and np.array_equal(*pictures[-2:])

    wait_until(picture)
    return pictures[-1]


def test_the_cup_turns_and_a_place_on_the_map_is_taken(reader):
    reader.open(f"?view=cup&{CUP}")
    viewer = reader.page.locator("#cup-viewer .viewer")
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
    reader.page.mouse.move(box["x"] + 100, box["y"] + 100)
    reader.page.mouse.down()
    reader.page.mouse.move(box["x"] + 180, box["y"] + 120)
    reader.page.mouse.up()
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
    stood = reader.page.locator("#cup-stood svg")
    stood.scroll_into_view_if_needed()
    place = stood.bounding_box()
    reader.page.mouse.click(place["x"] + 0.5 * place["width"], place["y"] + 0.4 * place["height"])
    reader.until("!location.search.includes('cup.inclination=45.0')")
    reader.answered()
    inclination = float(reader.page.locator("[data-name='cup.inclination'] input[type=text]").input_value())
    assert 40 < inclination < 46


def test_a_cycle_is_played_and_stops_where_it_is(reader):
    reader.open(f"?view=gait&{CUP}")
    button = reader.page.locator(".transport button")
    button.wait_for()
    output, canvas = reader.page.locator(".player output"), reader.page.locator(".player canvas")
    few = 0.7 * share_of_colours(seen(canvas, lambda pixels: share_of_colours(pixels) > 0))
    bar = reader.page.locator(".transport input")
    button.click()
    reader.until("document.querySelector('.transport input').value > 9")
    button.click()
    reader.until(f"location.search.includes('use.instant={bar.input_value()}')")
    bar.fill("160")  # of 200: the leg swings
    seen(canvas, lambda pixels: share_of_colours(pixels) < few)  # and presses less
    bar.focus()
    bar.press("Home")
    assert output.inner_text().startswith("0.5 % of the cycle: load ")
    reader.until("location.search.includes('use.instant=0')")
    reader.page.locator(".player .spot").nth(2).wait_for()  # load, pressure, distance; the film follows
    smallest = reader.page.evaluate("""() => Math.min(...[...document.querySelectorAll('.courses text')].map((text) =>
        parseFloat(getComputedStyle(text).fontSize) *
        Math.hypot(text.getScreenCTM().a, text.getScreenCTM().b)))""")
    assert smallest >= 11.5


NO_WEBGL = """HTMLCanvasElement.prototype.getContext = ((get) => function (kind, ...more) {
    return kind === "webgl2" ? null : get.call(this, kind, ...more); })(HTMLCanvasElement.prototype.getContext)"""


def test_a_browser_without_webgl_is_shown_the_flat_view(user):
    user.page.add_init_script(NO_WEBGL)
    user.open(f"?view=cup&{CUP}")
    assert user.says("This browser has no WebGL 2")
    assert "from the rim" in user.page.locator("#cup-map svg").get_attribute("aria-label")


def test_a_lost_context_is_restored(reader):
    reader.open(f"?view=cup&{CUP}")
    canvas = reader.page.locator("#cup-viewer canvas")
    canvas.wait_for()
    before = seen(canvas, lambda pixels: share_of_colours(pixels) > 0.04)
    lose = "canvas => (window.lost = canvas.getContext('webgl2').getExtension('WEBGL_lose_context')).loseContext()"
    canvas.evaluate(lose)
    seen(canvas, lambda pixels: share_of_colours(pixels) < 0.01)
    canvas.press("ArrowLeft")  # nothing breaks
    canvas.press("ArrowRight")
    reader.page.evaluate("window.lost.restoreContext()")
    seen(canvas, lambda pixels: difference(pixels, before) < 0.5)


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


def test_rows_of_limits_are_added_refused_and_taken_away(user):
    user.open("?view=map")
    user.page.locator("button", has_text="Add a limit").click()
    row = user.page.locator(".rows")
    box = row.locator("input[type=text]")
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
    assert box.count() == 0
    expect(user.page.locator("button", has_text="Add a limit")).to_be_focused()


def test_a_chart_is_zoomed_and_its_points_are_copied(reader):
    page = reader.open("?preset=hip-28&load.force=3000").page
    chart = page.locator("#press-charts figure").first

    def ends():
        ticks = chart.locator("svg[data-chart] > text.tick[text-anchor=middle]").all_text_contents()
        return float(ticks[0]), float(ticks[-1])

    chart.wait_for()
    whole = ends()
    chart.locator("button", has_text="Zoom").click()
    low, high = ends()
    assert whole[0] < low < high < whole[1]
    reader.nudge("load")
    reader.answered()
    assert ends() == (low, high)  # it outlives an answer
    reader.view("Compare")
    expect(page.locator("#compare-charts button", has_text="Zoom").first).to_be_visible()
    expect(page.locator("#compare-charts button", has_text="All").first).to_be_hidden()  # a zoom is of its view
    reader.view("Contact")
    assert ends() == (low, high)
    reader.drags("#press-charts figure:first-of-type svg[data-chart]", (40, 0))
    assert low <= ends()[0] < ends()[1] < high
    chart.locator("button", has_text="All").click()
    assert ends() == whole
    chart.locator("button", has_text="CSV").click()
    reader.says("copied")
    head, first, *_ = page.evaluate("navigator.clipboard.readText()").splitlines()
    assert head == '"curve","polar angle φ [°]","contact pressure p [MPa]"'
    name, angle, largest = first.split(",")
    assert (name, float(angle)) == ('"exact"', 0.0)
    assert float(largest) == pytest.approx(reader.number("max_pressure"), rel=1e-3)
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(new Error('not allowed')) }")
    chart.locator("button", has_text="CSV").click()
    reader.says("save the numbers of the view")


def test_a_zoom_holds_between_the_points_of_a_curve_and_at_first_contact(reader):
    chart = reader.open("?preset=hip-28&load.force=3000").page.locator("#press-charts figure").last
    chart.evaluate("figure => figure.show([1e-9, 2e-9])")  # between the first two points, in mm
    ticks = chart.locator("svg[data-chart] > text.tick[text-anchor=middle]").all_text_contents()
    assert all(1e-9 <= float(tick) <= 2e-9 for tick in ticks)
    chart.evaluate("figure => figure.show([0, 1e-9])")  # with no point but that without a load
    assert "NaN" not in chart.locator("svg[data-chart]").evaluate("svg => svg.outerHTML")
    chart.evaluate("figure => figure.show(null)")


def test_an_explanation_is_sent_when_it_is_opened_and_keeps_the_focus(reader):
    page = reader.open("?preset=hip-28&load.force=3000").page
    summary = page.locator("[data-why=area] > summary")
    assert page.locator("[data-why=area] p").text_content() == ""
    summary.press("Enter")
    expect(page.locator("[data-why=area] p")).to_contain_text("R1 = 14 mm")
    expect(summary).to_be_focused()
    reader.nudge("load")
    reader.answered()
    expect(page.locator("[data-why=area] p")).to_be_visible()
    summary.press("Enter")
    reader.answered()
    expect(page.locator("[data-why=area][open]")).to_have_count(0)
