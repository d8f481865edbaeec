"""How the ball's own cells pass over those of the socket, and what that wears of the ball."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from .kinematics import SurfaceSliding
from .laws import Pass
from .set_up import SetUp
from .spots import Spots, ball_directions, ball_grid, spots_of


@dataclass(frozen=True, kw_only=True, eq=False)
class Facing:
    """Cells of the ball that pass over cells of the socket.

    Attributes
    ----------
    cells : array (m,)
        Of the ball's grid.
    sliding : SurfaceSliding
        Of the socket over them, in the ball's own frame.
    areas : array (m,)
        In mm².
    socket_areas : array (n,)
    socket_cells : array (n,)
        The cells that they pass over.
    whole : int
        Cells of the socket in all.
    ball_whole : int
    on_socket, on_ball : Spots
        The cells of the ball at those of the socket in each instant, and the other way round.
    """

    cells: Numbers
    sliding: SurfaceSliding
    areas: Numbers
    socket_areas: Numbers
    socket_cells: Numbers
    whole: int
    ball_whole: int
    on_socket: Spots
    on_ball: Spots

    def gap(self, depth: Numbers) -> Numbers:
        """What is worn of the ball (m,) where it faces each cell of the socket: (instants, n)."""
        field = numpy.zeros((1, self.ball_whole))
        field[0, self.cells] = depth
        return self.on_socket.of(field)

    def passed(self, done: Pass) -> Pass:
        """What the points of the ball go through, with the work of each instant as the socket has it."""
        pressure = self._on_ball(done.pressure)
        given = (done.pressure * done.sliding.distances) @ self.socket_areas
        found = (pressure * self.sliding.distances) @ self.areas
        share = numpy.divide(given, found, out=numpy.zeros_like(given), where=found > 0)
        return Pass(
            pressure=pressure * share[:, None], sliding=self.sliding, shares=lambda: self._on_ball(done.contact)
        )

    def _on_ball(self, values: Numbers) -> Numbers:
        """Interpolate values of the socket's cells (instants, n) at those of the ball: (instants, m)."""
        field = numpy.zeros((len(values), self.whole))
        field[:, self.socket_cells] = values
        return self.on_ball.of(field)


def facing(use: SetUp, cells: Numbers) -> Facing:
    """The ball's cells that pass over some cells of the socket in a cycle."""
    frame = numpy.array(use.placed.frame)
    turned = frame @ use.moved.midpoint_rotations[use.loaded]
    own = ball_grid(use.ring_width)
    directions = ball_directions(own)
    over = spots_of(use.grid, numpy.einsum("tij,jp->itp", turned, directions))
    mine = numpy.zeros(len(use.bed.areas))
    mine[cells] = 1.0
    met = numpy.flatnonzero((over.of(mine[None]) > 0).any(axis=0))
    back = numpy.einsum("tji,jp->itp", turned, use.bed.directions[:, cells])
    radius = float(use.joint.ball_radius)
    return Facing(
        cells=met,
        sliding=SurfaceSliding(
            radius=radius,
            rotation_increments=numpy.einsum("tji,tj->ti", turned, use.rotation_increments),
            directions=directions[:, met],
        ),
        areas=numpy.repeat(own.areas[:, 0], own.meridians)[met] * radius**2,
        socket_areas=use.bed.areas[cells],
        socket_cells=cells,
        whole=len(use.bed.areas),
        ball_whole=own.rings * own.meridians,
        on_socket=spots_of(own, back[[2, 0, 1]]),
        on_ball=Spots(cells=over.cells[:, met], shares=over.shares[:, met]),
    )
