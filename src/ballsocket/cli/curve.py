"""`curve`: one joint from first touch to a load, by one model."""

from __future__ import annotations

from typing import Annotated, Any

import numpy
import typer

import ballsocket as bs

from ..reports.terminal import print_curve
from ..studies.file import named_model
from .elements import CupWords
from .groups import grouped
from .root import FAILURE, app, complain
from .words import AsJson, JointWords, LoadWords, echo_json


@app.command()
@grouped
def curve(
    *,
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    load: LoadWords,
    model: Annotated[str, typer.Option(help="A model's name.")] = "exact",
    points: Annotated[int, typer.Option(min=2, max=500, help="Loads from 0 to the given one, in equal steps.")] = 21,
    cup: CupWords,
    as_json: AsJson = False,
) -> None:
    """Press a joint with more and more, from first touch to a load: force, indentation, stiffness, pressure, area.

    Exit status: 0 done, 2 misuse, 3 no answer at any load.
    """
    file, asked = words.or_named(joint), named_model(model)
    steps: dict[str, Any] = {name: end * numpy.linspace(0.0, 1.0, points) for name, end in load.or_of(file).items()}
    contact = asked.in_cup(cup.on(file.cup)).press(file.joint, **steps)
    if as_json:
        echo_json({"version": bs.__version__, "joint": file.joint.summary(), **_told(contact)})
    else:
        print_curve(contact)
    if not numpy.isfinite(contact.indentation[1:]).any():
        complain(f"no answer from {asked.name} at any load (see the notes)")
        raise typer.Exit(FAILURE)


def _told(contact: Any) -> dict[str, Any]:
    """The numbers as lists; valid where every point is."""
    told = contact.summary()
    return {**told, "valid": all(told["valid"]), "valid_at": told["valid"]}
