"""Description of a press: a table of contacts with their deviations from the exact solution, verdicts and remarks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import degrees, isfinite
from typing import TYPE_CHECKING, Any

from .comparison import Comparison, relative_deviation
from .contact import Contact
from .contact.describe import number_of, quantities_of
from .contact.verdict import Verdict, rim_verdict
from .core.answers import PAGE, Answer, Column, Row, Table
from .core.arrays import Numbers, to_numpy
from .core.kinds import MILLIMETRES, NEWTONS
from .core.quantities import CONTACT, HEADLINE, LOADS, PLASTIC, YIELD_LIMITS
from .core.unit_systems import Amount, Sentence
from .design_checks import checks_of, strength_lines, unchecked_text, verdict_of
from .model_catalogue import JUDGE, OFF_AXIS, reference
from .question import PressAnswer

if TYPE_CHECKING:
    from .elasticity.off_axis.contact import OffAxisContact

_KEPT_LONGEST = ("max_pressure", "half_angle", "force", "indentation", "area", "stiffness")
_RANKS = {name: rank for rank, name in enumerate(dict.fromkeys((*_KEPT_LONGEST, *CONTACT)))}
"""Ranks of the columns: a narrow terminal always has the largest pressure and the ratios of stress to strength."""

_OFF_THE_POLE = ("pole_pressure", "max_pressure_angle")
"""Quantities that repeat others where every valid pressure is largest at the pole."""


def describe_press(comparison: Comparison, remarks: Iterable[str] = ()) -> Answer:
    """Describe contacts of one joint and load: a valid exact one first, the others with their deviations from it."""
    exact = comparison.get(reference.name)
    if exact is not None and exact.valid:
        comparison = replace(comparison, contacts={reference.name: exact, **comparison.contacts})
    contacts = comparison.contacts
    quantities = quantities_of(comparison.joint)
    if any(contact.yields for contact in contacts.values()):
        quantities += tuple(PLASTIC.values())
    off_pole = any(contact.valid and contact.max_pressure_angle > 0 for contact in contacts.values())
    hidden = () if off_pole else _OFF_THE_POLE
    columns = [
        Column.of(
            quantity,
            digits=4 if quantity.shown.text else 3,
            rank=PAGE if quantity.name in hidden else _RANKS.get(quantity.name, 0),
        )
        for quantity in quantities
    ]
    truths = [] if exact is None else [number_of(exact, quantity) for quantity in quantities]
    rows = []
    for name, contact in contacts.items():
        compared = exact is not None and name != reference.name and not contact.status.failed
        numbers = [number_of(contact, quantity) for quantity in quantities]
        below = [("  Δ %", *map(_percent, numbers, truths), "")] if compared else []
        verdict = None if contact.valid else Verdict.UNDECIDED
        rows.append(Row((name, *numbers, bool(contact.valid)), verdict, below=below))
    gaps = [None] * len(columns)
    rows += [Row((name, *gaps, False), Verdict.EXCEEDED) for name in comparison.missing]
    deviating = any(row.below for row in rows)
    heads = [Column.of_words("model"), *columns, Column.of_words("valid")]
    return Answer(
        title=str(comparison.joint),
        tables=[Table("results", "Results", heads, rows, list(strength_lines(contacts)))],
        notes=[*([f"Δ %: deviation from {reference.name}"] if deviating else []), *remarks, *comparison.notes()],
    )


def _percent(number: float, truth: float) -> str:
    """Write a deviation from the exact number in percent; empty if equal or undefined."""
    deviation = 100 * float(relative_deviation(number, truth))
    unknown = deviation != deviation or deviation == 0
    return "" if unknown else f"{deviation:+.1f}".replace("-0.0", "+0.0")


_DISPLACEMENT = replace(
    Column.of(CONTACT["indentation"]),
    key="displacement_along_load",
    name="displacement_along_load_mm",
    head="u",
    title="displacement along the load from the socket's centre",
)


def describe_curve(contact: Contact, signed: Mapping[str, Numbers] | None = None) -> Answer:
    """Describe contacts at increasing loads by their main quantities.

    `signed` has the force and the displacement of loads of both signs.
    """
    quantities = [CONTACT[name] for name in HEADLINE] + ([*PLASTIC.values()] if contact.yields else [])
    names, signed = [quantity.name for quantity in quantities], signed or {}
    columns = [to_numpy(signed.get(name, getattr(contact, name))).tolist() for name in names]
    heads = [*map(Column.of, quantities)]
    if "displacement_along_load" in signed:
        columns.insert(1, signed["displacement_along_load"].tolist())
        heads.insert(1, _DISPLACEMENT)
    rows = [
        Row((*numbers, bool(valid)), None if valid else Verdict.UNDECIDED)
        for *numbers, valid in zip(*columns, to_numpy(contact.valid), strict=True)
    ]
    heads.append(Column.of_words("valid"))
    title = Sentence("{} on {}", contact.model.name, str(contact.joint))
    return Answer(title=title, tables=[Table("curve", "Curve", heads, rows)], notes=contact.notes)


def press_remarks(answered: PressAnswer) -> list[str]:
    """List sentences on the verdict, meshes, rings, assumptions, the end of a preload, and the pull-out force."""
    comparison, seconds = answered.comparison, answered.seconds
    remarks = [f"verdict by {answered.leading}: {design_verdict(answered)[1]}"]
    if JUDGE in comparison:
        contact: Any = comparison[JUDGE]  # with its limits, if its liner yields
        remarks.append(_mesh_remark(contact, seconds[JUDGE]))
        if contact.yields and contact.collapse_load == contact.collapse_load:
            collapse = Amount(float(contact.collapse_load), NEWTONS)
            remarks.append(Sentence(f"{JUDGE}: {YIELD_LIMITS['collapse_load'].title} {{}}", collapse))
    if OFF_AXIS in comparison:
        remarks.append(_sphere_remark(comparison[OFF_AXIS], seconds[OFF_AXIS]))
    remarks += answered.assumptions
    if answered.wear_depth_to_loosen is not None:
        depth = Amount(answered.wear_depth_to_loosen, MILLIMETRES)
        remarks.append(Sentence("uniform wear of the bore by {} ends the preload", depth))
    pulled = answered.pulled
    if pulled is not None and pulled.force >= 0.0:
        force, displacement = Amount(pulled.force, NEWTONS), Amount(pulled.displacement, MILLIMETRES)
        remarks.append(Sentence("pull-out force {}, {} out of the cup's centre", force, displacement))
    return [*remarks, *(() if pulled is None else pulled.notes)]


def design_verdict(answered: PressAnswer) -> tuple[Verdict, str]:
    """Return the verdict on all checks of the leading contact in its cup, and its sentence."""
    contact = answered.comparison[answered.leading]
    checks = checks_of(contact, answered.file.cup, float(contact.von_mises))
    verdict, sentence = verdict_of(checks)
    return verdict, "; ".join(filter(None, [sentence, unchecked_text(checks)]))


def _mesh_remark(contact: Any, seconds: float) -> str:
    """Return one line with the mesh, the time and the estimated errors of a contact."""
    if contact.status.failed or contact.indentation == 0:
        return f"{JUDGE}: {seconds:.2f} s"
    size, errors = contact.mesh, _error_text(contact)
    error = f": {errors}" if errors else " not estimated"
    element = Amount(size.element_size, MILLIMETRES, 3)
    text = f"{JUDGE}: {size.elements} elements, {{}} at the contact, {seconds:.2f} s; error of the mesh{error}"
    return Sentence(text, element)


def _sphere_remark(contact: Any, seconds: float) -> str:
    """Return one line with the place of the contact in its cup, the rings, the time and the estimated errors."""
    cost = f"rings of {degrees(contact.model.ring_width):.3g}°, {seconds:.2f} s"
    if contact.status.failed or contact.indentation == 0:
        return f"{OFF_AXIS}: {cost}"
    from .elasticity.off_axis.directions import polar_angle

    peak = "pressure unbounded there"
    if isfinite(contact.max_pressure):
        peak = f"largest pressure {degrees(polar_angle(contact.max_pressure_at)):.3g}° from the axis"
    position = f"load {degrees(contact.tilt):.3g}° from the cup's axis, {{}}, {peak}"
    error = f"error of the rings: {_error_text(contact)}"
    return Sentence(f"{OFF_AXIS}: {position}; {cost}; {error}", _rim_sentence(contact))


def _rim_sentence(contact: OffAxisContact) -> str:
    distance = Amount(abs(float(contact.edge_distance)), MILLIMETRES, decimals=1)
    if contact.edge_loaded and contact.joint.clearance < 0:
        return "contact up to the rim"
    verdict = rim_verdict(contact)
    if verdict is Verdict.EXCEEDED:
        return Sentence("contact cut off by {} at the rim", distance)
    near = ", less than its error bar: edge loading is undecided" if verdict is Verdict.UNDECIDED else ""
    return Sentence(f"contact {{}} from the rim{near}", distance)


def _error_text(contact: Contact) -> str:
    """Return the estimated relative errors of load, displacement, peak pressure and stiffness as text."""
    return ", ".join(
        f"{CONTACT[name].symbol} ±{100 * error:.1g} %"
        for name, error in contact.error.items()
        if name in (*LOADS, "max_pressure", "stiffness") and error > 1e-9
    )
