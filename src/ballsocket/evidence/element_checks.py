"""What the elements reproduce exactly, and how fast they converge: uniform strain, a sphere under pressure."""

from __future__ import annotations

import numpy

from ..core.arrays import Numbers
from ..elasticity.finite_elements.elasticity import ElasticBlock
from ..elasticity.finite_elements.mesh import Block, mesh_block

INNER, OUTER = 1.0, 1.4
"""Radii of the sphere."""


def a_block(order: int, elements: int = 6, poisson: float = 0.3, end: float = numpy.pi / 2) -> ElasticBlock:
    """A thick shell of Young's modulus 1, from the axis to a polar angle, `elements` through its wall."""
    angle, radius = numpy.linspace(0.0, end, 2 * elements + 1), numpy.linspace(INNER, OUTER, elements + 1)
    return ElasticBlock(block=mesh_block(angle, [radius], order), young=numpy.ones(1), poisson=numpy.array([poisson]))


def polar(elastic: ElasticBlock, across: Numbers, along: Numbers) -> Numbers:
    """u_φ and u_r, unknown by unknown, of a displacement in ρ and z at the nodes."""
    phi = numpy.repeat(elastic.block.angle, elastic.block.radius.shape[1])
    sides = across * numpy.cos(phi) - along * numpy.sin(phi), across * numpy.sin(phi) + along * numpy.cos(phi)
    return numpy.stack(sides, -1).ravel()


def strain_energy_error(order: int) -> float:
    """The patch test: the relative error of the energy of u_ρ = a ρ, u_z = b z in the meshed volume."""
    end, a, b, nu = 1.1, 0.3, -0.2, 0.3
    elastic = a_block(order, end=end, poisson=nu)
    rho, z = elastic.block.nodes
    moved = polar(elastic, a * rho, b * z)
    G, K = 1 / (2 * (1 + nu)), 1 / (3 * (1 - 2 * nu))
    trace = 2 * a + b
    density = G * (2 * a * a + b * b - trace**2 / 3) + K * trace**2 / 2
    volume = 2 * numpy.pi / 3 * (OUTER**3 - INNER**3) * (1 - numpy.cos(end))
    return float(abs(moved @ (elastic.stiffness_matrix() @ moved) / 2 / (density * volume) - 1))


def thick_sphere_error(order: int, elements: int, poisson: float) -> float:
    """The error of the bore's radial displacement under pressure in the mean over the area; outside fixed.

    Against Bartel's modulus K_B = E/R2 (2(1-2ν) + (1+ν)k³)/((1+ν)(1-2ν)(1-k³)), k = R2/b.
    """
    from scipy.sparse.linalg import spsolve

    elastic = a_block(order, elements, poisson)
    mesh = elastic.block
    held = numpy.zeros(2 * mesh.number.size, dtype=bool)
    held[2 * mesh.number[[0, -1]]] = True  # the axis, and the plane of symmetry
    held[2 * mesh.number[:, -1]] = held[2 * mesh.number[:, -1] + 1] = True
    moved = numpy.zeros(len(held))
    moved[~held] = spsolve(elastic.stiffness_matrix()[~held][:, ~held], pressed(mesh)[~held])
    k = INNER / OUTER
    modulus = (2 * (1 - 2 * poisson) + (1 + poisson) * k**3) / ((1 + poisson) * (1 - 2 * poisson) * (1 - k**3))
    error = moved[2 * mesh.number[:, 0] + 1] * modulus - 1
    return float(numpy.sqrt(numpy.average(error**2, weights=numpy.sin(mesh.angle))))


def pressed(mesh: Block) -> Numbers:
    """Forces of a unit pressure on the elements of the bore, along their own edges, as unknowns u_φ and u_r."""
    x, w = numpy.polynomial.legendre.leggauss(4)
    if mesh.order == 1:
        N, slope = numpy.stack([1 - x, 1 + x]) / 2, numpy.stack([-0.5 + 0 * x, 0.5 + 0 * x])
    else:
        N = numpy.stack([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2])
        slope = numpy.stack([x - 0.5, -2 * x, x + 0.5])
    across, along = numpy.zeros(mesh.number.size), numpy.zeros(mesh.number.size)
    for first in range(0, len(mesh.angle) - 1, mesh.order):
        nodes = mesh.number[first : first + mesh.order + 1, 0]
        rho, z = mesh.nodes[:, nodes]
        ring = 2 * numpy.pi * (rho @ N) * w
        across[nodes] += N @ (ring * -(z @ slope))
        along[nodes] += N @ (ring * (rho @ slope))
    return polar(ElasticBlock(block=mesh, young=numpy.ones(1), poisson=numpy.zeros(1)), across, along)
