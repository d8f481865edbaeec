"""How a cup may stand: one load of the body pressed into it at many inclinations and anteversions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import degrees, inf, radians
from time import perf_counter
from typing import Any

import numpy

from ...contact.assembly import check_joint
from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.checks import check_number, require
from ...core.quantities import CUP
from ...core.validity import Status, is_missing
from ...problem import Joint
from ...version import __version__
from ..finite_elements.progress import report_progress
from .contact import OffAxisContact
from .model import Sphere, check_sphere


@dataclass(frozen=True, kw_only=True, eq=False)
class Orientations:
    """Contacts of one cup that stands in many ways, under one load; numbers are arrays (inclinations, anteversions).

    They are NaN where the bore does not hold the ball, and the `status` says so.

    Attributes
    ----------
    model : Sphere
        With the cup as it was given, and the direction of the load in the body's frame.
    joint : Joint
    load : dict
        As it was given.
    inclination, anteversion : array (n,), array (m,)
        In rad.
    contacts : tuple of OffAxisContact
        For each inclination those of all anteversions; vectors are in the frame of the cup that stands so.
    seconds : float
        What it took.
    """

    model: Sphere
    joint: Joint
    load: dict[str, float]
    inclination: Numbers
    anteversion: Numbers
    contacts: tuple[OffAxisContact, ...]
    seconds: float

    def _each(self, of: Callable[[OffAxisContact], Array]) -> Numbers:
        return numpy.stack([arrays.to_numpy(of(contact)) for contact in self.contacts])

    @cached_property
    def status(self) -> Numbers:
        """How each press ended, as the numbers of `Status`."""
        return self._each(lambda contact: contact.status)

    @cached_property
    def valid(self) -> Numbers:
        """Whether each answer can be trusted."""
        return self._each(lambda contact: contact.valid)

    @cached_property
    def tilt(self) -> Numbers:
        """The angle in rad between load and cup's axis."""
        return self._each(lambda contact: contact.tilt)

    @cached_property
    def edge_distance(self) -> Numbers:
        """The arc in mm from the contact to the rim; below 0 the load is so far beyond where it just reaches that."""
        return self._each(lambda contact: contact.edge_distance)

    @cached_property
    def edge_loaded(self) -> Numbers:
        """Whether the contact reaches the rim."""
        return self._each(lambda contact: contact.edge_loaded)

    @cached_property
    def max_pressure(self) -> Numbers:
        """The largest pressure in MPa; infinite where the end of the bore digs in."""
        return self._each(lambda contact: contact.max_pressure)

    @cached_property
    def half_angle(self) -> Numbers:
        """In rad, of a round contact of the same area."""
        return self._each(lambda contact: contact.half_angle)

    @cached_property
    def held(self) -> Numbers:
        """Where there is an answer."""
        return ~numpy.asarray(is_missing(self.status))

    def best(self, of: Numbers) -> tuple[float, float, int]:
        """Inclination and anteversion in rad where a field is largest, and its place in the flat field."""
        place = int(numpy.where(self.held & numpy.isfinite(of), of, -inf).argmax())
        row, column = divmod(place, len(self.anteversion))
        return float(self.inclination[row]), float(self.anteversion[column]), place

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON: fields are a list of anteversions for each inclination, in mm, MPa and degrees."""
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
            "status": [[Status(int(each)).name for each in row] for row in self.status],
            "valid": self.valid.tolist(),
            "seconds": self.seconds,
        }


_INCLINATIONS, _ANTEVERSIONS = (tuple(radians(2.5 * i) for i in steps) for steps in (range(12, 25), range(13)))


def orient(
    joint: Joint,
    *,
    model: Sphere | None = None,
    inclination: Array = _INCLINATIONS,
    anteversion: Array = _ANTEVERSIONS,
    **load: float,
) -> Orientations:
    """Press one joint in a cup that stands in many ways, under a load that keeps its direction in the body.

    The cup's own rings do not know how it stands: it is set up once.

    Parameters
    ----------
    joint : Joint
        Of plain numbers.
    model : Sphere, optional
        With the cup (its own inclination and anteversion do not matter), one direction of load, upwards by default, and
        the width of the rings.
    inclination, anteversion : array (n,), array (m,)
        Radiographic angles in rad: 30° to 60° and 0 to 30° by default, each 2.5°.
    force, indentation, half_angle : float
        One of them, as in a press.

    Returns
    -------
    Orientations

    Raises
    ------
    ValueError
        A number that is not allowed; a model with more than one direction.
    TypeError
        Another model; more than one joint or load.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> angles = [radians(each) for each in (30.0, 50.0)]
    >>> stood = bs.orient(bs.joints["hip-36"], force=3000.0, inclination=angles, anteversion=[0.0, radians(20.0)])
    >>> stood.edge_distance.round(1)
    array([[ 5.4,  3.7],
           [ 0.2, -0.6]])
    """
    model = Sphere() if model is None else check_sphere(model)
    _check_alone(joint, load)
    one = model.direction.ndim == 1
    require("directions of the model", model.direction.size // 3, one, "a cup is turned under one direction of load")
    axes = [_angles(name, values) for name, values in (("inclination", inclination), ("anteversion", anteversion))]
    start, contacts = perf_counter(), []
    for number, angle in enumerate(axes[0]):
        report_progress(f"inclination {number + 1} of {len(axes[0])}")
        contacts.append(_complete(model.press(joint, inclination=float(angle), anteversion=axes[1], **load)))
    return Orientations(
        model=model,
        joint=joint,
        load=load,
        inclination=axes[0],
        anteversion=axes[1],
        contacts=tuple(contacts),
        seconds=perf_counter() - start,
    )


def _check_alone(joint: Any, load: Mapping[str, Any]) -> None:
    """Raise TypeError for what is no joint, or more than one of it or its load."""
    check_joint(joint)
    if any(numpy.shape(arrays.to_numpy(number)) for number in joint.numbers()):
        raise TypeError("joint must be one joint, of plain numbers: a cup is turned around one")
    for name, value in load.items():
        if value is not None:
            check_number(name, value)


def _angles(name: str, values: Array) -> Numbers:
    """Angles (n,) in rad that a cup can have."""
    angles = numpy.atleast_1d(arrays.to_numpy(CUP[name].checked(values)).astype(float))
    if angles.ndim != 1 or angles.size == 0:
        raise ValueError(f"{name} of shape {angles.shape} is not allowed: a row of angles is needed")
    rising = bool((numpy.diff(angles) > 0).all())
    require(f"{name} from {angles[0]:.4g} to", angles[-1], rising, "angles (rad) rise from one to the next")
    return angles


def _complete(contact: Any) -> OffAxisContact:
    """The contact, with what is made when it is first asked for."""
    _ = contact.max_pressure, contact.edge_margin, contact.half_angle
    found: OffAxisContact = contact
    return found
