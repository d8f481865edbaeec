"""A pack of evidence as one page, in the order in which a reviewer reads; it prints on A4 and Letter."""

from __future__ import annotations

from html import escape

from . import html
from .evidence_sections import (
    calculation_section,
    matrix_section,
    uncertainty_section,
    validation_section,
    wear_section,
)
from .evidence_words import Record, limit_text, listed, number, percent, words

_SAID = {True: "passed", False: "FAILED", None: "not run"}
_LIMITS = (
    "Materials are linear elastic: where von Mises stress passes the yield stress, the numbers end (see utilisation).",
    "Contact is without friction as far as pressures go; torques are Coulomb's on these pressures.",
    "Bodies are those that the notes name: a whole shell behind the liner for the exact answer, the cup with its rim "
    "off the axis and in finite elements.",
    "Loads do not change in time; what wear says is in its own section.",
)
_STYLE = """<style>@media print { .sign td { height: 2.5rem; } .call { break-before: avoid; } h3 { break-after: avoid; }
details::details-content { content-visibility: visible; display: block; } }
.sign td { min-width: 14rem; }
.words td, .words th { text-align: left; vertical-align: top; }
.call { font-family: monospace; font-size: 0.8rem; color: #555; }</style>"""


def evidence_page(record: Record) -> str:
    """The page of a pack; see `evidence.pack.gathered`."""
    sections = {
        "question": ("Question and context of use", _question(record)),
        "risk": ("Model risk and required accuracy", _risk(record)),
        "inputs": ("Inputs", _inputs(record)),
        "matrix": ("Worst-case matrix", matrix_section(record)),
        "code": ("Code verification", _code(record)),
        "calculation": ("Calculation verification", calculation_section(record)),
        "validation": ("Validation", validation_section(record)),
        "uncertainty": ("Sensitivity and uncertainty", uncertainty_section(record)),
        "wear": ("Wear", wear_section(record)),
        "limits": ("Limits and assumptions", listed(_LIMITS)),
        "credibility": ("Credibility factors (ASME V&V 40)", _credibility(record)),
        "signed": ("Signatures", _signed(record)),
    }
    lede = f"{html.PRINT}{_STYLE}<p>{escape(record['question'])}</p>{listed(conclusions(record))}"
    return html.page("Evidence", lede, sections)


def conclusions(record: Record) -> list[str]:
    """What it comes to, in sentences: how limits are kept, and whether the numbers are as exact as is required."""
    limits = [f"{limit_text(each)}: {each['verdict']}" for each in record["limits"]] or ["no limit was given"]
    accurate = record["accurate"]
    largest = "unknown" if accurate["largest"] is None else percent(accurate["largest"])
    holds = "within" if accurate["holds"] else "NOT within"
    said = f"Error bars and other methods: {largest} at most, {holds} the required {percent(accurate['required'])}."
    return [*limits, said]


def _question(record: Record) -> str:
    return f"<p>{escape(record['question'])}</p><p>{escape(record['context_of_use'])}</p>"


def _risk(record: Record) -> str:
    rows = [
        ("influence of the model on the decision", record["risk"]["influence"]),
        ("consequence of a wrong decision", record["risk"]["consequence"]),
        ("required accuracy", percent(record["required"]["accuracy"])),
        *(("limit", limit_text(each)) for each in record["limits"]),
    ]
    return words(("", ""), rows)


def _inputs(record: Record) -> str:
    rows = [
        (each["name"], number(each["value"]), each["unit"], each["tolerance"], each["source"] or "none given")
        for each in record["inputs"]
    ]
    return words(("input", "value", "unit", "tolerance", "source"), rows)


def _code(record: Record) -> str:
    rows = [
        (each["what"], number(each["observed"]), _allowed(each), _SAID[each["passed"]] + _why(each))
        for each in record["code_verification"]
    ]
    made = ", ".join(f"{name} {text}" for name, text in record["made_with"].items())
    told = f"<p>Run when this pack was made, by ballsocket {escape(record['version'])} ({escape(made)}).</p>"
    return told + html.table(("check", "observed", "allowed", ""), rows)


def _allowed(check: Record) -> str:
    return f"at least {check['low']:g}" if check["high"] is None else f"at most {check['high']:g}"


def _why(check: Record) -> str:
    return f": {check['why']}" if check["why"] else ""


def _credibility(record: Record) -> str:
    rows = [(each["activity"], each["factor"], each["supported_by"], each["missing"]) for each in record["credibility"]]
    return words(("activity", "factor", "supported by", "missing"), rows)


def _signed(record: Record) -> str:
    told = (
        f"<p>Made on {escape(record['made_on'])} by ballsocket {escape(record['version'])}. The SHA-256 sums of this "
        "page and of what lies beside it are in checksums.txt; <code>ballsocket evidence --check FOLDER</code> "
        "computes it again.</p>"
    )
    rows = "".join(f"<tr><td>{name}</td><td></td><td></td></tr>" for name in ("prepared", "reviewed", "approved"))
    return f"{told}<table class='sign'><tr><th></th><th>name, date</th><th>signature</th></tr>{rows}</table>"
