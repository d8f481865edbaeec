"""Bore and ball together on the grid: what a pressure does, and which pressure does that."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, replace
from functools import cached_property
from threading import Lock

import numpy

from ...core.arrays import Numbers
from ...problem import Joint
from ...problem.cup import Cup
from ..exact.modes import ball_of
from ..finite_elements.shapes import socket_shape
from .grid import Grid, Local, Turning, rim_grid
from .rings_of_modes import modal_rings
from .surfaces import Springs, Surface


@dataclass(frozen=True, kw_only=True, eq=False)
class Compliance:
    """How the bore's surface and the ball's give way to each other.

    Attributes
    ----------
    grid : Grid
    softness, stiffness : Turning or Local
        From pressures in MPa to how far both surfaces give way in mm, and back.
    """

    grid: Grid
    softness: Turning | Local
    stiffness: Turning | Local

    def displacement(self, pressure: Numbers) -> Numbers:
        """How far the surfaces give way (mm) under pressures (MPa): both (batch, rings, meridians)."""
        return self.softness(pressure)

    def roughly(self, pressure: Numbers) -> Numbers:
        """That in single precision, where a cell does not stand for itself."""
        return self._rough(pressure)

    @cached_property
    def _rough(self) -> Turning | Local:
        return self.softness.rough()

    def pressure(self, displacement: Numbers) -> Numbers:
        """The pressures (MPa, of either sign) under which they give way so far (mm) all over the bore."""
        return self.stiffness(displacement)

    @cached_property
    def coarser(self) -> Compliance | None:
        """This compliance in cells twice as wide; None where these are wide already."""
        cells = self.grid.coarser
        if cells is None:
            return None
        if isinstance(self.softness, Local):
            return replace(self, grid=cells)
        matrices = self.grid.gathered_matrices(self.softness.matrices)
        return Compliance(
            grid=cells, softness=Turning(matrices=matrices), stiffness=Turning(matrices=_inverse(matrices))
        )

    @cached_property
    def evenly(self) -> float:
        """Pressure by displacement where both are the same all over, in MPa/mm."""
        ones = numpy.ones((1, self.grid.rings, self.grid.meridians))
        return float(self.grid.total(self.pressure(ones), ones)[0] / self.grid.ring_areas.sum())


def _made(surface: Surface, joint: Joint, cup: Cup, width: float) -> Compliance:
    return compliance_on(surface, joint, cup, rim_grid(socket_shape(joint, cup).reach, width))


def compliance_on(surface: Surface, joint: Joint, cup: Cup, cells: Grid) -> Compliance:
    """The compliance of a joint of plain numbers on these cells, made anew."""
    ball = ball_of(joint)
    if isinstance(surface, Springs) and ball is None:
        modulus = float(surface.modulus(joint))
        return Compliance(grid=cells, softness=Local(scale=1 / modulus), stiffness=Local(scale=modulus))
    matrices = surface.rings(joint, cup, cells)
    if ball is not None:
        matrices = matrices + cells.averaged(modal_rings(ball.compliance, cells))
    return Compliance(grid=cells, softness=Turning(matrices=matrices), stiffness=Turning(matrices=_inverse(matrices)))


def _inverse(matrices: Numbers) -> Numbers:
    """The inverses in single precision: they guide the iteration, and the end of that is judged by the compliance."""
    return numpy.linalg.inv(matrices).astype(numpy.float32)


_KEPT: OrderedDict[tuple[object, ...], Compliance] = OrderedDict()
_SIZE, _LOCK = 8, Lock()


def compliance(surface: Surface, joint: Joint, cup: Cup, width: float) -> Compliance:
    """The compliance of a joint of plain numbers in rings of this width (rad); the last few are kept."""
    key = (surface, joint, cup.arc_of_cover, cup.chamfer, cup.interface, width)
    with _LOCK:
        if key not in _KEPT:
            _KEPT[key] = _made(surface, joint, cup, width)
            if len(_KEPT) > _SIZE:
                _KEPT.popitem(last=False)
        _KEPT.move_to_end(key)
        return _KEPT[key]
