"""Command `film`: lubricating film of a pressed joint."""

from __future__ import annotations

from math import hypot, isfinite
from typing import Annotated

import numpy

from ..contact import Contact
from ..core.arrays import Numbers
from ..core.checks import require
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import Direction, JointFile
from ..files.joint_options import PARTS
from ..files.schema import FileTable, Length, RotationRate, Viscosity, Word, meaning
from ..files.tables import quantities_of, written_in
from ..files.units import as_given
from ..lubrication.film import METHODS, describe_films
from ..lubrication.film import film as compute_film
from ..lubrication.lubricant import Lubricant
from ..model_catalogue import with_gap
from ..question import PressQuestion
from ..reports.film_results import film_figure
from .elasticity_options import ModelNames, RingTable
from .options import GapName, JointName, JointOptions, OutputOptions, expand_groups, needed_load, requested_model
from .root import app, fail


class FilmMethod(Word):
    """Method of computing a film."""

    choices = tuple(METHODS)


class FilmInputs(FileTable, frozen=True, kw_only=True):
    """Motion of the ball, lubricant and method."""

    spin: Annotated[RotationRate, meaning("rotation rate of the ball", example="90 deg/s")] = RotationRate.stating(
        1.5, "1.5 rad/s"
    )
    spin_axis: Annotated[
        Direction | None,
        meaning(
            "axis of the rotation 'x,y,z'; z is the load, for sphere the axis of the cup",
            default="x, or the part of x across the load",
        ),
    ] = None
    viscosity: Annotated[Viscosity, meaning("viscosity of the lubricant")] = Viscosity.stating(2.5e-3, "2.5 mPa s")
    method: Annotated[FilmMethod, meaning("method; reynolds is for models on springs, exact and tabulated")] = (
        FilmMethod("wave")
    )
    ball_roughness: Annotated[Length, meaning("roughness Ra of the ball")] = Length.stating(20e-6, "20 nm")
    cup_roughness: Annotated[Length, meaning("roughness Ra of the cup")] = Length.stating(1e-3, "1 um")

    def lubricant(self) -> Lubricant:
        """Return the lubricant with the roughness of both surfaces."""
        with as_given(written_in(self)):
            return Lubricant(**quantities_of(self, "viscosity", "ball_roughness", "cup_roughness"))

    def spin_of(self, contact: Contact) -> Numbers:
        """Return the rotation rate (3,) in rad/s in the frame of a contact."""
        rate = float(self.spin)
        require("spin", rate, isfinite(rate), "a rotation rate (rad/s) is finite")
        if self.spin_axis is not None:
            return rate * numpy.array(self.spin_axis) / hypot(*self.spin_axis)
        if not isinstance(contact, OffAxisContact):
            return rate * numpy.array([1.0, 0.0, 0.0])
        load = numpy.asarray(contact.force_vector) / numpy.linalg.norm(contact.force_vector)
        first, second = numpy.eye(2, 3)
        chosen = first if abs(load[0]) < _NEARLY_PARALLEL else second
        across = chosen - (chosen @ load) * load
        return rate * across / numpy.linalg.norm(across)


_NEARLY_PARALLEL = 0.99  # cosine of the angle between load and x above which the rotation is about y


@app.command()
@expand_groups
def film(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    model: ModelNames = None,
    gap: GapName = None,
    inputs: FilmInputs,
    rings: Annotated[RingTable, "sphere"],
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
        compute_film(contact, spin=inputs.spin_of(contact), lubricant=inputs.lubricant(), method=inputs.method)
        for contact in _contacts(model, gap, file, rings)
    ]
    output.print(
        lambda: {"joint": file.joint.summary(), "results": [film.summary() for film in films]},
        lambda: describe_films(films),
    )
    output.draw(lambda: film_figure(films[0]))
    failed = [film for film in films if film.status.failed]
    if failed:
        fail(f"the film of {failed[0].contact.model.name} did not converge")


def _contacts(names: list[str] | None, gap: str | None, file: JointFile, rings: RingTable) -> list[Contact]:
    """Press the joint by the requested models.

    Raises typer.Exit: a model has no result.
    """
    load = needed_load(file)
    question = PressQuestion(
        file=file, models={model.name: model for model in map(requested_model, names or ())}, sphere=rings.model()
    )
    contacts = []
    for chosen in question.chosen.values():
        model = with_gap(chosen, gap).in_cup(file.cup, **file.aim)
        contact = model.press(file.joint, **load)
        if contact.status.failed:
            fail(f"no answer from {model.name}: {contact.status.sentence}")
        contacts.append(contact)
    return contacts
