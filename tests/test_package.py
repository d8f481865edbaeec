"""The package as it is shipped: light to import, every example runs, every figure is a figure of its result."""

import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.figures import press_figure

from .joints import HIP

ROOT = Path(__file__).parents[1]


def test_import_brings_nothing_heavy():
    heavy = "matplotlib pint typer rich scipy jax torch numba pandas"
    code = f"import ballsocket, sys; print([name for name in {heavy.split()} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True)
    assert done.stdout == "[]\n"


def test_everything_offered_is_there():
    assert sorted(bs.__all__) == bs.__all__ or len(set(bs.__all__)) == len(bs.__all__)
    for name in bs.__all__:
        assert getattr(bs, name) is not None


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_run(path, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")


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
