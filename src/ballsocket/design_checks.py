"""Checks of a design: each demand compared with its capacity, and the verdict on all of them.

Every door shows the same checks::

    rows = checks_of(contact, cup)                                         # a contact of any model in its cup
    rows = checks_at(joint, pressure=pressure, von_mises=stress)           # bars of a cycle or of a worn bore
    verdict, sentence = verdict_of(rows)
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import nextafter
from typing import Any

from .contact import Contact
from .contact.strength import unchecked_strength_reason
from .contact.verdict import EDGE_DISTANCE, Bounded, Verdict, ball_von_mises, error_bar, exact_number, ratio_text
from .core.answers import Check
from .core.quantities import QUANTITIES, SHAKEDOWN_WORK, STRENGTH
from .core.validity import Status
from .problem import Joint, Material
from .problem.cup import Cup

_PRESSURE, _VON_MISES = "allowable_pressure", "yield_stress"


def checks_of(contact: Contact, cup: Cup, von_mises: float | None = None) -> tuple[Check, ...]:
    """List the checks of a single contact in its cup, the highest ratio first.

    A contact without a result has none, but the check of a force beyond the collapse load of a liner that yields.
    A contact of a model along the axis ends at its half angle from the pole. `von_mises` is the largest von Mises
    stress in the liner in MPa, if it is solved for already; by default the `quick_von_mises`.
    """
    is_forced = contact.yields and float(contact.force) > 0
    if contact.status.failed:
        may_collapse = is_forced and contact.status is Status.NOT_REACHED
        return tuple(row for row in _yield_checks(contact) if row.verdict is Verdict.EXCEEDED) if may_collapse else ()
    joint, radius = contact.joint, float(contact.joint.socket_radius)
    reach_of: Any = getattr(contact.model, "reach_of", None)
    if reach_of is not None:  # a load off the axis
        reach, distance = float(reach_of(joint)), error_bar(contact, EDGE_DISTANCE)
    else:
        reach = cup.rim - cup.chamfer / radius
        value, low, high = error_bar(contact, "half_angle")
        distance = Bounded(*(radius * (reach - angle) for angle in (value, high, low)))
    rows = checks_at(
        joint,
        pressure=error_bar(contact, "max_pressure"),
        von_mises=error_bar(contact, "quick_von_mises" if von_mises is None else "von_mises"),
        edge=(reach, distance) if float(contact.half_angle) > 0 else None,
        trusted=bool(contact.valid),
    )
    if not is_forced:
        return rows
    yielding = ("liner", STRENGTH[_VON_MISES].title)  # its stress does not exceed the hardening curve
    return sorted_checks([*(row for row in rows if (row.part, row.limit) != yielding), *_yield_checks(contact)])


def checks_at(
    joint: Joint,
    *,
    pressure: Bounded,
    von_mises: Bounded,
    edge: tuple[float, Bounded] | None = None,
    trusted: bool = True,
) -> tuple[Check, ...]:
    """List the checks of a joint for the numbers of a contact, the highest ratio first.

    It takes the largest pressure and the largest von Mises stress in the liner in MPa; for a rim the angle in rad from
    the pole of the dome to the end of the bore, and the edge distance in mm; and if the numbers lie in the range of
    their model.
    """
    rows = list(_material_checks("liner", joint.liner, pressure, von_mises, trusted))
    if joint.ball is not None:
        ball_stress = ball_von_mises(joint, pressure)
        rows += (row for row in _material_checks("ball", joint.ball, pressure, ball_stress, trusted) if row.capacity)
    if edge is not None and not float(joint.clearance) < 0:  # a preloaded contact reaches the rim as a rule
        reach, distance = edge
        length = reach * float(joint.socket_radius)
        rim = Check(
            title="reach of the contact",
            quantity=EDGE_DISTANCE,
            demand=Bounded(*(length - float(arc) for arc in (distance.value, distance.high, distance.low))),
            capacity=nextafter(length, 0.0),  # a contact that ends at the rim is edge loaded
            limit="arc from pole to rim",
            source="arc of cover and chamfer of the cup",
            trusted=trusted,
        )
        rows.append(rim)
    return sorted_checks(rows)


def sorted_checks(rows: Iterable[Check]) -> tuple[Check, ...]:
    """Sort checks by their ratio, the highest first and unknown ones last."""
    return tuple(sorted(rows, key=lambda row: -1.0 if row.ratio is None else row.ratio.value, reverse=True))


def wear_check(joint: Joint, depth: Bounded) -> Check:
    """Compare the deepest wear (mm) with the thickness of the liner."""
    return Check(
        title="deepest wear",
        quantity="liner_thickness",
        demand=depth,
        capacity=float(joint.liner_thickness),
        limit="liner thickness",
        source="at this depth the liner is worn through",
    )


def _material_checks(
    part: str, material: Material, pressure: Bounded, stress: Bounded, trusted: bool
) -> Iterator[Check]:
    """Yield the checks of one body: pressure and von Mises stress, known capacity or not, and further strengths."""
    strengths = {_PRESSURE: None, _VON_MISES: None, **material.strengths}
    for name, capacity in strengths.items():
        is_pressure, title = name == _PRESSURE, STRENGTH[name].title
        parts = map(str.strip, material.source.split(";"))  # a material names the sources of its limits one by one
        source = next((text for text in parts if text.startswith(title.split()[0])), "value of the input")
        if capacity is None:
            source = f"no {title} of the {part} is known"
        elif material.name:
            source = f"{material.name}, {source}"
        yield Check(
            title=f"{'pressure on' if is_pressure else 'von Mises stress in'} the {part}",
            quantity="max_pressure" if is_pressure else "von_mises",
            demand=pressure if is_pressure else stress,
            capacity=None if capacity is None else float(capacity),
            limit=title,
            source=source,
            trusted=trusted,
            part=part,
        )


def _yield_checks(contact: Any) -> Iterator[Check]:
    """Yield the checks of a liner that yields: its force, and the plastic work of the repeated load."""
    force = exact_number(float(contact.force)) if contact.status.failed else error_bar(contact, "force")
    work, source = error_bar(contact, "repeated_work"), "a socket that shakes down is elastic from then on"
    for name, demand, capacity, limit, origin in (
        ("force", force, float(contact.collapse_load), "collapse load", "largest force with an equilibrium"),
        ("repeated_work", work, SHAKEDOWN_WORK, "limit of shakedown", source),
    ):
        yield Check(
            title=QUANTITIES[name].title,
            quantity=name,
            demand=demand,
            capacity=capacity,
            limit=limit,
            source=origin,
            trusted=bool(contact.valid),
        )


def verdict_of(rows: Sequence[Check]) -> tuple[Verdict, str]:
    """Return the verdict on a design and its sentence; undecided without a strength of the liner."""
    kept, undecided, exceeded = ([row for row in rows if row.verdict is verdict] for verdict in Verdict)
    if exceeded:
        return Verdict.EXCEEDED, f"Exceeded: {_uses(exceeded)}"
    if not rows:
        return Verdict.UNDECIDED, "Undecided: there is no result"
    if not all(row.trusted for row in rows):
        return Verdict.UNDECIDED, "Undecided: this result is outside the range of its model"
    near = [row for row in undecided if row.capacity is not None]
    if near:
        return Verdict.UNDECIDED, f"Undecided: {_uses(near)}"
    if not any(row.quantity in ("max_pressure", "von_mises", "force") for row in kept):
        return Verdict.UNDECIDED, f"Undecided: {'; '.join(row.source for row in undecided)}"
    near_limit = ", near the limit" if kept[0].is_near else ""
    return Verdict.KEPT, f"Kept{near_limit}: {_uses(kept[:1])}, the highest ratio"


def unchecked_text(rows: Sequence[Check]) -> str:
    """List the demands without a known limit, such as "not checked: pressure on the liner"; empty without one."""
    titles = ", ".join(row.title for row in rows if row.capacity is None)
    return f"not checked: {titles}" if titles else ""


def _uses(rows: Sequence[Check]) -> str:
    """Write the ratios of checks in words, such as "pressure on the liner is 81 % of the allowable pressure"."""
    return "; ".join(f"{row.title} is {_ratio_text(row)} the {row.limit}" for row in rows)


@dataclass(frozen=True, kw_only=True)
class StrengthVerdict:
    """Verdict on the strength of a contact, with its reason.

    Attributes
    ----------
    verdict : Verdict
        Kept below all strengths, exceeded above one of them. Undecided if an error bar contains a strength, without a
        valid result, or without a strength of the liner.
    words : str
        Reason in one sentence.
    check : Check or None
        Comparison that decides; None without a valid result, or without a strength of the liner.
    """

    verdict: Verdict
    words: str
    check: Check | None = None


def strength_checks(contact: Contact) -> tuple[Check, ...]:
    """Compare the stresses of a single contact with all strengths of its materials, the highest ratio first."""
    joint, pressure = contact.joint, error_bar(contact, "max_pressure")
    von_mises = error_bar(contact, "von_mises") if joint.liner.strengths else exact_number(0.0)
    return tuple(row for row in checks_at(joint, pressure=pressure, von_mises=von_mises) if row.capacity is not None)


def assess_strength(contact: Contact) -> StrengthVerdict:
    """Decide if the stresses of a single contact are below the strengths of its materials.

    Parameters
    ----------
    contact : Contact
        Contact of one joint under one load.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.design_checks import assess_strength
    >>> assess_strength(bs.Exact().press(bs.joints["hip-36"], force=2000.0)).verdict.word
    'kept'
    """
    checks = () if contact.status.failed else strength_checks(contact)
    worst = max(checks, key=lambda row: row.verdict, default=None)  # the first one has the highest ratio
    if worst is not None and (worst.verdict is Verdict.EXCEEDED or (contact.valid and contact.joint.liner.strengths)):
        words = f"{worst.verdict.word}: {_ratio_text(worst)} the {worst.limit} of the {worst.part}"
        return StrengthVerdict(verdict=worst.verdict, words=words, check=worst)
    if contact.status.failed:
        reason = f"no answer: {contact.status.sentence}"
    elif not contact.valid:
        reason = f"result not valid: {'; '.join(contact.notes)}"
    else:
        reason = unchecked_strength_reason(contact.joint)
    return StrengthVerdict(verdict=Verdict.UNDECIDED, words=f"undecided: {reason}")


def _ratio_text(row: Check) -> str:
    return "" if row.ratio is None else ratio_text(row.ratio)


def strength_lines(contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Yield the verdicts on single contacts by name on each strength that decides, one line for each strength."""
    verdicts: dict[str, list[str]] = {}
    for name, contact in contacts.items():
        strength = assess_strength(contact)
        if strength.check is not None:
            words = f"{name} {strength.verdict.word}, {_ratio_text(strength.check).removesuffix(' of')}"
            verdicts.setdefault(f"{strength.check.limit} of the {strength.check.part}", []).append(words)
    yield from (f"{title}: {'; '.join(words)}" for title, words in verdicts.items())
