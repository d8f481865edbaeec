"""Inputs of the page: a field, which is plain data for a script, and the reader of its edits."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, inf
from operator import attrgetter
from typing import Any

from ...core.checks import check_names, check_number, check_text, shown
from ...core.kinds import Kind, Unit
from ...core.quantities import QUANTITIES, Quantity
from ...core.unit_systems import Units
from ...files.inputs import Input, Typical, inputs_of
from ...files.joint_file import JointFileTable
from ...files.units import parse, split_quantity
from ...hip.cycle_registry import CYCLES
from ...hip.schema import HipTable
from ...model_catalogue import catalogue
from ...problem.dimensions import DIAMETERS
from ...reports.style import LineStyle
from ..state.screen import Screen
from ..state.use import CHOICES
from .blocks import plain_line
from .reading import Reading, box_text, handy_step, unit_suffix

Field = dict[str, Any]  # one input: its name, kind, label, value, and what its kind needs
Options = Iterable[Sequence[str]]  # values of a choice, each with its label unless that is the value
Changes = dict[str, Any]  # values of the screen by name
Reader = Callable[[Any], Changes | None]  # raises ValueError for a value that is not allowed; None changes nothing

_NEARLY_ZERO = 0.01  # share of the largest number below which the smallest is stated as zero
_MAX_SHOWN = 60  # characters of typed text in a message
_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?(?=\D|$)")
_COMMA = re.compile(r"(?<=\d),(?=\d)|^,(?=\d)|(?<=[-+]),(?=\d)")
_KEY_REFUSED = re.compile(r"[\w.]+ (?:= (?:'[^']*'|\S+) (?P<rule>is not allowed: .*)|(?P<need>must .*))", re.DOTALL)


MODEL_LABELS = [(name, f"{name}: {model.title}") for name, model in catalogue.items()]


def capital(title: str) -> str:
    """Write a title with a capital letter."""
    return f"{title[:1].upper()}{title[1:]}"


def choice(name: str, label: str, options: Options, value: str) -> Field:
    """Return a list for one choice."""
    pairs = [[option, option] if isinstance(option, str) else list(option) for option in options]
    return {"name": name, "kind": "choice", "label": label, "options": pairs, "value": value}


def segments(name: str, label: str, options: Options, value: str) -> Field:
    """Return a row of buttons for one choice."""
    return {**choice(name, label, options, value), "kind": "segments"}


def several(name: str, label: str, options: Options, value: Iterable[str], lines: Mapping[str, LineStyle]) -> Field:
    """Return a row of boxes for any number of choices, each with a piece of a line before its label."""
    plain = {option: plain_line(line) for option, line in lines.items()}
    return {**choice(name, label, options, ""), "kind": "several", "value": list(value), "lines": plain}


def tick(name: str, label: str, value: bool) -> Field:
    """Return a tick box."""
    return {"name": name, "kind": "tick", "label": label, "value": value}


def number(name: str, label: str, unit: Unit, ends: tuple[float, float], step: float, value: float) -> Field:
    """Return an input for a number, with a slider over its typical range and the present value.

    `value` and `ends` are in the unit beside the box, to which `unit.factor` leads from that of a joint file.
    """
    low, high = min(ends[0], value), max(ends[1], value)
    slider = {"factor": unit.factor, "low": low, "high": high, "step": step, "value": value}
    return {**empty_number(name, label, unit, box_text(value, unit.text)), **slider}


def empty_number(name: str, label: str, unit: Unit, text: str = "") -> Field:
    """Return an input for a number without a slider."""
    return {"name": name, "kind": "number", "label": label, "unit": unit.text, "value": None, "text": text}


def button(name: str, label: str, hint: str) -> Field:
    """Return a button with a sign, and with words for screen readers."""
    return {"name": name, "kind": "button", "label": label, "hint": hint, "value": None}


def rows(name: str, label: str, add: str, names: Iterable[str]) -> Field:
    """Return a group of the inputs of rows, whose names begin with its own, with a button that adds one."""
    inside = [inner.removeprefix(f"{name}.") for inner in names]
    return {"name": name, "kind": "rows", "label": label, "add": add, "names": inside, "value": ""}


def words(name: str, label: str, value: str, rows: int = 1) -> Field:
    """Return an input for text of several rows."""
    return {"name": name, "kind": "words", "label": label, "value": value, "rows": rows}


def typed(label: str, text: Any, unit: Unit, kind: str) -> float:
    """Convert typed text, "0.2", "0,2", "0.2 mm" or "1 1/8 in", to the number of a table.

    A bare number has the `unit` beside the box, whose factor leads to it from the number in the table. Raises
    ValueError for no number, or one that could be two.

    Examples
    --------
    >>> typed("Clearance", "0,2", Unit("mm"), "length"), typed("Clearance", "0.2 mm", Unit("in", 1 / 25.4), "length")
    (0.2, 0.2)
    """
    if isinstance(text, int | float) and not isinstance(text, bool):
        return _rounded(check_number(label, text) / unit.factor)
    inside = f" in {'inches' if unit.text == 'in' else unit.text}" if unit.text else ""
    rule = f"{label} must be a number{inside}" + (f", or {Kind(kind).example.replace(', ', ' ')}" if unit.text else "")
    stripped = text.strip() if isinstance(text, str) else ""
    if not stripped:
        raise ValueError(f"{rule}, got {'nothing' if isinstance(text, str) else shown(text)}")
    if _THOUSANDS.match(stripped):
        plain_text = stripped.replace(",", "")
        raise ValueError(
            f"{label} {shown(stripped)} could be two numbers: write {plain_text} or {stripped.replace(',', '.', 1)}"
        )
    pointed = _COMMA.sub(".", stripped, count=1)
    try:
        number, written_unit = split_quantity(pointed)
        if not written_unit:
            return _rounded(number / unit.factor)
        value = parse(label, pointed, kind)
    except ValueError as error:
        raise ValueError(f"{rule}, got {shown(stripped)}") from error
    return _rounded(degrees(value) if kind == Kind.ANGLE else value)


def _rounded(value: float) -> float:
    """Round off the error of a conversion of units."""
    return float(f"{value:.15g}")


def typed_quantity(label: str, text: Any, quantity: Quantity, reading: Reading) -> float:
    """Convert typed text to a number in internal units; a bare number has the unit of the page."""
    unit, written = reading.unit(quantity), quantity.written.factor
    return typed(label, text, Unit(unit.text, unit.factor / written), quantity.kind) / written


def refusal_of(field: Field, error: ValueError, value: Any) -> Field | None:
    """Return what a field shows beside a refused value, which stays in its box; None for a field without a box.

    The refusal of a key becomes one of the field's label, and states the number in use.
    """
    if field["kind"] not in ("number", "words"):
        return None
    unit, label, kept = unit_suffix(field.get("unit", "")), field["label"], field.get("text")
    sentence, refused = str(error), _KEY_REFUSED.fullmatch(str(error))
    if refused is not None:
        written = str(value).strip()[:_MAX_SHOWN]
        written += unit if written[-1:].isdigit() else ""
        sentence = f"{label} {refused['need']}" if refused["need"] else f"{label} {written} {refused['rule']}"
    sentence += f"; {kept}{unit} stays in use" if kept else ""
    return {"error": sentence, "refused": value if isinstance(value, str) else None}


@dataclass(frozen=True)
class Control:
    """Input of the page for one screen: its field, and the reader of its edits.

    `read` returns the changes of the screen; it raises ValueError for a value that is not allowed. It gets options of
    a choice only.
    """

    field: Field
    read: Callable[[Any], Changes]

    def take(self, value: Any) -> Changes:
        """Return the changes of the screen after an edit; raise ValueError for a value that is not allowed."""
        name, kind = self.field["name"], self.field["kind"]
        if kind == "several" and not isinstance(value, list):
            raise ValueError(f"{name} = {shown(value)} is not a list")
        if kind in ("choice", "segments", "several"):
            options = [option for option, _ in self.field["options"]]
            check_names(value if kind == "several" else [value], options, f"as {name}")
        return self.read(value)

    def but(self, **more: Any) -> Control:
        """Return the input with more entries of its field, such as `hidden`."""
        return Control({**self.field, **more}, self.read)


def by_name(controls: Iterable[Control], prefix: str = "") -> dict[str, Control]:
    """Return inputs by their names, before which stands a prefix."""
    named = (control.but(name=f"{prefix}{control.field['name']}") if prefix else control for control in controls)
    return {control.field["name"]: control for control in named}


def fields_of(controls: Mapping[str, Control]) -> dict[str, Field]:
    """Return the fields of inputs by name."""
    return {name: control.field for name, control in controls.items()}


def changed(screen: Screen, path: str, value: Any) -> Changes:
    """Return the change of the screen that sets a path such as "quantity" or "use.law"."""
    part, _, key = path.rpartition(".")
    return {part: replace(getattr(screen, part), **{key: value})} if part else {key: value}


def chosen(
    screen: Screen, path: str, label: str, options: Options, build: Callable[..., Field] = choice, name: str = ""
) -> Control:
    """Return the choice of a word of the screen, named after it."""
    field = build(name or path.rpartition(".")[2], label, options, attrgetter(path)(screen))
    return Control(field, lambda value: changed(screen, path, value))


def amount(screen: Screen, path: str, label: str, ends: tuple[float, float], step: float) -> Control:
    """Return the input of a number of the screen without a unit, with its typical range."""
    unit = Unit("")
    return Control(
        number(path.rpartition(".")[2], label, unit, ends, step, attrgetter(path)(screen)),
        lambda value: changed(screen, path, typed(label, value, unit, Kind.NUMBER)),
    )


def text(screen: Screen, path: str, label: str, rows: int = 1) -> Control:
    """Return the input of a text of the screen, of several rows."""
    field = words(path.rpartition(".")[2], label, attrgetter(path)(screen), rows)
    return Control(field, lambda value: changed(screen, path, check_text(label, value).strip()))


def tolerances_input(screen: Screen) -> Control:
    """Return the input of the tolerances of the joint and its load."""
    return text(screen, "asked.tolerances", "Tolerances, such as clearance = 0.1 +- 0.02 mm; force = 3 +- 0.3 kN")


@dataclass(frozen=True, kw_only=True)
class Number:
    """Number of a file with an input on the page."""

    entry: Input
    quantity: Quantity
    label: str
    largest: float = inf  # below which the bounds of its key are narrowed for a `reason`
    reason: str = ""

    @property
    def typical(self) -> Typical:
        """Typical range, step, sizes and bounds of the number."""
        assert self.entry.typical is not None
        return self.entry.typical

    def unit(self, reading: Reading) -> Unit:
        """Return the unit beside the box, and the factor to it from the table's unit."""
        unit = reading.unit(self.quantity)
        return Unit(unit.text, unit.factor / self.quantity.written.factor)

    def control(self, name: str, value: float | None, reading: Reading, change: Callable[[float], Changes]) -> Control:
        """Return the input for a number of a table, and for a change to another number of it."""
        return Control(self._field(name, value, reading), lambda value: change(self.meant(value, reading)))

    def _field(self, name: str, value: float | None, reading: Reading) -> Field:
        """Return the field of a number; an empty box for None."""
        unit = self.unit(reading)
        ratio = reading.unit(self.quantity).factor / self.quantity.shown.factor  # from the unit of metric pages
        hint = f"{self.quantity.symbol}: {self.quantity.meaning}".removeprefix(": ").replace("`", "")
        if value is None:
            return {**empty_number(name, self.label, unit), "hint": hint}
        low, high = (float(f"{end * ratio:.3g}") for end in self.typical.ends)
        step = self.typical.step * ratio
        step = step if ratio == 1 else handy_step(step)
        stated = "" if reading.units is Units.SI else " mm"  # of catalogue sizes where the page has another unit
        sizes = [f"{size:g}{stated}" for size in self.typical.sizes]
        drag = unit.factor * (2 if self.entry.key in DIAMETERS else 1)  # box unit per unit of a radius
        extra = {"hint": hint, "factor": drag, **({"sizes": sizes} if sizes else {})}
        return {**number(name, self.label, unit, (low, high), step, value * unit.factor), **extra}

    def meant(self, value: object, reading: Reading) -> float:
        """Convert typed text to the number of the table; raise ValueError for other text and numbers out of bounds."""
        unit = self.unit(reading)
        number = typed(self.label, value, unit, self.quantity.kind)
        low, high = self.typical.bounds
        high, reason = (self.largest, self.reason) if self.largest < high else (high, self.typical.reason)
        if low <= number <= high:
            return number
        texts = [box_text(end * unit.factor, unit.text) for end in (low, high, number)]
        rule = f"{texts[0]} to {texts[1]}{unit_suffix(unit.text)} ({reason})"
        if number <= 0 <= low < _NEARLY_ZERO * high:
            rule = "positive" if low else "zero or positive"
        raise ValueError(f"{self.label} must be {rule}, got {texts[2]}{unit_suffix(unit.text)}")


_INPUTS = {f"{entry.part}.{entry.key}".lstrip("."): entry for entry in inputs_of(JointFileTable) + inputs_of(HipTable)}


def number_of(path: str, **changes: Any) -> Number:
    """Return the number of a key of a file, such as "liner.young", with another quantity or label."""
    entry = _INPUTS[path]
    return Number(**{"entry": entry, "quantity": entry.quantity, "label": entry.label, **changes})


def parameter(name: str) -> Number:
    """Return the number of a parameter of a study, such as "liner_young"."""
    part, _, key = name.partition("_")
    named = (f"joint.{name}", f"{part}.{key}", f"load.{name}")
    return number_of(next(path for path in named if path in _INPUTS))


def file_choice(path: str, value: str, name: str = "") -> Field:
    """Return the input for a choice of a file, such as "cup.side"."""
    entry = _INPUTS[path]
    return segments(name or entry.key, entry.label, entry.choices, value)


_BODY_WEIGHT = number_of("body_weight", quantity=QUANTITIES["force"], label="Body weight")
_FOUNDATIONS = {"springs": "springs", "shell": "closed shell", "cup": "real cup"}


def cycle_controls(screen: Screen) -> list[Control]:
    """Return cycle, body weight where the cycle was measured in patients, and model of the liner: for Gait and Wear."""
    use = screen.use
    weight = _BODY_WEIGHT.control(
        "body_weight", use.body_weight, screen.reading, lambda value: changed(screen, "use.body_weight", value)
    )
    return [
        chosen(screen, "use.cycle", "Cycle", CHOICES["cycle"]),
        weight.but(hidden=not CYCLES[use.cycle].per_body_weight),
        chosen(screen, "use.contact", "Liner model", _FOUNDATIONS.items(), segments),
    ]
