"""One question at a time: a press of plain floats, a bound law in Python and compiled, the bare formula, and OpenSim.

Fair, because all take turns on one core in one run, at loads that alternate by a millionth, and because OpenSim's
ElasticFoundationForce is asked as in `opensim_rival`, with its coarsest mesh, the fastest that it offers. It says the
force alone; a press says indentation, largest pressure and half angle, a law force and tangent.
"""

from __future__ import annotations

import importlib.util
from functools import partial
from itertools import count
from time import process_time
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.compiled import Compiled, compiled_law
from ballsocket.elasticity.exact.tabulated.curves import JointCurves
from ballsocket.models.kinematics import linear_force, linear_stiffness

from . import opensim_rival
from .report import Report, Rows
from .timing import Spread, Spreads, Work, apart, interleaved, one_core

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
FORCE, DEPTH = 1000.0, 0.02  # N, mm
CALLS, POINTS, JOINTS, REPEATS = 50, 10**5, 20_000, 15
AIMS = {"tabulated": 100.0, "refined": 100.0, "exact": None, "plane-layer": None}  # µs a press; 40 for the others
LAW, COMPILED, EACH, FIRST = 5.0, 300.0, 1.0, 2.5  # µs, ns, µs, ms
BARE, CALL = "the formula, bare", "a Python function that returns its argument"
NOTES = (
    f"Press: {FORCE:g} N, with indentation, largest pressure and half angle. Law: force and tangent {DEPTH} mm deep.",
    "A law of `exact`, `tabulated`, `refined` or `plane-layer` is a curve through their presses. Compiled laws are "
    "asked inside a compiled loop; those of `hertz`, `steuermann` and `liu-reconstruction` are curves there.",
    "The formula, bare: Eq. (13) and its slope, called with five floats.",
    "With a joint of its own for each load, `tabulated` multiplies the matrices of its tables by the polynomials of "
    "each joint: 44 thousand operations for a rigid ball, 200 thousand for an elastic one. A core that does 40 to 50 "
    "thousand million a second, as this one with nothing beside it, needs 1.1 and 5 µs for that alone.",
)


def measure() -> Report:
    """In a process of its own, whose linear algebra has one thread: that can only be said before NumPy starts."""
    return apart(_measured, OPENBLAS_NUM_THREADS="1")


def _measured() -> Report:
    with one_core() as alone:
        singles, every, new = _singles(), _a_joint_each(), _new_joints()
    kept = "Processor time, in one thread, all of it on one core." if alone else "Processor time, in one thread."
    return Report([singles, every, new], [kept, *NOTES], ("opensim",))


def _singles() -> Rows:
    laws = {name: model.law(JOINT) for name, model in bs.catalogue.items()}
    work: dict[str, Work] = {CALL: _law(lambda depth: depth), BARE: _law(_bare())}
    for name, model in bs.catalogue.items():
        work[f"press {name}"], work[f"law {name}"] = _press(model), _law(laws[name])
        if name != "adhesive":  # pulls, and has no curve
            work[f"compiled {name}"] = _compiled(compiled_law(laws[name]))
    if importlib.util.find_spec("opensim") is not None:
        work["opensim"] = _opensim()
    _, seconds = interleaved(REPEATS, work, process_time)
    rows = Rows("One question", ("what", "press, µs", "law, µs", "compiled law, ns"))
    for name in bs.catalogue:
        press = _judged(seconds[f"press {name}"].per(1e-6 * CALLS), AIMS.get(name, 40.0))
        law = _judged(seconds[f"law {name}"].per(1e-6 * CALLS), LAW)
        rows.add(f"`{name}`", press, law, _of_compiled(seconds, name))
    for what in (BARE, CALL):
        rows.add(what, "", seconds[what].per(1e-6 * CALLS), "")
    if "opensim" in seconds:
        rows.add("OpenSim, coarsest mesh: force", seconds["opensim"].per(1e-6 * CALLS), "", "")
    return rows


def _of_compiled(seconds: Spreads, name: str) -> str:
    found = seconds.get(f"compiled {name}")
    return "" if found is None else _judged(found.per(1e-9 * POINTS), COMPILED)


def _press(model: bs.Model) -> Work:
    def work() -> None:
        for call in range(CALLS):
            contact = model.press(JOINT, force=FORCE * (1 + 1e-6 * (call % 2)))
            _ = contact.indentation, contact.max_pressure, contact.half_angle

    return work


def _law(law: Any) -> Work:
    def work() -> None:
        for call in range(CALLS):
            law(DEPTH * (1 + 1e-6 * (call % 2)))

    return work


def _bare() -> Any:
    R2, c, K = float(JOINT.socket_radius), float(JOINT.clearance), float(bs.hess_forsbach(JOINT))
    return lambda depth: (linear_force(R2, c, K, depth), linear_stiffness(R2, c, K, depth))


def _compiled(law: Any) -> Work:
    import numba

    depths = DEPTH * numpy.random.default_rng(1).uniform(0.9, 1.1, POINTS)

    @numba.njit
    def total(law, depths):  # type: ignore[no-untyped-def]
        both = 0.0
        for depth in depths:
            force, tangent = law(depth)
            both += force + tangent
        return both

    return lambda: total(law, depths)


def _opensim() -> Work:
    from .opensim_model import build

    rival, faces = opensim_rival.JOINT, min(opensim_rival.FACES)
    return _law(build(rival.ball_radius, rival.clearance, opensim_rival.K, faces).force)


def _a_joint_each() -> Rows:
    work: dict[str, Work] = {}
    random = numpy.random.default_rng(3)
    force = random.uniform(100.0, 4000.0, JOINTS)
    for ball, what in ((None, "rigid ball"), (bs.STEEL, "steel ball")):
        joint = _joints(random, ball)
        for model in (bs.Refined(), bs.Tabulated()):
            for each, how in ((model, "plain"), (Compiled(model=model), "compiled")):
                work[f"{model.name} {what} {how}"] = partial(each.press, joint, force=force)
        blocks = [joint.with_numbers([part[i : i + 2000] for part in joint.numbers()]) for i in range(0, JOINTS, 2000)]
        work[f"products {what}"] = partial(_products, blocks)
    _, seconds = interleaved(REPEATS, work, process_time)
    columns = ("what", "compiled", "plain", "of these, products of the tables")
    rows = Rows("A joint of its own for each load, µs a press by force", columns)
    for name in ("refined", "tabulated"):
        for what in ("rigid ball", "steel ball"):
            fast, plain = (seconds[f"{name} {what} {how}"].per(1e-6 * JOINTS) for how in ("compiled", "plain"))
            products = seconds[f"products {what}"].per(1e-6 * JOINTS) if name == "tabulated" else ""
            rows.add(f"`{name}`, {what}", _judged(fast, EACH), plain, products)
    return rows


def _products(blocks: list[bs.Joint]) -> None:
    for block in blocks:
        _ = JointCurves("", block).functions


def _joints(random: numpy.random.Generator, ball: bs.Material | None) -> bs.Joint:
    ranges = ((11.0, 23.0), (0.02, 0.4), (3.0, 12.0), (500.0, 1500.0), (0.3, 0.46))
    radius, clearance, thickness, young, poisson = (random.uniform(low, high, JOINTS) for low, high in ranges)
    if ball is not None:
        ball = bs.Material(young=numpy.full(JOINTS, ball.young), poisson=numpy.full(JOINTS, ball.poisson))
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner, ball=ball)


def _new_joints() -> Rows:
    fresh = count()

    def first() -> None:
        for _ in range(10):
            joint = JOINT.replace(liner_thickness=6.75 + 1e-6 * next(fresh), ball=bs.STEEL)
            contact = bs.Exact().press(joint, force=FORCE)
            _ = contact.indentation, contact.max_pressure, contact.half_angle

    _, seconds = interleaved(REPEATS, {"first": first}, process_time)
    rows = Rows("A new joint, ms", ("what", "ours"))
    rows.add("`exact`, a first load", _judged(seconds["first"].per(1e-2), FIRST))
    for name in ("exact", "tabulated", "refined", "plane-layer"):
        _, bound = interleaved(3, {name: partial(bs.catalogue[name].law, JOINT)}, process_time)
        rows.add(f"`{name}`, to bind a law", bound[name].per(1e-3))
    return rows


def _judged(found: Spread, aim: float | None) -> str:
    if aim is None:
        return str(found)
    return f"{found}; aim {aim:g}: {'met' if found.median <= aim else 'missed'}"
