"""Cells on the bore: rings about the cup's axis, cut by meridians.

The cup's frame: z points from the centre of the bore to its pole (the dome), θ counts from there, φ from x around z.
Fields are arrays (..., rings, meridians). A field that goes as cos mφ or sin mφ stays one under everything that is
symmetric about the axis, so that a compliance is one small matrix for each m.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, pi

import numpy
import scipy.fft

from ...core.arrays import Numbers
from ..finite_elements.mesh import join_points
from .directions import unit_vectors

_CUTS = numpy.array([0.5, 0.25, 0.25])
"""Widths of the parts that the last ring is cut into, as shares of it, towards the rim."""

_FINE_CUTS = numpy.array([0.5, 0.25, 0.125, 0.0625, 0.0625])
"""Finer widths for the distance from a contact to the rim: the rim of a soft liner bends in a short strip."""

_FEW = 24  # rings: to ask fewer first gains nothing


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """Cells of pressure, each of one value.

    Attributes
    ----------
    edges : array (rings + 1,)
        Polar angles between the rings in rad, from 0 to where the bore ends.
    meridians : int
        Even.
    """

    edges: Numbers
    meridians: int

    @property
    def rings(self) -> int:
        return len(self.edges) - 1

    @property
    def degrees(self) -> int:
        """The largest m."""
        return self.meridians // 2

    @property
    def reach(self) -> float:
        """Where the bore ends, in rad."""
        return float(self.edges[-1])

    @property
    def width(self) -> float:
        """Width of the widest ring, in rad."""
        return float(numpy.diff(self.edges).max())

    @cached_property
    def azimuth(self) -> Numbers:
        """φ in the middle of the cells (meridians,)."""
        return (numpy.arange(self.meridians) + 0.5) * (2 * pi / self.meridians)

    @cached_property
    def polar(self) -> Numbers:
        """θ in the middle of the rings (rings,)."""
        return (self.edges[1:] + self.edges[:-1]) / 2

    @cached_property
    def ring_areas(self) -> Numbers:
        """Areas of whole rings on a sphere of radius 1."""
        return 4 * pi * numpy.sin(self.polar) * numpy.sin(numpy.diff(self.edges) / 2)

    @cached_property
    def areas(self) -> Numbers:
        """Areas of cells on a sphere of radius 1: (rings, 1)."""
        return (self.ring_areas / self.meridians)[:, None]

    @cached_property
    def normals(self) -> Numbers:
        """The mean of the outward unit normal over each cell: (3, rings, meridians)."""
        low, high = self.edges[:-1], self.edges[1:]
        share = 2 * numpy.sin(self.polar) * numpy.sin((high - low) / 2)
        along = (numpy.sin(high) ** 2 - numpy.sin(low) ** 2) / 2 / share
        across = ((high - low) / 2 - numpy.cos(high + low) * numpy.sin(high - low) / 2) / share
        across = across * numpy.sinc(1 / self.meridians)
        x, y = (across[:, None] * turn(self.azimuth) for turn in (numpy.cos, numpy.sin))
        return numpy.stack([x, y, numpy.broadcast_to(along[:, None], x.shape)])

    @cached_property
    def middles(self) -> Numbers:
        """Unit vectors to the middles of the cells: (3, rings, meridians)."""
        return unit_vectors(self.polar[:, None], self.azimuth)

    @cached_property
    def centroids(self) -> Numbers:
        """Unit vectors to where fields have their means over the cells: (3, rings, meridians); nobody writes into them.

        At the pole, where cells are triangles, these are not the middles.
        """
        centroids = self.normals / numpy.linalg.norm(self.normals, axis=0)
        centroids.setflags(write=False)
        return centroids

    def averaged(self, rings: Numbers) -> Numbers:
        """From what rings do to rings, ∫ u dA for each m, to what cells do to cells: the mean u over each.

        The mean over the width of a cell takes its share of cos mφ, from the pressure and from what that does. Waves
        around the pole that are shorter than two rings give way as those that are as long: they mean nothing, and
        what is left of an iteration would make pressures of them.
        """
        share = numpy.sinc(numpy.arange(self.degrees + 1) / self.meridians) ** 2
        cells = rings * share[:, None, None] / self.ring_areas[:, None]
        each, own = numpy.arange(self.rings), numpy.einsum("mii->mi", cells)
        two_rings = numpy.ceil(pi * numpy.sin(self.polar) / self.width).clip(2, self.degrees).astype(int)
        shorter = numpy.arange(self.degrees + 1)[:, None] > two_rings
        cells[:, each, each] += numpy.where(shorter, numpy.maximum(own[two_rings, each] - own, 0.0), 0.0)
        return cells

    @cached_property
    def coarser(self) -> Grid | None:
        """Two rings and two meridians to a cell, the last ring alone where it is odd; None where few are left."""
        if self.meridians % 4 or self.rings < _FEW:
            return None
        return Grid(edges=numpy.unique(numpy.append(self.edges[::2], self.edges[-1])), meridians=self.meridians // 2)

    def gathered(self, fields: Numbers) -> Numbers:
        """The means of fields (..., rings, meridians) over the coarser cells."""
        pairs = fields.reshape(*fields.shape[:-1], -1, 2).mean(axis=-1) * self.ring_areas[:, None]
        starts = numpy.arange(0, self.rings, 2)
        means: Numbers = numpy.add.reduceat(pairs, starts, axis=-2)
        return means / numpy.add.reduceat(self.ring_areas, starts)[:, None]

    def spread(self, fields: Numbers) -> Numbers:
        """Fields (..., rings, meridians) of the coarser cells in these."""
        return numpy.repeat(numpy.repeat(fields, 2, axis=-2)[..., : self.rings, :], 2, axis=-1)

    def gathered_matrices(self, matrices: Numbers) -> Numbers:
        """Means over coarser cells under pressures on such, for each m, from what cells do to cells."""
        starts = numpy.arange(0, self.rings, 2)
        m = numpy.arange(self.meridians // 4 + 1)
        rows = numpy.add.reduceat(matrices[: len(m)] * self.ring_areas[:, None], starts, axis=1)
        both = numpy.add.reduceat(rows, starts, axis=2) / numpy.add.reduceat(self.ring_areas, starts)[:, None]
        share = numpy.sinc(2 * m / self.meridians) / numpy.sinc(m / self.meridians)
        return both * (share**2)[:, None, None]

    def total(self, one: Numbers, other: Numbers) -> Numbers:
        """∫ one · other over a sphere of radius 1, of fields (..., rings, meridians)."""
        rings: Numbers = numpy.vecdot(one, other)
        return rings @ self.areas[:, 0].astype(rings.dtype)


def grid(reach: float, width: float) -> Grid:
    """Cut the bore into rings of about this width, the last one in three parts; cells are square at 90°."""
    return _cut_grid(reach, width, _CUTS)


def rim_grid(reach: float, width: float) -> Grid:
    """Cut the bore into rings of about this width, the last one in five parts; cells are square at 90°."""
    return _cut_grid(reach, width, _FINE_CUTS)


def _cut_grid(reach: float, width: float, cuts: Numbers) -> Grid:
    rings = max(ceil(reach / width - 1e-9), 2)
    edges = numpy.linspace(0.0, reach, rings + 1)
    last = edges[-2] + numpy.append(0.0, numpy.cumsum(cuts)) * (reach - edges[-2])
    last[-1] = reach
    return Grid(edges=join_points([edges[:-1], last]), meridians=_meridians(width))


def even_grid(reach: float, width: float) -> Grid:
    """Rings of one width up to where the bore ends, cells as wide as long at 90°: none is stiffer than it need be."""
    rings = max(ceil(reach / width - 1e-9), 4)
    return Grid(edges=numpy.linspace(0.0, reach, rings + 1), meridians=_meridians(width))


def _meridians(width: float) -> int:
    return 2 * max(round(pi / width), 4)


@dataclass(frozen=True, kw_only=True, eq=False)
class Turning:
    """What does the same to a field however it is turned about the axis: a matrix (rings, rings) for each m.

    Attributes
    ----------
    matrices : array (degrees + 1, rings, rings)
        In single precision where that is enough; it is twice as fast.
    """

    matrices: Numbers

    def __call__(self, fields: Numbers) -> Numbers:
        """What becomes of fields (batch, rings, meridians), in the precision of the matrices."""
        batch, rings, meridians = fields.shape
        waves = scipy.fft.rfft(fields.astype(self.matrices.dtype, copy=False))
        columns = numpy.ascontiguousarray(waves.transpose(2, 1, 0))
        moved = self.matrices @ columns.view(self.matrices.dtype)
        back = moved.reshape(len(self.matrices), rings, 2 * batch).view(waves.dtype).transpose(2, 1, 0)
        return scipy.fft.irfft(back, n=meridians)

    def rough(self) -> Turning:
        """These matrices in single precision."""
        return Turning(matrices=self.matrices.astype(numpy.float32))


@dataclass(frozen=True, kw_only=True, eq=False)
class Local:
    """What does the same to every cell, whatever the others do: a number for all of them."""

    scale: float

    def __call__(self, fields: Numbers) -> Numbers:
        """What becomes of fields (batch, rings, meridians)."""
        return fields * self.scale

    def rough(self) -> Local:
        """Itself: it costs nothing."""
        return self
