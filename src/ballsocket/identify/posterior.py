"""The distribution of what is sought, by Markov chains, and whether they have converged."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs, require

if TYPE_CHECKING:
    from .parameters import Identified

_WALKERS = 64
_ENSEMBLES = 2
_BURN = 60  # steps that are not kept
_DEGREES = 5.0  # of freedom, of the proposals about the best point
_MOST = 64  # rounds of chains
CONVERGED = 1.01
"""R-hat up to which chains have converged."""


@dataclass(frozen=True, eq=False)
class Posterior:
    """Samples of the unknowns, and how far they can be trusted.

    Attributes
    ----------
    names : tuple of str
    samples : array (samples, unknowns)
        In mm, N, MPa, rad.
    acceptance : float
        Share of the proposals that were taken.
    autocorrelation : dict of str to float
        Steps after which a chain has forgotten where it was (integrated autocorrelation time).
    effective : dict of str to float
        As many independent samples tell as much.
    r_hat : dict of str to float
        Of independent ensembles, each cut in halves; 1 where all of them say the same.
    """

    names: tuple[str, ...]
    samples: Numbers
    acceptance: float
    autocorrelation: dict[str, float]
    effective: dict[str, float]
    r_hat: dict[str, float]

    @property
    def converged(self) -> bool:
        return max(self.r_hat.values()) <= CONVERGED

    def band(self, name: str, share: float = 0.95) -> tuple[float, float]:
        """Ends between which an unknown lies with that probability, as much beyond the one as beyond the other."""
        column = self.samples[:, self.names.index(name)]
        low, high = numpy.quantile(column, [(1 - share) / 2, (1 + share) / 2])
        return float(low), float(high)

    def median(self, name: str) -> float:
        return float(numpy.median(self.samples[:, self.names.index(name)]))

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "samples": len(self.samples),
            "acceptance": self.acceptance,
            "autocorrelation": self.autocorrelation,
            "effective": self.effective,
            "r_hat": self.r_hat,
            "converged": self.converged,
            "estimates": [
                {"name": name, "median": self.median(name), **dict(zip(("low", "high"), self.band(name), strict=True))}
                for name in self.names
            ],
        }


def posterior(found: Identified, samples: int = 4000, seed: int = 0) -> Posterior:
    """Samples of the unknowns by two ensembles of Markov chains, until as many are independent as are asked for.

    Half of the proposals are drawn about the best point, as wide as the information there says; the others are
    stretches between walkers, which find their way where the posterior is bent.

    Parameters
    ----------
    found : Identified
    samples : int
        How many, 100 or more.
    seed : int

    Raises
    ------
    ImportError
        emcee is not installed.

    References
    ----------
    Foreman-Mackey et al. 2013, Publ. Astron. Soc. Pac. 125, 306 (emcee); Goodman & Weare 2010; Gelman et al. 2013,
    section 11.4 (R-hat).
    """
    needs("identify", "emcee")
    require("samples", samples, samples >= 100, "a posterior has 100 samples or more")
    ensembles = [_ensemble(found, seed + number) for number in range(_ENSEMBLES)]
    steps = ceil(samples / (_WALKERS * _ENSEMBLES))
    for _ in range(_MOST):
        for each in ensembles:
            each.run_mcmc(None, steps, progress=False)
        chains = numpy.stack([each.get_chain() for each in ensembles])  # (ensembles, steps, walkers, unknowns)
        times = numpy.array([_time(chains[..., place]) for place in range(chains.shape[-1])])
        steps = ceil(0.5 * chains.shape[1])
        if chains[..., 0].size >= samples * times.max() and chains.shape[1] > 10 * times.max():
            break
    return _posterior(found, ensembles, chains, times, samples)


def _posterior(found: Identified, ensembles: list[Any], chains: Numbers, times: Numbers, samples: int) -> Posterior:
    names = found.scales.names
    flat = chains.reshape(-1, chains.shape[-1])
    kept = flat[numpy.linspace(0, len(flat) - 1, samples).round().astype(int)]
    return Posterior(
        names=names,
        samples=found.scales.values(kept),
        acceptance=float(numpy.mean([each.acceptance_fraction.mean() for each in ensembles])),
        autocorrelation=dict(zip(names, times.tolist(), strict=True)),
        effective=dict(zip(names, (len(flat) / times).tolist(), strict=True)),
        r_hat={name: _r_hat(chains[..., place]) for place, name in enumerate(names)},
    )


def _ensemble(found: Identified, seed: int) -> Any:
    """Walkers that have forgotten where they began, with proposals from where they went."""
    random = numpy.random.RandomState(seed)
    guess = _About(found.best.places, numpy.linalg.cholesky(found.information.covariance))
    start = guess.draw(_WALKERS, random)
    scales = found.scales
    anywhere = scales.low + (scales.high - scales.low) * random.random_sample(start.shape)
    start = numpy.where((start > scales.low) & (start < scales.high), start, anywhere)
    first = _sampler(found, guess, random)
    start = first.run_mcmc(start, _BURN, skip_initial_state_check=True).coords
    walked = first.get_chain(discard=_BURN // 2, flat=True)
    spread = numpy.cov(walked.T).reshape(2 * [len(scales.names)]) + 1e-12 * numpy.eye(len(scales.names))
    second = _sampler(found, _About(walked.mean(axis=0), numpy.linalg.cholesky(spread)), random)
    state = second.run_mcmc(start, _BURN // 2, skip_initial_state_check=True)
    second.reset()
    second.run_mcmc(state, 1, skip_initial_state_check=True)
    return second


def _sampler(found: Identified, about: _About, random: Any) -> Any:
    from emcee import EnsembleSampler
    from emcee.moves import DEMove, MHMove, StretchMove

    moves = [(MHMove(about), 0.5), (DEMove(), 0.35), (StretchMove(), 0.15)]
    sampler = EnsembleSampler(_WALKERS, len(about.centre), found.misfit.log_posterior, moves=moves, vectorize=True)
    sampler.random_state = random.get_state()
    return sampler


@dataclass(frozen=True, eq=False)
class _About:
    """Proposals that do not ask where a walker is: Student's t about a centre."""

    centre: Numbers
    root: Numbers

    def draw(self, count: int, random: Any) -> Numbers:
        size = len(self.centre)
        wide = numpy.sqrt(_DEGREES / random.chisquare(_DEGREES, (count, 1)))
        return self.centre + wide * random.standard_normal((count, size)) @ self.root.T

    def density(self, places: Numbers) -> Numbers:
        """ln of it, but for a constant."""
        apart = numpy.linalg.solve(self.root, (places - self.centre).T)
        return -(_DEGREES + len(self.centre)) / 2 * numpy.log1p(numpy.sum(apart**2, axis=0) / _DEGREES)

    def __call__(self, places: Numbers, random: Any) -> tuple[Numbers, Numbers]:
        new = self.draw(len(places), random)
        return new, self.density(places) - self.density(new)


def _time(chains: Numbers) -> float:
    """Integrated autocorrelation time in steps, of (ensembles, steps, walkers), over Sokal's window."""
    steps = chains.shape[1]
    apart = chains - chains.mean()
    power = abs(numpy.fft.rfft(apart, 2 * steps, axis=1)) ** 2
    shape = numpy.fft.irfft(power, axis=1)[:, :steps].mean(axis=(0, 2))
    shape = shape / (steps - numpy.arange(steps))
    times = 2 * numpy.cumsum(shape / shape[0]) - 1
    window = numpy.arange(steps) >= 5 * times
    return float(max(times[window.argmax() if window.any() else steps - 1], 1.0))


def _r_hat(chains: Numbers) -> float:
    """Split R-hat: ensembles cut in halves against each other."""
    steps = chains.shape[1] // 2
    halves = numpy.concatenate([chains[:, :steps], chains[:, -steps:]]).reshape(2 * len(chains), -1)
    count = halves.shape[1]
    within, between = halves.var(axis=1, ddof=1).mean(), count * halves.mean(axis=1).var(ddof=1)
    return float((((count - 1) * within + between) / (count * within)) ** 0.5)
