"""The force element as an FMU, a functional mock-up unit of the FMI standard."""

from .cross_check import write_cross_check
from .fmu import Fmu, Written

__all__ = ["Fmu", "Written", "write_cross_check"]
