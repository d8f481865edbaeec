"""Force element as an FMU, a functional mock-up unit of the FMI standard."""

from .fmu import Fmu, FmuFile
from .variables import write_cross_check

Written = FmuFile
"""Name of `FmuFile` in version 1.0."""

__all__ = ["Fmu", "FmuFile", "Written", "write_cross_check"]
