"""Pressure cells on the bore: rings about the cup's axis, divided by meridians.

The cup's frame has its origin at the centre of the bore, and z points to the pole of the dome. The polar angle θ starts
at z; the azimuth φ starts at x and turns about z. Fields are arrays (..., rings, meridians). A field that varies as
cos mφ or sin mφ keeps that form under any axisymmetric operator. A compliance is thus one small matrix per harmonic m.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, pi
from typing import Any

import numpy

from ...core.arrays import Numbers
from ..finite_elements.mesh import join_points
from .directions import unit_vectors

_RIM_WIDTHS = numpy.array([0.5, 0.25, 0.25])
"""Widths of the parts of the last ring towards the rim, as fractions of the ring."""

_FINE_RIM_WIDTHS = numpy.array([0.5, 0.25, 0.125, 0.0625, 0.0625])
"""Finer widths, for the distance from a contact to the rim: the rim of a soft liner bends in a narrow strip."""

_MIN_RINGS_TO_COARSEN = 24  # a coarser start saves no time on fewer rings


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """Cells of constant pressure on the bore, in rings and meridians."""

    edges: Numbers  # (rings + 1,), polar angles in rad of the lines between rings, from 0 to the end of the bore
    meridians: int  # number of cells in a ring, even

    @property
    def rings(self) -> int:
        """Number of rings."""
        return len(self.edges) - 1

    @property
    def max_harmonic(self) -> int:
        """Largest harmonic number m about the axis."""
        return self.meridians // 2

    @property
    def reach(self) -> float:
        """Polar angle of the end of the bore in rad."""
        return float(self.edges[-1])

    @property
    def width(self) -> float:
        """Width of the widest ring in rad."""
        return float(numpy.diff(self.edges).max())

    @cached_property
    def azimuth(self) -> Numbers:
        """Azimuths φ of the cell middles in rad: (meridians,)."""
        return (numpy.arange(self.meridians) + 0.5) * (2 * pi / self.meridians)

    @cached_property
    def polar(self) -> Numbers:
        """Polar angles θ of the ring middles in rad: (rings,)."""
        return (self.edges[1:] + self.edges[:-1]) / 2

    @cached_property
    def ring_areas(self) -> Numbers:
        """Areas of the rings on a unit sphere: (rings,)."""
        return 4 * pi * numpy.sin(self.polar) * numpy.sin(numpy.diff(self.edges) / 2)

    @cached_property
    def areas(self) -> Numbers:
        """Areas of the cells on a unit sphere: (rings, 1)."""
        return (self.ring_areas / self.meridians)[:, None]

    @cached_property
    def normals(self) -> Numbers:
        """Mean outward unit normals of the cells: (3, rings, meridians)."""
        low, high = self.edges[:-1], self.edges[1:]
        area = 2 * numpy.sin(self.polar) * numpy.sin((high - low) / 2)
        axial = (numpy.sin(high) ** 2 - numpy.sin(low) ** 2) / 2 / area
        radial = ((high - low) / 2 - numpy.cos(high + low) * numpy.sin(high - low) / 2) / area
        radial = radial * numpy.sinc(1 / self.meridians)
        x, y = (radial[:, None] * function(self.azimuth) for function in (numpy.cos, numpy.sin))
        return numpy.stack([x, y, numpy.broadcast_to(axial[:, None], x.shape)])

    @cached_property
    def middles(self) -> Numbers:
        """Unit vectors to the middles of the cells: (3, rings, meridians)."""
        return unit_vectors(self.polar[:, None], self.azimuth)

    @cached_property
    def centroids(self) -> Numbers:
        """Unit vectors to the centroids of the cells, where linear fields equal their means: (3, rings, meridians).

        They differ from the middles at the pole, where cells are triangles. The array is read-only.
        """
        centroids = self.normals / numpy.linalg.norm(self.normals, axis=0)
        centroids.setflags(write=False)
        return centroids

    def average_over_cells(self, ring_matrices: Numbers) -> Numbers:
        """Convert compliance matrices between rings (∫ u dA for each m) to matrices between cells (mean u).

        The mean over the width of a cell attenuates cos mφ twice: in the pressure and in the displacement. Waves around
        the pole that are shorter than two rings get the compliance of waves of two rings. The grid does not resolve
        them, and without this limit the residual of the iteration would appear as pressure.
        """
        cells = self._attenuate(ring_matrices)
        return self._fill_unresolved(cells, self._missing_compliance(cells) > 0)

    def average_slopes(self, ring_matrices: Numbers, slopes: Numbers) -> Numbers:
        """Convert derivatives (n, m, rings, rings) of compliance matrices between rings to those between cells."""
        filled = self._missing_compliance(self._attenuate(ring_matrices)) > 0
        return numpy.stack([self._fill_unresolved(self._attenuate(slope), filled) for slope in slopes])

    def _attenuate(self, ring_matrices: Numbers) -> Numbers:
        """Convert matrices between rings to means over the widths of cells."""
        attenuation = numpy.sinc(numpy.arange(self.max_harmonic + 1) / self.meridians) ** 2
        return ring_matrices * attenuation[:, None, None] / self.ring_areas[:, None]

    def _missing_compliance(self, cells: Numbers) -> Numbers:
        """Compute the compliance (m, rings) that cells lack from that of waves of two rings; 0 of longer waves."""
        diagonal, harmonic = numpy.einsum("mii->mi", cells), numpy.arange(self.max_harmonic + 1)[:, None]
        two_rings = numpy.ceil(pi * numpy.sin(self.polar) / self.width).clip(2, self.max_harmonic).astype(int)
        missing = diagonal[two_rings, numpy.arange(self.rings)] - diagonal
        return numpy.where(harmonic > two_rings, missing, 0.0)

    def _fill_unresolved(self, cells: Numbers, filled: Numbers) -> Numbers:
        """Add the compliance that cells lack, in the harmonics and rings of a mask (m, rings)."""
        ring = numpy.arange(self.rings)
        cells[:, ring, ring] += numpy.where(filled, self._missing_compliance(cells), 0.0)
        return cells

    @cached_property
    def coarser_grid(self) -> Grid | None:
        """Grid of cells twice as wide, an odd last ring alone; None if this grid has few rings."""
        if self.meridians % 4 or self.rings < _MIN_RINGS_TO_COARSEN:
            return None
        return Grid(edges=numpy.unique(numpy.append(self.edges[::2], self.edges[-1])), meridians=self.meridians // 2)

    def coarsen(self, fields: Numbers) -> Numbers:
        """Compute the means of fields (..., rings, meridians) over the cells of the coarser grid."""
        pairs = fields.reshape(*fields.shape[:-1], -1, 2).mean(axis=-1) * self.ring_areas[:, None]
        starts = numpy.arange(0, self.rings, 2)
        means: Numbers = numpy.add.reduceat(pairs, starts, axis=-2)
        return means / numpy.add.reduceat(self.ring_areas, starts)[:, None]

    def refine(self, fields: Numbers) -> Numbers:
        """Transfer fields from the coarser grid to the cells of this grid: (..., rings, meridians)."""
        return numpy.repeat(numpy.repeat(fields, 2, axis=-2)[..., : self.rings, :], 2, axis=-1)

    def coarsen_matrices(self, matrices: Numbers) -> Numbers:
        """Convert compliance matrices between cells, one for each m, to matrices between cells of the coarser grid."""
        starts = numpy.arange(0, self.rings, 2)
        m = numpy.arange(self.meridians // 4 + 1)
        rows = numpy.add.reduceat(matrices[: len(m)] * self.ring_areas[:, None], starts, axis=1)
        sums = numpy.add.reduceat(rows, starts, axis=2) / numpy.add.reduceat(self.ring_areas, starts)[:, None]
        attenuation = numpy.sinc(2 * m / self.meridians) / numpy.sinc(m / self.meridians)
        return sums * (attenuation**2)[:, None, None]

    def points(self, ring_share: float, column_share: float) -> Numbers:
        """Compute unit vectors (cells, 3) to the points at these fractions of the widths of all cells."""
        polar = (self.edges[:-1] + ring_share * numpy.diff(self.edges))[:, None]
        azimuth = (numpy.arange(self.meridians) + column_share) * (2 * pi / self.meridians)
        return unit_vectors(polar, azimuth).reshape(3, -1).T

    def surrounding_cells(self, directions: Numbers) -> tuple[Numbers, Numbers]:
        """Find the four cells around unit vectors (3, ...) in the frame of the grid, and their weights: both (4, ...).

        Fields are bilinear in polar angle and azimuth between the middles of the cells, and pass the pole in a straight
        line. They are constant between the last middle and the end of the grid, and 0 beyond.
        """
        x, y, z = directions
        polar, column = numpy.arctan2(numpy.hypot(x, y), z), numpy.arctan2(y, x) * (self.meridians / (2 * pi)) - 0.5
        nodes = numpy.concatenate([[-self.polar[0]], self.polar])  # the first ring on the other side of the pole
        lower = numpy.clip(numpy.searchsorted(nodes, polar) - 1, 0, len(nodes) - 2)
        ring_share = numpy.clip((polar - nodes[lower]) / (nodes[lower + 1] - nodes[lower]), 0.0, 1.0)
        left = numpy.floor(column).astype(int)
        column_share = column - left
        cells, weights = [], []
        for ring, by_ring in ((lower - 1, 1 - ring_share), (lower, ring_share)):
            beyond = numpy.where(ring < 0, self.meridians // 2, 0)
            for step, by_column in ((0, 1 - column_share), (1, column_share)):
                cells.append(numpy.maximum(ring, 0) * self.meridians + (left + step + beyond) % self.meridians)
                weights.append(numpy.where(polar <= self.reach, by_ring * by_column, 0.0))
        return numpy.stack(cells), numpy.stack(weights)

    def interpolation_matrix(self, directions: Numbers) -> Any:
        """Make the sparse matrix (directions, cells) that interpolates at unit vectors (directions, 3)."""
        from scipy.sparse import csr_matrix  # slow to import

        cells, weights = self.surrounding_cells(directions.T)
        rows = numpy.tile(numpy.arange(len(directions)), len(cells))
        return csr_matrix((weights.ravel(), (rows, cells.ravel())), (len(directions), self.rings * self.meridians))

    def integrate_product(self, first: Numbers, second: Numbers) -> Numbers:
        """Integrate the product of two fields (..., rings, meridians) over a unit sphere."""
        ring_sums: Numbers = numpy.vecdot(first, second)
        cell_areas = self.areas[:, 0]  # equal around a ring
        return ring_sums @ cell_areas.astype(ring_sums.dtype)


def rim_grid(reach: float, width: float) -> Grid:
    """Make a grid up to the polar angle `reach`, with the last ring divided in five parts towards the rim."""
    return graded_grid(reach, width, _FINE_RIM_WIDTHS)


def graded_grid(reach: float, width: float, fractions: Numbers = _RIM_WIDTHS) -> Grid:
    """Make a grid up to the polar angle `reach`, with the last ring divided into fractions, three by default.

    Rings are about `width` (rad) wide, and cells are square at a polar angle of 90°.
    """
    rings = max(ceil(reach / width - 1e-9), 2)
    edges = numpy.linspace(0.0, reach, rings + 1)
    last = edges[-2] + numpy.append(0.0, numpy.cumsum(fractions)) * (reach - edges[-2])
    last[-1] = reach
    return Grid(edges=join_points([edges[:-1], last]), meridians=_meridian_count(width))


def even_grid(reach: float, width: float) -> Grid:
    """Make a grid of equal rings up to the polar angle `reach`, of about `width` (rad).

    Cells are square at a polar angle of 90°. Without a narrow ring no cell is stiffer than necessary.
    """
    rings = max(ceil(reach / width - 1e-9), 4)
    return Grid(edges=numpy.linspace(0.0, reach, rings + 1), meridians=_meridian_count(width))


def _meridian_count(width: float) -> int:
    """Choose the even number of cells in a ring, at least 8, for cells of about this width (rad)."""
    return 2 * max(round(pi / width), 4)
