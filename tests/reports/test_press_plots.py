"""The figure of a press is a figure of its result."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.reports.press_plots import press_figure

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
    assert "MPa" in left.get_ylabel()
    assert "kN" in right.get_ylabel()
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
