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
from ..core.display import counted
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES, Quantity
from ..core.unit_systems import Units
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
    "wear in 10⁶ cycles",
    "wear of a new bore in a million cycles",
    Kind.VOLUME,
    "Volume, from the first cycles of a hip.",
)
NAMES: Mapping[str, Quantity] = {
    **{name: QUANTITIES[name] for name in (*COMPUTED, "edge_distance")},
    TORQUE.name: TORQUE,
    WEAR.name: WEAR,
}
"""Numbers of a case, by name."""

LIMITED: Mapping[str, Quantity] = {**QUANTITIES, **PARAMETERS, **NAMES}  # quantities that can be limited, by name

KEYS: Mapping[str, Quantity] = {quantity.key: quantity for quantity in LIMITED.values()}
"""Quantities that can be limited, by their key in JSON."""

_WORST = ("max_pressure", "half_angle", "area", "utilisation", "edge_distance", TORQUE.name, WEAR.name)

Case = dict[str, float]  # values of the varied parameters, by name


@dataclass(frozen=True)
class MatrixRow:
    """Result of a case."""

    case: Case
    numbers: Mapping[str, float]  # computed numbers by name; NaN for a missing result
    errors: Mapping[str, float]  # known relative errors by name
    bars: Mapping[str, tuple[float, float]]  # lower and upper bound of the numbers with an error bar, by name
    status: str  # name of the status of the contact
    valid: bool  # True in the range of the model

    def with_wear(self, rate: float | None) -> MatrixRow:
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
    def of(summary: Mapping[str, Any]) -> MatrixRow:
        """Create a row from its summary."""

        def known(part: str, quantities: Mapping[str, Quantity] = NAMES) -> list[tuple[str, float, Any]]:
            return [
                (n, q.written.factor, summary[part][q.key]) for n, q in quantities.items() if q.key in summary[part]
            ]

        return MatrixRow(
            {name: value / factor for name, factor, value in known("case", PARAMETERS)},
            {name: numpy.nan if value is None else value / factor for name, factor, value in known("numbers")},
            {name: value for name, _, value in known("errors")},
            {name: (low / f, inf if high is None else high / f) for name, f, (low, high) in known("bars")},
            summary["status"],
            summary["valid"],
        )


def to_file_unit(quantity: Quantity, value: float) -> float | None:
    """Convert a number to the unit of files; None for a missing number."""
    return value * quantity.written.factor if isfinite(value) else None


def list_cases(question: Question) -> list[Case]:
    """Combine the values of all axes of a question; the last axis varies fastest."""
    return [dict(zip(question.axes, values, strict=True)) for values in product(*question.axes.values())]


def compute_rows(question: Question, cases: Sequence[Case]) -> list[MatrixRow]:
    """Compute several cases in one call."""
    values = {name: numpy.array([case[name] for case in cases]) for name in question.axes}
    joint, load, possible = press_arguments(question.file.joint, values)
    contact = question.model.press(joint, **load)
    if question.model.off_axis:
        edge_distance = error_bar(contact, EDGE_DISTANCE)
    else:  # a round contact under a vertical load
        angle, cup = error_bar(contact, "half_angle"), question.file.cup
        ends = (cup.edge_distance(joint.socket_radius, end, UP) for end in (angle.value, angle.high, angle.low))
        edge_distance = Bounded(*ends)
    numbers = {name: getattr(contact, name) for name in COMPUTED} | {EDGE_DISTANCE: edge_distance.value}
    if question.friction is not None and question.model.off_axis:  # an upper bound: the ball radius is every lever
        numbers[TORQUE.name] = question.friction * joint.ball_radius * contact.pressure_integral
    elif question.friction is not None:
        numbers[TORQUE.name] = contact.friction_torque(question.friction)
    bars = {**{name: error_bar(contact, name) for name in COMPUTED}, EDGE_DISTANCE: edge_distance}
    columns = {name: _column(value, cases) for name, value in numbers.items() if value is not None}
    errors = {name: _column(value, cases) for name, value in known_errors(contact).items() if name in NAMES}
    bounds = {name: (_column(bar.low, cases), _column(bar.high, cases)) for name, bar in bars.items()}
    status, valid, made = (_column(value, cases) for value in (contact.status, contact.valid, possible))
    return [
        MatrixRow(
            case,
            {name: float(value[i]) if made[i] else numpy.nan for name, value in columns.items()},
            {name: float(value[i]) for name, value in errors.items()},
            {name: (float(low[i]), float(high[i])) for name, (low, high) in bounds.items() if made[i]},
            Status(int(status[i]) if made[i] else Status.NO_JOINT).name,
            bool(valid[i] and made[i]),
        )
        for i, case in enumerate(cases)
    ]


def known_errors(contact: Contact) -> Mapping[str, Any]:
    """Return the relative errors that a solver reports, by quantity; otherwise its tolerance."""
    known: Mapping[str, Any] = contact.error
    tolerance = getattr(contact.model, "tolerance", None)
    return known if known or tolerance is None else dict.fromkeys(COMPUTED, tolerance)


def _column(value: Any, cases: Sequence[Case]) -> Numbers:
    return numpy.broadcast_to(to_numpy(value), len(cases))


def worst_rows(rows: Sequence[MatrixRow]) -> dict[str, MatrixRow]:
    """Find the worst row of each number, by name; numbers without a result are omitted."""
    worst = {}
    for name in _WORST:
        known = [row for row in rows if isfinite(row.numbers.get(name, numpy.nan))]
        if known:
            worst[name] = (min if name == EDGE_DISTANCE else max)(known, key=lambda row: row.numbers[name])
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
    row : MatrixRow or None
        Row with the smallest margin.
    missing : str
        Reason why the limited number is not known; empty if it is.
    """

    limit: Limit
    accuracy: float
    beyond: int
    unknown: int
    marginal: int
    row: MatrixRow | None
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
        parts = [f"{counted(count, 'case')} {words}" for words, count in counts.items() if count]
        return ", ".join(parts) if parts or self.row is not None else "no case has a result"

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON, with the units of files."""
        low, high = (to_file_unit(LIMITED[self.limit.name], end) for end in (self.limit.low, self.limit.high))
        return {
            "limit": str(self.limit),
            "name": self.limit.name,
            "low": low,
            "high": high,
            "verdict": self.verdict.word,
            "reason": self.reason,
            "beyond": self.beyond,
            "unknown": self.unknown,
            "near": self.marginal,
            "worst": None if self.row is None else self.row.summary(),
        }


def check_limit(limit: Limit, rows: Sequence[MatrixRow], accuracy: float, missing: str = "") -> LimitCheck:
    """Check a limit over the matrix; `missing` is the reason of an unknown number.

    A case is beyond the limit if the whole error bar of its number is. It keeps the limit if the bar does so, widened
    to the required relative accuracy, and if the result is valid.
    """
    numbers = []
    for row in rows:
        value = row.numbers.get(limit.name, row.case.get(limit.name, numpy.nan))
        numbers.append((value, *row.bars.get(limit.name, (value, value))))
    bars = Bounded(*numpy.array(numbers, dtype=float).reshape(-1, 3).T)
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


# Titles and texts of the record and the page


def title_of(name: str) -> str:
    """Return the title of a number by its name."""
    return "utilisation (von Mises stress over yield stress)" if name == "utilisation" else LIMITED[name].title


def number(value: Any) -> str:
    """Format a number with five digits, without an exponent below 1e9; a dash for None."""
    if value is None or isinstance(value, str):
        return value or "–"
    text = f"{value:.5g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e9 else text


def amount_text(quantity: Quantity, value: float | None, units: Units = Units.SI) -> str:
    """Write a number of the record, which is in the unit of files, with its unit."""
    unit = units.of_text(quantity.written.text)
    return f"{number(None if value is None else value * unit.factor)} {unit.text}".strip().replace(" °", "°")


def limit_text(limit: Mapping[str, Any], units: Units = Units.SI) -> str:
    """Format a limit with the title and the unit of its number: "largest pressure at most 15 MPa"."""
    quantity = KEYS.get(limit["name"]) or LIMITED[limit["name"]]
    words = {"low": "at least", "high": "at most"}.items()
    ends = [f"{word} {amount_text(quantity, limit[end], units)}" for end, word in words if limit[end] is not None]
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
