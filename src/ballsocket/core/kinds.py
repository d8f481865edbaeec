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


PLAIN = Unit("")  # unit of a plain number

PERCENT = Unit("%", 100.0)
MILLIMETRES, MICROMETRES, NANOMETRES = Unit("mm"), Unit("µm", 1e3), Unit("nm", 1e6)
NEWTONS, MEGAPASCALS, NEWTON_METRES = Unit("N"), Unit("MPa"), Unit("N m", 1e-3)
CUBIC_MILLIMETRES = Unit("mm³")
MILLIONS = Unit("million", 1e-6)


class Kind(StrEnum):
    """Physical kind of a number, such as a length or a force, with its units and an example for messages.

    Attributes
    ----------
    unit : str
        Internal unit in the spelling of the CF conventions, such as "mm2" or "1".
    example : str
    written : Unit
        Unit in JSON, files and plain tables: degrees for an angle, otherwise the internal unit.
    assumed_unit : str
        Assumed unit of an input without a unit, in a file or on the command line; empty for a plain number.
    """

    unit: str
    example: str
    written: Unit
    assumed_unit: str

    def __new__(
        cls, name: str, unit: str = "", example: str = "", written: Unit | None = None, assumed: str | None = None
    ) -> Self:
        kind = str.__new__(cls, name)
        kind._value_, kind.unit, kind.example = name, unit, example
        kind.written = Unit(unit) if written is None else written
        kind.assumed_unit = unit if assumed is None else assumed
        return kind

    LENGTH = "length", "mm", "a length, such as '16 mm'"
    FORCE = "force", "N", "a force, such as '3 kN'"
    MODULUS = "modulus", "MPa", "a pressure, stress or modulus, such as '12 MPa'"
    ANGLE = "angle", "rad", "an angle, such as '40 deg'", Unit("°", degrees(1.0)), "deg"
    NUMBER = "number", "1", "a number, such as 0.4", PLAIN, ""
    AREA = "area", "mm2", "an area, such as '8 cm^2'", Unit("mm²")
    STIFFNESS = "stiffness", "N/mm", "a stiffness, such as '60 kN/mm'"
    ENERGY = "energy", "N mm", "an energy, such as '50 N*mm'"
    FOUNDATION = "foundation modulus", "MPa/mm", "a foundation modulus, such as '280 MPa/mm'"
    COMPLIANCE = "compliance", "mm/N", "a compliance, such as '5 um/kN'"
    FREQUENCY = "frequency", "Hz", "a frequency, such as '120 Hz'"
    MASS = "mass", "kg", "a mass, such as '2 kg'"
    SURFACE_ENERGY = "surface energy", "N/mm", "an energy per area, such as '0.05 J/m^2'"
    EDGE_COEFFICIENT = "edge coefficient", "MPa/mm**0.5", "an edge coefficient, such as '2 MPa/mm**0.5'"
    VISCOSITY = "viscosity", "Pa s", "a viscosity, such as '2.5 mPa s'"
    ROTATION_RATE = "rotation rate", "rad/s", "a rotation rate, such as '1.5 rad/s'"
    SPEED = "speed", "mm/s", "a speed, such as '0.1 m/s'"
    VOLUME = "volume", "mm3", "a volume, such as '80 mm^3'", CUBIC_MILLIMETRES
    CYCLES = "number of cycles", "1", "a number of cycles, such as 5e6", None, ""
    TIME = "time", "years", "a time in years, such as 5"
    DURATION = "duration", "s", "a time, such as '1.1 s'"

    @property
    def column_suffix(self) -> str:
        """Unit at the end of a CSV column name, such as "N_per_mm"; empty for a plain number."""
        return self.assumed_unit.replace("mm**0.5", "sqrt_mm").replace("/", "_per_").replace(" ", "_")
