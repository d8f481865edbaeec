"""The words of the shell become the calls of the package."""

from __future__ import annotations

import codecs
import dataclasses
import json
import sys
from collections.abc import Iterable
from io import TextIOWrapper
from pathlib import Path
from typing import Annotated, Any

import numpy
import typer

import ballsocket as bs

from . import figures, tables
from .calibrate import FORCES, Form, refit_table_3
from .compare import REFERENCE, Comparison
from .contact import Contact
from .files import JointFile, joint_of, nearest, read_joint, read_load
from .models.base import Model
from .presets import joints
from .units import parse
from .validity import Status

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
_IN_ASCII = {"≤": "<=", "≥": ">=", "°": "o", "µ": "u", "ε": "e", "ν": "v", "²": "2", "ß": "ss"}


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
    """Press a ball into its socket and see what models make of it, beside the exact answer.

    Exit status: 0 done, 2 misuse, 3 an iteration that did not converge, or no answer from any model.
    """
    words = {
        "joint": {"ball_radius": ball_radius, "clearance": clearance, "liner_thickness": liner_thickness},
        "liner": {"material": liner, "young": young, "poisson": poisson},
        "ball": {"material": ball, "young": ball_young, "poisson": ball_poisson},
    }
    described = {table: _given(part) for table, part in words.items() if _given(part)}
    load = read_load(_given({"force": force, "indentation": indentation, "half_angle": half_angle}))
    chosen = _chosen(model or [], every)
    file = _joint_file(joint, described)
    load = load or file.load
    if not load:
        raise ValueError("a load is needed: --force, --indentation or --half-angle")
    if figure is not None:
        figures.check_format(figure)
    comparison = bs.compare(file.joint, models={**chosen, REFERENCE: bs.catalogue[REFERENCE]}, **load)
    if not set(comparison) & set(chosen):
        raise ValueError("; ".join(why for name, why in comparison.missing.items() if name in chosen))
    if figure is not None:
        _draw(comparison, figure)
    if as_json:
        _echo_json(comparison.summary())
    else:
        tables.print_press(comparison)
    failure = _failure(comparison, chosen)
    if failure:
        typer.echo(f"ballsocket: {failure}", err=True)
        raise typer.Exit(FAILURE)


_FORMS: dict[str, Form] = {
    "constant": bs.as_constant,
    "polynomial": bs.as_polynomial,
    "corrected-vessel": bs.as_corrected_vessel,
}


@app.command()
def calibrate(
    joint: Annotated[str | None, typer.Argument(help="A joint file or a preset's name; none refits Table 3.")] = None,
    force: Annotated[list[str] | None, typer.Option(help="A load, '2 kN'; repeat. Default 1, 2 and 3 kN.")] = None,
    thickness: Annotated[list[str] | None, typer.Option(help="A liner thickness, '5 mm'; repeat for a family.")] = None,
    form: Annotated[str, typer.Option(help="constant, polynomial (Eq. 18) or corrected-vessel")] = "constant",
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object instead of the table.")] = False,
) -> None:
    """Fit the closed form's foundation modulus to the exact answer: for one joint, or as the paper did (Table 3)."""
    if joint is None:
        if force or thickness or form != "constant":
            raise ValueError(
                "--force, --thickness and --form need a joint; without one Table 3 is fitted as the paper did"
            )
        columns = refit_table_3()
        if as_json:
            _echo_json({"version": bs.__version__, "table_3": [column.summary() for column in columns]})
        else:
            tables.print_table_3(columns)
        return
    if form not in _FORMS:
        raise ValueError(f"form {form!r} is not known{nearest(form, _FORMS)}")
    given = _named_joint(joint).joint
    if thickness:
        lengths = [parse("thickness", text, "length") for text in thickness]
        given = dataclasses.replace(given, liner_thickness=numpy.array(lengths))
    loads = [parse("force", text, "force") for text in force or []] or FORCES
    fit = bs.calibrate(given, force=loads, form=_FORMS[form])
    if as_json:
        _echo_json({"version": bs.__version__, "joint": given.summary(), **fit.summary()})
    else:
        tables.print_calibration(fit)


def _echo_json(answer: dict[str, Any]) -> None:
    typer.echo(json.dumps(answer, indent=2, allow_nan=False))


@app.command()
def build_tables(
    out: Annotated[Path | None, typer.Option(help="Where to; without it the package's own file.")] = None,
    points: Annotated[int, typer.Option(min=1, help="Random contacts that the tables are checked at.")] = 10_000,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
    check: Annotated[bool, typer.Option("--check", help="Check the tables that are there, and build none.")] = False,
) -> None:
    """Build the tables of `tabulated` from the exact answer (two minutes), and report how accurate they are."""
    from .elastic import build_tables as builder

    path = builder.SHIPPED if out is None else out
    do = builder.check if check else builder.build
    typer.echo(f"{path}: {do(path, points=points, workers=workers)}")


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


def _joint_file(name: str | None, described: dict[str, dict[str, str]]) -> JointFile:
    if name is not None and described:
        raise ValueError("give a joint file or the joint's numbers, not both")
    if name is None and not described:
        raise ValueError(
            "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
        )
    return joint_of(described) if name is None else _named_joint(name)


def _named_joint(name: str) -> JointFile:
    if not name:
        raise ValueError("the joint's name is empty")
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


def _failure(comparison: Comparison, chosen: Iterable[str]) -> str:
    """What went wrong as a whole, or an empty text: a model without an answer is a note while another one has one."""
    unsettled = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
    if unsettled:
        return f"no convergence of {', '.join(unsettled)} (see the notes)"
    return "" if set(_answered(comparison)) & set(chosen) else f"no answer from {', '.join(chosen)} (see the notes)"


def _answered(comparison: Comparison) -> dict[str, Contact]:
    return {name: contact for name, contact in comparison.items() if not contact.status.failed}


def _draw(comparison: Comparison, path: Path) -> None:
    """Draw what has an answer; without any there is no figure."""
    shown = _answered(comparison)
    if not shown:
        return
    deepest = 1.15 * max(contact.indentation for contact in shown.values())
    steps = deepest * numpy.linspace(0.0, 1.0, 121) ** 2
    curves = {name: bs.catalogue[name].press(comparison.joint, indentation=steps) for name in shown}
    figures.save(figures.press_figure(shown, curves), path)


def _degrade(error: UnicodeError) -> tuple[str, int]:
    """What stands for characters that the terminal's encoding lacks."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_IN_ASCII.get(char, "?") for char in error.object[error.start : error.end]), error.end


def _write_in_any_encoding() -> None:
    codecs.register_error("degrade", _degrade)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="degrade")


def main() -> None:
    """The command `ballsocket`: one line on stderr for misuse, no tracebacks for what a user can mend."""
    _write_in_any_encoding()
    status = MISUSE
    try:
        sys.exit(app(standalone_mode=False) or DONE)
    except typer.Abort:
        sys.exit(130)
    except UsageError as error:
        message = error.format_message()
    except OSError as error:
        message = f"{error.filename or 'output'}: {error.strerror or error}"
    except ValueError as error:
        message = str(error)
    except (ArithmeticError, MemoryError) as error:
        message, status = f"these numbers are too large or too small to calculate with ({error})", FAILURE
    print("ballsocket: " + " ".join(message.split()), file=sys.stderr)
    sys.exit(status)
