"""Derivatives of ring matrices by the numbers of the liner: against differences, and where the mesh changes."""

from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.finite_elements.harmonics import socket_harmonics
from ballsocket.elasticity.finite_elements.mesh import socket_shape
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.elasticity.off_axis.ring_matrices import liner_numbers, vary_liner

from ...joints import HIP

CUP = bs.Cup(arc_of_cover=radians(170.0))
GRID = even_grid(CUP.rim, radians(12.0))
BACKED = HIP.replace(backing=[bs.Layer(thickness=3.0, material=bs.CANCELLOUS_BONE)])


def differences(surface, joint, fraction=1e-4):
    """Compute derivatives by the liner's numbers by central differences."""
    numbers = liner_numbers(joint)
    steps = fraction * numbers
    low, high = (
        [surface.rings(vary_liner(joint, numbers + sign * row), CUP, GRID) for row in np.diag(steps)]
        for sign in (-1, 1)
    )
    return (np.stack(high) - np.stack(low)) / (2 * steps[:, None, None, None])


@pytest.mark.parametrize("surface", [bs.ClosedShell(), bs.RealCup()])
def test_slopes_are_the_derivatives_of_ring_matrices(surface):
    slopes, expected = surface.ring_slopes(BACKED, CUP, GRID), differences(surface, BACKED)
    for slope, difference in zip(slopes, expected, strict=True):
        assert slope == pytest.approx(difference, abs=1e-7 * abs(difference).max())


def test_compliance_of_a_single_layer_falls_with_its_modulus():
    rings, slopes = bs.RealCup().rings(HIP, CUP, GRID), bs.RealCup().ring_slopes(HIP, CUP, GRID)
    assert slopes[0] == pytest.approx(-rings / HIP.liner.young, rel=1e-12)


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
    scale = abs(slopes[0]).max()
    assert slopes[0] == pytest.approx(slopes[1], abs=0.02 * scale)
