"""Numbers and choices of files that have inputs on the page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...core.kinds import Unit
from ...core.quantities import QUANTITIES, Quantity
from ...core.unit_systems import Units
from ...files.inputs import Input, Typical, inputs_of
from ...files.joint_file import JointFileTable
from ...hip.schema import HipTable
from ...problem.dimensions import DIAMETERS
from .fields import Field, empty_number, number, segments, typed
from .reading import Reading, box_text, handy_step, unit_suffix

_NEARLY_ZERO = 0.01  # share of the largest number below which the smallest is stated as zero


@dataclass(frozen=True, kw_only=True)
class Number:
    """Number of a file with an input on the page."""

    entry: Input
    quantity: Quantity
    label: str

    @property
    def typical(self) -> Typical:
        """Typical range, step, sizes and bounds of the number."""
        assert self.entry.typical is not None
        return self.entry.typical

    def unit(self, reading: Reading) -> Unit:
        """Return the unit beside the box, and the factor to it from the table's unit."""
        unit = reading.unit(self.quantity)
        return Unit(unit.text, unit.factor / self.quantity.written.factor)

    def field(self, name: str, value: float | None, reading: Reading) -> Field:
        """Return the input for a number of a table; an empty box that may stay empty for None."""
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
        if low <= number <= high:
            return number
        texts = [box_text(end * unit.factor, unit.text) for end in (low, high, number)]
        rule = f"{texts[0]} to {texts[1]}{unit_suffix(unit.text)} ({self.typical.reason})"
        if number <= 0 <= low < _NEARLY_ZERO * high:
            rule = "positive" if low else "zero or positive"
        raise ValueError(f"{self.label} must be {rule}, got {texts[2]}{unit_suffix(unit.text)}")


def capital(title: str) -> str:
    """Write a title with a capital letter."""
    return f"{title[:1].upper()}{title[1:]}"


_INPUTS = {f"{entry.part}.{entry.key}".lstrip("."): entry for entry in inputs_of(JointFileTable) + inputs_of(HipTable)}


def _number(path: str, **changes: Any) -> Number:
    """Return the number of a key of a file, such as "liner.young", with some changes."""
    entry = _INPUTS[path]
    return Number(**{"entry": entry, "quantity": entry.quantity, "label": entry.label, **changes})


def choice_of(path: str, value: str) -> Field:
    """Return the input for a choice of a file, such as "cup.side"."""
    return segments(_INPUTS[path].key, _INPUTS[path].label, _INPUTS[path].choices, value)


_LENGTHS = ("joint.ball_radius", "joint.clearance", "joint.liner_thickness", "joint.outer_radius")
_MODULI = ("liner.young", "liner.poisson", "ball.young", "ball.poisson")
NUMBERS = {path.removeprefix("joint.").replace(".", "_"): _number(path) for path in _LENGTHS + _MODULI}
"""Numbers of joint and materials by input."""

BODY_WEIGHT = _number("body_weight", quantity=QUANTITIES["force"], label="Body weight")
THICKNESS = _number("backing.thickness")
ALLOWABLE = _number("liner.allowable_pressure")
TILT = _number("load.tilt", label="Tilt of the load")
_LEAN = _number("load.direction", quantity=TILT.quantity)
CUP_NUMBERS: Mapping[str, Number] = {
    **{key: _number(f"cup.{key}") for key in ("inclination", "anteversion", "arc_of_cover", "chamfer")},
    "tilt": TILT,
    "inwards": replace(_LEAN, label="Load direction, medial"),
    "forwards": replace(_LEAN, label="Load direction, anterior"),
}
"""Numbers of a cup and of the direction of its load by input."""

_SINGLE = {single: double for double, single in DIAMETERS.items()}


def number_of(name: str, size: str) -> Number:
    """Return an input of joint or materials; `size` is "radius" or "diameter"."""
    return _number(f"joint.{_SINGLE[name]}") if size == "diameter" and name in _SINGLE else NUMBERS[name]


def of_parameter(name: str) -> Number:
    """Return the input of a parameter of a study."""
    part, _, key = name.partition("_")
    named = (f"joint.{name}", f"{part}.{key}", f"load.{name}")
    return _number(next(path for path in named if path in _INPUTS))
