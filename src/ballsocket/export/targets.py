"""Export targets: the job of an export, the files of each target program, and their registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require
from ..core.storage.atomic_files import make_folder, write_text
from ..dynamics import ContactState, ForceElement, PreloadedElement
from ..dynamics.ball_centre import Constants
from ..problem import Joint
from ..version import __version__
from .c_element import BEYOND, CElement, fill_template
from .compiler import LIBRARY_ENDING, NoCompiler, shared_library
from .law_fit import ExpressionFit, PowerFit, expression_fit, power_fit
from .time_steps import TimeStepAdvice, time_step_advice
from .tunable import TUNABLES

_NOT_CENTRAL = (
    "the force of a preloaded joint depends on the direction, which this target cannot represent: "
    "export c, drake, modelica or mujoco, or table for splines along two axes, or use `ballsocket fmu`"
)

Texts = Mapping[str, str]  # contents of files by their names


@dataclass(frozen=True, kw_only=True, eq=False)
class ExportJob:
    """Export of one force element: the element, the name of its files, and the largest fitted indentation in mm.

    `beyond` says what follows an indentation beyond the range of the law, see `CElement`. The ball of `mass` in kg is
    for the advice on time steps.
    """

    element: ForceElement | PreloadedElement
    name: str
    depth: float
    beyond: str = "extend"
    mass: float = 1.0

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
            raise ValueError(_NOT_CENTRAL)
        return self.element

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
            "through_wall": f"{ContactState.THROUGH_WALL.value}: {BEYOND[self.beyond]}",
            "failed": str(self.c_program.first_failure.value),
        }

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
    beyond_range : str
        What follows an indentation beyond the range of the law, if the program does not use the C program.
    central : bool
        True if the program has a force that depends on the distance of the centres alone.
    """

    name: str
    title: str
    texts: Callable[[ExportJob], Texts]
    compiled: Callable[[ExportJob, Path], str] = lambda job, folder: ""
    note: Callable[[ExportJob], str] = lambda job: ""
    without: tuple[str, ...] = ()
    beyond_range: str = ""
    central: bool = False

    def check(self, joint: Joint) -> None:
        """Raise ValueError for a preloaded joint whose force the program cannot represent, before it is solved."""
        if self.central and joint.clearance < 0:
            raise ValueError(_NOT_CENTRAL)

    def write(self, job: ExportJob, folder: Path) -> tuple[list[Path], str]:
        """Write the files of an export job into a folder; return their paths, and notes on omitted features.

        Raises
        ------
        OSError
            A folder that cannot be made, or written to.
        """
        texts = self.file_texts(job)
        make_folder(folder)
        paths = []
        for name, text in texts.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            paths.append(write_text(folder / name, text))
        return paths, "; ".join(filter(None, (self.compiled(job, folder), self._omitted_features(job), self.note(job))))

    def file_texts(self, job: ExportJob) -> Texts:
        """Return the contents of all files of a job by name: those of the program, and a page on their use."""
        page = fill_template(
            "readme.txt",
            title=self.title,
            beyond_range=self.beyond_range or BEYOND[job.beyond],
            notes="\n".join(filter(None, (self._omitted_features(job), self.note(job)))),
            time_steps=str(job.time_steps),
            **job.template_context,
        )
        return {**self.texts(job), f"{job.name}_readme.txt": page}

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
    "a lubricant": lambda constants: constants.film_damping > 0.0,
}
"""Features of an element that a target may lack, with the test for each of them."""

_LINE_OF_CENTRES = tuple(name for name in FEATURES if name != "damping")
"""Features that one force along the line of centres cannot represent."""


def _python_module_texts(job: ExportJob) -> dict[str, str]:
    """Return the texts of the C program and of the Python module that loads it, by file name."""
    return {**job.program_texts(), f"{job.name}.py": fill_template("module.py.txt", **job.template_context)}


def _compile_library(job: ExportJob, folder: Path) -> str:
    """Compile the C library that the Python module loads; return a note if the compilation fails."""
    try:
        shared_library([f"{job.name}.c"], Path(job.template_context["library"]), folder)
    except NoCompiler as error:
        return f"{error}; the sources are written and will be compiled at first use"
    return ""


def _opensim_texts(job: ExportJob) -> Texts:
    """Return the text of the OpenSim file with an expression force, by file name."""
    fitted_expression, element = job.fitted_expression, job.central_element
    accuracy = fitted_expression.range_note or f"within {100 * fitted_expression.error:.1g} % of the law"
    hysteresis = element.damping.hysteresis if element.damping else 0.0
    expression = fitted_expression.text("d", "ddot", 1e3 * hysteresis)
    inertia = repr(0.4 * (1e-3 * element.constants.ball_radius) ** 2)
    return {
        f"{job.name}.osim": fill_template(
            "opensim.osim", expression=expression, nearness=accuracy, inertia=inertia, **job.template_context
        )
    }


def _mujoco_texts(job: ExportJob) -> Texts:
    """Return the texts of the MuJoCo plug-in, callback and model, by file name."""
    radius = repr(1e-3 * job.element.constants.ball_radius)
    return {
        **_python_module_texts(job),
        f"{job.name}_mujoco.c": fill_template(
            "mujoco.c", stiffness=repr(1e3 * job.time_steps.stiffness), **job.template_context
        ),
        f"{job.name}_mujoco.py": fill_template("mujoco.py.txt", **job.template_context),
        f"{job.name}.xml": fill_template("mujoco.xml", ball_radius=radius, **job.template_context),
    }


def _compile_plugin(job: ExportJob, folder: Path) -> str:
    """Compile the C library, and the MuJoCo plug-in if MuJoCo is installed; return a note on a missing one."""
    library_note, mujoco = _compile_library(job, folder), find_spec("mujoco")
    if library_note or mujoco is None or not mujoco.submodule_search_locations:
        return library_note or "the plug-in is not compiled: mujoco, whose headers it needs, is not installed"
    package = Path(mujoco.submodule_search_locations[0])
    mujoco_library = next(iter(sorted(package.glob(f"libmujoco*{LIBRARY_ENDING}*"))), None)
    sources = [f"{job.name}.c", f"{job.name}_mujoco.c", *([str(mujoco_library)] if mujoco_library else [])]
    options = ("-isystem", str(package / "include"), f"-Wl,-rpath,{package}")
    try:
        shared_library(sources, Path(job.template_context["plugin"]), folder, options)
    except NoCompiler as error:
        return f"{error}; the plug-in is not compiled, its source is written"
    return ""


def _exudyn_texts(job: ExportJob) -> Texts:
    """Return the texts of the Python module and the Exudyn module with its power law, by file name."""
    power, constants = job.fitted_power_law, job.element.constants
    fit = {
        "stiffness": repr(power.stiffness * 1e3**power.exponent),
        "exponent": repr(power.exponent),
        "depth": f"{1e-3 * power.depth:.4g}",
        "error": f"{100 * power.error:.2g} %",
        "ball_radius": repr(1e-3 * constants.ball_radius),
        "socket_radius": repr(1e-3 * constants.socket_radius),
    }
    return {
        **_python_module_texts(job),
        f"{job.name}_exudyn.py": fill_template("exudyn.py.txt", **fit, **job.template_context),
    }


def _modelica_texts(job: ExportJob) -> Texts:
    """Return the texts of the Modelica package and its C program, by file name."""
    constants = job.element.constants
    declarations = "\n".join(
        f'    parameter Real {number.name}(unit="{number.si_unit}", min=0) = {start * number.si!r} "{number.meaning}";'
        for number in TUNABLES
        for start in (getattr(constants, number.constant),)
    )
    copies = "\n".join(f"    p.{parameter.name} = own[{index}];" for index, parameter in enumerate(TUNABLES))
    names = ", ".join(parameter.name for parameter in TUNABLES)
    include, context = f"{job.name}/Resources/Include", job.template_context
    return {
        f"{job.name}/package.mo": fill_template(
            "modelica.mo", declared=declarations, names=names, **job.template_context
        ),
        f"{include}/{job.name}_modelica.c": fill_template("modelica.c", copied=copies, **context),
        **{f"{include}/{name}": text for name, text in job.program_texts().items()},
    }


def _table_texts(job: ExportJob) -> Texts:
    """Return the texts of the table of the force law and of the fitted power law, by file name.

    The force of a preloaded joint is no power law: it has a table with both signs along two axes.
    """
    if isinstance(job.element, PreloadedElement):
        return {f"{job.name}_law.csv": _preloaded_table(job.element)}
    return {
        f"{job.name}_law.csv": _law_table(job.central_element, job.depth),
        f"{job.name}_power.txt": _power_law_text(job.central_element, job.fitted_power_law, __version__),
    }


_TABLE_ROWS = 201  # number of indentations in a table of the law

_COLUMNS = ("indentation_mm", "force_N", "stiffness_N/mm", "energy_N_mm", "half_angle_deg", "max_pressure_MPa")


def _law_table(element: ForceElement, depth: float) -> str:
    """Return a CSV table of force, stiffness, energy, half angle and pressure up to an indentation in mm."""
    depths = numpy.linspace(0.0, depth, _TABLE_ROWS)
    energy, force, stiffness = element.potential(depths)
    angle = numpy.degrees(element.half_angle(depths))
    columns = (depths, force, stiffness, energy, angle, element.max_pressure(depths))
    return _csv_text(_COLUMNS, columns)


_PRELOADED_COLUMNS = (
    "displacement_mm",
    *(f"{name}_{axis}" for axis in ("along", "across") for name in ("force_N", "max_pressure_MPa")),
)


def _preloaded_table(element: PreloadedElement) -> str:
    """Return a CSV table over the displacement from rest in mm, along the axis of the dome and across it.

    The force on the ball is in the direction of the displacement, negative for a positive one.
    """
    distances = numpy.linspace(-element.wall, element.wall, _TABLE_ROWS) * (1 - 1e-9)
    constants, columns = element.constants, [distances]
    dome = numpy.array([constants.dome_x, constants.dome_y, constants.dome_z])
    across = numpy.cross(dome, numpy.eye(3)[numpy.argmin(abs(dome))])
    for axis in (dome, across / numpy.linalg.norm(across)):
        load = element(element.rest_position + distances[:, None] * axis)
        columns += [load.force @ axis, load.max_pressure]
    return _csv_text(_PRELOADED_COLUMNS, columns)


def _csv_text(heads: Sequence[str], columns: Sequence[Numbers]) -> str:
    """Return a CSV table with nine digits."""
    rows = numpy.stack(columns, axis=1).tolist()
    return "\n".join([",".join(heads), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def _two_axes_note(job: ExportJob) -> str:
    """Return the note on the directions of the table of a preloaded joint; empty for other joints."""
    if not isinstance(job.element, PreloadedElement):
        return ""
    return (
        "force on the ball over its displacement from rest, along the cup's axis (positive to the dome) and across it; "
        "for other directions export c, drake, modelica or mujoco, or use `ballsocket fmu`"
    )


def _power_law_text(element: ForceElement, fit: PowerFit, version: str) -> str:
    """Return the fitted power law as text, with expressions for Adams, MotionSolve and Simpack in mm, N and s."""
    c, k, n = element.constants.clearance, fit.stiffness, fit.exponent
    return f"""# F = k d^n of a ball in a socket, in mm, N and s; written by ballsocket {version}
# {element.model.name}: error up to {fit.depth:.4g} mm at most {100 * fit.error:.2g} % of the force at that depth
k = {k!r}
n = {n!r}
clearance = {c!r}

# Adams and MotionSolve: a force along the line of centres of two markers, ball on socket; mm, N
-{k!r} * MAX(DM(ball, socket) - {c!r}, 0)**{n!r}

# Simpack: an expression, x the distance of the markers
-{k!r} * MAX(x - {c!r}, 0)^{n!r}
"""


TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target(name="c", title="C99 sources without other libraries", texts=ExportJob.program_texts),
        Target(
            name="opensim",
            title="an expression force in an .osim file",
            texts=_opensim_texts,
            note=lambda job: job.fitted_expression.range_note,
            beyond_range="the expression goes on beyond the range of the law, as a power of the indentation",
            without=_LINE_OF_CENTRES,
            central=True,
        ),
        Target(name="mujoco", title="a passive plug-in and a callback", texts=_mujoco_texts, compiled=_compile_plugin),
        Target(
            name="drake",
            title="a LeafSystem",
            texts=lambda job: {
                **_python_module_texts(job),
                f"{job.name}_drake.py": fill_template("drake.py.txt", **job.template_context),
            },
            compiled=_compile_library,
        ),
        Target(
            name="exudyn",
            title="a user function and its hollow sphere",
            texts=_exudyn_texts,
            compiled=_compile_library,
            central=True,
        ),
        Target(name="modelica", title="a package around the law in C", texts=_modelica_texts),
        Target(
            name="table",
            title="a table, and k and n for Adams, MotionSolve and Simpack",
            texts=_table_texts,
            beyond_range="the table ends at the range of the law",
            note=_two_axes_note,
            without=tuple(FEATURES),
        ),
    )
}
"""Targets of `ballsocket export` by name; a target in another module gets one line here."""
