"""The hip in use: gait, sliding, wear and creep over millions of cycles, film and friction."""

from .creep import Ladder, logarithmic
from .film import Film, Lubricant
from .gait import Cycle, constant_load, flexion, iso_14242_1, iso_14242_1_key_points, named_cycle, rocking
from .history import History
from .laws import Archard, AreaLaw, CrossShear, OwnLaw
from .use import InUse

__all__ = [
    "Archard",
    "AreaLaw",
    "CrossShear",
    "Cycle",
    "Film",
    "History",
    "InUse",
    "Ladder",
    "Lubricant",
    "OwnLaw",
    "constant_load",
    "flexion",
    "iso_14242_1",
    "iso_14242_1_key_points",
    "logarithmic",
    "named_cycle",
    "rocking",
]
