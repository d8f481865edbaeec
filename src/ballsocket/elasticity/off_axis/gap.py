"""How far a ball that sits anywhere in its bore asks the surface to give way."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy

from ...core.arrays import Numbers
from ...models.kinematics import linear_indentation
from ...problem.gaps import CircularGap, LinearGap
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

    def on(self, coarser: Grid) -> Separation:
        """This gap on the coarser grid."""
        return replace(self, grid=coarser, depth=self.grid.gathered(self.depth))

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
        ball, square = self._chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, 0.0))
        # e·n + sqrt(R1² - |e|² + (e·n)²) - R2, without cancellation
        overlap = along - self.clearance - self.depth - (ball * ball - square) / (ball + root)
        return numpy.where(square > 0, overlap, -self.socket_radius)  # a ray that passes by the ball

    def slope(self, displacement: Numbers) -> Numbers:
        """The overlap's slope by the displacement: (batch or 1, 3, rings, meridians)."""
        normals = self.grid.normals[None]
        if self.kind is LinearGap:
            return normals
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        ball, square = self._chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, (1e-6 * ball) ** 2))
        return normals + (along[:, None] * normals - displacement[:, :, None, None]) / root[:, None]

    def _chord(self, displacement: Numbers, along: Numbers) -> tuple[float, Numbers]:
        """The ball's radius, and the square of half the chord that it cuts off each ray."""
        ball = self.socket_radius - self.clearance
        return ball, ball * ball - (displacement * displacement).sum(axis=1)[:, None, None] + along * along


class Bore(Protocol):
    """What a ball is pressed into, as far as its sizes go."""

    @property
    def clearance(self) -> float: ...
    @property
    def socket_radius(self) -> float: ...


def sunk(bore: Bore, modulus: float, depth: Numbers, force: Numbers, axes: Numbers) -> Numbers:
    """Displacements (n, 3) in mm to begin with: along the loads, into a whole sphere of springs, by the wear deeper.

    Parameters
    ----------
    bore : object with a clearance and a socket_radius
        In mm.
    modulus : float
        Of the springs in MPa/mm: that of the bore under pressure all over.
    depth : array
        Of the worn bore below the sphere, in mm.
    force, axes : array (n,), array (n, 3)
        The size of the loads in N, and unit vectors along them.
    """
    clearance = max(bore.clearance, 0.0)
    deep = linear_indentation(bore.socket_radius, clearance, modulus, force)
    begin: Numbers = axes * (clearance + deep + float(depth.max(initial=0.0)))[:, None]
    return begin
