"""Motion of a ball in its socket: conserved energy and angular momentum, order of the steps, and restitution."""

from dataclasses import replace
from math import log1p, nan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import (
    Bristles,
    ContactState,
    Damping,
    Flores,
    Friction,
    damping_from_restitution,
    relations,
    simulate,
)
from ballsocket.dynamics.restitution import restitution_of

from ..extent import either
from ..joints import HIP

FREE = bs.ForceElement(bs.HessForsbach(), HIP)
THROW = {"mass": 1.0, "position": (0.01, 0.02, 0.0), "velocity": (10.0, 50.0, 200.0), "step": 2e-5}
LOSSY = replace(FREE, damping=Damping(hysteresis=1e-3, time=1e-5), friction=Friction(coefficient=0.1))


@pytest.mark.parametrize("smoothing", [0.0, 0.02])
def test_energy_is_conserved_over_bounces_without_losses(smoothing):
    motion = simulate(replace(FREE, smoothing=smoothing), duration=0.02, **THROW)
    assert motion.bounces > 10
    assert motion.drift < 1e-12


@pytest.mark.long
def test_energy_drift_of_ten_thousand_bounces_is_small():
    """Steps of 20 µs, compiled; a contact lasts about 22 steps."""
    from ballsocket.dynamics.compiled import CompiledElement

    motion = simulate(CompiledElement(FREE), duration=24.0, **THROW)
    assert motion.bounces > 10_000
    assert motion.drift < 1e-7


ORBIT = {"mass": 0.35, "position": (0.1, 0.0, 0.0), "velocity": (20.0, 60.0, 15.0)}


@pytest.mark.parametrize("step", [1e-5, 1e-4])
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz()], ids=lambda model: model.name)
def test_frictionless_orbit_conserves_angular_momentum_at_any_step(model, step):
    element = bs.ForceElement(model, HIP, damping=Damping(hysteresis=1e-4))
    for pull in ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0), lambda t: (0.0, 5.0 * np.sin(1e3 * t), 0.0)):
        motion = simulate(element, pull=pull, duration=400 * step, step=step, **ORBIT)
        assert motion.bounces >= 2
        assert motion.drift < 1e-12
        assert motion.angular_drift < 1e-13
    assert motion.summary()["angular_drift"] == motion.angular_drift


def test_energy_at_coarse_steps_has_no_trend():
    """Each contact lasts about two steps, for which the iteration converges slowest."""
    liner = bs.Material(young=1450.0, poisson=0.33)
    joint = bs.Joint(ball_radius=11.1, clearance=0.047, liner_thickness=3.9, liner=liner)
    thrown = {"mass": 0.21, "position": (0.03, 0.02, -0.04), "velocity": (35.0, -50.0, 22.0)}
    motion = simulate(bs.ForceElement(bs.HessForsbach(), joint), duration=0.06, step=1e-4, **thrown)
    assert motion.bounces > 50
    assert motion.drift < 1e-13


def test_orbit_in_a_cup_conserves_angular_momentum_about_the_dome_axis():
    cup = bs.Cup(inclination=0.6, arc_of_cover=np.radians(160.0))
    dome = np.array(cup.dome)
    tangent = np.cross(dome, (0.0, 1.0, 0.0)) / np.linalg.norm(np.cross(dome, (0.0, 1.0, 0.0)))
    position = 0.1 * (np.cos(1.3) * dome + np.sin(1.3) * tangent)
    velocity = 60.0 * np.cross(dome, tangent) + 3.0 * tangent + 10.0 * dome
    thrown = {"mass": 0.35, "position": tuple(position), "velocity": tuple(velocity), "pull": tuple(30.0 * dome)}
    motion = simulate(replace(FREE, cup=cup), duration=either(0.006, 0.02), step=2e-5, **thrown)
    assert motion.end_reason == ""
    assert (np.asarray(motion.load.status) == ContactState.AT_RIM).sum() > 50
    assert motion.drift < 1e-12
    assert motion.angular_drift < 1e-13


def test_angular_drift_is_none_with_friction():
    assert simulate(LOSSY, duration=1e-3, **THROW).angular_drift is None
    bristles = replace(FREE, friction=Bristles(coefficient=0.1))
    assert simulate(bristles, duration=1e-4, **THROW).angular_drift is None


@pytest.mark.long
@pytest.mark.parametrize("step", [1e-5, 5e-5, 1e-4])
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Tabulated()], ids=lambda model: model.name)
def test_many_steps_conserve_energy_and_angular_momentum(model, step):
    from ballsocket.dynamics.compiled import CompiledElement

    for pull in ((0.0, 0.0, 0.0), (0.0, 0.0, 3.4)):
        element = CompiledElement(bs.ForceElement(model, HIP))
        motion = simulate(element, pull=pull, duration=1e5 * step, step=step, **ORBIT)
        assert len(motion.time) == 10**5 + 1
        assert motion.bounces > 500
        assert motion.drift < 1e-12
        assert motion.angular_drift < 1e-12


def test_dissipated_energy_grows_and_balances():
    motion = simulate(LOSSY, duration=0.02, spin=(0.0, 3.0, 5.0), **THROW)
    assert motion.drift < 1e-12
    assert (np.diff(motion.dissipated_energy) >= 0).all()
    assert motion.dissipated_energy[-1] > 0.1 * motion.kinetic_energy[0]


def test_energy_balances_the_work_of_the_pull():
    motion = simulate(FREE, duration=0.02, pull=(0.0, 0.0, 500.0), **THROW)
    assert motion.drift < 1e-12
    assert motion.work[-1] == pytest.approx(500.0 * (motion.position[-1, 2] - motion.position[0, 2]))
    shaken = simulate(LOSSY, duration=0.02, pull=lambda t: (0.0, 0.0, 500.0 * np.sin(300.0 * t)), **THROW)
    assert shaken.drift < 1e-11


def test_nearly_circular_orbit_conserves_energy_and_angular_momentum():
    """The distance is nearly constant, so that the difference quotient of the energy is nearly 0/0."""
    distance = HIP.clearance + 0.03
    speed = np.sqrt(1e3 * -FREE((0.0, 0.0, distance)).force[2] * distance)
    for faster in (1.0, 1.0 + 1e-9, 1.0001):
        thrown = {"mass": 1.0, "position": (distance, 0.0, 0.0), "velocity": (0.0, faster * speed, 0.0)}
        motion = simulate(FREE, duration=either(0.004, 0.02), step=4e-5, **thrown)
        assert motion.end_reason == ""
        assert motion.drift < 1e-13
        assert motion.angular_drift < 1e-13
        assert np.ptp(motion.indentation) < 2e-4 * distance


def test_motion_converges_with_second_order_to_another_integrator():
    def rates(_, state):
        return [*state[3:], *(1e3 * component for component in FREE(tuple(state[:3].tolist())).force)]

    start = [*THROW["position"], *THROW["velocity"]]
    end = solve_ivp(rates, (0.0, 2e-3), start, method="DOP853", rtol=1e-11, atol=1e-12).y[:3, -1]
    errors = []
    for step in (2e-5, 1e-5, 5e-6):
        motion = simulate(FREE, duration=2e-3, **{**THROW, "step": step})
        errors.append(np.linalg.norm(motion.position[-1] - end))
    assert errors[-1] < 1e-3 * HIP.clearance
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)


def simulated_restitution(damping, speed, model):
    """Integrate the impact of 1 kg by a high-order method, and return its coefficient of restitution."""
    element = bs.ForceElement(model, HIP, damping=damping)

    def rates(_, state):
        d, v = state.tolist()
        return [v, 1e3 * element((0.0, 0.0, HIP.clearance + d), (0.0, 0.0, v)).force[2]]

    def leaves(_, state):
        return state[0]

    leaves.terminal, leaves.direction = True, -1
    solution = solve_ivp(rates, (0.0, 1.0), [1e-12, speed], method="DOP853", rtol=1e-10, atol=1e-13, events=leaves)
    return -solution.y_events[0][0][1] / speed


@pytest.mark.parametrize("relation", relations.relations, ids=lambda relation: relation.name)
def test_simulated_restitution_equals_the_exact_relation(relation):
    for restitution, model in ((0.9, bs.HessForsbach()), (0.5, bs.Hertz())):
        damping = damping_from_restitution(relation, restitution, 100.0)
        h = 100.0 * damping.hysteresis
        assert simulated_restitution(damping, 100.0, model) == pytest.approx(restitution_of(h), rel=1e-7)
        assert damping.restitution(100.0) == restitution_of(h)


def test_published_relations_are_accurate_in_their_ranges():
    """All relations hold near e = 1; those of Flores and Gonthier approximate any e."""
    for relation in relations.relations:
        assert restitution_of(relation.damping(0.99)) == pytest.approx(0.99, abs=4e-3), relation
    for e in np.linspace(0.05, 1.0, 20):
        assert restitution_of(relations.exact.damping(e)) == pytest.approx(e, rel=1e-12)
        assert restitution_of(relations.gonthier.damping(e)) == pytest.approx(e, abs=0.035)
        assert restitution_of(relations.flores.damping(e)) == pytest.approx(e, abs=0.05)
    assert restitution_of(relations.hunt_crossley.damping(0.3)) > 0.55
    assert restitution_of(relations.lankarani_nikravesh.damping(0.3)) > 0.65


def test_exact_relation_satisfies_its_equation():
    for h in (1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0):
        e = restitution_of(h)
        assert h * (1 + e) == pytest.approx(log1p(h) - log1p(-h * e), rel=1e-12)


@pytest.mark.parametrize("step", [2e-5, 2e-6, 2e-7])
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Tabulated()], ids=lambda model: model.name)
def test_resting_ball_conserves_energy_at_short_steps(model, step):
    """Over short paths the difference of the energy is dominated by rounding."""
    equilibrium = HIP.clearance + model.press(HIP, force=500.0).indentation
    lying = {"mass": 3.0, "position": (0.0, 0.0, equilibrium), "duration": 200 * step, "step": step}
    for damping in (None, Damping(hysteresis=0.01)):
        element = bs.ForceElement(model, HIP, damping=damping)
        motion = simulate(element, pull=lambda t: (0.0, 0.0, 500.0 + 400.0 * np.sin(150.0 * t)), **lying)
        assert motion.end_reason == ""
        assert motion.drift < 1e-11


def test_motion_ends_with_a_note_at_a_state_without_a_result():
    motion = simulate(FREE, mass=1.0, position=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 1e7), duration=1e-3, step=1e-5)
    assert len(motion.time) == 1
    assert "exceeds the wall thickness" in motion.end_reason
    nan_motion = simulate(FREE, mass=1.0, position=(nan, 0.0, 0.0), duration=1e-3, step=1e-5)
    assert "not finite" in nan_motion.end_reason
    assert "r = (0, 0, 20) mm" in simulate(FREE, **{**THROW, "position": (0.0, 0.0, 20.0)}, duration=1e-3).end_reason


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"mass": -1.0}, "mass = -1 is not allowed"),
        ({"mass": 1e-200}, "mass = 1e-200 is not allowed: mass must be between 1e-100 and 1e.100"),
        ({"inertia": float("nan")}, "inertia = nan is not allowed: inertia must be between"),
        ({"duration": 1e300}, "the number of steps = 5e.304 is not allowed"),
        ({"pull": (0.0, 1.0)}, "a pull must have three components"),
        ({"position": (0.0, 1.0)}, "a state must have three components"),
    ],
)
def test_invalid_arguments_are_rejected(arguments, message):
    with pytest.raises(ValueError, match=message):
        simulate(FREE, **{**THROW, "duration": 1e-3, **arguments})
    with pytest.raises(TypeError, match="element must be a ForceElement, got 3"):
        simulate(3, duration=1e-3, **THROW)


@pytest.mark.parametrize("friction", [Friction(coefficient=0.1), Bristles(coefficient=0.1)])
def test_motion_ends_where_the_ball_leaves_the_cup(friction):
    element = replace(FREE, cup=bs.Cup(), friction=friction)
    motion = simulate(element, duration=0.01, **{**THROW, "velocity": (0.0, 0.0, -300.0)})
    assert "has left the cup over its rim" in motion.end_reason
    assert len(motion.time) == pytest.approx(HIP.clearance / 300.0 / 2e-5, abs=2)


def test_restitution_decreases_with_the_impact_speed():
    damping = Flores(restitution=0.8, impact_speed=100.0)
    assert damping.restitution(50.0) > damping.restitution(100.0) > damping.restitution(200.0)
