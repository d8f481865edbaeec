"""Command `deck`: the finite-element model of a joint as an input file for CalculiX or Abaqus."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated

import typer

from ..files.joint_file import JointFile, read_aim
from ..reports.accuracy_results import print_rival, print_tilted_rival
from .elasticity_options import CupOptions, MeshOptions, solve_mesh
from .options import JointName, JointOptions, LoadOptions, expand_groups
from .root import app, echo_path

_TILTED_ELEMENT_ANGLE = 6.0  # degrees of the bore per element, by default


@app.command()
@expand_groups
def deck(
    *,
    joint: JointName = None,
    joint_options: JointOptions,
    out: Annotated[Path, typer.Option(help="Output folder; created if it does not exist.")],
    load_options: LoadOptions,
    steps: Annotated[
        int, typer.Option(min=1, max=1000, help="Number of equal indentation steps up to that of the load.")
    ] = 8,
    scale: Annotated[
        float,
        typer.Option(
            help="Factor on clearance and indentation; small: contact on the undeformed shape, 1: on the deformed."
        ),
    ] = 1e-3,
    tilt: Annotated[
        str | None, typer.Option(help="Angle between load and cup axis: '45 deg'. Writes a three-dimensional model.")
    ] = None,
    cup: CupOptions,
    mesh: MeshOptions,
    run: Annotated[bool, typer.Option("--run", help="Run CalculiX (ccx), and compare its results with ours.")] = False,
) -> None:
    """Write a finite-element input file for CalculiX or Abaqus.

    The folder also gets the results to expect.
    """
    file = joint_options.read(joint)
    load = load_options.read(file)
    if tilt is not None:
        angle = read_aim({"tilt": tilt})["tilt"]
        _write_tilted(replace(file, cup=cup.apply_to(file.cup)), load, angle, out, mesh, run)
        return
    contact, _ = solve_mesh(mesh.model(cup.apply_to(file.cup), meshes=1), file.joint, load)
    if contact.status.failed:
        raise ValueError("; ".join(contact.notes))
    from ..elasticity.finite_elements.decks.calculix import run as run_ccx
    from ..elasticity.finite_elements.decks.deck import deck_of

    made = deck_of(contact, steps=steps, scale=scale)
    echo_path(made.write(out), f": {contact.mesh.elements} elements, {steps} steps")
    if run:
        print_rival(made.expected, run_ccx(out))


def _write_tilted(
    file: JointFile, load: dict[str, float], tilt: float, out: Path, mesh: MeshOptions, run: bool
) -> None:
    """Write the input file of a ball that is displaced at a tilt in rad."""
    from ..elasticity.off_axis.deck import TiltedDeck
    from ..elasticity.off_axis.deck import run as run_ccx

    if "indentation" not in load:
        raise ValueError("a tilted deck displaces the ball: give an indentation")
    size = mesh.size or radians(_TILTED_ELEMENT_ANGLE) * float(file.joint.socket_radius)
    made = TiltedDeck(
        joint=replace(file.joint, ball=None),
        cup=file.cup,
        indentation=load["indentation"],
        tilt=tilt,
        element_size=size / float(file.joint.socket_radius),
    )
    echo_path(made.write(out), f": {made.ball.last_number} nodes, rigid ball")
    if run:
        print_tilted_rival(made.expected["force_vector"], run_ccx(out)["force_vector"])
