"""The force element: a gradient of its energy, one law for both bodies, and nothing made out of nothing."""

import json
import logging
from dataclasses import replace
from math import inf, nan, pi, radians

import array_api_strict
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, Flores, Friction

from ..extent import either
from ..joints import HIP

C = HIP.clearance
LOSSY = {
    "damping": Damping(hysteresis=0.01, time=2e-4),
    "friction": Friction(coefficient=0.05, static_coefficient=0.08, viscous=1e-4),
}
CUPS = {"sphere": None, "cup": bs.Cup(), "leaning cup": bs.Cup(inclination=radians(50.0), arc_of_cover=radians(150.0))}
EVERY_CUP = pytest.mark.parametrize("cup", CUPS.values(), ids=CUPS)
LAWS = ["hess-forsbach", "bartel", "hertz", "refined", "tabulated", "exact"]
EVERY_LAW = pytest.mark.parametrize("model", [bs.catalogue[name] for name in LAWS], ids=LAWS)


def states(count, seed=1, deepest=0.08):
    random = np.random.default_rng(seed)
    way = random.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    depth = random.uniform(-0.3 * deepest, deepest, count)
    position = way * (C + depth)[:, None]
    return position, random.normal(scale=100.0, size=(count, 3)), random.normal(scale=5.0, size=(count, 3))


@EVERY_LAW
def test_the_force_is_that_of_a_press_whichever_way_the_ball_lies(model):
    element = bs.ForceElement(model, HIP)
    position = states(40)[0]
    load = element(position)
    d = np.linalg.norm(position, axis=1) - C
    pressed = model.press(HIP, indentation=np.maximum(d, 0.0))
    np.testing.assert_allclose(load.force, model.force_vector(HIP, position), rtol=2e-9, atol=1e-9)
    np.testing.assert_allclose(load.energy, pressed.energy, rtol=1e-8, atol=1e-12)
    touching = d > 0
    np.testing.assert_allclose(load.half_angle[touching], pressed.half_angle[touching], rtol=1e-8)
    np.testing.assert_allclose(load.max_pressure[touching], pressed.max_pressure[touching], rtol=1e-8)
    stiffness = np.einsum("ni,nij,nj->n", position, load.tangent, position) / np.linalg.norm(position, axis=1) ** 2
    np.testing.assert_allclose(stiffness[touching], pressed.stiffness[touching], rtol=2e-7)


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz(), bs.Tabulated()], ids=lambda model: model.name)
@EVERY_CUP
@pytest.mark.parametrize("smoothing", [0.0, 0.02])
def test_the_force_is_the_slope_of_the_energy_and_the_tangent_that_of_the_force(model, cup, smoothing):
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


@EVERY_CUP
def test_the_damping_matrix_is_the_slope_over_the_speeds_at_its_normal_force_and_symmetric(cup):
    friction = Friction(coefficient=0.0, viscous=1e-4)
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=LOSSY["damping"], cup=cup)
    rubbing = bs.ForceElement(bs.HessForsbach(), HIP, friction=LOSSY["friction"], cup=cup)
    for each in (element, rubbing, bs.ForceElement(bs.HessForsbach(), HIP, friction=friction)):
        position, velocity, spin = (np.asarray(part) for part in states(30))
        D = each(position, velocity, spin).damping_matrix
        found, rates, step = np.zeros_like(D), np.concatenate([velocity, spin], axis=1), 1e-4
        for axis in range(6):
            shift = step * np.eye(6)[axis]
            up, down = (each(position, (rates + way)[:, :3], (rates + way)[:, 3:]) for way in (shift, -shift))
            ends = [np.concatenate([end.force, end.moment], axis=1) for end in (up, down)]
            found[:, :, axis] = -(ends[0] - ends[1]) / (2 * step)
        np.testing.assert_allclose(D, found, atol=1e-6 * np.abs(D).max())
        np.testing.assert_allclose(D, np.swapaxes(D, -1, -2), atol=1e-12 * np.abs(D).max())


@EVERY_CUP
def test_action_is_reaction_in_force_and_moment(cup):
    load = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, **LOSSY)(*states(1000))
    position = states(1000)[0]
    np.testing.assert_array_equal(load.socket_force, -load.force)
    # about the socket's centre, the ball's force acts at its own centre
    total = load.moment + np.cross(position, load.force) + load.socket_moment
    assert np.abs(total).max() <= 1e-12 * np.abs(load.moment).max()


@EVERY_CUP
@pytest.mark.parametrize("smoothing", [0.0, 0.02])
def test_nothing_is_made_out_of_nothing(cup, smoothing):
    """10^5 states of any place, speed and spin, with every damping and friction."""
    random = np.random.default_rng(7)
    count = either(quick=10**4, long=10**5)
    elastic = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, smoothing=smoothing)
    for damping in (None, Flores(restitution=0.2, impact_speed=100.0), LOSSY["damping"]):
        for friction in (None, LOSSY["friction"]):
            element = replace(elastic, damping=damping, friction=friction)
            position, velocity, spin = states(count, seed=int(random.integers(1000)))
            velocity = velocity * 10.0 ** random.uniform(-3, 2, (count, 1))
            load, stored = element(position, velocity, spin), elastic(position).force
            assert (load.dissipation >= 0.0).all()
            work = np.sum((load.force - stored) * velocity + load.moment * spin, axis=1)
            size = np.sum(
                np.abs(load.force * velocity) + np.abs(stored * velocity) + np.abs(load.moment * spin), axis=1
            )
            assert (np.abs(work + load.dissipation) <= 1e-12 * size).all()


@pytest.mark.parametrize(("cup", "polar"), [(None, 0.3), (bs.Cup(), 1.5)], ids=["sphere", "over the rim"])
def test_the_work_of_a_closed_way_is_nothing(cup, polar):
    """∮ f·dr over ways in three dimensions that stay in contact: the trapezoidal rule is exact for smooth periods."""
    element = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup, smoothing=0.005)
    random, count = np.random.default_rng(3), 2000
    t = 2 * pi * np.arange(count) / count
    for _ in range(3):
        wave = [sum(random.normal(scale=0.3 / k) * np.sin(k * t + random.uniform(0, 6)) for k in (1, 2)) for _ in "eab"]
        e, lean, turn = C + 0.05 * (1.0 + 0.3 * wave[0]), polar + 0.1 * wave[1], wave[2]
        way = e[:, None] * np.stack([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)], axis=-1)
        rate = np.fft.ifft(1j * np.fft.fftfreq(count, 1 / count)[:, None] * np.fft.fft(way, axis=0), axis=0).real
        load = element(way)
        power = np.einsum("ni,ni->n", load.force, rate)
        assert np.ptp(load.energy) > 0.2 * load.energy.max()
        assert abs(power.mean()) <= 1e-10 * np.abs(power).max()
        if cup is not None:
            assert set(load.status.tolist()) == {ContactState.AT_RIM}


def test_force_and_stiffness_are_continuous_at_touch_down_and_there_is_none_within_the_clearance():
    for model in (bs.HessForsbach(), bs.Refined(), bs.Hertz()):
        element = bs.ForceElement(model, HIP)
        assert element((0.0, 0.0, 0.99 * C)).force == (0.0, 0.0, 0.0)
        deep = element((0.0, 0.0, C + 0.05))
        for depth, share in ((1e-6, 1e-2), (1e-10, 1e-4)):
            near = element((0.0, 0.0, C + depth))
            assert abs(near.force[2]) < share * abs(deep.force[2])
            assert near.tangent[2][2] < share * deep.tangent[2][2]


def test_a_smooth_touch_down_is_twice_differentiable_and_the_law_beyond_it():
    sharp, smooth = (bs.ForceElement(bs.Hertz(), HIP, smoothing=width) for width in (0.0, 0.02))
    deep = np.array([[0.0, 0.0, C + depth] for depth in (0.0201, 0.05)])
    np.testing.assert_array_equal(smooth(deep).force, sharp(deep).force)
    d, step = np.array([-0.02, 0.0, 0.02])[:, None], 1e-7
    around = C + d + step * np.array([-1.0, 1.0])
    tangent = smooth(np.stack([0 * around, 0 * around, around], axis=-1)).tangent[..., 2, 2]
    bend = np.diff(tangent, axis=1)[:, 0] / (2 * step)
    assert bend[0] == pytest.approx(0.0, abs=1e-3 * bend[2])
    assert smooth((0.0, 0.0, C - 0.0201)).force == (0.0, 0.0, 0.0)


def test_over_the_rim_the_force_dies_out_and_says_so():
    cup = bs.Cup()
    element = bs.ForceElement(bs.HessForsbach(), HIP, cup=cup)
    e = C + 0.05
    angles = np.radians([0.0, 30.0, 60.0, 90.0, 120.0, 130.0, 170.0])
    load = element(e * np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=-1))
    size = np.linalg.norm(load.force, axis=1)
    assert load.status.tolist() == [ContactState.CONTACT] * 2 + [ContactState.AT_RIM] * 4 + [ContactState.OVER_RIM]
    assert size[1] == pytest.approx(size[0], rel=1e-12)
    assert (np.diff(size[1:]) < 0).all()
    assert size[-1] == 0.0
    assert load.energy[3] == pytest.approx(load.energy[0] / 2, rel=1e-12)
    assert load.force[3, 2] < 0  # on the rim it is pushed out
    assert any("over its rim" in note for note in load.notes)


def test_numbers_and_arrays_of_any_library_say_the_same():
    element = bs.ForceElement(bs.Tabulated(), HIP, cup=CUPS["leaning cup"], smoothing=0.01, **LOSSY)
    position, velocity, spin = states(12)
    load = element(position, velocity, spin)
    strict = element(*map(array_api_strict.asarray, (position, velocity, spin)))
    for name in ("force", "moment", "energy", "tangent", "dissipation", "socket_moment", "half_angle", "status"):
        whole = getattr(load, name)
        np.testing.assert_allclose(np.asarray(getattr(strict, name)), whole, rtol=1e-13, atol=1e-12)
        single = [
            getattr(element(*map(tuple, state)), name) for state in np.stack([position, velocity, spin], 1).tolist()
        ]
        np.testing.assert_allclose(np.array(single, dtype=float), whole, rtol=1e-9, atol=1e-9)
    assert type(element((0.0, 0.0, 0.12)).tangent[0]) is tuple


@pytest.mark.parametrize(
    ("state", "touch"),
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
@pytest.mark.parametrize("lost", [{}, LOSSY, {"friction": Bristles(coefficient=0.1)}], ids=["elastic", "lossy", "held"])
def test_a_state_without_an_answer_is_flagged_and_named(state, touch, lost):
    element = bs.ForceElement(bs.HessForsbach(), HIP, **lost)
    load = element(*state)
    assert load.status is touch
    assert element(*map(np.array, state)).status == touch
    assert touch.failed == bool(np.isnan(load.force).any())
    assert bool(load.notes) == touch.failed
    if touch is ContactState.THROUGH_WALL:
        assert "deeper than the wall" in load.notes[0]
        assert "r = (0, 0, 30.1) mm, d = 30 mm" in load.notes[0]


@pytest.mark.parametrize("rates", [((0.0, 0.0, 1e200),), ((0.0, 0.0, 0.0), (1e300, 0.0, 0.0))], ids=["speed", "spin"])
@pytest.mark.parametrize("friction", [LOSSY["friction"], Bristles(coefficient=0.1)], ids=["friction", "bristles"])
def test_rates_too_large_to_square_and_bristles_that_are_no_number_are_flagged(rates, friction):
    element = bs.ForceElement(bs.HessForsbach(), HIP, friction=friction)
    assert element((0.0, 0.0, 0.12), *rates).status is ContactState.NO_NUMBER
    several = element(np.array([[0.0, 0.0, 0.12]] * 2), *(np.array([(0.0, 0.0, 1.0), rate]) for rate in rates))
    assert several.status.tolist() == [ContactState.CONTACT, ContactState.NO_NUMBER]
    if isinstance(friction, Bristles):
        bent = element((0.0, 0.0, 0.12), deflection=(nan, 0.0, 0.0, 0.0))
        assert bent.status is ContactState.NO_NUMBER


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Damping(hysteresis=-0.1), "hysteresis = -0.1 is not allowed: damping is 0 or more"),
        (lambda: Damping(time=nan), "time = nan is not allowed"),
        (lambda: Flores(restitution=1.1, impact_speed=1.0), "restitution = 1.1 is not allowed"),
        (lambda: Flores(restitution=0.5, impact_speed=0.0), "impact_speed = 0 is not allowed"),
        (lambda: Friction(coefficient=-0.1), "coefficient = -0.1 is not allowed: friction is 0 or more"),
        (lambda: Friction(coefficient=0.1, static_coefficient=0.05), "static friction is not below"),
        (lambda: bs.ForceElement(bs.HessForsbach(), HIP, smoothing=0.2), "at most the clearance"),
        (lambda: bs.ForceElement(bs.HessForsbach(), HIP)((0.0, 1.0)), "a state has three components"),
    ],
)
def test_what_is_not_allowed_is_refused(make, sentence):
    with pytest.raises(ValueError, match=sentence):
        make()
    with pytest.raises(TypeError, match="damping must be a Damping, got 0.3"):
        bs.ForceElement(bs.HessForsbach(), HIP, damping=0.3)


def test_a_law_outside_its_validity_says_so_once(caplog):
    element = bs.ForceElement(bs.Hertz(), HIP)
    with caplog.at_level(logging.WARNING, logger="ballsocket.dynamics"):
        element((0.0, 0.0, C + 1e-5))
        assert caplog.messages == []
        for depth in (0.05, 0.06):
            element((0.0, 0.0, C + depth))
            element(np.array([[0.0, 0.0, C + depth]]))
    (said,) = caplog.messages
    assert said.startswith("hertz at an indentation of 0.05 mm: outside ε")


def test_jax_finds_force_and_tangent_as_derivatives_of_the_energy():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        _derived(jax)


def _derived(jax):
    for model in (bs.HessForsbach(), bs.Tabulated()):
        element = bs.ForceElement(model, HIP, cup=CUPS["leaning cup"], smoothing=0.02)
        for place in ([0.01, 0.02, C], [0.0, 0.0, 0.0], [0.0, 0.0, C + 0.05], [C + 0.04, 0.0, 0.02]):
            position = jax.numpy.asarray(place)
            load = element(position)
            slope, bend = (way(lambda r, each=element: each(r).energy)(position) for way in (jax.grad, jax.hessian))
            np.testing.assert_allclose(-slope, load.force, atol=1e-9)
            np.testing.assert_allclose(bend, load.tangent, atol=1e-8)
            pushed = jax.jit(lambda r, each=element: each(r, 10.0 * r, r).force)(position)
            np.testing.assert_allclose(pushed, element(position, 10.0 * position, position).force, atol=1e-9)


def test_a_load_is_told_in_json():
    element = bs.ForceElement(bs.HessForsbach(), HIP, **LOSSY)
    for position in ((0.0, 0.0, C + 0.04), np.array([[0.0, 0.0, C + 0.04], [0.0, 0.0, nan]])):
        told = json.loads(json.dumps(element(position).summary(), allow_nan=False))
        assert {"force", "socket_moment", "energy", "half_angle_deg", "max_pressure"} <= set(told)
    assert told["energy"][1] is None
    assert element((0.0, 0.0, C + 0.04)).summary()["status"] == "contact"
