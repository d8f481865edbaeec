"""How much of a contact a cup carries: all of it away from the rim, half of it on the rim, nothing beyond.

The energy of radial springs under a small patch of half angle ε, cut by a straight rim that lies s ε from its centre,
is a share W(s) of the whole: the marginal of (1 - x² - y²)² over a disc.
"""

from __future__ import annotations

from math import pi

from ..core.arrays import Array, atan2, clip, sqrt


def share(place: Array) -> tuple[Array, Array, Array]:
    """W, its slope and its bend at s, the distance of the rim over the half angle: 1 from s = 1, 0 up to s = -1."""
    s = clip(place, -1.0, 1.0)
    square = clip(1.0 - s * s, 0.0, 1.0)
    root = sqrt(square)
    W = 0.5 + (atan2(s, root) + s * root * (33.0 + s * s * (8.0 * s * s - 26.0)) / 15.0) / pi
    slope = 16.0 / (5.0 * pi) * square * square * root
    return clip(W, 0.0, 1.0), slope, -16.0 / pi * s * square * root
