"""Rings and harmonics: their areas, and what lies between those that are computed."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import Ball, socket_of
from ballsocket.elasticity.finite_elements.harmonics import socket_harmonics
from ballsocket.elasticity.finite_elements.shapes import socket_shape
from ballsocket.elasticity.off_axis.grid import Turning, grid
from ballsocket.elasticity.off_axis.harmonics import every_harmonic
from ballsocket.elasticity.off_axis.rings_of_modes import modal_rings, ring_shares

from ...joints import HIP

RINGS = grid(pi / 2, radians(4.0))


def test_cells_add_up_to_the_bore():
    whole = grid(radians(140.0), radians(3.0))
    assert whole.areas.sum() * whole.meridians == pytest.approx(2 * pi * (1 - np.cos(radians(140.0))))
    closing = (whole.normals * whole.areas).sum(axis=(1, 2))
    assert closing == pytest.approx([0.0, 0.0, pi * np.sin(radians(140.0)) ** 2], abs=1e-12)


def test_shares_of_modes_are_orthonormal_over_a_whole_sphere():
    whole = grid(pi, radians(2.0))
    shares = ring_shares(whole, np.array([0, 1, 5]), 12)
    width = 2 * np.sin(np.diff(whole.edges) / 2) * np.sin(whole.polar)
    products = np.einsum("min,i,mik->mnk", shares, 1 / width, shares)
    for m, product in zip((0, 1, 5), products, strict=True):
        assert product[m:, m:] == pytest.approx(np.eye(13 - m), abs=0.02)
        assert not product[:m].any()


def test_a_uniform_pressure_does_to_rings_what_it_does_to_a_closed_shell():
    """Rings over the whole sphere under one pressure: every point moves by c_0."""
    whole, shell = grid(pi, radians(4.0)), socket_of(HIP)
    moved = Turning(matrices=whole.averaged(modal_rings(shell.compliance, whole)))(
        np.ones((1, whole.rings, whole.meridians))
    )
    assert moved == pytest.approx(float(shell.compliance([0])[0]), rel=1e-5)


def test_harmonics_between_are_as_good_as_computed_ones():
    shape = socket_shape(HIP, bs.Cup())
    meridian = socket_harmonics(shape, RINGS.edges)
    every = meridian.ring_compliance(RINGS.edges, range(RINGS.degrees + 1))
    between = every_harmonic(lambda some: meridian.ring_compliance(RINGS.edges, some), RINGS.degrees)
    diagonal = np.sqrt(np.einsum("mii->mi", every))
    assert (abs(between - every) / (diagonal[:, :, None] * diagonal[:, None, :])).max() < 1e-5


def test_a_liner_that_slides_does_not_turn_in_its_shell():
    """Nothing holds it, nothing drives it; rounding alone decided what m = 1 made of that."""
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
    edges = grid(cup.rim, 0.0927052231794753).edges
    zero, one, two = socket_harmonics(socket_shape(joint, cup), edges).ring_compliance(edges, [0, 1, 2])
    largest = [np.linalg.eigvalsh(each)[[0, -1]] for each in (zero, one, two)]
    assert np.min(largest) > 0
    assert largest[1][1] == pytest.approx(largest[2][1], rel=0.1)


def test_elements_and_modes_of_a_closed_shell_are_the_same_in_low_harmonics():
    shell = bs.Cup(arc_of_cover=radians(340.0))
    rings = grid(radians(170.0), radians(4.0))
    elements = socket_harmonics(socket_shape(HIP, shell), rings.edges).ring_compliance(rings.edges, [0, 1, 2])
    modes = modal_rings(socket_of(HIP).compliance, rings)[:3] / (HIP.socket_radius / HIP.liner.young)
    inner = slice(2, rings.rings // 2)  # one element spans the pole
    assert elements[:, inner, inner] == pytest.approx(modes[:, inner, inner], rel=0.04, abs=5e-6)


def test_a_ball_translates_freely():
    """Its mode n = 1 is the translation, which is no compliance: a cosine of pressure moves nothing of it."""
    whole = grid(pi, radians(4.0))
    rings = modal_rings(Ball(radius=18.0, young=1000.0, poisson=0.3).compliance, whole)
    cosine = np.broadcast_to(np.cos(whole.polar)[:, None], (1, whole.rings, whole.meridians))
    moved = Turning(matrices=whole.averaged(rings))(cosine)
    assert abs(moved).max() < 1e-2 * 18.0 / 1000.0
