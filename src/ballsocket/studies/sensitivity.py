"""Which number matters: Sobol indices over distributions, and elasticities at their middle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers
from ..checks import check_names, needs, require
from ..joint import Joint
from ..model import Model
from .distributions import Distribution
from .labels import described
from .parameters import PARAMETERS, contradiction
from .slopes import elasticities, pressed
from .task import QUANTITIES

if TYPE_CHECKING:
    import xarray


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
    """How much of each answer's scatter comes from each number that scatters.

    Parameters
    ----------
    model, joint
        What is pressed; numbers that are not in `distributions` stay.
    distributions : mapping of str to Rectangular or Normal
        Independent of each other.
    quantities : iterable of str
    count : int
        Samples of each of `len(distributions) + 2` sets; a power of two.
    seed : int
        The same seed gives the same indices and intervals.
    confidence : float
        Of the bootstrap intervals, between 0 and 1.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad), unless it scatters itself.

    Returns
    -------
    xarray.Dataset
        Along `quantity` and `parameter`: `first_order` (the share of the variance that this number alone makes),
        `total_order` (with all that it does together with others), each with `_low` and `_high` ends of its interval,
        and `elasticity`, percent by percent where every number is at its median. Along `quantity` also `mean` and
        `deviation`.

    Raises
    ------
    ValueError
        A name that is not known, a count that is no power of two, samples that have no answer, an answer that does not
        change.

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259; `scipy.stats.sobol_indices`.
    """
    needs("study", "xarray")
    import xarray
    from scipy.stats import sobol_indices

    check_names(distributions, PARAMETERS, "among what scatters")
    wanted, fixed = tuple(quantities), dict(load or {})
    check_names(wanted, QUANTITIES, "among the quantities")
    if not distributions:
        raise ValueError("at least one number must scatter")
    contradiction({**distributions, **fixed})
    for name in fixed:
        if name in distributions:
            raise ValueError(f"{name} scatters and is given as a load too; one is needed")
    require("count", count, count >= 2 and count & (count - 1) == 0, "a power of two of samples")
    seen: list[Numbers] = []

    def answers(values: Numbers) -> Numbers:
        found = pressed(model, joint, {**dict(zip(distributions, values, strict=True)), **fixed}, wanted)
        table = numpy.stack([numpy.broadcast_to(found[name], values.shape[1:]) for name in wanted])
        if not numpy.isfinite(table).all():
            bad = int((~numpy.isfinite(table)).any(axis=0).sum())
            raise ValueError(f"{model.name} has no answer for {bad} of {values.shape[1]} samples: narrow what scatters")
        same = [name for name, row in zip(wanted, table, strict=True) if not seen and numpy.ptp(row) == 0]
        if same:
            raise ValueError(
                f"{same[0]} does not change with {' and '.join(distributions)}: there is nothing to share out"
            )
        seen.append(table.copy())  # SciPy centres its own in place
        return table

    indices = sobol_indices(
        func=answers, n=count, dists=[one.frozen for one in distributions.values()], rng=numpy.random.default_rng(seed)
    )
    with _seeded(seed):
        interval = indices.bootstrap(confidence_level=confidence)
    dims = ("quantity", "parameter")
    shape = (len(wanted), len(distributions))
    numbers: dict[str, tuple[Any, Any]] = {
        f"{order}_order{end}": (dims, numpy.reshape(values, shape))
        for order, found, ends in (
            ("first", indices.first_order, interval.first_order.confidence_interval),
            ("total", indices.total_order, interval.total_order.confidence_interval),
        )
        for end, values in (("", found), ("_low", ends.low), ("_high", ends.high))
    }
    middle = {name: float(one.frozen.median()) for name, one in distributions.items()}
    local = elasticities(model, joint, wanted, {**middle, **fixed})
    numbers["elasticity"] = (dims, [[local[quantity][name] for name in distributions] for quantity in wanted])
    samples = numpy.concatenate(seen[:2], axis=1)
    return xarray.Dataset(
        {
            **numbers,
            "mean": ("quantity", samples.mean(axis=1)),
            "deviation": ("quantity", samples.std(axis=1)),
            "units": ("quantity", [described(name)["units"] for name in wanted]),
        },
        coords={"quantity": list(wanted), "parameter": list(distributions)},
        attrs={"model": model.name, "samples": count, "confidence": confidence},
    )


@contextmanager
def _seeded(seed: int) -> Iterator[None]:
    """SciPy's bootstrap of these indices draws from NumPy's global stream: seeded here, and left as it was."""
    state = numpy.random.get_state()  # noqa: NPY002
    numpy.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        numpy.random.set_state(state)  # noqa: NPY002
