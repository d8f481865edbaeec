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


def test_figure_draws_the_result():
    answers = bs.compare(HIP, force=3000.0)
    curves = {name: bs.catalogue[name].press(HIP, indentation=np.linspace(0.0, 0.06, 30)) for name in answers}
    figure = press_figure(answers, curves)
    left, right = figure.axes
    drawn = {line.get_label(): line for line in left.lines}
    assert set(drawn) == set(answers)
    for name, line in drawn.items():
        assert line.get_ydata().max() == pytest.approx(
            answers[name].pressure(np.linspace(0.0, 1.4, 2000)).max(), rel=5e-3
        )
        assert line.get_linewidth() == (2.0 if answers[name].valid else 1.0)
    assert len(right.lines) == 2 * len(answers)
    assert "MPa" in left.get_ylabel()
    assert "kN" in right.get_ylabel()
    assert "17.9 mm" in figure.get_suptitle()


def test_of_many_models_those_that_matter_are_drawn_and_the_others_named():
    answers = bs.compare(HIP, force=3000.0)
    figure = answers.plot()
    left = figure.axes[0]
    drawn = [line.get_label() for line in left.lines]
    assert len(drawn) == 7
    assert "exact" in drawn
    assert "tabulated" not in drawn  # lies on the exact one
    assert all(name in drawn for name, contact in answers.items() if contact.valid and name != "tabulated")
    said = figure.legends[0].get_title().get_text()
    assert said == f"not drawn: {', '.join(name for name in answers if name not in drawn)}"
    few = {name: bs.catalogue[name] for name in ("bartel", "tabulated", "exact")}
    assert len(bs.compare(HIP, force=3000.0, models=few).plot().axes[0].lines) == 3


def test_the_reference_lies_under_what_is_judged():
    answers = bs.compare(HIP, force=3000.0, models={name: bs.catalogue[name] for name in ("hess-forsbach", "exact")})
    order = {line.get_label(): line.get_zorder() for line in answers.plot().axes[0].lines}
    assert order["exact"] < order["hess-forsbach"]
