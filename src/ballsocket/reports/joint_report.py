"""Page of a joint: drawing, inputs, results, and the joint file of the computation; it prints."""

from __future__ import annotations

import json
from collections.abc import Iterable
from datetime import date
from hashlib import sha256
from math import inf
from typing import Any

from ..contact import Contact
from ..core.quantities import CUP, MATERIAL, STRESS_LIMITS
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..files.joint_toml import tables_of
from ..problem import Material
from ..problem.cup import Cup
from ..studies.parameters import PARAMETERS
from .joint_section import joint_section
from .pages import Sections, render_page, svg_address, trusted_html
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
