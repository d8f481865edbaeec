"""A ball pressed into a cup at a tilt: a new clearance, one load, a cycle, batches; beside CalculiX.

CalculiX gets the same cup, rigid ball and displacement, in the limit of small displacements, on meshes as coarse as its
force allows: 0.69 and 0.05 % from ours.
"""

from __future__ import annotations

import os
import shutil
from functools import partial
from itertools import count
from math import pi, radians
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest import mock

import numpy

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import TiltedDeck, run

from .report import Pair, Row, compare, if_installed
from .timing import Job

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
INDENTATION, TILT, CYCLE = 0.04, radians(45.0), 100
TILTED = bs.Sphere(cup=bs.Cup(inclination=radians(45.0), anteversion=radians(15.0)))
BATCHED = bs.joints["hip-36"]
_fresh = count(1)


def measure() -> list[Row]:
    model, springs = bs.Sphere(), bs.Sphere(surface=bs.Springs())
    displaced = Job(lambda: model.press(JOINT, indentation=INDENTATION, tilt=TILT))
    forced = Job(lambda: [model.press(JOINT, force=3000.0, tilt=TILT) for _ in range(9)], 9)
    jax = if_installed("jax", partial(jax_job, 64))
    with TemporaryDirectory() as folder:
        pairs = [
            Pair("tilted cup, a new liner thickness and its first press", _set_up(model)),
            Pair("tilted cup, a new clearance in a known bore and its first press", _new_clearance(model)),
            Pair("tilted cup, a displacement", displaced, "CalculiX, 2954 nodes", _calculix(folder, 11.25)),
            Pair("tilted cup, a displacement", displaced, "CalculiX, 4570 nodes", _calculix(folder, 9.0)),
            Pair("tilted cup, a force", forced),
            Pair(f"tilted cup, each of a cycle of {CYCLE} loads", _cycle(model), "springs", _cycle(springs)),
            Pair("tilted cup, each of 64 loads at once", _batch(64), "one at a time", _batch(1)),
            Pair("tilted cup, each of 64 loads at once", _batch(64), "JAX, float32", jax),
        ]
        return compare(pairs, repeats=2)


def _set_up(model: bs.Sphere) -> Job:
    """A liner that nobody has pressed, and an empty cache on disk."""

    def call() -> None:
        joint = JOINT.replace(liner_thickness=6.75 + 1e-7 * next(_fresh))
        with TemporaryDirectory() as folder, mock.patch.dict(os.environ, BALLSOCKET_CACHE=folder):
            model.press(joint, indentation=INDENTATION)

    return Job(call)


def _new_clearance(model: bs.Sphere) -> Job:
    """A smaller ball in a known bore."""

    def call() -> None:
        change = 1e-7 * next(_fresh)
        joint = JOINT.replace(ball_radius=17.9 - change, clearance=0.1 + change)
        model.press(joint, force=3000.0, tilt=TILT)

    return Job(call)


def _cycle(model: bs.Sphere) -> Job:
    """A load that comes and goes, and swings."""
    time = 2 * pi * numpy.arange(CYCLE) / CYCLE
    swing = 0.4 + 0.3 * numpy.cos(time)
    direction = numpy.stack([numpy.sin(swing), 0.2 * numpy.sin(time), numpy.cos(swing)], axis=-1)
    return Job(lambda: model.press(JOINT, force=1650.0 + 1350.0 * numpy.sin(time), direction=direction), CYCLE)


def _calculix(folder: str, size: float) -> Job | str:
    """Elements of a size in degrees."""
    if shutil.which("ccx") is None:
        return "no command ccx"
    deck = TiltedDeck(joint=JOINT, cup=bs.Cup(), indentation=INDENTATION, tilt=TILT, element_size=radians(size))
    place = Path(folder) / f"{size:g}"
    deck.write(place)
    return Job(lambda: run(place))


def _loads(number: int) -> tuple[Any, Any]:
    """Forces of 500 to 3500 N, and tilts of 0 to 69 degrees in another order."""
    order = numpy.random.default_rng(0).permutation(number)
    return numpy.linspace(500.0, 3500.0, number), numpy.linspace(0.0, 1.2, number)[order]


def _batch(number: int) -> Job:
    force, tilt = _loads(number)
    return Job(lambda: TILTED.press(BATCHED, force=force, tilt=tilt), number)


def jax_job(number: int, tolerance: float = 1e-4) -> Job:
    """Displacements and largest pressures of many loads in single precision, on JAX's default device."""
    import jax

    from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere

    force, tilt = _loads(number)
    direction = numpy.stack([numpy.sin(tilt), 0.0 * tilt, numpy.cos(tilt)], axis=-1) @ numpy.array(TILTED.cup.frame)
    cup = JaxSphere(model=TILTED, joint=BATCHED, tolerance=tolerance)
    inputs = jax.numpy.asarray(force, dtype="float32"), jax.numpy.asarray(direction, dtype="float32")

    @jax.jit
    def press(force: Any, direction: Any) -> Any:
        contacts = cup.press(force, direction)
        return contacts.displacement, contacts.max_pressure, contacts.converged

    if not numpy.all(press(*inputs)[2]):
        raise RuntimeError("a load did not converge")
    return Job(lambda: jax.block_until_ready(press(*inputs)), number)
