"""The hip in use: gait, sliding, wear over millions of cycles."""

from .gait import Cycle, constant_load, flexion, iso_14242_1, iso_14242_1_key_points, named_cycle, rocking
from .history import History
from .laws import Archard, AreaLaw, CrossShear, OwnLaw
from .use import InUse

__all__ = [
    "Archard",
    "AreaLaw",
    "CrossShear",
    "Cycle",
    "History",
    "InUse",
    "OwnLaw",
    "constant_load",
    "flexion",
    "iso_14242_1",
    "iso_14242_1_key_points",
    "named_cycle",
    "rocking",
]
