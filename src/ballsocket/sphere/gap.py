"""How far a ball that sits anywhere in its bore asks the surface to give way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..arrays import Numbers
from ..gaps import CircularGap, LinearGap
from .grid import Grid


@dataclass(frozen=True, kw_only=True, eq=False)
class Separation:
    """The gap between ball and bore on a grid.

    Attributes
    ----------
    grid : Grid
    clearance, socket_radius : float
        In mm.
    depth : array (rings, meridians)
        Of the worn bore below the sphere, in mm.
    kind : type
        `LinearGap` or `CircularGap`.
    """

    grid: Grid
    clearance: float
    socket_radius: float
    depth: Numbers
    kind: type[LinearGap] | type[CircularGap]

    def overlap(self, displacement: Numbers) -> Numbers:
        """How far the ball would stand in the bore's surface: (batch, rings, meridians) in mm, below 0 where apart.

        Parameters
        ----------
        displacement : array (batch, 3)
            Of the ball's centre from the centre of the bore, in mm.
        """
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        if self.kind is LinearGap:
            return along - self.clearance - self.depth
        ball, root = self._chord(displacement, along)
        # e·n + sqrt(R1² - |e|² + (e·n)²) - R2, without cancellation
        return along - self.clearance - self.depth - (ball * ball - root * root) / (ball + root)

    def slope(self, displacement: Numbers) -> Numbers:
        """The overlap's slope by the displacement: (batch or 1, 3, rings, meridians)."""
        normals = self.grid.normals[None]
        if self.kind is LinearGap:
            return normals
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        _, root = self._chord(displacement, along)
        return normals + (along[:, None] * normals - displacement[:, :, None, None]) / root[:, None]

    def _chord(self, displacement: Numbers, along: Numbers) -> tuple[float, Numbers]:
        ball = self.socket_radius - self.clearance
        square = (displacement * displacement).sum(axis=1)[:, None, None]
        return ball, numpy.sqrt(numpy.maximum(ball * ball - square + along * along, (1e-3 * ball) ** 2))
