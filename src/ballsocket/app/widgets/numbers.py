"""Numbers of a joint that have inputs: their tables, typical ranges and units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ...core.kinds import Unit
from ...core.quantities import JOINT, MATERIAL, QUANTITIES, Quantity
from ...problem.dimensions import DIAMETERS
from ...reports.unit_systems import Units
from .fields import Field, number, typed
from .reading import Reading, handy_step


@dataclass(frozen=True, kw_only=True)
class Number:
    """Number of a joint file with its typical range, its step and its catalogue sizes; `times` is 2 for a diameter."""

    table: str
    key: str
    quantity: Quantity
    ends: tuple[float, float]
    step: float
    times: int = 1
    sizes: Sequence[float] = ()

    def unit(self, reading: Reading) -> Unit:
        """Return the unit beside the box, and the factor to it from the table's unit."""
        unit = reading.unit(self.quantity)
        return Unit(unit.text, self.times * unit.factor / self.quantity.written.factor)

    def field(self, name: str, value: float, reading: Reading) -> Field:
        """Return the input for a number of a table."""
        unit, ratio = self.unit(reading), _ratio(self.quantity, reading)
        low, high = (float(f"{self.times * end * ratio:.3g}") for end in self.ends)
        step = self.times * self.step * ratio
        made = number(
            name, self.label, unit, (low, high), step if ratio == 1 else handy_step(step), value * unit.factor
        )
        return {**made, "sizes": self._sizes(reading)} if self.sizes else made

    @property
    def label(self) -> str:
        """Title and symbol."""
        title = self.quantity.title if self.key not in MATERIAL else MATERIAL[self.key].title
        return f"{title[:1].upper()}{title[1:]} {self.quantity.symbol}".strip()

    def _sizes(self, reading: Reading) -> list[str]:
        """List the catalogue sizes, with their unit where the page has another."""
        behind = "" if reading.units is Units.SI else " mm"
        return [f"{self.times * size:g}{behind}" for size in self.sizes]

    def meant(self, value: object, reading: Reading) -> float:
        """Convert typed text to the number of the table; raise ValueError for other text."""
        return typed(self.quantity.name, value, self.unit(reading), self.quantity.kind, self.times)


def _ratio(quantity: Quantity, reading: Reading) -> float:
    """Return the factor from the unit of metric pages to the chosen one."""
    return reading.unit(quantity).factor / quantity.shown.factor


def _number(name: str, table: str, key: str, ends: tuple[float, float], step: float, *sizes: float) -> Number:
    return Number(table=table, key=key, quantity=QUANTITIES[name], ends=ends, step=step, sizes=sizes)


NUMBERS: Mapping[str, Number] = {
    "ball_radius": _number("ball_radius", "joint", "ball_radius", (5.0, 30.0), 0.1, 11.1125, 13, 14, 16, 18, 20, 22),
    "clearance": _number("clearance", "joint", "clearance", (0.0, 0.5), 0.005),
    "liner_thickness": _number("liner_thickness", "joint", "liner_thickness", (0.5, 20.0), 0.1, 3, 4, 5, 6, 7, 8, 10),
    "outer_radius": _number("outer_radius", "joint", "outer_radius", (10.0, 40.0), 0.1, *range(22, 35)),
    "liner_young": _number("liner_young", "liner", "young", (100.0, 5000.0), 10.0),
    "liner_poisson": _number("liner_poisson", "liner", "poisson", (0.0, 0.4995), 0.005),
    "ball_young": _number("ball_young", "ball", "young", (1e3, 4e5), 1e3),
    "ball_poisson": _number("ball_poisson", "ball", "poisson", (0.0, 0.4995), 0.005),
}
"""Numbers of joint and materials by input; heads and shells have the sizes of hip manufacturers."""

_LOADS = {
    "force": _number("force", "load", "force", (50.0, 5000.0), 50.0),
    "indentation": _number("indentation", "load", "indentation", (1.0, 200.0), 1.0),
    "half_angle": _number("half_angle", "load", "half_angle", (1.0, 80.0), 0.5),
}
THICKNESS = _number("thickness", "backing", "thickness", (0.5, 10.0), 0.1)
ALLOWABLE = _number("allowable_pressure", "liner", "allowable_pressure", (1.0, 100.0), 0.5)
TILT = _number("tilt", "load", "tilt", (0.0, 90.0), 1.0)

_SINGLE = {single: double for double, single in DIAMETERS.items()}


def number_of(name: str, size: str) -> Number:
    """Return an input of joint or materials; `size` is "radius" or "diameter"."""
    spec = NUMBERS[name]
    if size != "diameter" or name not in _SINGLE:
        return spec
    return Number(**{**vars(spec), "quantity": JOINT[_SINGLE[name]], "times": 2})


def load_of(kind: str) -> Number:
    """Return the input of a kind of load."""
    return _LOADS[kind]
