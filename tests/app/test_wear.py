"""The wear's view without a browser: years as `hip` has them, and two designs beside each other."""

import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

from .asking import does, edits, opened, saved, told, trouble

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
from ballsocket.app import results
from ballsocket.app.results import ResultStore
from ballsocket.app.state.use import DEFAULT_USE
from ballsocket.app.views.wear import view as wear_view
from ballsocket.app.views.wear import worker
from ballsocket.app.views.wear.charts import depth_maps, penetration_chart, wear_numbers
from ballsocket.app.widgets.reading import Reading
from ballsocket.reports.check_table import wear_check
from ballsocket.reports.unit_systems import Units

HIP = "view=wear&preset=hip-36&cup.inclination=40&cup.anteversion=15"
LINK = f"{HIP}&use.millions=0.1&use.coefficient=1e-7&use.spread=1"


@pytest.fixture(autouse=True)
def nothing_is_known(monkeypatch):
    store = ResultStore()
    monkeypatch.setattr(results, "RESULTS", store)
    monkeypatch.setattr(wear_view, "RESULTS", store)
    monkeypatch.setattr(worker, "figure_bytes", lambda figure: b"a picture")


def test_a_life_is_that_of_python(at_once):
    page = opened(LINK)
    assert "not computed yet" in told(page, "wear-curve")  # a picture of what will be shown
    does(page, "save", kind="CSV")
    assert "there is no result for this design yet" in trouble(page)
    edits(page, "wear.run", True)
    cup = bs.Cup(inclination=radians(40.0), anteversion=radians(15.0))
    use = HipSimulation(joint=bs.joints["hip-36"], cycle=iso_14242_1(), wear=Archard(coefficient=1e-7), cup=cup)
    last = use.after(1e5, report_at=[1e4 * each for each in range(1, 10)]).last
    assert f"<td>{last.volume:.4g}</td>" in told(page, "wear-numbers")
    rows = [line.split(",") for line in saved(page, "CSV").decode().splitlines()]
    assert [rows[0][2], rows[0][6]] == ["penetration [mm]", "volume [mm3]"]
    shown = [float(rows[-1][column]) for column in (2, 5, 6)]
    assert shown == pytest.approx([last.penetration, last.depth, last.volume])
    assert float(rows[1][2]) == 0
    does(page, "choose", name="units", value="imperial")
    assert saved(page, "CSV").startswith(b"design,million cycles,penetration [mil],low [mil]")
    does(page, "choose", name="units", value="SI")
    assert "numerical error of the run" in told(page, "wear-numbers")
    assert f"up to {1e3 * last.depth:.4g} µm" in told(page, "wear-maps")
    shares = [news.share for news in at_once.news]
    assert shares == sorted(shares)
    assert len(shares) > 5
    shown = told(page, "wear-numbers")
    assert "<th scope='row'>deepest wear</th>" in shown
    assert told(page, "wear-earlier") == ""
    edits(page, "wear.millions", 1)
    assert told(page, "wear-numbers").replace("earlier design 1", "hip-36") == shown  # nothing is lost
    assert "belong to an earlier design" in told(page, "wear-earlier")
    edits(page, "wear.millions", 0.1)
    assert (told(page, "wear-numbers"), told(page, "wear-earlier")) == (shown, "")


def made(scale):
    grown, grid = scale * np.arange(3.0), bs.sphere.grid.graded_grid(radians(90.0), radians(10.0))
    last = {"edge_distance": 1.0, "penetration_of_creep": 0.0, "max_pressure": 5.0, "contact": [{"utilisation": None}]}
    contact = {"valid": scale > 0.1, "unworn": [{"utilisation": 1.5 - scale}]}
    summary = {"history": [last], "contact": contact, "cycle": {"peaks": {"max_pressure_MPa": 10.0}}}
    curves = {"penetration": grown, "deepest": grown, "volume": 100 * grown, "low": 0.5 * grown, "high": 2 * grown}
    depth, checks = scale * np.ones((grid.rings, grid.meridians)), (wear_check(bs.joints["hip-36"], 30 * scale),)
    bore = {"depth": depth, "grid": grid, "cup": bs.Cup(), "load": np.array([0.0, 0.0, 1.0])}
    texts = {"band": "band: of a test", "notes": ("a note",), "figure": b""}
    return worker.WearResult(cycles=np.arange(3.0), **curves, **bore, **texts, summary=summary, checks=checks)


def test_a_bore_worn_to_the_rim_fails_there_only_by_edge_loading():
    distances = np.array([0.0, 3.0, -1.0])
    assert worker.rim_distances(distances, np.zeros(3, dtype=bool)).tolist() == [3.0]
    assert worker.rim_distances(distances, np.array([False, False, True])).min() == -1.0


def test_two_designs_are_beside_each_other_in_one_scale():
    found = {"one": made(0.1), "other": made(0.2)}
    assert "<td>40 (+100 %)</td>" in wear_numbers(found)
    assert "<td>utilisation σv/σy, new</td><td>1.4</td>" in wear_numbers(found)
    assert wear_numbers(found).count("✗ Fails: deepest wear is 1.2 times the liner thickness") == 1
    assert wear_numbers(found).count("outside the range in which this model can be trusted") == 1
    assert "✗ one: outside" in wear_numbers(found)
    inches = Reading(units=Units.IMPERIAL)
    assert "penetration [mil]" in penetration_chart(found, inches)
    assert "largest pressure, new [psi]" in wear_numbers(found, inches)
    chart = penetration_chart(found)
    assert "one: 200 µm after 2 million cycles, 100 µm to 400 µm" in chart
    assert chart.count('opacity="0.2"') == 2
    scales = re.findall(r"worn depth \[µm\].*?</svg>", depth_maps(found), flags=re.DOTALL)
    assert len(scales) == 2
    assert scales[0].split("worn depth")[-1] == scales[1].split("worn depth")[-1]


def test_inputs_are_a_design_beside_and_a_coefficient_with_its_unit(asked):
    page = opened(LINK)
    edits(page, "wear.beside", "as it is now")
    edits(page, "wear.run", True)
    edits(page, "clearance", "0.4")
    edits(page, "wear.run", True)
    assert [len(designs) for _, designs, *_ in asked] == [1, 2]  # the same design twice is one
    (other,) = page.screen.beside
    assert (other.joint.clearance, other.cup) == (0.1, page.screen.file.cup)
    assert opened(page.channel.shown_value("link")).screen == page.screen
    edits(page, "wear.beside", "hip-28")
    assert page.screen.beside[0].joint == bs.joints["hip-28"]
    edits(page, "wear.beside", "")
    assert page.screen.beside == ()
    edits(page, "wear.coefficient", "1,066e-6 mm^3/(N m)")  # as others write it
    assert page.screen.use.coefficient == pytest.approx(1.066e-6)


def test_a_hip_that_cannot_be_worn_says_why(at_once):
    page = opened(LINK.replace("cup.inclination=40", "cup.inclination=90"))
    edits(page, "wear.run", True)
    assert "dislocated" in told(page, "wear-trouble")


@pytest.mark.long
def test_patients_whose_coefficient_scatters_make_the_band():
    page = opened(LINK)
    use = replace(DEFAULT_USE, millions=0.2, spread=1.5)
    (found,) = worker.simulate_designs({"one": page.screen.file}, use, {}, lambda news: None).values()
    assert (found.low[1:] < found.penetration[1:]).all()
    assert (found.penetration[1:] < found.high[1:]).all()
    assert found.high[-1] / found.penetration[-1] == pytest.approx(1.5**1.96, rel=0.25)
    assert "64 patients" in found.band
    assert "95 % of the predictions" in found.band
