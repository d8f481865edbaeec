"""Contacts of one cup at many inclinations and anteversions, under one load of the body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees, inf, radians
from time import perf_counter
from typing import Any

import numpy

from ...contact.assembly import check_joint
from ...contact.verdict import Bounded, error_bar
from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.checks import check_number, require
from ...core.display import split_numbers
from ...core.quantities import CUP
from ...core.records import Record
from ...core.validity import Status, is_missing
from ...problem import Joint
from ...version import __version__
from ..finite_elements.progress import report_progress
from .contact import OffAxisContact
from .model import Sphere, check_sphere


@dataclass(frozen=True, kw_only=True, eq=False)
class Orientations(Record):
    """Contacts of one cup in many orientations under one load; fields are arrays (inclinations, anteversions).

    Fields are NaN where the bore does not hold the ball; `status` reports these orientations.

    Attributes
    ----------
    model : Sphere
        Model with the original cup, and the direction of the load in the body's frame.
    joint : Joint
    load : dict
        Prescribed load by its name.
    inclination, anteversion : array (n,), array (m,)
        Angles in rad.
    contacts : tuple of OffAxisContact
        Contacts of all anteversions, for each inclination. Vectors are in the frame of the rotated cup.
    seconds : float
        Computing time in s.
    status : array
        Outcome of each press, as a number of `Status`.
    valid : array of bool
        True where the model is valid.
    tilt : array
        Angle in rad between the load and the cup's axis.
    edge_distance : array
        Arc in mm from the contact to the rim, negative for edge loading; see `OffAxisContact.edge_distance`.
    edge_loaded : array of bool
        True where the contact reaches the rim.
    max_pressure : array
        Largest pressure in MPa; infinite where the end of the bore indents the ball.
    half_angle : array
        Half angle in rad of a round contact of the same area.
    """

    model: Sphere
    joint: Joint
    load: dict[str, float]
    inclination: Numbers
    anteversion: Numbers
    contacts: tuple[OffAxisContact, ...]
    seconds: float
    status: Numbers
    valid: Numbers
    tilt: Numbers
    edge_distance: Numbers
    edge_loaded: Numbers
    max_pressure: Numbers
    half_angle: Numbers

    def error_bar(self, name: str) -> Bounded:
        """Return a quantity of all contacts with its error bar."""
        bars = [error_bar(contact, name) for contact in self.contacts]
        return Bounded(*(numpy.stack(list(map(arrays.to_numpy, ends))) for ends in zip(*bars, strict=True)))

    @cached_property
    def held(self) -> Numbers:
        """True where the bore holds the ball and there is a solution."""
        return ~numpy.asarray(is_missing(self.status))

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the contacts; one with the largest numbers stands for all that differ in numbers alone."""
        findings = (finding for contact in self.contacts for finding in contact.findings() if finding.applies)
        texts = {finding.sentence for finding in findings} - {status.sentence for status in Status}
        ordered = sorted(texts, key=lambda text: split_numbers(text)[1])
        return tuple({split_numbers(text)[0]: text for text in ordered}.values())

    def best(self, field: Numbers) -> tuple[float, float, int]:
        """Return the inclination and anteversion in rad at which a field is largest, and its flat index."""
        index = int(numpy.where(self.held & numpy.isfinite(field), field, -inf).argmax())
        row, column = divmod(index, len(self.anteversion))
        return float(self.inclination[row]), float(self.anteversion[column]), index

    def summary(self) -> dict[str, Any]:
        """Return the contacts as a dictionary for JSON, with fields in mm, MPa and degrees.

        A field has one list of anteversions for each inclination.
        """
        cup = self.model.cup
        fields = {
            "tilt_deg": numpy.degrees(self.tilt),
            "edge_distance": self.edge_distance,
            "max_pressure": self.max_pressure,
            "half_angle_deg": numpy.degrees(self.half_angle),
        }
        return {
            "version": __version__,
            "model": self.model.name,
            "joint": self.joint.summary(),
            "cup": {"arc_of_cover_deg": degrees(cup.arc_of_cover), "chamfer": cup.chamfer, "side": cup.side.value},
            "load": {**self.load, "direction": self.model.direction.tolist()},
            "inclination_deg": numpy.degrees(self.inclination).tolist(),
            "anteversion_deg": numpy.degrees(self.anteversion).tolist(),
            **{name: arrays.to_list(values) for name, values in fields.items()},
            "edge_loaded": [
                [bool(loaded) if held else None for loaded, held in zip(*pair, strict=True)]
                for pair in zip(self.edge_loaded, self.held, strict=True)
            ],
            "status": [[Status(int(number)).name for number in row] for row in self.status],
            "valid": self.valid.tolist(),
            "notes": list(self.notes),
            "seconds": self.seconds,
        }


_INCLINATIONS, _ANTEVERSIONS = (tuple(radians(2.5 * i) for i in steps) for steps in (range(12, 25), range(13)))
"""Default angles in rad: 30° to 60°, and 0 to 30°, in steps of 2.5°."""


def orient(
    joint: Joint,
    *,
    model: Sphere | None = None,
    inclination: Array = _INCLINATIONS,
    anteversion: Array = _ANTEVERSIONS,
    **load: float,
) -> Orientations:
    """Press one joint in a cup at many orientations, under a load that keeps its direction in the body.

    The compliance in the cup's frame is independent of the orientation and is computed once.

    Parameters
    ----------
    joint : Joint
        A joint without arrays.
    model : Sphere, optional
        Model with the cup, one direction of the load (upwards by default) and the width of the rings. The cup's own
        inclination and anteversion have no effect.
    inclination, anteversion : array (n,), array (m,)
        Radiographic angles in rad; 30° to 60° and 0 to 30° in steps of 2.5° by default.
    force, indentation, half_angle : float
        Exactly one of them, as in `Sphere.press`.

    Raises
    ------
    ValueError
        A number outside its allowed range; a model with more than one direction.
    TypeError
        Another model; more than one joint or load.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> angles = [radians(angle) for angle in (30.0, 50.0)]
    >>> cups = bs.orient(bs.joints["hip-36"], force=3000.0, inclination=angles, anteversion=[0.0, radians(20.0)])
    >>> cups.edge_distance.round(1)
    array([[ 5.4,  3.7],
           [ 0.2, -0.6]])
    """
    model = Sphere() if model is None else check_sphere(model)
    check_joint(joint)
    if any(numpy.shape(arrays.to_numpy(number)) for number in joint.numbers()):
        raise TypeError("joint must be one joint, of plain numbers: arrays of joints are not allowed")
    for name, value in load.items():
        if value is not None:
            check_number(name, value)
    single = model.direction.ndim == 1
    require("directions of the model", model.direction.size // 3, single, "give one direction of the load")
    axes = []
    for name, values in (("inclination", inclination), ("anteversion", anteversion)):
        angles = numpy.atleast_1d(arrays.to_numpy(CUP[name].check(values)).astype(float))
        if angles.ndim != 1 or angles.size == 0:
            raise ValueError(f"{name} of shape {angles.shape} is not allowed: give a row of angles")
        rising = bool((numpy.diff(angles) > 0).all())
        require(f"{name} from {angles[0]:.4g} to", angles[-1], rising, "angles (rad) rise from one to the next")
        axes.append(angles)
    start, contacts = perf_counter(), []
    named_load: dict[str, Any] = {**load}
    for number, angle in enumerate(axes[0]):
        report_progress(f"inclination {number + 1} of {len(axes[0])}")
        contact: Any = model.press(joint, inclination=float(angle), anteversion=axes[1], **named_load)
        contacts.append(contact)
    names = ("status", "valid", "tilt", "edge_distance", "edge_loaded", "max_pressure", "half_angle")
    fields = {name: numpy.stack([arrays.to_numpy(getattr(contact, name)) for contact in contacts]) for name in names}
    return Orientations(
        model=model,
        joint=joint,
        load=load,
        inclination=axes[0],
        anteversion=axes[1],
        contacts=tuple(contacts),
        seconds=perf_counter() - start,
        **fields,
    )
