"""The ball's own cells: how they pass over those of the socket, and what that wears of the ball."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy

from ..arrays import Numbers
from ..sphere.grid import Grid, even_grid
from .laws import Pass
from .sliding import Sliding

if TYPE_CHECKING:
    from .use import InUse


@dataclass(frozen=True, kw_only=True, eq=False)
class Spots:
    """Places between the cells of a grid, each with the four around it.

    Attributes
    ----------
    cells : array (n, places, 4)
    shares : array (n, places, 4)
        They add up to 1; 0 beyond the grid's reach.
    """

    cells: Numbers
    shares: Numbers

    def of(self, fields: Numbers) -> Numbers:
        """Values of fields (n or 1, all cells) at the places: (n, places)."""
        count, places, four = self.cells.shape
        fields = numpy.broadcast_to(fields, (count, fields.shape[-1]))
        found = numpy.take_along_axis(fields, self.cells.reshape(count, -1), axis=1)
        return numpy.einsum("tpk,tpk->tp", found.reshape(count, places, four), self.shares)


def spots_of(grid: Grid, directions: Numbers) -> Spots:
    """Where unit vectors (3, n, places) lie between the middles of a grid's cells."""
    x, y, z = directions
    polar, around = numpy.arctan2(numpy.hypot(x, y), z), numpy.arctan2(y, x)
    ring = numpy.clip(numpy.searchsorted(grid.polar, polar) - 1, 0, grid.rings - 2)
    up = numpy.clip((polar - grid.polar[ring]) / (grid.polar[ring + 1] - grid.polar[ring]), 0.0, 1.0)
    turn = around / (2 * numpy.pi) * grid.meridians - 0.5
    first = numpy.floor(turn).astype(int)
    on = turn - first
    cells = numpy.stack(
        [(ring + i) * grid.meridians + (first + j) % grid.meridians for i in (0, 1) for j in (0, 1)], axis=-1
    )
    shares = numpy.stack([(1 - up) * (1 - on), (1 - up) * on, up * (1 - on), up * on], axis=-1)
    return Spots(cells=cells, shares=shares * (polar <= grid.reach)[..., None])


def ball_grid(width: float) -> Grid:
    """The ball's cells: rings about its axis to the front, so that none of those that are pressed is a sliver."""
    return even_grid(numpy.pi, width)


def ball_directions(grid: Grid) -> Numbers:
    """Unit vectors (3, cells) to the middles of the cells of a ball that is not turned, in the body's directions."""
    along, across, front = grid.middles.reshape(3, -1)
    return numpy.stack([across, front, along])


@dataclass(frozen=True, kw_only=True, eq=False)
class Facing:
    """Cells of the ball that pass over cells of the socket.

    Attributes
    ----------
    cells : array (m,)
        Of the ball's grid.
    sliding : Sliding
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
    sliding: Sliding
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
        field = numpy.zeros((len(done.pressure), self.whole))
        field[:, self.socket_cells] = done.pressure
        pressure = self.on_ball.of(field)
        given = (done.pressure * done.sliding.steps) @ self.socket_areas
        found = (pressure * self.sliding.steps) @ self.areas
        share = numpy.divide(given, found, out=numpy.zeros_like(given), where=found > 0)
        return Pass(pressure=pressure * share[:, None], sliding=self.sliding)


def facing(use: InUse, cells: Numbers) -> Facing:
    """The ball's cells that pass over some cells of the socket in a cycle."""
    frame = numpy.array(use.placed.frame)
    turned = frame @ use.moved.middles[use.loaded]
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
        sliding=Sliding(
            radius=radius,
            turns=numpy.einsum("tji,tj->ti", turned, use.turns),
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
