"""Force element as an FMU, a functional mock-up unit of the FMI standard."""

from .cross_check import write_cross_check
from .fmu import Fmu, FmuFile

Written = FmuFile
"""Name of `FmuFile` in version 1.0."""

__all__ = ["Fmu", "FmuFile", "Written", "write_cross_check"]
