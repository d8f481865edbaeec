"""The hip in use: gait, sliding, wear and creep over millions of cycles, film and friction."""

from .creep import Ladder, constrained_share, logarithmic
from .cycle import Cycle, Frame, Spring
from .cycle_registry import named_cycle
from .film import Film, Lubricant
from .history import History
from .in_vivo import in_vivo
from .laws import Archard, AreaLaw, CrossShear, EnergyLaw, OwnLaw
from .mix import Activity, Mix
from .patients import Scatter
from .simulator_cycles import (
    constant_load,
    flexion,
    iso_14242_1,
    iso_14242_1_key_points,
    iso_14242_4,
    rocking,
    two_axis,
)
from .uncertainty import Bands, population, uncertainty
from .use import InUse

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
