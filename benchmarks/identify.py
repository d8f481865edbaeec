"""Clearance and modulus from twenty points of a press by the tables: the best point, and 4000 samples of the posterior.

Rivals are what one would write by hand: SciPy's `curve_fit` on the same model from the middle of the ranges, and emcee
as it comes, with stretches between its walkers, for as many evaluations of the same posterior. Fair, because all ask
the same model about the same data in NumPy, in turns; best points are compared, and samples counted as independent.
"""

from __future__ import annotations

import importlib.util
from math import sqrt
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.identify import IdentificationResult, Measured
from ballsocket.identify.posterior import Posterior

from .report import Report, Rows
from .timing import Spread, Work, interleaved

POINTS, SAMPLES, REPEATS, DRAWS = 20, 4000, 7, 3
OPTIMUM, POSTERIOR = 0.2, 10.0  # s, the aims
FREE = {"clearance": (0.02, 0.3), "liner.young": (400.0, 2000.0)}
HIP = bs.joints["hess-forsbach"]


def measure() -> Report | str:
    if importlib.util.find_spec("emcee") is None:
        return "emcee is not installed"
    data = _data()
    found = bs.identify(bs.Tabulated(), HIP, data, FREE)
    _, fits = interleaved(
        REPEATS, {"ours": lambda: bs.identify(bs.Tabulated(), HIP, data, FREE), "rival": _by_hand(data)}
    )
    best = Rows(f"The best point from {POINTS} points, s", ("what", "ours", "curve_fit", "ours over it"))
    best.add(
        "clearance and modulus",
        fits["ours"],
        fits["rival"],
        f"{fits['ours'].over(fits['rival'])}; {_verdict(fits['ours'], OPTIMUM)}",
    )
    chains, drawn, plain = _chains(found)
    rows = Rows(f"{SAMPLES} samples of the posterior", ("what", "ours", "emcee as it comes", "ratio"))
    rows.add("s", chains["ours"], chains["rival"], _verdict(chains["ours"], POSTERIOR))
    rows.add(
        "independent samples, the fewest of an unknown",
        f"{_fewest(drawn):.0f}",
        f"{plain:.0f}",
        f"{_fewest(drawn) / plain:.1f} times as many",
    )
    by_hand = _by_hand(data)()
    apart = max(abs(found.point[name] / value - 1) for name, value in zip(found.point, by_hand, strict=True))
    return Report(
        [best, rows],
        [
            f"The best points agree within {apart:.1e}, relative. Ours also searches the ranges for a start, twice.",
            f"R-hat {max(drawn.r_hat.values()):.4f}; acceptance {drawn.acceptance:.2f}. One process draws all samples.",
        ],
        ("scipy", "emcee"),
    )


def _data() -> Measured:
    random = numpy.random.default_rng(2021)
    force = numpy.linspace(150.0, 3000.0, POINTS)
    depth = bs.Tabulated().press(HIP, force=force).indentation
    scattered = depth + 5e-4 * random.standard_normal(POINTS)
    return Measured(quantity="indentation", values=scattered, uncertainty=5e-4, force=force)


def _by_hand(data: Measured) -> Any:
    """What SciPy's own differences find, which ask for one joint after the other."""
    from scipy.optimize import curve_fit

    model = bs.Tabulated()

    def depth(force: Any, clearance: float, young: float) -> Any:
        joint = HIP.replace(clearance=clearance, liner=bs.Material(young=young, poisson=HIP.liner.poisson))
        return model.press(joint, force=force).indentation

    start = [sqrt(low * high) for low, high in FREE.values()]
    return lambda: curve_fit(
        depth, data.force, data.values, start, data.uncertainty, bounds=tuple(zip(*FREE.values(), strict=True))
    )[0]


def _chains(found: IdentificationResult) -> tuple[dict[str, Spread], Posterior, float]:
    """Seconds of both, our posterior, and how many independent samples the plain chains have."""
    drawn = found.posterior(SAMPLES)
    plain = _plain(found, _steps(drawn))
    _, seconds = interleaved(DRAWS, {"ours": lambda: found.posterior(SAMPLES), "rival": plain})
    chain: Any = plain()
    times = _longest(chain)
    return seconds, drawn, chain[..., 0].size / times


def _longest(chain: Any) -> float:
    """The longest autocorrelation time of an unknown."""
    from emcee.autocorr import integrated_time

    return float(max(integrated_time(chain, quiet=True)))


def _steps(drawn: Posterior) -> int:
    """Steps of 64 walkers that are as many evaluations as our chains took."""
    name = drawn.names[0]
    return int(drawn.effective[name] * drawn.autocorrelation[name] / 64)


def _plain(found: IdentificationResult, steps: int) -> Work:
    import emcee

    def run() -> Any:
        random = numpy.random.default_rng(0)
        places = found.best.theta + 0.1 * random.standard_normal((64, len(found.best.theta)))
        sampler = emcee.EnsembleSampler(64, places.shape[1], found.misfit.log_posterior, vectorize=True)
        sampler.run_mcmc(places, steps + 200)
        return sampler.get_chain(discard=200)

    return run


def _fewest(drawn: Posterior) -> float:
    return min(drawn.effective.values())


def _verdict(taken: Spread, aim: float) -> str:
    return f"aim {aim:g} s: {'met' if taken.median <= aim else 'missed'}"
