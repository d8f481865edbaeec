"""From results and measurements back to the numbers of a joint.

`ballsocket.identify` itself is the function that fits measurements; what it takes and gives are names of this room.
"""

from .information import Information, Product
from .measured import MEASURED, Machine, Measured, Own
from .modulus import Calibration, as_constant, as_corrected_vessel, as_polynomial, calibrate
from .oscillation import oscillation
from .parameters import Estimate, Identified, identify
from .scatter import HeavyTailed, NormalScatter

__all__ = [
    "MEASURED",
    "Calibration",
    "Estimate",
    "HeavyTailed",
    "Identified",
    "Information",
    "Machine",
    "Measured",
    "NormalScatter",
    "Own",
    "Product",
    "as_constant",
    "as_corrected_vessel",
    "as_polynomial",
    "calibrate",
    "identify",
    "oscillation",
]
