"""A pack of evidence as one page, in the order in which a reviewer reads; it prints on A4 and Letter."""

from __future__ import annotations

from html import escape

from ..core.storage.fingerprint import fingerprint
from ..evidence.matrix import input_title, limit_text, number, title_of
from . import html
from .evidence_sections import (
    calculation_section,
    credibility_section,
    matrix_section,
    requirements_section,
    uncertainty_section,
    validation_section,
    wear_section,
)
from .evidence_words import (
    Record,
    listed,
    percent,
    quantities_of_interest,
    recentred_text,
    words,
)

_SAID = {True: "passed", False: "FAILED", None: "not run"}
_LIMITS = (
    "Materials are linear elastic: where von Mises stress passes the yield stress, the numbers end (see utilisation).",
    "Contact is without friction as far as pressures go; torques are Coulomb's on these pressures.",
    "Bodies are those that the notes name: a whole shell behind the liner for the exact answer, the cup with its rim "
    "off the axis and in finite elements.",
    "Loads do not change in time; what wear says is in its own section.",
)
_STYLE = """<style>
@media print { table { break-inside: auto; } .sign { break-inside: avoid; } .sign td { height: 2.5rem; }
.call { break-before: avoid; } h3 { break-after: avoid; }
details::details-content { content-visibility: visible; display: block; } }
.sign td { min-width: 14rem; }
.words td, .words th { text-align: left; vertical-align: top; }
.call { font-family: monospace; font-size: 0.8rem; color: #555; }
.digest { font-family: monospace; overflow-wrap: anywhere; }</style>"""
_MARGINS = """<style>@page { margin: 22mm 15mm 20mm;
@top-left { content: "Evidence, ballsocket %(version)s"; font: 8pt sans-serif; color: #555; }
@top-right { content: "pack %(short)s"; font: 8pt monospace; color: #555; }
@bottom-right { content: "page " counter(page) " of " counter(pages); font: 8pt sans-serif; color: #555; } }</style>"""
_SHORT = 16
"""Number of digest characters in the head of a printed page."""


def evidence_page(record: Record, digest: str = "") -> str:
    """Return the page of a pack as HTML.

    Parameters
    ----------
    record : mapping
        See `evidence.pack.gather_evidence`.
    digest : str
        Digest of the pack, see `evidence.folder.digest`; omitted if empty.
    """
    with html.plain_style():
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
            "credibility": ("Credibility factors (ASME V&V 40)", credibility_section(record)),
            "requirements": ("Requirements and evidence", requirements_section(record)),
            "signed": ("Signatures", _signed(record, digest)),
        }
    head = _margins(digest) if digest else ""
    lede = f"{html.PRINT}{_STYLE}{head}<p>{escape(record['question'])}</p>{listed(conclusions(record))}"
    return html.page("Evidence", lede, sections)


def _margins(digest: str) -> str:
    """Return the style of head and foot of printed pages."""
    return _MARGINS % {"version": fingerprint(), "short": f"{digest[:_SHORT]}…"}


def conclusions(record: Record) -> list[str]:
    """What it comes to, in sentences: how limits are kept, and whether the numbers are as exact as is required."""
    limits = [f"{limit_text(each)}: {each['verdict']}" for each in record["limits"]] or ["no limit was given"]
    accurate = record["accurate"]
    largest = "unknown" if accurate["largest"] is None else percent(accurate["largest"])
    holds = "within" if accurate["holds"] else "NOT within"
    said = f"Error bars and other methods: {largest} at most, {holds} the required {percent(accurate['required'])}."
    return [*limits, said, f"{record['adequacy']['text']}.", *map(recentred_text, record["recentred"])]


def _question(record: Record) -> str:
    return f"<p>{escape(record['question'])}</p><p>{escape(record['context_of_use'])}</p>"


def _risk(record: Record) -> str:
    risk = record["risk"]
    rows = [
        ("influence of the model on the decision", risk["influence"]),
        ("consequence of a wrong decision", risk["consequence"]),
        ("model risk", f"{risk['level']} ({risk['rank']} of 5): it sets the goals of the credibility factors"),
        ("required accuracy", percent(record["required"]["accuracy"])),
        ("quantities of interest", ", ".join(map(title_of, quantities_of_interest(record)))),
        *(("limit", limit_text(each)) for each in record["limits"]),
    ]
    return words(("", ""), rows)


def _inputs(record: Record) -> str:
    rows = [
        (input_title(each["name"]), number(each["value"]), each["unit"], each["tolerance"], each["source"] or "none")
        for each in record["inputs"]
    ]
    table = words(("input", "value", "unit", "tolerance", "source"), rows)
    return table + listed(map(recentred_text, record["recentred"]))


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


def _signed(record: Record, digest: str) -> str:
    told = (
        f"<p>Made on {escape(record['made_on'])} by ballsocket {escape(record['version'])}. The digest below is the "
        "SHA-256 sum of the checksums of all files of the pack except this page, which is made from them. "
        "<code>ballsocket evidence --check FOLDER</code> computes all of it again, compares every byte of this page "
        "and prints the digest; <code>--sign KEY</code> and <code>--verify KEY.pub</code> sign the pack and verify "
        "its signature.</p>"
    )
    shown = f"<p>Digest of the pack: <span class='digest'>{escape(digest)}</span></p>" if digest else ""
    rows = "".join(f"<tr><td>{name}</td><td></td><td></td></tr>" for name in ("prepared", "reviewed", "approved"))
    return f"{told}{shown}<table class='sign'><tr><th></th><th>name, date</th><th>signature</th></tr>{rows}</table>"
