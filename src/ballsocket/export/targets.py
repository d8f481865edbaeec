"""Export targets: the files of each target program, and their registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from ..core.storage.atomic_files import make_folder, write_text
from ..dynamics.ball_centre import Constants
from ..problem import Joint
from .c_element import fill_template
from .compiler import LIBRARY_ENDING, NoCompiler, shared_library
from .job import NOT_CENTRAL, ExportJob, Texts
from .law_tables import pivot_texts, table_texts, two_axes_note
from .warp import warp_texts


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
    states : bool
        True if the program can have internal states: deflections of bristles, relaxed forces of a liner.
    """

    name: str
    title: str
    texts: Callable[[ExportJob], Texts]
    compiled: Callable[[ExportJob, Path], str] = lambda job, folder: ""
    note: Callable[[ExportJob], str] = lambda job: ""
    without: tuple[str, ...] = ()
    beyond_range: str = ""
    central: bool = False
    states: bool = False

    def check(self, joint: Joint) -> None:
        """Raise ValueError for a preloaded joint whose force the program cannot represent, before it is solved."""
        if self.central and joint.clearance < 0:
            raise ValueError(NOT_CENTRAL)

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
        """Return the contents of all files of a job by name: those of the program, and a page on their use.

        Raises ValueError: an internal state that the program cannot represent.
        """
        if job.element.internal_states and not self.states:
            raise ValueError(f"{job.element.internal_state}, which {self.name} cannot represent: export c or an FMU")
        notes = "\n".join(filter(None, (self._omitted_features(job), self.note(job))))
        page = job.readme(self.title, self.beyond_range, notes)
        return {**self.texts(job), f"{job.name}_readme.txt": page}

    def _omitted_features(self, job: ExportJob) -> str:
        """Describe the features of the element that the target program cannot represent; empty if none."""
        omitted = [name for name in self.without if FEATURES[name](job.element.constants)]
        return f"{self.name} cannot represent {' and '.join(omitted)}: omitted" if omitted else ""


_SMOOTHED = "a smoothed first touch"

FEATURES: Mapping[str, Callable[[Constants], bool]] = {
    "friction": lambda constants: constants.static + constants.viscous > 0.0,
    "damping": lambda constants: constants.hysteresis > 0.0,
    "the retardation time of the liner": lambda constants: constants.time > 0.0,
    "the rim of the cup": lambda constants: constants.rim > 0.0,
    _SMOOTHED: lambda constants: constants.smoothing > 0.0,
    "a lubricant": lambda constants: constants.film_damping > 0.0,
}
"""Features of an element that a target may lack, with the test for each of them."""

_DIRECTED = tuple(name for name in FEATURES if name not in ("damping", _SMOOTHED))
"""Features that one expression of the distance cannot represent."""


def _compile_library(job: ExportJob, folder: Path) -> str:
    """Compile the C library that the Python module loads; return a note if the compilation fails."""
    try:
        shared_library([f"{job.name}.c"], Path(job.template_context["library"]), folder)
    except NoCompiler as error:
        return f"{error}; the sources are written and will be compiled at first use"
    return ""


def _opensim_texts(job: ExportJob) -> Texts:
    """Return the texts of the OpenSim file with an expression force, and of a plug-in, by file name."""
    fitted_expression, element = job.fitted_expression, job.central_element
    radius, hysteresis = 1e-3 * element.constants.ball_radius, element.constants.hysteresis
    file = fill_template(
        "opensim.osim",
        expression=fitted_expression.text("d", "ddot", 1e3 * hysteresis),
        nearness=fitted_expression.range_note or f"within {100 * fitted_expression.error:.1g} % of the law",
        differentiability=fitted_expression.differentiability(hysteresis > 0.0),
        inertia=repr(0.4 * radius**2),
        **job.template_context,
    )
    return {f"{job.name}.osim": file, **job.program_texts(), **job.file("opensim.cpp", ball_radius=repr(radius))}


def _opensim_note(job: ExportJob) -> str:
    """Return the note on the accuracy and smoothness of the expression, and on what only the plug-in has."""
    fit, constants = job.fitted_expression, job.element.constants
    order = f"the expression is {fit.differentiability(constants.hysteresis > 0.0)}"
    lost = any(FEATURES[name](constants) for name in _DIRECTED)
    return "; ".join(filter(None, (f"{job.name}_opensim.cpp has every feature" if lost else "", fit.range_note, order)))


def _mujoco_texts(job: ExportJob) -> Texts:
    """Return the texts of the MuJoCo plug-in, callback and model, by file name."""
    radius = repr(1e-3 * job.element.constants.ball_radius)
    return {
        **job.python_module_texts(),
        **job.file("mujoco.c", stiffness=repr(1e3 * job.time_steps.stiffness)),
        **job.file("mujoco.py.txt"),
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
    module = job.file(
        "exudyn.py.txt",
        stiffness=repr(power.stiffness * 1e3**power.exponent),
        exponent=repr(power.exponent),
        depth=f"{1e-3 * power.depth:.4g}",
        error=f"{100 * power.error:.2g} %",
        ball_radius=repr(1e-3 * constants.ball_radius),
        socket_radius=repr(1e-3 * constants.socket_radius),
    )
    return {**job.python_module_texts(), **module}


def _modelica_texts(job: ExportJob) -> Texts:
    """Return the texts of the Modelica package and its C program, by file name."""
    tunables, context = job.c_program.tunables, job.template_context
    declarations = "\n".join(
        f'    parameter Real {number.name}(unit="{number.si_unit}", min=0) = {number.value(job.element) * number.si!r} '
        f'"{number.meaning}";'
        for number in tunables
    )
    copies = "\n".join(f"    p.{parameter.name} = own[{index}];" for index, parameter in enumerate(tunables))
    include = f"{job.name}/Resources/Include"
    return {
        f"{job.name}/package.mo": fill_template(
            "modelica.mo", declared=declarations, names=context["tunables"], **context
        ),
        f"{include}/{job.name}_modelica.c": fill_template("modelica.c", copied=copies, **context),
        **{f"{include}/{name}": text for name, text in job.program_texts().items()},
    }


TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target(name="c", title="C99 sources without other libraries", texts=ExportJob.program_texts, states=True),
        Target(
            name="opensim",
            title="an expression force in an .osim file, and a plug-in",
            texts=_opensim_texts,
            note=_opensim_note,
            beyond_range="the expression goes on beyond the range of the law, as a power of the indentation",
            without=_DIRECTED,
            central=True,
        ),
        Target(name="mujoco", title="a passive plug-in and a callback", texts=_mujoco_texts, compiled=_compile_plugin),
        Target(
            name="drake",
            title="a LeafSystem",
            texts=lambda job: {**job.python_module_texts(), **job.file("drake.py.txt")},
            compiled=_compile_library,
        ),
        Target(
            name="exudyn",
            title="a user function and its hollow sphere",
            texts=_exudyn_texts,
            compiled=_compile_library,
            central=True,
        ),
        Target(
            name="adams",
            title="a user subroutine GFOSUB in C",
            texts=lambda job: {**job.program_texts(), **job.file("adams.c")},
        ),
        Target(
            name="simpack",
            title="a user force element in Fortran, around the law in C",
            texts=lambda job: {**job.program_texts(), **job.file("simpack.f90")},
        ),
        Target(name="modelica", title="a package around the law in C", texts=_modelica_texts),
        Target(
            name="table",
            title="a table, and k and n for Adams, MotionSolve and Simpack",
            texts=table_texts,
            beyond_range="the table ends at the range of the law",
            note=two_axes_note,
            without=tuple(name for name in FEATURES if name != "the rim of the cup"),
        ),
        Target(name="warp", title="functions of Warp, for Newton and MuJoCo Warp", texts=warp_texts, central=True),
        Target(
            name="ross",
            title="force, indentation and stiffness of a pivot, for ROSS",
            texts=pivot_texts,
            beyond_range="the table ends at the range of the law",
            without=tuple(FEATURES),
            central=True,
        ),
    )
}
"""Targets of `ballsocket export` by name; a target in another module gets one line here."""
