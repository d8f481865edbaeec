"""Page of an evidence pack, from its record alone, in the order in which a reviewer reads; for A4 and Letter."""

from __future__ import annotations

from itertools import starmap
from types import MappingProxyType
from typing import Any

from ..core.display import counted
from ..core.unit_systems import Sentence, Units, from_json, holders_of
from ..evidence.credibility import MET, NOT_MET, UNKNOWN
from ..evidence.folder import RECORD
from ..evidence.matrix import KEYS, NAMES, input_title, limit_text, number, title_of, verdict_text
from ..studies.metadata import held_text
from . import evidence_parts as figures
from .evidence_parts import (
    Record,
    band_text,
    bare_number,
    case_text,
    column_head,
    error_text,
    named_number,
    percent,
    quantities_of_interest,
    recentred_text,
    unloaded,
    value_text,
)
from .figure_files import default_style
from .pages import data_address, render_page, svg_address
from .style import in_units

_SECTIONS = MappingProxyType(
    {
        "question": "Question and context of use",
        "risk": "Model risk and required accuracy",
        "inputs": "Inputs",
        "matrix": "Worst-case matrix",
        "code": "Code verification",
        "calculation": "Calculation verification",
        "validation": "Comparison with published computations",
        "uncertainty": "Sensitivity and uncertainty",
        "wear": "Wear",
        "limits": "Limits and assumptions",
        "credibility": "Credibility factors (ASME V&V 40)",
        "requirements": "Requirements and evidence",
        "signed": "Signatures",
    }
)
"""Titles of the sections by their ids, which are blocks of the template."""

_CHECK_RESULTS = {True: "passed", False: "FAILED", None: "not run"}
_STATUS_ORDER = (NOT_MET, UNKNOWN, MET)
_MAPPED = ("max_pressure", "edge_distance", "wear_rate")  # results that are drawn over the matrix

Rows = list[tuple[str, ...]]


def evidence_page(record: Record, digest: str = "", units: Units = Units.SI) -> str:
    """Return the page of a pack as HTML, from the record of `evidence.pack.gather_evidence`.

    The digest of the pack, see `evidence.folder.digest`, is omitted if it is empty. Published numbers, and
    requirements, whose texts are those of the record, keep their units.
    """
    with default_style():
        context = {
            **_inputs(record, units),
            **_matrix(record, units),
            **_verification(record, units),
            **_validation(record),
            **_credibility(record),
            "uncertainty": _uncertainty(record, units),
            "wear": _wear(record, units),
        }
    sections = {name: (title, None) for name, title in _SECTIONS.items()}
    context["conclusions"] = conclusions(record, units)
    return render_page("evidence.html", "Evidence", sections, record=record, digest=digest, **context)


def conclusions(record: Record, units: Units = Units.SI) -> list[str]:
    """Return the conclusions in sentences: verdict on each limit, accuracy, adequacy, changed nominal values."""
    limits = [f"{limit_text(limit, units)}: {verdict_text(limit)}" for limit in record["limits"]]
    accurate = record["accurate"]
    largest = "unknown" if accurate["largest"] is None else percent(accurate["largest"])
    within = "within" if accurate["holds"] else "NOT within"
    accuracy = (
        f"Error bars and other methods: {largest} at most, {within} the required {percent(accurate['required'])}."
    )
    recentred = [recentred_text(change, units) for change in record["recentred"]]
    return [*(limits or ["no limit is stated"]), accuracy, f"{record['adequacy']['text']}.", *recentred]


def _inputs(record: Record, units: Units) -> dict[str, Any]:
    risk = record["risk"]
    return {
        "risk": [
            ("influence of the model on the decision", risk["influence"]),
            ("consequence of a wrong decision", risk["consequence"]),
            ("model risk", f"{risk['level']} ({risk['rank']} of 5): it sets the goals of the credibility factors"),
            ("required accuracy", percent(record["required"]["accuracy"])),
            ("quantities of interest", ", ".join(map(title_of, quantities_of_interest(record)))),
            *(("limit", limit_text(limit, units)) for limit in record["limits"]),
        ],
        "inputs": [_input_cells(row, units) for row in record["inputs"]],
        "recentred": [recentred_text(change, units) for change in record["recentred"]],
    }


def _input_cells(row: Record, units: Units) -> tuple[str, ...]:
    unit, (value, tolerance) = units.of_text(row["unit"]), (row["value"], row["tolerance"])
    value = value if isinstance(value, str) else unit.factor * value
    ends = [tolerance] if isinstance(tolerance, str) else [number(unit.factor * end) for end in tolerance]
    return input_title(row["name"]), number(value), unit.text, " to ".join(ends), row["source"] or "none"


def _matrix(record: Record, units: Units) -> dict[str, Any]:
    worst = [
        (title_of(name), value_text(name, row, units), case_text(row["case"], units))
        for name, row in record["worst"].items()
    ]
    return {
        "held": units.sentence(held_text(record["held"])),
        "limits": [
            (limit_text(limit, units), verdict_text(limit), *(str(limit[key]) for key in ("beyond", "unknown", "near")))
            for limit in record["limits"]
        ],
        "worst": [*worst, *_final_wear(record, units)],
        "matrix_figures": [] if record["drawn"] is None else _pictures(record, units),
        "cases": _cases(record["matrix"], units),
    }


def _final_wear(record: Record, units: Units) -> Rows:
    """Return the row of the wear after all cycles where it is worst, with its band; no row without wear."""
    wear = record["wear"]
    if wear is None:
        return []
    last, bands, unit = wear["history"][-1], wear.get("bands", ()), units.of_text("mm³")
    band = f" ({band_text(bands[-1]['volume'], unit.factor)} in 95 of 100 patients)" if bands else ""
    case = case_text(unloaded(record["worst"]["wear_rate"]["case"]), units)
    volume = f"{number(last['volume'] * unit.factor)} {unit.text}{band}"
    return [(f"worn volume after {counted(last['cycles'], 'cycle')}", volume, case)]


def _pictures(record: Record, units: Units) -> list[dict[str, str]]:
    """Return pictures of the joint with the largest pressure, and of each mapped result over the matrix."""
    half_angle, aside = record["drawn"]["half_angle_deg"], "Its contact lies off the axis and is not drawn."
    if half_angle is not None:
        aside = f"A dashed line marks the edge of its contact, to {half_angle:.3g}°."
    caption = f"The joint with the largest pressure. {aside}"
    pictures = [
        {
            "address": data_address(figures.joint_drawing(record, units), "svg+xml"),
            "title": "section",
            "caption": caption,
        }
    ]
    names = [name for name in _MAPPED if name in record["worst"]] if len(record["matrix"]) > 1 else []
    limited = {limit["name"] for limit in record["limits"]}
    for name in names:
        title, crosses = NAMES[name].title, " × marks cases that break the limit." if name in limited else ""
        caption = f"{title[:1].upper()}{title[1:]} over the matrix; a frame marks the worst case.{crosses}"
        address = svg_address(figures.matrix_figure(record, name, units))
        pictures.append({"address": address, "title": title, "caption": caption})
    return pictures


def _cases(rows: list[Record], units: Units) -> dict[str, Any]:
    inputs, results = list(rows[0]["case"]), list(rows[0]["numbers"])
    return {
        "heads": [*(column_head(key, units) for key in (*inputs, *results)), "valid"],
        "rows": [
            (
                *(bare_number(key, row["case"][key], units) for key in inputs),
                *(bare_number(key, row["numbers"][key], units) for key in results),
                "yes" if row["valid"] else row["status"].lower().replace("_", " "),
            )
            for row in rows
        ],
    }


def _verification(record: Record, units: Units) -> dict[str, Any]:
    deviating = any(piece["deviation"] for piece in record["calculation"])
    return {
        "checks": [
            (
                check["what"],
                number(check["observed"]),
                f"at least {check['low']:g}" if check["high"] is None else f"at most {check['high']:g}",
                _CHECK_RESULTS[check["passed"]] + (f": {check['why']}" if check["why"] else ""),
            )
            for check in record["code_verification"]
        ],
        "calculations": [_methods(piece, units) for piece in record["calculation"]],
        "methods_figure": svg_address(figures.methods_figure(record)) if deviating else None,
    }


def _methods(piece: Record, units: Units) -> dict[str, Any]:
    """Return one worst case by every method, and the largest deviation of each result."""
    keys = list(piece["methods"][0]["numbers"])
    holders = holders_of((method["name"], map(from_json, method["notes"])) for method in piece["methods"])
    rows: Rows = [
        (method["name"], *(_with_error(method, key, units) for key in keys), "yes" if method["valid"] else "no")
        for method in piece["methods"]
    ]
    deviations = (percent(piece["deviation"][key]) if key in piece["deviation"] else "" for key in keys)
    return {
        "title": ", ".join(NAMES[name].title for name in piece["worst_of"]),
        "heads": ["method", *(column_head(key, units) for key in keys), "valid"],
        "rows": [*rows, ("largest deviation", *deviations, "")],
        "notes": [units.sentence(Sentence("{}: {}", ", ".join(names), note)) for note, names in holders.items()],
        "call": piece["call"],
    }


def _with_error(method: Record, key: str, units: Units) -> str:
    """Write a result of a method with its error bar; empty if the method does not have it."""
    if key not in method["numbers"]:
        return ""
    return bare_number(key, method["numbers"][key], units) + error_text(method["errors"].get(key))


def _notes(piece: Record, units: Units) -> list[str]:
    return [units.sentence(from_json(note)) for note in piece["notes"]]


def _validation(record: Record) -> dict[str, Any]:
    return {
        "claims": [
            (
                claim["sentence"],
                claim["where"],
                claim["text"],
                "; ".join(starmap(named_number, claim["numbers"].items())),
                claim["applicability"]["text"],
            )
            for claim in record["claims"]
        ],
        "comparators": [
            {**comparator, "applicability": comparator["applicability"]["text"], "rows": _comparator_rows(comparator)}
            for comparator in record["comparators"]
        ],
    }


def _comparator_rows(comparator: Record) -> Rows:
    """Return inputs, assumptions and published results of a comparator, and the range of ballsocket's."""
    texts = {"inputs": "published input", "assumed": "assumed", "published": "published"}
    rows: Rows = [(kind, name, text) for key, kind in texts.items() for name, text in comparator[key].items()]
    ranges = comparator["ours"].items()
    return [*rows, *(("ours", name, f"{number(low)} to {number(high)}") for name, (low, high) in ranges)]


def _uncertainty(record: Record, units: Units) -> dict[str, Any] | None:
    """Return bands and Sobol indices of the tolerances; None without tolerances."""
    uncertainty = record["uncertainty"]
    if uncertainty is None:
        return None
    names, indices = next(iter(uncertainty["sobol"].values())), uncertainty["sobol"].values()
    return {
        **uncertainty,
        "notes": _notes(uncertainty, units),
        "figure": svg_address(in_units(figures.bands_figure(record), units)),
        "bands": [
            (column_head(key, units), *(bare_number(key, band[end], units) for end in ("low", "median", "high")))
            for key, band in uncertainty["bands"].items()
        ],
        "heads": ["tolerance", *(f"share in the variance of the {KEYS[key].title}" for key in uncertainty["sobol"])],
        "shares": [(title_of(name), *(percent(share[name]) for share in indices)) for name in names],
    }


def _wear(record: Record, units: Units) -> dict[str, Any] | None:
    """Return the history of the joint that wears most; None without wear."""
    wear = record["wear"]
    if wear is None:
        return None
    written = [units.of_text(text) for text in ("", "mm³", "mm", "mm", "MPa")]
    names = ("cycles", "volume", "depth", "penetration", "max_pressure")
    heads = ("cycles", "volume", "depth", "penetration", "pmax")
    columns = list(zip(names, written, strict=True))
    return {
        "heads": [head + unit.text_in_brackets for head, unit in zip(heads, written, strict=True)],
        "file": wear["file"],
        "case": case_text(unloaded(record["worst"]["wear_rate"]["case"]), units),
        "figure": svg_address(in_units(figures.wear_figure(record), units)),
        "history": [tuple(number(row[name] * unit.factor) for name, unit in columns) for row in wear["history"]],
        "bands": [
            (number(band["cycles"]), *(band_text(band[name], unit.factor) for name, unit in columns[1:4]))
            for band in wear.get("bands", ())
        ],
        "notes": _notes(wear, units),
        "call": wear["call"],
    }


def _credibility(record: Record) -> dict[str, Any]:
    """Return the credibility factors with their gradations, and the requirements with gaps first."""
    requirements = sorted(record["requirements"], key=lambda row: _STATUS_ORDER.index(row["status"]))
    factors = record["credibility"]
    return {
        "factors": [
            (
                *(factor[key] for key in ("activity", "factor", "goal", "reached")),
                "met" if factor["adequate"] else "NOT met",
                factor["supported_by"],
                factor["missing"],
            )
            for factor in factors
        ],
        "gradations": [
            (factor["factor"], letter, text) for factor in factors for letter, text in factor["gradation"].items()
        ],
        "requirements": [
            tuple(row[key] for key in ("id", "requirement", "status", "evidence", "gap", "where"))
            for row in requirements
        ],
        "gaps": sum(row["status"] != MET for row in requirements),
        "record_name": RECORD,
    }
