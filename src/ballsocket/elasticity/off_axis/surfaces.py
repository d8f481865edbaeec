"""Surfaces of the socket: springs, a closed shell, or a real cup; their compliance and the edge of a contact on them.

The compliance matrices between rings give the displacement of one ring under a unit pressure on another, for each
harmonic m. Bodies are a sphere with a modal compliance (the ball, a closed shell) or a cup in finite elements of its
meridian.

The edge of a contact is the line of zero pressure and zero gap. It runs between the cells.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy

from ...core.arrays import Numbers, gauss_legendre
from ...core.storage.atomic_files import cached_array, is_array_cached
from ...models.modulus import Modulus, as_modulus, hess_forsbach
from ...problem import Joint
from ...problem.cup import Cup
from ..exact.modes import socket_of
from ..finite_elements.mesh import SocketShape, socket_shape

if TYPE_CHECKING:
    from .grid import Grid

_MAX_CONSECUTIVE_HARMONIC = 6
"""Largest m up to which every harmonic is computed."""

_STEP_GROWTH = 1.15
"""Ratio of the steps between the harmonics that are computed beyond."""

_MODES_PER_RING = 6  # multiple of the number of modes that the rings resolve
_POINTS_PER_RING = 8  # Gauss points

ModalCompliance = Callable[[Numbers], Numbers]
"""Function from degrees n to modal compliances c_n in mm/MPa."""


def interpolate_harmonics(compute: Callable[[Numbers], Numbers], max_harmonic: int) -> Numbers:
    """Compute the matrices of all harmonics m up to `max_harmonic`, most of them by a spline in ln m.

    The error is within 2e-6 of the diagonal.

    Parameters
    ----------
    compute : function
        From an array of harmonics m to their matrices (m, rings, rings).
    max_harmonic : int
    """
    from scipy.interpolate import make_interp_spline  # slow to import

    nodes = _harmonic_nodes(max_harmonic)
    exact = compute(nodes)
    harmonics = numpy.arange(max_harmonic + 1)
    scaled = exact[2:] * (nodes[2:] + 1.0)[:, None, None]  # compliances fall like 1/m
    spline = make_interp_spline(numpy.log(nodes[2:] + 1.0), scaled, k=5)
    interpolated = spline(numpy.log(harmonics[2:] + 1.0)) / (harmonics[2:] + 1.0)[:, None, None]
    return numpy.concatenate([exact[:2], interpolated])


def _harmonic_nodes(max_harmonic: int) -> Numbers:
    """Choose the harmonics to compute: all low ones, and high ones at growing steps."""
    nodes, step = list(range(min(_MAX_CONSECUTIVE_HARMONIC, max_harmonic) + 1)), 1.0
    while nodes[-1] < max_harmonic:
        step *= _STEP_GROWTH
        nodes.append(min(max_harmonic, nodes[-1] + max(1, round(step))))
    return numpy.array(nodes)


def sphere_rings(compliance: ModalCompliance, grid: Grid) -> Numbers:
    """Compute the compliance matrices between rings on a solid ball or a closed shell.

    Parameters
    ----------
    compliance : function
        From degrees n to modal compliances in mm/MPa.
    grid : Grid

    Returns
    -------
    array (max_harmonic + 1, rings, rings)
        ∫ u dA in mm/MPa over the ring of the row, on a unit sphere, per unit pressure on the ring of the column. The
        mean over a cell's width is not applied.
    """
    count = int(_MODES_PER_RING * pi / grid.width)
    modal = compliance(numpy.arange(count + 1))
    limit = modal[-1]  # compliance of all higher modes

    def compute_harmonics(m: Numbers) -> Numbers:
        """Compute the compliance matrices between rings for harmonics m."""
        integrals = legendre_ring_integrals(grid, m, count)
        return 2 * pi * (integrals * (modal - limit)) @ integrals.swapaxes(1, 2) + limit * numpy.diag(grid.ring_areas)

    return interpolate_harmonics(compute_harmonics, grid.max_harmonic)


def legendre_ring_integrals(grid: Grid, m: Numbers, max_degree: int) -> Numbers:
    """Integrate the normalised associated Legendre functions P_n^m over each ring: (m, rings, degrees n).

    The integrand is P_n^m sin θ.
    """
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

    Raises
    ------
    ValueError
        A cup that does not fit this joint.
    """
    from ..finite_elements.solver import check_cup  # slow to import

    check_cup(cup, joint)
    unit = _unit_cup_rings(*_unit_inputs(joint, cup, grid))
    return unit * (float(joint.socket_radius) / float(joint.liner.young))


def are_cup_rings_cached(joint: Joint, cup: Cup, grid: Grid) -> bool:
    """Return True if the compliance matrices of `cup_rings` are cached on disk."""
    return is_array_cached(_unit_inputs(joint, cup, grid))


def _unit_inputs(joint: Joint, cup: Cup, grid: Grid) -> tuple[SocketShape, tuple[float, ...], int]:
    """Return the inputs of the matrices for a bore of radius 1 and a liner of modulus 1."""
    return socket_shape(joint, cup), tuple(grid.edges.tolist()), grid.max_harmonic


@lru_cache(maxsize=16)
def _unit_cup_rings(shape: SocketShape, edges: tuple[float, ...], max_harmonic: int) -> Numbers:
    """Compute or load the compliance matrices between rings for a bore of radius 1 and a liner of modulus 1."""
    rings = numpy.array(edges)

    def compute_matrices() -> Numbers:
        """Compute the compliance matrices between rings of all harmonics by finite elements."""
        from ..finite_elements.harmonics import socket_harmonics  # slow to import

        meridian = socket_harmonics(shape, rings)
        return interpolate_harmonics(lambda m: meridian.ring_compliance(rings, m), max_harmonic)

    return cached_array((shape, edges, max_harmonic), compute_matrices)


_ELASTIC_INSET = 0.113
"""Distance from a cell's middle to the contact's edge at the first load of the cell, as a fraction of its width."""

_GAP_TO_PRESSURE = 2 / 3
"""Factor k of the edge between two cells, which balances p w of the last loaded cell and k E* g of the first open cell.

Both constants are fitted to a Hertz line contact on a half-plane in equal cells, at 40 positions of its edge. Their
error of the edge is 0.01 cells.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeRelation:
    """Relation of pressure and gap that locates the edge of a contact between cells.

    Attributes
    ----------
    compliance : array (rings, 1)
        Gap in mm of an open cell that is equivalent to 1 MPa in a loaded cell.
    inset : float
        Distance of the edge inside a cell's middle at the first load of that cell, as a fraction of a ring's width.
    bounded : bool
        True if the pressure stays finite in a contact that reaches the end of the bore.
    """

    compliance: Numbers
    inset: float
    bounded: bool

    def levels(self, pressure: Numbers, gap: Numbers) -> Numbers:
        """Compute levels in mm (..., rings, meridians) from pressures in MPa and gaps in mm.

        A level is positive in loaded cells and minus the gap in open ones.
        """
        return numpy.where(pressure > 0, pressure * self.compliance, -numpy.maximum(gap, 0.0))


def elastic_edges(joint: Joint, grid: Grid, bounded: bool) -> EdgeRelation:
    """Return the relation between pressure and gap near the contact edge of elastic bodies.

    At the distance s from the edge the pressure falls as s^(1/2), and the gap opens as s^(3/2).
    """
    bodies = [joint.liner] if joint.ball is None else [joint.liner, joint.ball]
    softness = sum((1 - float(body.poisson) ** 2) / float(body.young) for body in bodies)  # 1/E*
    width = numpy.diff(grid.edges)[:, None] * float(joint.socket_radius)
    return EdgeRelation(compliance=width * softness / _GAP_TO_PRESSURE, inset=_ELASTIC_INSET, bounded=bounded)


def spring_edges(modulus: float, grid: Grid) -> EdgeRelation:
    """Return the linear relation of pressure and gap near the contact edge on springs of a modulus in MPa/mm."""
    return EdgeRelation(compliance=numpy.full((grid.rings, 1), 1 / modulus), inset=0.0, bounded=True)


class Surface(Protocol):
    """Interface of compliance models of the bore."""

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the compliance matrices between cells for each harmonic m in mm/MPa: (m, rings, rings)."""
        ...

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        """Return the relation between pressure and gap that locates the edge of a contact between cells."""
        ...

    @property
    def edge_exponent(self) -> float:
        """Exponent n of the pressure p ~ s^n at a distance s from the edge of a contact."""
        ...

    @property
    def isotropic(self) -> Surface:
        """Surface with the same compliance about every axis, which differs from this one by smooth displacements."""
        ...


@dataclass(frozen=True, kw_only=True)
class RealCup:
    """Real cup with rim, arc of cover, chamfer and backing layers, by finite elements of its meridian.

    Each harmonic about the cup's axis has one stiffness for all directions of the load. Setting it up takes a second.
    It is cached on disk for each R2/L, ν, arc of cover, chamfer and backing, and scales with Young's modulus.
    """

    edge_exponent: ClassVar[float] = 0.5

    @property
    def isotropic(self) -> ClosedShell:
        """Closed shell of the same layers."""
        return ClosedShell()

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the compliance matrices between cells for each harmonic m in mm/MPa: (m, rings, rings)."""
        return grid.average_over_cells(cup_rings(joint, cup, grid))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        """Return the relation between pressure and gap that locates the edge of a contact between cells."""
        return elastic_edges(joint, grid, bounded=cup.chamfer == 0)


@dataclass(frozen=True, kw_only=True)
class ClosedShell:
    """Closed shell without an opening, as in `Exact`: the rim ends the contact but does not soften the liner."""

    edge_exponent: ClassVar[float] = 0.5

    @property
    def isotropic(self) -> ClosedShell:
        """This surface."""
        return self

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the compliance matrices between cells for each harmonic m in mm/MPa: (m, rings, rings)."""
        return grid.average_over_cells(sphere_rings(socket_of(joint).compliance, grid))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        """Return the relation between pressure and gap that locates the edge of a contact between cells."""
        return elastic_edges(joint, grid, bounded=False)


@dataclass(frozen=True, kw_only=True)
class Springs:
    """Independent radial springs, the foundation of the paper.

    Parameters
    ----------
    modulus : Modulus
        Function from a joint to the foundation modulus K in MPa/mm; the paper's fit by default.
    """

    modulus: Modulus = hess_forsbach

    edge_exponent: ClassVar[float] = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "modulus", as_modulus(self.modulus))

    @property
    def isotropic(self) -> Springs:
        """This surface."""
        return self

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the compliance matrices between cells for each harmonic m in mm/MPa: (m, rings, rings)."""
        diagonal = numpy.eye(grid.rings) / float(self.modulus(joint))
        return numpy.broadcast_to(diagonal, (grid.max_harmonic + 1, *diagonal.shape))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        """Return the relation between pressure and gap that locates the edge of a contact between cells."""
        return spring_edges(float(self.modulus(joint)), grid)
