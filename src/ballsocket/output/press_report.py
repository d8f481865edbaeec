"""A press as one page to send: drawing, inputs, verdict, answers, tolerances, sources; it prints on A4 and Letter."""

from __future__ import annotations

import json
from collections.abc import Iterable
from datetime import date
from hashlib import sha256
from html import escape
from math import inf, isinf
from typing import Any

from ..compare import Comparison, answered
from ..contact import Contact
from ..contact.describe import number_text
from ..contact.verdict import Verdict, verdict
from ..cup import Cup
from ..io.joint_file import JointFile
from ..io.joint_toml import tables_of
from ..joint import Material
from ..quantities import CONTACT, CUP, MATERIAL, STRENGTH
from ..sources import Source
from ..sphere.contact import OffAxisContact
from ..studies.around import Around
from ..studies.parameters import PARAMETERS
from . import html, quick_plot
from .joint_section import joint_section
from .unit_systems import Units

_CLASSES = {True: "holds", False: "fails", None: "nearly"}


def press_report(
    comparison: Comparison,
    file: JointFile,
    leading: str,
    units: Units = Units.SI,
    surroundings: Around | None = None,
    day: date | None = None,
) -> str:
    """The page of single contacts of one joint.

    Parameters
    ----------
    comparison : Comparison
    file : JointFile
        The joint with its cup and load.
    leading : str
        The name of the model that gives the verdict; the exact answer, where there is one, is best.
    units : Units
        Of every number.
    surroundings : Around, optional
        What a percent of each number and the tolerances do.
    day : date, optional
        By default today's.

    Returns
    -------
    str
        HTML that needs nothing beside it.
    """
    contact = comparison[leading]
    painted = None if contact.status.failed or isinstance(contact, OffAxisContact) else contact
    section = joint_section(file.joint, file.cup, painted, units)
    sections = {
        "drawing": ("Drawing", html.picture(html.drawn(section, "svg"), f"{file.joint} in section", form="svg+xml")),
        "inputs": ("Inputs", html.words(("input", "value", "source"), _inputs(file, units))),
        "answers": ("Answers", _answers(comparison, units)),
        "figures": ("Pressure and force", _curves(comparison, contact)),
        "tolerances": ("What tolerances do", _around(surroundings, units)),
        "sources": ("Sources", _sources(comparison)),
        "origin": ("Origin", _origin(file, day or date.today())),
    }
    name = file.joint.name or "A ball in its socket"
    return html.page(name, html.PRINT + _lede(contact, verdict(contact), units), sections)


def _lede(contact: Contact, said: Verdict, units: Units) -> str:
    """The first number with its verdict in words."""
    pressure, load = (escape(_number(contact, name, units)) for name in ("max_pressure", "force"))
    told = f"<strong>{pressure}</strong> largest pressure under {load}, by {escape(contact.model.name)}"
    return f"<p>{told}: <span class='{_CLASSES[said.bears]}'>{escape(said.words)}.</span></p>"


def _number(contact: Contact, name: str, units: Units) -> str:
    column = next(column for column in units.columns if column.attribute == name)
    return f"{number_text(column.of(contact), 4, 'no answer')} {column.unit}"


# --- inputs ---


def _inputs(file: JointFile, units: Units) -> Iterable[tuple[str, str, str]]:
    joint = file.joint
    yield "head diameter", units.length(2 * float(joint.ball_radius)), joint.source
    yield "bore diameter", units.length(2 * float(joint.socket_radius)), ""
    yield "diametral clearance", units.length(2 * float(joint.clearance)), "twice the radial one"
    yield "liner thickness", _thick(joint.liner_thickness, units), ""
    yield "liner", _material(joint.liner, units), joint.liner.source
    yield "ball", "rigid" if joint.ball is None else _material(joint.ball, units), getattr(joint.ball, "source", "")
    for number, layer in enumerate(joint.backing, 1):
        material = layer.material
        yield f"backing {number}", f"{_thick(layer.thickness, units)} of {_material(material, units)}", material.source
    yield "outermost surface", joint.support.value, ""
    yield from _cup(file.cup, units)
    for name, angle in file.aim.items():
        if name == "tilt":
            yield PARAMETERS[name].title, units.told(PARAMETERS[name], float(angle)), "between load and cup's axis"
        else:
            yield name, ", ".join(f"{part:.4g}" for part in angle), "to the right, to the front, up"
    for name, value in file.load.items():
        yield PARAMETERS[name].title, units.told(PARAMETERS[name], float(value)), ""


def _thick(thickness: Any, units: Units) -> str:
    return "to infinity" if isinf(float(thickness)) else units.length(float(thickness))


def _material(material: Material, units: Units) -> str:
    known = {MATERIAL[name]: getattr(material, name) for name in ("young", "poisson")}
    known |= {STRENGTH[name]: strength for name, strength in material.strengths.items()}
    numbers = (f"{quantity.title} {units.told(quantity, float(number))}" for quantity, number in known.items())
    return f"{material.name or 'a material'}: {', '.join(numbers)}"


def _cup(cup: Cup, units: Units) -> Iterable[tuple[str, str, str]]:
    for name, quantity in CUP.items():
        number = float(getattr(cup, name))
        yield quantity.title, units.length(number) if name == "chamfer" else units.told(quantity, number), ""
    yield "liner on its backing", cup.interface.value, ""


# --- answers ---


def _answers(comparison: Comparison, units: Units) -> str:
    columns = units.columns
    rows = [
        (name, *(number_text(column.of(contact), 4, "-") for column in columns), "yes" if contact.valid else "no")
        for name, contact in comparison.items()
    ]
    heads = ("model", *(column.head for column in columns), "valid")
    meant = ", ".join(f"{column.symbol} {column.title}" for column in columns)
    notes = "".join(f"<p class='quiet'>{escape(note)}</p>" for note in comparison.notes())
    return f"{html.table(heads, rows)}<p class='quiet'>{escape(meant)}</p>{notes}"


def _curves(comparison: Comparison, leading: Contact) -> str:
    """The curves; the cup seen from its opening for a contact beside its axis."""
    shown = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else answered(comparison)
    if not shown or leading.status.failed:
        return "<p>There is nothing to draw.</p>"
    return html.picture(html.drawn(quick_plot.plot(shown), "svg"), "pressure and force", form="svg+xml")


def _around(found: Around | None, units: Units) -> str:
    """Elasticities, and the band of the tolerances."""
    if found is None:
        return "<p>Not asked for.</p>"
    names = list(next(iter(found.changes.values())))
    rows = [(CONTACT[asked].title, *(f"{each[name]:+.2f}" for name in names)) for asked, each in found.changes.items()]
    heads = ("changes by %, where 1 % is added to the", *(PARAMETERS[name].title for name in names))
    text = html.table(heads, rows)
    if not found.band:
        return text + "<p class='quiet'>No tolerances were given.</p>"
    ends = [
        (CONTACT[asked].title, *(units.told(CONTACT[asked], end) for end in band)) for asked, band in found.band.items()
    ]
    return text + html.table(("95 % of the joints within the tolerances lie", "above", "half above", "below"), ends)


# --- where it comes from ---


def _sources(comparison: Comparison) -> str:
    return "<ul>" + "".join(f"<li>{escape(_told(source))}</li>" for source in comparison.sources) + "</ul>"


def _told(source: Source) -> str:
    return f"{source}, doi {source.doi}" if source.doi else str(source)


def _origin(file: JointFile, day: date) -> str:
    """The question as a file, with its checksum and the day."""
    text = json.dumps(_finite(tables_of(file)), indent=1, ensure_ascii=False)
    checksum = sha256(text.encode()).hexdigest()
    told = "The joint as the tables of a joint file, with which <code>ballsocket press</code> computes it again"
    return f"<p>{day.isoformat()}. {told}; their SHA-256 is <code>{checksum}</code>.</p><pre>{escape(text)}</pre>"


def _finite(tables: Any) -> Any:
    """With what is infinite in words, as JSON needs it and a joint file takes it."""
    if isinstance(tables, dict):
        return {name: _finite(value) for name, value in tables.items()}
    if isinstance(tables, list):
        return [_finite(value) for value in tables]
    return "inf" if tables == inf else tables
