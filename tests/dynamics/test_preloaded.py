"""Force element of a preloaded joint: the forces of the solver, balances, damping and friction."""

from math import radians

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction, PreloadedElement
from ballsocket.dynamics.load import ContactState

TIGHT = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
CUP = bs.Cup(arc_of_cover=radians(220.0), inclination=0.3, anteversion=0.2)
MODEL = bs.Sphere(cup=CUP, ring_width=radians(5.0))


@pytest.fixture(scope="module")
def element():
    damping = Damping(hysteresis=1e-3, time=1e-4)
    return PreloadedElement(MODEL, TIGHT, damping=damping, friction=Friction(coefficient=0.05))


@pytest.fixture(scope="module")
def positions(element):
    numbers = np.random.default_rng(5)
    directions = numbers.normal(size=(40, 3))
    lengths = numbers.uniform(1e-3, 0.9 * element.wall, 40) / np.linalg.norm(directions, axis=1)
    return np.array(CUP.dome) * element.table.offset + lengths[:, None] * directions


def test_forces_are_those_of_the_solver_in_every_direction(element, positions):
    contact = MODEL.press(TIGHT, displacement=positions)
    force = -np.asarray(contact.force_vector) @ np.array(CUP.frame)  # on the ball, in the body's frame
    error = np.linalg.norm(element(positions).force - force, axis=1) / np.linalg.norm(force, axis=1)
    assert error.max() < 0.015
    assert np.median(error) < 3e-3
    assert 0.5 * error.max() < element.table.error < 2.0 * error.max()


def test_in_equilibrium_there_is_no_force_and_the_stiffness_of_the_solver(element):
    equilibrium = bs.Preload(model=MODEL, joint=TIGHT).equilibrium
    load = element(tuple(element.table.offset * part for part in CUP.dome))
    assert element.table.offset == pytest.approx(equilibrium.displacement[2])
    assert_allclose(load.force, 0.0, atol=1e-2)
    assert load.energy == pytest.approx(0.0, abs=1e-6)
    frame = np.array(CUP.frame)
    assert_allclose(frame @ np.array(load.tangent) @ frame.T, equilibrium.stiffness_matrix, rtol=0.01, atol=5e3)


def test_the_force_is_the_slope_of_the_energy_and_the_tangent_that_of_the_force(element, positions):
    step = 1e-6
    for position in positions[:3]:
        moves = step * np.eye(3)
        ahead, behind = element(position + moves), element(position - moves)
        load = element(position)
        assert_allclose((behind.energy - ahead.energy) / (2 * step), load.force, rtol=1e-6, atol=1e-3)
        slope = (behind.force - ahead.force) / (2 * step)
        assert_allclose(slope, load.tangent, atol=1e-6 * abs(slope).max())


def test_numbers_and_arrays_give_equal_loads(element, positions):
    velocity, spin = np.array([1.0, 2.0, 3.0]), np.array([0.1, -0.2, 0.3])
    loads = element(positions, velocity + 0 * positions, spin + 0 * positions)
    for index in (0, 7):
        load = element(positions[index].tolist(), velocity.tolist(), spin.tolist())
        for name in ("force", "moment", "max_pressure", "half_angle"):
            assert_allclose(getattr(load, name), getattr(loads, name)[index], rtol=1e-12)
        assert load.status == loads.status[index] == ContactState.CONTACT


def test_friction_is_that_of_the_preload_and_passive(element):
    """Friction acts without a load, by the torque of all pressures; beyond the transition speed it is Coulomb's."""
    at_rest = tuple(element.table.offset * part for part in CUP.dome)
    contact = MODEL.press(TIGHT, force=0.0, direction=CUP.dome)
    for axis, angle in ((CUP.dome, 0.0), (CUP.frame[0], np.pi / 2)):
        moment = np.array(element(at_rest, spin=tuple(2.0 * part for part in axis)).moment)
        assert moment @ axis == pytest.approx(-contact.friction_torque(0.05, angle), rel=0.01)
        assert np.linalg.norm(moment - (moment @ axis) * np.array(axis)) < 1e-6 * np.linalg.norm(moment)
    numbers = np.random.default_rng(2)
    velocity, spin = numbers.normal(size=(2, 50, 3))
    position = np.array(at_rest) + 0.01 * numbers.normal(size=(50, 3))
    lossy, elastic = element(position, velocity, spin), PreloadedElement(MODEL, TIGHT)(position, velocity, spin)
    power = np.sum((lossy.force - elastic.force) * velocity + lossy.moment * spin, axis=1)
    assert (power < 0).all()
    assert_allclose(elastic.moment, 0.0)


def test_states_beyond_the_table_have_a_status_and_no_load(element):
    far, unknown = element((1.0, 0.0, 0.0)), element((np.nan, 0.0, 0.0))
    assert (far.status, unknown.status) == (ContactState.THROUGH_WALL, ContactState.NO_NUMBER)
    assert np.isnan(far.force).all()
    assert far.notes[0].endswith(f"the limit is {element.wall:.4g} mm from equilibrium")
