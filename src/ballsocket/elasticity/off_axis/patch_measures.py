"""Measures of many contact patches at once: largest pressure, outline, half angle and margin to the rim.

The functions are written for NumPy and JAX. Fields are arrays (contacts, rings, meridians), directions
(contacts, ..., 3).
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi, prod
from typing import NamedTuple

import numpy

from ...core import arrays
from ...core.arrays import Array, Numbers
from .grid import Grid

RAYS = 90  # number of rays from the centre of a contact to its outline
_SECANTS = 5  # number of secants that locate the edge in a step of half a ring's width: half angles within 3e-7 rad
_FIT_RADIUS = 2.2  # radius of the quadratic fit around the largest pressure, in widths of a ring
_FLAT = 2e-5  # relative difference of two pressures of the fit that the points of the lattice do not resolve

_FIT_RINGS = 8
"""Number of rings on each side of the largest pressure that the radius can reach: those at the rim are narrow."""

_LATTICE_POINTS = 25  # number of points in each direction at which the fit is evaluated
_ROUNDING = 1e-6  # relative error of a polar angle by rounding: directions at the end of the bore belong to it
_MIN_MARGIN = 1e-6  # margin in rad of a contact that comes to the end of the bore without reaching it


class CellArrays(NamedTuple):
    """Cells of a grid as arrays of one library and data type."""

    polar: Array  # (rings,), polar angles of the ring middles in rad
    # (rings + 3,), polar angles in rad between which fields are interpolated, from two beyond the pole to the end
    # of the bore
    nodes: Array
    edge_nodes: Array  # (rings,), polar angles in rad at which the edge lies when the level of a ring is 0
    middles: Array  # (3, rings, meridians), unit vectors to the middles of the cells
    areas: Array  # (rings, 1), areas of the cells on a unit sphere
    # (), polar angle of the end of the bore, width of a ring, and `EdgeRelation.inset` times that width, in rad
    reach: Array
    width: Array
    inset: Array


class Patches(NamedTuple):
    """Pressures in MPa and levels in mm of contacts (contacts, rings, meridians), axes of their loads (contacts, 3).

    Levels are positive in the contact and minus the gap outside: see `EdgeRelation.levels`.
    """

    pressure: Array
    level: Array
    axis: Array


def make_cell_arrays(grid: Grid, inset: float) -> CellArrays:
    """Make the NumPy arrays of a grid; `inset` is a fraction of a ring's width."""
    edge_nodes = grid.polar - inset * numpy.diff(grid.edges)
    edge_nodes[-1] = grid.reach  # the contact reaches the rim when the last ring is loaded
    return CellArrays(
        polar=grid.polar,
        nodes=numpy.concatenate([-grid.polar[:2][::-1], grid.polar, [grid.reach]]),
        edge_nodes=edge_nodes,
        middles=grid.middles,
        areas=grid.areas,
        reach=numpy.asarray(grid.reach),
        width=numpy.asarray(grid.width),
        inset=numpy.asarray(inset * grid.width),
    )


def pressure_table(cells: CellArrays, pressure: Array) -> Array:
    """Extend pressures across the pole and to the end of the bore, linearly to a loaded rim."""
    ratio = (cells.reach - cells.polar[-1]) / (cells.polar[-1] - cells.polar[-2])
    last, before = pressure[:, -1], pressure[:, -2]
    at_rim = last + ratio * (last - before)
    return _extend(pressure, at_rim * ((last > 0) & (at_rim > 0)))


def level_table(level: Array) -> Array:
    """Extend levels across the pole, and to the end of the bore with a constant."""
    return _extend(level, level[:, -1])


def _flattened(values: Array) -> Array:
    """Return fields with one row for each contact, also without any contact."""
    return values.reshape(values.shape[0], prod(values.shape[1:]))


def _extend(values: Array, at_rim: Array) -> Array:
    """Extend fields by two rings beyond the pole, one at the rim, and one meridian on either side."""
    xp = arrays.namespace(values)
    beyond = xp.roll(xp.flip(values[:, :2], axis=1), values.shape[2] // 2, axis=2)
    rows = xp.concat([beyond, values, at_rim[:, None]], axis=1)
    return xp.concat([rows[..., -1:], rows, rows[..., :1]], axis=2)


def interpolate(cells: CellArrays, table: Array, directions: Array) -> Array:
    """Interpolate tables (contacts, rings + 3, meridians + 2) at unit vectors (contacts, ..., 3); 0 outside."""
    xp = arrays.namespace(table)
    count, rows, columns = table.shape
    x, y, z = (directions[..., axis] for axis in range(3))
    polar, turn = xp.atan2(xp.hypot(x, y), z), xp.atan2(y, x) / (2 * pi)
    column = (turn - xp.floor(turn)) * (columns - 2) + 0.5
    left = xp.clip(xp.floor(column), 0, columns - 2)
    row = xp.clip(xp.searchsorted(cells.nodes, polar, side="right") - 1, 0, rows - 2)
    low = cells.nodes[row]
    down, along = (polar - low) / (cells.nodes[row + 1] - low), column - left
    index = _flattened(row * columns + left.astype(row.dtype))
    flat = table.reshape(count, rows * columns)
    offsets = (0, 1, columns, columns + 1)
    corners = [xp.take_along_axis(flat, index + offset, axis=1).reshape(polar.shape) for offset in offsets]
    upper = corners[0] + along * (corners[1] - corners[0])
    lower = corners[2] + along * (corners[3] - corners[2])
    return (upper + down * (lower - upper)) * (polar <= cells.reach * (1 + _ROUNDING))


def tangents_at(axis: Array) -> tuple[Array, Array]:
    """Compute two unit vectors (..., 3) across axes (..., 3): away from the pole, and along the ring of the axis.

    At the pole they have finite derivatives, of 0.
    """
    xp = arrays.namespace(axis)
    x, y, z = (axis[..., component] for component in range(3))
    at_pole = (x == 0) & (y == 0)
    beside = xp.where(at_pole, 1.0, x)
    radius, azimuth = xp.where(at_pole, 0.0, xp.hypot(beside, y)), xp.atan2(y, beside)
    length = xp.hypot(radius, z)
    cosine, sine = xp.cos(azimuth), xp.sin(azimuth)
    away = xp.stack([z / length * cosine, z / length * sine, -radius / length], axis=-1)
    return away, xp.stack([-sine, cosine, 0.0 * x], axis=-1)


def ray_directions(centre: Array, angle: Array, azimuth: Array) -> Array:
    """Compute unit vectors (..., 3) at angles (rad) from centres, on rays at azimuths (rad) about them.

    The ray of azimuth 0 lies in the plane of the centre and the cup's axis, away from the pole.
    """
    xp = arrays.namespace(centre)
    first, second = tangents_at(centre)
    side = xp.cos(azimuth)[..., None] * first + xp.sin(azimuth)[..., None] * second
    return xp.cos(angle)[..., None] * centre + xp.sin(angle)[..., None] * side


def ray_azimuths(like: Array) -> Array:
    """Compute the azimuths in rad of the rays about the centre of a contact: (rays,)."""
    return arrays.namespace(like).arange(RAYS, dtype=like.dtype) * (2 * pi / RAYS)


def largest_pressures(cells: CellArrays, pressure: Array, axis: Array) -> tuple[Array, Array]:
    """Compute the largest pressures in MPa (contacts,) and the unit vectors to them (contacts, 3).

    A quadratic polynomial is fitted to the cells around the cell with the largest pressure, by least squares. Contacts
    without pressure have 0. Where the fit has the same pressure at the axis of the load, that is the direction.
    """
    xp = arrays.namespace(pressure)
    count, rings, meridians = pressure.shape
    cell = xp.argmax(_flattened(pressure), axis=1)
    top = xp.max(_flattened(pressure), axis=1)
    middle = cells.middles.reshape(3, -1)[:, cell].T
    span = min(2 * _FIT_RINGS + 1, rings)
    ring = xp.clip(cell // meridians - _FIT_RINGS, 0, rings - span)[:, None] + xp.arange(span)
    near = xp.moveaxis(cells.middles[:, ring], 0, -1).reshape(count, span * meridians, 3)
    values = _flattened(xp.take_along_axis(pressure, ring[..., None], axis=1))
    radius = _FIT_RADIUS * cells.width
    fitted = (near @ middle[..., None])[..., 0] > xp.cos(radius)
    fitted = (fitted & (values > 0)).astype(pressure.dtype)
    first, second = tangents_at(middle)
    terms = _quadratic_terms(*_project(near, first, second, radius)) * fitted[..., None]
    normal, rises = terms.swapaxes(1, 2) @ terms, (values - top[:, None]) * fitted
    fit = xp.linalg.pinv(normal, hermitian=True) @ (terms.swapaxes(1, 2) @ rises[..., None])
    lattice = xp.linspace(-0.6, 0.6, _LATTICE_POINTS, dtype=pressure.dtype) * radius
    s, t = (coordinate.reshape(-1)[None, :, None] for coordinate in xp.meshgrid(lattice, lattice))
    candidates = middle[:, None] + first[:, None] * s + second[:, None] * t
    candidates = candidates / xp.sqrt(xp.sum(candidates * candidates, axis=-1, keepdims=True))
    rise = (_quadratic_terms(*_project(candidates, first, second, radius)) @ fit)[..., 0]
    rise = xp.where(candidates[..., 2] < xp.cos(cells.reach), -top[:, None], rise)
    best = xp.argmax(rise, axis=1)[:, None]
    highest = xp.take_along_axis(rise, best, axis=1)[:, 0]
    at = xp.take_along_axis(candidates, best[..., None], axis=1)[:, 0]
    direction = xp.where((highest < 0)[:, None], middle, at)
    loaded = top > 0
    at_axis = (_quadratic_terms(*_project(axis[:, None], first, second, radius)) @ fit)[:, 0, 0]
    flat = (xp.sum(axis * middle, axis=1) > xp.cos(radius)) & (at_axis >= highest - _FLAT * top)
    flat = flat & (axis[:, 2] >= xp.cos(cells.reach))
    peak = top + loaded * xp.maximum(highest, 0.0 * highest)
    return peak, xp.where((loaded & ~flat)[:, None], direction, axis)


def _project(points: Array, first: Array, second: Array, radius: Array) -> tuple[Array, Array]:
    """Compute coordinates of points (contacts, points, 3) along two tangents, in units of a radius."""
    return (points @ first[..., None])[..., 0] / radius, (points @ second[..., None])[..., 0] / radius


def _quadratic_terms(s: Array, t: Array) -> Array:
    return arrays.namespace(s).stack([1.0 + 0.0 * s, s, t, s * s, s * t, t * t], axis=-1)


def contact_centres(cells: CellArrays, patches: Patches) -> Array:
    """Compute the centres of contacts (contacts, 3): the load, or the largest pressure if the load points outside."""
    xp = arrays.namespace(patches.pressure)
    inside = axis_pressures(cells, patches.pressure, patches.axis) > 0
    cell = xp.argmax(_flattened(patches.pressure), axis=1)
    return xp.where(inside[:, None], patches.axis, cells.middles.reshape(3, -1)[:, cell].T)


def axis_pressures(cells: CellArrays, pressure: Array, axis: Array) -> Array:
    """Compute the pressure in MPa at the axis of each load: (contacts,)."""
    return interpolate(cells, pressure_table(cells, pressure), axis[:, None])[:, 0]


def ray_steps(cells: CellArrays, patches: Patches, centres: Array) -> range:
    """Compute the steps of half a ring's width in which rays leave their contacts, for all contacts in NumPy."""
    cosine = numpy.einsum("nk,krm->nrm", centres, cells.middles)
    loaded, step = patches.level > 0, cells.width / 2
    cosines = numpy.where(loaded, cosine, 1.0).min(initial=1.0), numpy.where(loaded, -1.0, cosine).max(initial=-1.0)
    farthest_loaded, nearest = (float(numpy.arccos(numpy.clip(extreme, -1.0, 1.0))) for extreme in cosines)
    farthest = farthest_loaded + 3 * cells.width
    to_rim = cells.reach - numpy.atan2(numpy.hypot(centres[:, 0], centres[:, 1]), centres[:, 2]).max(initial=0.0)
    first = max(int((min(nearest, to_rim) - 2 * cells.width) / step), 1)
    return range(first, max(int(min(farthest, pi) / step), first) + 1)


def edge_angles(cells: CellArrays, level: Array, centres: Array, steps: range) -> Array:
    """Compute the angles in rad from the centre of each contact to its edge along the rays: (contacts, rays).

    The edge is the first zero of the level, or the end of the bore. It is searched in steps of half a ring's width;
    before the first of them all rays are inside. A ray that never leaves a contact all around the bore has the angle 0.
    """
    xp = arrays.namespace(level)
    table, azimuths, centre = level_table(level), ray_azimuths(level), centres[:, None]
    step = cells.width / 2
    angles = xp.arange(steps.start, steps.stop, dtype=level.dtype) * step
    points = ray_directions(centre[:, None], angles[:, None], azimuths)
    in_bore = points[..., 2] >= xp.cos(cells.reach)
    outside = ~((interpolate(cells, table, points) > 0) & in_bore)
    end = xp.argmax(outside, axis=1)  # the first step outside
    rim = rim_angles(cells, centres)
    end_in_bore = xp.take_along_axis(in_bore, end[:, None], axis=1)[:, 0]
    end_angle = angles[end]
    high = xp.where(end_in_bore, end_angle, xp.minimum(end_angle, rim))

    def level_at(angle: Array) -> Array:
        return interpolate(cells, table, ray_directions(centre, angle, azimuths))

    end_level = level_at(high)
    edge = _find_zero(level_at, end_angle - step, high, end_level) - cells.inset
    ends = xp.minimum(xp.where(end_level > 0, rim, xp.maximum(edge, 0.0 * edge)), rim)
    return xp.where(xp.any(outside, axis=1), ends, 0.0)


def _find_zero(function: Callable[[Array], Array], low: Array, high: Array, high_value: Array) -> Array:
    """Find the zeros of a function between `low` and `high`, where it is positive and not, by the Illinois method."""
    xp = arrays.namespace(low)

    def halve(bounds: tuple[Array, ...]) -> tuple[Array, ...]:
        low, high, low_value, high_value, stayed = bounds
        middle = _secant_zero(low, high, low_value, high_value)
        value = function(middle)
        inside = value > 0
        high_value = xp.where(inside, xp.where(stayed > 0, high_value / 2, high_value), value)
        low_value = xp.where(inside, value, xp.where(stayed < 0, low_value / 2, low_value))
        low, high = xp.where(inside, middle, low), xp.where(inside, high, middle)
        return low, high, low_value, high_value, xp.where(inside, 1.0, -1.0) + 0.0 * low

    bounds = low, high, function(low), high_value, 0.0 * low
    low, high, low_value, high_value, _ = arrays.repeat_step(halve, bounds, _SECANTS)
    return _secant_zero(low, high, low_value, high_value)


def _secant_zero(low: Array, high: Array, low_value: Array, high_value: Array) -> Array:
    xp = arrays.namespace(low)
    fall = low_value - high_value
    crosses = (low_value > 0) & (high_value <= 0)
    return low + (high - low) * xp.where(crosses, low_value / xp.where(crosses, fall, 1.0), 0.5)


def rim_angles(cells: CellArrays, centres: Array) -> Array:
    """Compute the angles in rad from centres to the end of the bore along rays; infinite if a ray misses it."""
    xp = arrays.namespace(centres)
    azimuths = ray_azimuths(centres)
    # z = cos out z(0) + sin out z(90°) = A cos(out - a)
    start = centres[:, 2:] + 0.0 * azimuths
    side = ray_directions(centres[:, None], 0.0 * azimuths + pi / 2, azimuths)[..., 2]
    cosine = xp.cos(cells.reach) / xp.hypot(start, side)
    hits = xp.abs(cosine) < 1
    return xp.where(hits, xp.atan2(side, start) + xp.acos(xp.where(hits, cosine, 0.0)), xp.inf)


def half_angles(cells: CellArrays, patches: Patches, edges: Array) -> Array:
    """Compute the half angles in rad of round contacts of the same area, from the edges along rays: (contacts,).

    The solid angle in the outline is 2π (1 - cos ε). A contact that the load does not point into, a ring around a
    preloaded ball, has the area of its cells.
    """
    xp = arrays.namespace(edges)
    solid_angle = xp.sum((patches.pressure > 0) * cells.areas, axis=(1, 2))
    outlined = axis_pressures(cells, patches.pressure, patches.axis) > 0
    cosine = xp.where(outlined, xp.mean(xp.cos(edges), axis=1), 1 - solid_angle / (2 * pi))
    return xp.acos(xp.clip(cosine, -1.0, 1.0))


def edge_loaded(pressure: Array) -> Array:
    """Return True where there is pressure at the end of the bore: (contacts,)."""
    return arrays.namespace(pressure).any(pressure[:, -1] > 0, axis=1)


def edge_margins(cells: CellArrays, patches: Patches) -> Array:
    """Compute the smallest angles in rad from the edge to the end of the bore (contacts,); 0 if a contact reaches it.

    On every meridian the edge lies between the last loaded cell and the first open one. A parabola through the
    furthest meridian and its neighbours gives the furthest point.
    """
    xp = arrays.namespace(patches.level)
    edges = _polar_edges(cells, patches.level)
    furthest = xp.argmax(edges, axis=1)[:, None]
    before, middle, after = (
        xp.take_along_axis(edges, (furthest + shift) % edges.shape[1], axis=1)[:, 0] for shift in (-1, 0, 1)
    )
    bend = 2 * middle - before - after
    rise = xp.where(bend > 0, (after - before) ** 2 / (8 * xp.where(bend > 0, bend, 1.0)), 0.0)
    margin = cells.reach - middle - rise
    return xp.where(edge_loaded(patches.pressure), 0.0, xp.where(margin < _MIN_MARGIN, _MIN_MARGIN, margin))


def _polar_edges(cells: CellArrays, level: Array) -> Array:
    """Compute the polar angles in rad of the edge towards the rim (contacts, meridians); 0 without contact."""
    xp = arrays.namespace(level)
    loaded, last = level > 0, level.shape[1] - 1
    ring = last - xp.argmax(xp.flip(loaded, axis=1), axis=1)
    after = xp.minimum(ring + 1, 0 * ring + last)
    inner, outer = (xp.take_along_axis(level, index[:, None], axis=1)[:, 0] for index in (ring, after))
    falls = inner > outer
    fraction = xp.where(falls, inner / xp.where(falls, inner - outer, 1.0), 0.0)
    low = cells.edge_nodes[ring]
    return xp.where(xp.any(loaded, axis=1), low + fraction * (cells.edge_nodes[after] - low), 0.0)


def cell_shares(cells: CellArrays, patches: Patches, centres: Array, edges: Array) -> Array:
    """Compute the share of each cell inside the edge of its contact, 0 to 1: (contacts, rings, meridians).

    A cell is half inside at its first load, so that on average as much is inside as in the loaded cells. Beyond a
    ring's width from the edge along the rays, the loaded cells have 1 and the others 0.
    """
    xp = arrays.namespace(edges)
    first, second = tangents_at(centres)
    points = _flattened(cells.middles.reshape(3, -1)).T
    along, across = (points @ direction[..., None] for direction in (first, second))
    angle = xp.acos(xp.clip((points @ centres[..., None])[..., 0], -1.0, 1.0))
    turn = xp.atan2(across[..., 0], along[..., 0]) * (RAYS / (2 * pi))
    ray = xp.floor(turn)
    ends = xp.where(edges > 0, edges + cells.inset, 2 * pi)  # a ray that never leaves its contact has the angle 0
    ends = xp.where(edges < rim_angles(cells, centres), ends, ends + 2 * cells.width)  # the rim does not give way
    before, after = (xp.take_along_axis(ends, ((ray + shift) % RAYS).astype(int), axis=1) for shift in (0.0, 1.0))
    share = 0.5 + (before + (turn - ray) * (after - before) - angle) / cells.width
    loaded = _flattened(patches.pressure) > 0
    return xp.where((share > 0) & (share < 1), share, 1.0 * loaded).reshape(patches.pressure.shape)


def measure_edges(cells: CellArrays, patches: Patches) -> tuple[Numbers, Numbers]:
    """Compute the centres (contacts, 3) and edge angles (contacts, rays) of contacts in NumPy."""
    centres = contact_centres(cells, patches)
    return centres, edge_angles(cells, patches.level, centres, ray_steps(cells, patches, centres))
