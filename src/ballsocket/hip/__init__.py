"""The hip in use: gait, sliding, wear and creep over millions of cycles, film and friction."""

from .bands import Bands
from .creep import Ladder, constrained_share, logarithmic
from .cycle import Cycle, Frame, Spring
from .film import Film, Lubricant
from .gait import constant_load, flexion, iso_14242_1, iso_14242_1_key_points, iso_14242_4, rocking, two_axis
from .history import History
from .in_vivo import in_vivo
from .laws import Archard, AreaLaw, CrossShear, EnergyLaw, OwnLaw
from .mix import Activity, Mix
from .named_cycles import named_cycle
from .uncertainty import population, uncertainty
from .use import InUse
from .variability import PatientVariability

Scatter = PatientVariability
"""Name of `PatientVariability` in version 1.0."""

__all__ = [
    "Activity",
    "Archard",
    "AreaLaw",
    "Bands",
    "CrossShear",
    "Cycle",
    "EnergyLaw",
    "Film",
    "Frame",
    "History",
    "InUse",
    "Ladder",
    "Lubricant",
    "Mix",
    "OwnLaw",
    "PatientVariability",
    "Scatter",
    "Spring",
    "constant_load",
    "constrained_share",
    "flexion",
    "in_vivo",
    "iso_14242_1",
    "iso_14242_1_key_points",
    "iso_14242_4",
    "logarithmic",
    "named_cycle",
    "population",
    "rocking",
    "two_axis",
    "uncertainty",
]
