"""Figures of a press and of a joint in motion are pictures of their results."""

from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Damping, Prony, Viscoelastic, simulate
from ballsocket.reports.figure_files import save
from ballsocket.reports.press_plots import energy_balance, loop_figure, motion_figure, press_figure

from ..joints import HIP


def test_the_figure_of_a_massive_socket_says_so():
    pivot = bs.joints["tilting-pad-pivot"]
    contact = bs.Hertz().press(pivot, force=3000.0)
    title = press_figure({"hertz": contact}, {"hertz": contact}).get_suptitle()
    assert "massive socket of 210 GPa" in title
    assert "inf" not in title


@pytest.fixture(scope="module")
def comparison():
    return bs.compare(HIP, force=3000.0)


def test_figure_draws_the_result(comparison):
    curves = {name: bs.catalogue[name].press(HIP, indentation=np.linspace(0.0, 0.06, 30)) for name in comparison}
    figure = press_figure(comparison, curves)
    left, right = figure.axes
    drawn = {line.get_label(): line for line in left.lines}
    assert set(drawn) == set(comparison)
    for name, line in drawn.items():
        largest = comparison[name].pressure(np.linspace(0.0, 1.4, 2000)).max()
        assert line.get_ydata().max() == pytest.approx(largest, rel=5e-3)
        assert line.get_linewidth() == (2.0 if comparison[name].valid else 1.0)
    assert len(right.lines) == 2 * len(comparison)
    assert ("MPa" in left.get_ylabel(), "kN" in right.get_ylabel()) == (True, True)
    assert "17.9 mm" in figure.get_suptitle()


def test_of_many_models_those_that_matter_are_drawn_and_the_others_named(comparison):
    figure = comparison.plot()
    drawn = [line.get_label() for line in figure.axes[0].lines]
    assert len(drawn) == 7
    assert "exact" in drawn
    assert "tabulated" not in drawn  # lies on the exact one
    assert all(name in drawn for name, contact in comparison.items() if contact.valid and name != "tabulated")
    title = figure.legends[0].get_title().get_text()
    assert title == f"not drawn: {', '.join(name for name in comparison if name not in drawn)}"


def test_few_models_are_all_drawn_with_the_reference_below_what_is_judged():
    few = {name: bs.catalogue[name] for name in ("hess-forsbach", "tabulated", "exact")}
    lines = bs.compare(HIP, force=3000.0, models=few).plot().axes[0].lines
    order = {line.get_label(): line.get_zorder() for line in lines}
    assert set(order) == set(few)
    assert order["exact"] < order["hess-forsbach"]


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


def test_a_figure_that_cannot_be_drawn_leaves_no_file(tmp_path):
    def fail(*_, **__):
        raise RuntimeError

    with pytest.raises(RuntimeError):
        save(SimpleNamespace(savefig=fail), tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []
