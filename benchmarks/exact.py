"""The exact solution: a first load, further loads, curves; beside CalculiX, which solves the same equations.

CalculiX gets the same rigid ball and indentations, on the coarsest meshes that keep the force of every step within
0.3 % or 0.05 % (see `calculix_rival`). Its time is that of its process; ours is within 4e-9 % of the exact force.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.exact.model import chebyshev_curve_of, curve_of

from .calculix_rival import Mesh, calculix
from .report import Pair, Row, compare
from .timing import Job

LINER = bs.Material(young=1000.0, poisson=0.4)
RIGID = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=LINER)
JOINT = RIGID.replace(ball=bs.STEEL)
BACKED = JOINT.replace(
    backing=(
        bs.Layer(thickness=3.0, material=bs.TITANIUM),
        bs.Layer(thickness=2.0, material=bs.BONE_CEMENT),
        bs.Layer(thickness=numpy.inf, material=bs.CANCELLOUS_BONE),
    )
)
MODEL = bs.Exact(tolerance=1e-6)
DEPTHS, SINGLE = numpy.linspace(0.01, 0.045, 8), numpy.array([0.04])  # mm
COARSE = Mesh(name="0.3 %", angles=((1.0, 1), (48.0, 12)), deep=2, slope=1e6)
FINE = Mesh(name="0.05 %", angles=((1.0, 1), (2.5, 1), (48.0, 24)), deep=3, slope=3e6)
CASES = ((COARSE, DEPTHS), (FINE, DEPTHS), (FINE, SINGLE))


def measure() -> list[Row]:
    loads = numpy.linspace(900.0, 3300.0, 20).tolist()
    many = numpy.linspace(10.0, 6000.0, 100_000)
    curve = bs.ExactCurve(model=MODEL)

    def further() -> None:
        for load in loads:
            _press(MODEL, JOINT, force=load)

    _press(MODEL, BACKED, force=3000.0)
    rows = compare(
        [
            Pair("exact, first load on a new joint", Job(lambda: _first(MODEL, JOINT, force=3000.0))),
            Pair("exact, each further load", Job(further, len(loads))),
            Pair(
                "exact-curve, a joint with three layers, first load", Job(lambda: _first(curve, BACKED, force=3000.0))
            ),
            Pair("exact-curve, each of 100 000 loads on it", Job(lambda: _press(curve, BACKED, force=many), len(many))),
        ]
    )
    return rows + _beside_calculix()


def _press(model: bs.Model, joint: bs.Joint, **load: Any) -> None:
    contact = model.press(joint, **load)
    _ = contact.max_pressure, contact.half_angle


def _first(model: bs.Model, joint: bs.Joint, **load: Any) -> None:
    """Press a joint that was never seen."""
    curve_of.cache_clear()
    chebyshev_curve_of.cache_clear()
    _press(model, joint, **load)


def _beside_calculix() -> list[Row]:
    pairs = []
    with TemporaryDirectory() as folder:
        for number, (mesh, depths) in enumerate(CASES):
            theirs = calculix(RIGID, mesh, depths, Path(folder) / str(number))
            work = f"exact, {len(depths)} indentations on a new joint" if len(depths) > 1 else "exact, one indentation"
            ours = Job(lambda depths=depths: _first(MODEL, RIGID, indentation=depths))  # type: ignore[misc]
            pairs.append(Pair(work, ours, f"CalculiX to {mesh.name}", theirs))
        return compare(pairs, repeats=3)
