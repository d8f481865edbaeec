"""Wear simulations of a sampled patient cohort, in parallel and resumable."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from math import ceil
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.executors.processes import Engine, Serial, check_memory, count_text
from ..core.storage.folders import ArrayPieceStore, folder_at
from ..core.storage.pieces import PieceRun, check_worker_code, fingerprint, hash_inputs
from ..studies.axes import SampleAxis
from .cup_frame import ANGLES
from .simulation import make_checkpoint
from .variability import RESULT_UNITS, CohortResult, PatientVariability, contact_table, join_results, result_table

PATIENTS_PER_PIECE = 16  # patients of one piece of work: about half a second

_MAX_PATIENTS = 1_000_000
_COPIES = 4  # copies of the results in memory: the table, those for shared coefficients, and a sorted column of a band
_ROWS_PER_BLOCK = 10_000  # rows of the table of patients that are written at once
_LABEL_NAME = "patients.json"  # name of the file with the identity of a stored cohort
_SERIAL = Serial()
_SUFFIXES = {"clearance": "_mm", "body_weight": "_N", **dict.fromkeys(ANGLES, "_deg")}  # units in the table's columns

ProgressCallback = Callable[[int], None]  # function that is called with the number of finished patients


@dataclass(frozen=True, kw_only=True, eq=False)
class CohortRun:
    """Simulation of a sampled patient cohort; a call with the number of a piece simulates its few patients."""

    variability: PatientVariability  # distributions of the patients
    counts: tuple[float, ...]  # cycles of the nominal patient at the reports, in ascending order
    values: Mapping[str, Numbers]  # (patients,), sampled quantities by name of `SAMPLED_QUANTITIES`
    code: str = field(default_factory=fingerprint)  # fingerprint of the code that the workers must have

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))

    @property
    def pieces(self) -> range:
        """Indices from 0 of the pieces of work; each piece is a group of patients."""
        return range(ceil(len(self) / PATIENTS_PER_PIECE))

    def patient_numbers(self, piece: int) -> range:
        """Return the indices of the patients in a piece (group of patients)."""
        return range(piece * PATIENTS_PER_PIECE, min((piece + 1) * PATIENTS_PER_PIECE, len(self)))

    def __call__(self, piece: int) -> CohortResult:
        """Simulate the patients of one piece (group of patients)."""
        check_worker_code(self.code)
        tables, contacts, errors = zip(
            *(self._simulate_patient(patient_index) for patient_index in self.patient_numbers(piece)), strict=True
        )
        return CohortResult(table=numpy.stack(tables), refused=numpy.array(errors), contact=numpy.stack(contacts))

    def _simulate_patient(self, patient_index: int) -> tuple[Numbers, Numbers, str]:
        """Simulate one patient; return results, contacts and an error message, empty without error."""
        values = {name: float(samples[patient_index]) for name, samples in self.values.items()}
        try:
            patient = self.variability.patient(values)
            reports = patient.simulate(self.counts)
            return result_table(reports), contact_table(patient.use, reports), ""
        except ValueError as error:
            results = numpy.full((len(self.counts), len(RESULT_UNITS)), numpy.nan)
            contact = numpy.full((1 + len(self.counts), 3), numpy.nan)
            return results, contact, str(error)

    def simulate(
        self,
        engine: Engine = _SERIAL,
        store: CohortStore | None = None,
        progress: ProgressCallback = lambda finished: None,
    ) -> CohortResult:
        """Simulate all patients of the cohort, except those whose results are stored."""
        if store is not None:
            store.create()
        coarse = replace(self, variability=replace(self.variability, use=self.variability.coarse_simulation))
        run = PieceRun(coarse, self.pieces, None if store is None else replace(store, n_patients=len(self)))
        results = dict(run.stored)
        finished = sum(len(self.patient_numbers(piece)) for piece in results)
        progress(finished)
        for piece, result in run.compute_missing(engine):
            results[piece] = result
            finished += len(self.patient_numbers(piece))
            progress(finished)
        return join_results([results[piece] for piece in self.pieces])


@dataclass(frozen=True, kw_only=True)
class CohortStore(ArrayPieceStore):
    """Folder of stored cohort results, one file for each piece (group of patients).

    The identity is a digest of nominal hip, distributions, seed and code, without the number of patients.
    """

    n_patients: int = 0  # of the present run; a stored last piece with fewer patients is computed again
    prefix: str = "patients"

    def create(self) -> None:
        """Create the folder and the label file of the store, unless they exist."""
        if self._read_label() is None:
            self.folder.write(_LABEL_NAME, json.dumps({"identity": self.identity}).encode())

    def check(self) -> None:
        """Check that an existing store belongs to this cohort; ValueError otherwise."""
        label = self._read_label()
        if label is None:
            return
        try:
            identity = json.loads(label)["identity"]
        except (ValueError, LookupError, TypeError) as error:
            raise ValueError(
                f"{self.folder}/{_LABEL_NAME} is not the label of a patient cohort; delete it to start again"
            ) from error
        if identity != self.identity:
            raise ValueError(f"{self.folder} has another cohort, or one of another version; choose another folder")

    def _read_label(self) -> bytes | None:
        try:
            return self.folder.read(_LABEL_NAME)
        except FileNotFoundError:
            return None

    def to_arrays(self, result: CohortResult) -> dict[str, Numbers]:
        return {array.name: getattr(result, array.name) for array in fields(result)}

    def from_arrays(self, piece: int, arrays: dict[str, Numbers]) -> CohortResult | None:
        """Return the result of a piece; None if it has another number of patients."""
        result = CohortResult(**arrays)
        patient_count = min(PATIENTS_PER_PIECE, self.n_patients - piece * PATIENTS_PER_PIECE)
        return result if len(result.table) == patient_count else None


def cohort_store(
    folder: str | Path, variability: PatientVariability, counts: Sequence[float], seed: int
) -> CohortStore:
    """Create the store of a cohort in a folder; ValueError if the folder stores another cohort.

    Parameters
    ----------
    folder : str or Path
        Folder of the store, or its address in a remote store that fsspec knows. It is created by the first run.
    variability : PatientVariability
        Distributions of the patients.
    counts : sequence of float
        Cycles of the nominal patient at the reports.
    seed : int
        Seed of the samples.

    Raises
    ------
    ValueError
        The folder has another cohort or a damaged label.
    """
    nominal = make_checkpoint(variability.coarse_simulation, Path(folder)).identity
    distributions = dict(variability.distributions)
    identity = hash_inputs(fingerprint(), nominal, distributions, variability.body_weight, tuple(counts), seed)
    store = CohortStore(folder=folder_at(folder), identity=identity)
    store.check()
    return store


def check_cohort_memory(patients: int, n_quantities: int, n_reports: int) -> None:
    """Check that the results of a cohort and their bands fit into the memory; ValueError otherwise."""
    numbers = n_quantities + _COPIES * (n_reports * len(RESULT_UNITS) + 3 * (1 + n_reports))
    check_memory(f"results of {count_text(patients)} patients", 8 * numbers * patients)


def sample_patients(variability: PatientVariability, count: int, seed: int) -> Mapping[str, Numbers]:
    """Sample the quantities of patients from a Sobol sequence; the first patients do not depend on `count`."""
    require("patients", count, 1 <= count <= _MAX_PATIENTS, f"it must be 1 to {_MAX_PATIENTS}")
    require("seed", seed, seed >= 0, "it must be at least 0")
    return SampleAxis(count=count, distributions=tuple(variability.distributions.items()), seed=seed).values_in()


def table_columns(run: CohortRun, result: CohortResult) -> Iterator[tuple[str, Numbers]]:
    """Yield name and values of each column of the patient table, with angles in degrees."""
    for name, values in run.values.items():
        yield f"{name}{_SUFFIXES.get(name, '')}", numpy.degrees(values) if name in ANGLES else values
    for report, count in enumerate(run.counts):
        for column, (name, unit) in enumerate(RESULT_UNITS.items()):
            yield f"{name}_{unit}_at_{count:g}", result.table[:, report, column]
        yield f"peak_utilisation_at_{count:g}", result.peak_utilisation[:, report]
        yield f"valid_at_{count:g}", result.valid[:, report]
        yield f"edge_loaded_at_{count:g}", result.edge_loaded[:, report]


def write_csv(path: Path, run: CohortRun, result: CohortResult) -> Path:
    """Write the patient table to a CSV file, local or remote, one row for each patient, and return its path."""
    names, columns = zip(*table_columns(run, result), strict=True)
    folder_at(path.parent).write_blocks(path.name, _csv_blocks(names, columns))
    return path


def _csv_blocks(names: Sequence[str], columns: Sequence[Numbers]) -> Iterator[bytes]:
    """Yield the lines of a table in blocks of rows, the names first; the cell of an unknown number is empty."""
    yield f"{','.join(names)}\n".encode()
    for first in range(0, len(columns[0]), _ROWS_PER_BLOCK):
        block = numpy.stack([column[first : first + _ROWS_PER_BLOCK] for column in columns], axis=1)
        rows = (["" if value != value else f"{value:.9g}" for value in row] for row in block.tolist())
        yield "".join(f"{','.join(row)}\n" for row in rows).encode()
