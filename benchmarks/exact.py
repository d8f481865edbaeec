"""The exact answer: a first load on a new joint, each further load, a curve, a sweep; and against CalculiX.

The first table has aims for rivals. The second has CalculiX (command `ccx`), which solves the same equations with
finite elements: its input is made as coarse as the error allows, see `calculix_rival`. Fair, because both get the same
rigid ball and the same indentations on one core, and neither error is looked at in isolation: the meshes were searched
for the coarsest that keep the force within 0.3 % and 0.05 % at every step. CalculiX's time is that of the process, its
files included, as its user waits for it; making the input is not counted. Ours runs in a Python that is up.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.exact.exact_curve import chebyshev_curve_of
from ballsocket.elasticity.exact.model import curve_of

from .calculix_rival import Calculix, Mesh, Steps
from .report import Report, Rows
from .timing import Spread, Work, apart, interleaved, one_core

LINER = bs.Material(young=1000.0, poisson=0.4)
RIGID = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=LINER)
JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=LINER, ball=bs.STEEL)
BACKED = JOINT.replace(
    backing=(
        bs.Layer(thickness=3.0, material=bs.TITANIUM),
        bs.Layer(thickness=2.0, material=bs.BONE_CEMENT),
        bs.Layer(thickness=numpy.inf, material=bs.CANCELLOUS_BONE),
    )
)
MODEL, MANY = bs.Exact(tolerance=1e-6), 100_000
POISSON, RATIOS, LOADS = (0.30, 0.35, 0.40, 0.45, 0.49), numpy.linspace(1.2, 6.0, 12), (500.0, 1500.0, 3000.0)
CURVE = numpy.linspace(100.0, 4000.0, 50)
REPEATS, RIVAL_REPEATS, FURTHER, TRIM = 9, 3, 20, 65536
DEPTHS = numpy.linspace(0.01, 0.045, 8)  # mm
SINGLE = numpy.array([0.04])
NEAR = (0.0395, 0.0405)
"""Where a mesh that was made for one step is tried as well."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A mesh, what it is pushed to, and what is asked of it: an error in percent, and how much slower than ours."""

    mesh: Mesh
    depths: numpy.ndarray
    percent: float
    aim: float

    @property
    def what(self) -> str:
        steps = "one step" if len(self.depths) == 1 else f"a curve of {len(self.depths)} steps"
        return f"{steps}, {self.mesh.name}"


_FOR_ALL = (
    (Mesh(name="0.3 % mesh", angles=((1.0, 1), (48.0, 12)), deep=2, slope=1e6), 0.3, 100.0),
    (Mesh(name="0.05 % mesh", angles=((1.0, 1), (2.5, 1), (48.0, 24)), deep=3, slope=3e6), 0.05, 1000.0),
)
_GRADED = Mesh(name="0.05 % mesh graded to its edge", angles=((1.0, 1), (36.0, 5), (48.0, 4)), deep=2, slope=1e6)
CASES = (
    *(Case(mesh=mesh, depths=depths, percent=percent, aim=aim)
      for mesh, percent, aim in _FOR_ALL for depths in (DEPTHS, SINGLE)),
    Case(mesh=_GRADED, depths=SINGLE, percent=0.05, aim=1000.0),
)  # fmt: skip


def measure() -> Report:
    """In processes of their own, whose linear algebra has one thread: that can only be said before NumPy starts."""
    report = apart(_measured, OPENBLAS_NUM_THREADS="1")
    trimmed = apart(_trimmed, OPENBLAS_NUM_THREADS="1", MALLOC_TRIM_THRESHOLD_=str(TRIM))
    report.tables.insert(1, trimmed)
    return report


def _measured() -> Report:
    with one_core() as pinned:
        notes = [
            "One core, and one thread of linear algebra." if pinned else "One thread of linear algebra.",
            f"R1 17.9, c 0.1, L 6.75 mm, E 1000 MPa, nu 0.4; a steel ball in the first table, a rigid one against "
            f"CalculiX. `Exact(tolerance={MODEL.tolerance:g})`; every time includes pressure and half angle.",
        ]
        tables = [_alone()]
        if shutil.which("ccx") is None:
            notes.append("CalculiX skipped: no command `ccx`.")
        else:
            tables += _against_calculix()
            notes += _RIVAL_NOTES
    return Report(tables, notes, ("scipy",))


_RIVAL_NOTES = (
    "CalculiX: rigid ball without unknowns, CAX8R, face-to-face penalty, SPOOLES on one thread, small-displacement "
    "limit; whole process. Errors are against `Exact(tolerance=1e-10)` at the same indentation, the worst "
    "of the steps. Its pole pressure is a fit to nodal contact pressures that zigzag, its half angle that of the "
    "outermost node under pressure: no judge of what a finer reading of its fields would give.",
    "The graded mesh knows beforehand where the edge of its one contact is, which is a gift; "
    f"its error was also taken at {NEAR[0]} and {NEAR[1]} mm, and the worst of the three counts.",
)


def _press(joint: bs.Joint, **load: Any) -> bs.Contact:
    contact = MODEL.press(joint, **load)
    _ = contact.max_pressure, contact.half_angle
    return contact


def _new(joint: bs.Joint, **load: Any) -> Work:
    """A press on a joint that was never seen."""

    def work() -> bs.Contact:
        curve_of.cache_clear()
        return _press(joint, **load)

    return work


def _curves() -> list[tuple[str, Work, float, float]]:
    """A backed joint whose curve is found once, and many loads on it."""
    model, loads = bs.ExactCurve(model=MODEL), numpy.linspace(10.0, 6000.0, MANY)

    def bound() -> None:
        curve_of.cache_clear()
        chebyshev_curve_of.cache_clear()
        _ = model.press(BACKED, force=3000.0).max_pressure

    def many() -> None:
        contact = model.press(BACKED, force=loads)
        _ = contact.max_pressure, contact.half_angle, contact.stiffness, contact.energy

    return [
        ("curve of a backed joint (titanium, cement, bone), first load, ms", bound, 1e-3, 20.0),
        (f"each of {MANY} loads on it, µs", many, 1e-6 * MANY, 1.0),
    ]


def _trimmed() -> Rows:
    """In a process that gives memory back as soon as 64 KiB of it are free (glibc), as Dask's workers do."""
    with one_core():
        return _rows(f"Exact in a process that trims its memory (MALLOC_TRIM_THRESHOLD_={TRIM})", _plan()[:3])


def _alone() -> Rows:
    return _rows("Exact, against its aims", [*_plan(), *_curves()])


def _plan() -> list[tuple[str, Work, float, float]]:
    """What is timed, the work, its unit in seconds, and the aim in that unit."""
    loads = numpy.linspace(900.0, 3300.0, FURTHER).tolist()

    def further() -> None:
        for load in loads:
            _press(JOINT, force=load)

    shape = (len(POISSON), len(RATIOS), 1)
    poisson = numpy.broadcast_to(numpy.array(POISSON)[:, None, None], shape)
    swept = bs.Joint(
        ball_radius=17.9,
        clearance=0.1,
        liner_thickness=18.0 / RATIOS[None, :, None],
        liner=bs.Material(young=1000.0, poisson=poisson),
        ball=bs.STEEL,
    )
    return [
        ("first load on a new joint, ms", _new(JOINT, force=3000.0), 1e-3, 2.5),
        ("each further load on it, ms", further, 1e-3 * FURTHER, 1.0),
        (f"force-indentation curve of {len(CURVE)} points on a new joint, ms", _new(JOINT, force=CURVE), 1e-3, 20.0),
        (
            f"sweep of Table 3, {len(POISSON)} nu x {len(RATIOS)} R2/L x {len(LOADS)} loads, s",
            _new(swept, force=numpy.array(LOADS)),
            1.0,
            2.0,
        ),
    ]


def _rows(title: str, plan: list[tuple[str, Work, float, float]]) -> Rows:
    _press(JOINT, force=3000.0)
    rows = Rows(title)
    for what, work, unit, aim in plan:
        _, seconds = interleaved(REPEATS, {what: work})
        taken = seconds[what].per(unit)
        rows.add(what, taken, f"aim {aim:g}", _share(taken.per(aim)))
    return rows


def _share(of_aim: Spread) -> str:
    return f"{of_aim} of the aim: {'met' if of_aim.median <= 1 else 'missed'}"


def _against_calculix() -> list[Rows]:
    times = Rows("Against CalculiX, ms", ("what", "ours", "CalculiX", "CalculiX over ours"))
    errors = Rows(
        "Largest error, %",
        ("what", "ours, force", "CalculiX, force", "CalculiX, pole pressure", "CalculiX, half angle", "nodes"),
    )
    with TemporaryDirectory() as folder:
        for number, case in enumerate(CASES):
            rival = Calculix(RIGID, case.mesh, case.depths, Path(folder) / str(number))
            ours, its = "ours", "CalculiX"
            _, seconds = interleaved(RIVAL_REPEATS, {ours: _new(RIGID, indentation=case.depths), its: rival.run})
            mine, theirs = (seconds[name].per(1e-3) for name in (ours, its))
            for what, steps in ((case.what, 1), (f"{case.what}: per step", len(case.depths))):
                if steps == 1 and what != case.what:
                    continue
                ratio = theirs.over(mine)
                verdict = "met" if ratio.median >= case.aim else "missed"
                times.add(what, mine.per(steps), theirs.per(steps), f"{ratio} times; aim {case.aim:g}: {verdict}")
            errors.add(case.what, *_errors(case, rival, Path(folder)), rival.nodes)
    return [times, errors]


def _errors(case: Case, rival: Calculix, folder: Path) -> list[str]:
    found = [(case.depths, rival.answer())]
    if case.mesh is _GRADED:
        for depth in NEAR:
            near = Calculix(RIGID, case.mesh, numpy.array([depth]), folder / f"near{depth}")
            near.run()
            found.append((numpy.array([depth]), near.answer()))
    depths = numpy.concatenate([part for part, _ in found])
    answer = Steps(**{
        name: numpy.concatenate([getattr(part, name) for _, part in found])
        for name in ("force", "max_pressure", "half_angle")
    })  # fmt: skip
    true = bs.Exact(tolerance=1e-10).press(RIGID, indentation=depths)
    own = _press(RIGID, indentation=depths)
    force = _worst(answer.force, true.force)
    kept = "" if abs(float(force)) <= case.percent else f", more than {case.percent:g}"
    pairs = [_worst(getattr(answer, name), getattr(true, name)) for name in ("max_pressure", "half_angle")]
    return [_worst(own.force, true.force, ".0e"), force + kept, *pairs]


def _worst(found: numpy.ndarray, true: numpy.ndarray, form: str = "+.3f") -> str:
    """The relative difference of largest size, in percent with its sign."""
    apart = 100 * (numpy.asarray(found) / true - 1)
    return format(float(apart[numpy.argmax(abs(apart))]), form)
