"""The force element for other programs: as sources of C, as an FMU, and in the words of the tools people use."""

from .c_element import CElement
from .targets import TARGETS, Job, Target

__all__ = ["TARGETS", "CElement", "Job", "Target"]
