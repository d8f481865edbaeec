"""The explorer's page without a browser: what goes wrong inside is said on it."""

import re
from html import unescape
from itertools import product

import pytest

import ballsocket as bs

from ..extent import either
from .asking import does, edits, saved, trouble

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app import server as serve
from ballsocket.app.session import Page
from ballsocket.app.view import make_file
from ballsocket.app.views.contact.view import Press
from ballsocket.app.views.design_map.worker import mapped
from ballsocket.files.joint_toml import toml_of


def test_a_view_that_fails_says_so_and_is_logged(monkeypatch, caplog):
    page = Page("")

    def show(self, screen):
        raise RuntimeError("no <luck>")

    monkeypatch.setattr(Press, "show", show)
    page.ask(shown=("exact",))
    assert "This cannot be shown: no &lt;luck&gt;" in trouble(page)
    assert "a view failed" in caplog.text


def test_a_file_that_cannot_be_made_says_why():
    page = Page("view=judge")
    assert "file" not in does(page, "save", kind="CSV")
    assert "press 'Run finite elements' first" in unescape(trouble(page))


def test_what_does_not_change_is_not_shown_again(monkeypatch):
    page, shown = Page(""), []
    monkeypatch.setattr(Press, "show", lambda self, screen: shown.append(screen))
    page.ask(view="press")
    assert not shown
    page.ask(size="radius")
    assert [screen.size for screen in shown] == ["radius"]


LOADS = ("force=500", "indentation=0.01", "half_angle=20")
EACH_ONCE = [(preset, LOADS[number % 3]) for number, preset in enumerate(bs.joints)]


@pytest.mark.parametrize(("preset", "load"), either(quick=EACH_ONCE[::3], long=list(product(bs.joints, LOADS))))
def test_every_preset_can_be_seen_under_every_load(preset, load):
    for view in ("press", "map", "compare"):
        model = "hertz" if preset == "tilting-pad-pivot" else "tabulated"
        page = Page(f"view={view}&preset={preset}&load.{load}&map_model={model}")
        assert trouble(page) == ""
        assert page.view.document(page.screen).rows()


@pytest.mark.parametrize(("angle", "unit", "factor"), [("degrees", "°", 57.29577951308232), ("radians", "rad", 1.0)])
def test_a_map_of_angles_has_the_unit_that_is_chosen(angle, unit, factor):
    page = Page(f"view=map&quantity=half_angle&angle={angle}&preset=hip-28")
    found = mapped(page.screen.file, page.screen.across, page.screen.up, page.screen.map_model)
    least = float(found.half_angle.min()) * factor
    gap = "" if unit == "°" else " "
    assert f"Minimum of the half angle: <b>{least:.4g}{gap}{unit}</b>" in page.channel.shown_value("#map-note")


def test_a_load_of_zero_is_compared_without_shares():
    page = Page("view=compare&preset=hip-28&load.force=0&beside1.preset=hip-36")
    assert trouble(page) == ""
    assert page.view.document(page.screen).rows()


def test_what_is_too_long_for_a_link_does_not_come_on_the_screen():
    page = Page("")
    before = page.screen
    does(
        page,
        "upload",
        text='name = "' + "€" * 999 + '"\n' + toml_of(before.file).partition("source")[2].partition("\n")[2],
    )
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


def test_a_port_that_is_none_is_refused():
    with pytest.raises(ValueError, match="port = 70000 is not allowed: a port is 0 to 65535"):
        serve.server(70000)


@pytest.mark.parametrize("address", ["nowhere.invalid", "a" * 300])
def test_an_address_that_is_none_is_refused(address):
    with pytest.raises(ValueError, match="address = 'nowhere.invalid' is not allowed|address = 'aaa.* is not allowed"):
        serve.server(0, address)


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


def test_only_what_has_changed_is_sent():
    page = Page("")
    answer = edits(page, "load", 2900)
    assert answer["=load"]["value"] == 2900
    assert "data-value='2900.0'" in answer["#press-numbers"]
    assert not {"=clearance", "order", "view", "#trouble"} & set(answer)
    assert set(edits(page, "load", 2900)) == {"n", "question"}


@pytest.mark.parametrize(
    ("text", "meant"), [("0,2", 0.2), ("0.2", 0.2), (" 0,2 mm", 0.2), ("200 um", 0.2), (",2", 0.2), (0.2, 0.2)]
)
def test_a_number_is_understood_as_people_write_it(text, meant):
    page = Page("size=radius")
    edits(page, "clearance", text)
    assert trouble(page) == ""
    assert page.screen.file.joint.clearance == pytest.approx(meant, rel=1e-12)


@pytest.mark.parametrize("view", ["press", "compare"])
def test_a_report_has_the_joint_its_inputs_and_no_machine(view):
    name, page = make_file(Page(f"view={view}").seen(), "HTML")
    text = page.decode()
    assert name.endswith(".html")
    for part in ("Drawing", "Inputs", "head diameter", "SHA-256", "In the explorer: <code>/?"):
        assert part in text, part
    assert ("<span class='holds'>Passes: " in text) == (view == "press")
    assert "localhost" not in text
    assert "http" not in text.replace("http://www.w3.org", "")


def test_a_refusal_goes_with_the_next_change():
    page = Page("view=judge")
    assert edits(page, "judge.arc_of_cover", "20")["reset"]
    assert "20" in trouble(page)
    assert page.screen == Page("view=judge").screen
    edits(page, "judge.arc_of_cover", "150")
    assert trouble(page) == ""
    assert page.channel.shown_value("=judge.arc_of_cover")["value"] == pytest.approx(150)
