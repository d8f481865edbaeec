"""Wear simulation of hip joints: gait, sliding, wear and creep over millions of cycles, film and friction."""

from typing import TYPE_CHECKING

from ..core.lazy import imported_names
from ..lubrication import Lubricant as Lubricant
from ..lubrication import Stribeck as Stribeck

if TYPE_CHECKING:
    from .bands import Bands as Bands
    from .config import read_hip as read_hip
    from .creep_law import constrained_share as constrained_share
    from .creep_laws import KelvinVoigtChain as KelvinVoigtChain
    from .creep_laws import LogarithmicCreep as LogarithmicCreep
    from .creep_laws import logarithmic as logarithmic
    from .cycle import Cycle as Cycle
    from .cycle import Frame as Frame
    from .cycle import Spring as Spring
    from .cycle_registry import named_cycle as named_cycle
    from .film import Film as Film
    from .film_limit import FilmLimit as FilmLimit
    from .history import History as History
    from .in_vivo_cycles import in_vivo as in_vivo
    from .measured_wear import MeasuredWear as MeasuredWear
    from .mix import Activity as Activity
    from .mix import Mix as Mix
    from .simulation import HipSimulation as HipSimulation
    from .simulator_cycles import constant_load as constant_load
    from .simulator_cycles import flexion as flexion
    from .simulator_cycles import iso_14242_1 as iso_14242_1
    from .simulator_cycles import iso_14242_1_key_points as iso_14242_1_key_points
    from .simulator_cycles import iso_14242_4 as iso_14242_4
    from .simulator_cycles import rocking as rocking
    from .simulator_cycles import two_axis as two_axis
    from .variability import PatientVariability as PatientVariability
    from .wear_fit import WearFit as WearFit
    from .wear_fit import fit_wear_coefficient as fit_wear_coefficient
    from .wear_laws import WEAR_FACTORS as WEAR_FACTORS
    from .wear_laws import Archard as Archard
    from .wear_laws import ContactAreaWear as ContactAreaWear
    from .wear_laws import CrossShear as CrossShear
    from .wear_laws import CustomWearLaw as CustomWearLaw
    from .wear_laws import FrictionEnergyWear as FrictionEnergyWear
    from .wear_uncertainty import population as population
    from .wear_uncertainty import uncertainty as uncertainty

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

__all__ = ["Lubricant", "Stribeck", *(name for names in _NAMES_BY_MODULE.values() for name in names.split())]

if not TYPE_CHECKING:
    __getattr__ = imported_names(__name__, _NAMES_BY_MODULE)


def __dir__() -> list[str]:
    """List the names for users."""
    return sorted({*globals(), *__all__})
