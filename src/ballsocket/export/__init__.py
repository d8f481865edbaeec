"""Force elements for other programs: C sources, FMUs, and files for multibody codes."""

from .c_element import CElement
from .job import ExportJob
from .targets import TARGETS, Target

__all__ = ["TARGETS", "CElement", "ExportJob", "Target"]
