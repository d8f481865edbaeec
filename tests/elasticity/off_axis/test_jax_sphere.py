"""`Sphere` in JAX: one step of the search, agreement with NumPy, derivatives, refused inputs."""

from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.compliance import make_compliance
from ballsocket.elasticity.off_axis.coupled_search import apply_operator, integrate
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere
from ballsocket.elasticity.off_axis.lane_solver import make_bore_arrays

from ...joints import HIP
from .shapes import COARSE

jax = pytest.importorskip("jax")

MODEL = bs.Sphere(surface=bs.ClosedShell(), ring_width=radians(3.0))
TILT = np.array([0.1, 0.7, 1.1, 0.4])
FORCE = np.array([600.0, 3000.0, 1500.0, 2500.0])
DIRECTION = np.stack([np.sin(TILT), 0.1 * TILT, np.cos(TILT)], axis=-1)


def test_operator_in_jax_equals_that_in_numpy():
    grid = even_grid(radians(90.0), radians(6.0))
    bore = MODEL.bore_contact(HIP)
    compliance = make_compliance(bs.ClosedShell(), HIP, bs.Cup(), grid)
    gap = type(bore.gap)(grid=grid, clearance=0.1, socket_radius=18.0, depth=np.zeros((15, 60)), kind=bs.LinearGap)
    arrays = make_bore_arrays(type(bore)(compliance=compliance, gap=gap))
    fields = np.random.default_rng(1).standard_normal((60, 15, 3)).astype(np.float32)
    in_jax = jax.tree.map(jax.numpy.asarray, arrays)
    expected = apply_operator(arrays, arrays.softness, fields)
    with jax.default_matmul_precision("highest"):
        displacement = apply_operator(in_jax, in_jax.softness, jax.numpy.asarray(fields))
        integral = integrate(in_jax, displacement, jax.numpy.asarray(fields))
    assert np.asarray(displacement) == pytest.approx(expected, abs=2e-6 * float(abs(expected).max()))
    assert np.asarray(integral) == pytest.approx(integrate(arrays, expected, fields), rel=1e-5)


@pytest.mark.long
def test_single_precision_agrees_with_numpy():
    contacts = JaxSphere(model=MODEL, joint=HIP).press(FORCE, DIRECTION)
    expected = MODEL.press(HIP, force=FORCE, direction=DIRECTION)
    assert np.asarray(contacts.converged).all()
    assert np.asarray(contacts.error).max() <= 2e-5
    assert np.asarray(contacts.displacement) == pytest.approx(expected.displacement, abs=2e-5 * 0.2)
    force = np.linalg.norm(contacts.force_vector - expected.force_vector, axis=1)
    assert (force <= 2e-5 * FORCE).all()
    assert np.asarray(contacts.max_pressure) == pytest.approx(expected.max_pressure, rel=2e-5)
    assert np.asarray(contacts.half_angle) == pytest.approx(expected.half_angle, abs=5e-4)
    assert np.asarray(contacts.edge_loaded).tolist() == expected.edge_loaded.tolist()
    margin = np.maximum(expected.edge_margin, 0.0)
    assert np.asarray(contacts.edge_margin) == pytest.approx(margin, abs=5e-4)
    scale = abs(expected.stiffness_matrix).max()
    assert np.asarray(contacts.stiffness_matrix) == pytest.approx(expected.stiffness_matrix, abs=1e-3 * scale)


@pytest.mark.long
def test_derivatives_by_load_direction_clearance_and_worn_depth_are_slopes():
    with jax.enable_x64(True):
        xp = jax.numpy
        cup = JaxSphere(model=MODEL, joint=HIP, tolerance=1e-9, dtype="float64")
        worn = np.maximum(MODEL.bore_contact(HIP).compliance.grid.centroids[2], 0.0) ** 2

        @jax.jit
        def press(x):
            contacts = cup.press(x[:1], x[None, 1:4], clearance=x[4], depth=x[5] * worn)
            return xp.concatenate([contacts.displacement[0], contacts.force_vector[0], contacts.max_pressure])

        def both(x):
            values = press(x)
            return values, values

        x = xp.array([3000.0, 0.5, 0.1, 0.8, 0.1, 0.0])
        slopes, _ = jax.jacrev(both, has_aux=True)(x)
        steps = np.array([0.3, 2e-5, 2e-5, 2e-5, 2e-5, 2e-5])
        ends = [(press(x.at[i].add(step)) - press(x.at[i].add(-step))) / (2 * step) for i, step in enumerate(steps)]
        differences = np.stack(ends, axis=1)
        for rows, floor in ((slice(0, 3), 0.0), (slice(3, 6), 100.0), (slice(6, 7), 0.0)):
            scale = abs(differences[rows]).max(axis=0).clip(floor)  # the force in N follows the load alone
            assert (abs(slopes[rows] - differences[rows]).max(axis=0) <= 1e-5 * scale).all()


def test_bores_without_lanes_are_refused():
    with pytest.raises(ValueError, match="JaxSphere needs an elastic surface, LinearGap and rings of 3 deg"):
        JaxSphere(model=COARSE, joint=HIP).press(FORCE, DIRECTION)


def test_tolerance_is_limited():
    with pytest.raises(ValueError, match="tolerance = 0.1 is not allowed: a tolerance is 1e-9 to 1e-2"):
        JaxSphere(model=MODEL, joint=HIP, tolerance=0.1)
