"""Contact with a viscoelastic liner: relaxation, creep, vibration, and the force of a loading cycle.

While the contact grows, the force is the hereditary integral of the elastic law (correspondence principle, Lee &
Radok). While it shrinks, Ting's solution applies. Force and edge at a time t are those of a history that stopped at an
earlier time t1, with ∫ g(t - s) ḋ ds = 0 from t1 to t. For radial springs it is exact, because ḋ compresses all springs
in proportion. `spring_force` integrates the springs numerically for any history.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy

from ..contact import Model
from ..core.arrays import Array, Numbers, where
from ..core.checks import check_number, require, shown
from ..core.sources import Source
from ..models.foundation import RadialFoundation
from ..models.kinematics import linear_kinematics
from ..problem import Joint
from .potential import Potential, potential_of
from .reaction import Elastic

_SHORTEST_TIME = 1e-15  # shortest relaxation time in s; a shorter one vanishes in the time of an integration


@dataclass(frozen=True, kw_only=True)
class Prony:
    """Relaxation modulus as a Prony series, relative to the instantaneous modulus.

    g(t) = g∞ + Σ g_i exp(-t/τ_i), with g(0) = 1.

    Parameters
    ----------
    terms : tuple of (float, float)
        Shares g_i, above 0 and with a sum below 1, and relaxation times τ_i in s, 1e-15 or more. g∞ is 1 minus the sum.

    Raises
    ------
    ValueError
        No terms; a share that is not positive; a time that is too short; shares with a sum of 1 or more.
    TypeError
        Terms that are no pairs of numbers.
    """

    terms: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        try:
            pairs = [(share, time) for share, time in self.terms]
        except (TypeError, ValueError) as error:
            raise TypeError(
                f"terms must be pairs of a share and a relaxation time (s), got {shown(self.terms)}"
            ) from error
        terms = tuple(
            (check_number("a share", share), check_number("a relaxation time", time)) for share, time in pairs
        )
        require("the number of terms", len(terms), len(terms) > 0, "a relaxation modulus needs at least one term")
        for share, time in terms:
            require("a share", share, 0.0 < share < 1.0, "it must be above 0 and below 1")
            valid = _SHORTEST_TIME <= time < inf
            require("a relaxation time", time, valid, f"it must be at least {_SHORTEST_TIME:g} s and finite")
        total = sum(share for share, _ in terms)
        require("the sum of the shares", total, total < 1.0, "it must be below 1, or no modulus remains at long times")
        object.__setattr__(self, "terms", terms)

    @property
    def shares(self) -> Numbers:
        """Fractions g_i of the instantaneous modulus that relax, one for each term."""
        return numpy.array([share for share, _ in self.terms])

    @property
    def times(self) -> Numbers:
        """Relaxation times τ_i in s, one for each term."""
        return numpy.array([time for _, time in self.terms])

    @property
    def long_term_share(self) -> float:
        """Fraction g∞ of the instantaneous modulus that remains after a long time."""
        return 1.0 - sum(share for share, _ in self.terms)

    def relaxation(self, time: Numbers) -> Numbers:
        """Compute the relaxation modulus g(t) over the instantaneous modulus, at times in s, 0 or more."""
        ages = numpy.asarray(time, dtype=float)[..., None]
        return self.long_term_share + numpy.sum(self.shares * numpy.exp(-ages / self.times), axis=-1)

    def mean(self, early: Numbers, late: Numbers) -> Numbers:
        """Compute the mean of the relative relaxation modulus g(t) between two times in s."""
        early_ratio, span_ratio = early[..., None] / self.times, (late - early)[..., None] / self.times
        return self.long_term_share + numpy.sum(
            self.shares * numpy.exp(-early_ratio) * -numpy.expm1(-span_ratio) / span_ratio, axis=-1
        )

    def complex_modulus(self, frequency: Numbers) -> Numbers:
        """Compute the complex modulus over the instantaneous modulus at frequencies in Hz.

        It is g∞ + Σ g_i iωτ/(1 + iωτ).
        """
        phase = 2j * numpy.pi * numpy.asarray(frequency, dtype=float)[..., None] * self.times
        return self.long_term_share + numpy.sum(self.shares * phase / (1 + phase), axis=-1)

    def creep_compliance(self, time: Numbers) -> Numbers:
        """Compute the relative creep compliance J(t), from 1 at time 0 to 1/g∞ after a long time."""
        # strains r of the dashpots: τ r' = 1 + g·r - r, made symmetric by sqrt(g τ); J = 1 + g·r
        g, tau = self.shares, self.times
        root = numpy.sqrt(g / tau)
        rates, modes = numpy.linalg.eigh(numpy.diag(1.0 / tau) - root[:, None] * root)
        weights = (modes.T @ root) ** 2 / rates
        return 1.0 / self.long_term_share - numpy.sum(
            weights * numpy.exp(-numpy.asarray(time)[..., None] * rates), axis=-1
        )


def relaxed_contact(
    contact: Elastic, relaxed_forces: tuple[Array, ...], modulus: Prony
) -> tuple[Elastic, tuple[Array, ...]]:
    """Compute the contact of a relaxing liner from the instantaneous one, and the rates of its relaxed forces in N/s.

    The relaxed forces s_i follow the instantaneous force F0 with the relaxation times of the terms::

        τ_i s_i' = E - s_i,    F = E - Σ g_i s_i,    E = max(F0, Σ g_i s_i).

    F is the hereditary integral ∫ g(t - s) dF0, until it vanishes. Then the liner recovers without the ball, as a
    detached spring of `Viscoelastic.spring_force` does. The stiffness is that at constant relaxed forces, and the
    energy that of the long-time modulus.
    """
    rows = list(zip(modulus.terms, relaxed_forces, strict=True))
    relaxed = sum((share * relaxed_force for (share, _), relaxed_force in rows), 0.0)
    detached = relaxed > contact.normal
    instantaneous = where(detached, relaxed, contact.normal)
    force, stiffness = instantaneous - relaxed, where(detached, 0.0, contact.stiffness)
    relaxing = contact._replace(
        energy=modulus.long_term_share * contact.energy,
        normal=force,
        stiffness=stiffness,
        damped_force=force,
        damped_stiffness=stiffness,
    )
    return relaxing, tuple((instantaneous - relaxed_force) / time for (_, time), relaxed_force in rows)


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """Joint with a viscoelastic liner of constant Poisson's ratio; the model gives the instantaneous force.

    Parameters
    ----------
    model : Model
        Any model with a force law.
    joint : Joint
        Joint of plain numbers, with the instantaneous Young's modulus of the liner.
    modulus : Prony
        Relative modulus of the liner over time.

    Examples
    --------
    >>> import numpy
    >>> import ballsocket as bs
    >>> from ballsocket.dynamics import Prony, Viscoelastic
    >>> liner = Viscoelastic(bs.HessForsbach(), bs.joints["hip-28"], Prony(terms=((0.3, 0.1), (0.2, 10.0))))
    >>> time = numpy.linspace(0.0, 1.0, 401)
    >>> depth = 0.05 * numpy.sin(numpy.pi * time)
    >>> force = liner.cycle_force(time, depth)
    >>> bool(force[100] > force[300] > 0)  # smaller force on unloading
    True
    """

    sources: ClassVar[tuple[Source, ...]] = (Source("lee1960"), Source("ting1966"))

    model: Model
    joint: Joint
    modulus: Prony

    @cached_property
    def potential(self) -> Potential:
        """Elastic energy of the joint with the instantaneous modulus, as a function of the indentation."""
        return potential_of(self.model, self.joint)

    def instantaneous_force(self, depth: Numbers) -> Numbers:
        """Compute the instantaneous contact force in N at an indentation in mm; 0 without contact."""
        return self.potential(numpy.maximum(numpy.asarray(depth, dtype=float), 0.0))[1]

    def relaxation_force(self, depth: float, time: Numbers) -> Numbers:
        """Compute the force in N at times in s after a sudden indentation in mm, which stays constant."""
        return self.instantaneous_force(numpy.array(depth)) * self.modulus.relaxation(time)

    def creep_indentation(self, force: float, time: Numbers) -> Numbers:
        """Compute the indentation in mm at times in s after a sudden force in N, which stays constant."""
        return self.model.press(self.joint.with_floats(), force=force * self.modulus.creep_compliance(time)).indentation

    def dynamic_stiffness(self, depth: float, frequency: Numbers) -> Numbers:
        """Compute the complex stiffness in N/mm for small vibrations in Hz about an indentation in mm."""
        return self.potential(numpy.array(depth))[2] * self.modulus.complex_modulus(frequency)

    def separable_force(self, time: Numbers, depth: Numbers) -> Numbers:
        """Compute the force in N by the separable approximation g(t) F(d(t)), only for comparison.

        The approximation is common but wrong.
        """
        time, depth = _check_history(time, depth)
        touched = numpy.argmax(depth > 0)
        return self.modulus.relaxation(numpy.maximum(time - time[touched], 0.0)) * self.instantaneous_force(depth)

    def hereditary_force(self, time: Numbers, depth: Numbers) -> Numbers:
        """Compute the force in N by the hereditary integral ∫ g(t - s) dF; the contact must not shrink."""
        time, depth = _check_history(time, depth)
        rise = numpy.diff(self.instantaneous_force(depth))
        return numpy.append(0.0, numpy.sum(self._mean_relaxation(time) * rise, axis=1))

    def cycle_force(self, time: Numbers, depth: Numbers) -> Numbers:
        """Compute the force in N of one loading and unloading, by the method of Ting.

        Parameters
        ----------
        time : array (instants,)
            Increasing times in s.
        depth : array (instants,)
            Indentation in mm, linear between instants: it rises from 0 or less to its maximum, and then falls.

        Raises
        ------
        ValueError
            Times that do not increase; a depth that rises again, for which `spring_force` is valid.
        """
        time, depth = _check_history(time, depth)
        peak_index = int(numpy.argmax(depth))
        rising_steps = numpy.flatnonzero(numpy.diff(depth)[peak_index:] > 0)
        last = peak_index + rising_steps[0] if len(rising_steps) else len(depth)
        before_rise = numpy.arange(len(depth)) <= last
        require("depth", depth, before_rise, "it must rise once and then fall; use `spring_force`")
        force = self.hereditary_force(time, depth)
        weights, positive_depth = self._mean_relaxation(time), numpy.maximum(depth, 0.0)
        for instant in range(peak_index + 1, len(time)):
            force[instant] = self._unloading_force(weights[instant - 1], positive_depth, peak_index, instant)
        return force

    def _unloading_force(self, weights: Numbers, depth: Numbers, peak_index: int, instant: int) -> float:
        """Compute the force in N at an instant of unloading from the loading up to the same edge (Ting)."""
        strain = numpy.cumsum((weights[:instant] * numpy.diff(depth)[:instant])[::-1])[::-1]
        initial = numpy.flatnonzero(strain[: peak_index + 1] <= 0)
        if len(initial) and initial[0] == 0:
            return 0.0
        last_loading_index = int(initial[0]) - 1 if len(initial) else peak_index
        next_strain = strain[last_loading_index + 1] if last_loading_index + 1 < instant else 0.0
        interpolation = strain[last_loading_index] / (strain[last_loading_index] - next_strain)
        edge_depth = depth[last_loading_index] + interpolation * (
            depth[last_loading_index + 1] - depth[last_loading_index]
        )
        forces = self.instantaneous_force(numpy.append(depth[: last_loading_index + 1], edge_depth))
        return float(numpy.sum(weights[: last_loading_index + 1] * numpy.diff(forces)))

    def _mean_relaxation(self, time: Numbers) -> Numbers:
        """Compute the mean relaxation modulus over each past interval: (instants - 1, intervals); 0 if future."""
        late, early = time[1:, None] - time[None, :-1], time[1:, None] - time[None, 1:]
        return numpy.where(early >= 0, self.modulus.mean(numpy.maximum(early, 0.0), numpy.maximum(late, 1e-300)), 0.0)

    def spring_force(self, time: Numbers, depth: Numbers, rings: int = 400) -> Numbers:
        """Compute the force in N of any indentation history, by radial springs with Maxwell elements.

        A spring whose pressure would become negative detaches and recovers, until the ball touches it again.

        Parameters
        ----------
        time, depth : array (instants,)
            Times in s and indentations in mm, linear between instants.
        rings : int
            Number of rings of springs about the pole.

        Raises
        ------
        TypeError
            A model other than radial springs with linear kinematics.
        """
        if not isinstance(self.model, RadialFoundation) or self.model.kinematics is not linear_kinematics:
            raise TypeError(f"the model must be radial springs with linear kinematics, got {self.model.name}")
        time, depth = _check_history(time, depth)
        joint = self.joint.with_floats()
        c, deepest = joint.clearance, max(float(depth.max()), 1e-300)
        width = deepest / (c + deepest) / rings
        ring_versines = width * (numpy.arange(rings) + 0.5)
        # d cos φ - c (1 - cos φ)
        spring_displacements = numpy.maximum(depth, -c)[:, None] * (1.0 - ring_versines) - c * ring_versines
        pressure = _maxwell_pressures(self.modulus, time, spring_displacements)
        factor = 2 * numpy.pi * joint.socket_radius**2 * float(self.model.modulus.evaluate(joint)) * width
        return factor * (pressure @ (1.0 - ring_versines))


def _maxwell_pressures(modulus: Prony, time: Numbers, spring_displacements: Numbers) -> Numbers:
    """Compute the pressures of Maxwell springs divided by their stiffness, in mm: (instants, springs)."""
    surface = numpy.zeros(spring_displacements.shape[1])
    stresses = numpy.zeros((len(modulus.terms), spring_displacements.shape[1]))
    pressure = numpy.zeros(spring_displacements.shape)
    shares, times, long_term_share = modulus.shares[:, None], modulus.times[:, None], modulus.long_term_share
    for instant, time_step in enumerate(numpy.diff(time), start=1):
        decay_factor, weight = numpy.exp(-time_step / times), -numpy.expm1(-time_step / times) * times / time_step
        past_pressure = numpy.sum(shares * (decay_factor * stresses - weight * surface), axis=0)
        effective_stiffness = long_term_share + float(numpy.sum(shares * weight))
        # the ball surface, or the recovering liner surface
        displaced = numpy.maximum(spring_displacements[instant], -past_pressure / effective_stiffness)
        stresses = decay_factor * stresses + weight * (displaced - surface)
        pressure[instant] = numpy.where(
            displaced == spring_displacements[instant],
            long_term_share * displaced + numpy.sum(shares * stresses, axis=0),
            0.0,
        )
        surface = displaced
    return pressure


def _check_history(time: Any, depth: Any) -> tuple[Numbers, Numbers]:
    time, depth = numpy.asarray(time, dtype=float), numpy.asarray(depth, dtype=float)
    if time.ndim != 1 or time.shape != depth.shape or len(time) < 2:
        raise ValueError(f"time and depth must be rows of equal length, at least 2, got {time.shape} and {depth.shape}")
    require("depth", depth, numpy.isfinite(depth), "an indentation (mm) must be finite")
    increasing = numpy.append(True, numpy.diff(time) > 0)
    require("time", time, increasing, "times must increase")
    require("depth", depth[:1], depth[:1] <= 0, "a history must begin without contact")
    return time, depth
