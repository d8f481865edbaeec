"""A second of a spatial four-bar whose ball joint has clearance: compiled, in Python, and in Exudyn.

The mechanism of `examples/what_does_clearance_do_to_a_four_bar.py`. Exudyn has its own bodies and joints for it; its
hollow sphere has an elastic force and a restitution only. Of 169 mrad through which the rocker swings the compiled
element is 0.07 off at steps of 40 µs, the element in Python 0.003, Exudyn 1.1.

`python -m benchmarks.four_bar FILE` writes what Exudyn answers as the example reads it.
"""

from __future__ import annotations

import runpy
import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy

from ballsocket.export import TARGETS, ExportJob

from . import tools
from .report import Pair, Row, compare, if_installed
from .timing import Job

EXAMPLE = Path(__file__).parents[1] / "examples" / "what_does_clearance_do_to_a_four_bar.py"
BAR = SimpleNamespace(**runpy.run_path(str(EXAMPLE), run_name="four_bar"))
NAME, DEPTH = "linked", 0.004
RESTITUTION = {"restitutionCoefficient": 0.8, "impactModel": 2, "minimumImpactVelocity": 1e-3}


def compiled(duration: float, step: float, samples: int) -> numpy.ndarray:
    """States (12, samples) of the compiled element, by Runge and Kutta's fourth order."""
    from ballsocket.dynamics.compiled import CompiledElement

    fast = CompiledElement(BAR.ELEMENT)
    found = numpy.empty((samples, len(BAR.START)))
    steps = round(duration / step / (samples - 1))
    _march()((fast.potential, fast.constants), numpy.array(BAR.START), duration / steps / (samples - 1), steps, found)
    return found.T


@cache
def _march() -> Callable[..., None]:
    import numba
    from numba.extending import register_jitable

    from ballsocket.dynamics import reaction as formulas
    from ballsocket.dynamics.ball_centre import ball_centre_at

    for each in (BAR.dot, BAR.cross, BAR.plus, BAR.at_joint, BAR.rates):
        register_jitable(each)

    @numba.njit(error_model="numpy")
    def ask(joint, position, velocity, spin):  # type: ignore[no-untyped-def]
        potential, given = joint
        place = ball_centre_at(position[0], position[1], position[2], given.clearance)
        contact = formulas.elastic_contact(potential, place, given)
        fx, fy, fz, mx, my, mz = formulas.force_and_moment(place, contact, velocity, spin, given)
        lost = formulas.dissipation(place, contact, velocity, spin, given)
        return (fx, fy, fz), (mx, my, mz), lost

    rates = BAR.rates

    @numba.njit(error_model="numpy")
    def march(joint, y, h, steps, found):  # type: ignore[no-untyped-def]
        for row in range(len(found)):
            found[row] = y
            for _ in range(steps):
                one = numpy.array(rates(ask, joint, y))
                two = numpy.array(rates(ask, joint, y + 0.5 * h * one))
                three = numpy.array(rates(ask, joint, y + 0.5 * h * two))
                four = numpy.array(rates(ask, joint, y + h * three))
                y = y + h / 6.0 * (one + 2.0 * two + 2.0 * three + four)

    return march


class Answer(NamedTuple):
    """Results of Exudyn over the time in s: the rocker's angle in rad, and the energy lost in N mm."""

    time: numpy.ndarray
    angle: numpy.ndarray
    lost: numpy.ndarray


def in_exudyn(name: str, duration: float, step: float, samples: int) -> Answer:
    """The mechanism in Exudyn, with the exported `law`, or with its own hollow `sphere` and the k and n of that law."""
    with TemporaryDirectory() as made:
        TARGETS["exudyn"].write(ExportJob(element=BAR.ELEMENT, name=NAME, depth=DEPTH), Path(made))
        with tools.module(Path(made), f"{NAME}_exudyn") as joint:
            sphere = partial(joint.add_hollow_sphere, **RESTITUTION)
            add = {"law": joint.add_joint, "sphere": sphere}[name]
            time, angle, mechanical, depth = _exudyn(add, duration, step, samples)
            stored = 1e-3 * BAR.ELEMENT.potential(1e3 * depth)[0]
            if name == "sphere":
                stored = joint.STIFFNESS * depth ** (joint.EXPONENT + 1.0) / (joint.EXPONENT + 1.0)
    return Answer(time=time, angle=angle, lost=1e3 * (mechanical[0] - mechanical - stored))


def _exudyn(add: Callable[..., Any], duration: float, step: float, samples: int) -> tuple[numpy.ndarray, ...]:
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name

    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(items.ObjectGround())
    links, bodies, pivot, (ball, socket) = _links(mbs, ground)
    add(mbs, socket, ball)
    kinds = exu.OutputVariableType
    seen = {"storeInternal": True}
    place = {"outputVariableType": kinds.Position, **seen}
    ends = [mbs.AddSensor(items.SensorMarker(markerNumber=each, **place)) for each in (ball, socket)]
    moving = kinds.Position, kinds.Velocity, kinds.AngularVelocityLocal
    sensors = [
        [mbs.AddSensor(items.SensorBody(bodyNumber=body, outputVariableType=kind, **seen)) for kind in moving]
        for body in bodies
    ]
    mbs.Assemble()
    settings = tools.exudyn_settings(duration, round(duration / step), samples)
    settings.timeIntegration.newton.useModifiedNewton = True
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    at, held = (mbs.GetSensorStoredData(each) for each in ends)
    arm = held[:, 1:] - pivot
    energy = numpy.zeros(len(at))
    for (length, mass), three in zip(links, sensors, strict=True):
        place, speed, spin = (mbs.GetSensorStoredData(each)[:, 1:] for each in three)
        moving = mass * numpy.sum(speed**2, axis=1) + numpy.sum(_inertia(length, mass) * spin**2, axis=1)
        energy += moving / 2 + 1e-3 * BAR.GRAVITY * mass * place[:, 2]
    apart = numpy.linalg.norm(at[:, 1:] - held[:, 1:], axis=1) - 1e-3 * BAR.JOINT.clearance
    return at[:, 0], numpy.arctan2(arm[:, 0], arm[:, 2]), energy, numpy.maximum(apart, 0.0)


def _links(mbs: Any, ground: int) -> Any:
    """The three links with their ideal joints, in SI units; where the rocker turns, and the ends that are to meet."""
    from exudyn import itemInterface as items  # noqa: N813 - a module's name

    links = [(1e-3 * length, 1e3 * mass) for length, mass in (BAR.CRANK, BAR.COUPLER, BAR.ROCKER)]
    pivot = 1e-3 * numpy.array(BAR.PIVOT)
    elbow = numpy.array([0.0, links[0][0], 0.0])
    ways = [numpy.array([0.0, 1.0, 0.0]), numpy.array(BAR.START[2:5]), numpy.array([0.0, 0.0, 1.0])]
    starts = [numpy.zeros(3), elbow, pivot]
    bodies = [_rod(mbs, *link, start, way) for link, start, way in zip(links, starts, ways, strict=True)]
    crank, coupler, rocker = bodies
    mbs.CreateRevoluteJoint(itemNumbers=[ground, crank], position=[0.0, 0.0, 0.0], axis=[1.0, 0.0, 0.0])
    mbs.CreateRevoluteJoint(itemNumbers=[ground, rocker], position=list(pivot), axis=[0.0, 1.0, 0.0])
    mbs.CreateSphericalJoint(itemNumbers=[crank, coupler], position=list(elbow))
    ends = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[length / 2, 0.0, 0.0]))
        for body, (length, _) in ((coupler, links[1]), (rocker, links[2]))
    ]
    return links, bodies, pivot, ends


def _rod(mbs: Any, length: float, mass: float, start: numpy.ndarray, way: numpy.ndarray) -> int:
    from exudyn.utilities import RigidBodyInertia

    aside = numpy.cross(way, [0.3, 0.5, 0.8])
    aside /= numpy.linalg.norm(aside)
    return mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=mass, inertiaTensor=numpy.diag(_inertia(length, mass))),
        referencePosition=list(start + length / 2 * way),
        referenceRotationMatrix=numpy.stack([way, aside, numpy.cross(way, aside)], axis=1),
        gravity=[0.0, 0.0, -1e-3 * BAR.GRAVITY],
    )


def _inertia(length: float, mass: float) -> numpy.ndarray:
    across = mass * length**2 / 12
    return numpy.array([mass * (1e-3 * BAR.THICK) ** 2 / 2, across, across])


def measure() -> list[Row]:
    work, ours = "four-bar for a second, compiled, 40 µs", Job(lambda: compiled(1.0, 4e-5, 201))
    python = Job(lambda: BAR.fallen(numpy.linspace(0.0, 1.0, 201)))
    pairs = [Pair(work, ours, "the element in Python, LSODA", python)]
    for name, words in (("law", "the exported law"), ("sphere", "its own hollow sphere")):
        theirs = if_installed("exudyn", lambda name=name: Job(lambda: in_exudyn(name, 1.0, 2e-5, 201)))  # type: ignore[misc]
        pairs.append(Pair(work, ours, f"Exudyn, {words}, 20 µs", theirs))
    return compare(pairs, repeats=3)


def kept(duration: float = 1.0, step: float = 1e-5, samples: int = 201) -> str:
    """What Exudyn answers, as the example reads it."""
    law, sphere = (in_exudyn(name, duration, step, samples) for name in ("law", "sphere"))
    columns = {"time_s": law.time}
    for name, each in (("law", law), ("sphere", sphere)):
        columns |= {f"{name}_angle_rad": each.angle, f"{name}_lost_N_mm": each.lost}
    rows = numpy.stack(list(columns.values()), axis=1).tolist()
    return "\n".join([",".join(columns), *(",".join(f"{value:.7g}" for value in row) for row in rows)]) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(kept(), encoding="utf-8")
