"""Every door of a result says the same: terminal, page and data have the same numbers, in both systems of units."""

import re
from dataclasses import replace
from functools import cache
from html import unescape
from io import StringIO

import numpy as np
import pint
import pytest
from matplotlib.text import Text

import ballsocket as bs
from ballsocket.core.answers import PAGE, Answer, named_records, records
from ballsocket.core.unit_systems import Amount, Sentence, Units
from ballsocket.files.joint_file import JointFile
from ballsocket.hip import Archard, MeasuredWear, fit_wear_coefficient
from ballsocket.hip.answers import HipRun, describe_bands, describe_hips, describe_history
from ballsocket.identification import Measured
from ballsocket.identification.result_answer import describe_identification
from ballsocket.lubrication import Lubricant
from ballsocket.lubrication.film import describe_films
from ballsocket.planning import fit_liner, make_plan, measure_wear, read_mesh, read_points
from ballsocket.planning.plan import describe_plan
from ballsocket.press_answer import describe_curve, describe_press, press_remarks
from ballsocket.problem.cup import Cup
from ballsocket.question import PressQuestion, answer
from ballsocket.reports import evidence_parts, hip_plots, study_plots
from ballsocket.reports.film_results import film_figure
from ballsocket.reports.hip_comparison import wear_figure, wear_fit_figure
from ballsocket.reports.hip_report import hip_report
from ballsocket.reports.identify_results import corner_figure, fit_figure
from ballsocket.reports.joint_drawing import joint_svg
from ballsocket.reports.orientation_plots import orientation_figure
from ballsocket.reports.pages import answer_lede, answer_sections
from ballsocket.reports.press_plots import plot
from ballsocket.reports.section_plots import section_figure
from ballsocket.reports.style import in_units
from ballsocket.reports.terminal import print_answer
from ballsocket.studies.calibration import describe_calibration
from ballsocket.studies.derivatives import local_uncertainty
from ballsocket.studies.distributions import Rectangular, tolerance
from ballsocket.studies.limits import Limit
from ballsocket.studies.optimisation import optimise, pareto
from ballsocket.studies.orientation_answer import describe_orientations
from ballsocket.studies.study_answer import describe_front, describe_map, describe_optimum, describe_study
from ballsocket.studies.variance_shares import describe_sensitivity, sensitivity, uncertainty_tables

from ..hip.hips import QUICK, hip
from ..hip.test_uncertainty import bands
from ..places import EXAMPLES

WIDE = 2000
METRIC = re.compile(r"(?:\d |\[)(?:mm|mm²|mm³|µm|nm|MPa|kN|N|N m|mm³/\(N m\))(?![\w/(])")
SYMBOLS = {"mm²": "mm**2", "mm³": "mm**3", "in²": "in**2", "in³": "in**3", "°": "deg", "µin": "microinch"}
SYMBOLS |= {"million": "1", "": "1", "%": "1", "N m": "N*m", "lbf in": "lbf*in", "mm³/(N m)": "mm**3/(N*m)"}
SYMBOLS |= {"mm MPa": "mm*MPa", "in psi": "in*psi", "mil": "thou"}
COUNTS = {"million": 1e-6, "%": 100.0}


@cache
def history():
    return hip(**QUICK).after(2e4, [1e4], lubricant=Lubricant())


ANSWERS = {
    "wear of a hip": lambda: describe_history(history()),
    "bands of patients": lambda: describe_bands(bands()),
    "hips side by side": lambda: describe_hips([HipRun(name=name, history=history()) for name in ("new", "b")]),
}
"""Descriptions of cheap results of every kind."""


def plain_study(**axes):
    return bs.study(bs.HessForsbach(), bs.joints["hip-28"], quantities=QUANTITIES, **axes)


QUANTITIES = ("indentation", "half_angle", "max_pressure", "area", "stiffness", "utilisation")
LIMITS = (Limit(name="outer_radius", high=26.0), Limit(name="half_angle", low=0.2))
SPACE = {"clearance": [0.05, 0.2], "liner_thickness": [5.0, 8.0], "force": 3000.0}
SPREAD = {"clearance": tolerance(0.1, 0.05), "liner_young": Rectangular(low=700.0, high=1100.0)}


def best():
    ranges = {"liner_thickness": (4.0, 8.0), "liner_young": (700.0, 1100.0)}
    joint, load = bs.joints["hip-28"], {"force": 3000.0}
    return optimise(bs.HessForsbach(), joint, ranges, load=load, limits=LIMITS, minimise="indentation")


def yielding():
    model = bs.FiniteElement(plastic=True, meshes=1, spacing=bs.Adapted(elements=24))
    return bs.compare(bs.joints["hip-28"], models={"fem": model}, force=8000.0)


def surroundings():
    return local_uncertainty(bs.joints["hip-28"], Cup(), {"force": 3000.0}, SPREAD)


def shares(**options):
    settings = {"quantities": ["max_pressure", "area"], "count": 32, "load": {"force": 3000.0}, **options}
    return sensitivity(bs.HessForsbach(), bs.joints["hip-28"], SPREAD, **settings)


ANSWERS |= {
    "study": lambda: describe_study(plain_study(**SPACE)),
    "study with materials": lambda: describe_study(plain_study(liner=[bs.UHMWPE, bs.POM], force=[1.0, 3000.0])),
    "map": lambda: describe_map(plain_study(**SPACE), LIMITS),
    "front": lambda: describe_front(pareto(plain_study(**SPACE), limits=LIMITS)),
    "yielding liner": lambda: describe_press(yielding()),
    "optimum": lambda: describe_optimum(best()),
    "sensitivity": lambda: describe_sensitivity(shares(second_order=True)),
    "tolerances": lambda: Answer(title="tolerances", tables=uncertainty_tables(surroundings())),
    "correlated sensitivity": lambda: describe_sensitivity(shares(correlation={("clearance", "liner_young"): 0.5})),
}


def identified(*quantities):
    """Identify clearance and modulus from exact readings of the closed form."""
    model, joint, force = bs.HessForsbach(), bs.joints["hip-28"], np.array([500.0, 1000.0, 2000.0, 3000.0])
    contact = model.press(joint, force=force)
    read = {name: getattr(contact, name) for name in quantities}
    data = [Measured(quantity=name, values=one, uncertainty=0.02 * one, force=force) for name, one in read.items()]
    return bs.identify(model, joint, data, {"clearance": (0.05, 0.2), "liner_young": (500.0, 2000.0)})


def film(method):
    return bs.film(bs.HessForsbach().press(bs.joints["hip-28"], force=2000.0), method=method)


ANSWERS |= {
    "films": lambda: describe_films([film("inlet"), film("wave")]),
    "identification": lambda: describe_identification(identified("indentation", "area")),
    "product of unknowns": lambda: describe_identification(identified("area")),
    "calibration": lambda: describe_calibration(bs.calibrate(bs.joints["hip-28"])),
}


def press(**options):
    return bs.compare(bs.joints["hip-28"], force=3000.0, **options)


@cache
def loosened():
    joint = bs.Joint(ball_radius=13.5, interference=0.01, liner_thickness=3.0, liner=bs.POM)
    return answer(PressQuestion(file=JointFile(joint=joint, load={}), sphere=bs.Sphere(ring_width=0.1)))


ANSWERS |= {
    "press": lambda: describe_press(press(models=["exact", "hess-forsbach", "hertz"])),
    "press without a result": lambda: describe_press(
        bs.compare(bs.joints["tilting-pad-pivot"], force=1.0, models=["exact", "bonded-layer"])
    ),
    "preloaded press": lambda: describe_press(loosened().comparison, press_remarks(loosened())),
    "curve": lambda: describe_curve(bs.Hertz().press(bs.joints["hip-28"], force=np.array([0.0, 300.0, 3000.0]))),
}


def orientations():
    sphere = bs.Sphere(ring_width=np.radians(6.0))
    angles = {"inclination": np.radians([30, 45, 60]), "anteversion": [0.3]}
    return bs.orient(bs.joints["hip-36"], model=sphere, force=3000.0, **angles)


RIM = (Limit(name="edge_distance", low=1.0), Limit(name="max_pressure", high=12.0))
ANSWERS["orientations"] = lambda: describe_orientations(orientations(), RIM)
ANSWERS["planning data"] = lambda: describe_plan(
    make_plan(
        liner=fit_liner(read_mesh(EXAMPLES / "planning" / "liner.stl")),
        worn=measure_wear(read_points(EXAMPLES / "planning" / "worn.xyz")),
    )
)


@cache
def registry():
    return pint.UnitRegistry()


def converted(value, metric, shown):
    """Convert a number by pint, which is independent of the factors of the package."""
    counted = COUNTS.get(shown, 1.0)
    metric, shown = ("/".join(SYMBOLS.get(part, part) for part in split(unit)) for unit in (metric, shown))
    return registry().Quantity(value, metric).to(shown).magnitude * counted


def split(unit):
    """Split the unit of a slope, such as "µm/mm"."""
    return [unit] if unit in SYMBOLS else unit.split("/")


def contains(line, expected):
    """Check that a line has the expected numbers, in their order, to the digits that are printed."""
    found = map(float, re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[-+]?\d+)?(?![\w.])", line))
    return all(any(number == approx for number in found) for approx in expected)


def amount(part, units):
    """Yield the number of an amount in the unit that the doors write."""
    shown = re.sub(r"^\S+? ?(?=[^\d.e+-]|$)", "", units.amount(part)) if part.unit.text else ""
    metric = part.unit.text
    factor = part.unit.factor * (1.0 if metric == shown else converted(1.0, metric, shown))
    digits = {"rel": 0.6 * 10 ** (1 - part.digits), "abs": 1e-12}
    if part.decimals is not None:
        digits = {"abs": 0.6 * 10**-part.decimals * factor / part.unit.factor}
    yield pytest.approx(part.value * factor, **digits)


def expected_numbers(row, table, units, most_rank):
    """Return the numbers of a row as a reader of its data expects them in the unit that the door writes."""
    (keyed,) = records(table._replace(rows=[row]))
    for cell, column in zip(row.cells, table.columns, strict=True):
        if column.rank > most_rank:
            continue
        if isinstance(cell, Sentence):
            yield from (number for part in cell.pieces if isinstance(part, Amount) for number in amount(part, units))
        if column.unit is None or isinstance(cell, str):
            continue
        value, metric, digits = keyed[column.key], column.written.text, column.digits
        shown = units.written(column.unit).text
        if isinstance(cell, Amount):
            yield from amount(cell, units)
            continue
        for end in value if isinstance(value, list) else [value]:
            if end is not None and end == end:
                number = end if metric == shown else converted(end, metric, shown)
                tolerance = {"rel": 0.6 * 10 ** (1 - digits), "abs": 1e-12}
                if column.decimals is not None:
                    factor = 1.0 if metric == shown else converted(1.0, metric, shown)
                    tolerance = {"abs": 0.6 * 10 ** (np.floor(np.log10(factor)) - column.decimals)}
                yield pytest.approx(number, **tolerance)


def printed(answer, units):
    terminal = StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", str(WIDE))
        patch.setattr("sys.stdout", terminal)
        print_answer(answer, units)
    page = "".join(html for _, html in answer_sections(answer, units).values()) + answer_lede(answer, units)
    rows = re.findall(r"<(?:tr|p|li)>(.*?)</(?:tr|p|li)>", page, re.S)
    return terminal.getvalue().splitlines(), [unescape(re.sub(r"<[^>]+>", " ", row)) for row in rows]


def test_the_json_of_a_press_has_every_number_of_its_table():
    liner = replace(bs.UHMWPE, allowable_pressure=20.0)
    comparison = bs.compare(bs.joints["hip-28"].replace(liner=liner), force=3000.0, models=["exact", "hess-forsbach"])
    (table,) = describe_press(comparison).tables
    for row in records(table):
        data = next(result for result in comparison.summary()["results"] if result["model"] == row["model"])
        assert {"utilisation", "pressure_ratio"} < row.keys()
        assert {name: data[name] for name in row} == row


@pytest.mark.long
def test_the_page_of_a_hip_draws_its_bands_and_states_their_level():
    page, level = hip_report(history(), bands()), bands().level
    assert f"the band holds {100 * level:.0f} % of the samples" in page


@pytest.mark.parametrize("units", Units)
@pytest.mark.parametrize("name", ANSWERS)
def test_every_door_has_the_same_numbers_and_sentences(name, units):
    answer = ANSWERS[name]()
    terminal, page = printed(answer, units)
    for table in answer.tables:
        assert [[*row.values()] for row in records(table)] == [[*row.values()] for row in named_records(table)]
        for lines, most_rank in ((terminal, PAGE - 1), (page, PAGE)):
            for row in table.rows:
                expected = list(expected_numbers(row, table, units, most_rank))
                assert row.rank > most_rank or any(contains(line, expected) for line in lines), (table.key, expected)
    sentences = [*answer.lines, *(line for table in answer.tables for line in table.lines), *answer.notes]
    for lines in (terminal, page):
        folded = " ".join(" ".join(lines).split())
        assert all(" ".join(units.sentence(sentence).split()) in folded for sentence in sentences)
        assert units is Units.SI or not METRIC.search(folded), METRIC.search(folded)


def fitted_wear():
    rate = MeasuredWear(quantity="volume", values=38.0, rate="mean", end=2e5, uncertainty=3.8)
    return fit_wear_coefficient(hip(wear=Archard(coefficient=1e-6), **QUICK), rate)


PACK = {
    "drawn": {"joint": bs.joints["hip-28"].summary(), "arc_of_cover_deg": 180.0, "half_angle_deg": 30.0},
    "worst": {"max_pressure": {"numbers": {"force": 3000.0}}},
}

FIGURES = {
    "press": lambda units: plot(dict(press(models=["exact", "hertz"])), units),
    "joint": lambda units: joint_svg(JointFile(bs.joints["hip-28"], {}, Cup()), press()["exact"], units=units),
    "joint of a pack": lambda units: evidence_parts.joint_drawing(PACK, units),
    "section": lambda units: in_units(section_figure(yielding()["fem"]), units),
    "film": lambda units: in_units(film_figure(film("wave")), units),
    "worn bore": lambda units: in_units(hip_plots.wear_map(history()), units),
    "wear": lambda units: in_units(wear_figure([history()]), units),
    "fit of wear": lambda units: in_units(wear_fit_figure(fitted_wear()), units),
    "identification": lambda units: in_units(fit_figure(identified("indentation", "area")), units),
    "correlation": lambda units: in_units(corner_figure(identified("indentation", "area"), None), units),
    "orientations": lambda units: orientation_figure(orientations(), units, RIM),
    "map": lambda units: study_plots.design_map(plain_study(**SPACE), LIMITS, units=units),
}
"""Figures of every kind, in a system of units."""


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_has_the_units_of_its_answer(name):
    drawn = {units: FIGURES[name](units) for units in reversed(Units)}
    texts = {
        units: re.sub("<[^>]*>", " | ", figure.decode())  # an SVG document
        if isinstance(figure, bytes)
        else " | ".join(text.get_text() for text in figure.findobj(Text))
        for units, figure in drawn.items()
    }
    assert METRIC.search(texts[Units.SI])
    assert not METRIC.search(texts[Units.IMPERIAL]), METRIC.search(texts[Units.IMPERIAL])
