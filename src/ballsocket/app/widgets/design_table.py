"""Table of several designs in columns: dimensions, results of one model, differences and verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan, nan

from ...comparison import relative_deviation, successful_contacts
from ...contact import Contact
from ...contact.verdict import Verdict, range_text
from ...core.answers import Check
from ...core.quantities import CONTACT, JOINT
from ...design_checks import checks_of, verdict_of
from ...files.joint_file import JointFile
from ...problem.presets import material_label
from ...question import real_cup_reason
from ...reports.joint_drawing import largest_drawn
from ..pictures.section import extent_of, section
from ..pressing import pressed
from ..state.screen import Screen
from ..views.real_cup import is_prepared, pressed_in_cup
from .blocks import Block, styled_row, table
from .reading import Reading, box_text, number_text
from .words import VERDICT_KINDS, percent

_DIMENSIONS = {
    "radius": ("ball_radius", "clearance", "liner_thickness", "outer_radius"),
    "diameter": ("head_diameter", "diametral_clearance", "liner_thickness", "outer_diameter"),
}


@dataclass(frozen=True, kw_only=True)
class ComparedDesign:
    """Design with its contact by one model, or the reason for a missing one; `heading` is HTML below its name.

    `limit` is the reason why the contact needs the real cup. `von_mises` is the stress (MPa) of its checks; None is
    the estimate.
    """

    file: JointFile
    contact: Contact | None
    reason: str = ""
    limit: str = ""
    heading: str = ""
    von_mises: float | None = None


Designs = Mapping[str, ComparedDesign]  # designs by their names, the one on the screen first


def press_designs(files: Mapping[str, JointFile], model: str, headings: Mapping[str, str]) -> Designs:
    """Press designs by a model, with HTML below some names."""
    designs = {}
    for name, file in files.items():
        contact: Contact | None
        if real_cup_reason(file) and is_prepared(file):
            contact, reason, limit = pressed_in_cup(file), "", ""
        else:
            comparison = pressed(file, (model,))
            contact, reason = successful_contacts(comparison).get(model), comparison.missing.get(model, "no result")
            limit = real_cup_reason(file, comparison.contacts.get(model))
        designs[name] = ComparedDesign(
            file=file,
            contact=contact,
            reason=reason,
            limit=f"{limit}: see Cup" if limit else "",
            heading=headings.get(name, ""),
        )
    return designs


def with_stresses(designs: Designs) -> Designs:
    """Take the von Mises stress of the model itself for the checks, as Contact does."""
    return {
        name: replace(design, von_mises=None if design.contact is None else float(design.contact.von_mises))
        for name, design in designs.items()
    }


def with_drawings(designs: Designs) -> Designs:
    """Add sections of the designs to their headings, at one scale and in one colour scale."""
    extent = max(extent_of(design.file) for design in designs.values())
    pressures = [largest_drawn(design.contact) for design in designs.values() if design.contact is not None]
    highest = max(pressures, default=1.0)
    return {
        name: replace(design, heading=section(design.file, design.contact, extent, highest) + design.heading)
        for name, design in designs.items()
    }


def design_table(designs: Designs, base: str, screen: Screen, names: Sequence[str] = tuple(CONTACT)) -> Block:
    """Return a table with differences from the base, which stand below the numbers."""
    heads = [[name, "", "", "", design.heading] for name, design in designs.items()]
    rows = [styled_row([label, *cells]) for label, cells in design_rows(designs, base, screen, names)]
    return table(["", *heads], rows, "designs")


def design_rows(
    designs: Designs, base: str, screen: Screen, names: Sequence[str] = tuple(CONTACT)
) -> list[tuple[str, list[list[str]]]]:
    """Tabulate designs in columns: verdict, checks, validity, dimensions, materials and the results of some `names`.

    A load that needs the real cup has no checks. A cell has its text, and may have the difference from the base and a
    style.
    """
    listed, reading = list(designs.values()), screen.reading
    checks: list[Sequence[Check]] = [
        () if design.contact is None or design.limit else checks_of(design.contact, design.file.cup, design.von_mises)
        for design in listed
    ]
    rows = [("verdict", [_verdict(design, part) for design, part in zip(listed, checks, strict=True)])]
    for check in dict.fromkeys((row.title, row.limit) for part in checks for row in part if row.capacity):
        ratios = [{(row.title, row.limit): row for row in part}.get(check) for part in checks]
        rows.append((" / ".join(check), [_ratio(row) for row in ratios]))
    rows.append(("valid here", [_validity(design, reading) for design in listed]))
    for name in _DIMENSIONS[screen.size]:
        unit = reading.unit(JOINT[name])
        lengths = [float(getattr(design.file.joint, name)) * unit.factor for design in listed]
        cells = [[box_text(length, unit.text)] for length in lengths]
        rows.append((f"{JOINT[name].title}{unit.text_in_brackets}", cells))
    for part in ("liner", "ball"):
        materials = [getattr(design.file.joint, part) for design in listed]
        rows.append((part, [[material_label(material, "custom numbers")] for material in materials]))
    for quantity in (CONTACT[name] for name in CONTACT if name in names):
        unit = reading.unit(quantity)
        values = [float(getattr(design.contact, quantity.name, nan)) * unit.factor for design in listed]
        reference = values[list(designs).index(base)]
        rows.append((f"{quantity.title}{unit.text_in_brackets}", [_number(value, reference) for value in values]))
    return rows


def report_table(designs: Designs, base: str, screen: Screen) -> Block:
    """Return a table for a report, with the differences from the base in brackets."""
    brackets = "{} ({})".format
    rows = [
        [label, *(brackets(*cell[:2]) if any(cell[1:2]) else cell[0] for cell in cells)]
        for label, cells in design_rows(designs, base, screen)
    ]
    return table(["", *designs], rows)


def _number(value: float, base: float) -> list[str]:
    if value == base or isnan(value):
        return [number_text(value)]
    return [number_text(value), percent(float(relative_deviation(value, base)), "+")]


def _verdict(design: ComparedDesign, checks: Sequence[Check]) -> list[str]:
    verdict, sentence = (Verdict.UNDECIDED, design.limit) if design.limit else verdict_of(checks)
    difference = "" if verdict is Verdict.KEPT else sentence
    return [f"{verdict.sign} {verdict.word}", difference, VERDICT_KINDS[verdict]]


def _ratio(check: Check | None) -> list[str]:
    if check is None or check.ratio is None:
        return ["–", "", "quiet"]
    bar = f"estimate, {range_text(check.ratio)}" if check.ratio.is_estimate else ""
    text = f"{check.verdict.sign} {100 * check.ratio.value:.0f} %"
    return [text, bar, "doubt" if check.is_near else VERDICT_KINDS[check.verdict]]


def _validity(design: ComparedDesign, reading: Reading) -> list[str]:
    if design.contact is None:
        return [design.reason, "", "no"]
    notes = [*filter(None, [design.limit]), *design.contact.notes]
    kind, text = ("yes", "✓ yes") if bool(design.contact.valid) and not design.limit else ("no", "✗ no")
    return [text, "; ".join(map(reading.units.sentence, notes)), kind]
