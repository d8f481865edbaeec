"""HTML of a gait cycle: charts, the moving bore in three dimensions, and the flat bore of one instant."""

from __future__ import annotations

import json
from base64 import b64encode
from dataclasses import dataclass
from html import escape

import numpy

from ....core.kinds import Unit
from ....core.quantities import CONTACT, DERIVED, FIELD, Quantity
from ....files.joint_file import JointFile
from ....reports.style import BLUE, INK, LineStyle
from ...pictures.bore import CELLS_EDGE, BoreField, colour_scale, load_bore, node_field, shape_of, viewer
from ...pictures.chart import Curve, chart, legend
from ...pictures.svg import levels_between
from ...pressing import rounded_up
from ...widgets.reading import Reading
from ...widgets.words import number_text
from .worker import MERIDIANS, RINGS, Frames, GaitFilm, GaitResult

_PHASE_LABEL = "phase of the cycle [%]"
_SIZE = (520.0, 182.0)
_INK, _BLUE = LineStyle(INK), LineStyle(BLUE, (6.0, 2.0))
_NM, _RATIO = Unit("nm"), Unit("")
_FILM_TITLE = "film thickness"


@dataclass(frozen=True)
class Course:
    """Quantity over the cycle: its field of `GaitResult` or `GaitFilm`, its name, and its unit."""

    field: str
    name: str
    quantity: Quantity | None = None
    own_unit: Unit = _NM
    line: LineStyle = _INK

    def unit(self, reading: Reading) -> Unit:
        """Return the unit of the values; films are in nm."""
        return self.own_unit if self.quantity is None else reading.unit(self.quantity)

    def label(self, reading: Reading) -> str:
        return f"{self.name}{self.unit(reading).text_in_brackets}"

    def of(self, result: GaitResult | GaitFilm, reading: Reading) -> numpy.ndarray:
        return numpy.asarray(getattr(result, self.field)) * self.unit(reading).factor


_LOAD, _PRESSURE = Course("force", "load", CONTACT["force"]), CONTACT["max_pressure"]
_PRESS_CHARTS = (
    (_LOAD,),
    (Course("pressure", _PRESSURE.title, _PRESSURE),),
    (Course("edge", DERIVED["edge_distance"].title, DERIVED["edge_distance"]),),
)
_FILM_CHARTS = (
    (Course("least", "smallest film thickness"), Course("central", "central film thickness", line=_BLUE)),
    (Course("ratio", "film ratio λ", own_unit=_RATIO),),
)


def courses_of(result: GaitResult, film: GaitFilm | None, reading: Reading) -> list[list[tuple[Course, numpy.ndarray]]]:
    """List the courses of each chart with their values."""
    known = [[(course, course.of(result, reading)) for course in charted] for charted in _PRESS_CHARTS]
    if film is None:
        return known
    return [*known, *([(course, course.of(film, reading)) for course in charted] for charted in _FILM_CHARTS)]


def gait_charts(result: GaitResult, film: GaitFilm | None, reading: Reading) -> str:
    """Return the charts of a cycle, and the numbers with which the page plays it."""
    charts = courses_of(result, film, reading)
    listed = [
        {"name": course.name, "unit": course.unit(reading).text, "values": _plain(values, 5), "chart": number}
        for number, charted in enumerate(charts)
        for course, values in charted
    ]
    data = {"phase": _plain(result.phase, 5), "courses": listed, "rim": result.rim.tolist()}
    drawn = "".join(_chart(charted, result, reading) for charted in charts)
    pending = "" if film is not None else "".join(_empty_chart(charted, reading) for charted in _FILM_CHARTS)
    numbers = escape(json.dumps(data, separators=(",", ":")), quote=True)
    return f"<div data-player='{numbers}'></div>{drawn}{pending}"


def empty_charts(reading: Reading) -> str:
    """Return axes without curves for a cycle that is being prepared."""
    return "".join(_empty_chart(charted, reading) for charted in (*_PRESS_CHARTS, *_FILM_CHARTS))


def _empty_chart(charted: tuple[Course, ...], reading: Reading) -> str:
    words = f"{charted[0].label(reading)}: Preparing ..."
    axes = chart(words, _PHASE_LABEL, "", {}, (100.0, 1.0), _SIZE)
    return f"<figure class='quiet'><figcaption>{escape(words)}</figcaption>{axes}</figure>"


def _chart(charted: list[tuple[Course, numpy.ndarray]], result: GaitResult, reading: Reading) -> str:
    unit = charted[0][0].unit(reading)
    known = numpy.concatenate([values[numpy.isfinite(values)] for _, values in charted])
    highest = rounded_up(1.05 * float(known.max(initial=0.0)))
    curves = {
        course.name: Curve(result.phase, numpy.where(numpy.isfinite(values), values, numpy.nan), course.line)
        for course, values in charted
    }
    flagged = _spans(result) if charted[0][0].field == "edge" else []
    sentence = "; ".join(_range_sentence(course, values, unit) for course, values in charted)
    named = f"{legend({course.name: course.line for course, _ in charted})} " if len(charted) > 1 else ""
    red = " <b class='no'>✗ red: rim contact</b>" if flagged else ""
    drawn = chart(
        f"over the cycle: {sentence}", _PHASE_LABEL, unit.text or "λ", curves, (100.0, highest), _SIZE, flagged
    )
    return f"<figure><figcaption>{escape(sentence)}{red} {named}</figcaption>{drawn}</figure>"


def _range_sentence(course: Course, values: numpy.ndarray, unit: Unit) -> str:
    known = values[numpy.isfinite(values)]
    if not len(known):
        return f"{course.name}: no number"
    return f"{course.name}: {number_text(known.min())} to {number_text(known.max())} {unit.text}".rstrip()


def _spans(result: GaitResult) -> list[tuple[float, float]]:
    """List the ranges of phase in % with rim contact."""
    steps = numpy.flatnonzero(numpy.diff(numpy.concatenate([[0], result.rim, [0]])))
    half = 50.0 / len(result.phase)
    return [
        (float(result.phase[start]) - half, float(result.phase[end - 1]) + half)
        for start, end in zip(steps[::2], steps[1::2], strict=True)
    ]


def least_edge_distance(result: GaitResult) -> float:
    """Return the smallest distance from the contact to the rim in mm; NaN if the cycle presses nothing."""
    known = result.edge[numpy.isfinite(result.edge)]
    return float(known.min()) if known.size else numpy.nan


def rim_sentence(result: GaitResult, reading: Reading) -> str:
    """State in words if the contact reaches the rim, and when."""
    if not result.rim.any():
        distance = least_edge_distance(result)
        if numpy.isnan(distance):
            return "<p class='trust no'>✗ No contact: this cycle never presses the ball into its socket</p>"
        least = reading.with_unit(DERIVED["edge_distance"], distance)
        return f"<p class='trust yes'>✓ No rim contact: the contact ends at least {least} before the rim</p>"
    spans = ", ".join(f"{low:.0f} to {high:.0f} %" for low, high in _spans(result))
    share = f"{100 * result.rim.mean():.0f} % of the cycle"
    return f"<p class='trust no'>✗ Rim contact in {share} ({spans}): the pressure there is a lower bound</p>"


def _shown(result: GaitResult, film: GaitFilm | None, reading: Reading) -> tuple[Frames, float, str]:
    """Return the field on the bore, the factor of its unit, and its label; the pressure without a film."""
    if film is not None:
        return film.frames, 1.0, f"{_FILM_TITLE}{_NM.text_in_brackets}"
    return result.frames, reading.unit(FIELD["pressure"]).factor, reading.label(FIELD["pressure"])


def gait_viewer(result: GaitResult, film: GaitFilm | None, file: JointFile, reading: Reading) -> str:
    """Show the pressure or the film of a cycle on the bore in three dimensions."""
    frames, factor, label = _shown(result, film, reading)
    levels = levels_between(0.0, factor * frames.highest or 1.0)
    return viewer(
        "gait",
        f"{label} on the cup in the chosen instant",
        colour_scale(levels, label),
        **shape_of(file.joint, file.cup, result.reach, RINGS, MERIDIANS),
        bytes=b64encode(frames.cells.tobytes()).decode("ascii"),
        gain=factor * frames.highest / levels[-1],
        loads=result.load.round(4).tolist(),
        sizes=(result.force / (float(result.force.max(initial=0.0)) or 1.0)).round(4).tolist(),
        film=film is not None,
    )


def flat_bore(result: GaitResult, film: GaitFilm | None, file: JointFile, reading: Reading, instant: int) -> str:
    """Draw the pressure or the film of one instant on the flat bore."""
    frames, factor, label = _shown(result, film, reading)
    nodes = factor * frames.highest / 255 * frames.cells[instant]
    field = BoreField(
        name="gait",
        at=node_field(nodes if film is None else numpy.where(nodes > 0, nodes, numpy.nan), result.reach),
        highest=factor * frames.highest or 1.0,
        label=label,
        reach=result.reach,
        cup=file.cup,
        least=CELLS_EDGE if film is None else 1e-3,
    )
    phase, highest = result.phase[instant], number_text(nodes.max())
    words = f"{label} at {phase:.1f} % of the cycle, seen from the opening, up to {highest}"
    return load_bore(field, words, result.load[instant])


def _plain(values: numpy.ndarray, digits: int) -> list[float | None]:
    return [float(f"{value:.{digits}g}") if numpy.isfinite(value) else None for value in values.tolist()]
