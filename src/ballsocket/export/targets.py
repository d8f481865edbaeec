"""The programs that a joint can be exported to, and the files that each of them is given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path

from ..core.storage.atomic_files import write_text
from ..dynamics import ForceElement, Touch
from ..dynamics.reaction import Constants
from ..version import __version__
from .c_element import CElement, filled
from .compiler import LIBRARY_ENDING, NoCompiler, shared_library
from .law_fit import ExpressionFit, PowerFit, expression_fit, power_fit
from .tables import law_table, power_words
from .tunable import TUNABLES

Texts = Mapping[str, str]


@dataclass(frozen=True, kw_only=True, eq=False)
class Job:
    """What is exported: an element, the name of its files, and up to what indentation (mm) a fit is to be good."""

    element: ForceElement
    name: str
    depth: float

    @cached_property
    def program(self) -> CElement:
        return CElement(element=self.element, name=self.name)

    @cached_property
    def power(self) -> PowerFit:
        return power_fit(self.element, self.depth)

    @cached_property
    def expression(self) -> ExpressionFit:
        return expression_fit(self.element, self.depth)

    @property
    def words(self) -> dict[str, str]:
        """What the texts are filled with."""
        return {
            **self.program.about,
            "name": self.name,
            "NAME": self.name.upper(),
            "library": f"_{self.name}{LIBRARY_ENDING}",
            "plugin": f"_{self.name}_plugin{LIBRARY_ENDING}",
            "parameters": str(len(TUNABLES)),
            "units": ", ".join(repr(each.si) for each in TUNABLES),
            "tunables": ", ".join(each.name for each in TUNABLES),
            "failed": str(Touch.THROUGH_WALL.value),
        }

    def program_texts(self) -> dict[str, str]:
        return {f"{self.name}.h": self.program.header, f"{self.name}.c": self.program.source}


@dataclass(frozen=True, kw_only=True)
class Target:
    """Program that joints are exported to.

    Attributes
    ----------
    name, title : str
    texts : function
        The files of a job, by name.
    compiled : function
        Compiles the libraries of the program into a folder; returns a note on missing ones.
    note : function
        Note on the accuracy of a job's files; empty without one.
    without : tuple of str
        Features that the program cannot represent, by the names of `_LOSSES`.
    """

    name: str
    title: str
    texts: Callable[[Job], Texts]
    compiled: Callable[[Job, Path], str] = lambda job, folder: ""
    note: Callable[[Job], str] = lambda job: ""
    without: tuple[str, ...] = ()

    def write(self, job: Job, folder: Path) -> tuple[list[Path], str]:
        """Write the files into a folder; return their paths and notes on missing or limited features.

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
        return paths, "; ".join(filter(None, (self.compiled(job, folder), self._left_out(job), self.note(job))))

    def _left_out(self, job: Job) -> str:
        lost = [name for name in self.without if _LOSSES[name](job.element.constants)]
        return f"{self.name} has no words for {' and '.join(lost)}: left out" if lost else ""


_LOSSES: Mapping[str, Callable[[Constants], bool]] = {
    "friction": lambda given: given.static + given.viscous > 0.0,
    "damping": lambda given: given.hysteresis > 0.0,
    "a liner that takes its time": lambda given: given.time > 0.0,
    "the cup's rim": lambda given: given.rim > 0.0,
    "a smooth touch-down": lambda given: given.smoothing > 0.0,
}
_LINE_OF_CENTRES = tuple(name for name in _LOSSES if name != "damping")


def _module(job: Job) -> dict[str, str]:
    return {**job.program_texts(), f"{job.name}.py": filled("module.py.txt", **job.words)}


def _library(job: Job, folder: Path) -> str:
    """The library that the module in Python loads."""
    try:
        shared_library([f"{job.name}.c"], Path(job.words["library"]), folder)
    except NoCompiler as missing:
        return f"{missing}; the sources are there, and compiled where they are first used"
    return ""


def _opensim(job: Job) -> Texts:
    fit, element = job.expression, job.element
    near = fit.range_note or f"within {100 * fit.error:.1g} % of the law"
    lost = element.damping.hysteresis if element.damping else 0.0
    expression = fit.text("d", "ddot", 1e3 * lost)
    ball = repr(0.4 * (1e-3 * element.constants.ball_radius) ** 2)
    return {f"{job.name}.osim": filled("opensim.osim", expression=expression, nearness=near, inertia=ball, **job.words)}


def _mujoco(job: Job) -> Texts:
    radius = repr(1e-3 * job.element.constants.ball_radius)
    return {
        **_module(job),
        f"{job.name}_mujoco.c": filled("mujoco.c", **job.words),
        f"{job.name}_mujoco.py": filled("mujoco.py.txt", **job.words),
        f"{job.name}.xml": filled("mujoco.xml", ball_radius=radius, **job.words),
    }


def _plugin(job: Job, folder: Path) -> str:
    """The library, and the plug-in where MuJoCo is there to compile it with."""
    missing, found = _library(job, folder), find_spec("mujoco")
    if missing or found is None or not found.submodule_search_locations:
        return missing or "mujoco is not installed, whose headers the plug-in needs; its source is there"
    room = Path(found.submodule_search_locations[0])
    linked = next(iter(sorted(room.glob(f"libmujoco*{LIBRARY_ENDING}*"))), None)
    sources = [f"{job.name}.c", f"{job.name}_mujoco.c", *([str(linked)] if linked else [])]
    options = ("-isystem", str(room / "include"), f"-Wl,-rpath,{room}")
    try:
        shared_library(sources, Path(job.words["plugin"]), folder, options)
    except NoCompiler as error:
        return f"{error}; the source of the plug-in is there"
    return ""


def _drake(job: Job) -> Texts:
    return {**_module(job), f"{job.name}_drake.py": filled("drake.py.txt", **job.words)}


def _exudyn(job: Job) -> Texts:
    power, constants = job.power, job.element.constants
    fit = {
        "stiffness": repr(power.stiffness * 1e3**power.exponent),
        "exponent": repr(power.exponent),
        "depth": f"{1e-3 * power.depth:.4g}",
        "error": f"{100 * power.error:.2g} %",
        "ball_radius": repr(1e-3 * constants.ball_radius),
        "socket_radius": repr(1e-3 * constants.socket_radius),
    }
    return {**_module(job), f"{job.name}_exudyn.py": filled("exudyn.py.txt", **fit, **job.words)}


def _modelica(job: Job) -> Texts:
    constants = job.element.constants
    declared = "\n".join(
        f'    parameter Real {each.name}(unit="{each.si_unit}", min=0) = {start * each.si!r} "{each.meaning}";'
        for each in TUNABLES
        for start in (getattr(constants, each.constant),)
    )
    copied = "\n".join(f"    p.{each.name} = own[{number}];" for number, each in enumerate(TUNABLES))
    names = ", ".join(each.name for each in TUNABLES)
    include = f"{job.name}/Resources/Include"
    return {
        f"{job.name}/package.mo": filled("modelica.mo", declared=declared, names=names, **job.words),
        f"{include}/{job.name}_modelica.c": filled("modelica.c", copied=copied, **job.words),
        **{f"{include}/{name}": text for name, text in job.program_texts().items()},
    }


def _table(job: Job) -> Texts:
    return {
        f"{job.name}_law.csv": law_table(job.element, job.depth),
        f"{job.name}_power.txt": power_words(job.element, job.power, __version__),
    }


TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target(name="c", title="sources of C99 that need no library", texts=Job.program_texts),
        Target(
            name="opensim",
            title="an expression force in an .osim file",
            texts=_opensim,
            note=lambda job: job.expression.range_note,
            without=_LINE_OF_CENTRES,
        ),
        Target(name="mujoco", title="a passive plug-in, and a callback", texts=_mujoco, compiled=_plugin),
        Target(name="drake", title="a LeafSystem", texts=_drake, compiled=_library),
        Target(name="exudyn", title="a user function, and its hollow sphere", texts=_exudyn, compiled=_library),
        Target(name="modelica", title="a package around the law in C", texts=_modelica),
        Target(
            name="table",
            title="a table, and k and n for Adams, MotionSolve, Simpack",
            texts=_table,
            without=tuple(_LOSSES),
        ),
    )
}
"""All of them, by name."""
