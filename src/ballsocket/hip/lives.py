"""Many patients' hips: drawn, worn piece by piece, wherever there is room, and kept so that a stop loses little."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from hashlib import sha256
from math import ceil, degrees, isfinite
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.executors.local import Engine, Serial
from ..core.storage.atomic import write_text
from ..core.storage.fingerprint import fingerprint
from ..core.storage.npz import read_arrays, write_arrays
from ..studies.axes import SampleAxis
from ..studies.distributions import Distribution
from .checkpoint import checkpoint
from .patients import ANSWERS, Scatter, answers_of, contact_over

_PIECE = 16
"""Patients: about half a second of work."""

_MOST = 1_000_000
_LABEL = "patients.json"
_HERE = Serial()

Listener = Callable[[int], None]
"""Told how many patients are done."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Lived:
    """What is seen of some patients.

    Attributes
    ----------
    table : array (patients, looks, answers)
        Of `ANSWERS`; NaN where there is none.
    refused : array of str (patients,)
        Why there is none; empty where there is one.
    contact : array (patients, 1 + looks, 2)
        Utilisation and validity (1 or 0) of the contact, unworn and at each report.
    """

    table: Numbers
    refused: Numbers
    contact: Numbers

    @property
    def peak_utilisation(self) -> Numbers:
        """Largest utilisation from the first cycle to each report: (patients, looks), NaN where it is not known."""
        return numpy.maximum.accumulate(self.contact[:, :, 0], axis=1)[:, 1:]

    @property
    def valid(self) -> Numbers:
        """Validity from the first cycle to each report, 1 or 0: (patients, looks)."""
        return numpy.minimum.accumulate(self.contact[:, :, 1], axis=1)[:, 1:]


def joined(parts: Sequence[Lived]) -> Lived:
    """One after the other."""
    return Lived(
        table=numpy.concatenate([one.table for one in parts]),
        refused=numpy.concatenate([one.refused for one in parts]),
        contact=numpy.concatenate([one.contact for one in parts]),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Lives:
    """Patients to be worn, in pieces of a few: called with the number of a piece, it wears these.

    Attributes
    ----------
    scatter : Scatter
    counts : tuple of float
        Cycles of the usual patient at which to look, in order.
    values : mapping of str to array (patients,)
        By name of `SCATTERS`.
    code : str
        Which code is to wear them.
    """

    scatter: Scatter
    counts: tuple[float, ...]
    values: Mapping[str, Numbers]
    code: str = field(default_factory=fingerprint)

    def __len__(self) -> int:
        """Patients."""
        return len(next(iter(self.values.values())))

    @property
    def pieces(self) -> range:
        return range(ceil(len(self) / _PIECE))

    def patients(self, piece: int) -> range:
        """Numbers of the patients in a piece."""
        return range(piece * _PIECE, min((piece + 1) * _PIECE, len(self)))

    def __call__(self, piece: int) -> Lived:
        """What is seen of the patients in a piece.

        Raises
        ------
        RuntimeError
            Another version of this package than that which asks.
        """
        if fingerprint() != self.code:
            raise RuntimeError(f"this worker has ballsocket {fingerprint()}, and {self.code} asks")
        tables, contacts, refusals = zip(*(self._lived(number) for number in self.patients(piece)), strict=True)
        return Lived(table=numpy.stack(tables), refused=numpy.array(refusals), contact=numpy.stack(contacts))

    def _lived(self, number: int) -> tuple[Numbers, Numbers, str]:
        """Wear the hip of one patient; return its results, its contacts, and an error message."""
        values = {name: float(each[number]) for name, each in self.values.items()}
        try:
            patient = self.scatter.patient(values)
            reports = patient.seen(self.counts)
            return answers_of(reports), contact_over(patient.use, reports), ""
        except ValueError as error:
            answers = numpy.full((len(self.counts), len(ANSWERS)), numpy.nan)
            contact = numpy.full((1 + len(self.counts), 2), numpy.nan)
            return answers, contact, str(error)

    def all(self, engine: Engine = _HERE, store: Kept | None = None, listen: Listener = lambda done: None) -> Lived:
        """Every patient, those of a store not anew."""
        if store is not None:
            store.prepare()
        found = {} if store is None else store.found(self)
        sent = replace(self, scatter=replace(self.scatter, use=self.scatter.quick))
        work = sent if store is None else Writing(lives=sent, store=store)
        done = sum(len(self.patients(piece)) for piece in found)
        listen(done)
        for piece, lived in engine.run(work, [piece for piece in self.pieces if piece not in found]):
            found[piece] = lived
            done += len(self.patients(piece))
            listen(done)
        return joined([found[piece] for piece in self.pieces])


@dataclass(frozen=True, kw_only=True, eq=False)
class Writing:
    """Wears a piece and keeps it: a process that is killed loses no more than that."""

    lives: Lives
    store: Kept

    def __call__(self, piece: int) -> Lived:
        lived = self.lives(piece)
        self.store.write(piece, lived)
        return lived


@dataclass(frozen=True, kw_only=True)
class Kept:
    """The folder in which patients are kept, a file for each piece.

    Attributes
    ----------
    folder : Path
    identity : str
        Of the usual hip, of what scatters, and of the code; not of how many patients there are.
    """

    folder: Path
    identity: str

    def _path(self, piece: int) -> Path:
        return self.folder / f"patients_{piece:06d}.npz"

    @property
    def _label(self) -> Path:
        return self.folder / _LABEL

    def prepare(self) -> None:
        """Make the folder where it is not there yet."""
        self.folder.mkdir(parents=True, exist_ok=True)
        if not self._label.exists():
            write_text(self._label, json.dumps({"identity": self.identity}))

    def check(self) -> None:
        """Whether what is kept there, if anything is, are these patients.

        Raises
        ------
        ValueError
            Other patients are kept there, or something else.
        """
        label = self._label
        if not label.exists():
            return
        try:
            kept = json.loads(label.read_bytes())["identity"]
        except (ValueError, LookupError, TypeError) as error:
            raise ValueError(f"{label} tells of no patients; remove it to begin anew") from error
        if kept != self.identity:
            raise ValueError(f"{self.folder} keeps other patients, or those of another version: give another folder")

    def write(self, piece: int, lived: Lived) -> None:
        write_arrays(self._path(piece), table=lived.table, refused=lived.refused, contact=lived.contact)

    def found(self, lives: Lives) -> dict[int, Lived]:
        """The pieces that are there, whole."""
        each = ((piece, self._read(piece, len(lives.patients(piece)))) for piece in lives.pieces)
        return {piece: lived for piece, lived in each if lived is not None}

    def _read(self, piece: int, count: int) -> Lived | None:
        try:
            lived = Lived(**read_arrays(self._path(piece)))
        except (OSError, ValueError, TypeError):  # what is damaged is worn anew
            return None
        return lived if len(lived.table) == count else None


def kept(folder: Path, scatter: Scatter, counts: Sequence[float], seed: int) -> Kept:
    """Where the patients of a sample are kept; see `Kept`."""
    whose = checkpoint(scatter.quick, folder).identity
    drawn = (fingerprint(), whose, dict(scatter.distributions), scatter.body_weight, tuple(counts), seed)
    store = Kept(folder=folder.absolute(), identity=sha256(repr(drawn).encode()).hexdigest())
    store.check()
    return store


def drawn(scatter: Scatter, count: int, seed: int) -> Mapping[str, Numbers]:
    """The numbers of patients: by Sobol's points, of which more are added to the same first ones.

    Raises
    ------
    ValueError
        No number of patients, or a seed below 0.
    """
    require("patients", count, 1 <= count <= _MOST, f"at least one, at most {_MOST}")
    require("seed", seed, seed >= 0, "a seed is 0 or more")
    return SampleAxis(count=count, distributions=tuple(scatter.distributions.items()), seed=seed).values


def columns(lives: Lives, lived: Lived) -> Iterator[tuple[str, Numbers]]:
    """The heads and the numbers of a table with a row for each patient; angles in degrees."""
    for name, values in lives.values.items():
        yield f"{name}{_UNITS.get(name, '')}", numpy.degrees(values) if name in _ANGLES else values
    for look, count in enumerate(lives.counts):
        for place, (name, unit) in enumerate(ANSWERS.items()):
            yield f"{name}_{unit}_at_{count:g}", lived.table[:, look, place]
        yield f"peak_utilisation_at_{count:g}", lived.peak_utilisation[:, look]
        yield f"valid_at_{count:g}", lived.valid[:, look]


_ANGLES = ("inclination", "anteversion", "tilt")
_UNITS = {"clearance": "_mm", "body_weight": "_N", **dict.fromkeys(_ANGLES, "_deg")}


def write_csv(path: Path, lives: Lives, lived: Lived) -> Path:
    """Write a row for each patient; returns the path."""
    heads, values = zip(*columns(lives, lived), strict=True)
    rows = (",".join("" if numpy.isnan(one) else f"{one:.9g}" for one in row) for row in numpy.stack(values, axis=1))
    return write_text(path, "\n".join([",".join(heads), *rows]) + "\n")


def summary_of(scatter: Scatter) -> dict[str, Any]:
    """What scatters, as plain data: mm, N, degrees."""
    return {name: _told(name, each) for name, each in scatter.distributions.items()}


def _told(name: str, distribution: Distribution) -> dict[str, Any]:
    turned = degrees(1.0) if name in _ANGLES else 1.0
    numbers = {each.name: getattr(distribution, each.name) for each in fields(distribution)}
    told = {key: turned * value for key, value in numbers.items() if isfinite(value)}
    return {"distribution": type(distribution).__name__, **told}
