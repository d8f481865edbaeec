"""Equilibrium of a ball on springs: the compiled pass equals NumPy's, in any contact and in any blocks of loads."""

from importlib.util import find_spec

import numpy as np
import pytest

from ballsocket.hip import socket_foundation, spring_equilibrium
from ballsocket.hip.socket_foundation import NO_LATERAL_SPRING
from ballsocket.hip.spring_equilibrium import load_blocks, newton_step, solve_in_blocks, spring_solver
from ballsocket.hip.wear_integrator import WearIntegrator

from .hips import QUICK, hip
from .test_foundations import SPRINGS, TILTED

WORN = np.random.default_rng(1).uniform(0.0, 0.02, len(SPRINGS.areas))
CONTACTS = {
    "unworn": (np.zeros_like(WORN), NO_LATERAL_SPRING, False),
    "worn": (WORN, NO_LATERAL_SPRING, False),
    "another depth under each load": (WORN * np.array([[0.5], [1.0], [2.0]]), NO_LATERAL_SPRING, False),
    "a lateral spring": (WORN, np.diag([500.0, 0.0, 0.0]), False),
    "a start without contact": (WORN, NO_LATERAL_SPRING, True),
}


def solved_by(solver, monkeypatch, depth, lateral, far):
    monkeypatch.setattr(socket_foundation, "spring_solver", lambda: solver)
    start = SPRINGS.solve_equilibrium(TILTED, depth)
    if not far:
        return SPRINGS.solve_equilibrium(TILTED, depth, None, lateral)
    start.displacement[:] *= -2.0
    return SPRINGS.solve_equilibrium(TILTED, depth, start, lateral)


@pytest.fixture(scope="module")
def compiled():
    pytest.importorskip("numba")
    return spring_solver()


@pytest.mark.parametrize("name", CONTACTS)
def test_the_compiled_pass_equals_numpy(name, compiled, monkeypatch):
    one, other = (solved_by(solver, monkeypatch, *CONTACTS[name]) for solver in (compiled, solve_in_blocks))
    assert one.converged
    assert other.converged
    np.testing.assert_allclose(one.displacement, other.displacement, rtol=0, atol=1e-11 * 0.1)
    np.testing.assert_allclose(one.pressure, other.pressure, rtol=0, atol=1e-11 * other.pressure.max())


def test_a_million_cycles_are_the_same_on_both_paths(compiled, monkeypatch):
    integrators = []
    for solver in (compiled, solve_in_blocks):
        monkeypatch.setattr(socket_foundation, "spring_solver", lambda solver=solver: solver)
        integrators.append(WearIntegrator(setup=hip(**QUICK)).run_until(1e6, lambda cycles: None))
    one, other = integrators
    assert one.steps == other.steps
    assert one.volume == pytest.approx(other.volume, rel=1e-11)
    np.testing.assert_allclose(one.depth, other.depth, rtol=0, atol=1e-11 * other.depth.max())


def test_a_load_that_no_contact_balances_is_not_converged_on_either_path(compiled, monkeypatch):
    depth = np.full_like(WORN, np.nan)
    for solver in (compiled, solve_in_blocks):
        monkeypatch.setattr(socket_foundation, "spring_solver", lambda solver=solver: solver)
        assert not SPRINGS.solve_equilibrium(TILTED, depth).converged


def test_blocks_of_loads_do_not_change_the_result(monkeypatch):
    together = solved_by(solve_in_blocks, monkeypatch, *CONTACTS["another depth under each load"])
    monkeypatch.setattr(spring_equilibrium, "_BLOCK_SIZE", 2 * len(SPRINGS.areas))
    assert list(load_blocks(3, len(SPRINGS.areas))) == [slice(0, 2), slice(2, 4)]
    in_blocks = solved_by(solve_in_blocks, monkeypatch, *CONTACTS["another depth under each load"])
    np.testing.assert_allclose(in_blocks.pressure, together.pressure, rtol=0, atol=1e-12 * together.pressure.max())
    near = [SPRINGS.cells_near_contact(together, WORN, 0.3)]
    monkeypatch.setattr(spring_equilibrium, "_BLOCK_SIZE", 10**9)
    assert (SPRINGS.cells_near_contact(together, WORN, 0.3) == near[0]).all()


def test_numpy_solves_where_numba_is_not_installed(monkeypatch):
    monkeypatch.setattr(spring_equilibrium, "find_spec", lambda name: None if name == "numba" else find_spec(name))
    assert spring_solver() is solve_in_blocks


def test_without_a_folder_for_its_cache_numba_still_compiles(monkeypatch):
    numba = pytest.importorskip("numba")
    plain = numba.njit

    def without_folder(function, cache=False, **options):
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return plain(function, **options)

    monkeypatch.setattr(numba, "njit", without_folder)
    assert spring_equilibrium._compiled_solver.__wrapped__().py_func is spring_equilibrium._solve_one_by_one


@pytest.mark.parametrize("softest", [1.0, 1e-12])
def test_the_newton_step_solves_its_equations(softest):
    """One cell in contact has a stiffness in one direction only: the regularisation holds the others."""
    normal = np.array([0.3, -0.5, np.sqrt(1 - 0.34)])
    stiffness = 400.0 * np.outer(normal, normal) + 400.0 * softest * np.eye(3)
    force = np.array([20.0, -3.0, 500.0]) if softest == 1.0 else 500.0 * normal
    step = np.array(newton_step(tuple(stiffness[np.triu_indices(3)]), tuple(force)))
    np.testing.assert_allclose(stiffness @ step, force, rtol=0, atol=1e-9 * 500.0)
