"""The sections of a page of evidence that hold its numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from itertools import starmap
from typing import Any

from ..evidence.folder import RECORD
from ..evidence.matrix import KEYS, NAMES, limit_text, number, title_of
from ..evidence.requirements import MET, NOT_MET, UNKNOWN
from . import evidence_figures as figures
from . import html
from .evidence_words import (
    Record,
    call,
    case_text,
    error_text,
    head,
    listed,
    percent,
    unloaded,
    value_text,
    words,
)


def _worn_at_the_end(record: Record) -> list[tuple[str, str, str]]:
    """Wear after all cycles where it is worst, with its band."""
    found = record["wear"]
    if found is None:
        return []
    last, bands = found["history"][-1], found.get("bands", ())
    band = f" ({_ends(bands[-1]['volume'])} in 95 of 100 patients)" if bands else ""
    where = case_text(unloaded(record["worst"]["wear_rate"]["case"]))
    return [(f"worn volume after {number(last['cycles'])} cycles", f"{number(last['volume'])} mm³{band}", where)]


_OPEN = 200
"""Cases up to which all of them are shown at once."""


def _joint_caption(record: Record) -> str:
    aside = "" if record["drawn"]["half_angle_deg"] is not None else " Its contact lies off the axis and is not drawn."
    return f"The joint where the pressure is worst.{aside}"


_MAPPED = ("max_pressure", "edge_distance", "wear_rate")


def matrix_section(record: Record) -> str:
    """Limits and worst cases, the joint, the maps, every case."""
    rows = record["matrix"]
    limits = [
        (limit_text(each), each["verdict"], str(each["beyond"]), str(each["unknown"]), str(each["near"]))
        for each in record["limits"]
    ]
    heads = ("limit", "verdict", "cases beyond", "without an answer", "nearer than the accuracy")
    worst = [(title_of(name), value_text(name, row), case_text(row["case"])) for name, row in record["worst"].items()]
    worst += _worn_at_the_end(record)
    told = f"<p>{len(rows)} cases by the model {escape(record['model']['name'])}.</p>"
    judged = html.table(heads, limits) if limits else ""
    drawn = _maps(record) if record["drawn"] is not None else ""
    return (
        told + judged + words(("worst", "value", "case"), worst) + drawn + _cases(rows) + call(record["model"]["call"])
    )


def _maps(record: Record) -> str:
    """The joint where it is pressed hardest, and the numbers over the matrix."""
    section = html.vector(figures.joint_figure(record), "section", _joint_caption(record))
    names = [name for name in _MAPPED if name in record["worst"]] if len(record["matrix"]) > 1 else []
    return section + "".join(
        html.vector(figures.matrix_figure(record, name), NAMES[name].title, _mapped(record, name)) for name in names
    )


def _mapped(record: Record, name: str) -> str:
    limited = any(each["name"] == name for each in record["limits"])
    crossed = " Marked ×: the limit is not kept." if limited else ""
    return escape(f"{_capital(NAMES[name].title)} over the matrix; framed where it is worst.{crossed}")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _cases(rows: Sequence[Record]) -> str:
    """Every case, folded away."""
    inputs, answers = list(rows[0]["case"]), list(rows[0]["numbers"])
    heads = [head(key) for key in (*inputs, *answers)] + ["valid"]
    body = [
        [number(row["case"][key]) for key in inputs]
        + [number(row["numbers"][key]) for key in answers]
        + ["yes" if row["valid"] else row["status"].lower().replace("_", " ")]
        for row in rows
    ]
    state = " open" if len(rows) <= _OPEN else ""
    return f"<details{state}><summary>all {len(rows)} cases</summary>{html.table(heads, body)}</details>"


def calculation_section(record: Record) -> str:
    """Every worst case by every method."""
    told = "".join(_methods(each) for each in record["calculation"])
    if not any(each["deviation"] for each in record["calculation"]):
        return told or "<p>No case has an answer.</p>"
    caption = "Every other method against the one that answers, at the worst cases."
    return html.vector(figures.methods_figure(record), "methods", caption) + told


def _methods(piece: Record) -> str:
    keys = list(piece["methods"][0]["numbers"])
    rows = [
        [method["name"]] + [_with_bar(method, key) for key in keys] + ["yes" if method["valid"] else "no"]
        for method in piece["methods"]
    ]
    apart = [percent(piece["deviation"][key]) if key in piece["deviation"] else "" for key in keys]
    rows.append(["largest deviation", *apart, ""])
    names = ", ".join(NAMES[name].title for name in piece["worst_of"])
    heads = ["method", *map(head, keys), "valid"]
    notes = _grouped_notes(piece["methods"])
    return f"<h3>Where {escape(names)} is worst</h3>{html.table(heads, rows)}{listed(notes)}{call(piece['call'])}"


def _grouped_notes(methods: Iterable[Record]) -> list[str]:
    """List each note once, after the names of its methods."""
    holders: dict[str, list[str]] = {}
    for method in methods:
        for note in method["notes"]:
            holders.setdefault(note, []).append(method["name"])
    return [f"{', '.join(names)}: {note}" for note, names in holders.items()]


def _with_bar(method: Record, key: str) -> str:
    if key not in method["numbers"]:
        return ""
    return number(method["numbers"][key]) + error_text(method["errors"].get(key))


def validation_section(record: Record) -> str:
    """What others found, beside ours, and whether it speaks of this question."""
    claims = [
        (each["sentence"], each["where"], each["text"], _ours(each["numbers"]), each["applicability"]["text"])
        for each in record["claims"]
    ]
    told = words(("published", "where", "verdict", "ours", "to this question"), claims)
    return told + "".join(map(_comparator, record["comparators"]))


def _ours(numbers: Mapping[str, Any]) -> str:
    return "; ".join(starmap(_named, numbers.items()))


def _named(name: str, value: Any) -> str:
    """A number behind its name, which ends in its unit."""
    said, _, unit = name.rpartition(", ")
    return f"{said or unit}: {number(value)} {unit if said else ''}".strip()


def _comparator(each: Record) -> str:
    said = [("published input", name, text) for name, text in each["inputs"].items()]
    said += [("assumed", name, text) for name, text in each["assumed"].items()]
    said += [("published", name, text) for name, text in each["published"].items()]
    said += [("ours", name, f"{number(low)} to {number(high)}") for name, (low, high) in each["ours"].items()]
    told = (
        f"<p>{escape(each['agreement'])}</p><p>To this question it {escape(each['applicability']['text'])}.</p>"
        f"<p><small>{escape(each['kind'])}; {escape(each['source'])} (read: {escape(each['read'])})</small></p>"
    )
    return f"<h3>{escape(each['title'])}</h3>{words(('', '', ''), said)}{told}{call(each['call'])}"


def uncertainty_section(record: Record) -> str:
    """What the tolerances leave, and which of them matter."""
    found = record["uncertainty"]
    if found is None:
        return "<p>No tolerances were given: nothing was propagated.</p>"
    bands = [
        (head(key), number(band["low"]), number(band["median"]), number(band["high"]))
        for key, band in found["bands"].items()
    ]
    names, indices = next(iter(found["sobol"].values())), found["sobol"].values()
    shares = [(title_of(name), *(percent(each[name]) for each in indices)) for name in names]
    aligned = " The load is taken along the axis." if found["aligned"] else ""
    told = f"{found['samples']} samples by {escape(found['model'])}, seed {found['seed']}, about the worst case."
    heads = ("tolerance", *(f"share in the variance of the {KEYS[key].title}" for key in found["sobol"]))
    tables = html.table(("", "2.5 %", "median", "97.5 %"), bands) + html.table(heads, shares)
    drawn = html.vector(figures.bands_figure(record), "bands", "What the tolerances leave, and which of them matter.")
    return f"<p>{told}{aligned}</p>{listed(found['notes'])}{drawn}{tables}{call(found['call'])}"


def wear_section(record: Record) -> str:
    """What becomes of the joint that wears most."""
    found = record["wear"]
    if found is None and "wear_rate" in record["matrix"][0]["numbers"]:
        return "<p>None of these joints can go through the cycle: pressed together, or pushed over the rim.</p>"
    if found is None:
        return "<p>No cycle was given: wear is not part of this evidence.</p>"
    names = ("cycles", "volume", "depth", "penetration", "max_pressure")
    heads = ("cycles", "volume [mm³]", "depth [mm]", "penetration [mm]", "pmax [MPa]")
    rows = [[number(row[name]) for name in names] for row in found["history"]]
    told = (
        f"<p>What {escape(found['file'])} goes through, with its cup, law and cycle, by the joint of the matrix that "
        f"wears most: {escape(case_text(unloaded(record['worst']['wear_rate']['case'])))}.</p>"
    )
    drawn = html.vector(figures.wear_figure(record), "wear", "Worn volume over the cycles.")
    tables = html.table(heads, rows) + _bands(found)
    return told + drawn + tables + listed(found.get("notes", ())) + call(found["call"])


def _bands(found: Record) -> str:
    """What patients differ by, where the hip's file says so."""
    bands = found.get("bands", ())
    names = {"volume": "volume [mm³]", "depth": "depth [mm]", "penetration": "penetration [mm]"}
    rows = [[number(band["cycles"]), *(_ends(band[name]) for name in names)] for band in bands]
    return html.table(("cycles, band of 95 %", *names.values()), rows) if rows else ""


def _ends(band: Record) -> str:
    return f"{number(band['low'])} to {number(band['high'])}"


def credibility_section(record: Record) -> str:
    """Return the factors with required level, reached level and gradations."""
    rows = [
        (
            each["activity"],
            each["factor"],
            each["goal"],
            each["reached"],
            "met" if each["adequate"] else "NOT met",
            each["supported_by"],
            each["missing"],
        )
        for each in record["credibility"]
    ]
    heads = ("activity", "factor", "goal", "reached", "", "supported by", "missing")
    told = (
        f"<p>{escape(record['adequacy']['text'])}. Goals follow from the model risk. The standard leaves gradations "
        "and goals to the user; these are a proposal of the software.</p>"
    )
    levels = [
        (each["factor"], letter, text) for each in record["credibility"] for letter, text in each["gradation"].items()
    ]
    gradations = words(("factor", "level", "activities"), levels)
    return f"{told}{words(heads, rows)}<details><summary>the gradations</summary>{gradations}</details>"


def requirements_section(record: Record) -> str:
    """Return the matrix of requirements, with gaps first."""
    rows = sorted(record["requirements"], key=lambda row: _ORDER.index(row["status"]))
    table = [(row["id"], row["requirement"], row["status"], row["evidence"], row["gap"], row["where"]) for row in rows]
    gaps = sum(row["status"] != _ORDER[-1] for row in rows)
    told = f"<p>{gaps} of {len(rows)} requirements are not met or not known; they are listed first.</p>"
    return told + words(("", "requirement", "status", "evidence", "gap", f"in {RECORD}"), table)


_ORDER = (NOT_MET, UNKNOWN, MET)
