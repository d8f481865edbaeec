"""Preloaded joints: a ball larger than its socket, which reaches around it beyond the equator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy

from ...contact.assembly import check_joint
from ...core.arrays import Array
from ...core.checks import check_number, require
from ...core.deprecation import RenamedAttribute
from ...problem import Joint
from .bore_shapes import BoreDeviation
from .directions import check_direction
from .model import Sphere, check_sphere

if TYPE_CHECKING:
    from .contact import OffAxisContact

_MAX_BISECTIONS = 40

_RELATIVE_TOLERANCE = 1e-4

_MAX_INTERFERENCES = 4.0
"""Displacement, as a multiple of the interference, at which every ball has lost contact somewhere."""


@dataclass(frozen=True, kw_only=True)
class Preload:
    """Preloaded joint: a ball with an interference in its socket, unloaded, displaced or worn.

    The joint is assembled. Pressing the ball in through the narrower opening is not modelled, nor is any permanent
    deformation from it.

    Parameters
    ----------
    model : Sphere
        Model with a cup that reaches beyond the equator, an arc of cover above π.
    joint : Joint
        Joint with an `interference`.

    Raises
    ------
    ValueError
        A joint with a clearance; a cup that ends before the equator.
    TypeError
        Another model; another type than a joint; an array of joints.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> joint = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    >>> fitted = bs.Preload(model=bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0))), joint=joint)
    >>> bool(fitted.equilibrium.max_pressure > 50.0)
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
    def equilibrium(self) -> OffAxisContact:
        """Contact of the ball in equilibrium without a load."""
        contact: OffAxisContact = self.model.press(self.joint, force=0.0)  # type: ignore[assignment]
        return contact

    def displace(self, displacement: Array) -> OffAxisContact:
        """Solve the contacts of the ball at displacements from the centre of the bore.

        Parameters
        ----------
        displacement : array (..., 3)
            Displacements of the ball's centre in mm, in the body's frame.
        """
        contact: OffAxisContact = self.model.press(self.joint, displacement=displacement)  # type: ignore[assignment]
        return contact

    def separation_displacement(self, direction: Array) -> float:
        """Compute the displacement in mm from equilibrium at which the ball first loses contact in any cell.

        Parameters
        ----------
        direction : array (3,)
            Direction in the body's frame, of any length.

        Raises
        ------
        ValueError
            More than one direction; a direction of length 0.
        """
        vector = check_direction(direction)
        if vector.shape != (3,):
            raise ValueError(f"direction of shape {vector.shape} is not allowed: give one direction x, y, z")
        start = self.equilibrium.displacement @ numpy.array(self.model.cup.frame)

        def is_closed(distance: float) -> bool:
            """Check if the bore touches the ball everywhere at a distance in mm from equilibrium."""
            return _touches_everywhere(self.displace(start + distance * vector / numpy.linalg.norm(vector)))

        return self._bisect_length(is_closed)

    def wear_depth_to_loosen(self) -> float:
        """Compute the uniform wear of the bore in mm at which the unloaded ball first loses contact in any cell."""

        def is_closed(depth: float) -> bool:
            """Check if the bore touches the ball everywhere at a uniform wear depth in mm."""
            worn = replace(self.model, worn=BoreDeviation(of=lambda n: depth + 0.0 * n[2]))
            return _touches_everywhere(worn.press(self.joint, force=0.0))  # type: ignore[arg-type]

        return self._bisect_length(is_closed)

    def _bisect_length(self, is_closed: Callable[[float], bool]) -> float:
        """Find the largest length in mm at which the contact is closed, or 0 if it is open at 0."""
        low, high = 0.0, _MAX_INTERFERENCES * float(self.joint.interference)
        if not is_closed(low):
            return 0.0
        for _ in range(_MAX_BISECTIONS):
            middle = (low + high) / 2
            low, high = (middle, high) if is_closed(middle) else (low, middle)
            if high - low < _RELATIVE_TOLERANCE * high:
                break
        return low

    rest = RenamedAttribute("equilibrium")
    displaced = RenamedAttribute("displace")
    lost_at = RenamedAttribute("separation_displacement")
    worn_out_at = RenamedAttribute("wear_depth_to_loosen")


def _touches_everywhere(contact: OffAxisContact) -> bool:
    """Return True if every cell of a single contact is loaded."""
    return bool((contact.pressure_map[2] > 0).all())
