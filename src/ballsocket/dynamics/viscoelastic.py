"""A ball that is pressed into a liner whose modulus relaxes, and let go again.

While the contact grows, the force is the hereditary integral of the elastic law (correspondence, Lee & Radok). While
it shrinks, the edge of the contact is where the pressure ends, not where the ball ends: after Ting, force and edge at a
time t are those of a history that stopped at an earlier t1, with ∫ g(t - s) ḋ ds = 0 from t1 to t. For radial
springs that is exact, whatever the law, since every spring is pressed in proportion to ḋ. `springs` are those springs,
one by one, through any history.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import require
from ..core.sources import Source
from ..models.foundation import RadialFoundation
from ..models.kinematics import linear_kinematics
from ..problem import Joint
from .potential import Potential, potential_of
from .prony import Prony


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """A joint whose liner relaxes: the model's law holds at once, Poisson's ratio stays.

    Parameters
    ----------
    model : Model
        Any that has a law.
    joint : Joint
        Of plain numbers; Young's modulus of the liner is that of a sudden load.
    modulus : Prony

    Examples
    --------
    >>> import numpy
    >>> import ballsocket as bs
    >>> from ballsocket.dynamics import Prony, Viscoelastic
    >>> liner = Viscoelastic(bs.HessForsbach(), bs.joints["hip-28"], Prony(terms=((0.3, 0.1), (0.2, 10.0))))
    >>> time = numpy.linspace(0.0, 1.0, 401)
    >>> depth = 0.05 * numpy.sin(numpy.pi * time)
    >>> force = liner.pressed(time, depth)
    >>> bool(force[100] > force[300] > 0)  # less on the way back
    True
    """

    sources: ClassVar[tuple[Source, ...]] = (Source("lee1960"), Source("ting1966"))

    model: Model
    joint: Joint
    modulus: Prony

    @cached_property
    def potential(self) -> Potential:
        return potential_of(self.model, self.joint)

    def at_once(self, depth: Numbers) -> Numbers:
        """The force in N of a sudden indentation in mm; 0 where nothing touches."""
        return self.potential(numpy.maximum(numpy.asarray(depth, dtype=float), 0.0))[1]

    def relaxing(self, depth: float, time: Numbers) -> Numbers:
        """The force in N at times (s) after an indentation (mm) that came at once and stays."""
        return self.at_once(numpy.array(depth)) * self.modulus.relaxed(time)

    def creeping(self, force: float, time: Numbers) -> Numbers:
        """The indentation in mm at times (s) after a force (N) that came at once and stays: the contact grows."""
        return self.model.press(self.joint.with_floats(), force=force * self.modulus.crept(time)).indentation

    def dynamic_stiffness(self, depth: float, frequency: Numbers) -> Numbers:
        """The complex stiffness in N/mm of a small vibration (Hz) about an indentation (mm) that lasts."""
        return self.potential(numpy.array(depth))[2] * self.modulus.complex_modulus(frequency)

    def product(self, time: Numbers, depth: Numbers) -> Numbers:
        """What is not to be done: the elastic force times the modulus of that time, g(t) F(d(t))."""
        time, depth = _check_history(time, depth)
        touched = numpy.argmax(depth > 0)
        return self.modulus.relaxed(numpy.maximum(time - time[touched], 0.0)) * self.at_once(depth)

    def grown(self, time: Numbers, depth: Numbers) -> Numbers:
        """The hereditary integral ∫ g(t - s) dF of the elastic force: right as long as the contact has only grown."""
        time, depth = _check_history(time, depth)
        rise = numpy.diff(self.at_once(depth))
        return numpy.append(0.0, numpy.sum(self._weights(time) * rise, axis=1))

    def pressed(self, time: Numbers, depth: Numbers) -> Numbers:
        """The force in N of a ball that is pressed in once and let go.

        Parameters
        ----------
        time : array (instants,)
            In s, growing.
        depth : array (instants,)
            The indentation in mm, which rises from 0 or less to its highest and then falls; straight between instants.

        Raises
        ------
        ValueError
            Times that do not grow; a depth that rises again: ask `springs`.
        """
        time, depth = _check_history(time, depth)
        top = int(numpy.argmax(depth))
        again = numpy.flatnonzero(numpy.diff(depth)[top:] > 0)
        require("depth", depth, _mask_until(len(depth), top, again), "it rises once and falls then; ask `springs`")
        force = self.grown(time, depth)
        weights, bed = self._weights(time), numpy.maximum(depth, 0.0)
        for number in range(top + 1, len(time)):
            force[number] = self._unloading_force(weights[number - 1], bed, top, number)
        return force

    def _unloading_force(self, weights: Numbers, depth: Numbers, top: int, number: int) -> float:
        """Ting: the last instant t1 of the rise from which on the springs at the edge have been pushed and let go."""
        pushed = numpy.cumsum((weights[:number] * numpy.diff(depth)[:number])[::-1])[::-1]
        initial = numpy.flatnonzero(pushed[: top + 1] <= 0)
        if len(initial) and initial[0] == 0:
            return 0.0
        last = int(initial[0]) - 1 if len(initial) else top
        after = pushed[last + 1] if last + 1 < number else 0.0
        share = pushed[last] / (pushed[last] - after)
        edge = depth[last] + share * (depth[last + 1] - depth[last])
        forces = self.at_once(numpy.append(depth[: last + 1], edge))
        return float(numpy.sum(weights[: last + 1] * numpy.diff(forces)))

    def _weights(self, time: Numbers) -> Numbers:
        """The mean of g(t - s) over each stretch of s before each t: (instants - 1, stretches), 0 after t."""
        late, early = time[1:, None] - time[None, :-1], time[1:, None] - time[None, 1:]
        return numpy.where(early >= 0, self.modulus.mean(numpy.maximum(early, 0.0), numpy.maximum(late, 1e-300)), 0.0)

    def springs(self, time: Numbers, depth: Numbers, rings: int = 400) -> Numbers:
        """The force in N of any history, by radial springs that are Maxwell chains, ring by ring.

        A spring whose pressure would fall below 0 lets go, recovers by itself, and is met again where it is then.

        Parameters
        ----------
        time, depth : array (instants,)
            In s and mm, straight between instants.
        rings : int
            Of springs about the pole.

        Raises
        ------
        TypeError
            A model that is not one of radial springs with linear kinematics.
        """
        if not isinstance(self.model, RadialFoundation) or self.model.kinematics is not linear_kinematics:
            raise TypeError(
                f"springs stand for a model of radial springs with linear kinematics, not {self.model.name}"
            )
        time, depth = _check_history(time, depth)
        joint = self.joint.with_floats()
        c, deepest = joint.clearance, max(float(depth.max()), 1e-300)
        width = deepest / (c + deepest) / rings
        m = width * (numpy.arange(rings) + 0.5)
        ball = numpy.maximum(depth, -c)[:, None] * (1.0 - m) - c * m  # d cos φ - c (1 - cos φ)
        pressure = _maxwell_pressures(self.modulus, time, ball)
        factor = 2 * numpy.pi * joint.socket_radius**2 * float(self.model.modulus.of(joint)) * width
        return factor * (pressure @ (1.0 - m))


def _maxwell_pressures(modulus: Prony, time: Numbers, ball: Numbers) -> Numbers:
    """Pressure over the stiffness at once of springs (instants, springs), pushed by a ball's surface."""
    surface = numpy.zeros(ball.shape[1])
    held = numpy.zeros((len(modulus.terms), ball.shape[1]))
    pressure = numpy.zeros(ball.shape)
    g, tau, rest = modulus.shares[:, None], modulus.times[:, None], modulus.rest
    for number, step in enumerate(numpy.diff(time), start=1):
        fade, weight = numpy.exp(-step / tau), -numpy.expm1(-step / tau) * tau / step
        memory = numpy.sum(g * (fade * held - weight * surface), axis=0)
        stiff = rest + float(numpy.sum(g * weight))
        moved = numpy.maximum(ball[number], -memory / stiff)  # the ball's surface, or the one that recovers
        held = fade * held + weight * (moved - surface)
        pressure[number] = numpy.where(moved == ball[number], rest * moved + numpy.sum(g * held, axis=0), 0.0)
        surface = moved
    return pressure


def _check_history(time: Any, depth: Any) -> tuple[Numbers, Numbers]:
    time, depth = numpy.asarray(time, dtype=float), numpy.asarray(depth, dtype=float)
    if time.ndim != 1 or time.shape != depth.shape or len(time) < 2:
        raise ValueError(f"time and depth are rows of one length, 2 or more, got {time.shape} and {depth.shape}")
    require("depth", depth, numpy.isfinite(depth), "an indentation (mm) is finite")
    grows = numpy.append(True, numpy.diff(time) > 0)
    require("time", time, grows, "each is later than the one before")
    require("depth", depth[:1], depth[:1] <= 0, "a history begins before the touch, or at it")
    return time, depth


def _mask_until(count: int, top: int, again: Numbers) -> Numbers:
    """Where a depth does as it should: it does not after the instant from which it rises again."""
    good = numpy.ones(count, dtype=bool)
    if len(again):
        good[top + again[0] + 1 :] = False
    return good
