"""The gait's view without a browser: a cycle as `hip` presses it, played from plain numbers."""

import base64
import json
import re
from html import unescape
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, Lubricant, iso_14242_1, named_cycle

from .asking import does, edits, opened, saved, told

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
from ballsocket.app.state.use import DEFAULT_USE
from ballsocket.app.views.gait.worker import MERIDIANS, RINGS, simulate_film, simulate_gait

LINK = "view=gait&preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"
OWN = "phase [%], force [N], flexion [deg]\n0, 300, 20\n25, 2000, 0\n50, 2500, -20\n75, 300, 0\n100, 300, 20\n"


@pytest.fixture
def page(at_once):
    return opened(LINK)


@pytest.fixture
def with_film(at_once):
    at_once.left.discard("simulate_film")
    return opened(LINK)


def python(page):
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(15.0))
    return HipSimulation(joint=page.screen.file.joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6), cup=cup)


def simulated(page, simulate=simulate_gait):
    return simulate(page.screen.file, DEFAULT_USE, None, lambda news: None)


def played(page):
    return json.loads(unescape(re.search(r"data-player='([^']*)'", told(page, "gait-courses"))[1]))


def viewed(page):
    return json.loads(re.search(r"data-viewer='([^']*)'", told(page, "gait-viewer"))[1])


def test_a_cycle_is_that_of_python(page):
    found, hip = simulated(page), python(page)
    assert found.force == pytest.approx(hip.cycle.force_magnitudes)
    assert found.pressure == pytest.approx(hip.unworn.pressure.max(axis=1))
    assert found.edge == pytest.approx(hip.edge_distance(hip.unworn))
    assert found.load @ np.array([1.0, 0.0, 0.0]) == pytest.approx(hip.forces[:, 0] / hip.cycle.force_magnitudes)
    cells = found.frames.cells
    assert cells.shape == (100, RINGS + 1, MERIDIANS)
    assert 240 <= cells.max() <= 255
    assert found.frames.highest == pytest.approx(found.pressure.max())
    assert cells[found.heaviest].sum() == cells.sum(axis=(1, 2)).max()
    around = 2 * np.pi * (np.arange(MERIDIANS) + 0.5) / MERIDIANS
    lean = (cells[found.heaviest].sum(axis=0) * np.exp(1j * around)).sum()  # towards the load, around the axis
    assert np.angle(lean) == pytest.approx(np.arctan2(*found.load[found.heaviest, 1::-1]), abs=radians(3))


@pytest.mark.long
def test_the_film_is_the_wave_of_python(page):
    found, film = simulated(page, simulate_film), python(page).film(Lubricant(), method="wave")
    assert found.least == pytest.approx(1e6 * film.least)
    assert found.central == pytest.approx(1e6 * film.central)
    assert found.ratio == pytest.approx(film.ratio)
    assert found.figure.startswith(b"\x89PNG")
    assert (found.valid, found.note, found.regime) == (film.valid, film.note, film.regime)
    filmed, pressed = ((one.frames.cells > 0).mean(axis=(1, 2)) for one in (found, simulated(page)))
    assert filmed == pytest.approx(pressed, abs=0.05)  # a film is shown where there is a contact, and only there


@pytest.mark.long
def test_the_page_plays_what_the_process_found(with_film):
    page, found = with_film, simulated(with_film)
    data = played(page)
    assert [course["unit"] for course in data["courses"]] == ["N", "MPa", "mm", "nm", "nm", ""]
    assert [course["chart"] for course in data["courses"]] == [0, 1, 2, 3, 3, 4]
    assert data["courses"][1]["values"] == pytest.approx(found.pressure, rel=1e-4)
    assert base64.b64decode(viewed(page)["bytes"]) == found.frames.cells.tobytes()
    assert told(page, "gait-at") == str(found.heaviest)
    assert "at 12.5 % of the cycle" in told(page, "gait-flat")
    edits(page, "gait.instant", 7)
    assert told(page, "gait-at") == "7"
    assert "at 7.5 % of the cycle" in told(page, "gait-flat")
    assert "use.instant=7" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen


@pytest.mark.long
def test_files_have_the_cycle_and_the_units_of_the_page(with_film):
    head, first, *_ = saved(with_film, "CSV").decode().splitlines()
    press = "phase [%],load [N],largest pressure [MPa],edge distance [mm]"
    assert head == f"{press},smallest film thickness [nm],central film thickness [nm],film ratio λ"
    assert float(first.split(",")[2]) == pytest.approx(simulated(with_film).pressure[0])
    assert b"<svg" in saved(with_film, "SVG")
    report = saved(with_film, "HTML").decode()
    assert "A cycle: iso-14242-1" in report
    assert "✗ Rim contact in 19 % of the cycle" in report
    assert "alt='film over the cycle'" in report.replace('"', "'")
    does(with_film, "choose", name="units", value="imperial")
    courses = played(with_film)["courses"]
    assert [course["unit"] for course in courses] == ["lbf", "psi", "in", "nm", "nm", ""]
    assert max(courses[0]["values"]) == pytest.approx(iso_14242_1().force_magnitudes.max() / 4.4482216, rel=1e-4)
    assert "lbf" in told(with_film, "gait-numbers")
    assert saved(with_film, "CSV").startswith(b"phase [%],load [lbf],largest pressure [psi]")


@pytest.mark.long
def test_rim_contact_is_named_and_red(page):
    edge, numbers = simulated(page).edge, told(page, "gait-numbers")
    share = f"Rim contact in {100 * (edge <= 0).mean():.0f} % of the cycle (9 to 19 %, 44 to 53 %)"
    assert f"<p class='trust no'>✗ {share}" in numbers
    assert told(page, "gait-courses").count('class="flagged"') == 2
    assert numbers.index("✗ Fails: reach of the contact") < numbers.index("✓ passes")
    assert played(page)["rim"] == (edge <= 0).tolist()
    free = opened(LINK.replace("inclination=45", "inclination=30"))
    assert "✓ No rim contact" in told(free, "gait-numbers")
    assert "flagged" not in told(free, "gait-courses")


@pytest.mark.long
def test_the_film_is_shown_on_the_bore_with_its_own_scale(with_film):
    pressure = viewed(with_film)
    edits(with_film, "gait.field", "film")
    assert "use.field=film" in with_film.channel.shown_value("link")
    film = viewed(with_film)
    assert (pressure["film"], film["film"]) == (False, True)
    assert film["bytes"] != pressure["bytes"]
    assert "film thickness [nm]" in told(with_film, "gait-viewer")
    assert "film thickness [nm] at 12.5 % of the cycle" in told(with_film, "gait-flat")
    numbers = told(with_film, "gait-numbers")
    assert "✗ wave method, not valid here" in numbers
    assert "estimated error 12 %" in numbers
    assert "fresh lubricant does not reach a core, up to 56 % of the contact" in numbers


def test_a_cycle_that_is_prepared_is_sketched(asked):
    page = opened(LINK.replace("hip-36", "hip-32"))
    assert told(page, "gait-courses").count("Preparing ...") >= 5
    assert "Preparing ..." in told(page, "gait-flat")


def test_a_patients_load_needs_a_weight(page):
    assert page.channel.shown_value("=gait.body_weight")["hidden"]
    edits(page, "gait.cycle", "jogging")
    assert not page.channel.shown_value("=gait.body_weight")["hidden"]
    edits(page, "gait.body_weight", "700")
    largest = named_cycle("jogging", body_weight=700.0).force_magnitudes.max()
    assert f"{largest:.4g} <span class='unit'>N" in told(page, "gait-numbers")


@pytest.mark.long
def test_a_cycle_of_ones_own_is_read_and_is_in_no_link(page):
    edits(page, "gait.own", {"name": "walk <1>.csv", "size": len(OWN), "text": OWN})
    assert "2500 <span class='unit'>N" in told(page, "gait-numbers")
    assert "walk &lt;1&gt;.csv: a link does not hold it" in told(page, "gait-load")
    assert "own" not in page.channel.shown_value("link")
    edits(page, "gait.cycle", "flexion")
    assert "walk" not in told(page, "gait-load")
    idle = re.sub(r", (300|2000|2500),", ", 0,", OWN)
    edits(page, "gait.own", {"name": "idle.csv", "size": len(idle), "text": idle})
    assert "✗ No contact: this cycle never presses" in told(page, "gait-numbers")
    assert "∞" not in told(page, "gait-numbers")


def test_a_cycle_that_cannot_be_pressed_says_why(page):
    edits(page, "gait.own", {"name": "walk.csv", "text": "phase [%], force [N]\n0, 1\n50, few\n100, 1\n"})
    assert "cycle.csv" in told(page, "gait-trouble")
    dislocated = opened(LINK.replace("cup.inclination=45", "cup.inclination=90"))
    assert "dislocated" in told(dislocated, "gait-trouble")
    assert told(dislocated, "gait-viewer") == ""
