"""Benchmark problems of spherical joints with clearance, in the form of the IFToMM library of multibody problems.

`python -m benchmarks.clearance_problems FOLDER` writes a folder: a page on each problem, its reference as CSV, the
definition of the error, and a table of the programs that are installed here with their errors and times.

The references of (a) and (b) are integrals of the energy over the indentation. All others, and the motions of (a) and
(b), are integrated by the method of Dormand and Prince of order 8 with a tolerance of 1e-11.
"""

from __future__ import annotations

import runpy
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib.util import find_spec
from math import radians, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.dynamics import Friction, simulate
from ballsocket.export import TARGETS, ExportJob

from . import tools

MODULUS, SOCKET_RADIUS, CLEARANCE, SPEED = 276.7, 18.0, 0.1, 100.0  # N/mm³, mm, mm, mm/s
_SHAPE = bs.Joint(
    socket_radius=SOCKET_RADIUS, clearance=CLEARANCE, liner_thickness=6.75, liner=bs.Material(young=1.0, poisson=0.4)
)
_YOUNG = MODULUS / bs.hess_forsbach(_SHAPE)
JOINT = _SHAPE.replace(liner=bs.Material(young=_YOUNG, poisson=0.4))
"""Joint whose foundation has the modulus of the problems."""

PIPE = bs.Joint(socket_radius=50.0, clearance=20.0, liner_thickness=6.0, liner=bs.Material(young=50.0, poisson=0.4))
_SMOOTH = bs.ForceElement(bs.HessForsbach(), JOINT)
_ROUGH = bs.ForceElement(bs.HessForsbach(), PIPE, friction=Friction(coefficient=0.3, transition_speed=1.0))
EXAMPLES = Path(__file__).parents[1] / "examples"

Positions = numpy.ndarray


def radial_impact(angle: float) -> dict[str, float]:
    """Integrate an impact of 1 kg on the smooth socket at an angle in rad between velocity and normal.

    With e = c + d, the angular momentum L = m e e' across and the energy U(d) = π/3 K R² d³/(c + d), the indentation
    follows d'² = v² - 2 U/m - (L/(m e))². d = d_max (1 - s²) removes the singularity at the end.
    """
    from scipy.integrate import quad
    from scipy.optimize import brentq

    stiffness, across = numpy.pi / 3.0 * MODULUS * SOCKET_RADIUS**2, CLEARANCE * SPEED * sin(angle)

    def square(depth: float) -> float:
        distance = CLEARANCE + depth
        return SPEED**2 - 2e3 * stiffness * depth**3 / distance - (across / distance) ** 2

    deepest = brentq(square, 1e-3, 0.05, xtol=1e-16, rtol=1e-15)

    def integral(of: Callable[[float], float]) -> float:
        def integrand(s: float) -> float:
            depth = deepest * (1.0 - s * s)
            return of(depth) * 2.0 * s * deepest / numpy.sqrt(square(depth))

        return 2.0 * quad(integrand, 1e-9, 1.0, epsabs=0.0, epsrel=1e-12, limit=200)[0]

    contact = integral(lambda depth: 1.0)
    distance = CLEARANCE + deepest
    if angle:
        last = {"angle swept in contact, deg": float(numpy.degrees(integral(lambda d: across / (CLEARANCE + d) ** 2)))}
    else:
        last = {"period, s": 2.0 * (contact + 2.0 * CLEARANCE / SPEED)}
    return {
        "largest indentation, mm": deepest,
        "largest force, N": stiffness * deepest**2 * (3.0 * CLEARANCE + 2.0 * deepest) / distance**2,
        "duration of contact, s": contact,
        **last,
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class BallProblem:
    """Ball of 1 kg in a fixed socket; the result is its position in mm over the time."""

    title: str
    text: str
    bounce: tools.Bounce
    numbers: Mapping[str, float] = field(default_factory=dict)
    columns = ("x_mm", "y_mm", "z_mm")

    @cached_property
    def reference(self) -> Positions:
        element = self.bounce.element

        def load(r: Any, v: Any, w: Any) -> tuple[Any, Any]:
            result = element(tuple((1e3 * r).tolist()), tuple((1e3 * v).tolist()), tuple(w.tolist()))
            return result.force, 1e-3 * numpy.array(result.moment)

        return tools.by_load(self.bounce, load)

    @property
    def times(self) -> Positions:
        return self.bounce.times

    def programs(self, folder: Path) -> dict[str, Callable[[], Positions]]:
        """Solve with each installed program, by its name."""
        bounce = self.bounce
        job = ExportJob(element=bounce.element, name=tools.NAME, depth=0.05)
        names = {"c": "ballsocket", "mujoco_callback": "mujoco", "drake": "pydrake", "exudyn": "exudyn", "warp": "warp"}
        if not bounce.element.friction:
            names["opensim"] = "opensim"
        installed = [name for name, package in names.items() if find_spec(package)]
        for name in {"exudyn", *installed}:
            TARGETS[name.removesuffix("_callback")].write(job, folder)
        solved = {name: lambda name=name: getattr(tools, name)(bounce, folder) for name in installed}
        return {"ballsocket, simulate": lambda: simulated(bounce), **solved}


def simulated(bounce: tools.Bounce) -> Positions:
    """Positions by this package's own steps of 2e-7 s, of second order."""
    from ballsocket.dynamics.compiled import CompiledElement

    stride = round(bounce.duration / (bounce.samples - 1) / 2e-7)
    compiled: Any = CompiledElement(bounce.element)
    motion = simulate(
        compiled,
        mass=1.0,
        position=bounce.position,
        velocity=bounce.velocity,
        pull=(0.0, 0.0, -bounce.gravity),
        inertia=1e6 * bounce.turning,
        duration=bounce.duration,
        step=bounce.duration / (bounce.samples - 1) / stride,
    )
    return motion.position[::stride]


@dataclass(frozen=True, kw_only=True, eq=False)
class MechanismProblem:
    """Mechanism of an example of the gallery; `solve(load)` returns columns over the times with any force element."""

    title: str
    text: str
    element: bs.ForceElement
    times: Positions
    columns: tuple[str, ...]
    solve: Callable[[Any], Positions]
    numbers: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def reference(self) -> Positions:
        return self.solve(self.element)

    def programs(self, folder: Path) -> dict[str, Callable[[], Positions]]:
        """Solve with the exported program in C."""
        TARGETS["drake"].write(ExportJob(element=self.element, name=tools.NAME, depth=0.05), folder)

        def by_c() -> Positions:
            with tools.module(folder, tools.NAME) as made:

                def load(position: Any, velocity: Any, spin: Any) -> Any:
                    result = made.load(*(tuple(1e-3 * part for part in each) for each in (position, velocity)), spin)
                    moment = tuple(1e3 * part for part in result[1])
                    own = self.element(position, velocity, spin)
                    return SimpleNamespace(force=result[0], moment=moment, dissipation=own.dissipation)

                return self.solve(load)

        return {"c": by_c}


def _pendulum() -> MechanismProblem:
    example = _example("what_does_clearance_do_to_a_pendulum")
    return MechanismProblem(
        title="Pendulum with gravity and friction",
        text="A bob of 2 kg on a rod of 200 mm hangs from a ball of 20 mm with a clearance of 0.5 mm and a friction "
        "coefficient of 0.1. It starts at rest at 40 degrees, with the ball hanging in the direction of the rod.",
        element=example.element(0.1),
        times=numpy.linspace(0.0, example.SECONDS, 400),
        columns=("x_mm", "y_mm", "angle_rad"),
        solve=lambda load: example.swing(load)[1][:3].T,
    )


def _four_bar() -> MechanismProblem:
    bar, times = _example("what_does_clearance_do_to_a_four_bar"), numpy.linspace(0.0, 0.2, 201)

    def solve(load: Any) -> Positions:
        states = bar.fallen(times, load)
        return states[[0, 9]].T

    return MechanismProblem(
        title="Spatial four-bar with clearance",
        text="Crank, coupler and rocker fall from rest; the ball joint between coupler and rocker has a ball of 20 mm "
        "and a clearance of 0.2 mm. Lengths, masses and axes are those of the example of the gallery.",
        element=bar.ELEMENT,
        times=times,
        columns=("crank_rad", "rocker_rad"),
        solve=solve,
    )


def _example(name: str) -> SimpleNamespace:
    return SimpleNamespace(**runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="problem"))


def _ball(title: str, text: str, angle: float) -> BallProblem:
    numbers, velocity = radial_impact(angle), (SPEED * sin(angle), 0.0, SPEED * numpy.cos(angle))
    bounce = tools.Bounce(element=_SMOOTH, position=(0.0, 0.0, CLEARANCE), velocity=velocity, gravity=0.0)
    return BallProblem(title=title, text=text, bounce=replace(bounce, duration=0.005, samples=101), numbers=numbers)


_SOCKET = (
    "A smooth ball of 1 kg without weight has the radius 17.9 mm; the socket is fixed and has the radius R = 18 mm. "
    "The force is pi/3 K R^2 d^2 (3 c + 2 d)/(c + d)^2 along the line of centres, K = 276.7 MPa/mm, c = 0.1 mm. "
    "At time 0 the ball touches at (0, 0, c) with 0.1 m/s"
)

PROBLEMS: Mapping[str, Callable[[], BallProblem | MechanismProblem]] = {
    "a_radial_bounce": lambda: _ball("Radial bounce", f"{_SOCKET} along z.", 0.0),
    "b_oblique_bounce": lambda: _ball("Oblique bounce", f"{_SOCKET}, 30 degrees from z towards x.", radians(30.0)),
    "c_pendulum": _pendulum,
    "d_four_bar": _four_bar,
    "e_wheel_in_a_pipe": lambda: BallProblem(
        title="Wheel in a pipe",
        text="A solid ball of 1 kg with the radius 30 mm rolls in a fixed socket of 50 mm under its weight of 9.81 N, "
        "with a friction coefficient of 0.3 and a transition speed of 1 mm/s. It starts at rest at 20 degrees.",
        bounce=tools.Bounce(
            element=_ROUGH,
            position=(20.02 * sin(radians(20.0)), 0.0, -20.02 * float(numpy.cos(radians(20.0)))),
            velocity=(0.0, 0.0, 0.0),
            duration=0.1,
            samples=101,
        ),
    ),
}
"""Problems by the names of their folders."""

HEAD = "| problem | program | error | processor time, s |\n|---|---|---|---|"
ERROR = (
    "The error of a program is the largest difference of any column from the reference, over the largest change of "
    "that column's magnitude in the reference. The goal is 1e-6."
)


def write(folder: Path, names: Any = tuple(PROBLEMS)) -> dict[tuple[str, str], tuple[float, float]]:
    """Write the folder; return the error and the seconds of each program on each problem."""
    results = {}
    for name in names:
        problem = PROBLEMS[name]()
        place = folder / name
        place.mkdir(parents=True, exist_ok=True)
        table = numpy.column_stack([problem.times, problem.reference])
        head = ",".join(("time_s", *problem.columns))
        numpy.savetxt(place / "reference.csv", table, delimiter=",", header=head, comments="", fmt="%.17g")
        lines = [f"- {key}: {value:.12g}" for key, value in problem.numbers.items()]
        page = [f"# {problem.title}", problem.text, *(["Reference numbers:", "\n".join(lines)] if lines else []), ERROR]
        (place / "description.md").write_text("\n\n".join(page) + "\n", encoding="utf-8")
        with TemporaryDirectory() as made:
            for program, solve in problem.programs(Path(made)).items():
                start = time.process_time()
                found, seconds = solve(), time.process_time() - start
                error = abs(found - problem.reference).max() / numpy.ptp(problem.reference, axis=0).max()
                results[name, program] = float(error), seconds
    rows = [f"| {problem} | {program} | {e:.1e} | {s:.2g} |" for (problem, program), (e, s) in results.items()]
    text = ["# Spherical joints with clearance", ERROR, "\n".join([HEAD, *rows])]
    (folder / "README.md").write_text("\n\n".join(text) + "\n", encoding="utf-8")
    return results


if __name__ == "__main__":
    for (problem, program), (e, seconds) in write(Path(sys.argv[1])).items():
        print(f"{problem:20} {program:24} error {e:.1e}  {seconds:.2g} s")
