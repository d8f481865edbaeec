"""Ring matrices of spheres and cups, and their interpolation in the harmonics."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import ElasticBall, socket_of
from ballsocket.elasticity.finite_elements.harmonics import socket_harmonics
from ballsocket.elasticity.finite_elements.mesh import socket_shape
from ballsocket.elasticity.off_axis.compliance import AxisymmetricOperator
from ballsocket.elasticity.off_axis.grid import graded_grid
from ballsocket.elasticity.off_axis.ring_matrices import _harmonic_nodes as harmonic_nodes
from ballsocket.elasticity.off_axis.ring_matrices import interpolate_harmonics, legendre_ring_integrals, sphere_rings

from ...joints import HIP

RINGS = graded_grid(pi / 2, radians(4.0))


def test_legendre_integrals_are_orthonormal_over_a_sphere():
    sphere = graded_grid(pi, radians(2.0))
    integrals = legendre_ring_integrals(sphere, np.array([0, 1, 5]), 12)
    width = 2 * np.sin(np.diff(sphere.edges) / 2) * np.sin(sphere.polar)
    products = np.einsum("min,i,mik->mnk", integrals, 1 / width, integrals)
    for m, product in zip((0, 1, 5), products, strict=True):
        assert product[m:, m:] == pytest.approx(np.eye(13 - m), abs=0.02)
        assert not product[:m].any()


def test_uniform_pressure_displaces_a_closed_shell_by_its_first_mode():
    """Every point of a sphere under uniform pressure moves by c_0."""
    sphere, shell = graded_grid(pi, radians(4.0)), socket_of(HIP)
    moved = AxisymmetricOperator(matrices=sphere.average_over_cells(sphere_rings(shell.compliance, sphere)))(
        np.ones((1, sphere.rings, sphere.meridians))
    )
    assert moved == pytest.approx(float(shell.compliance([0])[0]), rel=1e-5)


def test_interpolated_harmonics_are_as_accurate_as_computed_ones():
    shape = socket_shape(HIP, bs.Cup())
    meridian = socket_harmonics(shape, RINGS.edges)
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
    bone = bs.Layer(thickness=0.8697383926236849, material=bs.CANCELLOUS_BONE)
    liner = bs.Material(young=960.4975021952781, poisson=0.0)
    joint = bs.Joint(
        ball_radius=3.566844822075002,
        clearance=0.016782901326375416,
        liner_thickness=0.6989930671383167,
        liner=liner,
        backing=(bone,),
    )
    cup = bs.Cup(arc_of_cover=3.1234503824406263, interface=bs.Interface.SLIDING)
    edges = graded_grid(cup.rim, 0.0927052231794753).edges
    matrices = socket_harmonics(socket_shape(joint, cup), edges).ring_compliance(edges, [0, 1, 2])
    largest = [np.linalg.eigvalsh(matrix)[[0, -1]] for matrix in matrices]
    assert np.min(largest) > 0
    assert largest[1][1] == pytest.approx(largest[2][1], rel=0.1)


def test_elements_and_modes_of_a_closed_shell_agree_in_low_harmonics():
    shell = bs.Cup(arc_of_cover=radians(340.0))
    rings = graded_grid(radians(170.0), radians(4.0))
    elements = socket_harmonics(socket_shape(HIP, shell), rings.edges).ring_compliance(rings.edges, [0, 1, 2])
    modes = sphere_rings(socket_of(HIP).compliance, rings)[:3] / (HIP.socket_radius / HIP.liner.young)
    inner = slice(2, rings.rings // 2)  # one element spans the pole
    assert elements[:, inner, inner] == pytest.approx(modes[:, inner, inner], rel=0.04, abs=5e-6)


def test_cosine_pressure_does_not_deform_a_ball():
    """Mode n = 1 is the translation of a ball, which is excluded from its compliance."""
    sphere = graded_grid(pi, radians(4.0))
    rings = sphere_rings(ElasticBall(radius=18.0, young=1000.0, poisson=0.3).compliance, sphere)
    cosine = np.broadcast_to(np.cos(sphere.polar)[:, None], (1, sphere.rings, sphere.meridians))
    moved = AxisymmetricOperator(matrices=sphere.average_over_cells(rings))(cosine)
    assert abs(moved).max() < 1e-2 * 18.0 / 1000.0
