"""Posterior distribution of the unknowns by Markov chains, with their convergence."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs, require
from .fit import FittedModel

_N_WALKERS = 64
_N_ENSEMBLES = 2
_BURN_IN = 60  # steps that are discarded
_PROPOSAL_FREEDOM = 5.0  # degrees of freedom of the proposals about the best point
_MAX_ROUNDS = 64  # rounds of chains
CONVERGED = 1.01
"""Largest R-hat of converged chains."""


@dataclass(frozen=True, eq=False)
class Posterior:
    """Samples of the posterior distribution of the unknowns, with convergence measures.

    Attributes
    ----------
    names : tuple of str
    samples : array (samples, unknowns)
        Values in mm, N, MPa, rad.
    acceptance : float
        Fraction of accepted proposals.
    autocorrelation : dict of str to float
        Integrated autocorrelation time in steps, by unknown.
    effective : dict of str to float
        Effective number of independent samples, by unknown.
    r_hat : dict of str to float
        Split R-hat of independent ensembles, by unknown; 1 for converged chains.
    """

    names: tuple[str, ...]
    samples: Numbers
    acceptance: float
    autocorrelation: dict[str, float]
    effective: dict[str, float]
    r_hat: dict[str, float]

    @property
    def converged(self) -> bool:
        """True if R-hat of every unknown is at most `CONVERGED`."""
        return max(self.r_hat.values()) <= CONVERGED

    def band(self, name: str, probability: float = 0.95) -> tuple[float, float]:
        """Compute the ends of the central credible interval of an unknown for a probability."""
        column = self.samples[:, self.names.index(name)]
        low, high = numpy.quantile(column, [(1 - probability) / 2, (1 + probability) / 2])
        return float(low), float(high)

    def median(self, name: str) -> float:
        """Compute the median of the posterior samples of an unknown."""
        return float(numpy.median(self.samples[:, self.names.index(name)]))

    def summary(self) -> dict[str, Any]:
        """Return the posterior as a dictionary for JSON."""
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


def posterior(fitted: FittedModel, samples: int = 4000, seed: int = 0) -> Posterior:
    """Draw samples from the posterior distribution of the unknowns by Markov chain Monte Carlo.

    Half of the proposals are independent draws about the best point, with the covariance there. The others are moves
    between walkers, which follow a curved posterior. The chains end when the number of independent samples suffices.

    Parameters
    ----------
    fitted : IdentificationResult
    samples : int
        Number of independent samples, 100 or more.
    seed : int

    Raises
    ------
    ImportError
        emcee is not installed.
    ValueError
        Fewer than 100 samples.

    References
    ----------
    Foreman-Mackey et al. 2013, Publ. Astron. Soc. Pac. 125, 306 (emcee); Goodman & Weare 2010; Gelman et al. 2013,
    section 11.4 (R-hat).
    """
    needs("identify", "emcee")
    require("samples", samples, samples >= 100, "a posterior has 100 samples or more")
    ensembles = [_start_ensemble_sampler(fitted, seed + ensemble_index) for ensemble_index in range(_N_ENSEMBLES)]
    steps = ceil(samples / (_N_WALKERS * _N_ENSEMBLES))
    for _ in range(_MAX_ROUNDS):
        for sampler in ensembles:
            sampler.run_mcmc(None, steps, progress=False)
        chains = numpy.stack([sampler.get_chain() for sampler in ensembles])  # (ensembles, steps, walkers, unknowns)
        times = numpy.array([_autocorrelation_time(chains[..., index]) for index in range(chains.shape[-1])])
        steps = ceil(0.5 * chains.shape[1])
        if chains[..., 0].size >= samples * times.max() and chains.shape[1] > 10 * times.max():
            break
    names = fitted.transform.names
    all_samples = chains.reshape(-1, chains.shape[-1])
    selected = all_samples[numpy.linspace(0, len(all_samples) - 1, samples).round().astype(int)]
    return Posterior(
        names=names,
        samples=fitted.transform.to_values(selected),
        acceptance=float(numpy.mean([sampler.acceptance_fraction.mean() for sampler in ensembles])),
        autocorrelation=dict(zip(names, times.tolist(), strict=True)),
        effective=dict(zip(names, (len(all_samples) / times).tolist(), strict=True)),
        r_hat={name: _r_hat(chains[..., index]) for index, name in enumerate(names)},
    )


def _start_ensemble_sampler(fitted: FittedModel, seed: int) -> Any:
    """Create an ensemble sampler, run its burn-in, and adapt its proposals to the first chains."""
    from scipy.stats import multivariate_t

    random = numpy.random.RandomState(seed)
    transform = fitted.transform
    unknown_count = len(transform.names)
    initial_proposal = multivariate_t(fitted.best.theta, fitted.information.covariance, df=_PROPOSAL_FREEDOM)
    start_points = initial_proposal.rvs(_N_WALKERS, random_state=random).reshape(_N_WALKERS, unknown_count)
    uniform_start = transform.low + (transform.high - transform.low) * random.random_sample(start_points.shape)
    start_points = numpy.where(
        (start_points > transform.low) & (start_points < transform.high), start_points, uniform_start
    )
    burn_in_sampler = _make_ensemble_sampler(fitted, initial_proposal, random)
    start_points = burn_in_sampler.run_mcmc(start_points, _BURN_IN, skip_initial_state_check=True).coords
    chain = burn_in_sampler.get_chain(discard=_BURN_IN // 2, flat=True)
    covariance = numpy.cov(chain.T).reshape(2 * [unknown_count]) + 1e-12 * numpy.eye(unknown_count)
    adapted_proposal = multivariate_t(chain.mean(axis=0), covariance, df=_PROPOSAL_FREEDOM)
    adapted_sampler = _make_ensemble_sampler(fitted, adapted_proposal, random)
    state = adapted_sampler.run_mcmc(start_points, _BURN_IN // 2, skip_initial_state_check=True)
    adapted_sampler.reset()
    adapted_sampler.run_mcmc(state, 1, skip_initial_state_check=True)
    return adapted_sampler


def _make_ensemble_sampler(fitted: FittedModel, proposal: Any, random: Any) -> Any:
    """Create a sampler whose proposals are half draws from a distribution, and half moves between walkers."""
    from emcee import EnsembleSampler
    from emcee.moves import DEMove, MHMove, StretchMove

    def draw(theta: Numbers, random: Any) -> tuple[Numbers, Numbers]:
        """Propose a new point for each walker; also return the logarithm of the density ratio."""
        new_theta = proposal.rvs(len(theta), random_state=random).reshape(theta.shape)
        return new_theta, proposal.logpdf(theta) - proposal.logpdf(new_theta)

    moves = [(MHMove(draw), 0.5), (DEMove(), 0.35), (StretchMove(), 0.15)]
    sampler = EnsembleSampler(
        _N_WALKERS, len(fitted.transform.names), fitted.misfit.log_posterior, moves=moves, vectorize=True
    )
    sampler.random_state = random.get_state()
    return sampler


def _autocorrelation_time(chains: Numbers) -> float:
    """Compute the autocorrelation time in steps of chains (ensembles, steps, walkers), with Sokal's window."""
    steps = chains.shape[1]
    deviations = chains - chains.mean()
    power = abs(numpy.fft.rfft(deviations, 2 * steps, axis=1)) ** 2
    correlation = numpy.fft.irfft(power, axis=1)[:, :steps].mean(axis=(0, 2))
    correlation = correlation / (steps - numpy.arange(steps))
    times = 2 * numpy.cumsum(correlation / correlation[0]) - 1
    window = numpy.arange(steps) >= 5 * times
    return float(max(times[window.argmax() if window.any() else steps - 1], 1.0))


def _r_hat(chains: Numbers) -> float:
    """Compute the convergence measure R-hat of chains (ensembles, steps, walkers), each split into halves."""
    steps = chains.shape[1] // 2
    halves = numpy.concatenate([chains[:, :steps], chains[:, -steps:]]).reshape(2 * len(chains), -1)
    half_length = halves.shape[1]
    variance_within, variance_between = halves.var(axis=1, ddof=1).mean(), half_length * halves.mean(axis=1).var(ddof=1)
    return float((((half_length - 1) * variance_within + variance_between) / (half_length * variance_within)) ** 0.5)
