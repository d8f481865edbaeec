"""Film that the ball's surface carries across a face: central differences, upwind, or between both at fronts.

Central differences are of second order. In a time step they make new extremes at a front of the film, which may become
thinner than nothing. The film upstream of a face makes none, and is of first order.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy

from ..core.arrays import Numbers
from .mesh import FilmMesh

CentralShare = Callable[[FilmMesh, Numbers, Numbers], Numbers]
"""Function of mesh, spin and film thickness: share of central differences at each face, 0 to 1."""

_SMOOTH, _FRONT = 0.1, 0.3  # largest relative change of a smooth film across a face, and the least of a front


def all_central(mesh: FilmMesh, spin: Numbers, thickness: Numbers) -> Numbers:
    """Return the share 1 of each face, for smooth films."""
    return numpy.ones(len(mesh.first))


def all_upwind(mesh: FilmMesh, spin: Numbers, thickness: Numbers) -> Numbers:
    """Return the share 0 of each face."""
    return numpy.zeros(len(mesh.first))


def smooth_share(mesh: FilmMesh, spin: Numbers, thickness: Numbers) -> Numbers:
    """Compute the share of central differences: 1 where the film is smooth, and 0 at its fronts.

    A front is a face where the film changes by 30 % or more of the thinner side. A change up to 10 % counts as smooth.
    """
    across = numpy.abs(thickness[mesh.second] - thickness[mesh.first])
    step = across / numpy.minimum(thickness[mesh.second], thickness[mesh.first])
    return numpy.asarray(numpy.clip((_FRONT - step) / (_FRONT - _SMOOTH), 0.0, 1.0))
