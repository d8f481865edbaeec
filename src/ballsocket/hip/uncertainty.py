"""How sure a prediction is: bands over patients who differ, and which of the differences matter."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.executors.local import Engine, Serial
from ..elasticity.off_axis.surfaces import Springs
from ..studies.room import check_samples
from ..studies.sobol import sobol
from .coefficient_response import COEFFICIENT, CONVERTED, SharedCoefficient, share_coefficient
from .contact_checks import list_notes
from .history import History, Report
from .lives import Kept, Listener, Lived, Lives, drawn, joined, summary_of
from .patients import ANSWERS, Patient, Scatter, answers_of
from .wear_law import coefficient_field

LEVEL = 0.95
COUNT = 64
"""Samples of each of as many sets as numbers scatter, and two."""

SHARED = ("volume", "depth", "penetration")
"""Whose scatter is shared out among what scatters."""

_HERE = Serial()


def _nothing(done: int) -> None:
    pass


@dataclass(frozen=True, kw_only=True, eq=False)
class Bands:
    """What many patients' hips come to.

    Attributes
    ----------
    scatter : Scatter
    counts : tuple of float
        Cycles of the usual patient at which was looked.
    lived : Lived
    seed : int
    level : float
        Share of the predictions within a band, and of the patients within a band for one coefficient.
    shared : SharedCoefficient, optional
        Results of the patients for a shared wear coefficient; None without a sampled coefficient and another quantity.
    indices : mapping of str to array (answers of `SHARED`, what scatters), optional
        Sobol's: `first_order`, `total_order`, and the ends of their intervals, `_low` and `_high`.
    off : mapping of str to float
        How far the usual patient's quick run is from the full one, relative to it.
    """

    scatter: Scatter
    counts: tuple[float, ...]
    lived: Lived
    seed: int = 0
    level: float = LEVEL
    indices: Mapping[str, Numbers] | None = None
    off: Mapping[str, float] = field(default_factory=dict)
    shared: SharedCoefficient | None = None

    @property
    def subject(self) -> str:
        """Noun for the members of a band: "predictions" for an unknown wear coefficient, else "patients"."""
        return "predictions" if COEFFICIENT in self.scatter.distributions else "patients"

    @property
    def patients(self) -> int:
        return len(self.lived.refused)

    @property
    def without(self) -> int:
        """Patients without an answer."""
        return int((self.lived.refused != "").sum())

    def quantile(self, name: str, share: float) -> Numbers:
        """The number of `ANSWERS` below which this share of the patients is, at each look."""
        if self.without == self.patients:
            return numpy.full(len(self.counts), numpy.nan)
        return numpy.nanquantile(self.lived.table[:, :, list(ANSWERS).index(name)], share, axis=0)

    def band(self, name: str) -> tuple[Numbers, Numbers]:
        """The ends of the band of a number of `ANSWERS` at each look, over patients and coefficient together."""
        rest = (1 - self.level) / 2
        return self.quantile(name, rest), self.quantile(name, 1 - rest)

    def population_band(self, name: str, coefficient: str = "median") -> tuple[Numbers, Numbers]:
        """Compute the ends of the band of the patients at each report, for one shared wear coefficient.

        Parameters
        ----------
        name : str
            "volume", "depth" or "penetration".
        coefficient : str
            "low", "median" or "high": the ends and the middle of the band of the coefficient.

        Raises
        ------
        ValueError
            An unknown name or coefficient, or bands without a shared coefficient.
        """
        if self.shared is None:
            raise ValueError("a band for one coefficient needs [uncertainty] with coefficient and another quantity")
        if coefficient not in self.shared.values:
            raise ValueError(f"coefficient = {coefficient!r} is not allowed: {', '.join(self.shared.values)}")
        if name not in CONVERTED:
            raise ValueError(f"{name!r} has no band for one coefficient: {', '.join(CONVERTED)}")
        rest = (1 - self.level) / 2
        low, high = (self.shared.quantile(coefficient, name, share) for share in (rest, 1 - rest))
        return low, high

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of it."""
        assumed = f"what scatters, and how, is as given: {', '.join(self.scatter.distributions)}, independently"
        elastic = () if isinstance(self.scatter.use.surface, Springs) else (_SPRINGS,)
        return (assumed, *self._coefficient, *elastic, *self._refusals, *self._through, *self._outside)

    @property
    def usual_notes(self) -> tuple[str, ...]:
        """Notes of the usual patient's run: contact model in the first cycle, cycle, cup and laws."""
        checks = [("usual patient, in the first cycle", self.scatter.quick.unworn_checks)]
        return (*list_notes(checks), *self.scatter.use.notes)

    @property
    def _coefficient(self) -> tuple[str, ...]:
        """Note on the wear coefficient that all patients share."""
        if COEFFICIENT not in self.scatter.distributions:
            return ()
        rest = (1 - self.level) / 2
        low, high = self.scatter.distributions[COEFFICIENT].frozen.ppf([rest, 1 - rest])
        coefficient = coefficient_field(self.scatter.use.wear)
        unit = "" if coefficient is None else coefficient.unit.text
        band = f"{100 * self.level:g} % between {low:.3g} and {high:.3g} {unit}".rstrip()
        return (f"the wear coefficient is unknown, but the same for all patients: {band}",)

    @property
    def _refusals(self) -> tuple[str, ...]:
        if not self.without:
            return ()
        why = Counter(str(each).split(":")[0] for each in self.lived.refused if each).most_common(1)[0][0]
        told = f"{self.without} of {self.patients} patients have no answer, most often: {why}"
        return (f"{told}; bands are of the others",)

    @property
    def _through(self) -> tuple[str, ...]:
        depth, liner = self.lived.table[:, -1, list(ANSWERS).index("depth")], self.scatter.use.joint.liner_thickness
        through = int((depth > liner).sum())
        return (f"{through} of {self.patients} patients wear their liner through",) if through else ()

    @property
    def _outside(self) -> tuple[str, ...]:
        """Note on patients whose contact leaves the validity of its model."""
        outside = int((self.lived.valid[:, -1] == 0).sum())
        model = self.scatter.quick.contact_model.name
        sentence = (
            f"{outside} of {self.patients} patients have contacts outside the validity of the contact model ({model})"
        )
        return (sentence,) if outside else ()

    @property
    def peak_utilisation(self) -> Numbers:
        """Largest utilisation of each patient from the first cycle to each report: (patients, looks)."""
        return self.lived.peak_utilisation

    def valid_share(self, look: int) -> float:
        """Compute the share of patients with valid contacts from the first cycle to a report."""
        valid = self.lived.valid[self.lived.refused == "", look]
        return float(valid.mean()) if len(valid) else numpy.nan

    @property
    def valid(self) -> bool:
        """True if every patient with an answer has valid contacts from the first cycle to each report."""
        valid = self.lived.valid[self.lived.refused == ""]
        return bool(valid.size and (valid == 1).all())

    def utilisation_quantile(self, share: float) -> Numbers:
        """Compute the quantile of the largest utilisation so far at each report; NaN where unknown."""
        known = self.peak_utilisation[~numpy.isnan(self.peak_utilisation).any(axis=1)]
        return numpy.quantile(known, share, axis=0) if len(known) else numpy.full(len(self.counts), numpy.nan)

    def summary(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "bands": [self._at(look) for look in range(len(self.counts))],
            "sobol": self._shares(),
            "uncertainty": {
                "patients": self.patients,
                "without_answer": self.without,
                "seed": self.seed,
                "level": self.level,
                "scatter": summary_of(self.scatter),
                "coefficient": None if self.shared is None else dict(self.shared.values),
                "quick_run_off": dict(self.off),
            },
        }

    def edge_loading(self, look: int) -> float:
        """The share of the patients whose contact reaches the rim in some instant then."""
        least = self.lived.table[self.lived.refused == "", look, list(ANSWERS).index("edge_distance")]
        return float((least <= 0).mean()) if len(least) else numpy.nan

    def _at(self, look: int) -> dict[str, Any]:
        year = self.scatter.cycles_per_year
        ends = {name: (*self.band(name), self.quantile(name, 0.5)) for name in ANSWERS}
        found: dict[str, dict[str, Any]] = {
            name: {"low": _plain(low[look]), "median": _plain(middle[look]), "high": _plain(high[look])}
            for name, (low, high, middle) in ends.items()
        }
        if self.shared is not None:
            for name in CONVERTED:
                found[name]["given_coefficient"] = self._given_coefficient(self.shared, name, look)
        contact = {"peak_utilisation": self._peak(look), "valid": _plain(self.valid_share(look))}
        when = {} if year is None else {"years": self.counts[look] / year}
        return {
            "cycles": self.counts[look],
            **when,
            **found,
            "edge_loading": _plain(self.edge_loading(look)),
            **contact,
        }

    def _peak(self, look: int) -> dict[str, float | None]:
        """Return the band of the largest utilisation from the first cycle to a report."""
        rest = (1 - self.level) / 2
        shares = {"low": rest, "median": 0.5, "high": 1 - rest}
        return {end: _plain(self.utilisation_quantile(share)[look]) for end, share in shares.items()}

    def _given_coefficient(self, shared: SharedCoefficient, name: str, look: int) -> dict[str, Any]:
        """Return the bands of the patients for each shared coefficient."""
        rest = (1 - self.level) / 2
        shares = {"low": rest, "median": 0.5, "high": 1 - rest}
        return {
            coefficient: {end: _plain(shared.quantile(coefficient, name, share)[look]) for end, share in shares.items()}
            for coefficient in shared.values
        }

    def _shares(self) -> dict[str, Any] | None:
        if self.indices is None:
            return None
        return {
            answer: {
                name: {order: _plain(values[row, column]) for order, values in self.indices.items()}
                for column, name in enumerate(self.scatter.distributions)
            }
            for row, answer in enumerate(SHARED)
        }


_SPRINGS = "bands are those of radial springs"


def _plain(value: float) -> float | None:
    return float(value) if numpy.isfinite(value) else None


def uncertainty(
    scatter: Scatter,
    history: History,
    *,
    count: int = COUNT,
    seed: int = 0,
    engine: Engine = _HERE,
    listen: Listener = _nothing,
) -> Bands:
    """The bands of a hip in use, and what matters.

    Parameters
    ----------
    scatter : Scatter
    history : History
        Of the usual patient; looks are taken where it has them.
    count : int
        Samples, a power of two: patients are as many, times the numbers that scatter and two. Bands are those of the
        first two sets.
    seed : int
        The same seed gives the same numbers.
    engine : Engine
        Who wears the patients' hips.
    listen : function
        Told how many patients are done.

    Raises
    ------
    ValueError
        A count that is no power of two, a seed below 0.
    """
    require("count", count, count >= 2 and count & (count - 1) == 0, "a power of two of samples")
    require("seed", seed, seed >= 0, "a seed is 0 or more")
    check_samples(count)
    counts = tuple(report.cycles for report in history.reports)
    answers = _Answers(scatter, counts, engine, listen)
    indices: Mapping[str, Numbers] | None = sobol(answers, list(scatter.distributions.values()), count, seed, LEVEL)
    if any((one.refused != "").any() for one in answers.seen):
        indices = None
    plain = joined(answers.seen[:2])
    sampled = {
        name: numpy.concatenate([values[name] for values in answers.sampled[:2]]) for name in scatter.distributions
    }
    return Bands(
        scatter=scatter,
        counts=counts,
        lived=plain,
        seed=seed,
        indices=indices,
        off=_off(scatter, history.reports),
        shared=share_coefficient(scatter, counts, sampled, plain.table, LEVEL, engine),
    )


def population(
    scatter: Scatter,
    counts: Sequence[float],
    *,
    patients: int,
    seed: int = 0,
    engine: Engine = _HERE,
    store: Kept | None = None,
    listen: Listener = _nothing,
) -> tuple[Lives, Bands]:
    """Many patients, and what their hips come to.

    Parameters
    ----------
    scatter : Scatter
    counts : sequence of float
        Cycles of the usual patient at which to look.
    patients : int
        With more of them the first ones stay the same.
    seed : int
    engine : Engine
        `Serial()`, `Processes()`, `Distributed()`: a piece of sixteen patients is a task.
    store : Kept, optional
        What lies there is not worn anew.
    listen : function
        Told how many patients are done.

    Raises
    ------
    ValueError
        No number of patients; a seed below 0.
    """
    lives = Lives(scatter=scatter, counts=tuple(sorted(counts)), values=drawn(scatter, patients, seed))
    whole = Patient(use=scatter.use, pace=1.0).seen(lives.counts)
    lived = lives.all(engine, store, listen)
    shared = share_coefficient(scatter, lives.counts, lives.values, lived.table, LEVEL, engine)
    off = _off(scatter, whole)
    return lives, Bands(scatter=scatter, counts=lives.counts, lived=lived, seed=seed, off=off, shared=shared)


@dataclass
class _Answers:
    """The numbers of `SHARED` at the end (answers, points) of samples (numbers, points), which it has `seen` whole."""

    scatter: Scatter
    counts: tuple[float, ...]
    engine: Engine
    listen: Listener
    seen: list[Lived] = field(default_factory=list)
    sampled: list[Mapping[str, Numbers]] = field(default_factory=list)
    done: int = 0

    def __call__(self, values: Numbers) -> Numbers:
        named = dict(zip(self.scatter.distributions, values.reshape(len(values), -1), strict=True))
        lives = Lives(scatter=self.scatter, counts=self.counts, values=named)
        lived = lives.all(self.engine, None, lambda done: self.listen(self.done + done))
        self.done += len(lives)
        self.seen.append(lived)
        self.sampled.append(named)
        last = lived.table[:, -1, [list(ANSWERS).index(name) for name in SHARED]]
        return last.T.reshape(len(SHARED), *values.shape[1:]).copy()


def _off(scatter: Scatter, whole: Sequence[Report]) -> dict[str, float]:
    """How far the usual patient's quick run is from the whole one."""
    quick = answers_of(scatter.patient({}).seen([report.cycles for report in whole]))
    full = answers_of(whole)
    found = {}
    for name in SHARED:
        place = list(ANSWERS).index(name)
        one, other = quick[:, place], full[:, place]
        found[name] = float(abs(numpy.divide(one, other, out=numpy.ones_like(one), where=other > 0) - 1).max())
    return found
