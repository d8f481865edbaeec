"""The numbers of a joint that the page has inputs for: where a joint file keeps each, what is usual, and its unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import radians

from ..joint.dimensions import DIAMETERS
from ..kinds import Unit
from ..quantities import JOINT, LOADS, MATERIAL, QUANTITIES, Quantity


@dataclass(frozen=True, kw_only=True)
class Number:
    """A number of the tables of a joint file, and the range that is usual for it, in the unit that is shown."""

    table: str
    key: str
    quantity: Quantity
    label: str
    unit: str
    low: float
    high: float
    step: float
    factor: float = 1.0  # from the number in the table to the one that is shown


def _number(name: str, table: str, key: str, ends: tuple[float, float], step: float) -> Number:
    """A quantity in the unit that is shown, where the table has that of files."""
    quantity = QUANTITIES[name]
    title = MATERIAL[key].title if key in MATERIAL else quantity.title
    return Number(
        table=table,
        key=key,
        quantity=quantity,
        label=f"{title[:1].upper()}{title[1:]} {quantity.symbol}".strip(),
        unit=quantity.shown.text,
        low=ends[0],
        high=ends[1],
        step=step,
        factor=quantity.shown.factor / quantity.written.factor,
    )


NUMBERS: Mapping[str, Number] = {
    "ball_radius": _number("ball_radius", "joint", "ball_radius", (5.0, 30.0), 0.1),
    "clearance": _number("clearance", "joint", "clearance", (0.0, 0.5), 0.005),
    "liner_thickness": _number("liner_thickness", "joint", "liner_thickness", (0.5, 20.0), 0.1),
    "outer_radius": _number("outer_radius", "joint", "outer_radius", (10.0, 40.0), 0.1),
    "liner_young": _number("liner_young", "liner", "young", (100.0, 5000.0), 10.0),
    "liner_poisson": _number("liner_poisson", "liner", "poisson", (0.0, 0.4995), 0.005),
    "ball_young": _number("ball_young", "ball", "young", (1e3, 4e5), 1e3),
    "ball_poisson": _number("ball_poisson", "ball", "poisson", (0.0, 0.4995), 0.005),
}
"""Of joint and materials, by the name of their input."""

_DOUBLED = {
    single: replace(
        NUMBERS[single],
        quantity=JOINT[double],
        label=f"{JOINT[double].title.capitalize()} {JOINT[double].symbol}",
        low=2 * NUMBERS[single].low,
        high=2 * NUMBERS[single].high,
        step=2 * NUMBERS[single].step,
        factor=2 * NUMBERS[single].factor,
    )
    for double, single in DIAMETERS.items()
}
_LOADS = {
    "force": _number("force", "load", "force", (50.0, 5000.0), 50.0),
    "indentation": _number("indentation", "load", "indentation", (1.0, 200.0), 1.0),
    "half_angle": _number("half_angle", "load", "half_angle", (1.0, 80.0), 0.5),
}
_IN_RADIANS = replace(
    _LOADS["half_angle"],
    unit=Unit(LOADS["half_angle"].unit).text,
    low=0.02,
    high=1.4,
    step=0.01,
    factor=radians(1.0),
)


def number_of(name: str, size: str) -> Number:
    """An input of joint or materials, balls by "radius" or "diameter"."""
    return _DOUBLED.get(name, NUMBERS[name]) if size == "diameter" else NUMBERS[name]


def load_of(kind: str, angle: str) -> Number:
    """The input of a load of that kind, angles in "degrees" or "radians"."""
    return _IN_RADIANS if (kind, angle) == ("half_angle", "radians") else _LOADS[kind]
