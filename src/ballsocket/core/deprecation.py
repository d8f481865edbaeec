"""Names of version 1.0 that have changed since: modules, functions and classes, attributes, and keyword arguments.

The old name of a function, class, attribute or argument still works, with a DeprecationWarning that states the new one.
The old path of a module works without a warning.
"""

from __future__ import annotations

import functools
import sys
import warnings
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import FunctionType, ModuleType
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_OFF_AXIS_MODULES = {
    **dict.fromkeys(("harmonics", "real_cup", "ring_matrices", "rings_of_modes"), "surfaces"),
    **dict.fromkeys(("loads", "rim"), "load_cases"),
    **dict.fromkeys(("forms", "worn"), "bore_shapes"),
    "balance": "equilibrium",
    "bricks": "deck",
    "edges": "surfaces",
    "gap": "bore_contact",
    "patch": "contact_patch",
    "search": "bore_contact",
    "solver": "pressure_solver",
    "states": "contact_states",
}
"""New names of the modules of `ballsocket.sphere`."""

_REPORT_MODULES = {
    **dict.fromkeys(("accuracy_plot", "accuracy_table", "reference_terminal"), "accuracy_results"),
    **dict.fromkeys(("cup_plot", "cup_section", "cup_view"), "cup_plots"),
    "design_map": "study_plots",
    "evidence_sections": "evidence_page",
    **dict.fromkeys(("evidence_words", "evidence_text", "evidence_figures"), "evidence_parts"),
    "gait_plot": "hip_plots",
    **dict.fromkeys(("hip_bands", "hip_contact", "hip_terminal"), "hip_tables"),
    "html": "pages",
    **dict.fromkeys(("identify_plots", "identify_terminal"), "identify_results"),
    **dict.fromkeys(("list_summary", "list_terminal"), "catalogue_lists"),
    **dict.fromkeys(("orientation_plot", "orientation_terminal"), "orientation_results"),
    "joint_report": "press_report",
    **dict.fromkeys(("press_plot", "quick_plot", "dynamics_plots"), "press_plots"),
    **dict.fromkeys(("report", "report_tables", "paper_plots"), "paper_report"),
    **dict.fromkeys(("save", "registration"), "figure_files"),
    **dict.fromkeys(("section_scale", "joint_section", "section_plot"), "section_plots"),
    **dict.fromkeys(("study_summary", "study_terminal"), "study_tables"),
}
"""New names of the modules of `ballsocket.output`."""

MOVED = {
    **{f"ballsocket.{name}": f"ballsocket.core.{name}" for name in ("arrays", "checks", "kinds", "quantities")},
    **{f"ballsocket.{name}": f"ballsocket.core.{name}" for name in ("sources", "stress", "validity", "input_files")},
    "ballsocket.atomic": "ballsocket.core.storage.atomic_files",
    "ballsocket.fingerprint": "ballsocket.core.storage.pieces",
    "ballsocket.npz": "ballsocket.core.storage.atomic_files",
    "ballsocket.core.plotting": "ballsocket.core.display",
    "ballsocket.engines": "ballsocket.core.executors",
    "ballsocket.engines.local": "ballsocket.core.executors.processes",
    "ballsocket.output": "ballsocket.reports",
    **{f"ballsocket.output.{old}": f"ballsocket.reports.{new}" for old, new in _REPORT_MODULES.items()},
    **{f"ballsocket.reports.{old}": f"ballsocket.reports.{new}" for old, new in _REPORT_MODULES.items()},
    "ballsocket.sphere.kept": "ballsocket.core.storage.atomic_files",
    **{f"ballsocket.studies.{name}": "ballsocket.studies.metadata" for name in ("identity", "labels")},
    **dict.fromkeys(
        ("ballsocket.studies.around", "ballsocket.studies.local_uncertainty"), "ballsocket.studies.derivatives"
    ),
    "ballsocket.studies.blocks": "ballsocket.studies.task",
    "ballsocket.studies.columns": "ballsocket.files.columns",
    "ballsocket.studies.optimum": "ballsocket.studies.optimisation",
    "ballsocket.studies.phrases": "ballsocket.studies.expressions",
    "ballsocket.studies.pieces": "ballsocket.studies.export",
    "ballsocket.studies.room": "ballsocket.core.executors.processes",
    "ballsocket.studies.rows": "ballsocket.studies.design",
    "ballsocket.studies.slopes": "ballsocket.studies.derivatives",
    "ballsocket.studies.sobol": "ballsocket.studies.sensitivity",
    **dict.fromkeys(("ballsocket.studies.usual", "ballsocket.studies.default_model"), "ballsocket.studies.run"),
    "ballsocket.studies.scatter": "ballsocket.studies.file",
    "ballsocket.hip.coefficient_response": "ballsocket.hip.uncertainty",
    "ballsocket.hip.checkpoint": "ballsocket.hip.simulation",
    "ballsocket.hip.cohort_results": "ballsocket.hip.variability",
    "ballsocket.hip.lives": "ballsocket.hip.cohort",
    "ballsocket.hip.patients": "ballsocket.hip.variability",
    "ballsocket.hip.scatter_file": "ballsocket.hip.config",
    "ballsocket.hip.coefficients": "ballsocket.hip.wear_law",
    "ballsocket.hip.creep": "ballsocket.hip.creep_laws",
    "ballsocket.hip.blocks": "ballsocket.hip.wear_integrator",
    "ballsocket.hip.contact_shares": "ballsocket.hip.socket_foundation",
    "ballsocket.hip.elastic_bed": "ballsocket.hip.elastic_foundation",
    "ballsocket.hip.facing": "ballsocket.hip.ball_wear",
    "ballsocket.hip.file": "ballsocket.hip.config",
    "ballsocket.hip.first": "ballsocket.hip.history",
    "ballsocket.hip.given_laws": "ballsocket.hip.config",
    "ballsocket.hip.levels": "ballsocket.hip.elastic_foundation",
    "ballsocket.hip.looks": "ballsocket.hip.simulation",
    "ballsocket.hip.near": "ballsocket.hip.ball_wear",
    "ballsocket.hip.placing": "ballsocket.hip.cup_frame",
    "ballsocket.hip.set_up": "ballsocket.hip.hip_setup",
    "ballsocket.hip.smoothing": "ballsocket.hip.elastic_foundation",
    "ballsocket.hip.spots": "ballsocket.hip.ball_wear",
    "ballsocket.hip.springs": "ballsocket.hip.socket_foundation",
    "ballsocket.hip.use": "ballsocket.hip.simulation",
    "ballsocket.hip.laws": "ballsocket.hip.wear_laws",
    "ballsocket.io": "ballsocket.files",
    "ballsocket.io.named_joint": "ballsocket.files.joint_file",
    "ballsocket.joint": "ballsocket.problem",
    "ballsocket.cup": "ballsocket.problem.cup",
    "ballsocket.gaps": "ballsocket.problem.gaps",
    "ballsocket.presets": "ballsocket.problem.presets",
    "ballsocket.model": "ballsocket.contact",
    "ballsocket.model.answer": "ballsocket.contact.assembly",
    "ballsocket.model.largest": "ballsocket.contact.roots",
    "ballsocket.model.theory": "ballsocket.contact.outcome",
    "ballsocket.pytrees": "ballsocket.compiled.pytrees",
    "ballsocket.elastic": "ballsocket.elasticity.exact",
    "ballsocket.elastic.curve": "ballsocket.elasticity.exact.load_curve",
    "ballsocket.elastic.fitted": "ballsocket.elasticity.exact.chebyshev_curve",
    "ballsocket.elastic.fitted_state": "ballsocket.elasticity.exact.chebyshev_curve",
    "ballsocket.elastic.stress_curve": "ballsocket.elasticity.exact.subsurface",
    "ballsocket.elastic.massive": "ballsocket.elasticity.exact.modes",
    "ballsocket.elastic.closed_forms": "ballsocket.elasticity.exact.grid",
    "ballsocket.elastic.intervals": "ballsocket.elasticity.exact.kernel",
    "ballsocket.elastic.tabulated.formulas": "ballsocket.elasticity.exact.tabulated.curves",
    "ballsocket.elastic.tabulated.solution": "ballsocket.elasticity.exact.tabulated.model",
    "ballsocket.fem.contact": "ballsocket.elasticity.finite_elements.model",
    "ballsocket.fem.export.vtk": "ballsocket.elasticity.finite_elements.section",
    **{
        f"ballsocket.fem.{name}": "ballsocket.elasticity.finite_elements.pair_contact"
        for name in ("full_contact", "round_contact")
    },
    "ballsocket.fem.memory": "ballsocket.elasticity.finite_elements.spacing",
    "ballsocket.fem.shapes": "ballsocket.elasticity.finite_elements.mesh",
    "ballsocket.joint.values": "ballsocket.problem.material",
    "ballsocket.models.liu": "ballsocket.models.half_space",
    "ballsocket.elastic.scratch": "ballsocket.elasticity.exact.kernel",
    "ballsocket.fem.curve": "ballsocket.elasticity.finite_elements.solver",
    "ballsocket.fem.states": "ballsocket.elasticity.finite_elements.solver",
    "ballsocket.fem.work": "ballsocket.elasticity.finite_elements.load_search",
    "ballsocket.fem.condense": "ballsocket.elasticity.finite_elements.bodies",
    "ballsocket.fem.export.lines": "ballsocket.elasticity.finite_elements.deck",
    "ballsocket.fem.export.solid": "ballsocket.elasticity.finite_elements.deck_bodies",
    "ballsocket.compiled.teaching": "ballsocket.compiled.overloads",
    "ballsocket.compiled.foundation": "ballsocket.compiled.kernels",
    "ballsocket.compiled.refined": "ballsocket.compiled.kernels",
    "ballsocket.compiled.tabulated": "ballsocket.compiled.table_kernel",
    "ballsocket.elastic.exact": "ballsocket.elasticity.exact.model",
    "ballsocket.fem": "ballsocket.elasticity.finite_elements",
    "ballsocket.fem.export": "ballsocket.elasticity.finite_elements",
    "ballsocket.sphere": "ballsocket.elasticity.off_axis",
    "ballsocket.hip.gait": "ballsocket.hip.simulator_cycles",
    "ballsocket.hip.named_cycles": "ballsocket.hip.cycle_registry",
    "ballsocket.hip.given_cycle": "ballsocket.hip.cycle_file",
    **{f"ballsocket.hip.{name}": "ballsocket.hip.cycle_tables" for name in ("measured", "tables", "waveforms")},
    "ballsocket.hip.cycle_schema": "ballsocket.hip.schema",
    "ballsocket.hip.report_points": "ballsocket.hip.simulation",
    "ballsocket.hip.resampled": "ballsocket.hip.cycle_tables",
    "ballsocket.hip.sliding": "ballsocket.hip.kinematics",
    **{f"ballsocket.hip.{name}": "ballsocket.hip.rim" for name in ("edge", "separation")},
    "ballsocket.hip.chebyshev": "ballsocket.core.runge_kutta_chebyshev",
    **{f"ballsocket.evidence.{name}": "ballsocket.evidence.worst_case" for name in ("calculation", "scatter", "wear")},
    **{f"ballsocket.evidence.{name}": "ballsocket.evidence.comparators" for name in ("applicability", "comparator")},
    "ballsocket.evidence.element_checks": "ballsocket.evidence.code_checks",
    "ballsocket.evidence.inputs": "ballsocket.evidence.pack",
    "ballsocket.evidence.requirements": "ballsocket.evidence.credibility",
    "ballsocket.evidence.named_files": "ballsocket.core.input_files",
    "ballsocket.evidence.published_wear": "ballsocket.evidence.hip_wear",
    "ballsocket.evidence.terms": "ballsocket.evidence.matrix",
    **{f"ballsocket.paper.claims.{name}": "ballsocket.paper.claims" for name in ("agreement", "design", "modulus")},
    "ballsocket.paper.claims.finding": "ballsocket.paper.claims.evaluation",
    "ballsocket.paper.claims.elsewhere": "ballsocket.paper.claims",
    "ballsocket.paper.figure": "ballsocket.paper.curves",
    "ballsocket.paper.table_3": "ballsocket.paper.cases",
    "ballsocket.identify.answers": "ballsocket.identify.forward_model",
    "ballsocket.identify.modulus": "ballsocket.studies.calibration",
    "ballsocket.identify.oscillation": "ballsocket.identify.observables",
    "ballsocket.identify.parameters": "ballsocket.identify.identification",
    "ballsocket.identify.profile": "ballsocket.identify.bands",
    "ballsocket.identify.remarks": "ballsocket.identify.result",
    "ballsocket.identify.estimates": "ballsocket.identify.information",
    "ballsocket.identify.search": "ballsocket.identify.fit",
    **{f"ballsocket.identify.{name}": "ballsocket.identify.misfit" for name in ("jax_derivatives", "tracing")},
    **{f"ballsocket.identify.{n}": "ballsocket.identify.unknown_kinds" for n in ("machine_errors", "model_numbers")},
    **{f"ballsocket.sphere.{old}": f"ballsocket.elasticity.off_axis.{new}" for old, new in _OFF_AXIS_MODULES.items()},
    **{f"ballsocket.dynamics.{name}": "ballsocket.dynamics.load" for name in ("brushed", "touch")},
    **{f"ballsocket.dynamics.{name}": "ballsocket.dynamics.ball_centre" for name in ("rim", "smooth")},
    **{f"ballsocket.dynamics.{name}": "ballsocket.dynamics.simulation" for name in ("carried", "stateful_motion")},
    **{f"ballsocket.dynamics.{name}": "ballsocket.dynamics.damping" for name in ("drop_test", "rebound")},
    "ballsocket.dynamics.prony": "ballsocket.dynamics.viscoelastic",
    "ballsocket.dynamics.sticking": "ballsocket.dynamics.potential",
    **{
        f"ballsocket.dynamics.{name}": "ballsocket.dynamics.element"
        for name in ("side_curves", "validity_monitor", "watch")
    },
    **{f"ballsocket.cli.{name}": "ballsocket.cli.json_answers" for name in ("answers", "next_steps")},
    **{f"ballsocket.cli.{name}": "ballsocket.cli.options" for name in ("engine", "groups", "words")},
    **{f"ballsocket.cli.{name}": "ballsocket.cli.elasticity_options" for name in ("elements", "off_axis")},
    **{f"ballsocket.cli.{name}": "ballsocket.cli.press_files" for name in ("files", "report")},
    **{f"ballsocket.cli.{name}": "ballsocket.cli.export" for name in ("fmu", "force_elements")},
    **{f"ballsocket.cli.{name}": "ballsocket.cli.servers" for name in ("app", "serve_mcp")},
    "ballsocket.cli.curve": "ballsocket.cli.press",
    "ballsocket.cli.fit": "ballsocket.cli.identify",
    "ballsocket.cli.questions": "ballsocket.cli.design",
    "ballsocket.cli.deck": "ballsocket.cli.export",
    "ballsocket.cli.tools": "ballsocket.mcp",
    "ballsocket.cli.reproduce": "ballsocket.cli.evidence",
    "ballsocket.cli.tools.limited": "ballsocket.cli.servers",
    "ballsocket.cli.tools.run": "ballsocket.mcp.call",
    "ballsocket.cli.tools.server": "ballsocket.mcp",
    **{f"ballsocket.cli.tools.{name}": "ballsocket.mcp.tools" for name in ("schema", "table")},
    "ballsocket.export.recording": "ballsocket.export.c_element",
    "ballsocket.export.slopes": "ballsocket.export.recorder",
    **{f"ballsocket.export.{name}": "ballsocket.export.targets" for name in ("tables", "target")},
    **{f"ballsocket.export.{name}": "ballsocket.dynamics.element" for name in ("trusted", "validity_depth")},
    "ballsocket.export.fmu.cross_check": "ballsocket.export.fmu.variables",
    "ballsocket.export.fmu.description": "ballsocket.export.fmu.fmu",
}
"""New path of each package or module that moved; the modules of a package move with it."""


def present_module_path(name: str) -> str | None:
    """Return the present path of a module from its path in version 1.0; None if it has not moved."""
    parent = name
    while "." in parent:
        if parent in MOVED:
            return MOVED[parent] + name[len(parent) :]
        parent = parent.rpartition(".")[0]
    return None


class _MovedModule(Loader):
    """Loader of a module that has moved, under its old path."""

    def __init__(self, path: str) -> None:
        self._path = path

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Import and return the module at its present path."""
        module = import_module(self._path)
        self._spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Restore the specification of the module, which is already executed."""
        module.__spec__ = self._spec  # the import system has just replaced it by that of the old path


class _MovedModules(MetaPathFinder):
    """Finder that maps old module paths to the present ones."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find a module by its old path; None if it has not moved."""
        moved = present_module_path(name)
        if moved is None:
            return None
        return ModuleSpec(name, _MovedModule(moved), is_package=True)


def register_old_paths() -> None:
    """Register the old paths of moved modules with the import system."""
    if not any(isinstance(finder, _MovedModules) for finder in sys.meta_path):
        sys.meta_path.insert(0, _MovedModules())


def _warn_renamed(old: str, new: str) -> None:
    """Issue a DeprecationWarning that states the new name."""
    warnings.warn(f"{old} is deprecated: use {new}; removed in 2.0", DeprecationWarning, stacklevel=3)


def renamed_names(module: str, names: dict[str, str]) -> Callable[[str], Any]:
    """Make the `__getattr__` of a module that resolves old names of functions and classes.

    `names` maps each old name to the present one, in the same module or with the path of another.
    """

    def resolve_old_name(name: str) -> Any:
        """Return a function or class by its old name, with a warning."""
        if name not in names:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        _warn_renamed(f"{module}.{name}", names[name])
        path, _, attribute = names[name].rpartition(".")
        return getattr(import_module(path or module), attribute)

    return resolve_old_name


class RenamedAttribute:
    """Descriptor for the old name of a method or attribute; each access warns.

    Example in the body of a class: `listen = RenamedAttribute("progress")`.
    """

    def __init__(self, new: str) -> None:
        self._new = new

    def __set_name__(self, owner: type, name: str) -> None:
        self._old = name

    def __get__(self, instance: Any, owner: type) -> Any:
        _warn_renamed(f"{owner.__name__}.{self._old}", self._new)
        if instance is not None:
            return getattr(instance, self._new)
        return self._documented(getattr(owner, self._new))

    def _documented(self, member: Any) -> Any:
        """Return a function or property of the class with a docstring for `help` that states the new name."""
        note = f"Deprecated: use `{self._new}`; removed in 2.0."
        if isinstance(member, FunctionType):

            @functools.wraps(member)
            def renamed(*args: Any, **kwargs: Any) -> Any:
                return member(*args, **kwargs)

            renamed.__doc__ = note
            return renamed
        if isinstance(member, property | functools.cached_property):
            return property(member.fget if isinstance(member, property) else member.func, doc=note)
        return member


def renamed_arguments(**names: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Make a decorator that accepts keyword arguments by their old names.

    Example: `@renamed_arguments(listen="progress")`.
    """

    def accept_old_names(function: Callable[P, T]) -> Callable[P, T]:
        """Wrap a function so that it accepts the old names of its arguments."""

        @functools.wraps(function)
        def call_with_new_names(*args: P.args, **kwargs: P.kwargs) -> T:
            """Call the function after translation of old argument names to the new ones."""
            for old in names.keys() & kwargs.keys():
                new = names[old]
                if new in kwargs:
                    raise TypeError(f"{function.__name__}() got both {new!r} and its old name {old!r}")
                _warn_renamed(f"argument {old!r} of {function.__name__}()", repr(new))
                kwargs[new] = kwargs.pop(old)
            return function(*args, **kwargs)

        return call_with_new_names

    return accept_old_names


def renamed_fields(**names: str) -> Callable[[type[T]], type[T]]:
    """Make a decorator of dataclasses that accepts old names of fields, attributes and methods.

    An old name of a field replaces the value under the new name, which `dataclasses.replace` passes as well.
    """

    def accept_old_names(owner: type[T]) -> type[T]:
        """Make a dataclass accept the old names of its fields, attributes and methods."""
        initialise: Any = owner.__init__
        arguments = {old: new for old, new in names.items() if new in owner.__dict__.get("__dataclass_fields__", {})}

        @functools.wraps(initialise)
        def call_with_new_names(self: T, *args: Any, **kwargs: Any) -> None:
            """Initialise the dataclass after translation of old field names to the new ones."""
            for old in arguments.keys() & kwargs.keys():
                _warn_renamed(f"argument {old!r} of {owner.__name__}()", repr(arguments[old]))
                kwargs[arguments[old]] = kwargs.pop(old)
            initialise(self, *args, **kwargs)

        setattr(owner, "__init__", call_with_new_names)  # noqa: B010 (mypy refuses to assign to a method)
        for old, new in names.items():
            attribute = RenamedAttribute(new)
            attribute.__set_name__(owner, old)
            setattr(owner, old, attribute)
        return owner

    return accept_old_names
