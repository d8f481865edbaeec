"""Matrix of cases: combined sizes, clearances, loads and orientations, the worst case of each number, and limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import inf, isfinite
from typing import Any

import numpy

from ..contact import Contact
from ..contact.verdict import EDGE_DISTANCE, Bounded, Verdict, error_bar
from ..core.arrays import Numbers, to_numpy
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES, Quantity
from ..core.validity import Status
from ..problem.cup import UP
from ..studies.limits import Limit
from ..studies.parameters import PARAMETERS, press_arguments
from .question import Question

COMPUTED = ("max_pressure", "half_angle", "area", "von_mises", "utilisation", "indentation", "force")
"""Quantities of the contact in every case, besides the edge distance and the friction torque."""

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
    **{name: QUANTITIES[name] for name in (*COMPUTED, "edge_distance")},
    TORQUE.name: TORQUE,
    WEAR.name: WEAR,
}
"""Numbers of a case, by name."""

LIMITED: Mapping[str, Quantity] = {**QUANTITIES, **PARAMETERS, **NAMES}
"""Quantities that can be limited, by name."""

KEYS: Mapping[str, Quantity] = {quantity.key: quantity for quantity in LIMITED.values()}
"""Quantities that can be limited, by their key in JSON."""

_SMALLEST_IS_WORST = ("edge_distance",)
_WORST = ("max_pressure", "half_angle", "area", "utilisation", "edge_distance", TORQUE.name, WEAR.name)

Case = dict[str, float]
"""Values of the varied parameters, by name."""


@dataclass(frozen=True)
class Row:
    """Result of a case.

    Attributes
    ----------
    case : dict of str to float
    numbers : mapping of str to float
        Computed numbers by name; NaN for a missing result.
    errors : mapping of str to float
        Known relative errors by name.
    bars : mapping of str to (float, float)
        Lower and upper bound of the numbers with an error bar, by name.
    status : str
        Name of the status of the contact.
    valid : bool
        True in the range of the model.
    """

    case: Case
    numbers: Mapping[str, float]
    errors: Mapping[str, float]
    bars: Mapping[str, tuple[float, float]]
    status: str
    valid: bool

    def with_wear(self, rate: float | None) -> Row:
        """Add the wear rate to the numbers of the row."""
        return replace(self, numbers={**self.numbers, WEAR.name: numpy.nan if rate is None else rate})

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON, with the units of files."""
        return {
            "case": {PARAMETERS[name].key: to_file_unit(PARAMETERS[name], value) for name, value in self.case.items()},
            "numbers": {NAMES[name].key: to_file_unit(NAMES[name], value) for name, value in self.numbers.items()},
            "errors": {NAMES[name].key: value for name, value in self.errors.items() if isfinite(value)},
            "bars": {
                NAMES[name].key: [to_file_unit(NAMES[name], end) for end in ends]
                for name, ends in self.bars.items()
                if isfinite(ends[0])
            },
            "status": self.status,
            "valid": self.valid,
        }

    @staticmethod
    def of(summary: Mapping[str, Any]) -> Row:
        """Create a row from its summary."""
        case, numbers, errors, bars = (summary[name] for name in ("case", "numbers", "errors", "bars"))
        return Row(
            {name: case[p.key] / p.written.factor for name, p in PARAMETERS.items() if p.key in case},
            {
                name: _to_internal_unit(quantity, numbers[quantity.key])
                for name, quantity in NAMES.items()
                if quantity.key in numbers
            },
            {name: errors[quantity.key] for name, quantity in NAMES.items() if quantity.key in errors},
            {
                name: (bars[quantity.key][0] / quantity.written.factor, _upper_bound(quantity, bars[quantity.key][1]))
                for name, quantity in NAMES.items()
                if quantity.key in bars
            },
            summary["status"],
            summary["valid"],
        )


def _to_internal_unit(quantity: Quantity, value: float | None) -> float:
    """Convert a number of a file to internal units; NaN for None."""
    return numpy.nan if value is None else value / quantity.written.factor


def _upper_bound(quantity: Quantity, value: float | None) -> float:
    """Convert an upper bound of a file to internal units; infinity for None."""
    return inf if value is None else value / quantity.written.factor


def to_file_unit(quantity: Quantity, value: float) -> float | None:
    """Convert a number to the unit of files; None for a missing number."""
    return value * quantity.written.factor if isfinite(value) else None


def list_cases(question: Question) -> list[Case]:
    """Combine the values of all axes of a question; the last axis varies fastest."""
    return [dict(zip(question.axes, values, strict=True)) for values in product(*question.axes.values())]


def compute_rows(question: Question, cases: Sequence[Case]) -> list[Row]:
    """Compute several cases in one call."""
    count = len(cases)
    values = {name: numpy.array([case[name] for case in cases]) for name in question.axes}
    joint, load, possible = press_arguments(question.file.joint, values)
    contact = question.model.press(joint, **load)
    numbers = {name: _column(value, count) for name, value in _contact_numbers(question, contact).items()}
    errors = {name: _column(value, count) for name, value in known_errors(contact).items() if name in NAMES}
    bars = {name: [_column(end, count) for end in bar[1:]] for name, bar in _error_bars(question, contact).items()}
    status, valid, made = (_column(value, count) for value in (contact.status, contact.valid, possible))
    return [
        Row(
            case,
            {name: float(value[i]) if made[i] else numpy.nan for name, value in numbers.items()},
            {name: float(value[i]) for name, value in errors.items()},
            {name: (float(low[i]), float(high[i])) for name, (low, high) in bars.items() if made[i]},
            Status(int(status[i]) if made[i] else Status.NO_JOINT).name,
            bool(valid[i] and made[i]),
        )
        for i, case in enumerate(cases)
    ]


def _contact_numbers(question: Question, contact: Contact) -> dict[str, Any]:
    """Return the numbers of a contact, by name."""
    numbers = {name: getattr(contact, name) for name in COMPUTED}
    numbers[EDGE_DISTANCE] = _edge_distance(question, contact).value
    if question.friction is not None:
        numbers[TORQUE.name] = _friction_torque(question, contact, question.friction)
    return {name: value for name, value in numbers.items() if value is not None}


def _edge_distance(question: Question, contact: Contact) -> Bounded:
    """Compute the edge distance in mm: of the off-axis contact, or of a round contact under a vertical load."""
    if question.model.off_axis:
        return error_bar(contact, EDGE_DISTANCE)
    angle, radius = error_bar(contact, "half_angle"), contact.joint.socket_radius
    return Bounded(*(question.file.cup.edge_distance(radius, end, UP) for end in (angle.value, angle.high, angle.low)))


def _error_bars(question: Question, contact: Contact) -> dict[str, Bounded]:
    """Return the numbers of a contact with their error bars, by name."""
    return {**{name: error_bar(contact, name) for name in COMPUTED}, EDGE_DISTANCE: _edge_distance(question, contact)}


def _friction_torque(question: Question, contact: Contact, friction: float) -> Any:
    """Compute the friction torque in N mm; off the axis an upper bound, with the ball radius as every lever."""
    if question.model.off_axis:
        return friction * contact.joint.ball_radius * contact.pressure_integral
    return contact.friction_torque(friction)


def known_errors(contact: Contact) -> Mapping[str, Any]:
    """Return the relative errors that a solver reports, by quantity; otherwise its tolerance."""
    known: Mapping[str, Any] = contact.error
    tolerance = getattr(contact.model, "tolerance", None)
    return known if known or tolerance is None else dict.fromkeys(COMPUTED, tolerance)


def _column(value: Any, count: int) -> Numbers:
    """Broadcast a number to all cases."""
    return numpy.broadcast_to(to_numpy(value), count)


def worst_rows(rows: Sequence[Row]) -> dict[str, Row]:
    """Find the worst row of each number, by name; numbers without a result are omitted."""
    worst = {}
    for name in _WORST:
        known = [row for row in rows if isfinite(row.numbers.get(name, numpy.nan))]
        if known:
            worst[name] = (min if name in _SMALLEST_IS_WORST else max)(known, key=lambda row: row.numbers[name])
    return worst


@dataclass(frozen=True)
class LimitCheck:
    """Result of the check of a limit over the matrix.

    Attributes
    ----------
    limit : Limit
    accuracy : float
        Required relative accuracy.
    beyond, unknown, marginal : int
        Number of cases outside the limit, without a result, and closer to the limit than their error bar or the
        required accuracy.
    row : Row or None
        Row with the smallest margin.
    missing : str
        Reason why the limited number is not known; empty if it is.
    """

    limit: Limit
    accuracy: float
    beyond: int
    unknown: int
    marginal: int
    row: Row | None
    missing: str = ""

    @property
    def verdict(self) -> Verdict:
        """Verdict on all cases together."""
        if self.beyond:
            return Verdict.EXCEEDED
        return Verdict.UNDECIDED if self.unknown or self.marginal or self.row is None else Verdict.KEPT

    @property
    def reason(self) -> str:
        """Numbers of cases that do not keep the limit, in words, or the missing strength; empty if it is kept."""
        if self.missing and not self.beyond:
            return self.missing
        counts = {
            "beyond the limit": self.beyond,
            f"nearer than the error bar or the required accuracy of {100 * self.accuracy:.3g} %": self.marginal,
            "without a valid result": self.unknown,
        }
        parts = [f"{count} case{'s' * (count > 1)} {words}" for words, count in counts.items() if count]
        return ", ".join(parts) if parts or self.row is not None else "no case has a result"

    def _in_file_unit(self, end: float) -> float | None:
        """Convert an end of the limit to the unit of files."""
        return to_file_unit({**PARAMETERS, **NAMES, **QUANTITIES}[self.limit.name], end)

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {
            "limit": str(self.limit),
            "name": self.limit.name,
            "low": self._in_file_unit(self.limit.low),
            "high": self._in_file_unit(self.limit.high),
            "verdict": self.verdict.word,
            "reason": self.reason,
            "beyond": self.beyond,
            "unknown": self.unknown,
            "near": self.marginal,
            "worst": None if self.row is None else self.row.summary(),
        }


def check_limit(limit: Limit, rows: Sequence[Row], accuracy: float, missing: str = "") -> LimitCheck:
    """Check a limit over the matrix; `missing` is the reason of an unknown number.

    A case is beyond the limit if the whole error bar of its number is. It keeps the limit if the bar does so, widened
    to the required relative accuracy, and if the result is valid.
    """
    bars = Bounded(*numpy.array([_limited_number(limit, row) for row in rows], dtype=float).reshape(-1, 3).T)
    widened = Bounded(
        bars.value,
        numpy.minimum(bars.low, bars.value - accuracy * abs(bars.value)),
        numpy.maximum(bars.high, bars.value + accuracy * abs(bars.value)),
    )
    computed = numpy.array([limit.name in row.numbers for row in rows], dtype=bool)
    valid = numpy.array([row.valid for row in rows], dtype=bool) | ~computed
    exceeded = bars.decide(**limit.ends) == Verdict.EXCEEDED
    kept = numpy.where(computed, widened.decide(**limit.ends), bars.decide(**limit.ends)) == Verdict.KEPT
    known = numpy.isfinite(bars.value)
    margin = numpy.minimum(bars.value - limit.low, limit.high - bars.value)
    order = numpy.where(known, margin, numpy.inf)
    return LimitCheck(
        limit=limit,
        accuracy=accuracy,
        beyond=int(exceeded.sum()),
        unknown=int((~exceeded & ~(known & valid)).sum()),
        marginal=int((known & valid & ~exceeded & ~kept).sum()),
        row=rows[int(order.argmin())] if known.any() else None,
        missing=missing,
    )


def _limited_number(limit: Limit, row: Row) -> Bounded:
    """Return the limited number of a row with its error bar, or the parameter of its case."""
    value = float(row.numbers.get(limit.name, row.case.get(limit.name, numpy.nan)))
    return Bounded(value, *row.bars.get(limit.name, (value, value)))


# Titles and texts of the record and the page

_LARGEST_INTEGER = 1e9
_LONG_TITLES = {"utilisation": "utilisation (von Mises stress over yield stress)"}
_LIMIT_ENDS = (("low", "at least"), ("high", "at most"))


def title_of(name: str) -> str:
    """Return the title of a number by its name."""
    return _LONG_TITLES.get(name) or LIMITED[name].title


def number(value: Any) -> str:
    """Format a number with five digits, without an exponent below 1e9; a dash for None."""
    if value is None or isinstance(value, str):
        return value or "–"
    text = f"{value:.5g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < _LARGEST_INTEGER else text


def limit_text(limit: Mapping[str, Any]) -> str:
    """Format a limit with the title and the unit of its number: "largest pressure at most 15 MPa"."""
    quantity = KEYS.get(limit["name"]) or LIMITED[limit["name"]]
    unit = quantity.written.text
    ends = [f"{word} {number(limit[end])} {unit}".strip() for end, word in _LIMIT_ENDS if limit[end] is not None]
    return f"{title_of(limit['name'])} {' and '.join(ends)}"


def verdict_text(limit: Mapping[str, Any]) -> str:
    """Write the verdict on a limit with its reason: "undecided: 2 cases without a valid result"."""
    return f"{limit['verdict']}: {limit['reason']}" if limit["reason"] else str(limit["verdict"])


def input_title(name: str) -> str:
    """Return the title of an input by its name.

    Examples
    --------
    >>> input_title("liner_young"), input_title("backing[0].thickness")
    ("Young's modulus of the liner", 'thickness of layer 1 behind the liner')
    """
    if name == "friction.coefficient":
        return "coefficient of friction"
    layer, _, inside = name.rpartition(".")
    if layer:
        index = int(layer.removeprefix("backing[").removesuffix("]")) + 1
        return f"{LIMITED[inside].title} of layer {index} behind the liner"
    part, _, strength = name.partition("_")
    return LIMITED[name].title if name in LIMITED else f"{LIMITED[strength].title} of the {part}"
