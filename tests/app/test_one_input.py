"""A result over one input, explanations beside numbers, and marks of work on the buttons of views."""

from dataclasses import replace
from html import unescape
from math import degrees

import pytest

import ballsocket as bs
from ballsocket.app import results
from ballsocket.app.running import RunFinished
from ballsocket.studies.derivatives import local_uncertainty
from ballsocket.studies.distributions import tolerance

from .asking import blocks, does, edits, opened, saved, told, trouble

HIP = bs.joints["hip-28"]
LINK = "view=curve&preset=hip-28&load.force=3000&limit=max_pressure<=16 MPa"


def test_a_result_over_one_input_is_that_of_the_model_and_red_where_a_limit_is_exceeded():
    page = opened(LINK)
    ((chart,),) = (block["charts"] for block in blocks(page, "curve-chart", "charts"))
    curve, limit = chart["curves"]
    ends = [0, -1]
    joints = [replace(HIP, ball_radius=curve["x"][end] / 2) for end in ends]
    pressures = [bs.Tabulated().press(joint, force=3000.0).max_pressure for joint in joints]
    assert [curve["y"][end] for end in ends] == pytest.approx(pressures, rel=1e-3)
    here = bs.Tabulated().press(HIP, force=3000.0).max_pressure
    assert curve["mark"] == pytest.approx([28.0, here], rel=2e-3)  # between points of the curve
    assert (chart["start"], set(limit["y"])) == (22.0, {16.0})
    ((_, end),) = chart["flagged"]  # the pressure falls with the size of the head
    step = curve["x"][1] - curve["x"][0]
    crossing = next(x for x, y in zip(curve["x"], curve["y"], strict=True) if y < 16.0)
    assert end == pytest.approx(crossing, abs=step)
    effects = local_uncertainty(HIP, bs.Cup(), {"force": 3000.0}, {}).changes["max_pressure"]
    assert f'"{effects["force"]:.2f}"' in told(page, "curve-effects")
    assert saved(page, "CSV").startswith(b"head_diameter_mm,")


def test_a_number_is_explained_by_its_formula_and_the_values_in_it():
    contact = bs.Exact().press(HIP, force=3000.0)
    page = opened("preset=hip-28")
    assert "cos ε" not in told(page, "press-numbers")
    edits(page, "press.why", ["area"])
    rows = [row for block in blocks(page, "press-numbers", "numbers") for row in block["rows"]]
    why = {name: text for name, *_, text in rows if text}
    assert list(why) == ["area"]  # only what is open
    assert "2π R1² (1 - cos ε)" in why["area"]
    assert f"R1 = 14 mm, ε = {degrees(contact.half_angle):.4g}°" in why["area"]
    edits(page, "press.why", [])
    assert "cos ε" not in told(page, "press-numbers")
    edits(page, "press.why", ["colour"])
    assert "'colour'" in unescape(trouble(page))


def test_a_view_is_marked_whose_work_ends_while_another_is_open(asked, monkeypatch):
    monkeypatch.setattr(results, "RESULTS", results.ResultStore())
    page = opened("view=cup&preset=hip-28")
    orientations = page.view.works[1]
    orientations.show_result = lambda screen, result: None

    def end_of_work():
        orientations._job._heard(asked[-1], RunFinished("a map"))

    end_of_work()
    does(page, "view", value="press")
    assert page.channel.shown_value("works") is None  # its end was seen
    end_of_work()
    assert page.channel.shown_value("works") == {"cup": "done"}
    edits(page, "tilt", 20)  # for which the view has no map of orientations
    does(page, "view", value="cup")
    does(page, "view", value="press")
    assert page.channel.shown_value("works") is None


def test_the_input_may_be_the_y_axis_of_the_map_whose_range_refuses_no_edit():
    page = opened(f"{LINK}&up=liner_thickness=3..15")
    edits(page, "curve.across", "liner_thickness")
    assert not trouble(page)
    assert (page.screen.across.name, page.screen.up.name) == ("liner_thickness", "head_diameter")
    assert blocks(page, "curve-chart", "charts")
    page = opened(f"{LINK}&up=liner_thickness=0.01..0.1&across=force=1000..3000&map_model=exact")
    edits(page, "curve.across_low", 2000)  # `exact` takes minutes over such liners
    assert (trouble(page), page.screen.across.low) == ("", 2000.0)


def test_tolerances_make_a_band_of_the_results_which_the_first_view_states_too():
    page = opened(LINK)
    edits(page, "curve.tolerances", "clearance = 0.1 +- 0.02 mm")
    bands = local_uncertainty(HIP, bs.Cup(), {"force": 3000.0}, {"clearance": tolerance(0.1, 0.02)}).band
    low, _, high = (f"{end:.4g} MPa" for end in bands["max_pressure"])
    assert f'"{low}"' in told(page, "curve-effects")
    does(page, "view", value="press")
    assert f"{low} to {high}" in told(page, "press-band")
    assert low in saved(page, "HTML").decode()
    edits(page, "tilt", 10)
    assert "No band" in told(page, "press-band")
    edits(page, "tilt", 0)
    edits(page, "clearance", "0.4")
    assert "outside its tolerance of 0.08 to 0.12 mm" in told(page, "press-band")
    does(page, "view", value="curve")
    for words in (
        "0.4 +- 0.2 mm",
        "3 +- 2.9 mm",
    ):  # hundreds of slow presses, also where only the ends are in the tables
        edits(page, "curve.tolerances", f"clearance = {words}")
        assert "outside the tables" in told(page, "curve-effects")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("clearance = 0.1 +- 0.02 mm; clearance = 0.1 +- 0.05 mm", "clearance is given twice"),
        ("force = 0 +- 5 kN", "force within its tolerance"),
        ("clearance = 0.1", "'clearance=0.1+-0.02 mm'"),
    ],
)
def test_a_tolerance_that_cannot_be_followed_is_refused_by_its_name_or_right_form(words, sentence):
    page = opened(LINK)
    edits(page, "curve.tolerances", words)
    assert sentence in unescape(told(page, "curve-effects"))


def test_effects_that_take_seconds_are_refused():
    page = opened(
        "view=curve&joint.ball_radius=19.9&joint.clearance=0.1&joint.liner_thickness=0.25&load.force=500"
        "&liner.young=800&liner.poisson=0.45"
    )
    assert "Too slow here at R2/L = 80" in told(page, "curve-effects")
