"""Force element as an FMU, a functional mock-up unit of the FMI standard."""

from .fmu import Fmu, FmuFile
from .reference_results import write_cross_check

__all__ = ["Fmu", "FmuFile", "write_cross_check"]
