"""A cycle that is played, as HTML: charts of its courses, the bore that moves, and the numbers of an instant."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy

from ..core.kinds import Unit
from ..core.quantities import CONTACT, DERIVED, Quantity
from ..reports.style import INK, LineStyle
from .bowl import bowl
from .chart import Curve, chart
from .gaiting import MERIDIANS, Gaited
from .pressing import rounded_up
from .reading import Reading

_PHASE = "phase of the cycle [%]"
_LINE = LineStyle(INK)


_NM = Unit("nm")


@dataclass(frozen=True)
class Course:
    """Something over the cycle: where `Gaited` has it, what it is called, and as which quantity it is read."""

    field: str
    name: str
    quantity: Quantity | None = None

    def unit(self, reading: Reading) -> Unit:
        """The unit in which it is read; films are in nm."""
        return _NM if self.quantity is None else reading.unit(self.quantity)

    def label(self, reading: Reading) -> str:
        """The label of an axis."""
        return f"{self.name}{self.unit(reading).text_in_brackets}"

    def of(self, found: Gaited, reading: Reading) -> numpy.ndarray:
        """Values over the instants of a cycle."""
        return numpy.asarray(getattr(found, self.field)) * self.unit(reading).factor


COURSES = (
    Course("force", "load", CONTACT["force"]),
    Course("pressure", CONTACT["max_pressure"].title, CONTACT["max_pressure"]),
    Course("film", "least film"),
    Course("edge", DERIVED["edge_distance"].title, DERIVED["edge_distance"]),
)
"""What is shown of a cycle."""


def player(found: Gaited, reading: Reading) -> str:
    """The whole player; which instant is looked at stands in the page's `gait-at`."""
    charts = "".join(f"<figure>{_chart(course, found, reading)}</figure>" for course in COURSES)
    listed = [
        {"name": each.name, "unit": each.unit(reading).text, "values": _plain(each.of(found, reading), 5)}
        for each in COURSES
    ]
    data = {"phase": _plain(found.phase, 5), "courses": listed}
    return (
        f"<div class='player' data-at='gait-at' data-told='gait.instant' data-player='{_json(data)}'>"
        "<div class='transport'><button type='button' class='plain'>▶ Play</button>"
        f"<input type='range' min='0' max='{len(found.phase) - 1}' step='1' aria-label='instant of the cycle'></div>"
        f"<output class='quiet'></output><div class='beside'><figure>{_bore(found)}"
        "<figcaption>Pressure on the cup now: drag it, or use the arrow keys</figcaption></figure>"
        f"<div class='courses'>{charts}</div></div></div>"
    )


def _chart(course: Course, found: Gaited, reading: Reading) -> str:
    values = course.of(found, reading)
    values = numpy.where(numpy.isfinite(values), values, numpy.nan)
    highest = rounded_up(1.05 * float(numpy.nanmax(values, initial=0.0)))
    curve = Curve(found.phase, values, numpy.full(values.shape, True), _LINE)
    said = _said(f"{course.name} over the cycle", course.unit(reading), found.phase, values)
    return chart(said, _PHASE, course.label(reading), {course.name: curve}, (100.0, highest))


def _said(name: str, unit: Unit, phase: numpy.ndarray, values: numpy.ndarray) -> str:
    """A course in a sentence for whoever does not see it."""
    if numpy.isnan(values).all():
        return f"{name}: no number"
    low, high = float(numpy.nanmin(values)), float(numpy.nanmax(values))
    place = float(phase[int(numpy.nanargmax(values))])
    return f"{name}: {low:.3g} to {high:.3g} {unit.text}, most at {place:.3g} % of it"


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
