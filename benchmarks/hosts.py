"""A ball joint in FMI, OpenSim, MuJoCo and Exudyn: the exported joint beside the contact that each program has itself.

MuJoCo and Exudyn take Runge and Kutta's steps of four forces. MuJoCo has no hollow sphere: its own contact is that of
the ball on a plane, pressed all the time. The unit of FMI is called by a program in C, as a host calls it. Towards
ν = ½ OpenSim's foundation has the modulus of the bonded layer, as its users take it.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import ballsocket as bs
from ballsocket.export import TARGETS, ExportJob
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library
from ballsocket.export.fmu import Fmu
from ballsocket.models.modulus import bonded_layer

from . import tools
from .opensim_model import build, exported
from .report import Pair, Row, compare, if_installed
from .timing import Job, MissingError

JOINT = bs.joints["hip-28"]
ELEMENT = bs.ForceElement(bs.HessForsbach(), JOINT)
BOUNCE = tools.Bounce(element=ELEMENT)
STEPS, CALLS, DEPTH = 10000, 1000, 0.04
POISSON = (0.3, 0.49)

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


def measure() -> list[Row]:
    with TemporaryDirectory() as made:
        folder = Path(made)
        try:
            for target in TARGETS.values():
                target.write(ExportJob(element=ELEMENT, name=tools.NAME, depth=0.05), folder)
            pairs = [Pair("FMI 3, one set and one get of nine numbers", _fmu(folder))]
        except NoCompiler as missing:
            raise MissingError(str(missing)) from missing
        hollow = partial(_bounce, tools.exudyn_hollow_sphere, folder)
        hosts: tuple[tuple[str, str, Callable[[Path], Job], str, Callable[[], Job]], ...] = (
            ("opensim", "a force", _force, "its elastic foundation, 924 faces", _foundation),
            ("mujoco", "a step", partial(_bounce, tools.mujoco), "its own contact", lambda: Job(_plane, STEPS)),
            ("exudyn", "a step", partial(_bounce, tools.exudyn), "its own hollow sphere", hollow),
        )
        rows = []
        for package, what, ours, rival, theirs in hosts:
            work, job = f"{package}, {what} by the exported joint", if_installed(package, partial(ours, folder))
            if isinstance(job, str):
                rows.append(Row(work, f"skipped: {job}", rival, skipped=True))
            else:
                pairs.append(Pair(work, job, rival, theirs()))
        rows += compare(pairs)
    return [*rows, *_towards_half()]


def _force(folder: Path) -> Job:
    return exported(folder / f"{tools.NAME}.osim", float(JOINT.clearance)).job(DEPTH, CALLS)


def _foundation() -> Job:
    return build(JOINT, float(bs.hess_forsbach(JOINT)), 1000).job(DEPTH, 100)


def _bounce(program: Callable[[tools.Bounce, Path], object], folder: Path) -> Job:
    return Job(lambda: program(BOUNCE, folder), STEPS)


def _fmu(folder: Path) -> Job:
    unit = Fmu(element=ELEMENT, name=tools.NAME)
    for name, text in unit.sources.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "host.c").write_text(HOST % unit.guid, encoding="ascii")
    path = shared_library([f"{tools.NAME}.c", "host.c"], folder / f"host{LIBRARY_ENDING}", folder)
    run = ctypes.CDLL(str(path)).run
    run.restype = ctypes.c_double
    return Job(lambda: run(CALLS), CALLS)


def _plane() -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_string(
        '<mujoco><option integrator="RK4" timestep="2e-6"/><worldbody><geom type="plane" size="1 1 1"/>'
        '<body pos="0 0 0.01399"><freejoint/><geom type="sphere" size="0.014" mass="1"/></body></worldbody></mujoco>'
    )
    mujoco.mj_step(model, mujoco.MjData(model), STEPS)


def _towards_half() -> list[Row]:
    """Errors of the force in OpenSim against `exact`."""
    rows = []
    for poisson in POISSON:
        work = f"error of the force in OpenSim, 40 µm deep, ν = {poisson:g}"
        joint = JOINT.replace(liner=bs.Material(young=1000.0, poisson=poisson), ball=None)
        rival = "its foundation, modulus of a bonded layer"
        if find_spec("opensim") is None:
            rows.append(Row(work, "skipped: opensim is not installed", rival, skipped=True))
            continue
        exact = float(bs.Exact().press(joint, indentation=DEPTH).force)
        with TemporaryDirectory() as made:
            job = ExportJob(element=bs.ForceElement(bs.Exact(), joint), name=tools.NAME, depth=1.25 * DEPTH)
            TARGETS["opensim"].write(job, Path(made))
            ours = exported(Path(made) / f"{tools.NAME}.osim", float(JOINT.clearance)).force(DEPTH)
        theirs = build(joint, float(bonded_layer(joint)), 1000).force(DEPTH)
        rows.append(Row(work, f"{100 * abs(ours / exact - 1):.2f} %", f"{rival}: {100 * (theirs / exact - 1):+.0f} %"))
    return rows
