"""Compliance of bore and ball: springs, edges and cache, and ring matrices with their derivatives."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import ball_of
from ballsocket.elasticity.finite_elements.harmonics import Harmonics, socket_harmonics
from ballsocket.elasticity.finite_elements.mesh import socket_shape
from ballsocket.elasticity.off_axis.compliance import make_compliance
from ballsocket.elasticity.off_axis.grid import even_grid, graded_grid
from ballsocket.elasticity.off_axis.ring_matrices import cup_rings, interpolate_harmonics, liner_numbers, vary_liner
from ballsocket.elasticity.off_axis.surfaces import elastic_edges, spring_edges

from ...joints import HIP
from .shapes import RIGID

BORE = even_grid(pi / 2, radians(3.6))
CUP = bs.Cup()


def test_springs_have_their_modulus_with_and_without_a_ball():
    modulus, grid = bs.hess_forsbach(RIGID), graded_grid(pi, radians(4.0))
    assert make_compliance(bs.Springs(), RIGID, CUP, grid).uniform_stiffness == pytest.approx(modulus)
    ball = float(ball_of(HIP).compliance([0])[0])
    stiffness = make_compliance(bs.Springs(), HIP, CUP, grid).uniform_stiffness
    assert stiffness == pytest.approx(1 / (1 / bs.hess_forsbach(HIP) + ball), rel=1e-4)


@pytest.mark.parametrize("scale", [0.7, 1.0, 1.9])
def test_bores_of_the_same_shape_share_their_matrices(monkeypatch, scale):
    """The shape is that of a bore of radius 1: neither the clearance nor the scale nor the modulus is part of it."""
    grid = graded_grid(CUP.rim, radians(12.0))
    first = cup_rings(HIP, CUP, grid)
    monkeypatch.setattr(Harmonics, "ring_compliance", None)
    bore = scale * HIP.socket_radius
    joint = HIP.replace(ball_radius=bore - 0.2, clearance=0.2, liner_thickness=scale * HIP.liner_thickness)
    softer = replace(joint, liner=replace(HIP.liner, young=HIP.liner.young / 2))
    np.testing.assert_allclose(cup_rings(softer, CUP, grid), 2 * scale * first, rtol=1e-12)


def test_edges_have_the_combined_modulus_and_levels_that_are_minus_the_gap_outside_the_contact():
    relation = elastic_edges(HIP, BORE, bounded=True)
    softness = sum((1 - body.poisson**2) / body.young for body in (HIP.liner, HIP.ball))
    width = radians(90.0) / BORE.rings * HIP.socket_radius
    assert relation.compliance == pytest.approx(np.full((BORE.rings, 1), 1.5 * width * softness))
    rigid = elastic_edges(RIGID, BORE, bounded=False)
    assert rigid.compliance == pytest.approx(1.5 * width * (1 - HIP.liner.poisson**2) / HIP.liner.young)
    assert relation.inset == rigid.inset == pytest.approx(0.113)
    assert (relation.bounded, rigid.bounded) == (True, False)
    assert bs.Springs().edges(RIGID, CUP, BORE).compliance == pytest.approx(1 / bs.hess_forsbach(RIGID))
    relation = spring_edges(50.0, BORE)
    pressure, gap = np.zeros((1, BORE.rings, BORE.meridians)), np.full((1, BORE.rings, BORE.meridians), 0.3)
    pressure[0, 0], gap[0, 1] = 10.0, -0.1
    levels = relation.levels(pressure, gap)[0]
    assert levels[0] == pytest.approx(0.2)
    assert levels[1] == pytest.approx(0.0)
    assert levels[2] == pytest.approx(-0.3)
    assert (relation.inset, relation.bounded) == (0.0, True)


@pytest.mark.parametrize(
    ("surface", "chamfer", "bounded"),
    [(bs.RealCup(), 0.0, True), (bs.RealCup(), 1.0, False), (bs.ClosedShell(), 0.0, False), (bs.Springs(), 1.0, True)],
)
def test_pressure_at_the_rim_is_bounded_on_springs_and_at_a_real_rim_without_a_chamfer(surface, chamfer, bounded):
    assert surface.edges(RIGID, bs.Cup(chamfer=chamfer), BORE).bounded is bounded


# --- ring matrices, and their derivatives by the liner's numbers ---


def test_interpolated_harmonics_are_as_accurate_as_computed_ones():
    rings = graded_grid(pi / 2, radians(4.0))
    meridian = socket_harmonics(socket_shape(HIP, CUP), rings.edges)
    exact = meridian.ring_compliance(rings.edges, range(rings.max_harmonic + 1))
    interpolated = interpolate_harmonics(lambda m: meridian.ring_compliance(rings.edges, m), rings.max_harmonic)
    diagonal = np.sqrt(np.einsum("mii->mi", exact))
    assert (abs(interpolated - exact) / (diagonal[:, :, None] * diagonal[:, None, :])).max() < 1e-5


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


NARROW = bs.Cup(arc_of_cover=radians(170.0))
GRID = even_grid(NARROW.rim, radians(12.0))


@pytest.mark.parametrize("surface", [bs.ClosedShell(), bs.RealCup()])
def test_slopes_are_the_derivatives_of_ring_matrices(surface):
    joint = HIP.replace(backing=[bs.Layer(thickness=3.0, material=bs.CANCELLOUS_BONE)])
    numbers = liner_numbers(joint)
    steps = 1e-4 * numbers
    low, high = (
        np.stack([surface.rings(vary_liner(joint, numbers + sign * row), NARROW, GRID) for row in np.diag(steps)])
        for sign in (-1, 1)
    )
    slopes, expected = surface.ring_slopes(joint, NARROW, GRID), (high - low) / (2 * steps[:, None, None, None])
    for slope, difference in zip(slopes, expected, strict=True):
        assert slope == pytest.approx(difference, abs=1e-7 * abs(difference).max())


@pytest.mark.long
def test_an_infinite_liner_has_no_slope_by_thickness():
    massive = HIP.replace(liner_thickness=float("inf"))
    for surface in (bs.ClosedShell(), bs.RealCup()):
        by_young, by_poisson, by_thickness = surface.ring_slopes(massive, NARROW, GRID)
        assert not by_thickness.any()
        assert np.isfinite(by_poisson).all()
        assert (np.einsum("mii->mi", by_young) < 0).all()
