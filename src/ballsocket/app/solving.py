"""Slow presses, solved in a separate process while the page stays usable."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import pi
from typing import Any

import numpy

from ..catalogue import catalogue
from ..compare import is_curve_slow, press_short_curve
from ..contact import Contact
from ..core import arrays
from ..core.arrays import Array
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..problem import Joint
from ..problem.cup import Cup
from .jobs import Job
from .running import Report, RunRefused

_LAW_FIELDS = (
    "half_angle",
    "max_pressure",
    "max_pressure_angle",
    "pole_pressure",
    "stiffness",
    "energy",
    "foundation_modulus",
    "pressure_integral",
)
_SAMPLE_ANGLES = numpy.sin(
    numpy.linspace(0.0, pi / 2, 120)
)  # of the half angle, dense where the pressure falls steeply
_NOTHING = (numpy.zeros(1), numpy.zeros(1))


@dataclass(frozen=True, kw_only=True, eq=False)
class RecordedLaws:
    """Numbers of a solved contact, and its pressure (MPa) at angles (rad) up to its edge."""

    half_angle: Array
    max_pressure: Array
    max_pressure_angle: Array
    pole_pressure: Array
    stiffness: Array
    energy: Array
    foundation_modulus: Array
    pressure_integral: Array
    profile: tuple[numpy.ndarray, numpy.ndarray]

    def pressure(self, angle: Array) -> Array:
        """Interpolate the sampled pressure linearly."""
        return numpy.interp(arrays.to_numpy(angle), *self.profile, right=0.0)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class RecordedContact(Contact):
    """Contact solved by another process, with its estimated errors, notes, validity and curve."""

    error: dict[str, Any] = field(default_factory=dict)
    curve: Contact | None = None
    solved_notes: tuple[str, ...] = ()
    solved_valid: Array = True

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the process that solved the contact."""
        return self.solved_notes

    @property
    def valid(self) -> Array:
        """Validity by the process that solved the contact."""
        return self.solved_valid


def record_contact(contact: Contact, curve: Contact | None = None) -> RecordedContact:
    """Copy a contact without its solver, with its curve if there is one."""
    laws = RecordedLaws(**{name: getattr(contact, name) for name in _LAW_FIELDS}, profile=_sample_pressure(contact))
    return RecordedContact(
        model=contact.model,
        joint=contact.joint,
        status=contact.status,
        laws=laws,
        force=contact.force,
        indentation=contact.indentation,
        error=dict(getattr(contact, "error", {})),
        curve=curve,
        solved_notes=contact.notes,
        solved_valid=contact.valid,
    )


def _sample_pressure(contact: Contact) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Sample angles and pressures of a single contact; nothing for several."""
    if numpy.ndim(contact.half_angle) or not float(contact.half_angle) > 0:
        return _NOTHING
    angles = min(float(contact.half_angle), pi / 2) * _SAMPLE_ANGLES
    return angles, numpy.asarray(contact.pressure(angles))


LONGEST = 20.0
"""Seconds that the presses of one joint may take."""

_MAX_SOLVED = 256

Key = tuple[Joint, Cup, tuple[tuple[str, float], ...], str]


Solved = RecordedContact | str
"""Result of a model: a contact with its curve, or the reason for its absence."""


def heavy(joint: Joint, name: str) -> bool:
    """Return True if a press of a model is slow."""
    return is_curve_slow(catalogue[name], joint)


_solved: OrderedDict[Key, tuple[Solved, bool]] = OrderedDict()
"""Results of slow presses, and True once they are complete: a contact precedes its curve."""


def solved(file: JointFile, name: str) -> Solved | None:
    """Return the result of a slow press so far; None before its request."""
    return _solved.get(_key(file, name), (None, False))[0]


def _unfinished(file: JointFile, names: Iterable[str]) -> tuple[str, ...]:
    return tuple(
        name for name in names if heavy(file.joint, name) and not _solved.get(_key(file, name), ("", False))[1]
    )


def _key(file: JointFile, name: str) -> Key:
    return file.joint, file.cup, tuple(file.load.items()), name


def _store(file: JointFile, name: str, result: Solved, complete: bool) -> None:
    _solved[_key(file, name)] = result, complete
    while len(_solved) > _MAX_SOLVED:
        _solved.popitem(last=False)


def solve(file: JointFile, names: Sequence[str], report: Report) -> None:
    """Press a joint by slow models in a separate process; report each contact, and its curve later."""
    contacts = {}
    for name in names:
        result = _contact(file, name)
        if isinstance(result, RecordedContact) and float(result.half_angle) > 0:
            contacts[name] = result
        report((name, result, name not in contacts))
    for name, contact in contacts.items():
        report((name, replace(contact, curve=record_contact(press_short_curve(contact, catalogue[name]))), True))


def _contact(file: JointFile, name: str) -> Solved:
    try:
        return record_contact(catalogue[name].in_cup(file.cup).press(file.joint, **file.load))
    except OutsideDomainError as error:
        return str(error)


class Errand:
    """Slow presses of one page, in at most one process for the present screen; `changed` is called on news."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._files: tuple[JointFile, tuple[str, ...]] | None = None
        self.job = Job(self._store_news, LONGEST)

    def ask(self, files: Iterable[JointFile], names: tuple[str, ...]) -> None:
        """Start the presses of the first file that has unsolved models."""
        unsolved = next(((file, missing) for file in files if (missing := _unfinished(file, names))), None)
        if unsolved is None:
            self.leave()
        elif not self.job.works or unsolved != self._files:
            self.leave()
            self._files = unsolved
            self.job.ask(unsolved, partial(solve, *unsolved))

    def _store_news(self, key: Any, news: Any) -> None:
        file, names = self._files or key
        if isinstance(news, tuple):
            _store(file, *news)
            self._files = file, _unfinished(file, names)
        elif isinstance(news, RunRefused):
            for name in names:
                _store(file, name, solved(file, name) or f"{name} has no answer here: {news.why}", True)
        self._changed()

    def leave(self) -> None:
        """End the process."""
        self.job.stop()
