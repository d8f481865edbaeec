"""Designs after millions of cycles, as HTML: numbers beside each other, penetration with its band, maps of depth."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from math import nan

import numpy

from ..compare import relative_deviation
from ..core.quantities import CONTACT, DERIVED
from ..reports.pages import table
from ..reports.style import BLUE, VERMILLION, LineStyle
from .bore_map import SHOWN, BoreField, cells_of, worn_bore
from .chart import Curve, chart, legend
from .pressing import rounded_up
from .reading import Reading
from .wearing import Worn
from .words import doubt, notes_list, number_text, percent

_DEPTH, _PRESSURE = CONTACT["indentation"], CONTACT["max_pressure"]
"""As what depths and pressures are read."""

_LINES = (LineStyle(BLUE), LineStyle(VERMILLION, (6.0, 2.0)))


def wear_numbers(found: Mapping[str, Worn], reading: Reading = SHOWN) -> str:
    """A table of what is worn at the end: a column for each design, the second with its difference from the first."""
    first, *others = found.values()
    rows = []
    for name, values in _told(first, reading).items():
        beside = [_told(other, reading)[name] for other in others]
        rows.append([name, number_text(values), *(f"{number_text(each)} ({_apart(each, values)})" for each in beside)])
    notes = "".join(
        f"{doubt(each.summary['contact']['valid'], name)}"
        f"<p class='quiet'>{escape(name)}: {escape(each.band)}</p>{notes_list(each.notes)}"
        for name, each in found.items()
    )
    return f"{table(['after the last cycle', *found], rows)}{notes}"


def _apart(value: float, base: float) -> str:
    return percent(float(relative_deviation(value, base)), "+") if base else "–"


def _told(worn: Worn, reading: Reading) -> dict[str, float]:
    last = worn.summary["history"][-1]
    edge = float("nan") if last["edge_distance"] is None else last["edge_distance"]
    new = worn.summary["cycle"]["peaks"]["max_pressure_MPa"]
    found = {
        "deepest wear": (_DEPTH, float(worn.deepest[-1])),
        "penetration": (_DEPTH, float(worn.penetration[-1])),
        "of it by creep alone": (_DEPTH, last["penetration_of_creep"]),
        "largest pressure, new": (_PRESSURE, new),
        "largest pressure, worn": (_PRESSURE, last["max_pressure"]),
        "nearest to the rim, worn": (DERIVED["edge_distance"], edge),
    }
    units = {name: reading.unit(quantity) for name, (quantity, _) in found.items()}
    numbers = {
        f"{name}{units[name].text_in_brackets}": value * units[name].factor for name, (_, value) in found.items()
    }
    new_and_worn = worn.summary["contact"]["unworn"], last["contact"]
    used = [[check["utilisation"] for check in checks if check["utilisation"] is not None] for checks in new_and_worn]
    shares = {
        f"utilisation σv/σy, {state}": max(part, default=nan) for state, part in zip(("new", "worn"), used, strict=True)
    }
    return {"worn volume [mm³]": float(worn.volume[-1]), **numbers, **shares}


def penetration_chart(found: Mapping[str, Worn], reading: Reading = SHOWN) -> str:
    """How far the ball has sunk in over the cycles, of each design with its band."""
    lines = dict(zip(found, _LINES, strict=False))
    unit = reading.unit(_DEPTH)
    curves = {
        name: Curve(
            each.cycles,
            unit.factor * each.penetration,
            numpy.full(each.cycles.shape, True),
            lines[name],
            band=(unit.factor * each.low, unit.factor * each.high),
        )
        for name, each in found.items()
    }
    end = max(float(each.cycles[-1]) for each in found.values())
    highest = rounded_up(unit.factor * max(float(each.high.max()) for each in found.values()))
    said = "; ".join(
        f"{name}: {reading.said(_DEPTH, float(each.penetration[-1]))} after {each.cycles[-1]:g} million cycles, "
        f"{reading.said(_DEPTH, float(each.low[-1]))} to {reading.said(_DEPTH, float(each.high[-1]))}"
        for name, each in found.items()
    )
    up = f"penetration{unit.text_in_brackets}"
    drawn = chart(f"penetration: {said}", "million cycles", up, curves, (end, highest))
    return f"{drawn}<p class='legend'>{legend(lines)}</p>"


def depth_maps(found: Mapping[str, Worn], reading: Reading = SHOWN) -> str:
    """What is worn away of each bore, in one scale of colours."""
    highest = max(float(each.depth.max()) for each in found.values()) or 1.0
    return "".join(
        f"<figure><figcaption>{escape(name)}</figcaption>{_map(f'wear{number}', name, each, highest, reading)}</figure>"
        for number, (name, each) in enumerate(found.items())
    )


def _map(place: str, name: str, worn: Worn, highest: float, reading: Reading) -> str:
    unit = reading.unit(_DEPTH)
    said = f"worn depth of {name} seen from its opening, up to {reading.said(_DEPTH, float(worn.depth.max()))}"
    field = BoreField(
        name=place,
        at=cells_of(worn.grid, unit.factor * worn.depth),
        highest=unit.factor * highest,
        label=f"worn depth{unit.text_in_brackets}",
        reach=worn.grid.reach,
        cup=worn.cup,
    )
    return worn_bore(field, said, worn.load)
