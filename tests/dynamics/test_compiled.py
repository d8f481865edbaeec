"""Compiled element: the same loads and steps as the element."""

from importlib import import_module

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Friction, simulate

from ..extent import either
from ..joints import HIP
from .test_element import LOSSY, states

numba = pytest.importorskip("numba")
compiled = import_module("ballsocket.dynamics.compiled")


@pytest.fixture
def interpreted(monkeypatch):
    """Run the loops of the module in Python, without the time of their compilation."""
    cached_loops = [value for value in vars(compiled).values() if hasattr(value, "cache_clear")]
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    for loop in cached_loops:
        loop.cache_clear()
    yield
    for loop in cached_loops:
        loop.cache_clear()


def check_loads(element, count):
    fast = compiled.CompiledElement(element)
    force, moment, energy, tangent = fast.loads(*states(count))
    load = element(*states(count))
    np.testing.assert_allclose(force, load.force, atol=1e-9 * np.abs(load.force).max())
    np.testing.assert_allclose(moment, load.moment, atol=1e-9 * np.abs(load.moment).max())
    np.testing.assert_allclose(energy, load.energy, rtol=1e-8, atol=1e-12)
    six = [load.tangent[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
    np.testing.assert_allclose(tangent, np.stack(six, axis=1), atol=1e-8 * np.abs(load.tangent).max())
    for depth in (1e-7, 1e-3, 0.05, 0.5):
        assert fast.potential(depth) == pytest.approx(element.potential(depth), rel=1e-8)


@pytest.mark.parametrize("cup", [None, bs.Cup()], ids=["sphere", "cup"])
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz(), bs.Tabulated()], ids=lambda model: model.name)
def test_interpreted_loops_have_the_loads_of_the_element_in_every_block(model, cup, interpreted):
    film = {"lubricant": bs.Lubricant(viscosity=0.1), "film_tension": 0.1}
    element = bs.ForceElement(model, HIP, cup=cup, smoothing=0.01, **film, **LOSSY)
    check_loads(element, either(150, 600))


def test_interpreted_steps_equal_those_of_the_element(interpreted):
    element = bs.ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(viscosity=1e-5), **LOSSY)
    throw = {"position": (0.01, 0.02, 0.09), "velocity": (10.0, 50.0, 200.0), "duration": 5e-4, "step": 2e-5}
    plain, fast = (simulate(kind, mass=1.0, **throw) for kind in (element, compiled.CompiledElement(element)))
    assert plain.energy.max() > 0.0
    np.testing.assert_allclose(fast.position, plain.position, atol=1e-15)


@pytest.mark.parametrize("shapes", [(2, 1, 2), (2, 2, 3), (0, 2, 2)])
def test_states_of_different_lengths_are_refused(shapes):
    """A compiled loop would read beyond the end of the shorter array."""
    element = compiled.CompiledElement(bs.ForceElement(bs.HessForsbach(), HIP))
    with pytest.raises(ValueError, match=r"(velocity|spin) of shape \(\d, 3\) is not allowed: its shape is"):
        element.loads(*(np.zeros((states, 3)) for states in shapes))
    with pytest.raises(ValueError, match=r"position of shape \(3,\) is not allowed: each state is a row"):
        element.loads(*np.zeros((3, 3)))


@pytest.mark.parametrize(
    "effects",
    [
        {},
        {"friction": Friction(coefficient=0.0, viscous=1e-3), "smoothing": 0.01},
        {"friction": Friction(coefficient=0.05, static_coefficient=0.1), "cup": bs.Cup()},
    ],
    ids=lambda effects: " ".join(effects) or "none",
)
def test_interpreted_loads_without_some_effects_equal_those_of_the_element(effects, interpreted):
    check_loads(bs.ForceElement(bs.HessForsbach(), HIP, **effects), 100)


@pytest.mark.long
def test_compiled_loads_and_steps_equal_those_of_the_element():
    element = bs.ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup(), lubricant=bs.Lubricant(), **LOSSY)
    check_loads(element, 500)
    throw = {"mass": 1.0, "position": (0.01, 0.02, 0.0), "velocity": (10.0, 50.0, 200.0), "step": 2e-5}
    plain, fast = (simulate(e, duration=2e-3, **throw) for e in (element, compiled.CompiledElement(element)))
    np.testing.assert_allclose(fast.position, plain.position, atol=1e-12)
