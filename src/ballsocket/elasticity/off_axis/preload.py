"""A preloaded joint: a ball that is larger than its socket, which reaches around it beyond the equator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy

from ...contact.assembly import check_joint
from ...core.arrays import Array, Numbers
from ...core.checks import check_number, require
from ...problem import Joint
from .directions import checked_direction
from .model import Sphere, check_sphere
from .worn import Worn

if TYPE_CHECKING:
    from .contact import OffAxisContact

_HALVINGS = 40
_FAR = 4.0  # interferences: no contact is whole at such a displacement


@dataclass(frozen=True, kw_only=True)
class Preload:
    """What a joint with an interference does at rest, when it is displaced, and as it wears.

    The joint is taken as assembled: pressing the ball in, through an opening that is narrower than it, is not
    modelled, and what the material kept of it neither.

    Parameters
    ----------
    model : Sphere
        With a cup that reaches beyond the equator, an arc of cover above π.
    joint : Joint
        With an `interference`.

    Raises
    ------
    ValueError
        A joint with a clearance; a cup that ends before the equator.
    TypeError
        Another model; what is no joint, or is many.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> joint = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    >>> fitted = bs.Preload(model=bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0))), joint=joint)
    >>> bool(fitted.rest.max_pressure > 50.0)
    True
    """

    model: Sphere
    joint: Joint

    def __post_init__(self) -> None:
        check_sphere(self.model)
        check_joint(self.joint)
        interference = check_number("interference", self.joint.interference)
        require("interference", interference, interference > 0, "a preloaded joint has an interference above 0")
        arc = self.model.cup.arc_of_cover
        require("arc_of_cover", arc, arc > numpy.pi, "a preloaded socket reaches beyond the equator, above pi radians")

    @cached_property
    def rest(self) -> OffAxisContact:
        """The contact without a load."""
        contact: OffAxisContact = self.model.press(self.joint, force=0.0)  # type: ignore[assignment]
        return contact

    def displaced(self, displacement: Array) -> OffAxisContact:
        """Contacts with the ball's centre at these places from the centre of the bore.

        Parameters
        ----------
        displacement : array (..., 3)
            In mm, in the body's frame.
        """
        contact: OffAxisContact = self.model.press(self.joint, displacement=displacement)  # type: ignore[assignment]
        return contact

    def lost_at(self, direction: Array) -> float:
        """The displacement in mm from rest along a direction at which the ball first leaves its socket somewhere.

        Parameters
        ----------
        direction : array (3,)
            In the body's frame, of any length.
        """
        way = checked_direction(direction)
        if way.shape != (3,):
            raise ValueError(f"direction of shape {way.shape} is not allowed: one direction at a time, x, y, z")
        start = self.rest.displacement @ numpy.array(self.model.cup.frame)
        return self._last(lambda far: self._whole(start + far * way / numpy.linalg.norm(way)))

    def worn_out_at(self) -> float:
        """The even wear of the bore in mm after which the ball at rest first leaves its socket somewhere."""

        def whole(depth: float) -> bool:
            worn = replace(self.model, worn=Worn(of=lambda n: depth + 0.0 * n[2]))
            return _touches_everywhere(worn.press(self.joint, force=0.0).pressure_map[2])  # type: ignore[attr-defined]

        return self._last(whole)

    def _whole(self, displacement: Numbers) -> bool:
        return _touches_everywhere(self.displaced(displacement).pressure_map[2])

    def _last(self, whole: Callable[[float], bool]) -> float:
        """The largest amount at which the contact is whole, 0 where it never is."""
        low, high = 0.0, _FAR * float(self.joint.interference)
        if not whole(low):
            return 0.0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if whole(middle) else (low, middle)
            if high - low < 1e-4 * high:
                break
        return low


def _touches_everywhere(pressure: Numbers) -> bool:
    return bool((pressure > 0).all())
