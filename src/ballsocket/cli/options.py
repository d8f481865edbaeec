"""Options that several commands share: joint, load, model, output and worker processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from copy import copy
from dataclasses import dataclass, fields, is_dataclass, replace
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

import typer

from ..core.checks import nearest, normalise_name
from ..core.input_files import resolve_input
from ..files.joint_file import JointFile, joint_of, read_cup, read_joint, read_load, varied
from ..model_catalogue import listed_models
from ..problem.dimensions import LENGTHS, fit_beside
from ..problem.presets import joints, materials
from ..reports.figure_files import check_format, save
from ..reports.unit_systems import Units
from .json_answers import echo_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.executors.processes import Engine


def complete_material(start: str) -> list[str]:
    """List the preset materials whose names have this start, for a shell."""
    return [name for name in materials if name.startswith(start.lower())]


def complete_model(start: str) -> list[str]:
    """List the models whose names have this start, for a shell."""
    return [name for name in listed_models if name.startswith(start.lower())]


JointName = Annotated[
    str | None,
    typer.Argument(help="Joint file (TOML), or name of a preset. The options of the joint replace its values."),
]
JointNames = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="JOINT",
        help="Joint file (TOML), or name of a preset. The options of the joint replace its values. "
        "Several joints share one report.",
        show_default=False,
    ),
]
UnitSystem = Annotated[
    Units,
    typer.Option(
        case_sensitive=False,
        help="Units of tables, figures and reports: SI is mm, N, MPa; imperial is in, lbf, psi. JSON is always SI.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object, not a table.")]
Workers = Annotated[
    int | None, typer.Option(help="Number of worker processes on this machine. Default: 1, or as in the file.")
]
Scheduler = Annotated[
    str | None,
    typer.Option(help="Address of a Dask scheduler that distributes the work: 'tcp://host:8786'. Default: none."),
]
ModelName = Annotated[
    str | None,
    typer.Option(
        help="Name of a model (see `ballsocket models`), or FILE.py:NAME for a custom model. "
        "Default: tabulated; exact for joints outside its tables.",
        autocompletion=complete_model,
    ),
]
GapName = Annotated[
    str | None,
    typer.Option(
        help="Gap of exact, fem and sphere: 'linear', Eq. (6), or 'circular', Eq. (5). "
        "Default: linear up to a clearance of 0.01 R2, else circular."
    ),
]


Force = Annotated[
    str | None, typer.Option(help="Axial force in N, or with a unit: '3 kN'. Default: load of the joint file.")
]
Indentation = Annotated[
    str | None,
    typer.Option(help="Displacement of the ball after first contact in mm, or with a unit: '40 um'. Not with --force."),
]
ArcOfCover = Annotated[
    str | None,
    typer.Option(help="Angle of the cup from rim to rim in degrees. Default: as in the file, or 180 deg."),
]


@dataclass(frozen=True, kw_only=True)
class JointPartOptions:
    """Options of a joint without its orientation; they replace single values of a joint file or preset."""

    ball_radius: Annotated[str | None, typer.Option(help="Ball radius R1 in mm, or with a unit: '1.6 cm'.")] = None
    head_diameter: Annotated[
        str | None, typer.Option(help="Ball diameter 2 R1 in mm: '32 mm'. Not with --ball-radius.")
    ] = None
    clearance: Annotated[
        str | None, typer.Option(help="Radial clearance (socket minus ball radius) in mm: '0.1 mm'.")
    ] = None
    diametral_clearance: Annotated[
        str | None, typer.Option(help="Twice the radial clearance in mm: '0.2 mm'. Not with --clearance.")
    ] = None
    interference: Annotated[
        str | None,
        typer.Option(
            help="Interference of a preloaded joint in mm: '0.02 mm'. Solved by model sphere. Not with --clearance."
        ),
    ] = None
    liner_thickness: Annotated[
        str | None, typer.Option(help="Thickness of the liner in mm: '6 mm'; inf for a massive socket.")
    ] = None
    outer_radius: Annotated[
        str | None,
        typer.Option(help="Outer radius of liner or shell in mm: '24 mm'."),
    ] = None
    outer_diameter: Annotated[
        str | None,
        typer.Option(help="Outer diameter of liner or shell in mm: '52 mm'."),
    ] = None
    shell: Annotated[
        str | None,
        typer.Option(
            help="Name of the material of a shell right behind the liner: 'titanium'. Its thickness follows from "
            "--outer-diameter and --liner-thickness, or is --shell-thickness.",
            autocompletion=complete_material,
        ),
    ] = None
    shell_thickness: Annotated[str | None, typer.Option(help="Thickness of the shell in mm: '2 mm'.")] = None
    young: Annotated[str | None, typer.Option(help="Young's modulus of the liner in MPa, or with a unit: '1 GPa'.")] = (
        None
    )
    poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the liner, from 0 to 0.5.")] = None
    liner: Annotated[
        str | None,
        typer.Option(
            help="Name of the liner material, see `ballsocket presets`. --young and --poisson replace its values.",
            autocompletion=complete_material,
        ),
    ] = None
    ball_young: Annotated[
        str | None,
        typer.Option(
            help="Young's modulus of the ball in MPa, or with a unit: '230 GPa'. Default: as in the file, or rigid."
        ),
    ] = None
    ball_poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the ball, from 0 to 0.5.")] = None
    ball: Annotated[
        str | None,
        typer.Option(
            help="Name of the ball material, see `ballsocket presets`. --ball-young and --ball-poisson replace it.",
            autocompletion=complete_material,
        ),
    ] = None

    def tables(self) -> dict[str, dict[str, str]]:
        """Return the options as tables of a joint file."""
        lengths = {name: getattr(self, name) for name in LENGTHS if hasattr(self, name)}
        liner = {"material": self.liner, "young": self.young, "poisson": self.poisson}
        ball = {"material": self.ball, "young": self.ball_young, "poisson": self.ball_poisson}
        shell = {"material": self.shell, "thickness": self.shell_thickness}
        tables = {"joint": lengths, "liner": liner, "ball": ball, "shell": shell}
        return {name: drop_missing(table) for name, table in tables.items() if drop_missing(table)}

    def read(self, name: str | None) -> JointFile:
        """Read a joint from a file, a preset or the options alone; options replace single values.

        Raises
        ------
        ValueError
            Neither a name nor options, or a value that is not allowed.
        """
        tables = self.tables()
        if name is None and not tables:
            raise ValueError(
                "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
            )
        if name is None:
            return joint_of(tables)
        return varied(named_joint(name), tables) if tables else named_joint(name)

    def stated(self, file: JointFile, varied: Iterable[str]) -> dict[str, float]:
        """Return the lengths in mm that the options state beside those that vary, for a study to hold."""
        lengths = self.tables().get("joint", {})
        return {name: float(getattr(file.joint, name)) for name in fit_beside(varied, lengths)}


_IN_FILE = "Default: as in [cup] of the joint file"


@dataclass(frozen=True, kw_only=True)
class JointOptions(JointPartOptions):
    """Options of a joint and of the orientation of its cup in the body."""

    inclination: Annotated[
        str | None, typer.Option(help=f"Inclination of the cup in degrees: '45 deg'. {_IN_FILE}, or 0.")
    ] = None
    anteversion: Annotated[
        str | None, typer.Option(help=f"Anteversion of the cup in degrees: '15 deg'. {_IN_FILE}, or 0.")
    ] = None
    side: Annotated[str | None, typer.Option(help=f"Side of the body: 'right' or 'left'. {_IN_FILE}, or right.")] = None
    orientation: Annotated[
        str | None,
        typer.Option(
            help="Definition of both angles (Murray 1993): 'radiographic', 'operative' or 'anatomical'. "
            "Default: radiographic."
        ),
    ] = None
    pelvic_tilt: Annotated[
        str | None,
        typer.Option(
            help="Tilt of the pelvis in degrees, positive with its top to the front: '10 deg'. The angles of the cup "
            "are those in the pelvis. Default: 0."
        ),
    ] = None

    @property
    def orients(self) -> bool:
        """True if an option orients the cup."""
        return bool(self._angles())

    def _angles(self) -> dict[str, str]:
        return drop_missing({key: getattr(self, key) for key in CUP_ANGLES})

    def read(self, name: str | None) -> JointFile:
        """Read a joint as `JointPartOptions.read`, and turn its cup as the options state."""
        file = super().read(name)
        return replace(file, cup=read_cup(self._angles(), file.cup))


CUP_ANGLES = ("inclination", "anteversion", "side", "orientation", "pelvic_tilt")
"""Options of the orientation of a cup, which are also keys of the table [cup]."""


@dataclass(frozen=True, kw_only=True)
class LoadOptions:
    """Options of a load; one of them replaces the load of the joint file."""

    force: Force = None
    indentation: Indentation = None
    half_angle: Annotated[
        str | None, typer.Option(help="Half angle of the contact in degrees: '40 deg'. Not with --force.")
    ] = None

    def read(self, file: JointFile) -> dict[str, float]:
        """Read the load from the options, or take that of the joint file, in N, mm or rad."""
        return read_load_option(vars(self), file)

    def are_missing(self, file: JointFile) -> bool:
        """Return True if neither the options nor the joint file have a load."""
        return not (drop_missing(vars(self)) or file.load)


@dataclass(frozen=True, kw_only=True)
class OutputOptions:
    """Options of a command that prints one result and can draw it."""

    figure: Annotated[Path | None, typer.Option(help="Write a figure to this file (.png, .svg, .pdf).")] = None
    as_json: AsJson = False

    def check(self) -> None:
        """Raise ValueError for a figure format that cannot be written."""
        if self.figure is not None:
            check_format(self.figure)

    def print(self, summary: Callable[[], dict[str, Any]], print_table: Callable[[], None]) -> None:
        """Print the result as JSON or as a table."""
        if self.as_json:
            echo_json(summary())
        else:
            print_table()

    def draw(self, draw: Callable[[], Figure]) -> None:
        """Draw and write the figure if there is a file for it."""
        if self.figure is not None:
            save(draw(), self.figure)


def drop_missing(options: dict[str, str | None]) -> dict[str, str]:
    """Return the options that have a value."""
    return {name: text for name, text in options.items() if text is not None}


def read_load_option(options: dict[str, str | None], file: JointFile) -> dict[str, float]:
    """Read the load from some options, or take that of the joint file, in N, mm or rad.

    Raises
    ------
    ValueError
        No load, several loads, or a value that is not allowed.
    """
    load = read_load(drop_missing(options)) or file.load
    if not load:
        names = [f"--{name.replace('_', '-')}" for name in options]
        raise ValueError(f"a load is needed: {', '.join(names[:-1])} or {names[-1]}, such as --force '3 kN'")
    return load


def named_joint(name: str) -> JointFile:
    """Return the joint of a file, or the preset of that name.

    Raises
    ------
    ValueError
        No such file or preset.
    """
    if not name:
        raise ValueError("the joint's name is empty")
    path = resolve_input(Path(name))
    if path.is_dir():
        raise ValueError(f"{name!r} is a folder; a joint file is needed")
    if path.exists():
        return read_joint(path)
    if normalise_name(name) in joints:
        return JointFile(joints[normalise_name(name)], {})
    if not path.parent.is_dir():
        raise ValueError(f"{name!r} does not exist: there is no folder {str(path.parent)!r}")
    raise ValueError(f"{name!r} is neither a file nor a preset{nearest(name, joints)}")


def choose_executor(workers: int | None, scheduler: str | None, default: Engine) -> Engine:
    """Return the executor that the options select, or the default."""
    if scheduler is not None:
        from ..core.executors.dask import Distributed

        return Distributed(address=scheduler, workers=workers)
    if workers is None:
        return default
    from ..core.executors.processes import Processes

    return Processes(workers=workers)


# --- groups of options in the signature of a command ---


def expand_groups(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command whose groups of options are expanded to single parameters, for typer.

    typer makes an option of each parameter in the signature of a function. A group is a dataclass whose fields are
    annotated like such parameters. The returned function has a signature in which the fields of each group replace the
    group; called with their values, it builds the groups and calls the command.

    A text in the annotation of a group, `mesh: Annotated[MeshOptions, "fem"]`, is put before the help of its options.
    """
    parameters = signature(command, eval_str=True).parameters.values()
    types = {parameter.name: _group_type(parameter)[0] for parameter in parameters}
    groups: dict[str, Any] = {name: kind for name, kind in types.items() if is_dataclass(kind)}

    def expanded_command(**options: Any) -> None:
        built = {
            name: group(**{field.name: options.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        command(**options, **built)

    expanded_command.__name__, expanded_command.__doc__ = command.__name__, command.__doc__
    flat = [
        option
        for parameter in parameters
        for option in (_group_options(parameter) if parameter.name in groups else (parameter,))
    ]
    expanded_command.__signature__ = Signature(flat)  # type: ignore[attr-defined]
    return expanded_command


def _group_type(parameter: Parameter) -> tuple[Any, str]:
    """Return the type of a parameter, and the text in its annotation."""
    if get_origin(parameter.annotation) is not Annotated:
        return parameter.annotation, ""
    kind, text = get_args(parameter.annotation)
    return kind, text


def _group_options(parameter: Parameter) -> Iterator[Parameter]:
    """Return the fields of a group as single parameters."""
    group, prefix = _group_type(parameter)
    for field in signature(group, eval_str=True).parameters.values():
        kind, option = get_args(field.annotation)
        if prefix:
            option = copy(option)
            option.help = f"{prefix}: {option.help[0].lower()}{option.help[1:]}"
        yield field.replace(annotation=Annotated[kind, option])
