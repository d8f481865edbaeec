"""A joint as one page to send, whatever was asked of it: drawing, inputs, answers, origin; it prints."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from datetime import date
from hashlib import sha256
from html import escape
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
from . import html
from .joint_section import joint_section
from .unit_systems import Units


def joint_report(
    file: JointFile,
    sections: Mapping[str, tuple[str, str]],
    lede: str = "",
    units: Units = Units.SI,
    contact: Contact | None = None,
    day: date | None = None,
    title: str = "",
) -> str:
    """The page of a joint.

    Parameters
    ----------
    file : JointFile
        The joint, of plain numbers, with its cup and load.
    sections : mapping of str to tuple of str
        What was found, between the inputs and the origin: by id a title and HTML.
    lede : str
        HTML above all.
    units : Units
        Of the drawing and the inputs.
    contact : Contact, optional
        What is painted on the drawing, where it is on the axis.
    day : date, optional
        By default today's.
    title : str
        By default the joint's name.

    Returns
    -------
    str
        HTML that needs nothing beside it.
    """
    painted = None if contact is None or contact.status.failed or isinstance(contact, OffAxisContact) else contact
    section = html.drawn(joint_section(file.joint, file.cup, painted, units), "svg")
    whole = {
        "drawing": ("Drawing", html.picture(section, f"{file.joint} in section", form="svg+xml")),
        "inputs": ("Inputs", html.words(("input", "value", "source"), _inputs(file, units))),
        **sections,
        "origin": ("Origin", _origin(file, day or date.today())),
    }
    return html.page(title or file.joint.name or "A ball in its socket", html.PRINT + lede, whole)


def _inputs(file: JointFile, units: Units) -> Iterable[tuple[str, str, str]]:
    joint = file.joint
    yield "head diameter", units.length(2 * float(joint.ball_radius)), joint.source
    yield "bore diameter", units.length(2 * float(joint.socket_radius)), ""
    yield "diametral clearance", units.length(2 * float(joint.clearance)), "twice the radial one"
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
            yield PARAMETERS[name].title, units.told(PARAMETERS[name], float(angle)), "between load and cup's axis"
        else:
            yield name, ", ".join(f"{part:.4g}" for part in angle), "to the right, to the front, up"
    for name, value in file.load.items():
        yield PARAMETERS[name].title, units.told(PARAMETERS[name], float(value)), ""


def _material(material: Material, units: Units) -> str:
    known = {MATERIAL[name]: getattr(material, name) for name in ("young", "poisson")}
    known |= {STRESS_LIMITS[name]: limit for name, limit in material.stress_limits.items()}
    numbers = (f"{quantity.title} {units.told(quantity, float(number))}" for quantity, number in known.items())
    return f"{material.name or 'a material'}: {', '.join(numbers)}"


def _cup(cup: Cup, units: Units) -> Iterable[tuple[str, str, str]]:
    for name, quantity in CUP.items():
        number = float(getattr(cup, name))
        yield quantity.title, units.length(number) if name == "chamfer" else units.told(quantity, number), ""
    yield "liner on its backing", cup.interface.value, ""


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
