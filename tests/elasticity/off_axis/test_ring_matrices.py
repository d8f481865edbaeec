"""Ring matrices of spheres and cups: their interpolation in the harmonics, and derivatives by the liner's numbers."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import ElasticBall, socket_of
from ballsocket.elasticity.finite_elements.harmonics import socket_harmonics
from ballsocket.elasticity.finite_elements.mesh import socket_shape
from ballsocket.elasticity.off_axis.compliance import AxisymmetricOperator
from ballsocket.elasticity.off_axis.grid import even_grid, graded_grid
from ballsocket.elasticity.off_axis.ring_matrices import _harmonic_nodes as harmonic_nodes
from ballsocket.elasticity.off_axis.ring_matrices import (
    interpolate_harmonics,
    legendre_ring_integrals,
    liner_numbers,
    sphere_rings,
    vary_liner,
)

from ...joints import HIP

RINGS, SPHERE = graded_grid(pi / 2, radians(4.0)), graded_grid(pi, radians(4.0))


def test_legendre_integrals_are_orthonormal_over_a_sphere():
    sphere = graded_grid(pi, radians(2.0))
    integrals = legendre_ring_integrals(sphere, np.array([0, 1, 5]), 12)
    width = 2 * np.sin(np.diff(sphere.edges) / 2) * np.sin(sphere.polar)
    products = np.einsum("min,i,mik->mnk", integrals, 1 / width, integrals)
    for m, product in zip((0, 1, 5), products, strict=True):
        assert product[m:, m:] == pytest.approx(np.eye(13 - m), abs=0.02)
        assert not product[:m].any()


def displaced_sphere(compliance, pressure):
    """Compute the displacement of a closed bore or a ball by a pressure (rings,) of constant latitude."""
    field = np.broadcast_to(pressure[:, None], (1, SPHERE.rings, SPHERE.meridians))
    return AxisymmetricOperator(matrices=SPHERE.average_over_cells(sphere_rings(compliance, SPHERE)))(field)


def test_uniform_pressure_displaces_a_closed_shell_by_its_first_mode():
    """Every point of a sphere under uniform pressure moves by c_0."""
    shell = socket_of(HIP)
    moved = displaced_sphere(shell.compliance, np.ones(SPHERE.rings))
    assert moved == pytest.approx(float(shell.compliance([0])[0]), rel=1e-5)


def test_cosine_pressure_does_not_deform_a_ball():
    """Mode n = 1 is the translation of a ball, which is excluded from its compliance."""
    ball = ElasticBall(radius=18.0, young=1000.0, poisson=0.3)
    assert abs(displaced_sphere(ball.compliance, np.cos(SPHERE.polar))).max() < 1e-2 * 18.0 / 1000.0


def test_interpolated_harmonics_are_as_accurate_as_computed_ones():
    meridian = socket_harmonics(socket_shape(HIP, bs.Cup()), RINGS.edges)
    exact = meridian.ring_compliance(RINGS.edges, range(RINGS.max_harmonic + 1))
    interpolated = interpolate_harmonics(lambda m: meridian.ring_compliance(RINGS.edges, m), RINGS.max_harmonic)
    diagonal = np.sqrt(np.einsum("mii->mi", exact))
    assert (abs(interpolated - exact) / (diagonal[:, :, None] * diagonal[:, None, :])).max() < 1e-5


def test_low_harmonics_are_all_computed_and_high_ones_at_growing_steps():
    for largest in (0, 3, 6, 7, 12):
        nodes = harmonic_nodes(largest)
        assert nodes[-1] == largest
        assert nodes[: min(largest, 8) + 1].tolist() == list(range(min(largest, 8) + 1))
    steps = np.diff(harmonic_nodes(90))
    assert (np.diff(steps[:-1]) >= 0).all()
    assert steps.max() > 5
    assert len(steps) < 30


def test_sliding_liner_does_not_rotate_in_its_shell():
    """No stiffness and no load acts on this rotation, which rounding alone would decide."""
    joint = bs.Joint(
        ball_radius=3.566844822075002,
        clearance=0.016782901326375416,
        liner_thickness=0.6989930671383167,
        liner=bs.Material(young=960.4975021952781, poisson=0.0),
        backing=(bs.Layer(thickness=0.8697383926236849, material=bs.CANCELLOUS_BONE),),
    )
    cup = bs.Cup(arc_of_cover=3.1234503824406263, interface=bs.Interface.SLIDING)
    edges = graded_grid(cup.rim, 0.0927052231794753).edges
    matrices = socket_harmonics(socket_shape(joint, cup), edges).ring_compliance(edges, [0, 1, 2])
    largest = [np.linalg.eigvalsh(matrix)[[0, -1]] for matrix in matrices]
    assert np.min(largest) > 0
    assert largest[1][1] == pytest.approx(largest[2][1], rel=0.1)


def test_elements_and_modes_of_a_closed_shell_agree_in_low_harmonics():
    rings = graded_grid(radians(170.0), radians(4.0))
    shape = socket_shape(HIP, bs.Cup(arc_of_cover=radians(340.0)))
    elements = socket_harmonics(shape, rings.edges).ring_compliance(rings.edges, [0, 1, 2])
    modes = sphere_rings(socket_of(HIP).compliance, rings)[:3] / (HIP.socket_radius / HIP.liner.young)
    inner = slice(2, rings.rings // 2)  # one element spans the pole
    assert elements[:, inner, inner] == pytest.approx(modes[:, inner, inner], rel=0.04, abs=5e-6)


# --- derivatives by the liner's numbers ---

CUP = bs.Cup(arc_of_cover=radians(170.0))
GRID = even_grid(CUP.rim, radians(12.0))


@pytest.mark.parametrize("surface", [bs.ClosedShell(), bs.RealCup()])
def test_slopes_are_the_derivatives_of_ring_matrices(surface):
    joint = HIP.replace(backing=[bs.Layer(thickness=3.0, material=bs.CANCELLOUS_BONE)])
    numbers = liner_numbers(joint)
    steps = 1e-4 * numbers
    low, high = (
        np.stack([surface.rings(vary_liner(joint, numbers + sign * row), CUP, GRID) for row in np.diag(steps)])
        for sign in (-1, 1)
    )
    slopes, expected = surface.ring_slopes(joint, CUP, GRID), (high - low) / (2 * steps[:, None, None, None])
    for slope, difference in zip(slopes, expected, strict=True):
        assert slope == pytest.approx(difference, abs=1e-7 * abs(difference).max())


@pytest.mark.long
def test_an_infinite_liner_has_no_slope_by_thickness():
    massive = HIP.replace(liner_thickness=float("inf"))
    for surface in (bs.ClosedShell(), bs.RealCup()):
        by_young, by_poisson, by_thickness = surface.ring_slopes(massive, CUP, GRID)
        assert not by_thickness.any()
        assert np.isfinite(by_poisson).all()
        assert (np.einsum("mii->mi", by_young) < 0).all()


@pytest.mark.long
def test_slopes_pass_a_change_of_the_mesh():
    """At some thickness the mesh has one element more; the slopes before and after differ by its error alone."""

    def has_many_elements(thickness):
        shape = socket_shape(HIP.replace(liner_thickness=thickness), CUP)
        return not socket_harmonics(shape, GRID.edges).has_mesh_of(thin)

    thin = socket_harmonics(socket_shape(HIP.replace(liner_thickness=15.0), CUP), GRID.edges)
    low, high = 15.0, 60.0
    assert has_many_elements(high)
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if has_many_elements(middle) else (middle, high)
    slopes = [bs.RealCup().ring_slopes(HIP.replace(liner_thickness=x), CUP, GRID)[2] for x in (low, high)]
    assert slopes[0] == pytest.approx(slopes[1], abs=0.02 * abs(slopes[0]).max())
