"""The same bounce of a ball in its socket in every program that a joint is exported to: how far they are apart.

A ball of 1 kg in a hip of 28 mm, by the paper's law: thrown aside inside its clearance at 0.1 m/s, it bounces eight
times in 20 ms, under its weight, 21 µm deep at most. No friction and no damping, since not all programs know them. The
reference is a method of order 8 with tolerances of 1e-11 on the exported module.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy

import ballsocket as bs
from ballsocket.export import TARGETS, ExportJob

from . import tools
from .report import Report, Rows
from .tools import Bounce

PROGRAMS: dict[Callable[[Bounce, Path], numpy.ndarray], str] = {
    tools.ours: "",
    tools.fmu: "fmpy",
    tools.mujoco: "mujoco",
    tools.mujoco_callback: "mujoco",
    tools.drake: "pydrake",
    tools.exudyn: "exudyn",
    tools.opensim: "opensim",
    tools.exudyn_hollow_sphere: "exudyn",
}
"""Each with the package that it needs."""


def measure() -> Report:
    bounce = Bounce(element=bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"]))
    rows = Rows("Largest difference of the position, nm", ("program", "difference", "integrator", "s"))
    with TemporaryDirectory() as made:
        folder = Path(made)
        for target in TARGETS.values():
            target.write(ExportJob(element=bounce.element, name=tools.NAME, depth=0.05), folder)
        reference = tools.python(bounce, folder)
        for program, needed in PROGRAMS.items():
            name = program.__name__.replace("_", " ")
            about = (program.__doc__ or "").splitlines()[0]
            if needed and find_spec(needed) is None:
                rows.add(name, f"{needed} is not installed", about, "")
                continue
            begun = perf_counter()
            off = numpy.max(abs(program(bounce, folder) - reference))
            rows.add(name, f"{1e6 * off:.3g}", about, f"{perf_counter() - begun:.2f}")
    deepest = numpy.linalg.norm(reference, axis=1).max() - bounce.element.constants.clearance
    notes = [
        f"{bounce.samples} times over {1e3 * bounce.duration:g} ms; the ball moves by 0.1 mm and is pressed in by "
        f"{1e3 * deepest:.1f} µm at most.",
        "The hollow sphere is Exudyn's own contact with the k and n nearest to the law up to 50 µm: another law.",
        "The seconds include what each program needs to begin.",
    ]
    return Report([rows], notes, ("fmpy", "mujoco", "drake", "exudyn", "opensim"))
