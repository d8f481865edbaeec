"""One joint, a million loads by force: indentation, half angle and largest pressure, beside a hand-made spline.

The spline goes through presses at 600 forces. It is made beforehand and is within 1e-6 of the model.
"""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import numpy
from scipy.interpolate import CubicSpline

import ballsocket as bs
from ballsocket.compiled import Compiled

from .joints import jax_job, results
from .report import Pair, Row, compare, if_installed, with_version
from .timing import Job

POINTS, KNOTS, LOWEST, HIGHEST = 10**6, 600, 100.0, 4000.0
JOINT = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)


def measure() -> list[Row]:
    force = numpy.random.default_rng(2021).uniform(LOWEST, HIGHEST, POINTS)
    tabulated, refined, exact = bs.Tabulated(), bs.Refined(), bs.ExactCurve()
    spline = _spline(tabulated, force[:1000])
    scipy = Job(lambda: spline(force), POINTS)
    numba = if_installed("numba", partial(_numba_job, spline, force))
    pairs = []
    for name, model in (("tabulated", tabulated), ("refined", refined), ("exact-curve", exact)):
        ours = _press(model, force)
        pairs.append(
            Pair(f"{name}, one joint and a million loads, NumPy", ours, f"{with_version('scipy')} CubicSpline", scipy)
        )
        fast = _press(Compiled(model=model), force)
        title = f"{name}, one joint and a million loads, compiled"
        pairs.append(Pair(title, fast, f"spline in {with_version('numba')}", numba))
        if isinstance(model, bs.Tabulated):
            jax = if_installed("jax", partial(_jax, model, force))
            pairs.append(Pair(title, fast, "the same in JAX", jax))
    return compare(pairs)


def _press(model: bs.Model, force: numpy.ndarray) -> Job:
    return Job(lambda: results(model.press(JOINT, force=force)), len(force))


def _jax(model: bs.Model, force: numpy.ndarray) -> Job:
    return jax_job(lambda loads: results(model.press(JOINT, force=loads)), [force], len(force))


def _spline(model: bs.Model, force: numpy.ndarray) -> CubicSpline:
    """Cubic spline of the three results over the force, checked against the model."""
    knots = numpy.linspace(LOWEST, HIGHEST, KNOTS)
    spline = CubicSpline(knots, numpy.stack(results(model.press(JOINT, force=knots)), axis=-1))
    error = numpy.max(abs(spline(force) / numpy.stack(results(model.press(JOINT, force=force)), axis=-1) - 1))
    if error > 1e-6:
        raise RuntimeError(f"the spline is {error:.1e} off the model")
    return spline


def _numba_job(spline: CubicSpline, force: numpy.ndarray) -> Job:
    pieces = numpy.ascontiguousarray(spline.c.transpose(1, 2, 0))
    width = (HIGHEST - LOWEST) / (KNOTS - 1)
    return Job(lambda: _interpolated()(pieces, LOWEST, width, force), len(force))


@cache
def _interpolated() -> Any:
    import numba

    @numba.njit(error_model="numpy")
    def interpolated(pieces, lowest, width, force):  # type: ignore[no-untyped-def]
        found = numpy.empty((3, len(force)))
        for i in range(len(force)):
            place = (force[i] - lowest) / width
            piece = min(max(int(place), 0), len(pieces) - 1)
            x = (place - piece) * width
            for k in range(3):
                a, b, c, d = pieces[piece, k]
                found[k, i] = ((a * x + b) * x + c) * x + d
        return found

    return interpolated
