"""Limits as rows of a quantity, at most or at least, and a value, for every view that has limits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from math import isfinite, nan
from typing import Any

from ...contact import Contact
from ...core.checks import check_names, require, shown
from ...core.quantities import CONTACT, JOINT, PARTS, QUANTITIES
from ...files.joint_file import JointFile
from ...studies.limits import Limit
from ...studies.parameters import nominal_value
from ...studies.task import EDGE_DISTANCE
from .controls import Changes, Control, capital, typed_quantity
from .reading import Reading, box_text

_SIGNS = {"<=": "at most", ">=": "at least"}
_ROUNDINGS = {"<=": ROUND_CEILING, ">=": ROUND_FLOOR}
"""Direction in which a number of the present design is rounded, so that the design keeps its own limit."""

_DIGITS = 3  # digits of a limit that starts at the present design

Row = tuple[str, str, str]  # name of a quantity, sign, and the text of the value in the unit of the page


class WrongRowError(ValueError):
    """Refusal of one row of limits, by its index."""

    def __init__(self, index: int, sentence: str) -> None:
        super().__init__(sentence)
        self.index = index


def limits_control(
    names: Iterable[str],
    limits: tuple[Limit, ...],
    reading: Reading,
    present: Callable[[str], float],
    change: Callable[[tuple[Limit, ...]], Changes],
) -> Control:
    """Return the input "limits" for limits on the quantities of `names`.

    `present` gives the number of the design for a row without a value.
    """
    rows = [row for limit in limits for row in _rows_of(limit, reading)]
    listed = dict.fromkeys([*names, *(row[0] for row in rows)])
    field = {
        "name": "limits",
        "kind": "limits",
        "label": "Limits",
        "options": [[key, capital(QUANTITIES[key].title), reading.unit(QUANTITIES[key]).text] for key in listed],
        "signs": [list(pair) for pair in _SIGNS.items()],
        "value": [list(row) for row in rows],
    }
    return Control(field, lambda value: change(read_limits(value, limits, reading, present)))


def read_limits(
    value: Any, limits: tuple[Limit, ...], reading: Reading, present: Callable[[str], float]
) -> tuple[Limit, ...]:
    """Read rows as the page sends them; raise `WrongRowError` for a wrong row, and ValueError if there are no rows."""
    if not isinstance(value, list) or not all(
        isinstance(row, list) and len(row) == 3 and all(isinstance(cell, str) for cell in row) for row in value
    ):
        raise ValueError(f"{shown(value)} is not a list of limits: each has a quantity, a sign and a value")
    check_names([row[0] for row in value], QUANTITIES, "among what can be limited")
    check_names([row[1] for row in value], _SIGNS, "as the sign of a limit")
    known = {row: limit for limit in limits for row in _rows_of(limit, reading)}  # an untouched row is not rounded
    read = []
    for index, (name, sign, text) in enumerate(value):
        row = name, sign, text.strip()
        try:
            read.append(known.get(row) or _limit(row, reading, present))
        except ValueError as error:
            raise WrongRowError(index, str(error)) from error
    return tuple(read)


def present_value(file: JointFile, name: str, contact: Contact | None = None) -> float:
    """Return a number of a design, in internal units; NaN for one that it does not have."""
    if name in file.load:
        return float(file.load[name])
    if contact is not None and name == EDGE_DISTANCE:
        cup, direction = file.cup.under_load(file.tilt)
        return float(cup.edge_distance(contact.joint.socket_radius, contact.half_angle, direction))
    if contact is not None and name in CONTACT:
        return float(getattr(contact, name))
    value = nominal_value(file.joint, name) if name in (*JOINT, *PARTS) else None
    return nan if value is None else value


def limit_text(limit: Limit, reading: Reading) -> str:
    """Write a limit with its unit, such as "outer diameter at most 52 mm"."""
    quantity = QUANTITIES[limit.name]
    ends = (f"{_SIGNS[sign]} {reading.with_unit(quantity, end)}" for sign, end in _ends(limit))
    return f"{quantity.title} {' and '.join(ends)}"


def _limit(row: Sequence[str], reading: Reading, present: Callable[[str], float]) -> Limit:
    name, sign, text = row
    quantity, title = QUANTITIES[name], capital(QUANTITIES[name].title)
    if text:
        end = typed_quantity(title, text, quantity, reading)
        require(title, end, isfinite(end), "a limit is a finite number")
    else:
        factor = reading.unit(quantity).factor
        digits = f"{present(name) * factor:.12g}"  # without the error of a conversion
        end = float(Context(prec=_DIGITS, rounding=_ROUNDINGS[sign]).create_decimal(digits)) / factor
        require(title, end, isfinite(end), "this design has no value for it: type one")
    return Limit(name=name, high=end) if sign == "<=" else Limit(name=name, low=end)


def _rows_of(limit: Limit, reading: Reading) -> list[Row]:
    unit = reading.unit(QUANTITIES[limit.name])
    return [(limit.name, sign, box_text(end * unit.factor, unit.text)) for sign, end in _ends(limit)]


def _ends(limit: Limit) -> list[tuple[str, float]]:
    return [(sign, end) for sign, end in (("<=", limit.high), (">=", limit.low)) if isfinite(end)]
