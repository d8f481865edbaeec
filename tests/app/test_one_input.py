"""A result over one input, explanations beside numbers, and marks of work on the buttons of views."""

import json
import re
from dataclasses import replace
from html import unescape
from math import degrees

import pytest

import ballsocket as bs
from ballsocket.studies.derivatives import local_uncertainty

from .asking import does, opened, saved, told

HIP = bs.joints["hip-28"]
LINK = "view=curve&preset=hip-28&load.force=3000&limit=max_pressure<=16 MPa"


def test_a_result_over_one_input_is_that_of_the_model_and_red_where_a_limit_is_exceeded():
    page = opened(LINK)
    chart = json.loads(re.search(r"data-chart='([^']*)'", told(page, "curve-chart"))[1])
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
    assert f"<td>{effects['force']:.2f}</td>" in told(page, "curve-effects")
    assert saved(page, "CSV").startswith(b"head_diameter_mm,")


def test_a_number_is_explained_by_its_formula_and_the_values_in_it():
    contact = bs.Exact().press(HIP, force=3000.0)
    (area,) = re.findall(r"data-why='area'>.*?<p>(.*?)</p>", told(opened("preset=hip-28"), "press-numbers"))
    assert "2π R1² (1 - cos ε)" in unescape(area)
    assert f"R1 = 14 mm, ε = {degrees(contact.half_angle):.4g}°" in unescape(area)


def test_a_view_whose_work_is_done_is_marked_until_it_is_seen():
    page = opened("view=wear&preset=hip-28")
    page.view.long.unseen = True
    assert page.channel.shown_value("works") is None  # of the open view
    does(page, "view", value="press")
    assert page.channel.shown_value("works") == {"wear": "done"}
    does(page, "view", value="wear")
    assert page.channel.shown_value("works") is None
