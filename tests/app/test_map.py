"""The design map without a browser: contours say their values, limits are moved by their lines, sizes are sold."""

import pytest

import ballsocket as bs

pytest.importorskip("panel", reason="the explorer's extra is not installed")
from bokeh.events import Tap

from ballsocket.app.session import Page
from ballsocket.app.views.design_map.worker import catalogue_sizes, mapped, models_of

LINK = "view=map&preset=hip-28&load.force=3000&across=ball_radius=11..23"


def opened(link=LINK):
    page = Page(link)
    page._refresh()  # the page has loaded
    return page, page.view._chart


def found(page):
    return mapped(page.screen.file, page.screen.across, page.screen.up, page.screen.map_model)


def drag(chart, number, place):
    """What a browser sends when a handle is let go."""
    data = {name: list(values) for name, values in chart._handles.data.items()}
    data["x"][number], data["y"][number] = place
    chart._handles.data = data


def test_contours_say_their_values():
    page, chart = opened()
    labels = chart._values.data
    study = found(page)
    for x, y, words in zip(labels["x"], labels["y"], labels["words"], strict=True):
        there = float(study.max_pressure.interp(ball_radius=x, liner_thickness=y))
        assert there == pytest.approx(float(words), rel=0.01)
    assert len(labels["words"]) >= 3


def test_a_limit_is_moved_by_its_line():
    page, chart = opened(f"{LINK}&limit=outer_radius<=26&limit=max_pressure<=12&limit=liner_thickness>=1")
    handles = chart._handles.data
    assert handles["words"] == ["outer radius ≤ 26 mm", "largest pressure ≤ 12 MPa"]  # the last is beside the map
    assert handles["x"][0] + 0.1 + handles["y"][0] == pytest.approx(26.0)
    drag(chart, 1, (20.0, 8.0))
    there = bs.catalogue["tabulated"].press(
        bs.joints["hip-28"].replace(ball_radius=20.0, liner_thickness=8.0), force=3000.0
    )
    assert page.screen.limits[1].high == pytest.approx(float(there.max_pressure), rel=0.01)
    assert [limit.name for limit in page.screen.limits] == ["outer_radius", "max_pressure", "liner_thickness"]
    assert "limit=max_pressure" in page.channel.shown_value("link")
    kept = page.screen.limits
    chart._handles.data = {"x": [], "y": [], "words": []}  # somebody presses Backspace on a handle
    assert page.screen.limits == kept
    assert len(chart._handles.data["x"]) == 2


def test_a_limit_is_not_moved_to_where_there_is_no_answer():
    page, chart = opened(f"{LINK}&limit=max_pressure<=12&up=outer_radius=15..30")
    before = page.screen.limits
    drag(chart, 0, (22.0, 16.0))  # no liner is left
    assert "has no number there" in page.view._refused.object
    assert page.screen.limits == before


def test_a_click_takes_sizes_of_a_catalogue():
    page, chart = opened(f"{LINK}&sizes=catalogue")
    chart.figure._trigger_event(Tap(chart.figure, x=15.3, y=6.7))
    joint = page.screen.file.joint
    assert (2 * joint.ball_radius, joint.liner_thickness) == (32.0, 7.0)
    assert catalogue_sizes({"head_diameter": 100.0, "clearance": 0.123}) == {"head_diameter": 44.0, "clearance": 0.123}


BACKED = (
    "view=map&joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=UHMWPE"
    "&backing.0.thickness=3&backing.0.material=titanium&backing.1.thickness=2&backing.1.material=bone-cement"
    "&load.force=3000&map_model=exact"
)


def test_models_that_know_the_joint_are_offered_and_exact_is_one_of_them():
    offered = models_of(Page(BACKED).screen)
    assert "exact" in offered
    assert "tabulated" not in offered  # its tables have one layer at most
    assert set(models_of(Page(LINK).screen)) >= {"exact", "tabulated", "refined", "plane-layer", "hertz"}


@pytest.mark.long
def test_a_backed_joint_is_mapped_by_the_exact_solution():
    page, _ = opened(BACKED)
    assert "Smallest value of" in page.view._told.object
    assert "exact" in page.view._model.options
    assert found(page).attrs["model"] == "exact"


def test_a_map_that_would_take_minutes_is_refused():
    page, _ = opened(f"{LINK}&map_model=exact&up=liner_thickness=0.1..1")
    assert "exact takes minutes where R2/L is above" in page.view._refused.object
