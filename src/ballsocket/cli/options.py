"""Options that several commands share: joint, load, model, output and worker processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

import typer

from ..contact import Model
from ..core.answers import Answer
from ..core.quantities import LOADS
from ..core.unit_systems import Units
from ..files.inputs import Input, inputs_of, plain_default
from ..files.joint_file import JointFile, joint_of, named_joint, varied
from ..files.joint_options import ORIENTATION, PARTS, inputs_in
from ..files.schema import FileTable
from ..files.tables import read_table
from ..model_catalogue import listed_models, named_model
from ..problem.dimensions import fit_beside
from ..reports.figure_files import check_format, save
from ..reports.terminal import print_answer
from .json_answers import echo_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.executors.processes import Engine


def is_model_file(text: str) -> bool:
    """Return True if a value of `--model` names an object of a Python file."""
    return text.endswith(".py") or ".py:" in text


def requested_model(text: str) -> Model:
    """Return the model of an option `--model`: a name, or FILE.py:NAME.

    Raises ValueError: an unknown name; a model file that is refused, see `load_model`.
    """
    if not is_model_file(text):
        return named_model(text)
    from .model_file import load_model

    return load_model(text)


def complete_model(start: str) -> list[str]:
    """List the models whose names have this start, for a shell."""
    return [name for name in listed_models if name.startswith(start.lower())]


JointName = Annotated[
    str | None,
    typer.Argument(help="Joint file (TOML), or name of a preset. Options replace its values."),
]
JointNames = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="JOINT",
        help="Joint file (TOML), or name of a preset. Options replace its values. Several joints share one report.",
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


@dataclass(frozen=True)
class JointOptions:
    """Options of a joint, its cup and its load; they replace single values of a joint file or preset.

    A parameter of this type is annotated with the parts of a joint file that the command offers as options,
    `Annotated[JointOptions, JOINT + LOAD]`. `tables` has the texts of the options by table and key.
    """

    tables: Mapping[str, Mapping[str, str]]

    def read(self, name: str | None) -> JointFile:
        """Read a joint from a file, a preset or the options alone; options replace single values.

        Raises ValueError: neither a name nor options, or a value that is not allowed.
        """
        if name is not None:
            return varied(named_joint(name), self.tables)
        if not {*PARTS} & {*self.tables}:
            raise ValueError(
                "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
            )
        return joint_of(self.tables)

    def stated(self, file: JointFile, varied: Iterable[str]) -> dict[str, float]:
        """Return the lengths in mm that the options state beside those that vary, for a study to hold."""
        lengths = self.tables.get("joint", {})
        return {name: float(getattr(file.joint, name)) for name in fit_beside(varied, lengths)}

    @property
    def orients(self) -> bool:
        """True if an option orients the cup."""
        return any(f"cup.{key}" in ORIENTATION for key in self.tables.get("cup", {}))


def needed_load(file: JointFile) -> dict[str, float]:
    """Return the load of a joint file with its options in N, mm or rad; raise ValueError without one."""
    if not file.load:
        names = [f"--{name.replace('_', '-')}" for name in LOADS]
        raise ValueError(f"a load is needed: {', '.join(names[:-1])} or {names[-1]}, such as --force '3 kN'")
    return file.load


def print_result(
    summarise: Callable[[], Mapping[str, Any]], describe: Callable[[], Answer], units: Units, as_json: bool
) -> None:
    """Print the summary of a result as JSON, or its description; only the printed one is made."""
    if as_json:
        echo_json(summarise())
    else:
        print_answer(describe(), units)


def write_figure(path: Path | None, draw: Callable[[], Figure], units: Units) -> None:
    """Draw and write a figure if there is a file for it."""
    if path is not None:
        from ..reports.style import in_units

        save(in_units(draw(), units), path)


@dataclass(frozen=True, kw_only=True)
class OutputOptions:
    """Options of a command that prints one result and can draw it."""

    figure: Annotated[Path | None, typer.Option(help="Write a figure to this file (.png, .svg, .pdf).")] = None
    units: UnitSystem = Units.SI
    as_json: AsJson = False

    def check(self) -> None:
        """Raise ValueError for a figure format that cannot be written."""
        check_format(self.figure)

    def print(self, summarise: Callable[[], Mapping[str, Any]], describe: Callable[[], Answer]) -> None:
        """Print the result as JSON, or its description; see `print_result`."""
        print_result(summarise, describe, self.units, self.as_json)

    def draw(self, draw: Callable[[], Figure]) -> None:
        """Draw and write the figure if there is a file for it."""
        write_figure(self.figure, draw, self.units)


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

    typer makes an option of each parameter in the signature of a function. A group is a table of files, whose keys
    become options; `JointOptions`; or a dataclass whose fields are annotated like parameters. The returned function has
    a signature in which the options of each group replace the group; called with their values, it builds the groups and
    calls the command.

    A text in the annotation of a group, `mesh: Annotated[MeshTable, "fem"]`, is put before the help of its options.
    """
    parameters = signature(command, eval_str=True).parameters.values()
    groups: dict[str, Any] = {parameter.name: group for parameter in parameters if (group := _group_of(parameter))}

    def expanded_command(**options: Any) -> None:
        built = {name: _built(group, annotation, options) for name, (group, annotation) in groups.items()}
        command(**options, **built)

    expanded_command.__name__, expanded_command.__doc__ = command.__name__, command.__doc__
    flat = [
        option
        for parameter in parameters
        for option in (_group_options(*groups[parameter.name]) if parameter.name in groups else (parameter,))
    ]
    expanded_command.__signature__ = Signature(flat)  # type: ignore[attr-defined]
    return expanded_command


def _group_of(parameter: Parameter) -> tuple[Any, Any] | None:
    """Return the type of a group of options and the rest of its annotation; None for a single option."""
    kind, annotation = parameter.annotation, ""
    if get_origin(kind) is Annotated:
        kind, annotation = get_args(kind)
    is_group = isinstance(kind, type) and (is_dataclass(kind) or issubclass(kind, FileTable))
    return (kind, annotation) if is_group else None


def _built(group: Any, annotation: Any, options: dict[str, Any]) -> Any:
    """Take the values of a group out of the options of a command, and return the group."""
    if not (group is JointOptions or issubclass(group, FileTable)):
        return group(**{field.name: options.pop(field.name) for field in fields(group)})
    tables: dict[str, dict[str, str]] = {}
    for entry in inputs_in(annotation) if group is JointOptions else inputs_of(group):
        if (text := options.pop(entry.name)) is not None:
            tables.setdefault(entry.part, {})[entry.key] = text
    return JointOptions(tables) if group is JointOptions else read_table(tables.get("", {}), group)


def _group_options(group: Any, annotation: Any) -> Iterator[Parameter]:
    if group is JointOptions:
        yield from (_parameter(entry, entry.help, None) for entry in inputs_in(annotation))
    elif issubclass(group, FileTable):
        for entry in inputs_of(group):
            text = f"{annotation}: {entry.help[0].lower()}{entry.help[1:]}" if annotation else entry.help
            yield _parameter(entry, text, plain_default(entry.field))
    else:
        for field in signature(group, eval_str=True).parameters.values():
            kind, option = get_args(field.annotation)
            yield field.replace(annotation=Annotated[kind, option])


def _parameter(entry: Input, text: str, default: Any) -> Parameter:
    def complete(start: str) -> list[str]:
        return [name for name in entry.choices if name.startswith(start.lower())]

    option = typer.Option(help=text, autocompletion=complete if entry.choices else None)
    kind: Any = Annotated[str if default else str | None, option]
    return Parameter(entry.name, Parameter.KEYWORD_ONLY, default=default, annotation=kind)
