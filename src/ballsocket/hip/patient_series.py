"""Results of similar patients from a series: polynomials in a box, fitted to some hundred simulations of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import product
from math import ceil, log

import numpy
from numpy.polynomial.chebyshev import chebvander

from ..core.arrays import Numbers
from ..core.chebyshev import chebyshev_coefficients, chebyshev_points
from ..core.display import counted
from ..core.storage.pieces import check_worker_code, fingerprint
from ..studies.distributions import draw_points
from .contact_checks import check_rows
from .similarity import CLEARANCE, RIM_NUMBERS, UNWORN_NUMBERS, Similarity
from .simulation import MAX_WORN_LINERS
from .variability import RESULT_COLUMNS, RESULT_UNITS, CohortResult

_BOX_MARGIN = 1e-9  # margin of the ends of a box, whose numbers are logarithms and angles


@dataclass(frozen=True, kw_only=True, eq=False)
class Box:
    """Ranges of named variables."""

    ranges: Mapping[str, tuple[float, float]]  # lower and upper end of each variable

    @cached_property
    def axes(self) -> tuple[str, ...]:
        """Names of the variables whose ends differ."""
        return tuple(name for name, (low, high) in self.ranges.items() if high > low)

    def contains(self, numbers: Mapping[str, Numbers]) -> Numbers:
        """Return the mask of the points inside the box, up to rounding; NaN is outside."""
        masks = [
            (numbers[name] >= low - _BOX_MARGIN) & (numbers[name] <= high + _BOX_MARGIN)
            for name, (low, high) in self.ranges.items()
        ]
        inside: Numbers = numpy.logical_and.reduce(masks)
        return inside

    def scale(self, numbers: Mapping[str, Numbers]) -> Numbers:
        """Map points to -1 to 1 on each axis, and those outside to its ends: (axes, points)."""
        count = len(next(iter(numbers.values())))
        scaled = numpy.zeros((len(self.axes), count))
        for row, name in zip(scaled, self.axes, strict=True):
            low, high = self.ranges[name]
            row[:] = numpy.clip((2 * numbers[name] - low - high) / (high - low), -1.0, 1.0)
        return scaled

    def sample(self, count: int) -> list[dict[str, float]]:
        """Return points of a Sobol sequence, denser at the ends like Chebyshev points.

        A larger count has the same first points. A box without axes has a single point.
        """
        from scipy.stats.qmc import Sobol

        if not self.axes:
            return [{name: low for name, (low, _) in self.ranges.items()}][:count]
        scaled = -numpy.cos(numpy.pi * draw_points(Sobol(len(self.axes), rng=0), count))
        points = [{name: low for name, (low, _) in self.ranges.items()} for _ in range(count)]
        for column, name in zip(scaled.T, self.axes, strict=True):
            low, high = self.ranges[name]
            for point, position in zip(points, column, strict=True):
                point[name] = float((low + high + (high - low) * position) / 2)
        return points


def exponents_of(weights: Sequence[int], degree: int) -> Numbers:
    """List the exponents of all terms up to a total degree, in which each axis has a weight: (terms, axes)."""
    powers = product(*(range(degree // weight + 1) for weight in weights))
    terms = [power for power in powers if sum(a * weight for a, weight in zip(power, weights, strict=True)) <= degree]
    return numpy.array(terms, dtype=int).reshape(len(terms), len(weights))


def basis(scaled: Numbers, exponents: Numbers) -> Numbers:
    """Compute products of Chebyshev polynomials at points (axes, points) from -1 to 1: (points, terms)."""
    columns = numpy.ones((len(exponents), scaled.shape[1]))
    for row, powers in zip(scaled, exponents.T, strict=True):
        columns *= chebvander(row, int(powers.max(initial=0))).T[powers]
    return columns.T


def interpolation_weights(points: Numbers, low: float, high: float, count: int) -> Numbers:
    """Compute weights (points, count) that interpolate values at Chebyshev points of a range to other points."""
    if count == 1:
        return numpy.ones((len(points), 1))
    scaled = numpy.clip((2 * points - low - high) / (high - low), -1.0, 1.0)
    weights: Numbers = chebvander(scaled, count - 1) @ chebyshev_coefficients(numpy.eye(count), 0)
    return weights


MEMBERS_PER_PIECE = 8  # simulations of one piece of work: about half a second

_NODES_PER_UNIT = 1.5  # interpolation points per unit of the logarithm of the exposure
_MAX_NODES = 24  # largest number of interpolation points of the exposure
_MEMBERS_PER_TERM = 2  # simulations per term of the polynomial
_WEIGHTS = {CLEARANCE: 4}  # weights in the degree; the modulus, and with it creep, hardly depends on clearance
_MIN_MEMBERS_PER_TERM = 1.5  # least number of simulations with a result per term of the polynomial
_WEAR_SAFETY = 0.95  # fraction of the largest allowed wear up to which a patient takes its result from the series
_EXPOSURE_MARGIN = 1e-12  # margin of the range of the logarithm of the exposure
_BLOCK = 2048  # patients whose results are computed at once
_CONTACT_FIELDS = 3  # numbers of each worst contact: indentation, half angle, pressure


class NoSeriesError(ValueError):
    """Error raised for patients without a series; its message is a reason in one clause."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FamilyRun:
    """Simulations of a family at sampled numbers, divided into pieces of a few."""

    similarity: Similarity
    box: Box  # ranges of the numbers
    log_exposures: tuple[float, float]  # range of the logarithm of the exposure
    code: str = field(default_factory=fingerprint)  # fingerprint of the code that the workers must have

    @property
    def n_nodes(self) -> int:
        """Number of interpolation points of the exposure."""
        low, high = self.log_exposures
        return 1 if high == low else min(2 + ceil(_NODES_PER_UNIT * (high - low)), _MAX_NODES)

    def __call__(self, piece: int) -> dict[str, Numbers]:
        """Simulate the members of a piece; those without a result are NaN."""
        check_worker_code(self.code)
        first = piece * MEMBERS_PER_PIECE
        members = self.box.sample(first + MEMBERS_PER_PIECE)[first:]
        contacts = _CONTACT_FIELDS * len(self.similarity.setup.frame.activities)
        n_worn = len(self.similarity.results) + len(RIM_NUMBERS) + contacts
        unworn = numpy.full((len(members), len(UNWORN_NUMBERS) + contacts), numpy.nan)
        worn = numpy.full((len(members), self.n_nodes, n_worn), numpy.nan)
        low, high = self.log_exposures
        exposures = ((low + high) / 2 + (high - low) / 2 * chebyshev_points(self.n_nodes)).tolist()
        for row, numbers in enumerate(members):
            with suppress(ValueError):
                unworn[row], worn[row] = self.similarity.simulate(numbers, exposures)
        return {"unworn": unworn, "worn": worn}


def members_of(box: Box, degree: int) -> int:
    """Return the number of simulations for a polynomial of a degree: whole pieces, two simulations a term."""
    wanted = _MEMBERS_PER_TERM * len(_exponents(box, degree)) if box.axes else 1
    return MEMBERS_PER_PIECE * ceil(wanted / MEMBERS_PER_PIECE)


def _exponents(box: Box, degree: int) -> Numbers:
    return exponents_of([_WEIGHTS.get(name, 1) for name in box.axes], degree)


@dataclass(frozen=True, kw_only=True, eq=False)
class PatientSeries:
    """Polynomials that give the results of patients from their dimensionless numbers."""

    family: FamilyRun  # family, with the ranges of its numbers
    degree: int  # total degree of the polynomials
    n_members: int  # number of simulations that the polynomials are fitted to
    # coefficients (terms, numbers) and (terms, exposures, numbers)
    unworn: Numbers
    worn: Numbers

    def results(self, values: Mapping[str, Numbers], counts: Sequence[float]) -> tuple[CohortResult, Numbers]:
        """Compute the results of patients at the nominal patient's cycle counts.

        Returns
        -------
        CohortResult
            Results. Those of patients outside the ranges of the series are those at its nearest end.
        array of bool (patients,)
            Mask of the patients within the ranges.
        """
        count = len(next(iter(values.values())))
        table = numpy.empty((count, len(counts), len(RESULT_UNITS)))
        contact, inside = numpy.empty((count, 1 + len(counts), 3)), numpy.empty(count, dtype=bool)
        for first in range(0, count, _BLOCK):
            block = slice(first, first + _BLOCK)
            part = {name: column[block] for name, column in values.items()}
            table[block], contact[block], inside[block] = self._block(part, counts)
        return CohortResult(table=table, refused=numpy.full(count, "", dtype=object), contact=contact), inside

    def _block(self, values: Mapping[str, Numbers], counts: Sequence[float]) -> tuple[Numbers, Numbers, Numbers]:
        """Compute table and contacts of a block of patients, and the mask of those within the ranges."""
        similarity, box = self.family.similarity, self.family.box
        numbers, exposure = similarity.numbers(values), similarity.log_exposure(values)
        terms = basis(box.scale(numbers), _exponents(box, self.degree))
        at_nodes = (terms @ self.worn.reshape(len(self.worn), -1)).reshape(len(terms), *self.worn.shape[1:])
        unworn = terms @ self.unworn
        low, high = self.family.log_exposures
        weights = partial(interpolation_weights, low=low, high=high, count=self.family.n_nodes)
        stages = [numpy.matmul(weights(exposure + log(count))[:, None, :], at_nodes)[:, 0] for count in counts]
        # clearly below the largest allowed wear, by the logarithm of depth over clearance
        clearance, log_depth = similarity.clearances(values), unworn[:, 0] + exposure + log(counts[-1])
        thickness = numpy.minimum(float(similarity.setup.joint.liner_thickness), similarity.socket_radius(clearance))
        inside = log_depth <= numpy.log(_WEAR_SAFETY * MAX_WORN_LINERS * thickness / clearance)
        inside &= box.contains(numbers)
        for count in (counts[0], counts[-1]):
            inside &= (exposure + log(count) >= low - _EXPOSURE_MARGIN) & (
                exposure + log(count) <= high + _EXPOSURE_MARGIN
            )
        return self._table(stages, values), self._contacts(unworn, stages, values), inside

    def _table(self, stages: Sequence[Numbers], values: Mapping[str, Numbers]) -> Numbers:
        """Convert the numbers of worn bores (patients, numbers) to results: (patients, reports, results)."""
        similarity = self.family.similarity
        units, names = similarity.units(similarity.clearances(values)), similarity.results
        table = numpy.zeros((len(stages[0]), len(stages), len(RESULT_UNITS)))
        for report, stage in enumerate(stages):
            results = {name: numpy.exp(stage[:, column]) for column, name in enumerate(names)}
            results["edge_distance"] = numpy.maximum(stage[:, len(names)], 0.0)
            for name, ratios in results.items():
                table[:, report, RESULT_COLUMNS[name]] = ratios * units[name]
        return table

    def _contacts(self, unworn: Numbers, stages: Sequence[Numbers], values: Mapping[str, Numbers]) -> Numbers:
        """Compute utilisation, validity and edge loading of the first cycle and each report: (patients, stages, 3)."""
        rim = len(self.family.similarity.results)
        worst = [unworn[:, len(UNWORN_NUMBERS) :], *(stage[:, rim + len(RIM_NUMBERS) :] for stage in stages)]
        checks = numpy.stack([self._contact_checks(contacts, values) for contacts in worst], axis=1)
        at_rim = unworn[:, UNWORN_NUMBERS.index("rim_distance")] <= 0
        # by the distance and the excess of the pressure at the rim, see `mask_edge_loading`
        edge = [at_rim, *((stage[:, rim] <= 0) & (at_rim | (stage[:, rim + 1] >= 0)) for stage in stages)]
        return numpy.concatenate([checks, numpy.stack(edge, axis=1)[:, :, None]], axis=2)

    def _contact_checks(self, stage: Numbers, values: Mapping[str, Numbers]) -> Numbers:
        """Compute utilisation and validity of patients from their worst contacts: (patients, 2)."""
        similarity = self.family.similarity
        clearance, forces = similarity.clearances(values), similarity.largest_forces(values)
        indentation, half_angle, pressure = stage.reshape(len(stage), -1, _CONTACT_FIELDS).transpose(2, 1, 0)
        pressure_unit = similarity.modulus(clearance) * clearance
        depth, max_pressure = numpy.exp(indentation) * clearance, numpy.exp(pressure) * pressure_unit
        columns = (numpy.zeros_like(forces), forces, depth, half_angle, max_pressure)
        rows = numpy.stack(columns, axis=-1).reshape(-1, len(columns))
        joint = replace(similarity.setup.joint, clearance=numpy.tile(clearance, len(forces)))
        utilisation, valid = check_rows(similarity.setup.contact_model, joint, rows).reshape(2, *forces.shape)
        return numpy.stack([utilisation.max(axis=0), valid.min(axis=0)], axis=1)


def fit_series(family: FamilyRun, pieces: Sequence[Mapping[str, Numbers]], degree: int) -> PatientSeries:
    """Fit polynomials of a degree to the simulated members of a family by least squares."""
    unworn, worn = (numpy.concatenate([piece[name] for piece in pieces]) for name in ("unworn", "worn"))
    known = numpy.isfinite(unworn).all(axis=1) & numpy.isfinite(worn).all(axis=(1, 2))
    points, exponents = family.box.sample(len(known)), _exponents(family.box, degree)
    if known.sum() < (_MIN_MEMBERS_PER_TERM * len(exponents) if family.box.axes else 1):
        simulations = counted(len(known), "simulation")
        raise NoSeriesError(f"{len(known) - int(known.sum())} of {simulations} of a series without a result")
    columns = {name: numpy.array([point[name] for point in points])[known] for name in family.box.ranges}
    terms = basis(family.box.scale(columns), exponents)
    solved = numpy.linalg.lstsq(
        terms, numpy.concatenate([unworn[known], worn[known].reshape(int(known.sum()), -1)], axis=1), rcond=None
    )[0]
    n_unworn = unworn.shape[1]
    return PatientSeries(
        family=family,
        degree=degree,
        n_members=len(known),
        unworn=solved[:, :n_unworn],
        worn=solved[:, n_unworn:].reshape(-1, *worn.shape[1:]),
    )
