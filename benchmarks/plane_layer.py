"""One case of the numerical plane layer: a press by force, with its maximum pressure.

There is no program at hand that solves this problem, so the rival is the aim, 10 ms a case, and the batch: the same
cases in one call of arrays. Fair, because both answer the same random joints, and the answers are compared.
"""

from __future__ import annotations

import numpy

import ballsocket as bs

from .report import Report, Rows
from .timing import Spread, Work, interleaved

CASES, REPEATS, AIM = 200, 7, 10.0  # AIM in ms


def measure() -> Report:
    random = numpy.random.default_rng(2000)
    ranges = ((11.0, 23.0), (0.02, 0.2), (3.0, 15.0), (500.0, 3000.0), (0.3, 0.49))
    numbers = [random.uniform(low, high, CASES) for low, high in ranges]
    width = numpy.radians(random.uniform(5.0, 20.0, CASES))  # within the model's validity
    model, joint = bs.PlaneLayer(), joint_of(*numbers)
    force = model.press(joint, half_angle=width).force
    joints = [joint_of(*row) for row in numpy.transpose(numbers).tolist()]
    cases = list(zip(joints, force.tolist(), strict=True))
    each: list[list[float]] = []

    def alone() -> None:
        each.append([float(model.press(one, force=load).max_pressure) for one, load in cases])

    work: dict[str, Work] = {"alone": alone, "batch": lambda: model.press(joint, force=force).max_pressure}
    _, seconds = interleaved(REPEATS, work)
    batch = model.press(joint, force=force)
    rows = Rows("A press by force with its maximum pressure, ms per case", ("what", "ours", "rival", "ratio"))
    for what, name in ((f"{CASES} random joints, one at a time", "alone"), (f"the same, one call of {CASES}", "batch")):
        taken = seconds[name].per(1e-3 * CASES)
        rows.add(what, taken, f"aim {AIM:g}", _share(taken.per(AIM)))
    faster = seconds["alone"].over(seconds["batch"])
    rows.add(
        "batch against one at a time",
        *(seconds[k].per(1e-3 * CASES) for k in ("batch", "alone")),
        f"{faster} times faster",
    )
    apart = float(numpy.max(numpy.abs(numpy.array(each[-1]) / batch.max_pressure - 1)))
    back = float(numpy.max(numpy.abs(batch.half_angle / width - 1)))
    notes = [
        f"Largest relative difference of the maximum pressure, batch against one at a time: {apart:.1e}.",
        f"The loads were made from half angles of 5 to 20 degrees, which come back within {back:.1e}; "
        f"{int(numpy.count_nonzero(batch.status))} of {CASES} have a status other than OK.",
        "Linear algebra on as many threads as NumPy takes by itself.",
    ]
    return Report([rows], notes, ("scipy",))


def joint_of(radius: object, clearance: object, thickness: object, young: object, poisson: object) -> bs.Joint:
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner)


def _share(of_aim: Spread) -> str:
    return f"{of_aim} of the aim: {'met' if of_aim.median <= 1 else 'missed'}"
