"""Designs after millions of cycles, as HTML: numbers beside each other, penetration with its band, maps of depth."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from ..compare import relative
from ..output.html import table
from ..output.style import BLUE, VERMILLION, Line
from .bore_map import worn_bore
from .chart import Curve, chart, legend
from .pressing import rounded_up
from .wearing import Worn
from .words import notes_list, number_text, percent

_LINES = (Line(BLUE), Line(VERMILLION, (6.0, 2.0)))


def wear_numbers(found: Mapping[str, Worn]) -> str:
    """A table of what is worn at the end: a column for each design, the second with its difference from the first."""
    first, *others = found.values()
    rows = []
    for name, values in _told(first).items():
        beside = [_told(other)[name] for other in others]
        rows.append([name, number_text(values), *(f"{number_text(each)} ({_apart(each, values)})" for each in beside)])
    notes = "".join(
        f"<p class='quiet'>{escape(name)}: {escape(each.band)}</p>{notes_list(each.notes)}"
        for name, each in found.items()
    )
    return f"{table(['after the last cycle', *found], rows)}{notes}"


def _apart(value: float, base: float) -> str:
    return percent(float(relative(value, base)), "+") if base else "–"


def _told(worn: Worn) -> dict[str, float]:
    last = worn.summary["history"][-1]
    edge = last["edge_distance"]
    return {
        "worn volume [mm³]": float(worn.volume[-1]),
        "deepest wear [µm]": 1e3 * float(worn.deepest[-1]),
        "penetration [µm]": 1e3 * float(worn.penetration[-1]),
        "of it by creep alone [µm]": 1e3 * float(last["penetration_of_creep"]),
        "largest pressure, new [MPa]": worn.summary["cycle"]["peaks"]["max_pressure_MPa"],
        "largest pressure, worn [MPa]": last["max_pressure"],
        "nearest to the rim, worn [mm]": float("nan") if edge is None else edge,
    }


def penetration_chart(found: Mapping[str, Worn]) -> str:
    """How far the ball has sunk in over the cycles, of each design with its band."""
    lines = dict(zip(found, _LINES, strict=False))
    curves = {
        name: Curve(
            each.cycles,
            1e3 * each.penetration,
            each.cycles == each.cycles,
            lines[name],
            band=(1e3 * each.low, 1e3 * each.high),
        )
        for name, each in found.items()
    }
    ends = max(float(each.cycles[-1]) for each in found.values()), 1e3 * max(each.high.max() for each in found.values())
    said = "; ".join(
        f"{name}: {1e3 * each.penetration[-1]:.3g} µm after {each.cycles[-1]:g} million cycles, "
        f"{1e3 * each.low[-1]:.3g} to {1e3 * each.high[-1]:.3g}"
        for name, each in found.items()
    )
    drawn = chart(f"penetration: {said}", "million cycles", "penetration [µm]", curves, (ends[0], rounded_up(ends[1])))
    return f"{drawn}<p class='legend'>{legend(lines)}</p>"


def depth_maps(found: Mapping[str, Worn]) -> str:
    """What is worn away of each bore, in one scale of colours."""
    highest = max(float(each.depth.max()) for each in found.values()) or 1.0
    return "".join(
        f"<figure><figcaption>{escape(name)}</figcaption>{_map(f'wear{number}', name, each, highest)}</figure>"
        for number, (name, each) in enumerate(found.items())
    )


def _map(place: str, name: str, worn: Worn, highest: float) -> str:
    said = f"worn depth of {name} seen from its opening, up to {float(worn.depth.max()):.3g} µm"
    return worn_bore(place, said, worn.grid, worn.depth, highest, worn.cup, worn.load)
