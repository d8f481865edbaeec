"""Sensitivity of contact quantities to scattered parameters: Sobol indices, and elasticities at the medians."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from warnings import catch_warnings

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..core.deprecation import renamed_names
from ..core.executors.processes import check_memory
from ..problem import Joint
from .derivatives import elasticities, press_quantities
from .distributions import Distribution
from .metadata import variable_attributes
from .parameters import PARAMETERS, check_contradictions
from .task import QUANTITIES

if TYPE_CHECKING:
    import xarray

__getattr__ = renamed_names(__name__, {"sobol": "sobol_indices"})

SampledFunction = Callable[[Numbers], Numbers]
"""Function from samples, shape (n_parameters, n_points), to quantities, shape (n_quantities, n_points)."""


def sensitivity(
    model: Model,
    joint: Joint,
    distributions: Mapping[str, Distribution],
    *,
    quantities: Iterable[str] = ("indentation", "half_angle", "max_pressure", "area"),
    count: int = 1024,
    seed: int = 0,
    confidence: float = 0.95,
    load: Mapping[str, float] | None = None,
) -> xarray.Dataset:
    """Compute the contributions of scattered parameters to the variance of contact quantities.

    Parameters
    ----------
    model : Model
    joint : Joint
        Values of the parameters that are not in `distributions`.
    distributions : mapping of str to Rectangular, Normal or LogNormal
        Independent distributions, by parameter.
    quantities : iterable of str
        Quantities of a contact.
    count : int
        Number of samples in each of `len(distributions) + 2` sets; a power of two.
    seed : int
        The same seed gives the same indices and intervals.
    confidence : float
        Confidence level of the bootstrap intervals, between 0 and 1.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad), unless the load has a distribution.

    Returns
    -------
    xarray.Dataset
        Along `quantity` and `parameter`: `first_order` (share of the variance from this parameter alone),
        `total_order` (with its interactions), the ends `_low` and `_high` of their intervals, and `elasticity` (percent
        for one percent, at the medians). Along `quantity`: `mean` and `deviation`.

    Raises
    ------
    ValueError
        An unknown name, a count that is not a power of two or needs too much memory, samples without a result, a
        quantity that does not change.
    """
    needs("study", "xarray")
    import xarray

    names, fixed = tuple(quantities), dict(load or {})
    _check_arguments(distributions, names, fixed)
    require("count", count, count >= 2 and count & (count - 1) == 0, "a power of two of samples")
    check_sample_memory(count)
    evaluate = _SampleEvaluation(model, joint, tuple(distributions), names, fixed)
    indices = sobol_indices(evaluate, list(distributions.values()), count, seed, confidence)
    medians = {name: float(distribution.frozen.median()) for name, distribution in distributions.items()}
    local = elasticities(model, joint, names, {**medians, **fixed})
    samples = numpy.concatenate(evaluate.tables[:2], axis=1)
    both = ("quantity", "parameter")
    return xarray.Dataset(
        {
            **{name: (both, values) for name, values in indices.items()},
            "elasticity": (both, [[local[quantity][name] for name in distributions] for quantity in names]),
            "mean": ("quantity", samples.mean(axis=1)),
            "deviation": ("quantity", samples.std(axis=1)),
            "units": ("quantity", [variable_attributes(name)["units"] for name in names]),
        },
        coords={"quantity": list(names), "parameter": list(distributions)},
        attrs={"model": model.name, "samples": count, "confidence": confidence},
    )


def _check_arguments(
    distributions: Mapping[str, Distribution], quantities: Iterable[str], fixed: Mapping[str, float]
) -> None:
    """Raise ValueError for unknown names, and for parameters that contradict each other."""
    check_names(distributions, PARAMETERS, "among what scatters")
    check_names(quantities, QUANTITIES, "among the quantities")
    if not distributions:
        raise ValueError("at least one number must scatter")
    check_contradictions({**distributions, **fixed})
    for name in fixed:
        if name in distributions:
            raise ValueError(f"{name} scatters and is given as a load too; one is needed")


@dataclass
class _SampleEvaluation:
    """Function from samples to quantities; the first two evaluated `tables` are those of independent samples."""

    model: Model
    joint: Joint
    names: tuple[str, ...]
    quantities: tuple[str, ...]
    fixed: Mapping[str, float]
    tables: list[Numbers] = field(default_factory=list)

    def __call__(self, values: Numbers) -> Numbers:
        """Compute the quantities, shape (n_quantities, n_points), of samples, shape (n_parameters, n_points)."""
        scattered = dict(zip(self.names, values, strict=True))
        results = press_quantities(self.model, self.joint, {**scattered, **self.fixed}, self.quantities)
        table = numpy.stack([numpy.broadcast_to(results[name], values.shape[1:]) for name in self.quantities])
        n_bad = int((~numpy.isfinite(table)).any(axis=0).sum())
        if n_bad:
            samples = f"{n_bad} of {values.shape[1]} samples"
            raise ValueError(f"{self.model.name} has no answer for {samples}: narrow the distributions")
        if not self.tables:
            self._check_changes(table)
        self.tables.append(table.copy())  # SciPy centres its copy in place
        return table

    def _check_changes(self, table: Numbers) -> None:
        """Raise ValueError for a quantity that is the same for all samples."""
        for name, row in zip(self.quantities, table, strict=True):
            if numpy.ptp(row) == 0:
                raise ValueError(f"{name} does not change with {' and '.join(self.names)}: its variance is zero")


def check_sample_memory(count: int) -> None:
    """Check that the intervals of the indices of `count` samples fit into the memory; raise ValueError otherwise."""
    check_memory(f"intervals of {count} samples", 40_000 * count + 25 * count**2)  # measured; SciPy's jackknife


def sobol_indices(
    evaluate: SampledFunction, distributions: Sequence[Distribution], count: int, seed: int, confidence: float
) -> dict[str, Numbers]:
    """Compute Sobol indices of first and total order, and the ends of their bootstrap intervals.

    Returns
    -------
    dict of str to array of shape (n_quantities, n_parameters)
        `first_order`, `total_order`, and both with `_low` and `_high`. NaN if there are too few samples.

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259; `scipy.stats.sobol_indices`.
    """
    from scipy import stats

    frozen = [distribution.frozen for distribution in distributions]
    with _seeded(seed), numpy.errstate(all="ignore"), catch_warnings(action="ignore"):  # too few samples: NaN
        rng = numpy.random.default_rng(seed)
        indices = stats.sobol_indices(func=evaluate, n=count, dists=frozen, rng=rng)
        interval = indices.bootstrap(confidence_level=confidence)
    arrays: dict[str, Numbers] = {}
    for order in ("first_order", "total_order"):
        ends = getattr(interval, order).confidence_interval
        arrays |= {order: getattr(indices, order), f"{order}_low": ends.low, f"{order}_high": ends.high}
    return {name: numpy.reshape(values, (-1, len(frozen))) for name, values in arrays.items()}


@contextmanager
def _seeded(seed: int) -> Iterator[None]:
    """Seed NumPy's global random numbers, from which SciPy's bootstrap draws, and restore them at the end."""
    state = numpy.random.get_state()  # noqa: NPY002
    numpy.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        numpy.random.set_state(state)  # noqa: NPY002
