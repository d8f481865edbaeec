"""The rings of a cup as it is built, by finite elements of its meridian."""

from __future__ import annotations

from functools import lru_cache

import numpy

from ...core.arrays import Numbers
from ...core.storage.array_files import cached_array
from ...problem import Joint
from ...problem.cup import Cup
from ..finite_elements.harmonics import socket_harmonics
from ..finite_elements.shapes import SocketShape, socket_shape
from ..finite_elements.solver import check_cup
from .grid import Grid
from .harmonics import every_harmonic


def cup_rings(joint: Joint, cup: Cup, grid: Grid) -> Numbers:
    """∫ u dA over rings of a sphere of radius 1 by pressures on rings, for each m, in mm/MPa: (m, rings, rings).

    Raises
    ------
    ValueError
        A cup that this joint cannot have.
    """
    check_cup(cup, joint)
    unit = _unit_rings(socket_shape(joint, cup), tuple(grid.edges.tolist()), grid.degrees)
    return unit * (float(joint.socket_radius) / float(joint.liner.young))


@lru_cache(maxsize=16)
def _unit_rings(shape: SocketShape, edges: tuple[float, ...], degrees: int) -> Numbers:
    """The ring matrices of a bore of radius 1 and a liner of modulus 1, from disk if they were made before."""
    rings = numpy.array(edges)

    def made() -> Numbers:
        meridian = socket_harmonics(shape, rings)
        return every_harmonic(lambda some: meridian.ring_compliance(rings, some), degrees)

    return cached_array((shape, edges, degrees), made)
