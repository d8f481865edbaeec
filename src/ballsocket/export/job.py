"""Job of an export: a force element with its C program, its fits and the values of file templates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from ..core.checks import known_name, require
from ..dynamics import ContactState, ForceElement, PreloadedElement
from .c_element import BEYOND, CElement, fill_template
from .compiler import LIBRARY_ENDING
from .law_fit import ExpressionFit, PowerFit, expression_fit, power_fit
from .time_steps import TimeStepAdvice, time_step_advice

NOT_CENTRAL = (
    "the force of a preloaded joint depends on the direction, which this target cannot represent: "
    "export c, drake, modelica or mujoco, or table for splines along two axes, or use `ballsocket fmu`"
)

Texts = Mapping[str, str]  # contents of files by their names


@dataclass(frozen=True, kw_only=True, eq=False)
class ExportJob:
    """Export of one force element: the element, the name of its files, and the largest fitted indentation in mm.

    `beyond` says what follows an indentation beyond the range of the law, see `CElement`. The ball of `mass` in kg is
    for the advice on time steps. `tilt` is the angle in rad between the first axis of a table and the axis of the dome.
    """

    element: ForceElement | PreloadedElement
    name: str
    depth: float
    beyond: str = "extend"
    mass: float = 1.0
    tilt: float = 0.0

    def __post_init__(self) -> None:
        require("mass", self.mass, self.mass > 0.0, "it must be above 0 kg")
        object.__setattr__(self, "beyond", known_name("beyond", self.beyond, BEYOND))

    @cached_property
    def c_program(self) -> CElement:
        """C source and header of the force element."""
        return CElement(element=self.element, name=self.name, beyond=self.beyond)

    @cached_property
    def fitted_power_law(self) -> PowerFit:
        """Fitted power law F = k d^n of the force element."""
        return power_fit(self.central_element, self.depth)

    @cached_property
    def fitted_expression(self) -> ExpressionFit:
        """Force law fitted as one expression of the distance."""
        return expression_fit(self.central_element, self.depth)

    @cached_property
    def time_steps(self) -> TimeStepAdvice:
        """Time steps for a host program."""
        return time_step_advice(self.element, self.depth or self.element.wall, self.mass)

    @property
    def central_element(self) -> ForceElement:
        """Element whose force depends on the distance of the centres alone.

        Raises
        ------
        ValueError
            A preloaded joint.
        """
        if isinstance(self.element, PreloadedElement):
            raise ValueError(NOT_CENTRAL)
        return self.element

    @property
    def template_context(self) -> dict[str, str]:
        """Values for the placeholders of file templates, by name."""
        return {
            **self.c_program.about,
            "name": self.name,
            "NAME": self.name.upper(),
            "Name": self.name.capitalize(),
            "library": f"_{self.name}{LIBRARY_ENDING}",
            "plugin": f"_{self.name}_plugin{LIBRARY_ENDING}",
            "parameters": str(len(self.c_program.tunables)),
            "units": ", ".join(repr(parameter.si) for parameter in self.c_program.tunables),
            "tunables": ", ".join(parameter.name for parameter in self.c_program.tunables),
            "through_wall": f"{ContactState.THROUGH_WALL.value}: {BEYOND[self.beyond]}",
            "failed": str(self.c_program.first_failure.value),
        }

    def program_texts(self) -> dict[str, str]:
        """Return the texts of the C header and source, by file name."""
        return {f"{self.name}.h": self.c_program.header, f"{self.name}.c": self.c_program.source}

    def file(self, template: str, **values: str) -> Texts:
        """Return the text of a filled template by the name of its file, which begins with the name of the job."""
        text = fill_template(template, **values, **self.template_context)
        return {f"{self.name}_{template.removesuffix('.txt')}": text}

    def python_module_texts(self) -> dict[str, str]:
        """Return the texts of the C program and of the Python module that loads it, by file name."""
        module = fill_template("module.py.txt", **self.template_context)
        return {**self.program_texts(), f"{self.name}.py": module}

    def readme(self, title: str, beyond_range: str = "", notes: str = "") -> str:
        """Return the text of a page on the use of the files: model, joint, time steps, range and notes."""
        return fill_template(
            "readme.txt",
            title=title,
            beyond_range=beyond_range or BEYOND[self.beyond],
            notes=notes,
            time_steps=str(self.time_steps),
            **self.template_context,
        )
