"""Elements of the finite-element contact: states reproduced exactly, and orders of convergence."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from ballsocket.elasticity.finite_elements.bodies import ball_body, socket_body
from ballsocket.elasticity.finite_elements.mesh import Resolution, SocketShape, graded_points
from ballsocket.evidence.code_checks import (
    polar_components,
    pressure_forces,
    shell_block,
    strain_energy_error,
    thick_sphere_error,
)
from ballsocket.problem import Support
from ballsocket.problem.cup import Interface

from ...extent import some

ORDERS = pytest.mark.parametrize("order", [1, 2], ids=["bilinear", "biquadratic"])


@ORDERS
def test_a_translation_along_the_axis_has_no_energy(order):
    elastic = shell_block(order, end=1.1)
    K = elastic.stiffness_matrix()
    moved = polar_components(elastic, np.zeros(elastic.block.number.size), np.ones(elastic.block.number.size))
    assert abs(K @ moved).max() < 1e-12 * abs(K).max()
    assert abs(K - K.T).max() < 1e-12 * abs(K).max()


@ORDERS
def test_a_uniform_strain_has_its_energy(order):
    """u_ρ = a ρ, u_z = b z: the patch test. The meshed volume is that of the elements, chords or parabolas."""
    assert strain_energy_error(order) < (5e-3 if order == 1 else 1e-4)


@pytest.mark.parametrize("poisson", some([0.4999, 0.49, 0.3, 0.0], 1))
@pytest.mark.parametrize(("order", "elements", "least"), [(1, 32, 1.9), (2, 8, 3.9)], ids=["bilinear", "biquadratic"])
def test_a_thick_sphere_under_pressure_converges_and_does_not_lock(order, elements, least, poisson):
    """Displacement by Bartel's modulus K_B = E/R2 (2(1-2ν) + (1+ν)k³)/((1+ν)(1-2ν)(1-k³)), k = R2/b."""
    coarse, fine = (thick_sphere_error(order, elements, poisson) for elements in (elements, 2 * elements))
    assert np.log2(coarse / fine) > least
    assert fine < (2e-5 if order == 1 else 1e-7)


@pytest.mark.parametrize("interface", Interface)
@ORDERS
def test_condensed_compliance_equals_that_of_the_complete_system(order, interface):
    """Against the plain solution of all equations, for a liner on a stiffer layer."""
    shape = SocketShape(
        layers=((1.3, 1.0, 0.4), (1.5, 20.0, 0.3)),
        rim=np.pi / 2,
        chamfer=0.05,
        interface=interface,
        support=Support.FIXED,
    )
    resolution = Resolution(size=0.2, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=order, halvings=1)
    body = socket_body(shape, resolution)
    forces = np.random.default_rng(1).normal(size=len(body.contact))
    K = body.elastic.stiffness_matrix().tolil()
    load = np.zeros(K.shape[0])
    load[body.normal_unknowns] = forces
    for unknown in np.flatnonzero(body.fixed_unknowns | (K.tocsr().diagonal() == 0)):
        K[unknown] = 0
        K[unknown, unknown] = 1
        load[unknown] = 0
    whole = spsolve(K.tocsc(), load)
    np.testing.assert_allclose(
        body.compliance() @ forces, whole[body.normal_unknowns], rtol=1e-8, atol=1e-9 * abs(whole).max()
    )
    moved = body.displacements(forces)
    np.testing.assert_allclose(moved[body.contact, 1], whole[body.normal_unknowns], atol=1e-9 * abs(whole).max())


def test_sliding_layers_move_together_across_and_freely_along_the_interface():
    shape = SocketShape(
        layers=((1.3, 1.0, 0.4), (1.5, 20.0, 0.3)),
        rim=1.5,
        chamfer=0.0,
        interface=Interface.SLIDING,
        support=Support.FIXED,
    )
    resolution = Resolution(size=0.1, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2)
    body = socket_body(shape, resolution)
    mesh = body.elastic.block
    (inner,) = mesh.sliding
    moved = body.displacements(np.ones(len(body.contact)))
    one, other = moved[mesh.number[:, inner]], moved[mesh.number[:, inner + 1]]
    np.testing.assert_array_equal(one[:, 1], other[:, 1])
    assert abs(one[1:, 0] - other[1:, 0]).max() > 1e-3 * abs(one[:, 1]).max()


def test_a_sliding_liner_in_a_free_shell_is_free_at_its_rim():
    """The shell sits on its rim; the liner in it does not."""
    shape = SocketShape(
        layers=((1.3, 1.0, 0.4), (1.5, 20.0, 0.3)),
        rim=1.5,
        chamfer=0.0,
        interface=Interface.SLIDING,
        support=Support.FREE,
    )
    resolution = Resolution(size=0.1, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2)
    body = socket_body(shape, resolution)
    mesh = body.elastic.block
    (inner,) = mesh.sliding
    along = body.displacements(np.ones(len(body.contact)))[mesh.number[-1], 0]
    assert np.all(along[: inner + 1] != 0)
    np.testing.assert_array_equal(along[inner + 1 :], 0.0)


def test_bonded_layers_of_one_material_are_one_layer():
    """Two bonded layers of one material are one layer."""
    resolution = Resolution(size=0.1, reach=0.8, growth=1.2, widest=0.3, deepest=0.25, order=2)
    ends = {"rim": 1.5, "chamfer": 0.0, "interface": Interface.BONDED, "support": Support.FIXED}
    one, two = (
        socket_body(SocketShape(layers=layers, **ends), resolution)
        for layers in (((1.5, 1.0, 0.3),), ((1.2, 1.0, 0.3), (1.5, 1.0, 0.3)))
    )
    forces = pressure_forces(one.elastic.block)[one.normal_unknowns] * np.cos(one.elastic.block.angle) ** 4
    np.testing.assert_allclose(one.compliance() @ forces, two.compliance() @ forces, rtol=1e-3, atol=1e-4)


def test_a_chamfer_removes_only_the_edge_of_the_bore():
    shape = SocketShape(
        layers=((1.3, 1.0, 0.4),), rim=1.5, chamfer=0.1, interface=Interface.BONDED, support=Support.FIXED
    )
    mesh = socket_body(
        shape, Resolution(size=0.1, reach=2.0, growth=1.2, widest=0.3, deepest=0.5, order=2)
    ).elastic.block
    bore = mesh.radius[:, 0]
    np.testing.assert_allclose(bore[mesh.angle <= 1.4 + 1e-12], 1.0)
    assert bore[-1] == pytest.approx(1.1)
    np.testing.assert_allclose(mesh.radius[:, -1], 1.3)


def test_the_equator_of_the_ball_is_fixed_axially_and_free_radially():
    body = ball_body(0.3, Resolution(size=0.1, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2))
    mesh = body.elastic.block
    moved = body.displacements(np.ones(len(body.contact)))
    np.testing.assert_array_equal(moved[mesh.number[-1], 0], 0.0)  # u_φ is the axial displacement there
    assert abs(moved[mesh.number[-1, 1:], 1]).min() > 0


@pytest.mark.parametrize("end", [3.0, -1.0])
def test_graded_points_have_the_stated_ends_and_growing_steps(end):
    places = graded_points(1.0, end, 0.1, 1.3, 0.5)
    assert places[0] == 1.0
    assert places[-1] == pytest.approx(end, rel=1e-14)
    steps = abs(np.diff(places))
    assert np.all(np.diff(steps) > -1e-12)
    assert steps[0] == pytest.approx(0.1, rel=0.35)
