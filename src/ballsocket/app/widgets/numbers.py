"""Numbers of a joint that have inputs: their tables, typical ranges, bounds and units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ...core.kinds import Unit
from ...core.quantities import JOINT, MATERIAL, QUANTITIES, Quantity
from ...core.unit_systems import Units
from ...problem.dimensions import DIAMETERS
from .fields import Field, empty_number, number, typed
from .reading import Reading, box_text, handy_step, unit_suffix

_NEARLY_ZERO = 0.01  # share of the largest number below which the smallest is stated as zero


@dataclass(frozen=True)
class Bounds:
    """Smallest and largest number that a box accepts, in the unit of a joint file, and the reason."""

    low: float
    high: float
    reason: str

    def check(self, label: str, value: float, unit: Unit) -> float:
        """Return a number of a table; raise ValueError, in the unit beside the box, for one out of bounds."""
        if self.low <= value <= self.high:
            return value
        low, high, written = (box_text(number * unit.factor, unit.text) for number in (self.low, self.high, value))
        rule = f"{low} to {high}{unit_suffix(unit.text)} ({self.reason})"
        if value <= 0 <= self.low < _NEARLY_ZERO * self.high:
            rule = "positive" if self.low else "zero or positive"
        raise ValueError(f"{label} must be {rule}, got {written}{unit_suffix(unit.text)}")


_BOUNDS = {
    "ball_radius": Bounds(1e-3, 1e4, "from a grain to the sphere of a bridge bearing"),
    "clearance": Bounds(0.0, 1e3, "a ball with a larger clearance is not conformal"),
    "liner_thickness": Bounds(1e-4, 1e4, "from a coating to a block; tick the solid socket for more"),
    "outer_radius": Bounds(1e-3, 3e4, "a ball, its liner and its backing"),
    "thickness": Bounds(1e-4, 1e4, "from a coating to a block"),
    "young": Bounds(1e-3, 1.3e6, "from a gel to diamond"),
    "poisson": Bounds(-0.999, 0.5, "the limits of an isotropic solid"),
    "allowable_pressure": Bounds(1e-3, 1e5, "from a gel to diamond"),
    "force": Bounds(0.0, 1e9, "a bridge bearing carries 1e8 N"),
    "indentation": Bounds(0.0, 1e3, "thicker than any liner"),
    "half_angle": Bounds(0.0, 180.0, "from the pole to its opposite"),
    "body_weight": Bounds(1.0, 1e4, "at most ten times that of a heavy patient"),
    "tilt": Bounds(0.0, 180.0, "an angle to the cup's axis"),
    "chamfer": Bounds(0.0, 1e3, "wider than any rim"),
    "arc_of_cover": Bounds(40.0, 340.0, "the ball must stay in its socket"),
    "inclination": Bounds(0.0, 90.0, "from an upright axis to a level one"),
    "anteversion": Bounds(-90.0, 90.0, "from the back to the front"),
    **dict.fromkeys(("inwards", "forwards"), Bounds(-80.0, 80.0, "the load must press into the body")),
}
"""Bounds of typed numbers in mm, N, MPa and degrees by key; files and links have the limits of the mechanics alone."""


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
    label: str

    def unit(self, reading: Reading) -> Unit:
        """Return the unit beside the box, and the factor to it from the table's unit."""
        unit = reading.unit(self.quantity)
        return Unit(unit.text, self.times * unit.factor / self.quantity.written.factor)

    def field(self, name: str, value: float | None, reading: Reading) -> Field:
        """Return the input for a number of a table; an empty box that may stay empty for None."""
        unit = self.unit(reading)
        ratio = reading.unit(self.quantity).factor / self.quantity.shown.factor  # from the unit of metric pages
        hint = f"{self.quantity.symbol}: {self.quantity.meaning}".removeprefix(": ").replace("`", "")
        if value is None:
            return {**empty_number(name, self.label, unit), "hint": hint}
        low, high = (float(f"{self.times * end * ratio:.3g}") for end in self.ends)
        step = self.times * self.step * ratio
        step = step if ratio == 1 else handy_step(step)
        stated = (
            "" if reading.units is Units.SI else " mm"
        )  # catalogue sizes have their unit where the page has another
        sizes = {"sizes": [f"{self.times * size:g}{stated}" for size in self.sizes]} if self.sizes else {}
        return {**number(name, self.label, unit, (low, high), step, value * unit.factor), "hint": hint, **sizes}

    def meant(self, value: object, reading: Reading) -> float:
        """Convert typed text to the number of the table; raise ValueError for other text and numbers out of bounds."""
        unit = self.unit(reading)
        number = typed(self.label, value, unit, self.quantity.kind, self.times)
        return _BOUNDS[self.key].check(self.label, number, unit)


def _number(name: str, table: str, key: str, ends: tuple[float, float], step: float, *sizes: float) -> Number:
    quantity = QUANTITIES[name]
    label = f"{table.capitalize()} {MATERIAL[key].title}" if key in MATERIAL else capital(quantity.title)
    return Number(table=table, key=key, quantity=quantity, ends=ends, step=step, sizes=sizes, label=label)


def capital(title: str) -> str:
    """Write a title with a capital letter."""
    return f"{title[:1].upper()}{title[1:]}"


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
BODY_WEIGHT = Number(
    table="use", key="body_weight", quantity=QUANTITIES["force"], ends=(300.0, 1500.0), step=10.0, label="Body weight"
)
THICKNESS = _number("thickness", "backing", "thickness", (0.5, 10.0), 0.1)
ALLOWABLE = _number("allowable_pressure", "liner", "allowable_pressure", (1.0, 100.0), 0.5)
TILT = replace(_number("tilt", "load", "tilt", (0.0, 90.0), 1.0), label="Tilt of the load")
CUP_NUMBERS: Mapping[str, Number] = {
    "inclination": _number("inclination", "cup", "inclination", (0.0, 90.0), 1.0),
    "anteversion": _number("anteversion", "cup", "anteversion", (-30.0, 60.0), 1.0),
    "arc_of_cover": _number("arc_of_cover", "cup", "arc_of_cover", (120.0, 220.0), 1.0),
    "chamfer": _number("chamfer", "cup", "chamfer", (0.0, 3.0), 0.1),
    "tilt": TILT,
    "inwards": replace(TILT, key="inwards", ends=(-45.0, 45.0), label="Load direction, medial"),
    "forwards": replace(TILT, key="forwards", ends=(-45.0, 45.0), label="Load direction, anterior"),
}
"""Numbers of a cup and of the direction of its load by input."""

_PARAMETERS = {
    "socket_radius": NUMBERS["ball_radius"],
    "liner_yield_stress": ALLOWABLE,
    "ball_yield_stress": ALLOWABLE,
}
"""Numbers with the bounds of parameters that have no box beside the joint."""

_SINGLE = {single: double for double, single in DIAMETERS.items()}


def number_of(name: str, size: str) -> Number:
    """Return an input of joint or materials; `size` is "radius" or "diameter"."""
    spec = NUMBERS[name]
    if size != "diameter" or name not in _SINGLE:
        return spec
    quantity = JOINT[_SINGLE[name]]
    return replace(spec, quantity=quantity, times=2, label=capital(quantity.title))


def of_parameter(name: str, label: str) -> Number:
    """Return the input of a parameter of a study, with other words beside its box."""
    quantity, single = QUANTITIES[name], DIAMETERS.get(name, name)
    spec = _PARAMETERS.get(single) or NUMBERS.get(single) or _LOADS[single]
    return replace(spec, quantity=quantity, times=1 + (name in DIAMETERS), label=label)


def load_of(kind: str) -> Number:
    """Return the input of a kind of load."""
    return _LOADS[kind]
