"""Wear simulation of hip joints: gait, sliding, wear and creep over millions of cycles, film and friction."""

from ..lubrication import Lubricant, Stribeck
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
from .wear_fit import MeasuredWear, WearFit, fit_wear_coefficient
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
