"""Figures of a joint in motion are pictures of their results."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Damping, Prony, Viscoelastic, simulate
from ballsocket.reports.press_plots import energy_balance, loop_figure, motion_figure

from ..joints import HIP


@pytest.fixture(scope="module")
def motion():
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=Damping(hysteresis=1e-3))
    throw = {"position": (0.0, 0.0, 0.0), "velocity": (20.0, 0.0, 200.0), "pull": (0.0, 0.0, 100.0)}
    return simulate(element, mass=1.0, duration=3e-3, step=2e-5, **throw)


def test_the_parts_of_the_energy_reach_what_was_put_in(motion):
    (axes,) = energy_balance(motion).axes
    top = axes.collections[-1].get_paths()[0].vertices
    (line,) = axes.lines
    assert top[:, 1].max() == pytest.approx(line.get_ydata().max(), rel=1e-9)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["moving", "stored", "lost", "put in"]


def test_the_way_stays_near_its_clearance_and_the_force_is_that_of_the_element(motion):
    way, force = motion_figure(motion).axes
    np.testing.assert_array_equal(way.lines[1].get_xydata(), motion.position[:, [0, 2]])
    assert np.hypot(*way.lines[0].get_xydata().T) == pytest.approx(HIP.clearance)
    assert force.lines[0].get_ydata().max() == pytest.approx(motion.summary()["largest_force"])


def test_a_loop_tells_what_it_loses():
    liner = Viscoelastic(bs.HessForsbach(), HIP, Prony(terms=((0.3, 0.1),)))
    time = np.linspace(0.0, 1.0, 101)
    depth = 0.05 * np.sin(np.pi * time)
    force = liner.cycle_force(time, depth)
    (axes,) = loop_figure(depth, {"pressed": force, "at once": liner.instantaneous_force(depth)}).axes
    told = [text.get_text() for text in axes.get_legend().get_texts()]
    assert told[0] == f"pressed: {np.trapezoid(force, depth):.3g} N mm lost"
    assert float(told[1].split()[2]) == pytest.approx(0.0, abs=1e-9)
