"""Finite volumes of a lubricating film: cells, the faces between them, and the rim where the pressure is given."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

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
    left, right : array of int (faces,)
        Cells on both sides of each face.
    width : array (faces,)
        Lengths of the faces in mm.
    left_distance, right_distance : array (faces,)
        Distances from the face to the centres of its two cells in mm.
    axis : array (faces, 3)
        Rotation that drives a unit flow through the face: the velocity from left to right is R ω · axis.
    rim_cell, rim_width, rim_distance, rim_axis : arrays (rim faces, ...)
        The same of the faces at the rim, whose outward side is the lubricant around the joint.
    """

    area: Numbers
    direction: Numbers
    left: Numbers
    right: Numbers
    width: Numbers
    left_distance: Numbers
    right_distance: Numbers
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

    def face_velocity(self, spin: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the velocity of the ball's surface across the faces and the rim faces in mm/s; spin in rad/s."""
        return self.radius * (self.axis @ spin), self.radius * (self.rim_axis @ spin)


def polar_mesh(radius: float, ring_edges: Numbers, meridians: int) -> FilmMesh:
    """Divide a sphere about its z axis into rings and meridians.

    Parameters
    ----------
    radius : float
        Radius of the sphere in mm.
    ring_edges : array (rings + 1,)
        Polar angles of the lines between the rings in rad, from 0 to the rim.
    meridians : int
        Number of cells in a ring.
    """
    require("meridians", meridians, meridians >= 4, "at least 4 cells in a ring")
    rings = len(ring_edges) - 1
    step = 2 * pi / meridians
    theta = 0.5 * (ring_edges[1:] + ring_edges[:-1])
    phi = (numpy.arange(meridians) + 0.5) * step
    cell = numpy.arange(rings * meridians).reshape(rings, meridians)
    inner = ring_edges[1:-1]
    ring_shape = (rings - 1, meridians)
    # Velocity of the surface is R ω × n, so its part along a unit tangent t is R ω · (n × t): n × e_θ = e_φ, n × e_φ = -e_θ.
    east = numpy.stack([-numpy.sin(phi), numpy.cos(phi), numpy.zeros(meridians)], axis=-1)
    border_phi = numpy.arange(1, meridians + 1) * step
    south = _meridian_tangents(theta[:, None], border_phi[None, :])
    return FilmMesh(
        area=numpy.repeat(radius**2 * -numpy.diff(numpy.cos(ring_edges)) * step, meridians),
        direction=_directions(theta[:, None], phi[None, :]).reshape(-1, 3),
        left=numpy.concatenate([cell[:-1].ravel(), cell.ravel()]),
        right=numpy.concatenate([cell[1:].ravel(), numpy.roll(cell, -1, axis=1).ravel()]),
        width=numpy.concatenate(
            [
                numpy.repeat(radius * numpy.sin(inner) * step, meridians),
                numpy.repeat(radius * numpy.diff(ring_edges), meridians),
            ]
        ),
        left_distance=numpy.concatenate(
            [
                numpy.repeat(radius * (inner - theta[:-1]), meridians),
                numpy.repeat(radius * numpy.sin(theta) * step / 2, meridians),
            ]
        ),
        right_distance=numpy.concatenate(
            [
                numpy.repeat(radius * (theta[1:] - inner), meridians),
                numpy.repeat(radius * numpy.sin(theta) * step / 2, meridians),
            ]
        ),
        axis=numpy.concatenate([numpy.broadcast_to(east, (*ring_shape, 3)).reshape(-1, 3), -south.reshape(-1, 3)]),
        rim_cell=cell[-1],
        rim_width=numpy.full(meridians, radius * numpy.sin(ring_edges[-1]) * step),
        rim_distance=numpy.full(meridians, radius * (ring_edges[-1] - theta[-1])),
        rim_axis=east,
        radius=radius,
    )


def strip_mesh(edges: Numbers) -> FilmMesh:
    """Divide a strip of unit width along x into cells between `edges` (mm); `spin` is then the sliding velocity."""
    centre = 0.5 * (edges[1:] + edges[:-1])
    cells = len(centre)
    inner = numpy.arange(cells - 1)
    along = numpy.array([1.0, 0.0, 0.0])
    return FilmMesh(
        area=numpy.diff(edges),
        direction=numpy.zeros((cells, 3)),
        left=inner,
        right=inner + 1,
        width=numpy.ones(cells - 1),
        left_distance=edges[1:-1] - centre[:-1],
        right_distance=centre[1:] - edges[1:-1],
        axis=numpy.tile(along, (cells - 1, 1)),
        rim_cell=numpy.array([0, cells - 1]),
        rim_width=numpy.ones(2),
        rim_distance=numpy.array([centre[0] - edges[0], edges[-1] - centre[-1]]),
        rim_axis=numpy.stack([-along, along]),
    )


def graded_rings(
    edge: float, *, finest: float, coarsest: float, rim: float = pi / 2, growth: float = 1.12
) -> Numbers:
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


def _directions(theta: Numbers, phi: Numbers) -> Numbers:
    """Compute unit vectors (..., 3) at polar and azimuth angles in rad."""
    return numpy.stack(
        numpy.broadcast_arrays(
            numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)
        ),
        axis=-1,
    )


def _meridian_tangents(theta: Numbers, phi: Numbers) -> Numbers:
    """Compute the unit tangents (..., 3) towards growing polar angle."""
    return numpy.stack(
        numpy.broadcast_arrays(
            numpy.cos(theta) * numpy.cos(phi), numpy.cos(theta) * numpy.sin(phi), -numpy.sin(theta)
        ),
        axis=-1,
    )
