"""Force elements for other programs: C sources, FMUs, and files for multibody codes."""

from .c_element import CElement
from .targets import TARGETS, ExportJob, Target

__all__ = ["TARGETS", "CElement", "ExportJob", "Target"]
