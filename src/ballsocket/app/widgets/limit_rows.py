"""Limits as rows of a quantity, at most or at least, and a value, for every view that has limits."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from functools import partial
from itertools import starmap
from math import isfinite, nan
from typing import Any

from ...contact import Contact
from ...core.checks import require
from ...core.quantities import CONTACT, JOINT, PARTS, QUANTITIES
from ...files.joint_file import JointFile
from ...studies.limits import Limit
from ...studies.parameters import nominal_value
from ...studies.task import EDGE_DISTANCE
from .controls import Changes, Control, Options, button, capital, choice, empty_number, rows, typed_quantity
from .reading import Reading, box_text

_SIGNS = {"<=": "at most", ">=": "at least"}
_ROUNDINGS = {"<=": ROUND_CEILING, ">=": ROUND_FLOOR}
"""Direction in which a number of the present design is rounded, so that the design keeps its own limit."""

_DIGITS = 3  # digits of a limit that starts at the present design

Row = tuple[str, str, float]  # name of a quantity, sign, and value in internal units
Present = Callable[[str], float]  # number of the present design, by its name


def limit_controls(
    names: Iterable[str],
    limits: tuple[Limit, ...],
    reading: Reading,
    present: Present,
    change: Callable[[tuple[Limit, ...]], Changes],
) -> list[Control]:
    """Return the inputs of limits on the quantities of `names`: four of each row, and their group "limits".

    A row that is added, or gets another quantity, starts at the number of the present design.
    """
    listed_rows = [(limit.name, *end) for limit in limits for end in _ends(limit)]
    used = [name for name, _, _ in listed_rows]
    titles = [(name, capital(QUANTITIES[name].title)) for name in dict.fromkeys([*names, *used])]
    unused = next((name for name, _ in titles if name not in used), titles[0][0])

    def with_row(index: int, *new: Row) -> Changes:
        return change(tuple(starmap(_limit, [*listed_rows[:index], *new, *listed_rows[index + 1 :]])))

    inputs = [
        control
        for index, row in enumerate(listed_rows)
        for control in _row_controls(f"limits.{index}", row, titles, reading, present, partial(with_row, index))
    ]
    field = rows("limits", "Limits", "Add a limit", [control.field["name"] for control in inputs])
    field["value"] = "; ".join(limit_text(limit, reading) for limit in limits)
    added = partial(_at_present, unused, "<=", reading, present)
    return [*inputs, Control(field, lambda value: with_row(len(listed_rows), added()))]


def _row_controls(
    name: str, row: Row, titles: Options, reading: Reading, present: Present, with_row: Callable[..., Changes]
) -> list[Control]:
    """Return the inputs of a row: quantity, sign, value, and the button that removes it."""
    key, sign, end = row
    quantity, title = QUANTITIES[key], capital(QUANTITIES[key].title)
    unit = reading.unit(quantity)

    def read_end(text: Any) -> Changes:
        number = typed_quantity(title, text, quantity, reading)
        require(title, number, isfinite(number), "a limit is a finite number")
        return with_row((key, sign, number))

    return [
        Control(
            choice(f"{name}.quantity", "quantity", titles, key),
            lambda other: with_row(_at_present(other, sign, reading, present)),
        ),
        Control(
            choice(f"{name}.sign", "kind of limit", _SIGNS.items(), sign), lambda other: with_row((key, other, end))
        ),
        Control(empty_number(f"{name}.value", title, unit, box_text(end * unit.factor, unit.text)), read_end),
        Control(button(f"{name}.remove", "×", "Remove this limit"), lambda value: with_row()),
    ]


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


def _at_present(name: str, sign: str, reading: Reading, present: Present) -> Row:
    """Return a row that the present design keeps."""
    factor = reading.unit(QUANTITIES[name]).factor
    digits = f"{present(name) * factor:.12g}"  # without the error of a conversion
    end = float(Context(prec=_DIGITS, rounding=_ROUNDINGS[sign]).create_decimal(digits)) / factor
    require(capital(QUANTITIES[name].title), end, isfinite(end), "this design has no value for it: type one")
    return name, sign, end


def _limit(name: str, sign: str, end: float) -> Limit:
    return Limit(name=name, high=end) if sign == "<=" else Limit(name=name, low=end)


def _ends(limit: Limit) -> list[tuple[str, float]]:
    return [(sign, end) for sign, end in (("<=", limit.high), (">=", limit.low)) if isfinite(end)]
