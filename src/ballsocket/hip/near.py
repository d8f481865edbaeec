"""The cells that are looked at in a block, of the socket and of a ball that wears."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from .facing import Facing, facing
from .kinematics import SurfaceSliding
from .set_up import SetUp
from .springs import CycleBed


@dataclass(frozen=True, kw_only=True, eq=False)
class Near:
    """The cells that are in reach of the contacts, what slides over them, and the ball's cells where those wear too."""

    cells: Numbers
    bed: CycleBed
    sliding: SurfaceSliding
    facing: Facing | None

    @property
    def ball_cells(self) -> Numbers:
        return numpy.zeros(0, dtype=int) if self.facing is None else self.facing.cells

    @property
    def areas(self) -> Numbers:
        """Areas of all that wears, socket and ball."""
        return self.bed.areas if self.facing is None else numpy.concatenate([self.bed.areas, self.facing.areas])


def near_cells(use: SetUp, cells: Numbers) -> Near:
    """Some cells of the socket, and those of the ball that pass over them if it wears."""
    faced = None if use.ball_wear is None else facing(use, cells)
    return Near(cells=cells, bed=use.bed.part(cells), sliding=use.sliding.select_points(cells), facing=faced)
