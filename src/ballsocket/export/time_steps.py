"""Advice on the time step of a host program: the largest stable one, and one that keeps the energy of an impact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from ..dynamics import ForceElement, PreloadedElement

_ALLOWED_ENERGY_ERROR = 0.01  # energy that a bounce may gain or lose, relative to its energy
_PHASES = 24  # number of bounces that differ in the part of a step before the first touch

_MAX_STEPS = 10_000  # largest number of steps of a bounce

_SHARES = numpy.geomspace(1.0, 0.01, 60)
"""Time steps that are tried, as shares of the largest stable one, in falling order."""


@dataclass(frozen=True, kw_only=True)
class TimeStepAdvice:
    """Time steps in s for a ball of `mass` in kg in a fixed socket, at indentations up to `depth` in mm.

    `stable` is the largest stable step of semi-implicit (symplectic) Euler, as in MuJoCo, with the largest stiffness k
    in N/mm: 2/sqrt(k/m) without damping. Friction and lubricant are not considered. It is at most the shortest time of
    a relaxing liner, so that Euler steps of its forces may precede or follow the position. `accurate` is the largest
    step with which a bounce up to that depth keeps its energy within 1 %, whenever the ball touches within a step, by
    the elastic force alone.
    """

    mass: float
    depth: float
    stiffness: float
    stable: float
    accurate: float

    def __str__(self) -> str:
        return (
            f"time steps for a ball of {self.mass:g} kg that is pressed by up to {self.depth:.3g} mm "
            f"({self.stiffness:.3g} N/mm): an explicit integration is stable below {self.stable:.2g} s, and a bounce "
            f"keeps its energy within {100 * _ALLOWED_ENERGY_ERROR:g} % up to {self.accurate:.2g} s"
        )


def time_step_advice(element: ForceElement | PreloadedElement, depth: float, mass: float) -> TimeStepAdvice:
    """Advise on time steps in s for a ball of a mass in kg that is pressed up to an indentation in mm.

    The socket is fixed. Two free bodies of masses m and M move like one with the mass m M/(m + M).
    """
    depth = min(depth, element.wall)
    depths = depth * numpy.linspace(0.0, 1.0, 401)[1:]
    if isinstance(element, PreloadedElement):  # it is stiffest at rest, where it moves with little force
        rows = element.table.evaluate("energy", numpy.append(1e-3 * depth, depths))
        forces, stiffnesses = numpy.array([row[1:] for row in rows]).max(axis=0)
    else:
        _, forces, stiffnesses = element.potential(depths)
    stiffness = float(numpy.max(stiffnesses))
    constants = element.constants
    damping = constants.hysteresis * float(numpy.max(forces)) + constants.time * stiffness
    relaxation = element.relaxation if isinstance(element, ForceElement) else None
    stable = _stable_step(1e-3 * mass, stiffness, damping, () if relaxation is None else relaxation.terms)
    changes = [_energy_change(depths, forces[-len(depths) :], mass, share * stable) for share in _SHARES]
    too_large = numpy.flatnonzero(~(numpy.array(changes) <= _ALLOWED_ENERGY_ERROR))
    accurate = float(_SHARES[min(too_large.max(initial=-1) + 1, len(_SHARES) - 1)]) * stable
    return TimeStepAdvice(mass=mass, depth=depth, stiffness=stiffness, stable=stable, accurate=accurate)


def _stable_step(mass: float, stiffness: float, damping: float, terms: Sequence[tuple[float, float]]) -> float:
    """Compute the largest stable step h in s of semi-implicit Euler (t, N/mm, N s/mm), at most the shortest time.

    A step that reverses all signs is at the limit: k h²/(4 m) (1 + Σ g h/(2 τ - h)) + c h/(2 m) = 1.
    """
    from scipy.optimize import brentq  # slow to import

    def excess(step: float) -> float:
        relaxed = sum(share * step / (2.0 * time - step) for share, time in terms)
        return 0.25 * stiffness * step * step / mass * (1.0 + relaxed) + 0.5 * damping * step / mass - 1.0

    # without relaxation the positive root, in a form without cancellation
    largest = 4.0 * mass / (damping + (damping * damping + 4.0 * stiffness * mass) ** 0.5)
    largest = min([largest, *(time for _, time in terms)])
    return float(brentq(excess, 0.0, largest)) if terms and excess(largest) > 0.0 else largest


def _energy_change(depths: Numbers, forces: Numbers, mass: float, step: float) -> float:
    """Integrate bounces on a force law (mm, N) by semi-implicit Euler; return the largest relative energy change."""
    depths, forces = numpy.append(0.0, depths), numpy.append(0.0, forces)
    work, last_stiffness = numpy.trapezoid(forces, depths), (forces[-1] - forces[-2]) / (depths[-1] - depths[-2])
    impact_speed = (2.0 * work / (1e-3 * mass)) ** 0.5
    depth = -impact_speed * step * numpy.linspace(0.0, 1.0, _PHASES, endpoint=False)
    speed, leaving = numpy.full(_PHASES, impact_speed), numpy.full(_PHASES, False)
    for _ in range(_MAX_STEPS):
        if leaving.all():
            break
        excess = numpy.clip(depth - depths[-1], 0.0, None)
        force = numpy.interp(depth, depths, forces) + excess * last_stiffness
        speed = numpy.where(leaving, speed, speed - force * step / (1e-3 * mass))
        depth = depth + speed * step
        leaving = leaving | ((depth <= 0.0) & (speed < 0.0))
    return float(numpy.max(abs((speed / impact_speed) ** 2 - 1.0)))
