"""Compliance matrices between rings on a sphere and on a real cup, and their derivatives by the numbers of the liner.

A matrix gives the displacement of one ring under a unit pressure on another, for each harmonic m. Bodies are a sphere
with a modal compliance (the ball, a closed shell) or a cup in finite elements of its meridian.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from math import pi
from typing import TYPE_CHECKING

import numpy

from ...core.arrays import Array, Numbers, gauss_legendre
from ...core.storage.atomic_files import cached_array, is_array_cached
from ...problem import Joint
from ...problem.cup import Cup
from ..finite_elements.mesh import SocketShape, socket_shape

if TYPE_CHECKING:
    from ..finite_elements.harmonics import Harmonics
    from .grid import Grid


_MAX_CONSECUTIVE_HARMONIC = 6  # largest m up to which every harmonic is computed
_STEP_GROWTH = 1.15  # ratio of the steps between the harmonics that are computed beyond

_MODES_PER_RING = 6  # multiple of the number of modes that the rings resolve
_POINTS_PER_RING = 8  # Gauss points

ModalCompliance = Callable[[Numbers], Numbers]
"""Function from degrees n to modal compliances c_n in mm/MPa."""


def interpolate_harmonics(compute: Callable[[Numbers], Numbers], max_harmonic: int) -> Numbers:
    """Compute the matrices of all harmonics m up to `max_harmonic`, most of them by a spline in ln m.

    `compute` computes the matrices (m, rings, rings) of an array of harmonics. The error is within 2e-6 of the
    diagonal.
    """
    from scipy.interpolate import make_interp_spline  # slow to import

    orders, step = list(range(min(_MAX_CONSECUTIVE_HARMONIC, max_harmonic) + 1)), 1.0
    while orders[-1] < max_harmonic:  # high ones at growing steps
        step *= _STEP_GROWTH
        orders.append(min(max_harmonic, orders[-1] + max(1, round(step))))
    nodes = numpy.array(orders)
    exact = compute(nodes)
    harmonics = numpy.arange(max_harmonic + 1)
    scaled = exact[2:] * (nodes[2:] + 1.0)[:, None, None]  # compliances fall like 1/m
    spline = make_interp_spline(numpy.log(nodes[2:] + 1.0), scaled, k=5)
    interpolated = spline(numpy.log(harmonics[2:] + 1.0)) / (harmonics[2:] + 1.0)[:, None, None]
    return numpy.concatenate([exact[:2], interpolated])


def sphere_rings(compliance: ModalCompliance, grid: Grid) -> Numbers:
    """Compute the compliance matrices between rings on a solid ball or a closed shell: (m, rings, rings).

    They are ∫ u dA in mm/MPa over the ring of the row, on a unit sphere, per unit pressure on the ring of the column.
    The mean over a cell's width is not applied.
    """
    count = int(_MODES_PER_RING * pi / grid.width)
    modal = compliance(numpy.arange(count + 1))
    limit = modal[-1]  # compliance of all higher modes

    def compute_harmonics(m: Numbers) -> Numbers:
        integrals = legendre_ring_integrals(grid, m, count)
        return 2 * pi * (integrals * (modal - limit)) @ integrals.swapaxes(1, 2) + limit * numpy.diag(grid.ring_areas)

    return interpolate_harmonics(compute_harmonics, grid.max_harmonic)


def legendre_ring_integrals(grid: Grid, m: Numbers, max_degree: int) -> Numbers:
    """Integrate the normalised Legendre functions P_n^m times sin θ over each ring: (m, rings, degrees n)."""
    nodes, weights = (numpy.array(rule) for rule in gauss_legendre(_POINTS_PER_RING))
    width = numpy.diff(grid.edges)[:, None]
    angle = (grid.edges[:-1, None] + width * nodes).ravel()
    measure = (width * weights).ravel() * numpy.sin(angle)
    integrals = numpy.zeros((len(m), grid.rings, max_degree + 1))
    previous, current = numpy.zeros((2, len(m), angle.size))
    start, rows = numpy.sqrt(0.5) * numpy.ones(angle.size), {int(order): i for i, order in enumerate(m)}
    for n in range(max_degree + 1):
        previous, current = current, _next_legendre(n, m[:, None], previous, current, numpy.cos(angle))
        if n in rows:
            current[rows[n]] = start
        start = start * numpy.sqrt((2 * n + 3) / (2 * n + 2)) * numpy.sin(angle)
        integrals[..., n] = (current * measure).reshape(len(m), grid.rings, _POINTS_PER_RING).sum(axis=-1)
    return integrals


def _next_legendre(n: int, m: Numbers, before_last: Numbers, last: Numbers, x: Numbers) -> Numbers:
    """Compute the associated Legendre functions of degree n from those of n - 2 and n - 1; 0 where m is not below n."""
    low = m < n
    square = numpy.where(low, n * n - m * m, 1)
    rise = numpy.sqrt(numpy.where(low, (4 * n * n - 1) / square, 0.0))
    drop = numpy.sqrt(numpy.where(low, (2 * n + 1) * numpy.maximum((n - 1) ** 2 - m * m, 0) / square, 0.0))
    return rise * x * last - drop / numpy.sqrt(max(2 * n - 3, 1)) * before_last


def cup_rings(joint: Joint, cup: Cup, grid: Grid) -> Numbers:
    """Compute the compliance matrices between rings of a cup by finite elements: (m, rings, rings).

    They are ∫ u dA in mm/MPa on a unit sphere.

    Raises ValueError: a cup that does not fit this joint.
    """
    from ..finite_elements.solver import check_cup  # slow to import

    check_cup(cup, joint)
    return _unit_cup_rings(*_unit_inputs(joint, cup, grid)) * _bore_scale(joint)


def _bore_scale(joint: Joint) -> float:
    """Return the factor from a bore of radius 1 in a liner of modulus 1 to that of a joint, in mm/MPa."""
    return float(joint.socket_radius) / float(joint.liner.young)


def are_cup_rings_cached(joint: Joint, cup: Cup, grid: Grid) -> bool:
    """Return True if the compliance matrices of `cup_rings` are cached on disk."""
    return is_array_cached(_unit_inputs(joint, cup, grid))


def _unit_inputs(joint: Joint, cup: Cup, grid: Grid) -> tuple[SocketShape, tuple[float, ...], int]:
    """Return the inputs of the matrices for a bore of radius 1 and a liner of modulus 1."""
    return socket_shape(joint, cup), tuple(grid.edges.tolist()), grid.max_harmonic


@lru_cache(maxsize=16)
def _unit_cup_rings(shape: SocketShape, edges: tuple[float, ...], max_harmonic: int) -> Numbers:
    rings = numpy.array(edges)

    def compute_matrices() -> Numbers:
        from ..finite_elements.harmonics import socket_harmonics  # slow to import

        meridian = socket_harmonics(shape, rings)
        return interpolate_harmonics(lambda m: meridian.ring_compliance(rings, m), max_harmonic)

    return cached_array((shape, edges, max_harmonic), compute_matrices)


_RELATIVE_STEP = 1e-5
"""Step of the central differences of the liner's numbers, as a fraction of Young's modulus, ½ - ν or the thickness."""


def vary_liner(joint: Joint, liner: Array) -> Joint:
    """Return a joint with another liner: modulus (MPa), Poisson's ratio, thickness (mm). Nothing is checked."""
    radius, clearance, _, _, _, *others = joint.numbers()
    young, poisson, thickness = liner
    return joint.with_numbers((radius, clearance, thickness, young, poisson, *others))


def liner_numbers(joint: Joint) -> Numbers:
    """Return Young's modulus in MPa, Poisson's ratio and thickness in mm of a joint's liner: (3,)."""
    return numpy.array([joint.liner.young, joint.liner.poisson, joint.liner_thickness], dtype=float)


def liner_steps(joint: Joint) -> list[tuple[float, Joint, Joint]]:
    """Return a step for each number of the liner, with the joints where it is smaller and larger by this step."""
    numbers = liner_numbers(joint)
    ranges = numpy.array([numbers[0], 0.5 - numbers[1], numbers[2]])
    steps = numpy.diag(numpy.where(numpy.isfinite(ranges), _RELATIVE_STEP * ranges, 1.0))
    return [(float(step.max()), vary_liner(joint, numbers - step), vary_liner(joint, numbers + step)) for step in steps]


def difference_rings(rings: Callable[[Joint], Numbers], joint: Joint) -> Numbers:
    """Compute derivatives of ring matrices by the liner's numbers, by central differences: (3, m, rings, rings).

    It is meant for closed formulas; the relative error is about 1e-9.
    """
    return numpy.stack([(rings(high) - rings(low)) / (2 * step) for step, low, high in liner_steps(joint)])


def cup_ring_slopes(joint: Joint, cup: Cup, grid: Grid) -> Numbers:
    """Compute or load derivatives of `cup_rings` by the numbers of the liner: (3, m, rings, rings).

    The mesh moves with the thickness and keeps its elements. Only the element matrices are differences of 1e-5, whose
    relative error is about 1e-9. One factorisation of the stiffness for each harmonic serves all three numbers.
    """
    key = ("slopes", joint.numbers(), *_unit_inputs(joint, cup, grid))
    return cached_array(key, lambda: _compute_cup_ring_slopes(joint, cup, grid))


def _compute_cup_ring_slopes(joint: Joint, cup: Cup, grid: Grid) -> Numbers:
    from ..finite_elements.harmonics import socket_harmonics  # slow to import

    @cache
    def mesh(shape: SocketShape) -> Harmonics:
        return socket_harmonics(shape, grid.edges)

    middle, stiffness_slopes = mesh(socket_shape(joint, cup)), []
    for step, *joints in liner_steps(joint):
        low, high = (mesh(socket_shape(varied, cup)) for varied in joints)
        meridians = {-step: low, 0.0: middle, step: high}
        alike = {at: meridian for at, meridian in meridians.items() if meridian.has_mesh_of(middle)}
        (first, before), *_, (last, after) = alike.items()
        pairs = zip(before.stiffness_powers, after.stiffness_powers, strict=True)
        constant, linear, quadratic = ((above - below) / (last - first) for below, above in pairs)
        stiffness_slopes.append((constant, linear, quadratic))
    rings = grid.rings

    def compute_slopes(m: Numbers) -> Numbers:  # one below the other: (m, 3 rings, rings)
        slopes = middle.ring_compliance_slopes(grid.edges, m, stiffness_slopes)
        return slopes.swapaxes(0, 1).reshape(len(m), 3 * rings, rings)

    by_harmonic = interpolate_harmonics(compute_slopes, grid.max_harmonic)
    slopes = by_harmonic.reshape(-1, 3, rings, rings).swapaxes(0, 1) * _bore_scale(joint)
    slopes[0] -= cup_rings(joint, cup, grid) / float(joint.liner.young)
    return slopes
