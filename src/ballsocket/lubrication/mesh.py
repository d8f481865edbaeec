"""Finite volumes of a lubricating film: cells, the faces between them, and the rim where the pressure is given."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..elasticity.finite_elements.mesh import graded_points
from ..elasticity.off_axis.directions import tangents as surface_tangents
from ..elasticity.off_axis.directions import unit_vectors

_NO_OFFSET = 1e-9  # angle in rad between two normals of a face that counts as none


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmMesh:
    """Cells of a film, faces between two cells, and faces at the rim of the film."""

    area: Numbers  # (cells,), areas of the cells in mm²
    direction: Numbers  # (cells, 3), unit vectors from the centre of the cup to the cells; zeros on a plane film
    first: Numbers  # (faces,), cell on the first side of each face
    second: Numbers  # (faces,), cell on its second side
    width: Numbers  # (faces,), lengths of the faces in mm
    first_distance: Numbers  # (faces,), distance in mm from the face to the centre of its first cell
    second_distance: Numbers  # (faces,), the same to its second cell
    # (faces, 3), rotation that drives a unit flow through the face: the velocity from first to second is R ω · axis
    axis: Numbers
    # (rim faces, ...), the same of the faces at the rim, whose outward side is the lubricant around the joint
    rim_cell: Numbers
    rim_width: Numbers
    rim_distance: Numbers
    rim_axis: Numbers
    radius: float = 1.0

    @property
    def cells(self) -> int:
        return len(self.area)

    def in_frame(self, frame: Numbers) -> FilmMesh:
        """Rotate the mesh: rows of `frame` (3, 3) are its x, y and z axes in the new coordinates."""
        names = ("direction", "axis", "rim_axis")
        return replace(self, **{name: getattr(self, name) @ frame for name in names})

    def within(self, mask: Numbers) -> FilmMesh:
        """Keep the cells of a mask (cells,); faces to the other cells become faces at the rim."""
        numbers = numpy.cumsum(mask) - 1
        first, second = mask[self.first], mask[self.second]
        inner, leaving, entering, rim = first & second, first & ~second, second & ~first, mask[self.rim_cell]
        return FilmMesh(
            area=self.area[mask],
            direction=self.direction[mask],
            first=numbers[self.first[inner]],
            second=numbers[self.second[inner]],
            width=self.width[inner],
            first_distance=self.first_distance[inner],
            second_distance=self.second_distance[inner],
            axis=self.axis[inner],
            rim_cell=numbers[numpy.concatenate([self.rim_cell[rim], self.first[leaving], self.second[entering]])],
            rim_width=numpy.concatenate([self.rim_width[rim], self.width[leaving], self.width[entering]]),
            rim_distance=numpy.concatenate(
                [self.rim_distance[rim], self.first_distance[leaving], self.second_distance[entering]]
            ),
            rim_axis=numpy.concatenate([self.rim_axis[rim], self.axis[leaving], -self.axis[entering]]),
            radius=self.radius,
        )

    @cached_property
    def _gradients(self) -> tuple[Numbers, tuple[Any, Any]]:
        """Tangents (cells, 2, 3), and sparse matrices (cells, cells) to least-squares slopes along both, per rad."""
        from scipy.sparse import csr_matrix, diags_array  # slow to import

        tangents = numpy.stack(surface_tangents(self.direction.T)).transpose(2, 0, 1)
        rows, columns = numpy.concatenate([self.first, self.second]), numpy.concatenate([self.second, self.first])
        steps = self.direction[columns] - self.direction[rows]
        local = numpy.einsum("ij,ikj->ik", steps, tangents[rows])
        weight = 1 / (local * local).sum(axis=1)
        moments = numpy.zeros((self.cells, 2, 2))
        numpy.add.at(moments, rows, weight[:, None, None] * local[:, :, None] * local[:, None, :])
        solved = numpy.einsum("ikl,il->ik", numpy.linalg.inv(moments)[rows], weight[:, None] * local)
        matrices = [csr_matrix((solved[:, axis], (rows, columns)), (self.cells, self.cells)) for axis in range(2)]
        first, second = (matrix - diags_array(numpy.asarray(matrix.sum(axis=1)).ravel()) for matrix in matrices)
        return tangents, (first.tocsr(), second.tocsr())

    @cached_property
    def face_slopes(self) -> Any:
        """Sparse matrix (2 faces, cells) from a field to twice its change from first to second centre of each face.

        The first rows have the gradient in the first cell, the others that in the second cell.
        """
        from scipy.sparse import diags_array, vstack  # slow to import

        tangents, gradients = self._gradients
        blocks = []
        for cells, others, sign in ((self.first, self.second, 2.0), (self.second, self.first, -2.0)):
            steps = numpy.einsum("ij,ikj->ik", self.direction[others] - self.direction[cells], tangents[cells])
            blocks.append(sum(diags_array(sign * steps[:, axis]) @ gradients[axis][cells] for axis in range(2)))
        return vstack(blocks, format="csr")

    def gradient(self, field: Numbers, cells: Numbers) -> Numbers:
        """Compute the gradient (n, 3) of a field (cells,) per mm in some of the cells."""
        tangents, (first, second) = self._gradients
        slopes: Numbers = (first @ field)[cells, None] * tangents[cells, 0]
        slopes += (second @ field)[cells, None] * tangents[cells, 1]
        return slopes / self.radius

    @cached_property
    def _offsets(self) -> Numbers:
        """Distances (faces,) in mm along each face between both normals through the centres of its cells.

        They are zero but between rings of different numbers of cells. The axis of a face is a tangent along it.
        """
        between = self.radius * (self.direction[self.second] - self.direction[self.first])
        along: Numbers = (between * self.axis).sum(axis=1)
        return numpy.where(numpy.abs(along) > _NO_OFFSET * self.radius, along, 0.0)

    def normal_rise(self, field: Numbers, faces: Numbers) -> Numbers:
        """Compute the rise of a field (cells,) along the normals of some faces, from first to second cell: (n,).

        Where the centres of both cells do not lie on a normal, the gradient along the face corrects the difference.
        """
        first, second = self.first[faces], self.second[faces]
        rise: Numbers = field[second] - field[first]
        skew = numpy.flatnonzero(self._offsets[faces])
        gradient = self.gradient(field, first[skew]) + self.gradient(field, second[skew])
        rise[skew] -= self._offsets[faces[skew]] * (gradient * self.axis[faces[skew]]).sum(axis=1) / 2
        return rise

    def face_velocity(self, spin: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the velocity of the ball's surface across the faces and the rim faces in mm/s; spin in rad/s."""
        return self.radius * (self.axis @ spin), self.radius * (self.rim_axis @ spin)


def polar_mesh(radius: float, ring_edges: Numbers, meridians: int | Numbers) -> FilmMesh:
    """Divide a sphere of a radius in mm about its z axis into rings and meridians.

    The polar angles (rings + 1,) of the lines between the rings are in rad, from 0 to the rim. `meridians` is the
    number of cells in each ring, or that of all.
    """
    rings = len(ring_edges) - 1
    counts = numpy.broadcast_to(meridians, rings).astype(int)
    require("meridians", counts.min(), bool((counts >= 4).all()), "at least 4 cells in a ring")
    starts = numpy.concatenate([[0], numpy.cumsum(counts)])
    theta = 0.5 * (ring_edges[1:] + ring_edges[:-1])
    ring = numpy.repeat(numpy.arange(rings), counts)
    column = numpy.arange(starts[-1]) - starts[ring]
    step = 2 * pi / counts
    phi, between = (column + 0.5) * step[ring], (column + 1) * step[ring]
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
            # Velocity of the surface is R ω × n, its part along a tangent t is R ω · (n × t), and here t = e_φ.
            numpy.cross(unit_vectors(theta[ring], between).T, _east(between)),
        ),
    ]
    first, second, width, first_distance, second_distance, axis = (
        numpy.concatenate(columns) for columns in zip(*rows, strict=True)
    )
    last = slice(starts[-2], starts[-1])
    return FilmMesh(
        area=(radius**2 * -numpy.diff(numpy.cos(ring_edges)) * step)[ring],
        direction=numpy.stack(list(unit_vectors(theta[ring], phi)), axis=-1),
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
    """Make the faces between two rings, one for each piece of the line between their cells."""
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


def graded_rings(
    edge: float, *, finest: float, coarsest: float, rim: float = pi / 2, growth: float = 1.12, last_edge: float = 0.0
) -> Numbers:
    """Make the angles between rings that are finest at the edge of the dry contact; all angles are in rad.

    One line between rings lies at `edge`, the half angle of the dry contact. Widths grow in the ratio `growth` from
    `finest` to `coarsest`, as far as `rim`. If the edge moves, rings are finest as far as `last_edge`.
    """
    require("edge", edge, 0 < edge < rim, "the contact ends between the pole and the rim")
    last = max(edge, last_edge)
    require("last_edge", last, last < rim, "the contact ends between the pole and the rim")
    inward = graded_points(edge, 0.0, finest, growth, coarsest)
    outward = graded_points(last, rim, finest, growth, coarsest)
    between = numpy.linspace(edge, last, max(ceil((last - edge) / finest), 1) + 1)[1:-1]
    ends = outward if last > edge else outward[1:]
    return numpy.concatenate([inward[::-1], between, ends])


def _east(phi: Numbers) -> Numbers:
    """Compute the unit tangents (..., 3) towards growing azimuth."""
    return numpy.stack([-numpy.sin(phi), numpy.cos(phi), numpy.zeros_like(phi)], axis=-1)
