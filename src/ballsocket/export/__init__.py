"""Force elements for other programs: C sources, FMUs, and files for multibody codes."""

from .c_element import CElement
from .targets import TARGETS, ExportJob, Target

Job = ExportJob
"""Name of `ExportJob` in version 1.0."""

__all__ = ["TARGETS", "CElement", "ExportJob", "Job", "Target"]
