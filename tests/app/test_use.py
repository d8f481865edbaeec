"""Views without a browser: a hip in use as `hip` has it, and evidence as the command writes it."""

import io
import json
import re
import zipfile
from base64 import b64decode
from dataclasses import replace
from html import unescape
from math import radians
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app import results
from ballsocket.app.jobs import Job
from ballsocket.app.results import ResultStore
from ballsocket.app.running import RunFinished
from ballsocket.app.state.screen import DEFAULT_QUESTION, EvidenceQuestion
from ballsocket.app.state.use import DEFAULT_USE, UploadedCycle, Use, sample_table
from ballsocket.app.views import evidence, hip_runs
from ballsocket.app.views import wear as wear_view
from ballsocket.app.views.evidence import EvidencePack, gather_pack, write_question
from ballsocket.app.views.hip_runs import MERIDIANS, RINGS, simulate_film, simulate_gait
from ballsocket.app.views.wear import depth_maps, penetration_chart, wear_numbers
from ballsocket.app.widgets.reading import Reading
from ballsocket.contact.verdict import exact_number
from ballsocket.core.unit_systems import Units
from ballsocket.design_checks import wear_check
from ballsocket.elasticity.off_axis.grid import graded_grid
from ballsocket.evidence.question import read_question
from ballsocket.files.joint_file import JointFile
from ballsocket.hip import Archard, HipSimulation, Lubricant, iso_14242_1, named_cycle
from ballsocket.hip.config import read_hip

from ..refusals import text_tables
from .asking import blocks, cells, does, edits, opened, saved, told, trouble

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


def drawn(page):
    return [chart for block in blocks(page, "gait-courses", "charts") for chart in block["charts"]]


def viewed(page):
    return json.loads(re.search(r"data-viewer='([^']*)'", told(page, "gait-viewer"))[1])


def test_a_cycle_is_that_of_python(page):
    found, hip = simulated(page), python(page)
    assert found.force == pytest.approx(hip.cycle.force_magnitudes)
    assert found.pressure == pytest.approx(hip.unworn.pressure.max(axis=1))
    assert found.edge == pytest.approx(hip.edge_distance(hip.unworn))
    assert found.load @ np.array([1.0, 0.0, 0.0]) == pytest.approx(hip.frame.forces[:, 0] / hip.cycle.force_magnitudes)
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
    assert all(drawn.startswith(b"\x89PNG") for drawn in found.figures.values())
    assert (found.valid, found.note, found.regime) == (film.valid, film.note, film.regime)
    filmed, pressed = ((one.frames.cells > 0).mean(axis=(1, 2)) for one in (found, simulated(page)))
    assert filmed == pytest.approx(pressed, abs=0.05)  # a film is shown where there is a contact, and only there


@pytest.mark.long
def test_the_page_plays_what_the_process_found(with_film):
    page, found = with_film, simulated(with_film)
    courses = drawn(page)
    assert [chart["y"] for chart in courses] == ["N", "MPa", "mm", "nm", "λ"]
    assert [len(chart["curves"]) for chart in courses] == [1, 1, 1, 2, 1]
    assert courses[1]["curves"][0]["y"] == pytest.approx(found.pressure, rel=1e-3)  # as many digits as a chart shows
    assert b64decode(viewed(page)["bytes"]) == found.frames.cells.tobytes()
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
    does(with_film, "edit", name="units", value="imperial")
    courses = drawn(with_film)
    assert [chart["y"] for chart in courses] == ["lbf", "psi", "in", "µin", "λ"]
    assert max(courses[0]["curves"][0]["y"]) == pytest.approx(
        iso_14242_1().force_magnitudes.max() / 4.4482216, rel=1e-3
    )
    assert "lbf" in told(with_film, "gait-numbers")
    assert saved(with_film, "CSV").startswith(b"phase [%],load [lbf],largest pressure [psi]")


@pytest.mark.long
def test_rim_contact_is_named_and_red(page):
    edge, numbers = simulated(page).edge, told(page, "gait-numbers")
    share = f"Rim contact in {100 * (edge <= 0).mean():.0f} % of the cycle (9 to 19 %, 44 to 53 %)"
    assert f"✗ {share}" in numbers
    assert [len(chart["flagged"]) for chart in drawn(page)] == [0, 0, 2, 0, 0]
    assert numbers.index("✗ Exceeded: reach of the contact") < numbers.index("? undecided: the error bar")
    course = drawn(page)[2]
    flagged = [any(low <= phase <= high for low, high in course["flagged"]) for phase in course["curves"][0]["x"]]
    assert flagged == (edge <= 0).tolist()
    free = opened(LINK.replace("inclination=45", "inclination=30"))
    assert "✓ No rim contact" in told(free, "gait-numbers")
    assert not any(chart["flagged"] for chart in drawn(free))


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
    assert f'"{largest:.4g}", " N"' in told(page, "gait-numbers")


@pytest.mark.long
def test_a_cycle_of_ones_own_is_read_and_is_in_no_link(page):
    edits(page, "gait.own", {"name": "walk <1>.csv", "size": len(OWN), "text": OWN})
    assert '"2500", " N"' in told(page, "gait-numbers")
    assert "A link does not hold walk &lt;1&gt;.csv" in told(page, "gait-load")
    assert page.channel.shown_value("=gait.cycle")["value"] == "walk <1>.csv"
    link = page.channel.shown_value("link")
    assert "2500" not in link
    assert "choose the file again" in told(opened(link), "gait-trouble")
    edits(page, "gait.cycle", "iso-14242-1")  # the cycle before the table
    assert "walk" not in told(page, "gait-load") + page.channel.shown_value("link")
    assert '"2998", " N"' in told(page, "gait-numbers")
    does(page, "open", query=link)  # undone by the browser
    assert '"2500", " N"' in told(page, "gait-numbers")
    idle = re.sub(r", (300|2000|2500),", ", 0,", OWN)
    edits(page, "gait.own", {"name": "idle.csv", "size": len(idle), "text": idle})
    assert "✗ No contact: this cycle never presses" in told(page, "gait-numbers")
    assert "∞" not in told(page, "gait-numbers")


@pytest.mark.parametrize(("name", "weight"), [("iso-14242-1", None), ("jogging", 800.0)])
def test_the_sample_is_a_table_that_is_read_with_and_without_units(asked, name, weight):
    named, phases = named_cycle(name, body_weight=weight), np.linspace(0.0, 0.98, 50)  # phases of the lines
    sample = UploadedCycle("sample.csv", sample_table(named))
    bare = UploadedCycle("bare.csv", re.sub(r" \[.*?\]", "", sample.text))
    for table in (sample, bare.with_units()):
        assert table.cycle(800.0).angles(phases) == pytest.approx(named.angles(phases), abs=1e-3)
        assert table.cycle(800.0).force(phases) == pytest.approx(named.force(phases), rel=1e-3, abs=0.1)
    page = opened(f"{LINK}&use.cycle={name}")
    assert b64decode(edits(page, "gait.sample", True)["file"]["content"]).decode() == sample.text
    edits(page, "gait.own", vars(bare))
    assert ("bare.csv has heads without units" in told(page, "gait-question"), page.screen.use.table) == (True, "")
    edits(page, "gait.units", True)
    assert (told(page, "gait-question"), page.screen.use.table) == ("", "bare.csv")


def test_a_cycle_that_cannot_be_pressed_and_a_hip_that_cannot_be_worn_say_why(page, at_once, nothing_is_known):
    edits(page, "gait.own", {"name": "walk.csv", "text": "phase [%], force [N]\n0, 1\n50, few\n100, 1\n"})
    assert "walk.csv" in trouble(page)
    dislocated = opened(LINK.replace("cup.inclination=45", "cup.inclination=90"))
    assert "dislocated" in told(dislocated, "gait-trouble")
    assert told(dislocated, "gait-viewer") == ""
    page = opened(WEAR.replace("cup.inclination=40", "cup.inclination=90"))
    assert "dislocated" in told(page, "wear-trouble")


WORN_HIP = "view=wear&preset=hip-36&cup.inclination=40&cup.anteversion=15"
WEAR = f"{WORN_HIP}&use.millions=0.1&use.coefficient=1e-7&use.spread=1"


@pytest.fixture
def nothing_is_known(monkeypatch):
    store = ResultStore()
    monkeypatch.setattr(results, "RESULTS", store)
    monkeypatch.setattr(wear_view, "RESULTS", store)
    monkeypatch.setattr(hip_runs, "bytes_by_units", lambda figure: dict.fromkeys(Units, b"a picture"))


def test_a_life_is_that_of_python(at_once, nothing_is_known):
    page = opened(WEAR)  # which runs by itself
    cup = bs.Cup(inclination=radians(40.0), anteversion=radians(15.0))
    use = HipSimulation(joint=bs.joints["hip-36"], cycle=iso_14242_1(), wear=Archard(coefficient=1e-7), cup=cup)
    last = use.after(1e5, report_at=[1e4 * each for each in range(1, 10)]).last
    assert ["worn volume [mm³]", f"{last.volume:.4g}"] in cells(page, "wear-numbers")
    rows = [line.split(",") for line in saved(page, "CSV").decode().splitlines()]
    assert [rows[0][2], rows[0][6]] == ["penetration [mm]", "volume [mm3]"]
    shown = [float(rows[-1][column]) for column in (2, 5, 6)]
    assert shown == pytest.approx([last.penetration, last.depth, last.volume])
    assert float(rows[1][2]) == 0
    does(page, "edit", name="units", value="imperial")
    assert saved(page, "CSV").startswith(b"design,million cycles,penetration [mil],low [mil]")
    does(page, "edit", name="units", value="SI")
    assert "numerical error of the run" in told(page, "wear-numbers")
    assert f"up to {1e3 * last.depth:.4g} µm" in told(page, "wear-maps")
    shares = [news.share for news in at_once.news]
    assert shares == sorted(shares)
    assert len(shares) > 5
    shown = told(page, "wear-numbers")
    assert "deepest wear" in [row["title"] for row in blocks(page, "wear-numbers", "checks")[0]["rows"]]
    assert told(page, "wear-earlier") == ""
    edits(page, "wear.millions", 1)
    assert told(page, "wear-numbers").replace("earlier design 1", "hip-36") == shown  # nothing is lost
    assert "belong to earlier inputs" in told(page, "wear-earlier")
    edits(page, "wear.millions", 0.1)
    assert (told(page, "wear-numbers"), told(page, "wear-earlier")) == (shown, "")


def made(scale):
    grown, grid = scale * np.arange(3.0), graded_grid(radians(90.0), radians(10.0))
    last = {"edge_distance": 1.0, "penetration_of_creep": 0.0, "max_pressure": 5.0, "contact": [{"utilisation": None}]}
    contact = {"valid": scale > 0.1, "unworn": [{"utilisation": 1.5 - scale}]}
    summary = {"history": [last], "contact": contact, "cycle": {"peaks": {"max_pressure_MPa": 10.0}}}
    curves = {"penetration": grown, "deepest": grown, "volume": 100 * grown, "low": 0.5 * grown, "high": 2 * grown}
    depth = scale * np.ones((grid.rings, grid.meridians))
    checks = (wear_check(bs.joints["hip-36"], exact_number(30 * scale)),)
    bore = {"depth": depth, "grid": grid, "cup": bs.Cup(), "load": np.array([0.0, 0.0, 1.0])}
    texts = {"band": "band: of a test", "notes": ("a note",), "figures": dict.fromkeys(Units, b"")}
    return hip_runs.WearResult(cycles=np.arange(3.0), **curves, **bore, **texts, summary=summary, checks=checks)


def test_a_bore_worn_to_the_rim_fails_there_only_by_edge_loading():
    distances = np.array([0.0, 3.0, -1.0])
    hip = SimpleNamespace(frame=SimpleNamespace(reach=1.5), joint=bs.joints["hip-36"])
    (row,) = hip_runs.worn_rim_rows(hip, distances, np.zeros(3, dtype=bool))
    assert (row.title, row.verdict.word) == ("reach of the contact", "undecided")
    assert hip_runs.worn_rim_rows(hip, distances, np.array([False, False, True])) == []


def test_two_designs_are_beside_each_other_in_one_scale():
    found = {"one": made(0.1), "other": made(0.2)}
    table, *others = wear_numbers(found)
    assert ["worn volume [mm³]", "20", "40 (+100 %)"] in table["rows"]
    assert "1.4" in dict(row[:2] for row in table["rows"])["utilisation σv/σy, new"]
    assert str(others).count("✗ Exceeded: deepest wear is 1.2 times the liner thickness") == 1
    assert str(others).count("outside the range in which this model can be trusted") == 1
    assert "✗ one: outside" in str(others)
    inches = Reading(units=Units.IMPERIAL)
    assert "penetration [mil]" in str(penetration_chart(found, inches))
    assert "largest pressure, new [psi]" in str(wear_numbers(found, inches))
    (chart,) = penetration_chart(found)[0]["charts"]
    assert "one: 200 µm after 2 million cycles, 100 µm to 400 µm" in chart["label"]
    assert all(curve["band"] for curve in chart["curves"])
    assert len(chart["curves"]) == 2
    scales = re.findall(r"worn depth \[µm\].*?</svg>", depth_maps(found), flags=re.DOTALL)
    assert len(scales) == 2
    assert scales[0].split("worn depth")[-1] == scales[1].split("worn depth")[-1]


def test_inputs_are_a_design_beside_and_a_coefficient_with_its_unit(asked, nothing_is_known):
    page = opened(WEAR)
    edits(page, "wear.beside", "as it is now")
    assert len(asked[-1][1]) == 1  # the same design twice is one
    edits(page, "clearance", "0.4")
    assert len(asked[-1][1]) == 2
    (other,) = page.screen.beside
    assert (other.joint.clearance, other.cup) == (0.1, page.screen.file.cup)
    assert opened(page.channel.shown_value("link")).screen == page.screen
    edits(page, "wear.beside", "hip-28")
    assert page.screen.beside[0].joint == bs.joints["hip-28"]
    edits(page, "wear.beside", "")
    assert page.screen.beside == ()
    edits(page, "wear.coefficient", "1,066e-6 mm^3/(N m)")  # as others write it
    assert page.screen.use.coefficient == pytest.approx(1.066e-6)


@pytest.mark.long
def test_patients_whose_coefficient_scatters_make_the_band(nothing_is_known):
    page = opened(WEAR)
    use = replace(DEFAULT_USE, millions=0.2, spread=1.5)
    (found,) = hip_runs.simulate_designs({"one": page.screen.file}, use, {}, lambda news: None).values()
    assert (found.low[1:] < found.penetration[1:]).all()
    assert (found.penetration[1:] < found.high[1:]).all()
    assert found.high[-1] / found.penetration[-1] == pytest.approx(1.5**1.96, rel=0.25)
    assert "64 patients" in found.band
    assert "95 % of the predictions" in found.band


EVIDENCE = "view=evidence&preset=hip-36&load.force=3000"
EVIDENCE_CUP = bs.Cup(inclination=radians(40.0))
FILE = JointFile(bs.joints["hip-36"], {"force": 3000.0})


def test_what_is_typed_is_a_question_file(tmp_path):
    limits, tolerances = "max_pressure <= 20 MPa; half_angle <= 60 deg", "clearance = 0.1 +- 0.02 mm"
    matrix = "force = 2, 3 kN; inclination = 30, 45 deg; clearance = 0.1 mm"
    more = {"tolerances": tolerances, "friction": "0.06", "elements": "yes", "wear": "yes"}
    asked = EvidenceQuestion(limits=limits, matrix=matrix, **more)
    use = Use(cycle="walking", body_weight=750.0, millions=2.0, creep="yes")
    found = write_question(asked, JointFile(FILE.joint, FILE.load, EVIDENCE_CUP), use, tmp_path)
    assert found.axes["force"] == (2000.0, 3000.0)
    assert found.axes["inclination"] == pytest.approx((radians(30.0), radians(45.0)))
    assert (found.file.joint.ball_radius, found.file.cup) == (18.0, EVIDENCE_CUP)
    assert [str(limit) for limit in found.limits] == ["max_pressure ≤ 20 MPa", "half_angle ≤ 60°"]
    assert (found.accuracy, found.friction, found.finite_elements) == (0.1, 0.06, True)
    hip = read_hip(found.hip)
    assert (hip.cycles, hip.use.cycle.name, hip.use.creep is not None) == (2e6, "walking", True)
    assert hip.use.cycle.force_magnitudes.max() == pytest.approx(2.47 * 750, rel=0.01)
    plain = write_question(DEFAULT_QUESTION, FILE, DEFAULT_USE, tmp_path)
    assert (plain.file.joint, plain.hip) == (FILE.joint, None)
    assert not (tmp_path / "hip.toml").exists()  # it would be taken along


def test_a_question_is_read_as_it_is_typed():
    page = opened(EVIDENCE)
    assert re.search("1 case<.*3000 N<", unescape(told(page, "evidence-found")), re.DOTALL)  # the load on the page
    edits(page, "evidence.matrix", "force = 2, 3 kN")
    assert "2000 N, 3000 N" in unescape(told(page, "evidence-found"))
    edits(page, "evidence.matrix", "force = 2, 3 kN; clearance = 0.05, 0.1, 0.15 mm")
    assert "6 cases" in unescape(told(page, "evidence-found"))
    assert "ask.matrix=" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen
    edits(page, "load", 4000)
    edits(page, "evidence.matrix", "clearance = 0.05, 0.1 mm")
    assert re.search("2 cases<.*4000 N<", unescape(told(page, "evidence-found")), re.DOTALL)
    edits(page, "kind", "half_angle")
    assert not told(page, "evidence-trouble")


(QUESTIONS,) = text_tables(Path(__file__).parent / "refused_questions.txt")


@pytest.mark.parametrize(("name", "value", "sentence"), QUESTIONS)
def test_what_is_wrong_with_a_question_is_said_in_the_view(name, value, sentence):
    page = opened(EVIDENCE)
    edits(page, f"evidence.{name}", value)
    assert sentence in unescape(told(page, "evidence-trouble"))


def test_limits_are_rows():
    page = opened(EVIDENCE)
    edits(page, "evidence.limits.0.quantity", "max_pressure")
    edits(page, "evidence.limits.0.value", "20")
    edits(page, "evidence.limits", True)
    edits(page, "evidence.limits.1.value", "60")
    assert page.screen.asked.limits.startswith("max_pressure<=20.0; half_angle<=1.047")
    assert page.channel.shown_value("=evidence.limits")["value"].endswith("half angle at most 60°")
    assert opened(page.channel.shown_value("link")).screen == page.screen
    does(page, "edit", name="units", value="imperial")
    edits(page, "evidence.limits.0.value", "3000")
    limit, _ = evidence._limits(page.screen.asked)
    assert limit.high == pytest.approx(20.68, rel=1e-3)


def test_a_limit_is_asked_for_before_anything_runs(asked):
    page = opened(f"{EVIDENCE}&ask.limits=")
    assert "Evidence needs a limit to decide on" in unescape(told(page, "evidence-trouble"))
    edits(page, "evidence.allowable", True)
    assert "the liner has no allowable pressure" in trouble(page)
    edits(page, "allowable", 20)
    assert asked == []
    edits(page, "evidence.allowable", True)
    assert page.screen.asked.limits == "max_pressure <= 20 MPa"
    assert len(asked) == 1
    page.leave()


def test_the_pack_that_was_gathered_is_taken(monkeypatch):
    folders = []
    limits = [
        {"name": "max_pressure", "low": None, "high": high, "verdict": verdict, "reason": reason}
        for high, verdict, reason in ((20.0, "kept", ""), (10.0, "exceeded", "2 cases beyond the limit"))
    ]

    def ask(self, key, work):
        folders.append(Path(work.args[-1]))
        assert folders[-1].is_dir()
        worst = {"max_pressure": {"numbers": {"max_pressure": 11.2}, "errors": {}, "bars": {}, "case": {"force": 2e3}}}
        accuracy = {"largest": None, "required": 0.05, "holds": False}
        record = {
            "worst": worst,
            "limits": limits,
            "accurate": accuracy,
            "adequacy": {"text": "gaps", "not_met": ["test samples"]},
            "recentred": [],
        }
        pack = EvidencePack(record=record, content={units: units.value.encode() for units in Units})
        self._heard(key, RunFinished(pack))

    monkeypatch.setattr(Job, "ask", ask)
    monkeypatch.setattr(results, "RESULTS", results.ResultStore())
    page = opened(f"{EVIDENCE}&ask.limits=max_pressure <= 20 MPa")
    found = unescape(told(page, "evidence-found"))
    assert "11.2 MPa" in found
    assert found.startswith("<p class='verdict no'>✗ largest pressure at most 10 MPa: exceeded")
    assert "✓ largest pressure at most 20 MPa: kept" in found
    assert "Factors below that level: test samples" in found
    for units in ("imperial", "SI"):
        edits(page, "units", units)
        pack = edits(page, "evidence.take", True)["file"]
        assert (pack["name"], b64decode(pack["content"]).decode()) == ("evidence.zip", units)
    assert b"largest pressure,11.2 MPa" in saved(page, "CSV")
    edits(page, "liner_young", 900)
    assert unescape(told(page, "evidence-found")) == found
    assert "belong to earlier inputs" in unescape(told(page, "evidence-earlier"))
    edits(page, "evidence.take", True)
    assert "there is no result for this design yet" in trouble(page)
    page.leave()
    assert not folders[0].exists()


@pytest.mark.long
def test_a_pack_is_what_the_command_writes(tmp_path):
    news, asked = [], EvidenceQuestion(matrix="force = 2000 N")
    found = gather_pack(asked, FILE, DEFAULT_USE, str(tmp_path), lambda reached: news.append(reached.share))
    assert news == sorted(news)
    with zipfile.ZipFile(io.BytesIO(found.content[Units.IMPERIAL])) as pack:
        assert "2000 N" not in pack.read("evidence.html").decode()
    with zipfile.ZipFile(io.BytesIO(found.content[Units.SI])) as pack:
        assert "2000 N" in pack.read("evidence.html").decode()
        assert pack.namelist() == ["checksums.txt", "evidence.html", "evidence.json", "question.toml"]
        pack.extractall(tmp_path / "again")
    assert read_question(tmp_path / "again" / "question.toml").axes == {"force": (2000.0,)}
    exact = bs.Exact().press(FILE.joint, force=2000.0).max_pressure
    assert found.record["worst"]["max_pressure"]["numbers"]["max_pressure"] == pytest.approx(exact, rel=1e-6)
