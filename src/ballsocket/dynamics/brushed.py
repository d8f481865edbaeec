"""The load of an element whose ball is held by bristles."""

from __future__ import annotations

from typing import Any

import numpy

from ..core import arrays
from ..core.arrays import sqrt
from ..core.checks import shown
from .bristles import Bristles, Four, bent
from .load import Load
from .matrices import vector
from .reaction import pressed, sliding


def brushed(load: Load, bristles: Bristles, deflection: Any) -> Load:
    """A load without friction, and what the bristles add to it."""
    place, given = load.place, load.element.constants
    speed = sum(rate * way for rate, way in zip(load.velocity, place[1:4], strict=True))
    slip = sliding(place, pressed(load.contact, speed, given), load.velocity, load.spin, given)
    force, rate, lost = bent(place, slip, _four(load, deflection), bristles)
    N, R1, n = slip.normal, given.ball_radius, place[1:4]
    rubbing = [-N * part for part in force[:3]]
    drill = -N * sqrt(slip.lever_squared) * force[3]
    turned = _cross(n, rubbing)
    kind = type(load.force)
    return load._replace(
        force=vector(kind, *(a + b for a, b in zip(_parts(load.force), rubbing, strict=True))),
        moment=vector(kind, *(R1 * a + drill * way for a, way in zip(turned, n, strict=True))),
        deflection_rate=vector(kind, *rate),
        rubbed=N * lost,
    )


def _four(load: Load, deflection: Any) -> Four:
    if type(load.force) is not tuple and type(deflection) in (tuple, list):
        deflection = numpy.asarray(deflection, dtype=float)
        deflection = arrays.namespace(load.force).asarray(deflection, dtype=load.force.dtype)
    parts = tuple(deflection) if type(deflection) in (tuple, list) else tuple(deflection[..., i] for i in range(4))
    if len(parts) != 4:
        raise ValueError(f"bristles have four deflections, x, y, z and about the load, got {shown(deflection)}")
    a, b, c, d = (part + 0.0 for part in parts)
    return a, b, c, d


def _parts(packed: Any) -> Any:
    return packed if type(packed) is tuple else [packed[..., axis] for axis in range(3)]


def _cross(a: Any, b: Any) -> Any:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
