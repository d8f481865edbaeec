"""Command `film`: lubricating film of a pressed joint."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Annotated

import numpy
import typer

from ..contact import Contact
from ..core.arrays import Numbers
from ..core.checks import require, shown
from ..core.kinds import Kind
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile, tilted_cup
from ..files.units import parse
from ..lubrication.film import METHODS
from ..lubrication.film import film as compute_film
from ..lubrication.lubricant import Lubricant
from ..model_catalogue import off_axis, with_gap
from ..problem.cup import UP
from ..reports.film_results import film_figure, print_films
from ..reports.unit_systems import Units
from ..version import __version__
from .elasticity_options import CupOptions, DirectionOptions
from .model_file import requested_model
from .options import (
    GapName,
    JointName,
    JointOptions,
    LoadOptions,
    OutputOptions,
    UnitSystem,
    complete_model,
    expand_groups,
)
from .press import DEFAULT_MODEL
from .root import app, fail


@dataclass(frozen=True, kw_only=True)
class FilmOptions:
    """Options of the motion, of the lubricant and of the method."""

    model: Annotated[
        list[str] | None,
        typer.Option(
            help="Name of a model (see `ballsocket models`), sphere, or FILE.py:NAME. Repeat for several. "
            f"Default: {DEFAULT_MODEL}, or sphere for a tilted load.",
            autocompletion=complete_model,
        ),
    ] = None
    gap: GapName = None
    spin: Annotated[str, typer.Option(help="Rotation rate of the ball in rad/s, or with a unit: '90 deg/s'.")] = (
        "1.5 rad/s"
    )
    spin_axis: Annotated[
        str | None,
        typer.Option(
            help="Axis of the rotation 'x,y,z'; z is the load, for sphere the axis of the cup. "
            "Default: x, or the part of x across the load."
        ),
    ] = None
    viscosity: Annotated[str, typer.Option(help="Viscosity of the lubricant in Pa s, or with a unit: '2.5 mPa s'.")] = (
        "2.5 mPa s"
    )
    method: Annotated[
        str, typer.Option(help=f"Method: {', '.join(METHODS)}. reynolds is for models on springs, exact and tabulated.")
    ] = "wave"
    ball_roughness: Annotated[str, typer.Option(help="Roughness Ra of the ball in mm, or with a unit: '20 nm'.")] = (
        "20 nm"
    )
    cup_roughness: Annotated[str, typer.Option(help="Roughness Ra of the cup in mm, or with a unit: '1 um'.")] = "1 um"

    def lubricant(self) -> Lubricant:
        """Return the lubricant with the roughness of both surfaces."""
        lengths = {name: parse(name, getattr(self, name), Kind.LENGTH) for name in ("ball_roughness", "cup_roughness")}
        return Lubricant(viscosity=parse("viscosity", self.viscosity, Kind.VISCOSITY), **lengths)

    def spin_of(self, contact: Contact) -> Numbers:
        """Return the rotation rate (3,) in rad/s in the frame of a contact."""
        rate = parse("spin", self.spin, Kind.ROTATION_RATE)
        require("spin", rate, bool(numpy.isfinite(rate)), "a rotation rate (rad/s) is finite")
        if self.spin_axis is not None:
            return rate * _unit_axis(self.spin_axis)
        if not isinstance(contact, OffAxisContact):
            return rate * numpy.array([1.0, 0.0, 0.0])
        load = numpy.asarray(contact.force_vector) / numpy.linalg.norm(contact.force_vector)
        first, second = numpy.eye(2, 3)
        chosen = first if abs(load[0]) < _NEARLY_PARALLEL else second
        across = chosen - (chosen @ load) * load
        return rate * across / numpy.linalg.norm(across)


def _unit_axis(text: str) -> Numbers:
    """Return the unit vector (3,) of an axis such as '0,1,0'.

    Raises
    ------
    ValueError
        Other than three numbers, or numbers without a direction.
    """
    try:
        axis = numpy.array([float(number) for number in text.split(",")])
    except ValueError:
        axis = numpy.empty(0)
    if axis.shape != (3,):
        raise ValueError(f"spin_axis = {shown(text)} must be three numbers 'x,y,z', such as '0,1,0'")
    largest = float(numpy.abs(axis).max())
    require("length of spin_axis", largest, 0 < largest < inf, "an axis has a positive and finite length")
    scaled = axis / largest  # its square neither overflows nor vanishes
    return scaled / numpy.linalg.norm(scaled)


_NEARLY_PARALLEL = 0.99
"""Cosine of the angle between load and x above which the rotation is about y."""


@app.command()
@expand_groups
def film(
    *,
    joint: JointName = None,
    joint_options: JointOptions,
    load: LoadOptions,
    film_options: FilmOptions,
    direction_options: DirectionOptions,
    cup_options: CupOptions,
    units: UnitSystem = Units.SI,
    output: OutputOptions,
) -> None:
    """Compute the lubricating film between ball and socket.

    The ball turns about an axis across the load and draws lubricant into the contact. inlet is the closed form at the
    edge of the contact. wave carries the film over the contact. reynolds solves Reynolds' equation with the deformation
    and the balance of the load. The error is an estimate; a film is valid up to 10 %.

    Exit status: 0 success, 2 wrong input, 3 an iteration did not converge or a model has no result.
    """
    output.check()
    file = joint_options.read(joint)
    films = [
        compute_film(
            contact,
            spin=film_options.spin_of(contact),
            lubricant=film_options.lubricant(),
            method=film_options.method,
        )
        for contact in _contacts(film_options, file, load.read(file), direction_options, cup_options)
    ]
    output.print(
        lambda: {"version": __version__, "joint": file.joint.summary(), "results": [film.summary() for film in films]},
        lambda: print_films(films, units),
    )
    output.draw(lambda: film_figure(films[0]))
    failed = [film for film in films if film.status.failed]
    if failed:
        fail(f"the film of {failed[0].contact.model.name} did not converge")


def _contacts(
    options: FilmOptions,
    file: JointFile,
    load: dict[str, float],
    direction_options: DirectionOptions,
    cup_options: CupOptions,
) -> list[Contact]:
    """Press the joint by the requested models.

    Raises
    ------
    typer.Exit
        A model has no result.
    """
    direction = direction_options.read(file)
    cup = tilted_cup(cup_options.apply_to(file.cup), direction)
    default = off_axis.name if direction or cup.tilt(UP) > 0 else DEFAULT_MODEL
    contacts = []
    for name in options.model or [default]:
        model = requested_model(name)
        if model.name == off_axis.name:
            model = replace(direction_options.model(), cup=cup).with_direction(**direction)
        model = with_gap(model, options.gap)
        contact = model.press(file.joint, **load)
        if contact.status.failed:
            fail(f"no answer from {model.name}: {contact.status.sentence}")
        contacts.append(contact)
    return contacts
