"""A cycle that is played, as HTML: charts of its courses, the bore that moves, and the numbers of an instant."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ..output.style import INK, Line
from ..quantities import CONTACT, DERIVED
from .bowl import bowl
from .chart import Curve, chart
from .gaiting import MERIDIANS, Gaited
from .pressing import rounded_up

_PHASE = "phase of the cycle [%]"
_LINE = Line(INK)


@dataclass(frozen=True)
class Course:
    """A quantity over the cycle: its name, its unit, and the factor to that from what `Gaited` has."""

    field: str
    name: str
    unit: str
    factor: float = 1.0

    @property
    def label(self) -> str:
        """The label of an axis: name and unit."""
        return f"{self.name} [{self.unit}]"

    def of(self, found: Gaited) -> numpy.ndarray:
        """Values over the instants of a cycle."""
        return numpy.asarray(getattr(found, self.field)) * self.factor


COURSES = (
    Course("force", "load", "kN", 1e-3),
    Course("pressure", CONTACT["max_pressure"].title, CONTACT["max_pressure"].unit),
    Course("film", "least film", "nm"),
    Course("edge", DERIVED["edge_distance"].title, DERIVED["edge_distance"].unit),
)
"""What is shown of a cycle."""


def player(found: Gaited) -> str:
    """The whole player; which instant is looked at stands in the page's `gait-at`."""
    charts = "".join(f"<figure>{_chart(course, found)}</figure>" for course in COURSES)
    listed = [{"name": each.name, "unit": each.unit, "values": _plain(each.of(found), 5)} for each in COURSES]
    data = {"phase": _plain(found.phase, 5), "courses": listed}
    return (
        f"<div class='player' data-at='gait-at' data-told='gait.instant' data-player='{_json(data)}'>"
        "<div class='transport'><button type='button' class='plain'>▶ Play</button>"
        f"<input type='range' min='0' max='{len(found.phase) - 1}' step='1' aria-label='instant of the cycle'></div>"
        f"<output class='quiet'></output><div class='beside'><figure>{_bore(found)}"
        "<figcaption>Pressure on the cup now: drag it, or use the arrow keys</figcaption></figure>"
        f"<div class='courses'>{charts}</div></div></div>"
    )


def _chart(course: Course, found: Gaited) -> str:
    values = course.of(found)
    values = numpy.where(numpy.isfinite(values), values, numpy.nan)
    highest = rounded_up(1.05 * float(numpy.nanmax(values, initial=0.0)))
    curve = Curve(found.phase, values, numpy.full(values.shape, True), _LINE)
    return chart(_said(course, found.phase, values), _PHASE, course.label, {course.name: curve}, (100.0, highest))


def _said(course: Course, phase: numpy.ndarray, values: numpy.ndarray) -> str:
    """A course in a sentence for whoever does not see it."""
    if numpy.isnan(values).all():
        return f"{course.name} over the cycle: no number"
    low, high = float(numpy.nanmin(values)), float(numpy.nanmax(values))
    place = float(phase[int(numpy.nanargmax(values))])
    return f"{course.name} over the cycle: {low:.3g} to {high:.3g} {course.unit}, most at {place:.3g} % of it"


def _bore(found: Gaited) -> str:
    largest = float(found.force.max(initial=0.0)) or 1.0
    return bowl(
        "gait",
        "the pressure on the cup in the instant that is chosen; arrow keys turn it, Home looks into its opening",
        polar=found.polar.round(5).tolist(),
        meridians=MERIDIANS,
        bytes=b64encode(found.cells).decode("ascii"),
        loads=found.load.round(4).tolist(),
        sizes=(found.force / largest).round(4).tolist(),
        outer=1.25,
        turned=[0.0, 0.0],
    )


def _plain(values: numpy.ndarray, digits: int) -> list[float | None]:
    return [float(f"{value:.{digits}g}") if numpy.isfinite(value) else None for value in values.tolist()]


def _json(data: Mapping[str, Any]) -> str:
    return escape(json.dumps(data, separators=(",", ":")), quote=True)
