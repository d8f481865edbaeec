"""Export targets: a target program, and the job of writing files for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..core.deprecation import RenamedAttribute
from ..core.storage.atomic_files import write_text
from ..dynamics import ContactState, ForceElement
from ..dynamics.reaction import Constants
from .c_element import CElement
from .compiler import LIBRARY_ENDING
from .law_fit import ExpressionFit, PowerFit, expression_fit, power_fit
from .tunable import TUNABLES

Texts = Mapping[str, str]
"""Contents of files by their names."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ExportJob:
    """Export of one force element: the element, the name of its files, and the largest fitted indentation in mm."""

    element: ForceElement
    name: str
    depth: float

    @cached_property
    def c_program(self) -> CElement:
        """C source and header of the force element."""
        return CElement(element=self.element, name=self.name)

    @cached_property
    def fitted_power_law(self) -> PowerFit:
        """Fitted power law F = k d^n of the force element."""
        return power_fit(self.element, self.depth)

    @cached_property
    def fitted_expression(self) -> ExpressionFit:
        """Force law fitted as one expression of the distance."""
        return expression_fit(self.element, self.depth)

    @property
    def template_context(self) -> dict[str, str]:
        """Values for the placeholders of file templates, by name."""
        return {
            **self.c_program.about,
            "name": self.name,
            "NAME": self.name.upper(),
            "library": f"_{self.name}{LIBRARY_ENDING}",
            "plugin": f"_{self.name}_plugin{LIBRARY_ENDING}",
            "parameters": str(len(TUNABLES)),
            "units": ", ".join(repr(parameter.si) for parameter in TUNABLES),
            "tunables": ", ".join(parameter.name for parameter in TUNABLES),
            "failed": str(ContactState.THROUGH_WALL.value),
        }

    words = RenamedAttribute("template_context")

    def program_texts(self) -> dict[str, str]:
        """Return the texts of the C header and source, by file name."""
        return {f"{self.name}.h": self.c_program.header, f"{self.name}.c": self.c_program.source}


@dataclass(frozen=True, kw_only=True)
class Target:
    """Target program of an export, with the functions that write its files.

    Attributes
    ----------
    name, title : str
    texts : function
        Contents of the files of a job, by name.
    compiled : function
        Compiles the libraries of the program into a folder; returns a note on missing ones.
    note : function
        Note on the accuracy of a job's files; empty without one.
    without : tuple of str
        Features that the program cannot represent, by the names of `FEATURES`.
    """

    name: str
    title: str
    texts: Callable[[ExportJob], Texts]
    compiled: Callable[[ExportJob, Path], str] = lambda job, folder: ""
    note: Callable[[ExportJob], str] = lambda job: ""
    without: tuple[str, ...] = ()

    def write(self, job: ExportJob, folder: Path) -> tuple[list[Path], str]:
        """Write the files of an export job into a folder; return their paths, and notes on omitted features.

        Raises
        ------
        OSError
            A folder that cannot be made, or written to.
        """
        folder.mkdir(parents=True, exist_ok=True)
        paths = []
        for name, text in self.texts(job).items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            paths.append(write_text(folder / name, text))
        return paths, "; ".join(filter(None, (self.compiled(job, folder), self._omitted_features(job), self.note(job))))

    def _omitted_features(self, job: ExportJob) -> str:
        """Describe the features of the element that the target program cannot represent; empty if none."""
        omitted = [name for name in self.without if FEATURES[name](job.element.constants)]
        return f"{self.name} cannot represent {' and '.join(omitted)}: omitted" if omitted else ""


FEATURES: Mapping[str, Callable[[Constants], bool]] = {
    "friction": lambda constants: constants.static + constants.viscous > 0.0,
    "damping": lambda constants: constants.hysteresis > 0.0,
    "the retardation time of the liner": lambda constants: constants.time > 0.0,
    "the rim of the cup": lambda constants: constants.rim > 0.0,
    "a smoothed first touch": lambda constants: constants.smoothing > 0.0,
}
"""Features of an element that a target may lack, with the test for each of them."""
