"""Wear simulation of hip joints: gait, sliding, wear and creep over millions of cycles, film and friction."""

from typing import TYPE_CHECKING

from ..core.lazy import imported_names
from ..lubrication import Lubricant, Stribeck

if TYPE_CHECKING:
    from .bands import Bands
    from .config import read_hip
    from .creep_law import constrained_share
    from .creep_laws import KelvinVoigtChain, LogarithmicCreep, logarithmic
    from .cycle import Cycle, Frame, Spring
    from .cycle_registry import named_cycle
    from .film import Film
    from .film_limit import FilmLimit
    from .history import History
    from .in_vivo_cycles import in_vivo
    from .measured_wear import MeasuredWear
    from .mix import Activity, Mix
    from .simulation import HipSimulation
    from .simulator_cycles import (
        constant_load,
        flexion,
        iso_14242_1,
        iso_14242_1_key_points,
        iso_14242_4,
        rocking,
        two_axis,
    )
    from .variability import PatientVariability
    from .wear_fit import WearFit, fit_wear_coefficient
    from .wear_laws import WEAR_FACTORS, Archard, ContactAreaWear, CrossShear, CustomWearLaw, FrictionEnergyWear
    from .wear_uncertainty import population, uncertainty

__all__ = [
    "WEAR_FACTORS",
    "Activity",
    "Archard",
    "Bands",
    "ContactAreaWear",
    "CrossShear",
    "CustomWearLaw",
    "Cycle",
    "Film",
    "FilmLimit",
    "Frame",
    "FrictionEnergyWear",
    "HipSimulation",
    "History",
    "KelvinVoigtChain",
    "LogarithmicCreep",
    "Lubricant",
    "MeasuredWear",
    "Mix",
    "PatientVariability",
    "Spring",
    "Stribeck",
    "WearFit",
    "constant_load",
    "constrained_share",
    "fit_wear_coefficient",
    "flexion",
    "in_vivo",
    "iso_14242_1",
    "iso_14242_1_key_points",
    "iso_14242_4",
    "logarithmic",
    "named_cycle",
    "population",
    "read_hip",
    "rocking",
    "two_axis",
    "uncertainty",
]

_NAMES_BY_MODULE = {
    "bands": "Bands",
    "config": "read_hip",
    "creep_law": "constrained_share",
    "creep_laws": "KelvinVoigtChain LogarithmicCreep logarithmic",
    "cycle": "Cycle Frame Spring",
    "cycle_registry": "named_cycle",
    "film": "Film",
    "film_limit": "FilmLimit",
    "history": "History",
    "in_vivo_cycles": "in_vivo",
    "measured_wear": "MeasuredWear",
    "mix": "Activity Mix",
    "simulation": "HipSimulation",
    "simulator_cycles": "constant_load flexion iso_14242_1 iso_14242_1_key_points iso_14242_4 rocking two_axis",
    "variability": "PatientVariability",
    "wear_fit": "WearFit fit_wear_coefficient",
    "wear_laws": "WEAR_FACTORS Archard ContactAreaWear CrossShear CustomWearLaw FrictionEnergyWear",
    "wear_uncertainty": "population uncertainty",
}
"""Names for users by module. A module is imported on the first use of one of its names."""

if not TYPE_CHECKING:
    __getattr__ = imported_names(__name__, _NAMES_BY_MODULE)


def __dir__() -> list[str]:
    """List the names for users."""
    return sorted({*globals(), *__all__})
