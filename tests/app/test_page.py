"""The explorer's page without a browser: messages, files, layers of a socket, compared designs, and the design map."""

import json
import re
from dataclasses import replace
from html import unescape
from math import degrees, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app import server as serve
from ballsocket.app.long_view import LongView
from ballsocket.app.pictures.contour_map import MapPlane
from ballsocket.app.session import Page
from ballsocket.app.state.screen import AXES, START, VIEWS, MapAxis
from ballsocket.app.views import design_map as map_view
from ballsocket.app.views import map_study
from ballsocket.app.views.contact import Press
from ballsocket.app.views.map_study import catalogue_sizes, mapped, models_of
from ballsocket.app.widgets.limit_rows import present_value
from ballsocket.core.quantities import QUANTITIES
from ballsocket.design_checks import checks_of
from ballsocket.files.joint_file import JointFile, parse_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.problem import Support
from ballsocket.problem.cup import Cup
from ballsocket.reports import svg

from ..extent import either, some
from .asking import blocks, cells, does, edits, numbers, saved, told, trouble

LOADS = ("force=500", "indentation=0.01", "half_angle=20")
EACH_ONCE = [(preset, LOADS[number % 3]) for number, preset in enumerate(bs.joints)]


@pytest.mark.parametrize(("preset", "load"), either(quick=EACH_ONCE[::3], long=EACH_ONCE))
def test_every_preset_can_be_seen_under_every_load(preset, load):
    for view in ("press", "map", "compare"):
        model = "hertz" if preset == "tilting-pad-pivot" else "tabulated"
        page = Page(f"view={view}&preset={preset}&load.{load}&map_model={model}")
        assert trouble(page) == ""
        assert page.view.document(page.screen).rows()


@pytest.mark.long
@pytest.mark.parametrize("view", VIEWS)
def test_every_view_shows_a_preset_and_writes_its_files(view):
    page = Page(f"view={view}&preset=hip-28&load.force=3000")
    assert (page.screen.view, trouble(page)) == (view, "")
    assert f'data-view="{view}">' in serve.page_files(None)["page.html"][1]
    if isinstance(page.view, LongView):
        return  # its files need a result that takes seconds
    header, *_ = page.view.document(page.screen).rows()
    assert saved(page, "CSV").decode("utf-8-sig").startswith(str(header[0]))
    assert b"hip-28" in saved(page, "HTML")


@pytest.mark.parametrize("link", ["load.force=1e-320", "view=compare&load.force=0&beside1.preset=hip-36"])
def test_the_smallest_loads_that_a_link_can_state_are_shown(link, caplog):
    page = Page(f"{link}&preset=hip-28")
    assert trouble(page) == ""
    assert page.view.document(page.screen).rows()
    assert not caplog.records


@pytest.mark.parametrize(("angle", "unit", "factor"), [("degrees", "°", 57.29577951308232), ("radians", "rad", 1.0)])
def test_a_map_of_angles_has_the_unit_that_is_chosen(angle, unit, factor):
    page = Page(f"view=map&quantity=half_angle&angle={angle}&preset=hip-28")
    found = mapped(page.screen)
    least = float(found.half_angle.min()) * factor
    gap = "" if unit == "°" else " "
    assert f"Minimum of the half angle: <b>{least:.4g}{gap}{unit}</b>" in page.channel.shown_value("#map-note")


def test_what_is_too_long_for_a_link_does_not_come_on_the_screen():
    page = Page("")
    before = page.screen
    unnamed = toml_of(before.file).partition("source")[2].partition("\n")[2]
    does(page, "upload", text=f'name = "{"€" * 999}"\n{unnamed}')
    assert page.screen == before
    assert "a link to this would be longer than 8000 characters" in trouble(page)


def test_names_that_are_formulas_elsewhere_are_text_in_files():
    joint = "".join(f"&beside1.{part}" for part in OWN.split("&"))
    page = Page(f"view=compare&preset=hip-28&beside1.name==1%2B1 $\\frac{{a${joint}")
    assert trouble(page) == ""
    assert b"'=1+1" in saved(page, "CSV")
    assert saved(page, "PNG").startswith(b"\x89PNG")


@pytest.mark.parametrize("where", [(70000,), (0, "nowhere.invalid"), (0, "a" * 300)])
def test_a_port_or_an_address_that_is_none_is_refused(where):
    with pytest.raises(ValueError, match=rf"^(port|address) = '?{str(where[-1])[:9]}.* is not allowed"):
        serve.server(*where)


def test_a_map_is_drawn_and_clicked_in_the_unit_that_its_axis_names():
    """An indentation runs over micrometres, and a click at 40 of them picks 0.04 mm."""
    page = Page("view=map&preset=hip-28&load.indentation=0.03&across=indentation=0.02..0.06&up=ball_radius=12..16")
    picture = page.channel.shown_value("#map-picture")
    assert "indentation d [µm]" in picture
    assert 'data-ends="20 60 12 16"' in picture
    assert float(re.search(r'class="here" [^>]*cy="([\d.]+)"', picture)[1]) == 12 + 296 / 2  # 14 mm
    edits(page, "map.pick", [40.0, 14.0])
    edits(page, "map.use", True)
    assert page.screen.file.load == {"indentation": pytest.approx(0.04)}
    assert page.screen.file.joint.ball_radius == 14.0


def test_the_exact_curve_lies_below_those_through_which_it_can_be_seen():
    page = Page(f"view=press&preset=hip-28&load.force=3000&shown={','.join(reversed([*bs.catalogue]))}")

    def curves():
        (drawn,) = blocks(page, "press-charts", "charts")
        return [[curve["name"] for curve in chart["curves"]] for chart in drawn["charts"]]

    assert [(names[0], set(names)) for names in curves()] == 2 * [("exact", set(bs.catalogue))]
    does(page, "edit", name="press.shown", value=["exact", "hertz"])
    assert curves() == 2 * [["exact", "hertz"]]


def test_only_what_has_changed_is_shown_and_sent(monkeypatch):
    page, shown = Page(""), []
    answer = edits(page, "load", 2900)
    assert answer["=load"] == page.channel.shown_value("=load")
    assert answer["=load"]["value"] == 2900
    assert numbers(page, "press-numbers")["force"] == 2900.0
    assert not {"=clearance", "@controls", "view", "#trouble"} & set(answer)
    assert set(edits(page, "load", 2900)) == {"n", "question"}
    monkeypatch.setattr(Press, "show", lambda self, screen: shown.append(screen.size))
    page.ask(view="press")
    page.ask(size="radius")
    assert shown == ["radius"]


@pytest.mark.parametrize("text", ["0,2", "0.2", " 0,2 mm", "200 um", ",2", 0.2])
def test_a_number_is_understood_as_people_write_it(text):
    page = Page("size=radius")
    edits(page, "clearance", text)
    assert page.screen.file.joint.clearance == pytest.approx(0.2, rel=1e-12)


@pytest.mark.parametrize("view", some(["press", "compare"], 1))
def test_files_have_the_joint_and_reports_its_inputs_and_no_machine(view):
    page = Page(f"view={view}&preset=hip-32&load.force=2500")
    text = saved(page, "HTML").decode()
    for part in ("Drawing", "Inputs", "head diameter", "SHA-256", "In the explorer: <code>/?"):
        assert part in text, part
    assert ("<span class='holds'>Kept: " in text) == (view == "press")
    assert "data:image/png;base64" in text
    assert "localhost" not in text
    assert "http" not in text.replace("http://www.w3.org", "")
    assert saved(page, "PNG").startswith(b"\x89PNG")
    assert b"<svg" in saved(page, "SVG")
    assert parse_joint(saved(page, "TOML"), "saved") == JointFile(bs.joints["hip-32"], {"force": 2500.0})


HIP = "preset=hip-28&load.force=3000"


def test_a_backing_is_built_from_bone_to_shell_of_at_most_twenty_layers():
    page = Page(HIP)
    page._refresh()
    edits(page, "behind.add", "titanium")
    edits(page, "behind.add", "bone-cement")
    shell, cement = page.screen.file.joint.backing
    assert (shell.material, cement.material) == (bs.TITANIUM, bs.BONE_CEMENT)
    assert shell.thickness == cement.thickness == 3.0
    edits(page, "behind.1", "cancellous-bone")
    edits(page, "layer1", "8")
    edits(page, "behind.support", "free")
    joint = page.screen.file.joint
    assert joint.backing[1] == bs.Layer(thickness=8.0, material=bs.CANCELLOUS_BONE)
    assert (joint.support, joint.name, joint.source) == (Support.FREE, "hip-28 (changed)", "")
    assert Page(page.channel.shown_value("link")).screen == page.screen
    expected = bs.Exact().press(joint, force=3000.0).max_pressure
    assert numbers(page, "press-numbers")["max_pressure"] == expected
    edits(page, "behind.0", "away")
    edits(page, "behind.0", "away")
    joint = page.screen.file.joint
    assert joint == bs.joints["hip-28"]  # nothing is left to be free, or to be changed
    assert "behind.0" not in page.channel.shown_value("@controls")
    layers = "".join(f"&backing.{place}.material=titanium&backing.{place}.thickness=3" for place in range(19))
    page = Page(f"view=judge&{OWN}{layers}")  # where nothing is pressed
    edits(page, "behind.add", "titanium")
    assert len(page.screen.file.joint.backing) == 20
    edits(page, "behind.add", "titanium")
    assert "'titanium' is one layer too many: at most 20" in unescape(trouble(page))


def test_joints_are_compared_with_the_one_that_is_chosen_also_when_another_is_removed():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36&beside2.preset=hip-32")
    assert "the difference from hip-36" in told(page, "compare-note")
    options = page.channel.shown_value("=compare.base")["options"]
    assert options == [["0", "this design"], ["1", "hip-36"], ["2", "hip-32"]]
    edits(page, "compare.base", "0")
    assert "the difference from this design" in told(page, "compare-note")
    mine, other = (bs.Exact().press(bs.joints[name], force=3000.0).max_pressure for name in ("hip-28", "hip-36"))
    table = told(page, "compare-table")
    assert f"{float(other):.4g}" in table
    assert f"{100 * (other / mine - 1):+.0f} %" in table
    assert "base=0" in page.channel.shown_value("link")
    assert Page(f"view=compare&{HIP}").screen.base == "1"  # nothing has been chosen by looking
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36")
    edits(page, "compare.preset", "hip-32")
    edits(page, "compare.base", "2")
    edits(page, "compare.remove", "hip-36")
    assert "the difference from hip-32" in told(page, "compare-note")
    edits(page, "compare.remove", "hip-32")
    assert page.screen.beside == ()
    assert "the difference from hip-36" in told(page, "compare-note")  # the example
    edits(page, "compare.keep", True)
    assert page.screen.beside == (page.screen.file,)


def test_six_designs_are_compared_by_the_checks_of_contact():
    """The von Mises stress of the checks is that of the model itself, as in Contact."""
    names = [name for name in bs.joints if name not in ("hip-28", "hess-forsbach")][:6]
    beside = "&".join(f"beside{number}.preset={name}" for number, name in enumerate(names, start=1))
    page = Page(f"view=compare&{HIP}&{beside}")
    assert page.channel.shown_value("=compare.base")["options"][-1][0] == "6"
    contact = bs.Exact().press(page.screen.file.joint, force=3000.0)
    checks = checks_of(contact, Cup(), float(contact.von_mises))
    (check,) = [row for row in checks if "stress in the liner" in row.title]
    rows = {name: mine for name, mine, *_ in cells(page, "compare-table")}
    assert rows[f"{check.title} / {check.limit}"] == f"✓ {100 * check.ratio.value:.0f} %"
    does(page, "view", value="press")
    assert f"{100 * check.ratio.value:.0f} %" in told(page, "press-numbers")
    does(page, "view", value="compare")
    edits(page, "compare.keep", True)
    assert "6 designs are compared with this one already" in trouble(page)


MAP = "view=map&preset=hip-28&load.force=3000&across=ball_radius=11..23"


def part(page, name):
    return told(page, f"map-{name}")


def found(page):
    return mapped(page.screen)


def on_axes(x, y):
    """The numbers of a point of the picture, for the axes of MAP."""
    left, top, right, foot = 58.0, 12.0, 426.0, 308.0  # of the map in its picture
    return 11 + 12 * (x - left) / (right - left), 3 + 12 * (foot - y) / (foot - top)


def handles(page):
    """Text and point of each square of a limit."""
    pattern = r'aria-valuetext="([^"]+)" data-limit="(\d)"[^>]+translate\(([\d.]+) ([\d.]+)\)'
    squares = re.findall(pattern, part(page, "picture"))
    return {int(number): (text, *on_axes(float(x), float(y))) for text, number, x, y in squares}


def pressure_at(radius, thickness):
    joint = bs.joints["hip-28"].replace(ball_radius=radius, liner_thickness=thickness)
    return float(bs.catalogue["tabulated"].press(joint, force=3000.0).max_pressure)


def test_contours_and_the_value_under_the_pointer_are_those_of_the_study():
    page, study = Page(MAP), found(Page(MAP)).max_pressure
    label = r'<text x="([\d.]+)" y="([\d.]+)" text-anchor="middle" class="on">([\d.]+)<'
    labels = [map(float, numbers) for numbers in re.findall(label, part(page, "picture"))]
    assert len(labels) >= 4
    for x, y, value in labels:
        radius, thickness = on_axes(x, y - 4)
        assert study.interp(ball_radius=radius, liner_thickness=thickness) == pytest.approx(value, rel=0.01)
    values = np.array(json.loads(re.search(r'data-values="([^"]+)"', part(page, "picture"))[1]))
    assert values == pytest.approx(study.transpose("liner_thickness", "ball_radius").values[::2, ::2], rel=1e-3)


def test_a_limit_is_moved_by_its_line():
    page = Page(f"{MAP}&limit=outer_radius<=26&limit=max_pressure<=12&limit=liner_thickness>=1")
    squares = handles(page)
    assert list(squares) == [0, 1]  # the line of the last one is beside the map
    assert squares[0][0] == "outer radius at most 26 mm"
    assert squares[0][1] + 0.1 + squares[0][2] == pytest.approx(26.0, abs=0.02)
    edits(page, "map.drag", [1, 20.0, 8.0])
    assert page.screen.limits[1].high == pytest.approx(pressure_at(20.0, 8.0), rel=0.01)
    assert [limit.name for limit in page.screen.limits] == ["outer_radius", "max_pressure", "liner_thickness"]
    assert "limit=max_pressure" in page.channel.shown_value("link")


def test_a_picked_point_is_shown_beside_the_design_and_used_in_one_step():
    page = Page(MAP)
    edits(page, "map.pick", [15.3, 6.7])
    assert "picked=15.3%2C6.7" in page.channel.shown_value("link")
    assert 'class="picked"' in part(page, "picture")
    assert f'"{pressure_at(15.3, 6.7):.4g}"' in part(page, "point")
    again = Page(page.channel.shown_value("link"))
    assert again.screen == page.screen
    assert (part(again, "point"), part(again, "picture")) == (part(page, "point"), part(page, "picture"))
    edits(again, "map.up", "clearance")
    assert again.screen.picked is None
    edits(page, "map.use", True)
    assert (page.screen.view, page.screen.file.joint.ball_radius) == ("map", 15.3)
    assert 'class="picked"' not in part(page, "picture")
    assert "picked" not in page.channel.shown_value("link")
    edits(page, "map.use", True)
    assert "no point of the map is chosen" in trouble(page)
    assert "the point of the map: " in part(Page("view=map&preset=hip-28&picked=46,-300"), "point")


def test_the_design_with_the_smallest_value_is_the_best_of_the_allowed():
    page = Page(f"{MAP}&limit=outer_radius<=26")
    edits(page, "map.best", True)
    edits(page, "map.compare", True)
    (best,) = page.screen.beside
    study = found(page)
    fine = study.max_pressure.where(study.ball_radius + 0.1 + study.liner_thickness <= 26)
    pressed = bs.catalogue["tabulated"].press(best.joint, force=3000.0)
    assert pressed.max_pressure == pytest.approx(float(fine.min()), rel=1e-3)


def test_a_click_takes_sizes_of_a_catalogue():
    page = Page(f"{MAP}&sizes=catalogue")
    edits(page, "map.pick", [15.3, 6.7])
    edits(page, "map.use", True)
    joint = page.screen.file.joint
    assert (2 * joint.ball_radius, joint.liner_thickness) == (32.0, 7.0)
    assert catalogue_sizes({"head_diameter": 100.0, "clearance": 0.123}) == {"head_diameter": 44.0, "clearance": 0.123}


def test_ranges_are_two_fields_in_the_units_of_the_page():
    page = Page(f"{MAP}&units=imperial")
    field = page.channel.shown_value("=map.across_low")
    assert (field["text"], field["unit"]) == ("0.4331", "in")
    edits(page, "map.across_low", "12 mm")
    edits(page, "map.across_high", "1")
    assert (page.screen.across.low, page.screen.across.high) == (12.0, pytest.approx(25.4))
    edits(page, "map.across_low", "2")
    assert "ball radius from 2 in to 1 in is not a range" in trouble(page)
    assert page.screen.across.low == 12.0


@pytest.mark.parametrize("name", AXES)
def test_no_range_ends_where_no_joint_is(name):
    """A map to 1e9 mm offered a ball of 1e9 mm as the best design."""
    up = START.across if name == START.up.name else START.up
    screen = replace(START, across=MapAxis(name=name, low=0.0, high=0.2), up=up)
    high = map_view.end_control(screen, "across", "high")
    for value in ("1e12", "-1e12"):
        with pytest.raises(ValueError, match="^x to must be "):
            high.read(value)
    assert high.read("0.3")["across"].high == pytest.approx(0.3 / screen.reading.unit(QUANTITIES[name]).factor)


def test_rows_of_limits_are_edited_and_a_refused_row_stays_as_typed_beside_its_reason():
    page = Page(f"{MAP}&limit=outer_diameter<=52")
    shown = page.channel.shown_value
    assert shown("=map.limits")["value"] == "outer diameter at most 52 mm"
    edits(page, "map.limits", True)  # a new row starts at the present design
    for name, value in (("quantity", "half_angle"), ("sign", ">="), ("value", "40,5")):
        edits(page, f"map.limits.1.{name}", value)
    assert page.screen.limits[1].low == pytest.approx(radians(40.5))
    field = edits(page, "map.limits.0.value", "wide")["=map.limits.0.value"]
    assert field["refused"] == "wide"
    assert field["error"].startswith("Outer diameter must be a number in mm")
    assert page.screen.limits[0].high == 52.0
    edits(page, "map.quantity", "area")  # another change keeps what was typed
    assert shown("=map.limits.0.value")["refused"] == "wide"
    edits(page, "map.limits.0.remove", True)
    assert [limit.name for limit in page.screen.limits] == ["half_angle"]
    assert "refused" not in shown("=map.limits.0.value")
    edits(page, "map.limits.0.sign", "<=")
    edits(page, "map.limits.0.quantity", "max_pressure")
    present = pressure_at(14.0, 5.0)
    (limit,) = page.screen.limits
    assert present <= limit.high == pytest.approx(present, rel=0.01)
    assert limit.high == float(f"{limit.high:.3g}")
    page = Page(f"view=map&{OWN}")
    edits(page, "map.limits", True)
    edits(page, "map.limits.0.quantity", "ball_young")
    assert "this design has no value for it" in trouble(page)
    assert page.screen.limits[0].name == "max_pressure"


def test_the_present_numbers_of_a_design():
    file = JointFile(bs.joints["hip-28"], {"force": 3000.0}, Cup(arc_of_cover=radians(170.0)))
    contact = bs.HessForsbach().press(file.joint, force=3000.0)
    assert present_value(file, "force") == 3000.0
    assert present_value(file, "outer_diameter") == pytest.approx(38.2)
    assert present_value(file, "liner_young") == 1000.0
    arc = 14.1 * radians(85.0 - degrees(contact.half_angle))
    assert present_value(file, "edge_distance", contact) == pytest.approx(arc)
    assert np.isnan(present_value(file, "indentation"))


def test_ticks_and_levels_are_round_and_enclose_the_values_and_crosses_mark_some_of_the_doubtful_points():
    assert svg.ticks_between(22.0, 46.0) == [25.0, 30.0, 35.0, 40.0, 45.0]
    assert svg.ticks_between(-10.0, 40.0) == [-10.0, 0.0, 10.0, 20.0, 30.0, 40.0]
    assert svg.levels_between(-3.2, 4.1, 8) == [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert svg.levels_between(3.0, 3.0) == [3.0, 3.5]
    line = np.linspace(0.0, 1.0, 61)
    plane = MapPlane(x=line, y=line, x_label="x", y_label="y")
    marked = np.zeros((61, 61), dtype=bool)
    assert list(plane.crosses(marked)) == []
    marked[:, 40:] = True
    (drawn,) = plane.crosses(marked)
    places = [float(x) + 3 for x in re.findall(r"M([\d.]+),", drawn)]
    assert len(places) == 2 * 15 * 5  # a light cross below each dark one
    assert min(places) == pytest.approx(plane.across(42 / 60), abs=0.06)


OWN = "joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=UHMWPE"
BACKING = "backing.0.thickness=3&backing.0.material=titanium&backing.1.thickness=2&backing.1.material=bone-cement"


def test_models_that_know_the_joint_are_offered_and_exact_is_one_of_them():
    offered = models_of(Page(f"{OWN}&{BACKING}&map_model=exact").screen)
    assert "exact" in offered
    assert "tabulated" not in offered  # its tables have one layer at most
    assert set(models_of(Page(MAP).screen)) >= {"exact", "tabulated", "refined", "plane-layer", "hertz"}


def test_a_backed_joint_is_mapped_by_the_exact_solution(monkeypatch):
    monkeypatch.setattr(map_study, "_SOLVED_POINTS", 4)
    page = Page(f"view=map&{OWN}&{BACKING}&load.force=3000&map_model=exact")
    assert "Minimum of the largest pressure" in part(page, "note")
    assert "exact" in [name for name, _ in page.channel.shown_value("=map.model")["options"]]
    assert found(page).attrs["model"] == "exact"


def test_a_map_that_would_take_minutes_is_refused():
    page = Page(f"{MAP}&map_model=exact&up=liner_thickness=0.1..1")
    assert "exact takes minutes where R2/L is above" in part(page, "trouble")
    page = Page(f"{MAP}&up=liner_thickness=0.1..1&map_model=refined")
    edits(page, "map.model", "exact")
    assert "exact takes minutes where R2/L is above" in trouble(page)
    assert page.screen.map_model == "refined"


def test_an_unexpected_failure_of_a_drawing_is_logged_and_a_sentence_and_the_page_is_idle(monkeypatch, caplog):
    def fail(*words):
        raise RuntimeError("no <luck>")

    page = Page("view=map&preset=hip-28&load.force=3000")
    assert "<svg" in part(page, "picture")
    monkeypatch.setattr(map_view, "map_picture", fail)
    edits(page, "ball_radius", 32)
    assert "This cannot be shown: no &lt;luck&gt;" in trouble(page)
    assert "a view failed" in caplog.text
    assert part(page, "picture") == part(page, "note") == ""
    assert page.channel.shown_value("expected") is None
    monkeypatch.undo()
    edits(page, "ball_radius", 30)
    assert "<svg" in part(page, "picture")
    assert page.channel.shown_value("#trouble") == ""
