"""Wear of the ball: maps pressures of the socket to the rotating surface of the ball."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid
from .hip_setup import HipSetup
from .kinematics import SurfaceSliding
from .socket_foundation import SocketFoundation
from .wear_law import CycleExposure


@dataclass(frozen=True, kw_only=True, eq=False)
class BilinearInterpolation:
    """Interpolation from the cells of a grid to points; see `Grid.surrounding_cells`."""

    cells: Numbers  # (4, n, points), numbers of the cells around each point
    weights: Numbers  # (4, n, points), weights of these cells

    def interpolate(self, fields: Numbers) -> Numbers:
        """Interpolate cell values (n or 1, cells) to the points: (n, points)."""
        corners, instant_count, _ = self.cells.shape
        fields = numpy.broadcast_to(fields, (corners, instant_count, fields.shape[-1]))
        return numpy.einsum("ktp,ktp->tp", numpy.take_along_axis(fields, self.cells, axis=-1), self.weights)


def interpolation_at(grid: Grid, directions: Numbers) -> BilinearInterpolation:
    """Create the interpolation from a grid to points given by unit vectors (3, n, points)."""
    cells, weights = grid.surrounding_cells(directions)
    return BilinearInterpolation(cells=cells, weights=weights)


def ball_directions(grid: Grid) -> Numbers:
    """Compute unit vectors (3, cells) to the centres of the cells of an unrotated ball, in the body's frame."""
    first_axis, second_axis, axis = grid.middles.reshape(3, -1)
    return numpy.stack([second_axis, axis, first_axis])


@dataclass(frozen=True, kw_only=True, eq=False)
class CounterfaceMap:
    """Relation of the cells of the ball to the cells of the socket during a cycle."""

    cells: Numbers  # (m,), numbers of these cells in the ball's grid
    sliding: SurfaceSliding  # sliding of the socket over them, in the ball's frame
    areas: Numbers  # (m,), areas in mm²
    socket_areas: Numbers  # (n,), areas of the socket's cells in mm²
    socket_cells: Numbers  # (n,), numbers of the socket's cells under them
    # numbers of cells of the complete grids
    socket_size: int
    ball_size: int
    # interpolations from the ball's grid to the socket's cells in each instant, and the reverse
    on_socket: BilinearInterpolation
    on_ball: BilinearInterpolation

    def depth_on_socket(self, depth: Numbers) -> Numbers:
        """Interpolate the worn depth of the ball (m,) in mm to the socket's cells: (instants, n)."""
        field = numpy.zeros((1, self.ball_size))
        field[0, self.cells] = depth
        return self.on_socket.interpolate(field)

    def ball_exposure(self, cycle: CycleExposure) -> CycleExposure:
        """Compute pressure and sliding of the ball's cells; their friction work equals that of the socket."""
        pressure = self._interpolate_to_ball(cycle.pressure)
        socket_work = (cycle.pressure * cycle.sliding.distances) @ self.socket_areas
        ball_work = (pressure * self.sliding.distances) @ self.areas
        work_ratio = numpy.divide(socket_work, ball_work, out=numpy.zeros_like(socket_work), where=ball_work > 0)
        return CycleExposure(
            pressure=pressure * work_ratio[:, None],
            sliding=self.sliding,
            contact_shares=lambda: self._interpolate_to_ball(cycle.contact),
        )

    def _interpolate_to_ball(self, values: Numbers) -> Numbers:
        """Interpolate values of the socket's cells (instants, n) to the ball's cells: (instants, m)."""
        field = numpy.zeros((len(values), self.socket_size))
        field[:, self.socket_cells] = values
        return self.on_ball.interpolate(field)


def map_counterface(setup: HipSetup, cells: Numbers) -> CounterfaceMap:
    """Find the cells of the ball that pass over some cells of the socket, with their interpolations."""
    cup_frame = numpy.array(setup.frame.placed.frame)
    rotations_in_cup = cup_frame @ setup.frame.side_cycle.midpoint_rotations[setup.frame.loaded]
    grid = setup.ball_grid
    directions = ball_directions(grid)
    to_ball = interpolation_at(setup.grid, numpy.einsum("tij,jp->itp", rotations_in_cup, directions))
    selected_cells = numpy.zeros(len(setup.foundation.areas))
    selected_cells[cells] = 1.0
    ball_cells = numpy.flatnonzero((to_ball.interpolate(selected_cells[None]) > 0).any(axis=0))
    to_socket = numpy.einsum("tji,jp->itp", rotations_in_cup, setup.foundation.directions[:, cells])
    radius = float(setup.joint.ball_radius)
    return CounterfaceMap(
        cells=ball_cells,
        sliding=SurfaceSliding(
            radius=radius,
            rotation_increments=numpy.einsum("tji,tj->ti", rotations_in_cup, setup.frame.rotation_increments),
            directions=directions[:, ball_cells],
        ),
        areas=setup.ball_areas[ball_cells],
        socket_areas=setup.foundation.areas[cells],
        socket_cells=cells,
        socket_size=len(setup.foundation.areas),
        ball_size=grid.rings * grid.meridians,
        on_socket=interpolation_at(grid, to_socket[[2, 0, 1]]),
        on_ball=BilinearInterpolation(cells=to_ball.cells[..., ball_cells], weights=to_ball.weights[..., ball_cells]),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class ActiveCells:
    """Socket cells near the contacts, and ball cells that pass over them if the ball wears."""

    cells: Numbers  # (n,), numbers of the socket's cells
    foundation: SocketFoundation  # foundation of these cells
    sliding: SurfaceSliding  # sliding of the ball over these cells
    counterface: CounterfaceMap | None  # cells of the ball; None for a ball without wear

    @property
    def ball_cells(self) -> Numbers:
        """Indices of the wearing cells of the ball; empty for a ball without wear."""
        return numpy.zeros(0, dtype=int) if self.counterface is None else self.counterface.cells

    @property
    def areas(self) -> Numbers:
        """Areas in mm² of all wearing cells, first of the socket, then of the ball."""
        if self.counterface is None:
            return self.foundation.areas
        return numpy.concatenate([self.foundation.areas, self.counterface.areas])


def select_active_cells(setup: HipSetup, cells: Numbers) -> ActiveCells:
    """Select socket cells by their indices, and the cells of a wearing ball that pass over them."""
    counterface = None if setup.ball_wear is None else map_counterface(setup, cells)
    return ActiveCells(
        cells=cells,
        foundation=setup.foundation.select_cells(cells),
        sliding=setup.sliding.select_points(cells),
        counterface=counterface,
    )
