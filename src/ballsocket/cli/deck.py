"""`deck`: the finite-element model of a joint as an input file for CalculiX or Abaqus."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..output import terminal
from . import elements
from .root import app
from .words import load_of, named_joint


@app.command()
def deck(
    joint: Annotated[str, typer.Argument(help="A joint file (TOML), or the name of a preset.")],
    out: Annotated[Path, typer.Option(help="The folder to write into; made if it is not there.")],
    force: Annotated[str | None, typer.Option(help="Axial load, '3 kN'")] = None,
    indentation: Annotated[str | None, typer.Option(help="Approach from first touch, '40 um'")] = None,
    half_angle: Annotated[str | None, typer.Option(help="Contact half-angle, '40 deg'")] = None,
    steps: Annotated[int, typer.Option(min=1, help="Equal indentations up to the load's.")] = 8,
    scale: Annotated[
        float, typer.Option(help="Of clearance and indentation; 1 has contact on the deformed shape.")
    ] = 1e-3,
    arc_of_cover: Annotated[str | None, typer.Option(help="From rim to rim, '180 deg'")] = None,
    chamfer: Annotated[str | None, typer.Option(help="Of the rim's inner edge, '1 mm'")] = None,
    interface: Annotated[str | None, typer.Option(help="Liner 'bonded' or 'sliding' on its backing")] = None,
    element_size: Annotated[str | None, typer.Option(help="'0.05 mm'; without it, what the contact needs")] = None,
    element: Annotated[str | None, typer.Option(help="'biquadratic' or 'bilinear'")] = None,
    run: Annotated[bool, typer.Option("--run", help="Run ccx on it, and show its answer beside ours.")] = False,
) -> None:
    """Write the finite-element model of a joint as an input file for CalculiX or Abaqus, with the numbers to expect."""
    file = named_joint(joint)
    load = load_of({"force": force, "indentation": indentation, "half_angle": half_angle}, file)
    words = {
        "arc_of_cover": arc_of_cover,
        "chamfer": chamfer,
        "interface": interface,
        "element_size": element_size,
        "element": element,
        "meshes": "1",
    }
    contact, _ = elements.timed(elements.finite_elements(words, file.cup), file.joint, load)
    if contact.status.failed:
        raise ValueError("; ".join(contact.notes))
    from ..fem.export.calculix import run as run_ccx
    from ..fem.export.deck import deck_of

    made = deck_of(contact, steps=steps, scale=scale)
    typer.echo(f"{made.write(out)}: {contact.mesh.elements} elements, {steps} steps")
    if run:
        terminal.print_rival(made.expected, run_ccx(out))
