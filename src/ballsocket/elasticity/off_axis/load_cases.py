"""Contacts under prescribed forces, indentations or half angles, and the tilt of the load at first rim contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from math import pi

import numpy

from ...core.arrays import Numbers
from ...core.executors.processes import check_memory, count_text
from ...models.kinematics import versine_of
from .bore_contact import BoreContact
from .contact_states import ContactStates, ContactSummaries, LoadSolver, summarise
from .directions import TILT_TOLERANCE, polar_angle, unit_vectors
from .equilibrium import solve_force
from .lane_solver import coarser_lanes
from .rim_curve import RimCurve, cached_rim_points, force_curve, indentation_curve
from .surfaces import EdgeRelation, initial_displacement

_MAX_FREE_DISPLACEMENT = 0.5
"""Displacement without contact, as a fraction of the bore's radius, beyond which a ball has left its bore.

A ball whose centre lies beyond the surface of the bore has left it in any case. Indentations for a prescribed half
angle are searched up to the same limit.
"""

MAX_EQUILIBRIUM_DISPLACEMENT = 0.25
"""Displacement of a ball in equilibrium, as a fraction of the bore's radius.

A preloaded ball beyond was pushed out by its bore.
"""

_MAX_SWING = pi / 3
"""Angle in rad beyond the rim at which a ball without equilibrium counts as dislocated.

Without friction a bore pushes along its normals alone. One that ends before its equator holds no load that points
beyond its end; one that ends behind it holds any load.
"""


def _solve_indentations(bore: BoreContact, indentation: Numbers, axes: Numbers, edges: EdgeRelation) -> ContactStates:
    """Solve the contacts of balls that are displaced by clearance plus indentation (mm) along axes."""
    clearance = bore.gap.clearance
    equilibrium = bore.solve_displaced(axes * (clearance + indentation)[:, None])
    separated = ~(equilibrium.pressure > 0).any(axis=(1, 2))
    distance = (clearance + indentation) / bore.gap.socket_radius
    dislocated = numpy.asarray((separated & (distance > _MAX_FREE_DISPLACEMENT)) | (distance > 1))
    return ContactStates(
        bore=bore,
        equilibrium=equilibrium,
        axes=axes,
        edges=edges,
        dislocated=dislocated,
        load=indentation,
        solve=_solve_indentations,
        rim_curve=indentation_curve,
    )


def _solve_forces(bore: BoreContact, force: Numbers, axes: Numbers, edges: EdgeRelation) -> ContactStates:
    reach = bore.compliance.grid.reach
    held = (polar_angle(axes.T) < reach) | (reach > pi / 2)
    start = initial_displacement(bore.gap, bore.compliance.uniform_stiffness, bore.gap.depth, force, axes)
    equilibrium = solve_force(bore, axes * force[:, None], start, held)
    displacement = equilibrium.displacement
    swung_out = polar_angle(displacement.T) > reach + _MAX_SWING
    max_distance = MAX_EQUILIBRIUM_DISPLACEMENT * bore.gap.socket_radius
    pushed_out = held & (numpy.linalg.norm(displacement, axis=1) > max_distance)
    dislocated = ~held | pushed_out | (~equilibrium.converged & swung_out)
    return ContactStates(
        bore=bore,
        equilibrium=equilibrium,
        axes=axes,
        edges=edges,
        dislocated=dislocated,
        load=force,
        solve=_solve_forces,
        rim_curve=force_curve,
    )


_MAX_BRACKET_STEPS = 40

_MIN_BRACKET = 1e-3
"""Width of a bracket, as a fraction of the indentation, that contains nothing but a jump of the half angle."""

_ANGLE_TOLERANCE = 0.005  # largest error of a half angle, as a fraction of a ring's width

_MAX_ANGLE_JUMP = 1.0
"""Largest error of a half angle at a jump, in widths of a ring: all cells of a ring may touch at once."""


def _solve_half_angles(bore: BoreContact, half_angle: Numbers, axes: Numbers, edges: EdgeRelation) -> ContactStates:
    """Solve the contacts of prescribed half angles (rad), by Newton's method for the indentation in a bracket."""
    width, limit = bore.compliance.grid.width, _MAX_FREE_DISPLACEMENT * bore.gap.socket_radius
    indentation = numpy.clip(_spring_indentation(bore, half_angle), 1e-6 * limit, limit)
    low, high = 0.0 * indentation, numpy.full_like(indentation, limit)
    active = numpy.arange(len(indentation))
    for _ in range(_MAX_BRACKET_STEPS):
        d, target = indentation[active], half_angle[active]
        angle = _solve_indentations(bore, d, axes[active], edges).half_angle
        low[active] = numpy.where(angle < target, d, low[active])
        high[active] = numpy.where(angle < target, high[active], d)
        unsolved = abs(angle - target) > _ANGLE_TOLERANCE * width
        unsolved &= high[active] - low[active] > _MIN_BRACKET * high[active]
        if not unsolved.any():
            break
        ratio = _spring_indentation(bore, target) / numpy.maximum(_spring_indentation(bore, angle), 1e-9 * d)
        guess = d * numpy.clip(ratio, 0.1, 10.0)
        active, guess = active[unsolved], guess[unsolved]
        indentation[active] = _limit_to_bracket(guess, low[active], high[active], limit)
    states = _solve_indentations(bore, indentation, axes, edges)
    deficit = half_angle - states.half_angle
    converged = states.equilibrium.converged & (abs(deficit) <= _MAX_ANGLE_JUMP * width)
    too_wide = (low >= (1 - _MIN_BRACKET) * limit) & (deficit > _ANGLE_TOLERANCE * width)
    return replace(states, equilibrium=replace(states.equilibrium, converged=converged), too_wide=too_wide)


def _spring_indentation(bore: BoreContact, half_angle: Numbers) -> Numbers:
    """Compute the indentation in mm of a half angle in rad on springs; without clearance only proportional to it."""
    versine = versine_of(half_angle)
    return max(abs(bore.gap.clearance), 1e-9) * versine / numpy.maximum(1 - versine, 0.05)


def _limit_to_bracket(guess: Numbers, low: Numbers, high: Numbers, limit: float) -> Numbers:
    """Return an estimate inside its bracket, else another point there, just below a limit that was never computed."""
    middle = numpy.where(low > 0, numpy.sqrt(low * high), high / 10)
    inside: Numbers = numpy.where((guess > low) & (guess < high), guess, middle)
    return numpy.where((guess >= limit) & (high >= limit), (1 - _MIN_BRACKET / 2) * limit, inside)


LOAD_SOLVERS = {"force": _solve_forces, "indentation": _solve_indentations, "half_angle": _solve_half_angles}
"""Solver of each kind of load by its name."""


_MAX_TILT_STEPS = 30
_POLE_TILT = 1e-6  # rad: tilt of an axial load that still defines a meridian


def edge_margins(states: ContactStates | ContactSummaries) -> Numbers:
    """Compute the smallest angles in rad from the edges of contacts to the end of the bore: (contacts,).

    A contact that reaches the end has a negative margin. Its size is the rotation of the load, or of a prescribed
    displacement, back towards the dome until the contact just touches the end.
    """
    margins = states.edge_margin.copy()
    cut_indices = numpy.flatnonzero((states.edge_loaded == 1) & states.converged)
    if len(cut_indices):
        rotation = _rim_contact_tilts(states, cut_indices) - polar_angle(states.axes[cut_indices].T)
        margins[cut_indices] = numpy.minimum(rotation, 0.0)
    return margins


def _rim_contact_tilts(states: ContactStates | ContactSummaries, cut_indices: Numbers) -> Numbers:
    """Compute the tilts of the loads in rad at which the contacts `cut_indices` just touch the end of the bore."""
    x, y, _ = states.axes[cut_indices].T
    worn = bool(states.bore.gap.depth.any())  # otherwise all meridians are the same
    azimuth = numpy.arctan2(y, x) if worn else 0.0 * x
    rows, group = numpy.unique(numpy.stack([states.load[cut_indices], azimuth]), axis=1, return_inverse=True)
    group, tilt, level = group.ravel(), polar_angle(states.axes[cut_indices].T), states.rim_level[cut_indices]
    smallest = numpy.array([numpy.flatnonzero(group == i)[tilt[group == i].argmin()] for i in range(rows.shape[1])])
    load, azimuth = rows
    tilts = numpy.full(len(load), numpy.nan) if worn else _read_curve(states, load)
    unknown = numpy.isnan(tilts)
    if unknown.any():
        solve = _interpolate_rim_contact if not worn and load[0] > 0 else _solve_rim_contact
        values = (array[unknown] for array in (load, azimuth, tilt[smallest], level[smallest]))
        tilts[unknown] = solve(states, *values)
    return tilts[group]


def _read_curve(states: ContactStates | ContactSummaries, load: Numbers) -> Numbers:
    """Read the tilts of loads in rad from the curve of an unworn bore; NaN where it has none."""
    bore, make_curve = states.bore, states.rim_curve
    if make_curve is None or bore.gap.clearance <= 0 or coarser_lanes(bore) is None:
        return numpy.full(len(load), numpy.nan)
    grid = bore.compliance.grid
    softness = float(states.edges.compliance[0, 0] / numpy.diff(grid.edges)[0])
    points = cached_rim_points(bore.compliance, softness, states.edges.inset)
    return make_curve(points, grid.reach, bore.gap.clearance, bore.gap.socket_radius).interpolate(load)


_MAX_RIM_NODES = 8  # number of loads from which the tilts of all others at first rim contact are interpolated
_MIN_NODE_DISTANCE = 1e-3  # difference of ln load below which two loads need not both be solved


def _interpolate_rim_contact(
    states: ContactStates | ContactSummaries, load: Numbers, azimuth: Numbers, high: Numbers, high_level: Numbers
) -> Numbers:
    """Find the tilts of `_solve_rim_contact` by a spline in ln load; all are solved if some fill the bore."""
    positions, nodes = numpy.log(load), sorted({0, len(load) - 1})
    while len(nodes) < min(_MAX_RIM_NODES, len(load)):  # add the load that is farthest from the nearest node
        distance = abs(positions[:, None] - positions[nodes]).min(axis=1)
        if distance.max() < _MIN_NODE_DISTANCE:
            break
        nodes.append(int(distance.argmax()))
    nodes.sort()
    solved = _solve_rim_contact(states, load[nodes], azimuth[nodes], high[nodes], high_level[nodes])
    if len(nodes) == len(load):
        return solved
    if not (solved > 0).all():
        return _solve_rim_contact(states, load, azimuth, high, high_level)
    return RimCurve(log_load=positions[nodes], tilt=solved).interpolate(load)


def _solve_rim_contact(
    states: ContactStates | ContactSummaries, load: Numbers, azimuth: Numbers, high: Numbers, high_level: Numbers
) -> Numbers:
    """Find the tilts in rad at which the level at the rim is 0, by the Illinois method.

    The rim is loaded at the tilts `high` in rad, with the levels `high_level` in mm.
    """

    def solve_tilted(indices: Numbers, tilt: Numbers) -> ContactStates:
        axes = unit_vectors(tilt, azimuth[indices]).T
        return states.solve(states.bore, load[indices], axes, states.edges)

    indices, low = numpy.arange(len(load)), numpy.full(len(load), _POLE_TILT)
    axial = solve_tilted(indices, low)
    filled = ~axial.equilibrium.converged | (axial.edge_loaded == 1)
    low_level, high_level, root = axial.rim_level, high_level.copy(), low.copy()
    margin = axial.edge_margin
    guess = low + margin  # first touch of a rigid rim
    active, previous_free = indices[~filled & (high > low)], numpy.full(len(load), -1)
    for _ in range(_MAX_TILT_STEPS):
        if not len(active):
            break
        below, above = low_level[active], high_level[active]
        tilt = (low[active] * above - high[active] * below) / (above - below)
        tilt = numpy.where(guess[active] < high[active], guess[active], tilt)  # excludes NaN and infinity
        trial = solve_tilted(active, tilt)
        level, trial_margin = trial.rim_level, trial.edge_margin
        with numpy.errstate(divide="ignore", invalid="ignore"):
            secant = tilt + trial_margin * (tilt - low[active]) / (margin[active] - trial_margin)
        free = level <= 0
        factor = numpy.where(free == previous_free[active], 0.5, 1.0)  # halves an end that stays twice (Illinois)
        high_level[active] = numpy.where(free, factor * above, level)
        low_level[active] = numpy.where(free, level, factor * below)
        previous_free[active] = free
        # margins are convex in the tilt: their secant stays on the free side
        guess[active] = numpy.where(free, secant, numpy.inf)
        margin[active] = numpy.where(free, trial_margin, margin[active])
        low[active], high[active] = numpy.where(free, tilt, low[active]), numpy.where(free, high[active], tilt)
        below, above = low_level[active], high_level[active]
        interpolated = (low[active] * above - high[active] * below) / (above - below)
        touching = numpy.minimum(tilt + trial_margin, high[active])
        root[active] = numpy.where(free & (trial_margin < TILT_TOLERANCE), touching, interpolated)
        active = active[abs(root[active] - tilt) > TILT_TOLERANCE]
    # a contact that fills the bore has the angle by which its undeformed overlap extends beyond, as a negative tilt
    distance = numpy.linalg.norm(axial.equilibrium.displacement, axis=1)
    cosine = states.bore.gap.clearance / numpy.where(distance > 0, distance, 1e-300)
    overhang = states.bore.compliance.grid.reach - numpy.arccos(numpy.clip(cosine, -1.0, 1.0))
    return numpy.where(filled, numpy.minimum(overhang, -_POLE_TILT), root)


_BLOCK_LOADS = 512  # number of loads whose fields are in memory at once while summaries are computed
_FIELD_COPIES = 4  # number of fields per load at the peak: pressures, their copies in the solver, and levels
_SUMMARY_NUMBERS = 100  # number of values per load at the peak of a summary


def check_contact_memory(*shapes: tuple[int, ...]) -> None:
    """Raise ValueError unless the numbers of all contacts of these loads and directions fit into the memory."""
    try:
        count = math.prod(numpy.broadcast_shapes(*shapes))
    except ValueError:  # refused elsewhere
        return
    check_memory(f"{count_text(count)} contacts", 8 * _SUMMARY_NUMBERS * count)


KeepFunction = Callable[[LoadSolver, BoreContact, Numbers, Numbers, EdgeRelation], "ContactStates | ContactSummaries"]
"""Function from a load solver and its arguments to contacts with their fields or to their summaries."""


def _keep_fields(
    solve: LoadSolver, bore: BoreContact, load: Numbers, axes: Numbers, edges: EdgeRelation
) -> ContactStates:
    subject = f'pressure fields of {count_text(len(load))} contacts (none with keep="summary")'
    check_memory(subject, _field_bytes(bore, len(load)))
    return solve(bore, load, axes, edges)


def _keep_summary(
    solve: LoadSolver, bore: BoreContact, load: Numbers, axes: Numbers, edges: EdgeRelation
) -> ContactSummaries:
    """Solve the loads block by block, and keep only the numbers of each contact."""
    size = 8 * _SUMMARY_NUMBERS * len(load) + _field_bytes(bore, min(len(load), _BLOCK_LOADS))
    check_memory(f"summaries of {count_text(len(load))} contacts", size)
    starts = range(0, max(len(load), 1), _BLOCK_LOADS)
    return summarise(solve(bore, load[i : i + _BLOCK_LOADS], axes[i : i + _BLOCK_LOADS], edges) for i in starts)


def _field_bytes(bore: BoreContact, count: int) -> int:
    grid = bore.compliance.grid
    return 8 * _FIELD_COPIES * grid.rings * grid.meridians * count


KEEP_FUNCTIONS: dict[str, KeepFunction] = {"fields": _keep_fields, "summary": _keep_summary}
"""Functions that solve loads, by the value of `keep`."""
