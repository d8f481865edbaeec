"""HTML of a gait cycle: charts, the moving bore and a player."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ....core.kinds import Unit
from ....core.quantities import CONTACT, DERIVED, Quantity
from ....reports.style import INK, LineStyle
from ...pictures.bore import bowl
from ...pictures.chart import Curve, chart
from ...pressing import rounded_up
from ...widgets.reading import Reading
from .worker import MERIDIANS, GaitResult

_PHASE_LABEL = "phase of the cycle [%]"
_COURSE_LINE = LineStyle(INK)


_NM = Unit("nm")


@dataclass(frozen=True)
class Course:
    """Something over the cycle: where `Gaited` has it, what it is called, and as which quantity it is read."""

    field: str
    name: str
    quantity: Quantity | None = None

    def unit(self, reading: Reading) -> Unit:
        """Return the unit of the values; films are in nm."""
        return _NM if self.quantity is None else reading.unit(self.quantity)

    def label(self, reading: Reading) -> str:
        """Return the label of the axis."""
        return f"{self.name}{self.unit(reading).text_in_brackets}"

    def of(self, result: GaitResult, reading: Reading) -> numpy.ndarray:
        """Return the values over the instants of a cycle."""
        return numpy.asarray(getattr(result, self.field)) * self.unit(reading).factor


COURSES = (
    Course("force", "load", CONTACT["force"]),
    Course("pressure", CONTACT["max_pressure"].title, CONTACT["max_pressure"]),
    Course("film", "least film"),
    Course("edge", DERIVED["edge_distance"].title, DERIVED["edge_distance"]),
)
"""Courses of a cycle on the page."""


def player(result: GaitResult, reading: Reading) -> str:
    """Return the player of a cycle; the element `gait-at` of the page holds the instant."""
    charts = "".join(f"<figure>{_chart(course, result, reading)}</figure>" for course in COURSES)
    listed = [
        {"name": course.name, "unit": course.unit(reading).text, "values": _plain(course.of(result, reading), 5)}
        for course in COURSES
    ]
    data = {"phase": _plain(result.phase, 5), "courses": listed}
    return (
        f"<div class='player' data-at='gait-at' data-event='gait.instant' data-player='{_json(data)}'>"
        "<div class='transport'><button type='button' class='plain'>▶ Play</button>"
        f"<input type='range' min='0' max='{len(result.phase) - 1}' step='1' aria-label='instant of the cycle'></div>"
        f"<output class='quiet'></output><div class='beside'><figure>{_bore(result)}"
        "<figcaption>Pressure on the cup now: drag it, or use the arrow keys</figcaption></figure>"
        f"<div class='courses'>{charts}</div></div></div>"
    )


def _chart(course: Course, result: GaitResult, reading: Reading) -> str:
    values = course.of(result, reading)
    values = numpy.where(numpy.isfinite(values), values, numpy.nan)
    highest = rounded_up(1.05 * float(numpy.nanmax(values, initial=0.0)))
    curve = Curve(result.phase, values, numpy.full(values.shape, True), _COURSE_LINE)
    label = _course_description(f"{course.name} over the cycle", course.unit(reading), result.phase, values)
    return chart(label, _PHASE_LABEL, course.label(reading), {course.name: curve}, (100.0, highest))


def _course_description(name: str, unit: Unit, phase: numpy.ndarray, values: numpy.ndarray) -> str:
    """Describe a course in a sentence for screen readers."""
    if numpy.isnan(values).all():
        return f"{name}: no number"
    low, high = float(numpy.nanmin(values)), float(numpy.nanmax(values))
    peak_phase = float(phase[int(numpy.nanargmax(values))])
    return f"{name}: {low:.3g} to {high:.3g} {unit.text}, most at {peak_phase:.3g} % of it"


def _bore(result: GaitResult) -> str:
    largest = float(result.force.max(initial=0.0)) or 1.0
    return bowl(
        "gait",
        "the pressure on the cup in the instant that is chosen; arrow keys turn it, Home looks into its opening",
        polar=result.polar.round(5).tolist(),
        meridians=MERIDIANS,
        bytes=b64encode(result.cells).decode("ascii"),
        loads=result.load.round(4).tolist(),
        sizes=(result.force / largest).round(4).tolist(),
        outer=1.25,
        turned=[0.0, 0.0],
    )


def _plain(values: numpy.ndarray, digits: int) -> list[float | None]:
    return [float(f"{value:.{digits}g}") if numpy.isfinite(value) else None for value in values.tolist()]


def _json(data: Mapping[str, Any]) -> str:
    return escape(json.dumps(data, separators=(",", ":")), quote=True)
