"""Elements of the finite-element contact: states reproduced exactly, and orders of convergence."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from ballsocket.elasticity.finite_elements.bodies import ball_body, socket_body
from ballsocket.elasticity.finite_elements.mesh import Resolution, SocketShape, graded_points
from ballsocket.evidence.code_checks import polar_components, shell_block, strain_energy_error, thick_sphere_error
from ballsocket.problem import Support
from ballsocket.problem.cup import Interface

from ...extent import some

ORDERS = pytest.mark.parametrize("order", [1, 2], ids=["bilinear", "biquadratic"])
LINER, BACKED = ((1.3, 1.0, 0.4),), ((1.3, 1.0, 0.4), (1.5, 20.0, 0.3))  # outer radius, E and ν of each layer


def shape(layers, *, rim=1.5, chamfer=0.0, interface=Interface.BONDED, support=Support.FIXED):
    return SocketShape(layers=layers, rim=rim, chamfer=chamfer, interface=interface, support=support)


def resolution(size=0.1, *, reach=0.8, growth=1.3, deepest=0.5, order=2, halvings=0):
    sizes = {"size": size, "reach": reach, "growth": growth, "widest": 0.3, "deepest": deepest}
    return Resolution(**sizes, order=order, halvings=halvings)


def solve_sliding(support):
    """Return mesh and displacements of a sliding liner under unit forces, and the last grid line of the liner."""
    body = socket_body(shape(BACKED, interface=Interface.SLIDING, support=support), resolution())
    return body.elastic.block, body.displacements(np.ones(len(body.contact))), *body.elastic.block.sliding


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
    backed = shape(BACKED, rim=np.pi / 2, chamfer=0.05, interface=interface)
    body = socket_body(backed, resolution(0.2, order=order, halvings=1))
    forces = np.random.default_rng(1).normal(size=len(body.contact))
    K = body.elastic.stiffness_matrix().tolil()
    load = np.zeros(K.shape[0])
    load[body.normal_unknowns] = forces
    fixed = np.flatnonzero(body.fixed_unknowns | (K.tocsr().diagonal() == 0))
    K[fixed], K[fixed, fixed], load[fixed] = 0, 1, 0
    whole = spsolve(K.tocsc(), load)
    normal, rounding = whole[body.normal_unknowns], 1e-9 * abs(whole).max()
    np.testing.assert_allclose(body.compliance() @ forces, normal, rtol=1e-8, atol=rounding)
    np.testing.assert_allclose(body.displacements(forces)[body.contact, 1], normal, atol=rounding)


def test_sliding_layers_move_together_across_and_freely_along_the_interface():
    mesh, moved, inner = solve_sliding(Support.FIXED)
    one, other = moved[mesh.number[:, inner]], moved[mesh.number[:, inner + 1]]
    np.testing.assert_array_equal(one[:, 1], other[:, 1])
    assert abs(one[1:, 0] - other[1:, 0]).max() > 1e-3 * abs(one[:, 1]).max()


def test_a_sliding_liner_in_a_free_shell_is_free_at_its_rim():
    """The shell sits on its rim; the liner in it does not."""
    mesh, moved, inner = solve_sliding(Support.FREE)
    along = moved[mesh.number[-1], 0]
    assert np.all(along[: inner + 1] != 0)
    np.testing.assert_array_equal(along[inner + 1 :], 0.0)


def test_a_chamfer_removes_only_the_edge_of_the_bore():
    mesh = socket_body(shape(LINER, chamfer=0.1), resolution(reach=2.0, growth=1.2)).elastic.block
    bore = mesh.radius[:, 0]
    np.testing.assert_allclose(bore[mesh.angle <= 1.4 + 1e-12], 1.0)
    assert bore[-1] == pytest.approx(1.1)
    np.testing.assert_allclose(mesh.radius[:, -1], 1.3)


def test_the_equator_of_the_ball_is_fixed_axially_and_free_radially():
    body = ball_body(0.3, resolution())
    mesh = body.elastic.block
    moved = body.displacements(np.ones(len(body.contact)))
    np.testing.assert_array_equal(moved[mesh.number[-1], 0], 0.0)  # u_φ is the axial displacement there
    assert abs(moved[mesh.number[-1, 1:], 1]).min() > 0


@pytest.mark.parametrize("end", [3.0, -1.0])
def test_graded_points_have_the_stated_ends_and_growing_steps(end):
    places = graded_points(1.0, end, 0.1, 1.3, 0.5)
    assert places[[0, -1]] == pytest.approx((1.0, end), rel=1e-14)
    steps = abs(np.diff(places))
    assert np.all(np.diff(steps) > -1e-12)
    assert steps[0] == pytest.approx(0.1, rel=0.35)
