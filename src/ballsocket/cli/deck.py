"""`deck`: the finite-element model of a joint as an input file for CalculiX or Abaqus."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated

import typer

from ..io.joint_file import JointFile, read_aim
from ..reports.reference_terminal import print_rival, print_tilted_rival
from .elements import CupWords, MeshWords, timed
from .groups import grouped
from .root import app, echo_path
from .words import JointWords, LoadWords


@app.command()
@grouped
def deck(
    *,
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    out: Annotated[Path, typer.Option(help="The folder to write into; made if it is not there.")],
    load: LoadWords,
    steps: Annotated[int, typer.Option(min=1, max=1000, help="Equal indentations up to the load's.")] = 8,
    scale: Annotated[
        float, typer.Option(help="Of clearance and indentation; 1 has contact on the deformed shape.")
    ] = 1e-3,
    tilt: Annotated[str | None, typer.Option(help="'45 deg' from the cup's axis: a deck of three dimensions.")] = None,
    cup: CupWords,
    mesh: MeshWords,
    run: Annotated[bool, typer.Option("--run", help="Run ccx on it, and show its answer beside ours.")] = False,
) -> None:
    """Write the finite-element model of a joint as an input file for CalculiX or Abaqus, with the numbers to expect."""
    file = words.or_named(joint)
    if tilt is not None:
        _tilted(replace(file, cup=cup.on(file.cup)), load.or_of(file), read_aim({"tilt": tilt})["tilt"], out, mesh, run)
        return
    contact, _ = timed(mesh.model(cup.on(file.cup), meshes=1), file.joint, load.or_of(file))
    if contact.status.failed:
        raise ValueError("; ".join(contact.notes))
    from ..elasticity.finite_elements.decks.calculix import run as run_ccx
    from ..elasticity.finite_elements.decks.deck import deck_of

    made = deck_of(contact, steps=steps, scale=scale)
    echo_path(made.write(out), f": {contact.mesh.elements} elements, {steps} steps")
    if run:
        print_rival(made.expected, run_ccx(out))


def _tilted(file: JointFile, load: dict[str, float], tilt: float, out: Path, mesh: MeshWords, run: bool) -> None:
    """A deck of a ball that is displaced at a tilt."""
    from ..elasticity.off_axis.deck import TiltedDeck
    from ..elasticity.off_axis.deck import run as run_ccx

    if "indentation" not in load:
        raise ValueError("a tilted deck displaces the ball: give an indentation")
    size = mesh.size or radians(_WIDE) * float(file.joint.socket_radius)
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


_WIDE = 6.0  # degrees
