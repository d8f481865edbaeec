"""The worst-case matrix: sizes, clearances, loads, orientations combined, and where each number is worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import isfinite
from typing import Any

import numpy

from ..contact import Contact
from ..core.arrays import Numbers, to_numpy
from ..core.deprecation import renamed_names
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES, Quantity
from ..core.validity import Status
from ..problem.cup import UP
from ..studies.limits import Limit
from ..studies.parameters import PARAMETERS, press_arguments
from .question import Question

ANSWERED = ("max_pressure", "half_angle", "area", "von_mises", "utilisation", "indentation", "force")
"""What every case is asked for, beside the edge distance and the friction torque."""

TORQUE = Quantity(
    "friction_torque", "Mf", "friction torque", Kind.ENERGY, "About an axis across the load, sliding all over, in N mm."
)
WEAR = Quantity(
    "wear_rate",
    "wear [mm³/10⁶]",
    "wear of a new bore, mm³ a million cycles",
    Kind.NUMBER,
    "Volume, in the first cycles of a hip.",
)
NAMES: Mapping[str, Quantity] = {
    **{name: QUANTITIES[name] for name in (*ANSWERED, "edge_distance")},
    TORQUE.name: TORQUE,
    WEAR.name: WEAR,
}
LEAST = ("edge_distance",)
"""What is worst where it is smallest."""

_WORST = ("max_pressure", "half_angle", "area", "utilisation", "edge_distance", TORQUE.name, WEAR.name)

Case = dict[str, float]


@dataclass(frozen=True)
class Row:
    """One case: its parameters, what was answered (NaN where nothing was), and how it went."""

    case: Case
    numbers: Mapping[str, float]
    errors: Mapping[str, float]
    status: str
    valid: bool

    def with_wear(self, rate: float | None) -> Row:
        """The row with its wear beside the other numbers."""
        return replace(self, numbers={**self.numbers, WEAR.name: numpy.nan if rate is None else rate})

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, with the units of files."""
        return {
            "case": {PARAMETERS[name].key: written(PARAMETERS[name], value) for name, value in self.case.items()},
            "numbers": {NAMES[name].key: written(NAMES[name], value) for name, value in self.numbers.items()},
            "errors": {NAMES[name].key: value for name, value in self.errors.items() if isfinite(value)},
            "status": self.status,
            "valid": self.valid,
        }

    @staticmethod
    def of(summary: Mapping[str, Any]) -> Row:
        """A row from its summary."""
        return Row(
            {
                name: summary["case"][each.key] / each.written.factor
                for name, each in PARAMETERS.items()
                if each.key in summary["case"]
            },
            {
                name: _read(each, summary["numbers"].get(each.key))
                for name, each in NAMES.items()
                if each.key in summary["numbers"]
            },
            {name: summary["errors"][each.key] for name, each in NAMES.items() if each.key in summary["errors"]},
            summary["status"],
            summary["valid"],
        )


def _read(quantity: Quantity, value: float | None) -> float:
    return numpy.nan if value is None else value / quantity.written.factor


def written(quantity: Quantity, value: float) -> float | None:
    """A number in the unit of files; None where it is missing."""
    return value * quantity.written.factor if isfinite(value) else None


def cases(question: Question) -> list[Case]:
    """Every combination, the last axis fastest."""
    return [dict(zip(question.axes, values, strict=True)) for values in product(*question.axes.values())]


def rows(question: Question, those: Sequence[Case]) -> list[Row]:
    """Some cases, answered all at once."""
    values = {name: numpy.array([case[name] for case in those]) for name in question.axes}
    joint, load, possible = press_arguments(question.file.joint, values)
    contact = question.model.press(joint, **load)
    found = {name: _column(value, len(those)) for name, value in _numbers(question, contact, load).items()}
    bars = {name: _column(value, len(those)) for name, value in known_errors(contact).items() if name in NAMES}
    status, valid = _column(contact.status, len(those)), _column(contact.valid, len(those))
    made = numpy.broadcast_to(to_numpy(possible), len(those))
    return [
        Row(
            case,
            {name: float(value[at]) if made[at] else numpy.nan for name, value in found.items()},
            {name: float(value[at]) for name, value in bars.items()},
            Status(int(status[at]) if made[at] else Status.NO_JOINT).name,
            bool(valid[at] and made[at]),
        )
        for at, case in enumerate(those)
    ]


def _numbers(question: Question, contact: Contact, load: Mapping[str, Any]) -> dict[str, Any]:
    found = {name: getattr(contact, name) for name in ANSWERED}
    found["edge_distance"] = _edge_distance(question, contact)
    if question.friction is not None:
        found[TORQUE.name] = _torque(question, contact, question.friction)
    return {name: value for name, value in found.items() if value is not None}


def _edge_distance(question: Question, contact: Contact) -> Any:
    """To the rim: of the contact as it is pressed off the axis, or of a round one under a vertical load."""
    if question.model.off_axis:
        return contact.edge_distance  # type: ignore[attr-defined]
    return question.file.cup.edge_distance(contact.joint.socket_radius, contact.half_angle, UP)


def _torque(question: Question, contact: Contact, friction: float) -> Any:
    """Off the axis the lever of every pressure is taken as the ball's radius, which is its most."""
    if question.model.off_axis:
        return friction * contact.joint.ball_radius * contact.pressure_integral
    return contact.friction_torque(friction)


def known_errors(contact: Contact) -> Mapping[str, Any]:
    """Relative errors that a solver knows of its answer, by quantity; a tolerance where it keeps one."""
    known: Mapping[str, Any] = getattr(contact, "error", None) or {}
    tolerance = getattr(contact.model, "tolerance", None)
    return known if known or tolerance is None else dict.fromkeys(ANSWERED, tolerance)


def _column(value: Any, count: int) -> Numbers:
    return numpy.broadcast_to(to_numpy(value), count)


def worst(found: Sequence[Row]) -> dict[str, Row]:
    """Where each of the numbers is worst, by its name; those that no case answers are left out."""
    places = {}
    for name in _WORST:
        known = [row for row in found if isfinite(row.numbers.get(name, numpy.nan))]
        if known:
            places[name] = (min if name in LEAST else max)(known, key=lambda row: row.numbers[name])
    return places


@dataclass(frozen=True)
class LimitCheck:
    """How a limit is kept over the matrix.

    Attributes
    ----------
    limit : Limit
    beyond, unknown, near : int
        Cases outside it, without an answer, and nearer to its end than the numbers may be off.
    row : Row or None
        The case that is worst.
    """

    limit: Limit
    beyond: int
    unknown: int
    near: int
    row: Row | None

    @property
    def verdict(self) -> str:
        """In words."""
        if self.beyond:
            return "not kept"
        if self.unknown or self.row is None:
            return "not known"
        return "kept, but nearer than the required accuracy" if self.near else "kept"

    def _end(self, end: float) -> float | None:
        return written({**PARAMETERS, **NAMES, **QUANTITIES}[self.limit.name], end)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "limit": str(self.limit),
            "name": self.limit.name,
            "low": self._end(self.limit.low),
            "high": self._end(self.limit.high),
            "verdict": self.verdict,
            "beyond": self.beyond,
            "unknown": self.unknown,
            "near": self.near,
            "worst": None if self.row is None else self.row.summary(),
        }


def kept(limit: Limit, found: Sequence[Row], accuracy: float) -> LimitCheck:
    """How a limit is kept, where numbers may be off by a share of themselves."""
    values = numpy.array([_limited(limit, row) for row in found], dtype=float)
    margin = numpy.minimum(values - limit.low, limit.high - values)
    known = numpy.isfinite(values)
    order = numpy.where(known, margin, numpy.inf)
    return LimitCheck(
        limit=limit,
        beyond=int((known & (margin < 0)).sum()),
        unknown=int((~known).sum()),
        near=int((known & (margin >= 0) & (margin < accuracy * abs(values))).sum()),
        row=found[int(order.argmin())] if known.any() else None,
    )


def _limited(limit: Limit, row: Row) -> float:
    return float(row.numbers.get(limit.name, row.case.get(limit.name, numpy.nan)))


__getattr__ = renamed_names(__name__, {"Kept": "LimitCheck"})
