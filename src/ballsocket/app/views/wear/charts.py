"""HTML of wear: table of numbers, penetration over the cycles and maps of depth."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from math import nan

import numpy

from ....comparison import relative_deviation
from ....core.quantities import CONTACT, DERIVED
from ....reports.pages import table
from ....reports.style import BLUE, VERMILLION, LineStyle
from ...pictures.bore import CELLS_EDGE, METRIC, BoreField, grid_field, load_bore
from ...pictures.chart import Curve, chart, legend
from ...pressing import rounded_up
from ...widgets.reading import Reading
from ...widgets.words import checked, doubt, notes_list, number_text, percent
from .worker import WearResult

_DEPTH, _PRESSURE = CONTACT["indentation"], CONTACT["max_pressure"]  # quantities whose units depths and pressures have
_DESIGN_LINES = (LineStyle(BLUE), LineStyle(VERMILLION, (6.0, 2.0)))


def wear_numbers(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> str:
    """Tabulate the final wear of each design, with the difference from the first."""
    columns = [_final_values(design, reading) for design in designs.values()]
    rows = []
    for name, base in columns[0].items():
        others = [column[name] for column in columns[1:]]
        apart = [f" ({percent(float(relative_deviation(value, base)), '+')})" if base else "" for value in others]
        cells = [number_text(value) + share for value, share in zip(others, apart, strict=True)]
        rows.append([name, number_text(base), *cells])
    used = "".join(
        f"<h3>{escape(name)} after the last cycle</h3>{checked(entry.checks, reading)}"
        for name, entry in designs.items()
    )
    notes = "".join(
        f"{doubt(entry.summary['contact']['valid'], name)}"
        f"<p class='quiet'>{escape(name)}: {escape(entry.band)}</p>{notes_list(entry.notes)}"
        for name, entry in designs.items()
    )
    return f"{table(['after the last cycle', *designs], rows)}{used}{notes}"


def _final_values(worn: WearResult, reading: Reading) -> dict[str, float]:
    last = worn.summary["history"][-1]
    edge = float("nan") if last["edge_distance"] is None else last["edge_distance"]
    new = worn.summary["cycle"]["peaks"]["max_pressure_MPa"]
    quantities = {
        "deepest wear": (_DEPTH, float(worn.deepest[-1])),
        "penetration": (_DEPTH, float(worn.penetration[-1])),
        "penetration by creep alone": (_DEPTH, last["penetration_of_creep"]),
        "largest pressure, new": (_PRESSURE, new),
        "largest pressure, worn": (_PRESSURE, last["max_pressure"]),
        "smallest distance to the rim, worn": (DERIVED["edge_distance"], edge),
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


def empty_chart(millions: float, reading: Reading) -> str:
    """Draw the axes of the penetration over the cycles, for a design without a result."""
    unit = reading.unit(_DEPTH)
    up = f"penetration{unit.text_in_brackets}"
    return chart(
        "penetration over the cycles, not computed yet", "million cycles", up, {}, (millions, 0.1 * unit.factor)
    )


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
        least=CELLS_EDGE,
    )
    return load_bore(field, label, worn.load)
