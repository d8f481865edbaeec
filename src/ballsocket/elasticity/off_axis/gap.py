"""Gap between ball and bore on a grid, for any position of the ball."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy

from ...core.arrays import Numbers
from ...models.kinematics import linear_indentation
from ...problem.gaps import CircularGap, LinearGap
from .grid import Grid


@dataclass(frozen=True, kw_only=True, eq=False)
class GapField:
    """Gap between the undeformed ball and bore in every cell of a grid.

    Attributes
    ----------
    grid : Grid
    clearance, socket_radius : float
        Radii in mm.
    depth : array (rings, meridians)
        Depth of the worn bore below its sphere in mm.
    kind : type
        `LinearGap` or `CircularGap`.
    """

    grid: Grid
    clearance: float
    socket_radius: float
    depth: Numbers
    kind: type[LinearGap] | type[CircularGap]

    def on_coarser_grid(self, grid: Grid) -> GapField:
        """Return this gap on the next coarser grid."""
        return replace(self, grid=grid, depth=self.grid.coarsen(self.depth))

    def overlap(self, displacement: Numbers) -> Numbers:
        """Compute the overlap of ball and undeformed bore in mm, negative in a gap: (batch, rings, meridians).

        Parameters
        ----------
        displacement : array (batch, 3)
            Displacement of the ball's centre from the centre of the bore, in mm.
        """
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        if self.kind is LinearGap:
            return along - self.clearance - self.depth
        ball, square = self._half_chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, 0.0))
        # e·n + sqrt(R1² - |e|² + (e·n)²) - R2, without cancellation
        overlap = along - self.clearance - self.depth - (ball * ball - square) / (ball + root)
        return numpy.where(square > 0, overlap, -self.socket_radius)  # the ray misses the ball

    def overlap_slope(self, displacement: Numbers) -> Numbers:
        """Compute the derivative of the overlap by the displacement of the ball: (batch or 1, 3, rings, meridians)."""
        normals = self.grid.normals[None]
        if self.kind is LinearGap:
            return normals
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        ball, square = self._half_chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, (1e-6 * ball) ** 2))
        return normals + (along[:, None] * normals - displacement[:, :, None, None]) / root[:, None]

    def _half_chord(self, displacement: Numbers, along: Numbers) -> tuple[float, Numbers]:
        """Compute the ball's radius in mm, and the squared half chord of each cell's ray in the ball in mm²."""
        ball = self.socket_radius - self.clearance
        return ball, ball * ball - (displacement * displacement).sum(axis=1)[:, None, None] + along * along


class BoreSize(Protocol):
    """Sizes of a bore: clearance and radius in mm."""

    @property
    def clearance(self) -> float: ...
    @property
    def socket_radius(self) -> float: ...


def initial_displacement(bore: BoreSize, modulus: float, depth: Numbers, force: Numbers, axes: Numbers) -> Numbers:
    """Estimate displacements (n, 3) in mm along the loads, from springs in a full sphere at the largest wear depth.

    Parameters
    ----------
    bore : object with a clearance and a socket_radius
        Radii in mm.
    modulus : float
        Foundation modulus in MPa/mm: that of the bore under uniform pressure.
    depth : array
        Depth of the worn bore below its sphere, in mm.
    force, axes : array (n,), array (n, 3)
        Magnitudes of the loads in N, and unit vectors along them.
    """
    clearance = max(bore.clearance, 0.0)
    indentation = linear_indentation(bore.socket_radius, clearance, modulus, force)
    start: Numbers = axes * (clearance + indentation + float(depth.max(initial=0.0)))[:, None]
    return start
