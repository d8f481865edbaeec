"""Clearance and modulus from twenty points: the best point beside `curve_fit`, samples of the posterior beside emcee.

SciPy's `curve_fit` starts on the same model from the middle of the ranges; ours also searches the ranges for a start,
twice. emcee runs as it comes, for as many evaluations of the same posterior; samples are counted as independent ones.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.identification import IdentificationResult, Measured
from ballsocket.identification.posterior import Posterior

from .report import Pair, Row, compare, digits, if_installed, with_version
from .timing import Job

POINTS, SAMPLES, WALKERS = 20, 4000, 64
FREE = {"clearance": (0.02, 0.3), "liner.young": (400.0, 2000.0)}
HIP = bs.joints["hess-forsbach"]


def measure() -> list[Row]:
    data = _data()
    result = bs.identify(bs.Tabulated(), HIP, data, FREE)
    ours = Job(lambda: bs.identify(bs.Tabulated(), HIP, data, FREE))
    rows = compare([Pair("the best point", ours, f"{with_version('scipy')} curve_fit", Job(lambda: _by_hand(data)))])
    work = f"{SAMPLES} samples of the posterior"
    rival = with_version("emcee")
    drawn = result.posterior(SAMPLES)
    theirs = if_installed("emcee", lambda: Job(lambda: _emcee(result, _steps(drawn))))
    rows += compare([Pair(work, Job(lambda: result.posterior(SAMPLES)), rival, theirs)], repeats=2)
    if isinstance(theirs, str):
        return rows
    independent, its = min(drawn.effective.values()), _independent(_emcee(result, _steps(drawn)))
    ratio = f"{digits(independent / its)} times as many"
    return [*rows, Row("independent ones of these", f"{independent:.0f}", f"{rival}: {its:.0f}", ratio)]


def _data() -> Measured:
    random = numpy.random.default_rng(2021)
    force = numpy.linspace(150.0, 3000.0, POINTS)
    depth = bs.Tabulated().press(HIP, force=force).indentation
    scattered = depth + 5e-4 * random.standard_normal(POINTS)
    return Measured(quantity="indentation", values=scattered, uncertainty=5e-4, force=force)


def _by_hand(data: Measured) -> Any:
    from scipy.optimize import curve_fit

    model = bs.Tabulated()

    def depth(force: Any, clearance: float, young: float) -> Any:
        joint = HIP.replace(clearance=clearance, liner=bs.Material(young=young, poisson=HIP.liner.poisson))
        return model.press(joint, force=force).indentation

    start = [sqrt(low * high) for low, high in FREE.values()]
    bounds = tuple(zip(*FREE.values(), strict=True))
    return curve_fit(depth, data.force, data.values, start, data.uncertainty, bounds=bounds)[0]


def _steps(drawn: Posterior) -> int:
    """Steps of the walkers that are as many evaluations as our chains took."""
    name = drawn.names[0]
    return int(drawn.effective[name] * drawn.autocorrelation[name] / WALKERS)


def _emcee(result: IdentificationResult, steps: int) -> Any:
    import emcee

    random = numpy.random.default_rng(0)
    places = result.best.theta + 0.1 * random.standard_normal((WALKERS, len(result.best.theta)))
    sampler = emcee.EnsembleSampler(WALKERS, places.shape[1], result.misfit.log_posterior, vectorize=True)
    sampler.run_mcmc(places, steps + 200)
    return sampler.get_chain(discard=200)


def _independent(chain: Any) -> float:
    from emcee.autocorr import integrated_time

    return float(chain[..., 0].size / max(integrated_time(chain, quiet=True)))
