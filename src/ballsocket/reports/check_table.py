"""Table of checks of a design: each demand beside its capacity, with ratio, verdict and source.

Reports and the explorer show the same rows::

    rows = checks_of(contact, cup)                            # a contact of any model in its cup
    rows = checks_at(joint, pressure=30.1, half_angle=0.6)    # numbers of a cycle or of a worn bore
    html = checks_html(rows, units.text_of)                   # or reading.with_unit in the explorer
    passes, sentence = verdict_of(rows)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..contact import Contact
from ..contact.strength import joint_ball_stress_ratio, von_mises_ratio
from ..core.quantities import QUANTITIES, STRENGTH, Quantity
from ..elasticity.off_axis.contact import OffAxisContact
from ..problem import Joint, Material
from ..problem.cup import Cup
from .pages import render_part

Writer = Callable[[Quantity, float], str]
"""Function that writes a number in internal units with its unit: `Units.text_of`, or `Reading.with_unit`."""

_PRESSURE, _VON_MISES = "allowable_pressure", "yield_stress"


@dataclass(frozen=True, kw_only=True)
class Check:
    """Comparison of one demand on a joint with its capacity; plain data, which a process can return.

    Attributes
    ----------
    title : str
        Demand in words, such as "pressure on the liner".
    quantity : str
        Name of the quantity of demand and capacity in `QUANTITIES`.
    demand : float
        Value in internal units: mm, MPa, rad.
    capacity : float or None
        Largest acceptable value; None if it is unknown.
    limit : str
        Capacity in words, such as "allowable pressure".
    source : str
        Origin of the capacity, or the input that is missing.
    trusted : bool
        True if the demand lies in the range of its model.
    """

    title: str
    quantity: str
    demand: float
    capacity: float | None
    limit: str
    source: str
    trusted: bool = True

    @property
    def ratio(self) -> float | None:
        """Ratio of demand to capacity; None without a capacity."""
        return None if self.capacity is None else self.demand / self.capacity

    @property
    def passes(self) -> bool | None:
        """True below the capacity; None without a capacity, and for a passing demand outside the range of its model."""
        if self.ratio is None or self.ratio != self.ratio:
            return None
        return False if self.ratio >= 1 else True if self.trusted else None


def checks_of(contact: Contact, cup: Cup, von_mises: float | None = None) -> tuple[Check, ...]:
    """List the checks of a single contact in its cup, the highest ratio first.

    Parameters
    ----------
    contact : Contact
        Contact of any model; one along the axis ends at its half angle from the pole.
    cup : Cup
    von_mises : float, optional
        Largest von Mises stress in the liner in MPa; by default the estimate from half angle and pressure.

    Returns
    -------
    tuple of Check
        Empty for a contact without a result.
    """
    if contact.status.failed:
        return ()
    joint, radius = contact.joint, float(contact.joint.socket_radius)
    if isinstance(contact, OffAxisContact):
        reach, distance = float(contact.model.reach_of(joint)), float(contact.edge_distance)
    else:
        reach = cup.rim - cup.chamfer / radius
        distance = radius * (reach - float(contact.half_angle))
    return checks_at(
        joint,
        pressure=float(contact.max_pressure),
        half_angle=float(contact.half_angle),
        von_mises=von_mises,
        edge=(reach, distance),
        trusted=bool(contact.valid),
    )


def checks_at(
    joint: Joint,
    *,
    pressure: float,
    half_angle: float,
    von_mises: float | None = None,
    edge: tuple[float, float] | None = None,
    trusted: bool = True,
) -> tuple[Check, ...]:
    """List the checks of a joint for the numbers of a contact, the highest ratio first.

    Parameters
    ----------
    joint : Joint
    pressure, half_angle : float
        Largest pressure in MPa, half angle in rad.
    von_mises : float, optional
        Largest von Mises stress in the liner in MPa; by default the estimate from half angle and pressure.
    edge : tuple of float, optional
        Angle in rad from the pole of the dome to the end of the bore, and edge distance in mm.
    trusted : bool
        True if the numbers lie in the range of their model.
    """
    estimate = float(von_mises_ratio(half_angle, joint.liner.poisson, joint.thickness_ratio)) * pressure
    stress = estimate if von_mises is None else von_mises
    rows = list(_material_checks("liner", joint.liner, pressure, stress, trusted))
    if von_mises is None:
        rows = [replace(row, source=row.source + _ESTIMATED) if _is_stress(row) else row for row in rows]
    if joint.ball is not None:
        ball_stress = float(joint_ball_stress_ratio(joint)) * pressure
        rows += (row for row in _material_checks("ball", joint.ball, pressure, ball_stress, trusted) if row.capacity)
    if edge is not None and not float(joint.clearance) < 0:  # a preloaded contact reaches the rim as a rule
        rows.append(_rim_check(joint, *edge, trusted))
    return sorted_checks(rows)


_ESTIMATED = "; stress estimated from pressure and half angle"


def _is_stress(row: Check) -> bool:
    return row.quantity == "von_mises" and row.capacity is not None


def sorted_checks(rows: Iterable[Check]) -> tuple[Check, ...]:
    """Sort checks by their ratio, the highest first and unknown ones last."""
    return tuple(sorted(rows, key=lambda row: -1.0 if row.ratio is None else row.ratio, reverse=True))


def wear_check(joint: Joint, depth: float) -> Check:
    """Compare the deepest wear (mm) with the thickness of the liner."""
    return Check(
        title="deepest wear",
        quantity="liner_thickness",
        demand=depth,
        capacity=float(joint.liner_thickness),
        limit="liner thickness",
        source="at this depth the liner is worn through",
    )


def _material_checks(part: str, material: Material, pressure: float, stress: float, trusted: bool) -> Iterator[Check]:
    """Yield the checks of one body: pressure and von Mises stress, known capacity or not, and further strengths."""
    strengths = {_PRESSURE: None, _VON_MISES: None, **material.strengths}
    for name, capacity in strengths.items():
        is_pressure, title = name == _PRESSURE, STRENGTH[name].title
        yield Check(
            title=f"{'pressure on' if is_pressure else 'von Mises stress in'} the {part}",
            quantity="max_pressure" if is_pressure else "von_mises",
            demand=pressure if is_pressure else stress,
            capacity=None if capacity is None else float(capacity),
            limit=title,
            source=f"no {title} of the {part} is known" if capacity is None else _source_of(material, title),
            trusted=trusted,
        )


def _source_of(material: Material, title: str) -> str:
    """Return the source of one limit of a material: its part of the sources, else its name alone."""
    parts = (part.strip() for part in material.source.split(";"))
    source = next((part for part in parts if part.startswith(title.split()[0])), "value of the input")
    return f"{material.name}, {source}" if material.name else source


def _rim_check(joint: Joint, reach: float, distance: float, trusted: bool) -> Check:
    """Compare the arc from the pole to the edge of the contact with the arc to the end of the bore."""
    length = reach * float(joint.socket_radius)
    return Check(
        title="reach of the contact",
        quantity="edge_distance",
        demand=length - distance,
        capacity=length,
        limit="arc from pole to rim",
        source="arc of cover and chamfer of the cup",
        trusted=trusted,
    )


def verdict_of(rows: Sequence[Check]) -> tuple[bool | None, str]:
    """Return the verdict on a design and its sentence; None without a strength of the liner or outside the range."""
    failed = [row for row in rows if row.passes is False]
    if failed:
        worst = "; ".join(f"{row.title} is {_use(row)} the {row.limit}" for row in failed)
        return False, f"Fails: {worst}"
    if not rows:
        return None, "No verdict: there is no result"
    if not all(row.trusted for row in rows):
        return None, "No verdict: this result is outside the range of its model"
    unknown = [row for row in rows if row.passes is None]
    if not any(row.passes and row.quantity in ("max_pressure", "von_mises") for row in rows):
        return None, f"No verdict: {'; '.join(row.source for row in unknown)}"
    highest = next(row for row in rows if row.passes)
    unchecked = f". Not checked: {', '.join(row.title for row in unknown)}" if unknown else ""
    return True, f"Passes: {highest.title} is {_use(highest)} the {highest.limit}, the highest ratio{unchecked}"


def _use(row: Check) -> str:
    """Write the ratio of a check in words, such as "81 % of" or "1.4 times"."""
    ratio = row.ratio or 0.0
    return f"{100 * ratio:.0f} % of" if ratio <= 1 else f"{ratio:.3g} times"


_STATES = {True: ("passes", "✓ passes"), False: ("fails", "✗ fails"), None: ("unknown", "? not known")}
"""Style and words of a result."""


def checks_html(rows: Sequence[Check], write: Writer) -> str:
    """Render checks as a table in HTML, with sign, word and style of each result; narrow pages stack its cells."""
    return render_part("parts.html", "checks", [_cells(row, write) for row in rows])


def _cells(row: Check, write: Writer) -> dict[str, Any]:
    """Return the texts of one row of the table."""
    quantity = QUANTITIES[row.quantity]
    state, words = _STATES[row.passes]
    outside = row.passes is None and row.ratio is not None
    return {
        "title": row.title,
        "demand": write(quantity, row.demand),
        "capacity": "–" if row.capacity is None else f"{write(quantity, row.capacity)} ({row.limit})",
        "ratio": "–" if row.ratio is None else f"{100 * row.ratio:.0f} %",
        "width": f"{min(100.0, 100 * (row.ratio or 0.0)):.1f}",
        "state": state,
        "result": "? outside the range of the model" if outside else words,
        "source": row.source,
    }
