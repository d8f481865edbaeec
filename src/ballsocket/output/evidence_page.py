"""A pack of evidence as one page, in the order in which a reviewer reads; it prints on A4 and Letter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import date
from html import escape
from typing import Any

from ..evidence.matrix import NAMES
from ..quantities import QUANTITIES, Quantity
from ..studies.parameters import PARAMETERS
from . import html

Record = Mapping[str, Any]

_KEYS: Mapping[str, Quantity] = {
    each.key: each for each in (*QUANTITIES.values(), *PARAMETERS.values(), *NAMES.values())
}
_SAID = {True: "passed", False: "FAILED", None: "not run"}
_LIMITS = (
    "Materials are linear elastic: where von Mises stress passes the yield stress, the numbers end (see utilisation).",
    "Contact is without friction as far as pressures go; torques are Coulomb's on these pressures.",
    "Bodies are those that the notes name: a whole shell behind the liner for the exact answer, the cup with its rim "
    "off the axis and in finite elements.",
    "Loads do not change in time; what wear says is in its own section.",
)
_FINE = 1e-5
_STYLE = """<style>@media print { .sign td { height: 2.5rem; } }
.sign td { min-width: 14rem; }
.words td, .words th { text-align: left; vertical-align: top; }
.call { font-family: monospace; font-size: 0.8rem; color: #555; }</style>"""


def evidence_page(record: Record, day: date | None = None) -> str:
    """The page of a pack; see `evidence.pack.gathered`."""
    sections = {
        "question": ("Question and context of use", _question(record)),
        "risk": ("Model risk and required accuracy", _risk(record)),
        "inputs": ("Inputs", _inputs(record)),
        "matrix": ("Worst-case matrix", _matrix(record)),
        "code": ("Code verification", _code(record)),
        "calculation": ("Calculation verification", _calculation(record)),
        "validation": ("Validation", _validation(record)),
        "uncertainty": ("Sensitivity and uncertainty", _uncertainty(record)),
        "wear": ("Wear", _wear(record)),
        "limits": ("Limits and assumptions", _list(_LIMITS)),
        "credibility": ("Credibility factors (ASME V&V 40)", _credibility(record)),
        "signed": ("Signatures", _signed(record, day or date.today())),
    }
    lede = f"{html.PRINT}{_STYLE}<p>{escape(record['question'])}</p>{_list(conclusions(record))}"
    return html.page("Evidence", lede, sections)


def conclusions(record: Record) -> list[str]:
    """What it comes to, in sentences: how limits are kept, and whether the numbers are as exact as is required."""
    limits = [f"{each['limit']}: {each['verdict']}" for each in record["limits"]] or ["no limit was given"]
    accurate = record["accurate"]
    largest = "unknown" if accurate["largest"] is None else _percent(accurate["largest"])
    holds = "within" if accurate["holds"] else "NOT within"
    said = f"Error bars and other methods: {largest} at most, {holds} the required {_percent(accurate['required'])}."
    return [*limits, said]


def _question(record: Record) -> str:
    return f"<p>{escape(record['question'])}</p><p>{escape(record['context_of_use'])}</p>"


def _risk(record: Record) -> str:
    rows = [
        ("influence of the model on the decision", record["risk"]["influence"]),
        ("consequence of a wrong decision", record["risk"]["consequence"]),
        ("required accuracy", _percent(record["required"]["accuracy"])),
        *(("limit", text) for text in record["required"]["limits"]),
    ]
    return _words(("", ""), rows)


def _inputs(record: Record) -> str:
    rows = [
        (each["name"], _number(each["value"]), each["unit"], each["tolerance"], each["source"] or "none given")
        for each in record["inputs"]
    ]
    return _words(("input", "value", "unit", "tolerance", "source"), rows)


def _matrix(record: Record) -> str:
    rows = record["matrix"]
    limits = [
        (each["limit"], each["verdict"], str(each["beyond"]), str(each["unknown"]), str(each["near"]))
        for each in record["limits"]
    ]
    heads = ("limit", "verdict", "cases beyond", "without an answer", "nearer than the accuracy")
    worst = [(NAMES[name].title, _value(name, row), _case(row)) for name, row in record["worst"].items()]
    told = f"<p>{len(rows)} cases by the model {escape(record['model']['name'])}.</p>"
    call = _call(record["model"]["call"])
    judged = html.table(heads, limits) if limits else ""
    return told + judged + _words(("worst", "value", "case"), worst) + _cases(rows) + call


def _cases(rows: Sequence[Record]) -> str:
    """Every case, folded away."""
    inputs, answers = list(rows[0]["case"]), list(rows[0]["numbers"])
    heads = [_head(key) for key in (*inputs, *answers)] + ["valid"]
    body = [
        [_number(row["case"][key]) for key in inputs]
        + [_number(row["numbers"][key]) for key in answers]
        + ["yes" if row["valid"] else row["status"].lower().replace("_", " ")]
        for row in rows
    ]
    return f"<details><summary>all {len(rows)} cases</summary>{html.table(heads, body)}</details>"


def _code(record: Record) -> str:
    rows = [
        (each["what"], _number(each["observed"]), _allowed(each), _SAID[each["passed"]] + _why(each))
        for each in record["code_verification"]
    ]
    made = ", ".join(f"{name} {text}" for name, text in record["made_with"].items())
    told = f"<p>Run when this pack was made, by ballsocket {escape(record['version'])} ({escape(made)}).</p>"
    return told + html.table(("check", "observed", "allowed", ""), rows)


def _allowed(check: Record) -> str:
    return f"at least {check['low']:g}" if check["high"] is None else f"at most {check['high']:g}"


def _why(check: Record) -> str:
    return f": {check['why']}" if check["why"] else ""


def _calculation(record: Record) -> str:
    return "".join(_methods(each) for each in record["calculation"]) or "<p>No case has an answer.</p>"


def _methods(piece: Record) -> str:
    keys = list(piece["methods"][0]["numbers"])
    rows = [
        [method["name"]] + [_with_bar(method, key) for key in keys] + ["yes" if method["valid"] else "no"]
        for method in piece["methods"]
    ]
    apart = [_percent(piece["deviation"][key]) if key in piece["deviation"] else "" for key in keys]
    rows.append(["largest deviation", *apart, ""])
    names = ", ".join(NAMES[name].title for name in piece["worst_of"])
    notes = [f"{method['name']}: {note}" for method in piece["methods"] for note in method["notes"]]
    heads = ["method", *map(_head, keys), "valid"]
    return f"<h3>Where {escape(names)} is worst</h3>{html.table(heads, rows)}{_list(notes)}{_call(piece['call'])}"


def _with_bar(method: Record, key: str) -> str:
    if key not in method["numbers"]:
        return ""
    bar = method["errors"].get(key)
    return _number(method["numbers"][key]) + _bar(bar)


def _validation(record: Record) -> str:
    claims = [
        (each["sentence"], each["where"], each["text"], _ours(each["numbers"]), each["applicability"]["text"])
        for each in record["claims"]
    ]
    told = _words(("published", "where", "verdict", "ours", "to this question"), claims)
    return told + "".join(map(_comparator, record["comparators"]))


def _ours(numbers: Mapping[str, Any]) -> str:
    return "; ".join(f"{name} {_number(value)}" for name, value in numbers.items())


def _comparator(each: Record) -> str:
    said = [("published input", name, text) for name, text in each["inputs"].items()]
    said += [("assumed", name, text) for name, text in each["assumed"].items()]
    said += [("published", name, text) for name, text in each["published"].items()]
    said += [("ours", name, f"{_number(low)} to {_number(high)}") for name, (low, high) in each["ours"].items()]
    told = (
        f"<p>{escape(each['agreement'])}</p><p>To this question it {escape(each['applicability']['text'])}.</p>"
        f"<p><small>{escape(each['kind'])}; {escape(each['source'])} (read: {escape(each['read'])})</small></p>"
    )
    return f"<h3>{escape(each['title'])}</h3>{_words(('', '', ''), said)}{told}{_call(each['call'])}"


def _uncertainty(record: Record) -> str:
    found = record["uncertainty"]
    if found is None:
        return "<p>No tolerances were given: nothing was propagated.</p>"
    bands = [
        (_head(key), _number(band["low"]), _number(band["median"]), _number(band["high"]))
        for key, band in found["bands"].items()
    ]
    names, indices = next(iter(found["sobol"].values())), found["sobol"].values()
    shares = [(_title(name), *(_percent(each[name]) for each in indices)) for name in names]
    aligned = " The load is taken along the axis." if found["aligned"] else ""
    told = f"{found['samples']} samples by {escape(found['model'])}, seed {found['seed']}, about the worst case."
    heads = ("tolerance", *(f"share in the variance of {_head(key)}" for key in found["sobol"]))
    tables = html.table(("", "2.5 %", "median", "97.5 %"), bands) + html.table(heads, shares)
    return f"<p>{told}{aligned}</p>{tables}{_call(found['call'])}"


def _wear(record: Record) -> str:
    found = record["wear"]
    if found is None:
        return "<p>No cycle was given: wear is not part of this evidence.</p>"
    names = ("cycles", "volume", "depth", "penetration", "max_pressure")
    heads = ("cycles", "volume [mm³]", "depth [mm]", "penetration [mm]", "pmax [MPa]")
    rows = [[_number(row[name]) for name in names] for row in found["history"]]
    return html.table(heads, rows) + _list(found.get("notes", ())) + _call(found["call"])


def _credibility(record: Record) -> str:
    rows = [(each["activity"], each["factor"], each["supported_by"], each["missing"]) for each in record["credibility"]]
    return _words(("activity", "factor", "supported by", "missing"), rows)


def _signed(record: Record, day: date) -> str:
    told = (
        f"<p>Made on {day.isoformat()} by ballsocket {escape(record['version'])}. The SHA-256 sums of this page and of "
        "what lies beside it are in checksums.txt; <code>ballsocket evidence --check FOLDER</code> computes it "
        "again.</p>"
    )
    rows = "".join(f"<tr><td>{name}</td><td></td><td></td></tr>" for name in ("prepared", "reviewed", "approved"))
    return f"{told}<table class='sign'><tr><th></th><th>name, date</th><th>signature</th></tr>{rows}</table>"


def _case(row: Record) -> str:
    return ", ".join(
        f"{_KEYS[key].title} {_number(value)} {_KEYS[key].written.text}".strip() for key, value in row["case"].items()
    )


def _value(name: str, row: Record) -> str:
    each = NAMES[name]
    bar = row["errors"].get(each.key)
    return f"{_number(row['numbers'][each.key])} {each.written.text}" + _bar(bar)


def _head(key: str) -> str:
    each = _KEYS[key]
    return f"{each.symbol or each.title}{each.written.bracketed}"


def _title(name: str) -> str:
    return QUANTITIES[name].title


def _bar(error: float | None) -> str:
    """An error bar; what is below the digits that are shown is not."""
    return f" ± {_percent(error)}" if error and error > _FINE else ""


def _number(value: Any) -> str:
    return "–" if value is None else value if isinstance(value, str) else f"{value:.5g}"


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"


def _call(text: str) -> str:
    return f"<p class='call'>{escape(text)}</p>"


def _words(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of words, all of which begin on the left."""
    return f"<div class='words'>{html.table(heads, rows)}</div>"


def _list(texts: Iterable[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>"
