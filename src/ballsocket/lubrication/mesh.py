"""Finite volumes of a lubricating film: cells, the faces between them, and the rim where the pressure is given."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmMesh:
    """Cells of a film, faces between two cells, and faces at the rim of the film.

    Attributes
    ----------
    area : array (cells,)
        Areas of the cells in mm².
    direction : array (cells, 3)
        Unit vectors from the centre of the cup to the cells; zeros on a plane film.
    first, second : array of int (faces,)
        Cells on both sides of each face.
    width : array (faces,)
        Lengths of the faces in mm.
    first_distance, second_distance : array (faces,)
        Distances from the face to the centres of its two cells in mm.
    axis : array (faces, 3)
        Rotation that drives a unit flow through the face: the velocity from first to second is R ω · axis.
    rim_cell, rim_width, rim_distance, rim_axis : arrays (rim faces, ...)
        The same of the faces at the rim, whose outward side is the lubricant around the joint.
    """

    area: Numbers
    direction: Numbers
    first: Numbers
    second: Numbers
    width: Numbers
    first_distance: Numbers
    second_distance: Numbers
    axis: Numbers
    rim_cell: Numbers
    rim_width: Numbers
    rim_distance: Numbers
    rim_axis: Numbers
    radius: float = 1.0

    @property
    def cells(self) -> int:
        """Number of cells."""
        return len(self.area)

    def in_frame(self, frame: Numbers) -> FilmMesh:
        """Rotate the mesh: rows of `frame` (3, 3) are its x, y and z axes in the new coordinates."""
        names = ("direction", "axis", "rim_axis")
        return replace(self, **{name: getattr(self, name) @ frame for name in names})

    @cached_property
    def face_slopes(self) -> tuple[Any, Any]:
        """Sparse matrices (faces, cells) from a field to its change from one centre of a face to the other one.

        The first matrix has the gradient in the first cell, the second that in the second cell, by least squares over
        the neighbours.
        """
        from scipy.sparse import csr_matrix, diags_array  # slow to import

        tangents = _tangent_bases(self.direction)
        rows, columns = numpy.concatenate([self.first, self.second]), numpy.concatenate([self.second, self.first])
        steps = self.direction[columns] - self.direction[rows]
        local = numpy.einsum("ij,ikj->ik", steps, tangents[rows])
        weight = 1 / (local * local).sum(axis=1)
        moments = numpy.zeros((self.cells, 2, 2))
        numpy.add.at(moments, rows, weight[:, None, None] * local[:, :, None] * local[:, None, :])
        solved = numpy.einsum("ikl,il->ik", numpy.linalg.inv(moments)[rows], weight[:, None] * local)
        matrices = []
        for cells, others in ((self.first, self.second), (self.second, self.first)):
            step = numpy.einsum("ij,ikj->ik", self.direction[others] - self.direction[cells], tangents[cells])
            slope: Any = 0
            for axis in range(2):
                gradient = csr_matrix((solved[:, axis], (rows, columns)), (self.cells, self.cells))
                gradient = gradient - diags_array(numpy.asarray(gradient.sum(axis=1)).ravel())
                slope = slope + diags_array(step[:, axis]) @ gradient[cells]
            matrices.append(slope.tocsr())
        return matrices[0], matrices[1]

    def face_velocity(self, spin: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the velocity of the ball's surface across the faces and the rim faces in mm/s; spin in rad/s."""
        return self.radius * (self.axis @ spin), self.radius * (self.rim_axis @ spin)


def polar_mesh(radius: float, ring_edges: Numbers, meridians: int | Numbers) -> FilmMesh:
    """Divide a sphere about its z axis into rings and meridians.

    Parameters
    ----------
    radius : float
        Radius of the sphere in mm.
    ring_edges : array (rings + 1,)
        Polar angles of the lines between the rings in rad, from 0 to the rim.
    meridians : int or array of int (rings,)
        Number of cells in each ring.
    """
    rings = len(ring_edges) - 1
    counts = numpy.broadcast_to(meridians, rings).astype(int)
    require("meridians", counts.min(), bool((counts >= 4).all()), "at least 4 cells in a ring")
    starts = numpy.concatenate([[0], numpy.cumsum(counts)])
    theta = 0.5 * (ring_edges[1:] + ring_edges[:-1])
    ring = numpy.repeat(numpy.arange(rings), counts)
    column = numpy.arange(starts[-1]) - starts[ring]
    step = 2 * pi / counts
    phi = (column + 0.5) * step[ring]
    across = [_ring_faces(radius, ring_edges, theta, starts, counts, index) for index in range(rings - 1)]
    half_width = radius * numpy.sin(theta[ring]) * step[ring] / 2
    rows = [
        *across,
        (
            numpy.arange(starts[-1]),
            starts[ring] + (column + 1) % counts[ring],
            radius * numpy.diff(ring_edges)[ring],
            half_width,
            half_width,
            # Velocity of the surface is R ω × n, its part along a tangent t is R ω · (n × t), and n × e_φ = -e_θ.
            -_meridian_tangents(theta[ring], (column + 1) * step[ring]),
        ),
    ]
    first, second, width, first_distance, second_distance, axis = (
        numpy.concatenate(columns) for columns in zip(*rows, strict=True)
    )
    last = slice(starts[-2], starts[-1])
    return FilmMesh(
        area=(radius**2 * -numpy.diff(numpy.cos(ring_edges)) * step)[ring],
        direction=_directions(theta[ring], phi),
        first=first,
        second=second,
        width=width,
        first_distance=first_distance,
        second_distance=second_distance,
        axis=axis,
        rim_cell=numpy.arange(starts[-2], starts[-1]),
        rim_width=numpy.full(counts[-1], radius * numpy.sin(ring_edges[-1]) * step[-1]),
        rim_distance=numpy.full(counts[-1], radius * (ring_edges[-1] - theta[-1])),
        rim_axis=_east(phi[last]),
        radius=radius,
    )


def _ring_faces(
    radius: float, ring_edges: Numbers, theta: Numbers, starts: Numbers, counts: Numbers, inner: int
) -> tuple[Numbers, ...]:
    """Make the faces between a ring and the next one: both cells, width, both distances, axis.

    Rings of different numbers of cells share one face for each piece of the line between them.
    """
    outer = inner + 1
    if counts[inner] == counts[outer]:
        marks = numpy.arange(counts[inner] + 1) / counts[inner]
    else:
        marks = numpy.unique(
            numpy.concatenate([numpy.arange(count + 1) / count for count in counts[[inner, outer]]]).round(12)
        )
    middle = 0.5 * (marks[1:] + marks[:-1])
    pieces = len(middle)
    return (
        starts[inner] + (middle * counts[inner]).astype(int),
        starts[outer] + (middle * counts[outer]).astype(int),
        radius * numpy.sin(ring_edges[outer]) * 2 * pi * numpy.diff(marks),
        numpy.full(pieces, radius * (ring_edges[outer] - theta[inner])),
        numpy.full(pieces, radius * (theta[outer] - ring_edges[outer])),
        _east(2 * pi * middle),  # n × e_θ = e_φ
    )


def thinned_meridians(ring_edges: Numbers, meridians: int) -> Numbers:
    """Choose the number of cells of each ring, a divisor of `meridians`, so that cells near the pole are not narrow."""
    divisors = numpy.array([count for count in range(6, meridians + 1) if meridians % count == 0])
    middle = 0.5 * (ring_edges[1:] + ring_edges[:-1])
    wanted = meridians * numpy.sin(numpy.minimum(middle, pi / 2))
    return divisors[numpy.searchsorted(divisors, wanted - 1e-9).clip(0, len(divisors) - 1)]


def strip_mesh(edges: Numbers) -> FilmMesh:
    """Divide a strip of unit width along x into cells between `edges` (mm); `spin` is then the sliding velocity."""
    centre = 0.5 * (edges[1:] + edges[:-1])
    cells = len(centre)
    inner = numpy.arange(cells - 1)
    along = numpy.array([1.0, 0.0, 0.0])
    return FilmMesh(
        area=numpy.diff(edges),
        direction=numpy.zeros((cells, 3)),
        first=inner,
        second=inner + 1,
        width=numpy.ones(cells - 1),
        first_distance=edges[1:-1] - centre[:-1],
        second_distance=centre[1:] - edges[1:-1],
        axis=numpy.tile(along, (cells - 1, 1)),
        rim_cell=numpy.array([0, cells - 1]),
        rim_width=numpy.ones(2),
        rim_distance=numpy.array([centre[0] - edges[0], edges[-1] - centre[-1]]),
        rim_axis=numpy.stack([-along, along]),
    )


def graded_rings(edge: float, *, finest: float, coarsest: float, rim: float = pi / 2, growth: float = 1.12) -> Numbers:
    """Make the angles between rings that are finest at the edge of the dry contact.

    Parameters
    ----------
    edge : float
        Half angle of the dry contact in rad; one line between rings lies there.
    finest, coarsest : float
        Width of the rings at the edge, and the largest width, in rad.
    rim : float
        Polar angle of the rim in rad.
    growth : float
        Ratio of the widths of neighbouring rings.
    """
    require("edge", edge, 0 < edge < rim, "the contact ends between the pole and the rim")
    inward = edge - _graded_line(edge, finest, coarsest, growth)
    outward = edge + _graded_line(rim - edge, finest, coarsest, growth)
    return numpy.concatenate([inward[::-1], outward[1:]])


def _graded_line(length: float, finest: float, coarsest: float, growth: float) -> Numbers:
    """Divide a length into steps that grow from `finest` at 0 to `coarsest`."""
    steps = [finest]
    while sum(steps) < length:
        steps.append(min(steps[-1] * growth, coarsest))
    points = numpy.concatenate([[0.0], numpy.cumsum(steps)])
    return points * (length / points[-1])


def _tangent_bases(directions: Numbers) -> Numbers:
    """Make two orthogonal unit tangents at each direction: (cells, 2, 3)."""
    helper = numpy.where(numpy.abs(directions[:, [2]]) < 0.8, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    second = numpy.cross(directions, helper)
    second = second / numpy.linalg.norm(second, axis=1)[:, None]
    return numpy.stack([numpy.cross(second, directions), second], axis=1)


def _east(phi: Numbers) -> Numbers:
    """Compute the unit tangents (..., 3) towards growing azimuth."""
    return numpy.stack([-numpy.sin(phi), numpy.cos(phi), numpy.zeros_like(phi)], axis=-1)


def _directions(theta: Numbers, phi: Numbers) -> Numbers:
    """Compute unit vectors (..., 3) at polar and azimuth angles in rad."""
    return numpy.stack(
        numpy.broadcast_arrays(numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)),
        axis=-1,
    )


def _meridian_tangents(theta: Numbers, phi: Numbers) -> Numbers:
    """Compute the unit tangents (..., 3) towards growing polar angle."""
    return numpy.stack(
        numpy.broadcast_arrays(numpy.cos(theta) * numpy.cos(phi), numpy.cos(theta) * numpy.sin(phi), -numpy.sin(theta)),
        axis=-1,
    )
