"""Identification of a joint from measurements, and calibration of a foundation modulus.

`identify` fits measurements; the other names are its data and results.
"""

from ..studies.calibration import Calibration, as_constant, as_corrected_vessel, as_polynomial, calibrate
from .information import Estimate, Information, Product
from .machine import Machine
from .maximum_likelihood import identify
from .measured import MEASURED, Measured
from .observables import CustomObservable, oscillation, sliding_torque
from .registry import MACHINE_ERRORS, MODEL_NUMBERS, OBSERVABLE_NUMBERS
from .result import IdentificationResult
from .scatter import HeavyTailed, NormalScatter
from .unknown_kinds import MachineError, ModelNumber

__all__ = [
    "MACHINE_ERRORS",
    "MEASURED",
    "MODEL_NUMBERS",
    "OBSERVABLE_NUMBERS",
    "Calibration",
    "CustomObservable",
    "Estimate",
    "HeavyTailed",
    "IdentificationResult",
    "Information",
    "Machine",
    "MachineError",
    "Measured",
    "ModelNumber",
    "NormalScatter",
    "Product",
    "as_constant",
    "as_corrected_vessel",
    "as_polynomial",
    "calibrate",
    "identify",
    "oscillation",
    "sliding_torque",
]
