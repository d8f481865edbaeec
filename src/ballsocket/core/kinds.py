"""Physical kinds of numbers and their units: internal, displayed and accepted as input."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, StrEnum
from math import degrees
from typing import Any, Self


class Choice(Enum):
    """Choice between words; files may write them with capitals."""

    @classmethod
    def _missing_(cls, value: Any) -> Self | None:
        """Find a member by its value in any spelling of capitals."""
        word = value.lower() if isinstance(value, str) else value
        return next((choice for choice in cls if choice.value == word), None)


@dataclass(frozen=True)
class Unit:
    """Displayed unit: its text, and the factor from the internal unit."""

    text: str
    factor: float = 1.0

    @property
    def text_in_brackets(self) -> str:
        """Unit in brackets, such as " [mm]", for column heads and axis labels; empty for a plain number."""
        return f" [{self.text}]" if self.text else ""


PLAIN = Unit("")
"""Unit of a plain number."""

PERCENT = Unit("%", 100.0)
MILLIMETRES, NANOMETRES = Unit("mm"), Unit("nm", 1e6)
NEWTONS, MEGAPASCALS, NEWTON_METRES = Unit("N"), Unit("MPa"), Unit("N m", 1e-3)
CUBIC_MILLIMETRES = Unit("mm³")
MILLIONS = Unit("million", 1e-6)


class Kind(StrEnum):
    """Physical kind of a number, such as a length or a force, which determines its units."""

    LENGTH = "length"
    FORCE = "force"
    MODULUS = "modulus"
    ANGLE = "angle"
    NUMBER = "number"
    AREA = "area"
    STIFFNESS = "stiffness"
    ENERGY = "energy"
    FOUNDATION = "foundation modulus"
    COMPLIANCE = "compliance"
    FREQUENCY = "frequency"
    MASS = "mass"
    SURFACE_ENERGY = "surface energy"
    EDGE_COEFFICIENT = "edge coefficient"
    VISCOSITY = "viscosity"
    ROTATION_RATE = "rotation rate"
    SPEED = "speed"
    VOLUME = "volume"
    CYCLES = "number of cycles"
    TIME = "time"
    DURATION = "duration"

    @property
    def unit(self) -> str:
        """Internal unit in the spelling of the CF conventions, such as "mm2" or "1"."""
        return _KINDS[self][0]

    @property
    def example(self) -> str:
        """Example of an input with a unit, for messages: "a length, such as '16 mm'"."""
        return _KINDS[self][1]

    @property
    def written(self) -> Unit:
        """Unit in JSON, files and plain tables: degrees for an angle, otherwise the internal unit."""
        return _WRITTEN.get(self, Unit(self.unit))

    @property
    def column_suffix(self) -> str:
        """Unit at the end of a CSV column name, such as "N_per_mm"; empty for a plain number."""
        return self.assumed_unit.replace("mm**0.5", "sqrt_mm").replace("/", "_per_").replace(" ", "_")

    @property
    def assumed_unit(self) -> str:
        """Assumed unit of an input without a unit, in a file or on the command line; empty for a plain number."""
        return _TYPED.get(self, self.unit)


_KINDS = {
    Kind.LENGTH: ("mm", "a length, such as '16 mm'"),
    Kind.FORCE: ("N", "a force, such as '3 kN'"),
    Kind.MODULUS: ("MPa", "a pressure, stress or modulus, such as '12 MPa'"),
    Kind.ANGLE: ("rad", "an angle, such as '40 deg'"),
    Kind.NUMBER: ("1", "a number, such as 0.4"),
    Kind.AREA: ("mm2", "an area, such as '8 cm^2'"),
    Kind.STIFFNESS: ("N/mm", "a stiffness, such as '60 kN/mm'"),
    Kind.ENERGY: ("N mm", "an energy, such as '50 N*mm'"),
    Kind.FOUNDATION: ("MPa/mm", "a foundation modulus, such as '280 MPa/mm'"),
    Kind.COMPLIANCE: ("mm/N", "a compliance, such as '5 um/kN'"),
    Kind.FREQUENCY: ("Hz", "a frequency, such as '120 Hz'"),
    Kind.MASS: ("kg", "a mass, such as '2 kg'"),
    Kind.SURFACE_ENERGY: ("N/mm", "an energy per area, such as '0.05 J/m^2'"),
    Kind.VISCOSITY: ("Pa s", "a viscosity, such as '2.5 mPa s'"),
    Kind.ROTATION_RATE: ("rad/s", "a rotation rate, such as '1.5 rad/s'"),
    Kind.SPEED: ("mm/s", "a speed, such as '0.1 m/s'"),
    Kind.VOLUME: ("mm3", "a volume, such as '80 mm^3'"),
    Kind.CYCLES: ("1", "a number of cycles, such as 5e6"),
    Kind.TIME: ("years", "a time in years, such as 5"),
    Kind.DURATION: ("s", "a time, such as '1.1 s'"),
    Kind.EDGE_COEFFICIENT: ("MPa/mm**0.5", "an edge coefficient, such as '2 MPa/mm**0.5'"),
}
_WRITTEN = {
    Kind.ANGLE: Unit("°", degrees(1.0)),
    Kind.NUMBER: Unit(""),
    Kind.AREA: Unit("mm²"),
    Kind.VOLUME: Unit("mm³"),
}
_TYPED = {Kind.ANGLE: "deg", Kind.NUMBER: "", Kind.CYCLES: ""}
