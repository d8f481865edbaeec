"""Pages of a joint and of a press: drawing, inputs, verdict, results, tolerances, sources."""

from __future__ import annotations

import json
from collections.abc import Iterable
from datetime import date
from hashlib import sha256
from math import inf
from typing import Any

from ..compare import Comparison, successful_contacts
from ..contact import Contact
from ..contact.describe import number_text
from ..contact.verdict import assess_strength
from ..core.quantities import CONTACT, CUP, MATERIAL, STRESS_LIMITS
from ..core.sources import Source
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..files.joint_toml import tables_of
from ..problem import Material
from ..problem.cup import Cup
from ..studies.derivatives import LocalUncertainty
from ..studies.parameters import PARAMETERS
from . import press_plots
from .pages import Sections, render_page, render_part, svg_address, trusted_html
from .section_plots import joint_section
from .unit_systems import Units


def joint_report(
    file: JointFile,
    sections: Sections,
    lede: str = "",
    units: Units = Units.SI,
    contact: Contact | None = None,
    day: date | None = None,
    title: str = "",
) -> str:
    """Return the page of a joint as HTML.

    Parameters
    ----------
    file : JointFile
        Joint without axes, with its cup and load.
    sections : mapping of str to tuple of str
        Sections between the inputs and the joint file: title and HTML by id.
    lede : str
        HTML above the sections.
    units : Units
        Units of the drawing and the inputs.
    contact : Contact, optional
        Contact that is drawn, if it lies on the axis.
    day : date, optional
        Date of the page; by default today.
    title : str
        Title; by default the joint's name.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    drawn_contact = None if contact is None or contact.status.failed or isinstance(contact, OffAxisContact) else contact
    all_sections = {
        "drawing": ("Drawing", None),
        "inputs": ("Inputs", None),
        **sections,
        "origin": ("Joint file", None),
    }
    text = json.dumps(_finite(tables_of(file)), indent=1, ensure_ascii=False)
    return render_page(
        "joint_report.html",
        title or file.joint.name or "A ball in its socket",
        all_sections,
        lede=trusted_html(lede),
        joint=str(file.joint),
        drawing=svg_address(joint_section(file.joint, file.cup, drawn_contact, units)),
        inputs=_inputs(file, units),
        day=(day or date.today()).isoformat(),
        checksum=sha256(text.encode()).hexdigest(),
        file=text,
    )


def _inputs(file: JointFile, units: Units) -> Iterable[tuple[str, str, str]]:
    """Yield title, value and source of each input."""
    joint = file.joint
    yield "head diameter", units.length(2 * float(joint.ball_radius)), joint.source
    yield "bore diameter", units.length(2 * float(joint.socket_radius)), ""
    yield "diametral clearance", units.length(2 * float(joint.clearance)), "twice the radial clearance"
    yield "liner thickness", units.length(float(joint.liner_thickness)), ""
    yield "liner", _material(joint.liner, units), joint.liner.source
    yield "ball", "rigid" if joint.ball is None else _material(joint.ball, units), getattr(joint.ball, "source", "")
    for number, layer in enumerate(joint.backing, 1):
        material = layer.material
        yield (
            f"backing {number}",
            f"{units.length(float(layer.thickness))} of {_material(material, units)}",
            material.source,
        )
    yield "outermost surface", joint.support.value, ""
    yield from _cup(file.cup, units)
    for name, angle in file.aim.items():
        if name == "tilt":
            yield PARAMETERS[name].title, units.text_of(PARAMETERS[name], float(angle)), "between load and cup's axis"
        else:
            yield name, ", ".join(f"{part:.4g}" for part in angle), "components to the right, to the front, up"
    for name, value in file.load.items():
        yield PARAMETERS[name].title, units.text_of(PARAMETERS[name], float(value)), ""


def _material(material: Material, units: Units) -> str:
    """Describe a material with its elastic constants and stress limits."""
    values = {MATERIAL[name]: getattr(material, name) for name in ("young", "poisson")}
    values |= {STRESS_LIMITS[name]: limit for name, limit in material.stress_limits.items()}
    numbers = (f"{quantity.title} {units.text_of(quantity, float(number))}" for quantity, number in values.items())
    return f"{material.name or 'a material'}: {', '.join(numbers)}"


def _cup(cup: Cup, units: Units) -> Iterable[tuple[str, str, str]]:
    """Yield title and value of each dimension of the cup."""
    for name, quantity in CUP.items():
        number = float(getattr(cup, name))
        yield quantity.title, units.length(number) if name == "chamfer" else units.text_of(quantity, number), ""
    yield "liner on its backing", cup.interface.value, ""


def _finite(tables: Any) -> Any:
    """Replace infinity by the text "inf", which JSON lacks and a joint file accepts."""
    if isinstance(tables, dict):
        return {name: _finite(value) for name, value in tables.items()}
    if isinstance(tables, list):
        return [_finite(value) for value in tables]
    return "inf" if tables == inf else tables


_TEMPLATE = "press.html"
_VERDICT_STYLES = {True: "holds", False: "fails", None: "nearly"}
"""Style of a verdict by whether the liner bears the load; None if that is unknown."""


def press_report(
    comparison: Comparison,
    file: JointFile,
    leading: str,
    units: Units = Units.SI,
    surroundings: LocalUncertainty | None = None,
    day: date | None = None,
) -> str:
    """Return the page of single contacts of one joint as HTML.

    Parameters
    ----------
    comparison : Comparison
    file : JointFile
        Joint with its cup and load.
    leading : str
        Name of the model whose contact gets the verdict; the exact one if there is one.
    units : Units
        Units of every number.
    surroundings : LocalUncertainty, optional
        Sensitivity of the results to each number and to the tolerances.
    day : date, optional
        Date of the page; by default today.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    contact = comparison[leading]
    answers, *more = press_sections(comparison, units, surroundings).items()
    drawn = ("figures", ("Pressure and force", _figures(comparison, contact)))
    return joint_report(file, dict([answers, drawn, *more]), press_lede(contact, units), units, contact, day)


def press_lede(contact: Contact, units: Units = Units.SI) -> str:
    """Return the largest pressure of a contact with the verdict in words, as HTML."""
    verdict = assess_strength(contact)
    pressure, load = (_number(contact, name, units) for name in ("max_pressure", "force"))
    model, kind = contact.model.name, _VERDICT_STYLES[verdict.bears]
    return render_part(_TEMPLATE, "lede", pressure, load, model, verdict.words, kind)


def press_sections(
    comparison: Comparison, units: Units = Units.SI, surroundings: LocalUncertainty | None = None
) -> dict[str, tuple[str, str]]:
    """Return the sections of a press without its figures: title and HTML by id."""
    return {
        "answers": ("Results", _results(comparison, units)),
        "tolerances": ("Sensitivity and tolerances", _tolerances(surroundings, units)),
        "sources": ("Sources", _sources(comparison)),
    }


def _number(contact: Contact, name: str, units: Units) -> str:
    """Write a quantity of a contact with its unit."""
    column = next(column for column in units.columns if column.attribute == name)
    return f"{number_text(column.values_of(contact), 4, 'no result')} {column.unit}"


def _results(comparison: Comparison, units: Units) -> str:
    """Return the table of results by model with the notes, as HTML."""
    columns = units.columns
    rows = [
        (
            name,
            *(number_text(column.values_of(contact), 4, "-") for column in columns),
            "yes" if contact.valid else "no",
        )
        for name, contact in comparison.items()
    ]
    heads = ("model", *(column.head for column in columns), "valid")
    symbols = ", ".join(f"{column.symbol} {column.title}" for column in columns)
    return render_part(_TEMPLATE, "answers", heads, rows, symbols, comparison.notes())


def _figures(comparison: Comparison, leading: Contact) -> str:
    """Return the figure of the curves as HTML; for a contact off the cup's axis the pressure map of the cup."""
    contacts = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else successful_contacts(comparison)
    drawable = contacts and not leading.status.failed
    return render_part(_TEMPLATE, "figures", svg_address(press_plots.plot(contacts)) if drawable else None)


def _tolerances(surroundings: LocalUncertainty | None, units: Units) -> str:
    """Return elasticities and the bands of the tolerances as HTML."""
    if surroundings is None:
        return render_part(_TEMPLATE, "tolerances", None, ())
    names = list(next(iter(surroundings.changes.values())))
    rows = [
        (CONTACT[name].title, *(f"{changes[name]:+.2f}" for name in names))
        for name, changes in surroundings.changes.items()
    ]
    heads = ("change in % if 1 % is added to the", *(PARAMETERS[name].title for name in names))
    ends = [
        (CONTACT[name].title, *(units.text_of(CONTACT[name], end) for end in band))
        for name, band in surroundings.band.items()
    ]
    return render_part(_TEMPLATE, "tolerances", {"heads": heads, "rows": rows}, ends)


def _sources(comparison: Comparison) -> str:
    """Return the list of sources as HTML."""
    return render_part(_TEMPLATE, "sources", map(_source_text, comparison.sources))


def _source_text(source: Source) -> str:
    """Write a source with its DOI."""
    return f"{source}, doi {source.doi}" if source.doi else str(source)
