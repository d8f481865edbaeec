"""One evaluation of the force element: exported to C, in plain Python, and a batch of states in NumPy.

Fair, because all are asked for the load at the same states, which touch, slide and spin; the C functions are compiled
with -O2 as any program would, and called from another file, so that nothing is moved out of the loop.
"""

from __future__ import annotations

import ctypes
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction
from ballsocket.export import CElement
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library

from .report import Report, Rows
from .timing import Work, interleaved

JOINT = bs.joints["hip-28"]
LOSSES: dict[str, Any] = {"damping": Damping(hysteresis=0.004), "friction": Friction(coefficient=0.05)}
ELEMENTS = {
    "springs": bs.ForceElement(bs.HessForsbach(), JOINT),
    "springs, damping, friction": bs.ForceElement(bs.HessForsbach(), JOINT, **LOSSES),
    "`tabulated`, damping, friction": bs.ForceElement(bs.Tabulated(), JOINT, **LOSSES),
    "`tabulated`, damping, friction, a cup's rim": bs.ForceElement(bs.Tabulated(), JOINT, **LOSSES, cup=bs.Cup()),
}
STATES, CALLS, REPEATS, AIM = 1000, 200, 15, 0.5  # AIM in µs

LOOP = """
#include "element.h"
#define LOOP(name, call, size) double name(const double *s, int n) \\
{ double out[9], sum = 0.0; \\
  for (int i = 0; i < n; i++, s += 9) { call; for (int k = 0; k < size; k++) sum += out[k]; } return sum; }
static const double way[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
LOOP(load, element_load(&element_defaults, s, s + 3, s + 6, out, out + 3, out + 6), 7)
LOOP(contact, element_contact(s, out, out + 1), 2)
LOOP(tangent, element_tangent(s, out), 9)
LOOP(slope, element_slope(&element_defaults, s, s + 3, s + 6, way, out), 9)
"""
FUNCTIONS = ("load", "contact", "tangent", "slope")


def measure() -> Report | str:
    states = _states()
    work: dict[str, Work] = {}
    with TemporaryDirectory() as folder:
        for number, (name, element) in enumerate(ELEMENTS.items()):
            try:
                functions = _compiled(element, Path(folder) / str(number))
            except NoCompiler as missing:
                return str(missing)
            for function in FUNCTIONS:
                work[f"{name}: {function}"] = _loop(functions[function], states)
            work[f"{name}: Python"] = _python(element, states[:CALLS])
            work[f"{name}: NumPy"] = _numpy(element, states)
        _, seconds = interleaved(REPEATS, work)
    rows = Rows("One evaluation, µs", ("element", *(f"C, {each}" for each in FUNCTIONS), "Python, load", "NumPy, load"))
    for name in ELEMENTS:
        inside = [seconds[f"{name}: {function}"].per(1e-6 * STATES) for function in FUNCTIONS]
        python, batch = seconds[f"{name}: Python"].per(1e-6 * CALLS), seconds[f"{name}: NumPy"].per(1e-6 * STATES)
        rows.add(name, *inside, python, batch)
    slowest = max(seconds[f"{name}: load"].per(1e-6 * STATES).median for name in ELEMENTS)
    notes = [
        f"Aim for C: {AIM} µs a load: {'met' if slowest <= AIM else 'missed'}.",
        f"{STATES} states 1 to 100 µm deep, in all directions; NumPy takes them in one batch.",
        "slope: how load, half angle and largest pressure change along one way of the nine numbers of the state.",
    ]
    return Report([rows], notes)


def _states() -> numpy.ndarray:
    draw = numpy.random.default_rng(1)
    way = draw.normal(size=(STATES, 3))
    distance = JOINT.clearance + numpy.geomspace(1e-3, 0.1, STATES)
    way *= (distance / numpy.linalg.norm(way, axis=1))[:, None]
    return numpy.ascontiguousarray(
        numpy.hstack([way, 30 * draw.normal(size=(STATES, 3)), draw.normal(size=(STATES, 3))])
    )


def _compiled(element: bs.ForceElement, folder: Path) -> dict[str, Any]:
    folder.mkdir()
    CElement(element=element, name="element").write(folder)
    (folder / "loop.c").write_text(LOOP, encoding="ascii")
    library = shared_library(["element.c", "loop.c"], folder / f"loop{LIBRARY_ENDING}", folder)
    functions = ctypes.CDLL(str(library))
    found = {name: getattr(functions, name) for name in FUNCTIONS}
    for function in found.values():
        function.restype = ctypes.c_double
    return found


def _loop(function: Any, states: numpy.ndarray) -> Work:
    place = states.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
    return lambda: function(place, len(states))


def _python(element: bs.ForceElement, states: numpy.ndarray) -> Work:
    given = [[tuple(part) for part in row.reshape(3, 3).tolist()] for row in states]
    return lambda: [element(*state) for state in given]


def _numpy(element: bs.ForceElement, states: numpy.ndarray) -> Work:
    return lambda: element(states[:, :3], states[:, 3:6], states[:, 6:])
