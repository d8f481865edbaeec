"""Which number matters: Sobol indices over distributions, and elasticities at their middle."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..problem import Joint
from .distributions import Distribution
from .labels import described
from .parameters import PARAMETERS, contradiction
from .room import check_samples
from .slopes import elasticities, pressed
from .sobol import sobol
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
    distributions : mapping of str to Rectangular, Normal or LogNormal
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
        A name that is not known, a count that is no power of two or needs more memory than there is, samples that have
        no answer, an answer that does not change.
    """
    needs("study", "xarray")
    import xarray

    wanted, fixed = tuple(quantities), dict(load or {})
    _check(distributions, wanted, fixed)
    require("count", count, count >= 2 and count & (count - 1) == 0, "a power of two of samples")
    check_samples(count)
    answers = _Answers(model, joint, tuple(distributions), wanted, fixed)
    shares = sobol(answers, list(distributions.values()), count, seed, confidence)
    middle = {name: float(one.frozen.median()) for name, one in distributions.items()}
    local = elasticities(model, joint, wanted, {**middle, **fixed})
    samples = numpy.concatenate(answers.seen[:2], axis=1)
    both = ("quantity", "parameter")
    return xarray.Dataset(
        {
            **{name: (both, values) for name, values in shares.items()},
            "elasticity": (both, [[local[quantity][name] for name in distributions] for quantity in wanted]),
            "mean": ("quantity", samples.mean(axis=1)),
            "deviation": ("quantity", samples.std(axis=1)),
            "units": ("quantity", [described(name)["units"] for name in wanted]),
        },
        coords={"quantity": list(wanted), "parameter": list(distributions)},
        attrs={"model": model.name, "samples": count, "confidence": confidence},
    )


def _check(distributions: Mapping[str, Distribution], wanted: Iterable[str], fixed: Mapping[str, float]) -> None:
    check_names(distributions, PARAMETERS, "among what scatters")
    check_names(wanted, QUANTITIES, "among the quantities")
    if not distributions:
        raise ValueError("at least one number must scatter")
    contradiction({**distributions, **fixed})
    for name in fixed:
        if name in distributions:
            raise ValueError(f"{name} scatters and is given as a load too; one is needed")


@dataclass
class _Answers:
    """Answers (quantities, points) to samples (numbers, points); those that it has `seen` first are the plain ones."""

    model: Model
    joint: Joint
    names: tuple[str, ...]
    wanted: tuple[str, ...]
    fixed: Mapping[str, float]
    seen: list[Numbers] = field(default_factory=list)

    def __call__(self, values: Numbers) -> Numbers:
        scattered = dict(zip(self.names, values, strict=True))
        found = pressed(self.model, self.joint, {**scattered, **self.fixed}, self.wanted)
        table = numpy.stack([numpy.broadcast_to(found[name], values.shape[1:]) for name in self.wanted])
        bad = int((~numpy.isfinite(table)).any(axis=0).sum())
        if bad:
            many = f"{bad} of {values.shape[1]} samples"
            raise ValueError(f"{self.model.name} has no answer for {many}: narrow what scatters")
        if not self.seen:
            self._check_changes(table)
        self.seen.append(table.copy())  # SciPy centres its own in place
        return table

    def _check_changes(self, table: Numbers) -> None:
        for name, row in zip(self.wanted, table, strict=True):
            if numpy.ptp(row) == 0:
                raise ValueError(
                    f"{name} does not change with {' and '.join(self.names)}: there is nothing to share out"
                )
