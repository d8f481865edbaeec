"""A million presses by force from the tables of the exact answer: one joint under many loads, and random joints.

The aim is a million presses a second on one core. Beside it the exact solver, which answers a sample of the same
problems, and the paper's closed form. Fair, because all run on the same inputs in NumPy on the same one core, each
gives force, indentation, half angle and pressure, and the pressures from the tables are compared with the exact ones.
"""

from __future__ import annotations

from dataclasses import replace

import numpy

import ballsocket as bs

from .report import Report, Rows
from .timing import Spread, Work, interleaved, one_core

POINTS, SAMPLE, REPEATS, AIM = 10**6, 200, 5, 1000.0  # AIM in ns a press
ONE, STEEL = "one joint, rigid ball", "one joint, ball of steel"
MANY, MANY_STEEL = "random joints, rigid ball", "random joints, ball of steel"


def measure() -> Report:
    random = numpy.random.default_rng(2021)
    force = random.uniform(10.0, 4000.0, POINTS)
    ranges = ((11.0, 23.0), (0.02, 0.2), (3.0, 15.0), (500.0, 3000.0), (0.3, 0.49))
    many = joint_of(*(random.uniform(low, high, POINTS) for low, high in ranges))
    one = joint_of(17.9, 0.1, 6.75, 1000.0, 0.4)
    joints = {ONE: one, STEEL: replace(one, ball=bs.STEEL), MANY: many, MANY_STEEL: replace(many, ball=bs.STEEL)}
    work = {name: _work(joint, force) for name, joint in joints.items()}
    rivals = {f"{model.name}, {name}": _rival(model, joints[name], force) for model, name in _RIVALS}
    with one_core() as pinned:
        _, seconds = interleaved(REPEATS, work | rivals)
    rows = Rows("A press by force with its maximum pressure, ns", ("what", "ours", "rival", "ratio"))
    for name in joints:
        rows.add(name, taken := seconds[name].per(1e-9 * POINTS), f"aim {AIM:g}", _share(taken.per(AIM)))
    for model, name in _RIVALS:
        ours, rival = seconds[name].per(1e-9 * POINTS), seconds[f"{model.name}, {name}"].per(1e-9 * _count(model))
        rows.add(f"{name}, against {model.name}", ours, rival, f"{rival.over(ours)} times faster")
    notes = [
        "All on one core." if pinned else "Not held to one core.",
        f"The exact solver answers the first {SAMPLE} problems, to a relative tolerance of 1e-6.",
        *(
            f"Largest relative difference of the maximum pressure, {name}: {_apart(joints[name], force):.1e}."
            for name in joints
        ),
    ]
    return Report([rows], notes)


def joint_of(radius: object, clearance: object, thickness: object, young: object, poisson: object) -> bs.Joint:
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner)


_RIVALS: tuple[tuple[bs.Model, str], ...] = (
    (bs.Exact(), ONE),
    (bs.Exact(), MANY),
    (bs.HessForsbach(), ONE),
    (bs.HessForsbach(), MANY),
)


def _work(joint: bs.Joint, force: numpy.ndarray) -> Work:
    model = bs.Tabulated()
    return lambda: model.press(joint, force=force).max_pressure


def _rival(model: bs.Model, joint: bs.Joint, force: numpy.ndarray) -> Work:
    some, load = _first(joint, force, _count(model))
    return lambda: (contact := model.press(some, force=load)).max_pressure + contact.half_angle


def _count(model: bs.Model) -> int:
    return SAMPLE if isinstance(model, bs.Exact) else POINTS


def _first(joint: bs.Joint, force: numpy.ndarray, count: int) -> tuple[bs.Joint, numpy.ndarray]:
    numbers = [number[:count] if numpy.ndim(number) else number for number in joint.numbers()]
    return joint.with_numbers(numbers), force[:count]


def _apart(joint: bs.Joint, force: numpy.ndarray) -> float:
    some, load = _first(joint, force, SAMPLE)
    exact, ours = (model.press(some, force=load).max_pressure for model in (bs.Exact(), bs.Tabulated()))
    return float(numpy.nanmax(numpy.abs(ours / exact - 1)))


def _share(of_aim: Spread) -> str:
    return f"{of_aim} of the aim: {'met' if of_aim.median <= 1 else 'missed'}"
