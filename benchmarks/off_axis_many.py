"""Tilted loads on one real cup in batches: NumPy on one core, JAX on one core, JAX on a GPU where there is one.

Times on the processor are process time, which other programs on the machine disturb less than the clock on the wall.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import radians
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere
from ballsocket.elasticity.off_axis.rim_curve import cached_rim_points

from .report import Report, Rows
from .timing import Clock, Spread, interleaved, one_core

REPEATS = 2
JOINT, MODEL = bs.joints["hip-36"], bs.Sphere(cup=bs.Cup(inclination=radians(45.0), anteversion=radians(15.0)))
QUANTITIES = {
    "half angle": "half_angle",
    "largest pressure": "max_pressure",
    "stiffness": "stiffness",
    "edge distance": "edge_margin",
}


def loads(count: int) -> tuple[Any, Any]:
    """Forces of 500 to 3500 N, and tilts of 0 to 69 degrees in another order."""
    order = numpy.random.default_rng(0).permutation(count)
    return numpy.linspace(500.0, 3500.0, count), numpy.linspace(0.0, 1.2, count)[order]


def measure() -> Report:
    rows = Rows("Milliseconds a load, process time on one core", ("what", "ours", "aims"))
    with one_core():
        for count, aim in ((1, ""), (64, "4"), (512, "")):
            rows.add(f"NumPy, by force, {count} at once", _per_load(_pressed(count), count), aim)
        rows.add(
            "NumPy, by force, out of the plane of the axis, 64 at once", _per_load(_pressed(64, azimuth=0.5), 64), ""
        )
        for title, name in QUANTITIES.items():
            rows.add(f"then {title}, 64 at once", _afterwards(name), "less than the solve")
        rows.add(
            "the first edge distances in the bore, 64 at once",
            _afterwards("edge_margin", cached_rim_points.cache_clear),
            "",
        )
        rows.add('NumPy, keep="summary", 64 at once', _per_load(_pressed(64, "summary"), 64), "")
    tables, notes = [rows], ["500 to 3500 N at 0 to 69 degrees from the axis of a hemisphere, rings of 2 degrees."]
    try:
        for tolerance in (1e-4, 2e-5):
            seconds = jax_seconds(64, tolerance, time.process_time)
            rows.add(f"JAX, float32, {tolerance:g}, 64 at once, on the processor", seconds.per(64e-3), "")
    except ImportError:
        notes.append("JAX is not installed.")
    return Report(tables, notes, ("jax", "scipy"))


def _pressed(count: int, keep: str = "fields", azimuth: float = 0.0) -> Callable[[], Any]:
    force, tilt = loads(count)
    return lambda: MODEL.press(JOINT, force=force, tilt=tilt, azimuth=azimuth, keep=keep)


def _per_load(work: Callable[[], Any], count: int) -> Spread:
    _, seconds = interleaved(REPEATS, {"work": work}, time.process_time)
    return seconds["work"].per(1e-3 * count)


def _afterwards(name: str, prepare: Callable[[], object] = lambda: None) -> Spread:
    """Milliseconds a contact for a quantity of contacts that are solved, after a preparation; the first is left out."""
    seconds = []
    for _ in range(REPEATS + 1):
        contact = _pressed(64)()
        prepare()
        start = time.process_time()
        getattr(contact, name)
        seconds.append(time.process_time() - start)
    return Spread(tuple(seconds[1:])).per(64e-3)


def jax_seconds(count: int, tolerance: float, clock: Clock) -> Spread:
    """Seconds of displacements and largest pressures of so many loads, compiled before."""
    import jax

    force, tilt = loads(count)
    direction = numpy.stack([numpy.sin(tilt), 0.0 * tilt, numpy.cos(tilt)], axis=-1) @ numpy.array(MODEL.cup.frame)
    cup = JaxSphere(model=MODEL, joint=JOINT, tolerance=tolerance)
    inputs = jax.numpy.asarray(force, dtype="float32"), jax.numpy.asarray(direction, dtype="float32")

    @jax.jit
    def press(force: Any, direction: Any) -> Any:
        contacts = cup.press(force, direction)
        return contacts.displacement, contacts.max_pressure, contacts.converged

    converged = numpy.asarray(press(*inputs)[2]).mean()
    if converged < 1:
        raise RuntimeError(f"{100 * converged:.1f} % of the loads converged")
    _, seconds = interleaved(REPEATS, {"press": lambda: jax.block_until_ready(press(*inputs))}, clock)
    return seconds["press"]
