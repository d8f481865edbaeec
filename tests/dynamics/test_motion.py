"""Motion of a ball in its socket: conserved energy and angular momentum, and order of the steps."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, Friction, simulate

from ..extent import either, some
from ..joints import HIP

FREE = bs.ForceElement(bs.HessForsbach(), HIP)
THROW = {"mass": 1.0, "position": (0.01, 0.02, 0.0), "velocity": (10.0, 50.0, 200.0), "step": 2e-5}
LOSSY = replace(FREE, damping=Damping(hysteresis=1e-3, time=1e-5), friction=Friction(coefficient=0.1))


ORBIT = {"mass": 0.35, "position": (0.1, 0.0, 0.0), "velocity": (20.0, 60.0, 15.0)}


@pytest.mark.parametrize("step", [1e-5, 1e-4])
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz()], ids=lambda model: model.name)
def test_frictionless_orbit_conserves_angular_momentum_at_any_step(model, step):
    element = bs.ForceElement(model, HIP, damping=Damping(hysteresis=1e-4), smoothing=0.01)
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
    dome, tangent = np.array(cup.dome), np.array(cup.frame[0])
    position = 0.1 * (np.cos(1.3) * dome + np.sin(1.3) * tangent)
    velocity = 60.0 * np.cross(dome, tangent) + 3.0 * tangent + 10.0 * dome
    thrown = {"mass": 0.35, "position": tuple(position), "velocity": tuple(velocity), "pull": tuple(30.0 * dome)}
    motion = simulate(replace(FREE, cup=cup), duration=either(0.004, 0.02), step=2e-5, **thrown)
    assert motion.end_reason == ""
    assert (np.asarray(motion.load.status) == ContactState.AT_RIM).sum() > 50
    assert motion.drift < 1e-12
    assert motion.angular_drift < 1e-13


def test_drifts_are_relative_to_the_largest_energy_and_angular_momentum():
    thrown = {"mass": 1.0, "position": (0.05, 0.0, 0.0), "velocity": (0.0, 200.0, 0.0), "duration": 1e-5, "step": 1e-5}
    motion = simulate(FREE, **thrown)
    velocity = np.array([[0.0, 200.0, 0.0], [0.0, 202.0, 0.0]])
    wrong = replace(motion, velocity=velocity, position=motion.position * 0 + 0.05)
    assert wrong.drift == pytest.approx((202.0**2 - 200.0**2) / 202.0**2, rel=1e-9)
    # L = m r x v is (-0.05 v, 0, 0.05 v) with r = (0.05, 0.05, 0.05): it changes by 1 % along itself
    reach = 0.05 * np.sqrt(3) * 202.0
    assert wrong.angular_drift == pytest.approx(0.05 * np.sqrt(2) * 2.0 / reach, rel=1e-9)
    assert replace(motion, velocity=0 * velocity).angular_drift == 0.0


@pytest.mark.long
@pytest.mark.parametrize("step", [1e-5, 1e-4])
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


def test_dissipated_energy_grows_and_energy_balances_the_work_of_the_pull():
    motion = simulate(LOSSY, duration=0.02, spin=(0.0, 3.0, 5.0), **THROW)
    assert motion.drift < 1e-12
    assert (np.diff(motion.dissipated_energy) >= 0).all()
    assert motion.dissipated_energy[-1] > 0.1 * motion.kinetic_energy[0]
    assert motion.angular_drift is None
    bristles = replace(FREE, friction=Bristles(coefficient=0.1))
    assert simulate(bristles, duration=1e-4, **THROW).angular_drift is None
    motion = simulate(FREE, duration=0.01, pull=(0.0, 0.0, 500.0), **THROW)
    assert motion.drift < 1e-12
    assert motion.work[-1] == pytest.approx(500.0 * (motion.position[-1, 2] - motion.position[0, 2]))
    shaken = simulate(LOSSY, duration=0.01, pull=lambda t: (0.0, 0.0, 500.0 * np.sin(300.0 * t)), **THROW)
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


def test_the_error_of_the_position_is_estimated_and_missing_without_steps_of_second_order():
    """The energy is conserved at both steps; the phase of the bounces is not."""
    thrown = THROW | {"duration": 0.01}
    motion, fine = (simulate(FREE, **thrown | {"step": step}) for step in (4e-5, 2e-6))
    error = np.linalg.norm(motion.position - fine.position[::20], axis=1).max()
    assert motion.drift < 1e-12
    assert 1e-3 < error == pytest.approx(motion.position_error, rel=0.1)
    assert (
        simulate(replace(FREE, friction=Bristles(coefficient=0.1)), **thrown | {"duration": 1e-4}).position_error
        is None
    )
    late = simulate(FREE, **thrown | {"velocity": (0.0, 0.0, 1e6), "step": 1e-4})
    assert late.end_reason
    assert late.position_error is None


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


@pytest.mark.parametrize("step", some([2e-5, 2e-6, 2e-7], 2))
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
    motion = simulate(FREE, **{**THROW, "velocity": (0.0, 0.0, 1e7)}, duration=1e-3)
    assert len(motion.time) == 1
    assert "exceeds the wall thickness" in motion.end_reason
    nan_motion = simulate(FREE, **{**THROW, "position": (nan, 0.0, 0.0)}, duration=1e-3)
    assert "after 0 s: the state is not finite" in nan_motion.end_reason
    assert "r = (0, 0, 20) mm" in simulate(FREE, **{**THROW, "position": (0.0, 0.0, 20.0)}, duration=1e-3).end_reason


@pytest.mark.parametrize("friction", [Friction(coefficient=0.1), Bristles(coefficient=0.1)])
def test_motion_ends_where_the_ball_leaves_the_cup(friction):
    element = replace(FREE, cup=bs.Cup(), friction=friction)
    motion = simulate(element, duration=0.01, **{**THROW, "velocity": (0.0, 0.0, -300.0)})
    assert "has left the cup over its rim" in motion.end_reason
    assert float(motion.end_reason.split()[1]) == pytest.approx(motion.time[-1], abs=1.01 * 2e-5)
    assert len(motion.time) == pytest.approx(HIP.clearance / 300.0 / 2e-5, abs=2)


def test_free_flight_is_uniform_and_falls_under_the_pull_at_the_midpoint_of_each_step():
    """Without contact 1 kg under 9.80665 N falls by g t²/2, and its spin stays."""
    thrown = {"mass": 1.0, "position": (0.0, 0.01, -0.04), "velocity": (1.0, -2.0, 3.0), "spin": (1.0, -2.0, 3.0)}
    motion = simulate(FREE, pull=(0.0, 0.0, 9.80665), duration=5e-3, step=1e-3, **thrown)
    t = motion.time
    np.testing.assert_allclose(t, np.arange(6) * 1e-3, rtol=1e-12)
    np.testing.assert_allclose(motion.position[:, 2], -0.04 + 3.0 * t + 9806.65 * t**2 / 2, rtol=1e-12)
    np.testing.assert_allclose(motion.velocity, np.stack([1 + 0 * t, -2 + 0 * t, 3 + 9806.65 * t], axis=1))
    np.testing.assert_allclose(motion.spin, np.tile([1.0, -2.0, 3.0], (6, 1)))
    assert not motion.dissipated_energy.any()
    assert motion.bounces == 0
    np.testing.assert_allclose(motion.work, 9.80665 * (motion.position[:, 2] + 0.04), atol=1e-15)
    expected = np.cross(motion.position, motion.velocity) * 1e-3
    np.testing.assert_allclose(motion.angular_momentum, expected)
    np.testing.assert_allclose(motion.pull_moment, expected - expected[0], atol=1e-16)
    # the impulse of a pull that grows linearly is exact by the midpoint rule: v = a t²/2
    motion = simulate(FREE, mass=2.0, position=(0, 0, 0), pull=lambda t: (t, 0.0, 0.0), duration=0.05, step=0.01)
    np.testing.assert_allclose(motion.velocity[:, 0], 1e3 / 2.0 * motion.time**2 / 2, rtol=1e-12)


def test_kinetic_energy_is_that_of_a_solid_ball():
    """0.5 kg at 0.3 m/s has 22.5 mJ; a solid ball of 17.9 mm has 0.4 m R²."""
    still = {"mass": 0.5, "position": (0, 0, 0), "spin": (0, 10.0, 0), "duration": 1e-5, "step": 1e-5}
    motion = simulate(FREE, velocity=(0, 0, 300.0), **still)
    assert motion.inertia == pytest.approx(0.4 * 0.5 * 17.9**2)
    assert motion.kinetic_energy[0] == pytest.approx(22.5 + 0.5 * 1e-3 * 0.4 * 0.5 * 17.9**2 * 100.0)
    heavy = simulate(FREE, inertia=7.0, **still)
    assert heavy.kinetic_energy[0] == pytest.approx(0.5 * 1e-3 * 7.0 * 100.0)


def test_summary_of_a_motion_has_its_ends_and_extremes():
    motion = simulate(LOSSY, duration=2e-3, **THROW)
    summary = motion.summary()
    assert summary["duration"] == pytest.approx(2e-3)
    assert summary["steps"] == 100
    assert summary["deepest"] == motion.indentation.max() > 0
    assert summary["largest_force"] == np.linalg.norm(motion.load.force, axis=1).max()
    assert summary["stored"] + summary["kinetic"] + summary["lost"] == pytest.approx(motion.total_energy[0], rel=1e-12)
    crossings = np.sum((motion.indentation[:-1] > 0) & (motion.indentation[1:] <= 0))
    assert summary["bounces"] == crossings > 0


@pytest.mark.parametrize(("duration", "step", "steps"), [(1e-3, 1e-4, 10), (1.05e-3, 1e-4, 11), (1e-5, 1e-3, 1)])
def test_steps_are_shortened_to_fill_the_duration(duration, step, steps):
    motion = simulate(FREE, mass=1.0, position=(0, 0, 0), velocity=(1.0, 0, 0), duration=duration, step=step)
    assert len(motion.time) == steps + 1
    assert motion.time[-1] == pytest.approx(duration, rel=1e-12)
    assert motion.position[-1, 0] == pytest.approx(duration, rel=1e-12)


@pytest.mark.parametrize("law", [Friction(coefficient=0.5, transition_speed=1.0), Friction(coefficient=0, viscous=1)])
def test_steps_with_friction_stiffer_than_inertia_converge(law):
    element = replace(FREE, friction=law, damping=Damping(hysteresis=0.01, time=1e-3))
    thrown = {"mass": 0.1, "position": (0.0, 0.02, HIP.clearance + 0.03), "duration": 2e-3, "step": 1e-4}
    motion = simulate(element, velocity=(30.0, -20.0, 5.0), spin=(3.0, 2.0, -4.0), pull=(0, 0, 800.0), **thrown)
    assert motion.end_reason == ""
    assert motion.drift < 1e-10
    assert (np.diff(motion.dissipated_energy) >= 0).all()


def test_friction_at_the_pole_turns_a_sliding_ball_until_it_rolls():
    """The impulse j of friction has the lever R; without slip at the pole the ball has v = R ω."""
    element = replace(FREE, friction=Friction(coefficient=0.2, transition_speed=0.1))
    deep = HIP.clearance + FREE.model.press(HIP, force=900.0).indentation
    thrown = {"mass": 1.0, "position": (0.0, 0.0, deep), "velocity": (0.0, 2.0, 0.0), "duration": 1e-4, "step": 2e-6}
    motion = simulate(element, pull=(0.0, 0.0, 900.0), spin=(0.5, 0.0, 0.0), **thrown)
    impulse = motion.mass * (motion.velocity[1, 1] - 2.0)
    assert impulse == pytest.approx(0.2 * 900.0 * 2e-6 * 1e3, rel=0.03)
    assert motion.inertia * (motion.spin[1, 0] - 0.5) == pytest.approx(-HIP.ball_radius * impulse, rel=5e-3)
    assert motion.velocity[-1, 1] == pytest.approx(HIP.ball_radius * motion.spin[-1, 0], rel=5e-3)
