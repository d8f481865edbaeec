"""The words of the shell become the calls of the package."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Any

import numpy
import typer

import ballsocket as bs

from . import figures, tables
from .compare import Comparison
from .files import JointFile, joint_of, nearest, read_joint, read_load
from .models.base import Model
from .presets import joints

app = typer.Typer(
    name="ballsocket",
    help="Contact of a ball in a socket of nearly its own radius. Units are mm, N, MPa, degrees unless text says so.",
    no_args_is_help=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

UsageError: Any = typer.BadParameter.__base__  # typer brings a click of its own, and does not export this
DONE, MISUSE, FAILURE = 0, 2, 3
DEFAULT_MODEL = "hess-forsbach"


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"ballsocket {bs.__version__}")
        raise typer.Exit()


@app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print it.")] = False,
) -> None:
    """Contact of a ball in a socket of nearly its own radius."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command()
def press(
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    ball_radius: Annotated[str | None, typer.Option(help="R1, '16 mm'")] = None,
    clearance: Annotated[str | None, typer.Option(help="Radial clearance, '0.1 mm'")] = None,
    liner_thickness: Annotated[str | None, typer.Option(help="L, '6 mm'; inf is a massive socket")] = None,
    young: Annotated[str | None, typer.Option(help="Young's modulus of the liner, '1 GPa'")] = None,
    poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the liner")] = None,
    liner: Annotated[str | None, typer.Option(help="Liner material by name, in place of --young --poisson")] = None,
    ball_young: Annotated[str | None, typer.Option(help="Young's modulus of the ball; none is a rigid ball")] = None,
    ball_poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the ball")] = None,
    ball: Annotated[str | None, typer.Option(help="Ball material by name, in place of its numbers")] = None,
    force: Annotated[str | None, typer.Option(help="Axial load, '3 kN'")] = None,
    indentation: Annotated[str | None, typer.Option(help="Approach from first touch, '40 um'")] = None,
    half_angle: Annotated[str | None, typer.Option(help="Contact half-angle, '40 deg'")] = None,
    model: Annotated[list[str] | None, typer.Option(help="A model's name; repeat for more.")] = None,
    every: Annotated[bool, typer.Option("--all", help="Every model of the catalogue.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object instead of the table.")] = False,
    figure: Annotated[Path | None, typer.Option(help="Write a figure: .png, .svg or .pdf")] = None,
) -> None:
    """Press a ball into its socket and see what every model makes of it.

    Exit status: 0 done, 2 misuse, 3 a numerical failure.
    """
    words = {
        "joint": {"ball_radius": ball_radius, "clearance": clearance, "liner_thickness": liner_thickness},
        "liner": {"material": liner, "young": young, "poisson": poisson},
        "ball": {"material": ball, "young": ball_young, "poisson": ball_poisson},
    }
    described = {table: _given(part) for table, part in words.items() if _given(part)}
    load = read_load(_given({"force": force, "indentation": indentation, "half_angle": half_angle}))
    chosen = _chosen(model or [], every)
    if joint is not None and described:
        raise ValueError("give a joint file or the joint's numbers, not both")
    if joint is None and not described:
        raise ValueError(
            "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
        )
    file = _named_joint(joint) if joint is not None else joint_of(described)
    load = load or file.load
    if not load:
        raise ValueError("a load is needed: --force, --indentation or --half-angle")
    if figure is not None:
        figures.check_format(figure)
    comparison = bs.compare(file.joint, models=chosen, **load)
    if not comparison.contacts:
        raise ValueError("; ".join(comparison.missing.values()))
    if figure is not None:
        _draw(comparison, figure)
    if as_json:
        typer.echo(json.dumps(comparison.summary(), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        tables.print_press(comparison)
    failed = [name for name, contact in comparison.items() if contact.status.failed]
    if failed:
        typer.echo(f"ballsocket: no answer from {', '.join(failed)} (see the notes)", err=True)
        raise typer.Exit(FAILURE)


@app.command()
def models() -> None:
    """The catalogue: every model, where it can be trusted, and where it comes from."""
    tables.print_models([*bs.catalogue.values(), bs.PinInHole()])


@app.command()
def presets() -> None:
    """Materials and joints by name, with the sources of their numbers."""
    tables.print_presets()


@app.command()
def cite(
    names: Annotated[list[str] | None, typer.Argument(help="Models by name; all of them if none is given.")] = None,
) -> None:
    """BibTeX of what a model is made of."""
    citable: dict[str, Any] = {**bs.catalogue, "pin-in-hole": bs.PinInHole()}
    for name in names or []:
        if name not in citable:
            raise ValueError(f"model {name!r} is not known{nearest(name, citable)}")
    typer.echo(bs.cite(*(citable[name] for name in names or citable)))


def _given(words: dict[str, str | None]) -> dict[str, str]:
    return {name: word for name, word in words.items() if word is not None}


def _named_joint(name: str) -> JointFile:
    path = Path(name)
    if path.is_dir():
        raise ValueError(f"{name!r} is a folder; a joint file is needed")
    if path.exists():
        return read_joint(path)
    if name in joints:
        return JointFile(joints[name], {})
    raise ValueError(f"{name!r} is neither a file nor a preset{nearest(name, joints)}")


def _chosen(names: list[str], every: bool) -> dict[str, Model]:
    for name in names:
        if name not in bs.catalogue:
            raise ValueError(f"model {name!r} is not known{nearest(name, bs.catalogue)}")
    if every:
        return dict(bs.catalogue)
    return {name: bs.catalogue[name] for name in names or [DEFAULT_MODEL]}


def _draw(comparison: Comparison, path: Path) -> None:
    shown = {name: contact for name, contact in comparison.items() if not contact.status.failed}
    if not shown:
        raise ValueError("no model has an answer to draw")
    deepest = 1.15 * max(contact.indentation for contact in shown.values())
    steps = deepest * numpy.linspace(0.0, 1.0, 121) ** 2
    curves = {name: bs.catalogue[name].press(comparison.joint, indentation=steps) for name in shown}
    figures.save(figures.press_figure(shown, curves), path)


def main() -> None:
    """The command `ballsocket`: one line on stderr for misuse, no tracebacks for what a user can mend."""
    try:
        sys.exit(app(standalone_mode=False) or DONE)
    except typer.Abort:
        sys.exit(130)
    except UsageError as error:
        message = error.format_message()
    except OSError as error:
        message = f"{error.filename or 'file'}: {error.strerror or error}"
    except ValueError as error:
        message = str(error)
    print("ballsocket: " + " ".join(message.split()), file=sys.stderr)
    sys.exit(MISUSE)
