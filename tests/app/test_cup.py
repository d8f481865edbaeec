"""The cup's view without a browser: what it shows is what a press of the sphere says, and it refuses in a sentence."""

import json
import re
from base64 import b64decode
from dataclasses import replace
from functools import partial
from math import degrees, radians
from unittest.mock import Mock

import numpy as np
import pytest

import ballsocket as bs

from .asking import does, edits, opened, saved, told

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("skfem")
from ballsocket.app import jobs, long_view
from ballsocket.app.jobs import Job
from ballsocket.app.pictures.bore import pressed_bore
from ballsocket.app.results import ResultStore
from ballsocket.app.running import RunFinished
from ballsocket.app.views.cup import worker
from ballsocket.app.views.cup.charts import angle_map
from ballsocket.app.views.cup.view import _hint
from ballsocket.app.views.cup.worker import OrientationMap
from ballsocket.app.widgets.reading import Reading
from ballsocket.problem.cup import Cup, Side
from ballsocket.reports.check_table import checks_html, checks_of
from ballsocket.reports.unit_systems import Units

LINK = "view=cup&preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"
JOINT = bs.joints["hip-36"]


def test_the_view_says_what_the_sphere_says(at_once):
    page = opened(LINK)
    contact = bs.Sphere(cup=page.screen.file.cup).press(JOINT, force=3000.0)
    assert f"{float(contact.edge_distance):.4g} <span class='unit'>mm" in told(page, "cup-numbers")
    (margin,) = re.findall(r"([\d.]+)° of arc", told(page, "cup-numbers"))
    assert float(margin) == pytest.approx(degrees(contact.edge_margin), abs=degrees(contact.error["edge_margin"]))
    assert f"{float(contact.max_pressure):.4g} <span class='unit'>MPa" in told(page, "cup-numbers")
    assert f"{float(contact.edge_distance):.4g} mm from the rim" in told(page, "cup-map")
    viewed = json.loads(re.search(r"data-viewer='([^']*)'", told(page, "cup-viewer"))[1])
    assert viewed["loads"][0] == pytest.approx(contact.force_vector / 3000.0, abs=1e-4)
    assert viewed["axes"]["up"] == pytest.approx([axis[2] for axis in page.screen.file.cup.frame], abs=1e-4)
    assert viewed["radii"] == pytest.approx([18.0 / 18.1, 1 + 5 / 18.1, 1 + 5 / 18.1], abs=1e-4)
    cells = np.frombuffer(b64decode(viewed["bytes"]), dtype=np.uint8)
    assert cells.max() / 255 * 12 == pytest.approx(float(contact.max_pressure), rel=0.01)
    rows = dict(line.split(",") for line in saved(page, "CSV").decode().splitlines())
    assert float(rows["max_pressure_MPa"]) == pytest.approx(float(contact.max_pressure))
    assert float(rows["half_angle_deg"]) == pytest.approx(degrees(contact.half_angle))
    assert {"force_N", "edge_distance_mm", "rim_distance_mm", "edge_margin_deg"} <= set(rows)
    report = saved(page, "HTML").decode()
    assert f"<td>{float(contact.max_pressure):.4g} MPa</td>" in report
    assert checks_html(checks_of(contact, page.screen.file.cup), page.screen.reading.with_unit) in report
    listed = re.sub("<[^>]*>", "", report.split(">Contact in the cup<")[1].split("</table>")[0])
    assert "_" not in listed
    assert at_once.asked[-1][0] == "cup-stood"  # the orientations follow

    edits(page, "cup.inwards", "20")
    way = page.screen.file.aim["direction"]
    assert degrees(np.arctan2(-way[0], way[2])) == pytest.approx(20)  # the middle is to the left of a right hip
    leaning = bs.Sphere(cup=page.screen.file.cup).press(JOINT, force=3000.0, direction=way)
    assert f"{degrees(leaning.tilt):.4g}<span class='unit'>°" in told(page, "cup-numbers")
    edits(page, "cup.side", "left")
    assert page.screen.file.aim["direction"][0] == pytest.approx(-way[0])
    assert f"{degrees(leaning.tilt):.4g}<span class='unit'>°" in told(page, "cup-numbers")  # a mirror changes nothing
    assert "load.direction=" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen

    edits(page, "cup.inwards", 0)
    edits(page, "cup.pick", [75.0, 12.34])
    assert degrees(page.screen.file.cup.anteversion) == pytest.approx(12.3)
    assert "✗ Rim contact (edge loading)" in told(page, "cup-numbers")
    table = told(page, "cup-numbers")
    assert table.index("reach of the contact</th>") < table.index("✗ fails") < table.index("? not known")
    edits(page, "cup.inclination", 90)
    assert "dislocated: the load pushes the ball out" in told(page, "cup-trouble")
    assert told(page, "cup-numbers") == ""


def test_an_orientation_of_zero_is_shown_and_not_replaced():
    """A cup without an orientation is offered the usual one, and its map has no directions of the body."""
    joint = bs.joints["hip-28"]
    upright, default = (bs.Sphere(cup=cup).press(joint, force=2000.0) for cup in (Cup(inclination=0.0), Cup()))
    assert "cup.usual" in _hint(default)
    assert _hint(upright) == ""
    assert ">anterior</text>" in pressed_bore(upright)
    assert ">anterior</text>" not in pressed_bore(default)


def test_a_load_is_aimed_in_the_body_or_from_the_cups_axis(asked):
    page = opened(LINK)
    assert page.channel.shown_value("=cup.tilt")["hidden"]
    assert not page.channel.shown_value("=cup.inclination")["hidden"]
    edits(page, "cup.aim", "axis")
    assert page.screen.file.aim["tilt"] == pytest.approx(page.screen.file.cup.tilt((0.0, 0.0, 1.0)))
    assert page.channel.shown_value("=cup.inclination")["hidden"]
    assert "turns with the cup" in told(page, "cup-stood")
    edits(page, "cup.tilt", 30)
    assert page.screen.file.aim == {"tilt": pytest.approx(radians(30))}
    does(page, "choose", name="angle", value="radians")
    edits(page, "cup.tilt", 0.5)
    assert page.screen.file.aim == {"tilt": pytest.approx(0.5)}
    edits(page, "cup.aim", "body")
    assert page.screen.file.aim == {}


def test_a_bore_whose_rings_are_on_disk_is_pressed_at_once(monkeypatch, asked):
    bs.Sphere(cup=Cup()).press(JOINT, force=1.0)
    monkeypatch.setattr(worker, "RESULTS", ResultStore())
    monkeypatch.setattr(long_view.results, "RESULTS", worker.RESULTS)
    page = opened(LINK)
    assert "MPa" in told(page, "cup-numbers")
    assert {name for name, *_ in asked} == {"cup-stood"}


def test_a_bore_is_prepared_by_one_process_for_all_who_wait(monkeypatch):
    """Contact and Cup share it; it ends with the last of them, and its news go to each by its own key."""
    heard, runs = [], [Mock(news=lambda: RunFinished(True)) for _ in range(4)]
    begun = Mock(side_effect=runs)
    monkeypatch.setattr(jobs, "Run", begun)
    first, second = (Job(lambda key, news: heard.append((key, news.value))) for _ in range(2))
    work, other = (partial(worker.set_up, JOINT, Cup(arc_of_cover=arc)) for arc in (3.0, 2.5))
    first.ask("press", work)
    second.ask("cup", work)
    assert begun.call_count == 1
    first.stop()
    assert second.works
    assert not runs[0].stop.called
    first.ask("press", work)
    first.hear()
    assert sorted(heard) == [("cup", True), ("press", True)]
    assert runs[0].stop.called
    first.ask("press", work)
    second.ask("cup", other)
    assert begun.call_count == 3


def test_a_map_of_orientations_says_how_many_keep_off_the_rim():
    angles = {"inclination": np.radians([20.0, 40.0, 60.0]), "anteversion": np.radians([0.0, 20.0])}
    apart, held = np.array([[5.0, 4.0], [2.0, 1.0], [-2.0, -3.0]]), np.ones((3, 2), dtype=bool)
    made = OrientationMap(**angles, edge_distance=apart, max_pressure=10 + apart**2, held=held, figure=b"")
    picture = angle_map(made, Cup(inclination=radians(40.0)), "edge_distance")
    assert "67 % of the orientations keep the contact off the rim" in picture
    assert "furthest, 5 mm, at inclination 20°, anteversion 0°" in picture
    assert 'class="here"' in picture
    ends = re.search(r'class="limit" d="M([\d.]+),.*L([\d.]+),', picture).groups()
    assert {float(x) for x in ends} == {58 + 368 * 0.75, 58 + 368 * 0.625}  # at 50° without anteversion, 45° with 20°
    assert 'class="here"' not in angle_map(made, Cup(), "edge_distance")
    assert "edge distance [in]" in angle_map(made, Cup(), "edge_distance", Reading(units=Units.IMPERIAL))
    lost = replace(made, held=~held)
    assert "in every orientation of the map the contact reaches the rim" in angle_map(lost, Cup(), "max_pressure")


@pytest.mark.long
def test_the_map_is_that_of_python(monkeypatch):
    page, angles = opened(LINK), {"inclination": worker.INCLINATIONS[::5], "anteversion": worker.ANTEVERSIONS[::5]}
    for name, values in angles.items():
        monkeypatch.setattr(worker, f"{name.upper()}S", values)
    found = worker.map_orientations(page.screen.file, lambda news: None)
    asked = bs.orient(JOINT, model=bs.Sphere(cup=Cup(side=Side.RIGHT)), force=3000.0, **angles)
    assert found.edge_distance == pytest.approx(asked.edge_distance, rel=1e-5)  # as far as a press is solved
    assert found.figure.startswith(b"\x89PNG")
