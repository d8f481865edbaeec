"""`press`: one joint, one load, models side by side."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated

import typer

import ballsocket as bs

from ..catalogue import judge, reference
from ..checks import nearest
from ..compare import Comparison, answered, force_curves
from ..io.joint_file import read_load
from ..model import Model
from ..output import press_plot, terminal
from ..output.save import check_format, save
from ..validity import Status
from . import elements
from .root import FAILURE, app
from .words import echo_json, given, joint_file

DEFAULT_MODEL = "hess-forsbach"


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
    arc_of_cover: Annotated[str | None, typer.Option(help="fem: from rim to rim, '180 deg'")] = None,
    chamfer: Annotated[str | None, typer.Option(help="fem: of the rim's inner edge, '1 mm'")] = None,
    interface: Annotated[str | None, typer.Option(help="fem: liner 'bonded' or 'sliding' on its backing")] = None,
    element_size: Annotated[str | None, typer.Option(help="fem: '0.05 mm'; without it, what the contact needs")] = None,
    element: Annotated[str | None, typer.Option(help="fem: 'biquadratic' or 'bilinear'")] = None,
    meshes: Annotated[int | None, typer.Option(min=1, max=2, help="fem: 1 gives no error bars")] = None,
    section: Annotated[Path | None, typer.Option(help="fem: write mesh, stresses and pressure as a figure")] = None,
    vtk: Annotated[Path | None, typer.Option(help="fem: write meshes and fields, .vtu or .vtk")] = None,
) -> None:
    """Press a ball into its socket and see what models make of it, beside the exact answer.

    The finite elements (--model fem) also answer for rims, chamfers and liners that slide.

    Exit status: 0 done, 2 misuse, 3 an iteration that did not converge, or no answer from any model.
    """
    words = {
        "joint": {"ball_radius": ball_radius, "clearance": clearance, "liner_thickness": liner_thickness},
        "liner": {"material": liner, "young": young, "poisson": poisson},
        "ball": {"material": ball, "young": ball_young, "poisson": ball_poisson},
    }
    described = {table: given(part) for table, part in words.items() if given(part)}
    load = read_load(given({"force": force, "indentation": indentation, "half_angle": half_angle}))
    names = model or []
    cup = {"arc_of_cover": arc_of_cover, "chamfer": chamfer, "interface": interface}
    mesh = {"element_size": element_size, "element": element, "meshes": None if meshes is None else str(meshes)}
    elements.check_asked({**cup, **mesh, "section": section, "vtk": vtk}, judge.name in names)
    output = elements.Output(section=section, vtk=vtk)
    output.check()
    if figure is not None:
        check_format(figure)
    _check_known(names)
    file = joint_file(joint, described)
    load = load or file.load
    if not load:
        raise ValueError("a load is needed: --force, --indentation or --half-angle")
    chosen, remarks = _chosen(names, every), []
    if judge.name in names:
        fem = elements.finite_elements({**cup, **mesh}, file.cup)
        chosen[judge.name] = fem
        remarks.append(elements.remark(*elements.timed(fem, file.joint, load)))
    comparison = bs.compare(file.joint, models={**chosen, reference.name: reference}, **load)
    if not set(comparison) & set(chosen):
        raise ValueError("; ".join(why for name, why in comparison.missing.items() if name in chosen))
    if figure is not None:
        _draw(comparison, {**bs.catalogue, **chosen}, figure)
    if judge.name in comparison:
        output.write(comparison[judge.name], answered(comparison).get(reference.name))
    if as_json:
        echo_json(comparison.summary())
    else:
        terminal.print_press(comparison, remarks)
    failure = _failure(comparison, chosen)
    if failure:
        typer.echo(f"ballsocket: {failure}", err=True)
        raise typer.Exit(FAILURE)


def _check_known(names: list[str]) -> None:
    known = [*bs.catalogue, judge.name]
    for name in names:
        if name not in known:
            raise ValueError(f"model {name!r} is not known{nearest(name, known)}")


def _chosen(names: list[str], every: bool) -> dict[str, Model]:
    """The models of the catalogue that are asked for, the paper's where none is."""
    if every:
        return dict(bs.catalogue)
    return {name: bs.catalogue.get(name, judge) for name in names or [DEFAULT_MODEL]}


def _failure(comparison: Comparison, chosen: Iterable[str]) -> str:
    """What went wrong as a whole, or an empty text: a model without an answer is a note while another one has one."""
    unsettled = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
    if unsettled:
        return f"no convergence of {', '.join(unsettled)} (see the notes)"
    return "" if set(answered(comparison)) & set(chosen) else f"no answer from {', '.join(chosen)} (see the notes)"


def _draw(comparison: Comparison, models: Mapping[str, Model], path: Path) -> None:
    """Draw what has an answer; without any there is no figure."""
    shown = answered(comparison)
    if not shown:
        return
    curves = force_curves(shown, {name: models[name] for name in shown})
    save(press_plot.press_figure(shown, curves), path)
