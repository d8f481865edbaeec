"""Compiled element: the same loads and steps as the element."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import simulate

from ..joints import HIP
from .test_element import LOSSY, states

pytest.importorskip("numba")


@pytest.mark.long
@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Hertz()], ids=lambda model: model.name)
def test_compiled_loads_equal_those_of_the_element(model):
    from ballsocket.dynamics.compiled import CompiledElement

    for cup in (None, bs.Cup()):
        element = bs.ForceElement(model, HIP, cup=cup, **LOSSY)
        force, moment, energy, tangent = CompiledElement(element).loads(*states(500))
        load = element(*states(500))
        np.testing.assert_allclose(force, load.force, atol=1e-9 * np.abs(load.force).max())
        np.testing.assert_allclose(moment, load.moment, atol=1e-9 * np.abs(load.moment).max())
        np.testing.assert_allclose(energy, load.energy, rtol=1e-8, atol=1e-12)
        six = [load.tangent[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))]
        np.testing.assert_allclose(tangent, np.stack(six, axis=1), atol=1e-8 * np.abs(load.tangent).max())


@pytest.mark.long
def test_compiled_steps_equal_those_of_the_element():
    from ballsocket.dynamics.compiled import CompiledElement

    element = bs.ForceElement(bs.HessForsbach(), HIP, **LOSSY)
    throw = {
        "mass": 1.0,
        "position": (0.01, 0.02, 0.0),
        "velocity": (10.0, 50.0, 200.0),
        "duration": 2e-3,
        "step": 2e-5,
    }
    plain, fast = simulate(element, **throw), simulate(CompiledElement(element), **throw)
    np.testing.assert_allclose(fast.position, plain.position, atol=1e-12)
