"""The explorer's page without a browser: its messages, files, layers of a socket, and designs that are compared."""

import re
from itertools import product

import pytest

import ballsocket as bs
from ballsocket.app import server as serve
from ballsocket.app.session import Page
from ballsocket.app.views.contact.view import Press
from ballsocket.app.views.design_map.worker import mapped
from ballsocket.app.widgets.joint_fields import layers_edited
from ballsocket.files.joint_file import JointFile, parse_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.problem import Support
from ballsocket.problem.cup import Cup
from ballsocket.reports.check_table import checks_of

from ..extent import either
from .asking import does, edits, saved, trouble

LOADS = ("force=500", "indentation=0.01", "half_angle=20")
EACH_ONCE = [(preset, LOADS[number % 3]) for number, preset in enumerate(bs.joints)]


@pytest.mark.parametrize(("preset", "load"), either(quick=EACH_ONCE[::3], long=list(product(bs.joints, LOADS))))
def test_every_preset_can_be_seen_under_every_load(preset, load):
    for view in ("press", "map", "compare"):
        model = "hertz" if preset == "tilting-pad-pivot" else "tabulated"
        page = Page(f"view={view}&preset={preset}&load.{load}&map_model={model}")
        assert trouble(page) == ""
        assert page.view.document(page.screen).rows()


@pytest.mark.parametrize("link", ["load.force=1e-320", "view=compare&load.force=0&beside1.preset=hip-36"])
def test_the_smallest_loads_that_a_link_can_state_are_shown(link, caplog):
    page = Page(f"{link}&preset=hip-28")
    assert trouble(page) == ""
    assert page.view.document(page.screen).rows()
    assert not caplog.records


@pytest.mark.parametrize(("angle", "unit", "factor"), [("degrees", "°", 57.29577951308232), ("radians", "rad", 1.0)])
def test_a_map_of_angles_has_the_unit_that_is_chosen(angle, unit, factor):
    page = Page(f"view=map&quantity=half_angle&angle={angle}&preset=hip-28")
    found = mapped(page.screen.file, page.screen.across, page.screen.up, page.screen.map_model)
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
    page = Page(
        "view=compare&preset=hip-28&beside1.name==1%2B1 $\\frac{a$&beside1.joint.ball_radius=14"
        "&beside1.joint.clearance=.1&beside1.joint.liner_thickness=5&beside1.liner.material=pom"
    )
    assert trouble(page) == ""
    assert b"'=1+1" in saved(page, "CSV")
    assert saved(page, "PNG").startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("where", "sentence"),
    [
        ((70000,), "port = 70000 is not allowed: a port is 0 to 65535"),
        ((0, "nowhere.invalid"), "address = 'nowhere.invalid' is not allowed"),
        ((0, "a" * 300), "address = 'aaa.* is not allowed"),
    ],
)
def test_a_port_or_an_address_that_is_none_is_refused(where, sentence):
    with pytest.raises(ValueError, match=sentence):
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
    page = Page(f"view=press&preset=hip-28&load.force=3000&shown={','.join(reversed(bs.catalogue))}")
    curves = re.findall('data-name="([^"]+)"', page.channel.shown_value("#press-charts"))
    assert curves[0] == "exact"
    assert set(curves) == set(bs.catalogue)
    does(page, "choose", name="shown", value=["exact", "hertz"])
    assert set(re.findall('data-name="([^"]+)"', page.channel.shown_value("#press-charts"))) == {"exact", "hertz"}


def test_only_what_has_changed_is_shown_and_sent(monkeypatch):
    page, shown = Page(""), []
    answer = edits(page, "load", 2900)
    assert answer["=load"]["value"] == 2900
    assert "data-value='2900.0'" in answer["#press-numbers"]
    assert not {"=clearance", "order", "view", "#trouble"} & set(answer)
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


@pytest.mark.parametrize("view", ["press", "compare"])
def test_files_have_the_joint_and_reports_its_inputs_and_no_machine(view):
    page = Page(f"view={view}&preset=hip-32&load.force=2500")
    text = saved(page, "HTML").decode()
    for part in ("Drawing", "Inputs", "head diameter", "SHA-256", "In the explorer: <code>/?"):
        assert part in text, part
    assert ("<span class='holds'>Passes: " in text) == (view == "press")
    assert "data:image/png;base64" in text
    assert "localhost" not in text
    assert "http" not in text.replace("http://www.w3.org", "")
    assert saved(page, "PNG").startswith(b"\x89PNG")
    assert b"<svg" in saved(page, "SVG")
    assert parse_joint(saved(page, "TOML"), "saved") == JointFile(bs.joints["hip-32"], {"force": 2500.0})


HIP = "preset=hip-28&load.force=3000"


def test_a_backing_is_built_from_bone_to_shell():
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
    assert f"{float(expected):.4g}" in page.channel.shown_value("#press-numbers")
    edits(page, "behind.0", "away")
    edits(page, "behind.0", "away")
    joint = page.screen.file.joint
    assert joint == bs.joints["hip-28"]  # nothing is left to be free, or to be changed
    assert "behind.0" not in page.channel.shown_value("order")


def test_a_wall_of_layers_ends():
    file = JointFile(bs.joints["hip-28"], {"force": 3000.0})
    for _ in range(20):
        file = layers_edited(file, "add", "titanium")
    assert len(file.joint.backing) == 20
    with pytest.raises(ValueError, match="'titanium' is one layer too many: at most 20"):
        layers_edited(file, "add", "titanium")


def test_joints_are_compared_with_the_one_that_is_chosen():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36&beside2.preset=hip-32")
    assert "the difference from hip-36" in page.channel.shown_value("#compare-note")
    options = page.channel.shown_value("=compare.base")["options"]
    assert options == [["0", "this design"], ["1", "hip-36"], ["2", "hip-32"]]
    edits(page, "compare.base", "0")
    assert "the difference from this design" in page.channel.shown_value("#compare-note")
    mine, other = (bs.Exact().press(bs.joints[name], force=3000.0).max_pressure for name in ("hip-28", "hip-36"))
    table = page.channel.shown_value("#compare-table")
    assert f"{float(other):.4g}" in table
    assert f"{100 * (other / mine - 1):+.0f} %" in table
    assert "base=0" in page.channel.shown_value("link")
    assert Page(f"view=compare&{HIP}").screen.base == "1"  # nothing has been chosen by looking


def test_a_base_remains_the_same_design_when_another_is_removed():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36")
    edits(page, "compare.preset", "hip-32")
    edits(page, "compare.base", "2")
    edits(page, "compare.remove", "hip-36")
    assert "the difference from hip-32" in page.channel.shown_value("#compare-note")
    edits(page, "compare.remove", "hip-32")
    assert page.screen.beside == ()
    assert "the difference from hip-36" in page.channel.shown_value("#compare-note")  # the example
    edits(page, "compare.keep", True)
    assert page.screen.beside == (page.screen.file,)


def test_six_designs_are_compared_by_the_checks_of_contact():
    """The von Mises stress of the checks is that of the model itself, as in Contact."""
    names = [name for name in bs.joints if name not in ("hip-28", "hess-forsbach")][:6]
    beside = "&".join(f"beside{number}.preset={name}" for number, name in enumerate(names, start=1))
    page = Page(f"view=compare&{HIP}&{beside}")
    assert page.channel.shown_value("=compare.base")["options"][-1][0] == "6"
    table = page.channel.shown_value("#compare-table")
    contact = bs.Exact().press(page.screen.file.joint, force=3000.0)
    (check,) = [
        row for row in checks_of(contact, Cup(), float(contact.von_mises)) if "stress in the liner" in row.title
    ]
    row = re.search(rf"<th scope='row'>{check.title} / {check.limit}</th><td class='\w*'>(.*?)</td>", table)
    assert row[1] == f"✓ {100 * check.ratio:.0f} %"
    does(page, "choose", name="view", value="press")
    assert f"{100 * check.ratio:.0f} %" in page.channel.shown_value("#press-numbers")
    does(page, "choose", name="view", value="compare")
    edits(page, "compare.keep", True)
    assert "6 designs are compared with this one already" in trouble(page)
