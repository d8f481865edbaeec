"""Ratio of the largest von Mises stress in a liner to the largest pressure, from a table of the exact solution.

The liner is bonded to a rigid backing. The ratio depends on the half angle, Poisson's ratio and R2/L, and not on load,
clearance or Young's modulus. It is the larger of two smooth functions: the largest stress on the load axis, and that
at the interface between liner and backing, which decides in nearly incompressible liners.
"""

from __future__ import annotations

from functools import cache, reduce
from importlib.resources import files
from itertools import product
from math import log

import numpy

from ..core import arrays
from ..core.arrays import Array, Numbers, clip, convert_like, log1p, safe_divisor, where
from ..core.arrays import log as ln
from ..problem import elementwise_maximum
from .coordinates import LIMIT, RATIO_SHIFT, angle_root

POISSON = (0.0, 0.4993)  # range of Poisson's ratio in the table
MAX_THICKNESS_RATIO = 20.5  # largest R2/L in the table; the smallest is 0, a massive socket

NODES = (25, 25, 33)
"""Numbers of nodes of ν, R2/L and the half angle ε, equally spaced in their coordinates from 0 to 1."""

MAX_AXIAL_POISSON = 0.44  # largest ν for which the stress on the axis decides at all half angles and R2/L of the table

_AROUND = range(4)  # nodes of a cubic polynomial: one before the cell, its two ends, and one behind it


def poisson_at(coordinate: Numbers) -> Numbers:
    """Compute Poisson's ratio at a coordinate from 0 to 1."""
    return (1 - numpy.exp(coordinate * log(1 - 2 * POISSON[1]))) / 2


def thickness_ratio_at(coordinate: Numbers) -> Numbers:
    """Compute R2/L at a coordinate from 0 to 1."""
    return RATIO_SHIFT * numpy.expm1(coordinate * log(1 + MAX_THICKNESS_RATIO / RATIO_SHIFT))


@cache
def _padded_table() -> Numbers:
    """Read the table (2, nodes of ν, R2/L, ε), with a parabola continued by one node beyond each end."""
    with (files("ballsocket") / "data" / "von_mises.npz").open("rb") as stream:
        table = numpy.moveaxis(numpy.load(stream)["ratios"].astype(float), -1, 0)
    for axis in (1, 2, 3):
        first, last = (numpy.take(table, ends, axis) for ends in ([0, 1, 2], [-1, -2, -3]))
        ghosts = (numpy.tensordot([3.0, -3.0, 1.0], end, (0, axis)) for end in (first, last))
        before, behind = (numpy.expand_dims(ghost, axis) for ghost in ghosts)
        table = numpy.concatenate([before, table, behind], axis)
    return table


def von_mises_ratio(half_angle: Array, poisson: Array, thickness_ratio: Array) -> Array:
    """Interpolate the ratio of largest von Mises stress to largest pressure; cubic between the nodes of the table.

    It depends on the half angle ε in rad, Poisson's ratio of the liner, and R2/L. Beyond the table the nearest ν and ε
    hold; a thinner liner has the ratio at the same contact radius over thickness.
    """
    thicker = where(thickness_ratio > MAX_THICKNESS_RATIO, MAX_THICKNESS_RATIO / safe_divisor(thickness_ratio), 1.0)
    ratio = thickness_ratio * thicker
    angle = clip(where(half_angle == half_angle, half_angle, 0.0) / thicker, 0.0, LIMIT)
    poisson = clip(poisson, *POISSON)
    coordinates = (
        ln(1 - 2 * poisson) / log(1 - 2 * POISSON[1]),
        log1p(ratio / RATIO_SHIFT) / log(1 + MAX_THICKNESS_RATIO / RATIO_SHIFT),
        angle_root(angle, ratio),
    )
    is_axial = arrays.all_true(poisson <= MAX_AXIAL_POISSON) is True
    tables = _padded_table()[: 1 if is_axial else 2]
    positions = [clip(x * (n - 1), 0.0, n - 1.0) for x, n in zip(coordinates, NODES, strict=True)]
    if all(type(position) is float for position in positions):
        return _interpolate_one(tables, positions)
    values = _interpolate(tables, arrays.to_common_arrays(*positions))
    return reduce(elementwise_maximum, values) + 0.0 * half_angle


def _interpolate_one(tables: Numbers, positions: list[float]) -> float:
    """Interpolate tables (functions, nodes) at one position, and return the largest."""
    block = tables
    for axis, (position, count) in enumerate(zip(positions, NODES, strict=True)):
        first = min(int(position), count - 2)
        block = block[(slice(None), *(slice(None),) * axis, slice(first, first + 4))]
        positions[axis] = position - first
    for fraction in positions[::-1]:
        block = block @ numpy.array(_cubic_weights(fraction))
    return float(block.max())


def _interpolate(tables: Numbers, positions: tuple[Array, ...]) -> list[Array]:
    """Interpolate each of the tables (functions, nodes) at positions of any shape and library."""
    xp = arrays.namespace(*positions)
    positions = xp.broadcast_arrays(*positions)
    shape, flat = positions[0].shape, [xp.reshape(position, (-1,)) for position in positions]
    firsts = [clip(xp.floor(position), 0.0, n - 2.0) for position, n in zip(flat, NODES, strict=True)]
    weights = [_cubic_weights(position - first) for position, first in zip(flat, firsts, strict=True)]
    strides = [step // tables.itemsize for step in tables[0].strides]
    corner = sum(xp.astype(first, xp.int32) * step for first, step in zip(firsts, strides, strict=True))
    values = []
    for table in tables:
        nodes = convert_like(table.ravel(), flat[0])
        value = 0.0 * flat[0]
        for i, j in product(_AROUND, _AROUND):
            start = corner + (i * strides[0] + j * strides[1])
            row = sum(weights[2][k] * xp.take(nodes, start + k, axis=0) for k in _AROUND)
            value = value + weights[0][i] * weights[1][j] * row
        values.append(xp.reshape(value, shape))
    return values


def _cubic_weights(t: Array) -> tuple[Array, Array, Array, Array]:
    """Compute the weights of four nodes at a fraction t of the middle cell (Catmull & Rom), with slope continuous."""
    return (
        t * (t * (2 - t) - 1) / 2,
        t * t * (1.5 * t - 2.5) + 1,
        t * (t * (2 - 1.5 * t) + 0.5),
        t * t * (t - 1) / 2,
    )
