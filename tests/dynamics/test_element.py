"""Force element: gradient of its energy, equal and opposite loads on both bodies, and non-negative dissipation."""

import json
from dataclasses import replace
from itertools import product
from math import inf, nan, radians

import array_api_strict
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, Flores, Friction, Prony

from ..extent import either
from ..joints import HIP

C = HIP.clearance
LOSSY = {"damping": Damping(hysteresis=0.01, time=2e-4)}
LOSSY["friction"] = Friction(coefficient=0.05, static_coefficient=0.08, viscous=1e-4)
CUPS = {"sphere": None, "cup": bs.Cup(), "leaning cup": bs.Cup(inclination=radians(50.0), arc_of_cover=radians(150.0))}
EVERY_CUP = pytest.mark.parametrize("cup", CUPS.values(), ids=CUPS)
LAWS = ["hess-forsbach", "bartel", "hertz", "refined", "tabulated", pytest.param("exact", marks=pytest.mark.long)]


def states(count, seed=1, deepest=0.08):
    random = np.random.default_rng(seed)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    depth = random.uniform(-0.3 * deepest, deepest, count)
    position = direction * (C + depth)[:, None]
    return position, random.normal(scale=100.0, size=(count, 3)), random.normal(scale=5.0, size=(count, 3))


def test_lists_and_tuples_of_vectors_are_states_of_an_array():
    element, (r, v, w) = bs.ForceElement(bs.HessForsbach(), HIP, **LOSSY), states(4)
    wanted = element(r, v, w)
    for kind in (list, tuple):
        load = element(*(kind(map(kind, part.tolist())) for part in (r, v, w)))
        assert np.array_equal(load.force, wanted.force)
        assert np.array_equal(load.moment, wanted.moment)


@pytest.mark.parametrize("name", LAWS)
def test_force_in_any_direction_equals_that_of_the_model(name):
    model = bs.catalogue[name]
    element = bs.ForceElement(model, HIP)
    position = states(40)[0]
    load = element(position)
    distance = np.linalg.norm(position, axis=1)
    pressed, touching = model.press(HIP, indentation=np.maximum(distance - C, 0.0)), distance > C
    np.testing.assert_allclose(load.force, model.force_vector(HIP, position), rtol=2e-9, atol=1e-9)
    np.testing.assert_allclose(load.energy, pressed.energy, rtol=1e-8, atol=1e-12)
    for name in ("half_angle", "max_pressure"):
        np.testing.assert_allclose(getattr(load, name)[touching], getattr(pressed, name)[touching], rtol=1e-8)
    stiffness = np.einsum("ni,nij,nj->n", position, load.tangent, position) / distance**2
    np.testing.assert_allclose(stiffness[touching], pressed.stiffness[touching], rtol=2e-7)


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz(), bs.Tabulated()], ids=lambda model: model.name)
@EVERY_CUP
@pytest.mark.parametrize("smoothing", [0.0, 0.02])
def test_force_and_tangent_are_derivatives_of_the_energy(model, cup, smoothing):
    element = bs.ForceElement(model, HIP, cup=cup, smoothing=smoothing)
    position, step = states(60)[0], 1e-5
    load = element(position)
    shifted = [(element(position + step * axis), element(position - step * axis)) for axis in np.eye(3)]
    force = -np.stack([(up.energy - down.energy) / (2 * step) for up, down in shifted], axis=-1)
    tangent = -np.stack([(up.force - down.force) / (2 * step) for up, down in shifted], axis=-1)
    steady = abs(np.linalg.norm(position, axis=1) - C) > 4 * step  # k has a corner at first touch
    scale = np.abs(load.force).max(), np.abs(load.tangent).max()
    np.testing.assert_allclose(load.force, force, atol=1e-7 * scale[0])
    np.testing.assert_allclose(load.tangent[steady], tangent[steady], atol=1e-7 * scale[1])
    np.testing.assert_array_equal(load.tangent, np.swapaxes(load.tangent, -1, -2))


def check_damping_matrix(element, position, velocity, spin):
    """The damping matrix is symmetric and the derivative of the loads over the rates."""
    matrix, step = element(position, velocity, spin).damping_matrix, 1e-4
    differences, rates = np.zeros_like(matrix), np.concatenate([velocity, spin], axis=1)
    for axis in range(6):
        ends = [element(position, *np.hsplit(rates + sign * step * np.eye(6)[axis], 2)) for sign in (1, -1)]
        loads = [np.concatenate([end.force, end.moment], axis=1) for end in ends]
        differences[:, :, axis] = (loads[1] - loads[0]) / (2 * step)
    np.testing.assert_allclose(matrix, differences, atol=1e-6 * np.abs(matrix).max())
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, -1, -2), atol=1e-12 * np.abs(matrix).max())


@EVERY_CUP
def test_damping_matrix_is_symmetric_and_the_derivative_over_the_speeds(cup):
    for name in ("damping", "friction"):
        check_damping_matrix(bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, **{name: LOSSY[name]}), *states(30))
    viscous = Friction(coefficient=0.0, viscous=1e-4)
    check_damping_matrix(bs.ForceElement(bs.HessForsbach(), HIP, friction=viscous), *states(30))


@EVERY_CUP
def test_loads_on_both_bodies_are_equal_and_opposite(cup):
    position, *rates = states(1000)
    load = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, **LOSSY)(position, *rates)
    np.testing.assert_array_equal(load.socket_force, -load.force)
    # the force on the ball has a moment about the socket centre
    total = load.moment + np.cross(position, load.force) + load.socket_moment
    assert np.abs(total).max() <= 1e-12 * np.abs(load.moment).max()


@EVERY_CUP
@pytest.mark.parametrize("smoothing", [0.0, 0.02])
def test_dissipation_is_positive_and_balances_the_power(cup, smoothing):
    random = np.random.default_rng(7)
    count = either(quick=10**4, long=10**5)
    elastic = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, smoothing=smoothing)
    flores = Flores(restitution=0.2, impact_speed=100.0)
    for damping, friction in product((None, flores, LOSSY["damping"]), (None, LOSSY["friction"])):
        element = replace(elastic, damping=damping, friction=friction)
        position, velocity, spin = states(count, seed=int(random.integers(1000)))
        velocity = velocity * 10.0 ** random.uniform(-3, 2, (count, 1))
        load, stored = element(position, velocity, spin), elastic(position).force
        assert (load.dissipation >= 0.0).all()
        parts = load.force * velocity, -stored * velocity, load.moment * spin
        size = np.sum(np.abs(parts), axis=(0, 2))
        assert (np.abs(np.sum(parts, axis=(0, 2)) + load.dissipation) <= 1e-12 * size).all()


def test_smoothed_force_is_twice_differentiable_and_exact_beyond_the_smoothing():
    sharp, smooth = (bs.ForceElement(bs.Hertz(), HIP, smoothing=width) for width in (0.0, 0.02))
    deep = np.array([[0.0, 0.0, C + depth] for depth in (0.0201, 0.05)])
    np.testing.assert_array_equal(smooth(deep).force, sharp(deep).force)
    d, step = np.array([-0.02, 0.0, 0.02])[:, None], 1e-7
    distance = C + d + step * np.array([-1.0, 1.0])
    tangent = smooth(np.stack([0 * distance, 0 * distance, distance], axis=-1)).tangent[..., 2, 2]
    bend = np.diff(tangent, axis=1)[:, 0] / (2 * step)
    assert bend[0] == pytest.approx(0.0, abs=1e-3 * bend[2])
    assert smooth((0.0, 0.0, C - 0.0201)).force == (0.0, 0.0, 0.0)
    widest = replace(sharp, smoothing=C)
    assert widest((0.0, 0.0, 1e-3)).force[2] < 0
    assert widest((0.0, 0.0, 0.0)).force == (0.0, 0.0, 0.0)


def test_force_vanishes_over_the_rim_and_the_notes_report_it():
    angles = np.radians([0.0, 30.0, 60.0, 90.0, 120.0, 130.0, 170.0])
    position = (C + 0.05) * np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=-1)
    load = bs.ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup())(position)
    size = np.linalg.norm(load.force, axis=1)
    assert load.status.tolist() == [ContactState.CONTACT] * 2 + [ContactState.AT_RIM] * 4 + [ContactState.OVER_RIM]
    assert size[1] == pytest.approx(size[0], rel=1e-12)
    assert (np.diff(size[1:]) < 0).all()
    assert size[-1] == 0.0
    assert load.energy[3] == pytest.approx(load.energy[0] / 2, rel=1e-12)
    assert load.force[3, 2] < 0  # at the rim the force points out of the cup
    assert any("over its rim" in note for note in load.notes)


def test_numbers_and_arrays_of_any_library_agree():
    parts = {"cup": CUPS["leaning cup"], "smoothing": 0.01, "lubricant": bs.Lubricant(), "film_tension": 0.1, **LOSSY}
    element = bs.ForceElement(bs.Tabulated(), HIP, **parts)
    position, velocity, spin = states(12)
    load = element(position, velocity, spin)
    strict = element(*map(array_api_strict.asarray, (position, velocity, spin)))
    names = ("force", "moment", "energy", "tangent", "dissipation", "socket_moment")
    for name in (*names, "half_angle", "status", "film_thickness"):
        expected = getattr(load, name)
        np.testing.assert_allclose(np.asarray(getattr(strict, name)), expected, rtol=1e-13, atol=1e-12)
        single = [getattr(element(*state), name) for state in zip(*(x.tolist() for x in states(12)), strict=True)]
        np.testing.assert_allclose(np.array(single, dtype=float), expected, rtol=1e-9, atol=1e-9)
    assert type(element((0.0, 0.0, 0.12)).tangent[0]) is tuple


@pytest.mark.parametrize(
    ("state", "status"),
    [
        (((0.0, 0.0, C + 30.0),), ContactState.THROUGH_WALL),
        (((0.0, 0.0, inf),), ContactState.NO_NUMBER),
        (((nan, 0.0, 0.1),), ContactState.NO_NUMBER),
        (((0.0, 0.0, 0.12), (0.0, nan, 0.0)), ContactState.NO_NUMBER),
        (((1e200, 0.0, 0.0),), ContactState.NO_NUMBER),
        (((0.0, 0.0, 0.05),), ContactState.FREE),
        (((0.0, 0.0, 0.12),), ContactState.CONTACT),
    ],
)
@pytest.mark.parametrize(
    "losses",
    [{}, LOSSY, {"friction": Bristles(coefficient=0.1)}, {"relaxation": Prony(terms=((0.3, 0.1),))}],
    ids=["none", "lossy", "held", "relaxing"],
)
def test_status_and_notes_report_states_without_a_result(state, status, losses):
    element = bs.ForceElement(bs.HessForsbach(), HIP, **losses)
    load = element(*state)
    assert load.status is status
    assert element(*map(np.array, state)).status == status
    assert status.failed == bool(np.isnan(load.force).any())
    assert bool(load.notes) == status.failed
    if status is ContactState.THROUGH_WALL:
        assert "exceeds the wall thickness" in load.notes[0]
        assert "r = (0, 0, 30.1) mm, d = 30 mm" in load.notes[0]


@pytest.mark.parametrize("rates", [((0.0, 0.0, 1e200),), ((0.0, 0.0, 0.0), (1e300, 0.0, 0.0))], ids=["speed", "spin"])
@pytest.mark.parametrize("friction", [LOSSY["friction"], Bristles(coefficient=0.1)], ids=["friction", "bristles"])
def test_status_reports_overflow_and_nan_of_rates_and_bristles(rates, friction):
    element = bs.ForceElement(bs.HessForsbach(), HIP, friction=friction)
    assert element((0.0, 0.0, 0.12), *rates).status is ContactState.NO_NUMBER
    several = element(np.array([[0.0, 0.0, 0.12]] * 2), *(np.array([(0.0, 0.0, 1.0), rate]) for rate in rates))
    assert several.status.tolist() == [ContactState.CONTACT, ContactState.NO_NUMBER]
    if isinstance(friction, Bristles):
        assert element((0.0, 0.0, 0.12), deflection=(nan, 0.0, 0.0, 0.0)).status is ContactState.NO_NUMBER


def test_each_element_warns_once_that_its_model_is_not_valid(caplog):
    element = bs.ForceElement(bs.Hertz(), HIP)
    array = replace(element)
    element((0.0, 0.0, C + 1.01 * element.wall))  # has no result
    element((0.0, 0.0, C + 1e-5))
    assert caplog.messages == []
    for depth in (0.05, 0.06):
        element((0.0, 0.0, C + depth))
        element(np.array([[0.0, 0.0, C + depth]]))
    array(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, C + 0.05]]))
    first, second = caplog.messages
    assert first == second
    assert first.startswith("hertz at an indentation of 0.05 mm: outside ε")


def test_contacts_that_begin_too_narrow_for_their_model_and_trial_states_are_not_reported(caplog):
    element = bs.ForceElement(bs.HessForsbach(), HIP)
    for depth in (1e-6, 0.003, 0.05):
        element((0.0, 0.0, C + depth))
    assert not element.model.press(HIP, indentation=0.003).valid
    assert caplog.messages == []
    with element.validity_monitor.paused():
        element((0.0, 0.0, C + 0.7))  # a trial state
    assert caplog.messages == []
    element((0.0, 0.0, C + 0.7))
    assert len(caplog.messages) == 1


def test_normal_force_of_a_leaving_ball_is_zero_and_never_tensile():
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=Damping(hysteresis=0.01))
    still = element((0.0, 0.0, C + 0.05)).force[2]
    for speed, share in ((-50.0, 0.5), (-100.0, 0.0), (-150.0, 0.0), (100.0, 2.0)):
        assert element((0.0, 0.0, C + 0.05), (0.0, 0.0, speed)).force[2] == pytest.approx(share * still, abs=1e-9)


def test_retarded_liner_drags_a_contact_that_moves_along_the_socket():
    """The power is τ F v²/e for a speed v across the load at a distance e of the centres."""
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=Damping(time=2e-4))
    load = element((0.0, 0.0, C + 0.05), (30.0, 0.0, 0.0))
    drag = 2e-4 * -load.force[2] * 30.0 / (C + 0.05)
    assert load.force[0] == pytest.approx(-drag, rel=1e-12)
    assert load.dissipation == pytest.approx(30.0 * drag, rel=1e-12)
    pressed = element((0.0, 0.0, C + 0.05), (0.0, 0.0, 30.0))
    assert pressed.dissipation == pytest.approx(2e-4 * load.tangent[2][2] * 30.0**2, rel=1e-12)


def test_jax_derivatives_of_the_energy_equal_force_and_tangent():
    jax = pytest.importorskip("jax")
    element = bs.ForceElement(bs.Tabulated(), HIP, cup=CUPS["leaning cup"], smoothing=0.02)
    with jax.enable_x64(True):
        slope, bend = (jax.jit(derive(lambda r: element(r).energy)) for derive in (jax.grad, jax.hessian))
        push = jax.jit(lambda r: element(r, 10.0 * r, r).force)
        for centre in ([0.01, 0.02, C], [0.0, 0.0, 0.0], [0.0, 0.0, C + 0.05], [C + 0.04, 0.0, 0.02]):
            position = jax.numpy.asarray(centre)
            load = element(position)
            np.testing.assert_allclose(-slope(position), load.force, atol=1e-9)
            np.testing.assert_allclose(bend(position), load.tangent, atol=1e-8)
            np.testing.assert_allclose(push(position), element(position, 10.0 * position, position).force, atol=1e-9)


def test_summary_of_a_load_is_json():
    element = bs.ForceElement(bs.HessForsbach(), HIP, **LOSSY)
    for position in ((0.0, 0.0, C + 0.04), np.array([[0.0, 0.0, C + 0.04], [0.0, 0.0, nan]])):
        summary = json.loads(json.dumps(element(position).summary(), allow_nan=False))
        assert {"force", "socket_moment", "energy", "half_angle_deg", "max_pressure"} <= set(summary)
    assert summary["energy"][1] is None
    assert element((0.0, 0.0, C + 0.04)).summary()["status"] == "contact"
