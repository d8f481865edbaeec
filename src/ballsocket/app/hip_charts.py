"""HTML of gait cycles and of wear: charts, tables, maps and a player."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from math import nan
from typing import Any

import numpy

from ..compare import relative_deviation
from ..core.kinds import Unit
from ..core.quantities import CONTACT, DERIVED, Quantity
from ..reports.pages import table
from ..reports.style import BLUE, INK, VERMILLION, LineStyle
from .chart import Curve, chart, legend
from .cup_pictures import METRIC, BoreField, bowl, grid_field, worn_bore
from .hip_tasks import MERIDIANS, GaitResult, WearResult
from .pressing import rounded_up
from .reading import Reading
from .words import doubt, notes_list, number_text, percent

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


_DEPTH, _PRESSURE = CONTACT["indentation"], CONTACT["max_pressure"]
"""Quantities whose units depths and pressures have."""

_DESIGN_LINES = (LineStyle(BLUE), LineStyle(VERMILLION, (6.0, 2.0)))


def wear_numbers(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> str:
    """Tabulate the final wear of each design, with the difference from the first."""
    first, *further = designs.values()
    rows = []
    for name, values in _final_values(first, reading).items():
        values_of_others = [_final_values(design, reading)[name] for design in further]
        rows.append(
            [
                name,
                number_text(values),
                *(f"{number_text(entry)} ({_deviation(entry, values)})" for entry in values_of_others),
            ]
        )
    notes = "".join(
        f"{doubt(entry.summary['contact']['valid'], name)}"
        f"<p class='quiet'>{escape(name)}: {escape(entry.band)}</p>{notes_list(entry.notes)}"
        for name, entry in designs.items()
    )
    return f"{table(['after the last cycle', *designs], rows)}{notes}"


def _deviation(value: float, base: float) -> str:
    return percent(float(relative_deviation(value, base)), "+") if base else "–"


def _final_values(worn: WearResult, reading: Reading) -> dict[str, float]:
    last = worn.summary["history"][-1]
    edge = float("nan") if last["edge_distance"] is None else last["edge_distance"]
    new = worn.summary["cycle"]["peaks"]["max_pressure_MPa"]
    quantities = {
        "deepest wear": (_DEPTH, float(worn.deepest[-1])),
        "penetration": (_DEPTH, float(worn.penetration[-1])),
        "of it by creep alone": (_DEPTH, last["penetration_of_creep"]),
        "largest pressure, new": (_PRESSURE, new),
        "largest pressure, worn": (_PRESSURE, last["max_pressure"]),
        "nearest to the rim, worn": (DERIVED["edge_distance"], edge),
    }
    units = {name: reading.unit(quantity) for name, (quantity, _) in quantities.items()}
    numbers = {
        f"{name}{units[name].text_in_brackets}": value * units[name].factor for name, (_, value) in quantities.items()
    }
    new_and_worn = worn.summary["contact"]["unworn"], last["contact"]
    used = [[check["utilisation"] for check in checks if check["utilisation"] is not None] for checks in new_and_worn]
    utilisations = {
        f"utilisation σv/σy, {state}": max(part, default=nan) for state, part in zip(("new", "worn"), used, strict=True)
    }
    return {"worn volume [mm³]": float(worn.volume[-1]), **numbers, **utilisations}


def penetration_chart(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> str:
    """Draw the penetration of each design over the cycles, with its band."""
    lines = dict(zip(designs, _DESIGN_LINES, strict=False))
    unit = reading.unit(_DEPTH)
    curves = {
        name: Curve(
            design.cycles,
            unit.factor * design.penetration,
            numpy.full(design.cycles.shape, True),
            lines[name],
            band=(unit.factor * design.low, unit.factor * design.high),
        )
        for name, design in designs.items()
    }
    end = max(float(design.cycles[-1]) for design in designs.values())
    highest = rounded_up(unit.factor * max(float(design.high.max()) for design in designs.values()))

    def depth(values: numpy.ndarray) -> str:
        return reading.with_unit(_DEPTH, float(values[-1]))

    label = "; ".join(
        f"{name}: {depth(design.penetration)} after {design.cycles[-1]:g} million cycles, "
        f"{depth(design.low)} to {depth(design.high)}"
        for name, design in designs.items()
    )
    up = f"penetration{unit.text_in_brackets}"
    drawn = chart(f"penetration: {label}", "million cycles", up, curves, (end, highest))
    return f"{drawn}<p class='legend'>{legend(lines)}</p>"


def depth_maps(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> str:
    """Draw the worn depth of each bore in one colour scale."""
    highest = max(float(design.depth.max()) for design in designs.values()) or 1.0
    return "".join(
        f"<figure><figcaption>{escape(name)}</figcaption>"
        f"{_depth_map(f'wear{number}', name, design, highest, reading)}</figure>"
        for number, (name, design) in enumerate(designs.items())
    )


def _depth_map(element: str, name: str, worn: WearResult, highest: float, reading: Reading) -> str:
    unit = reading.unit(_DEPTH)
    label = f"worn depth of {name} seen from its opening, up to {reading.with_unit(_DEPTH, float(worn.depth.max()))}"
    field = BoreField(
        name=element,
        at=grid_field(worn.grid, unit.factor * worn.depth),
        highest=unit.factor * highest,
        label=f"worn depth{unit.text_in_brackets}",
        reach=worn.grid.reach,
        cup=worn.cup,
    )
    return worn_bore(field, label, worn.load)
