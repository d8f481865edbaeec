"""What a ball joint costs in other programs, and what OpenSim's elastic foundation answers with its usual modulus.

Fair, because every program gets the same joint and takes the same steps: MuJoCo and Exudyn four evaluations a step
(Runge and Kutta), with the exported element and with the contact that they have themselves. MuJoCo has no hollow
sphere: its own contact is that of the ball on a plane, where it is pressed all the time. OpenSim is asked for one force
at a new position. The unit of FMI is called by a program in C, as a host calls it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import ballsocket as bs
from ballsocket.export import TARGETS, ExportJob
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library
from ballsocket.export.fmu import Fmu
from ballsocket.models.modulus import bonded_layer

from . import tools
from .report import Report, Rows
from .timing import Work, interleaved

JOINT = bs.joints["hip-28"]
ELEMENT = bs.ForceElement(bs.HessForsbach(), JOINT)
BOUNCE = tools.Bounce(element=ELEMENT)
STEPS, CALLS, REPEATS, FACES, DEPTH = 10000, 1000, 7, 1000, 0.04
POISSON = (0.3, 0.4, 0.45, 0.49, 0.499)

HOST = """
#include "fmi3.c"
double run(int n) {
    fmi3ValueReference in[9], out[9]; double x[9] = {0, 0, 1.2e-4, 0, 0.001, 0.02, 0, 1, 2}, y[9], sum = 0;
    fmi3Instance c = fmi3InstantiateModelExchange("", "%s", "", 0, 0, 0, 0);
    for (int k = 0; k < 9; k++) in[k] = 1 + k, out[k] = 10 + k;
    for (int i = 0; i < n; i++) {
        x[2] = 1.2e-4 + 1e-9 * (i & 1);
        fmi3SetFloat64(c, in, 9, x, 9);
        fmi3GetFloat64(c, out, 9, y, 9);
        sum += y[2];
    }
    fmi3FreeInstance(c);
    return sum;
}
"""


def measure() -> Report | str:
    missing = [name for name in ("mujoco", "exudyn", "opensim") if find_spec(name) is None]
    if missing:
        return f"{', '.join(missing)} not installed"
    with TemporaryDirectory() as made:
        folder = Path(made)
        for target in TARGETS.values():
            target.write(ExportJob(element=ELEMENT, name=tools.NAME, depth=0.05), folder)
        work: dict[str, tuple[Work, int]] = {
            "FMI 3, one set and one get of nine numbers": (_fmu(folder), CALLS),
            "OpenSim, a force: the expression": (_expression(folder), CALLS),
            f"OpenSim, a force: its elastic foundation, {FACES} faces": (_foundation(), CALLS // 10),
            "MuJoCo, a step: the plug-in": (lambda: tools.mujoco(BOUNCE, folder), STEPS),
            "MuJoCo, a step: its own contact, ball on plane": (_plane, STEPS),
            "Exudyn, a step: the user function": (lambda: tools.exudyn(BOUNCE, folder), STEPS),
            "Exudyn, a step: its own hollow sphere": (lambda: tools.exudyn_hollow_sphere(BOUNCE, folder), STEPS),
        }
        _, seconds = interleaved(REPEATS, {name: each for name, (each, _) in work.items()})
    rows = Rows("Time, µs", ("what", "takes"))
    for name, (_, count) in work.items():
        rows.add(name, seconds[name].per(1e-6 * count))
    notes = [
        f"Steps are those of Runge and Kutta, four forces each, {STEPS} of them in a run with all that begins it.",
        f"Timed is the paper's law, {1e3 * DEPTH:g} µm deep in OpenSim. Towards ν = ½ the expression is put through "
        "`exact`, and the foundation has the modulus of the bonded layer, as OpenSim's users take it.",
    ]
    return Report([rows, _towards_half()], notes, ("mujoco", "exudyn", "opensim"))


def _fmu(folder: Path) -> Work:
    unit = Fmu(element=ELEMENT, name=tools.NAME)
    for name, text in unit.sources.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "host.c").write_text(HOST % unit.guid, encoding="ascii")
    path = shared_library([f"{tools.NAME}.c", "host.c"], folder / f"host{LIBRARY_ENDING}", folder)
    run = ctypes.CDLL(str(path)).run
    run.restype = ctypes.c_double
    return lambda: run(CALLS)


def _expression(folder: Path) -> Work:
    force = _opensim_force(folder)

    def work() -> None:
        for call in range(CALLS):
            force(DEPTH * (1 + 1e-6 * (call % 2)))

    return work


def _opensim_force(folder: Path) -> Callable[[float], float]:
    """The force in N at an indentation in mm, of the exported file."""
    import opensim

    opensim.Logger.setLevelString("Error")
    opensim.Logger.removeFileSink()
    model = opensim.Model(str(folder / f"{tools.NAME}.osim"))
    model.setGravity(opensim.Vec3(0))
    state = model.initSystem()
    along = model.getCoordinateSet().get("x")
    ball = model.getBodySet().get("ball").getMobilizedBodyIndex()

    def force(depth: float) -> float:
        along.setValue(state, 1e-3 * (float(JOINT.clearance) + depth), False)
        model.realizeDynamics(state)
        forces = model.getRigidBodyForces(state) if hasattr(model, "getRigidBodyForces") else None
        return 0.0 if forces is None else -float(forces.get(ball).get(1).get(0))

    force.model = model  # type: ignore[attr-defined] # it must not go while it is asked
    return force


def _foundation() -> Work:
    from .opensim_model import build

    pair = build(float(JOINT.ball_radius), float(JOINT.clearance), float(bs.hess_forsbach(JOINT)), FACES)

    def work() -> None:
        for call in range(CALLS // 10):
            pair.force(DEPTH * (1 + 1e-6 * (call % 2)))

    return work


def _plane() -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option integrator="RK4" timestep="2e-6"/><worldbody><geom type="plane" size="1 1 1"/>'
        '<body pos="0 0 0.01399"><freejoint/><geom type="sphere" size="0.014" mass="1"/></body></worldbody></mujoco>'
    )
    mujoco.mj_step(model, mujoco.MjData(model), STEPS)


def _towards_half() -> Rows:
    """Forces towards ν = ½."""
    from .opensim_model import build

    columns = ("Poisson's ratio", "exact, N", "our expression in OpenSim", "OpenSim's foundation, K of a bonded layer")
    rows = Rows(f"The force {1e3 * DEPTH:g} µm deep, in OpenSim", columns)
    for poisson in POISSON:
        joint = JOINT.replace(liner=bs.Material(young=1000.0, poisson=poisson), ball=None)
        exact = float(bs.Exact().press(joint, indentation=DEPTH).force)
        with TemporaryDirectory() as made:
            job = ExportJob(element=bs.ForceElement(bs.Exact(), joint), name=tools.NAME, depth=1.25 * DEPTH)
            TARGETS["opensim"].write(job, Path(made))
            ours = _opensim_force(Path(made))(DEPTH)
        K = float(bonded_layer(joint))
        theirs = build(float(joint.ball_radius), float(joint.clearance), K, FACES).force(DEPTH)
        cells: tuple[Any, ...] = (f"{100 * (ours / exact - 1):+.3f} %", f"{100 * (theirs / exact - 1):+.0f} %")
        rows.add(f"{poisson:g}", f"{exact:.0f}", *cells)
    return rows
