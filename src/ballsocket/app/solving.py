"""Slow presses, solved in a separate process while the page stays usable."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ..comparison import is_curve_slow, press_short_curve
from ..contact import Contact
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..model_catalogue import catalogue
from ..problem import Joint
from ..problem.cup import Cup
from .jobs import Job
from .running import Report, RunRefused

PRESS_SECONDS = 20.0  # processor time in s of the presses of one joint
_MAX_SOLVED = 256

Key = tuple[Joint, Cup, tuple[tuple[str, Any], ...], str]
_solved: OrderedDict[Key, SolvedPress] = OrderedDict()  # results of slow presses: a contact precedes its curve


@dataclass(frozen=True, eq=False)
class SolvedPress:
    """Contact or the reason for its absence, its curve, and True once nothing more will come.

    The report of a curve has no `result`, which precedes it.
    """

    result: Contact | str | None
    curve: Contact | None = None
    complete: bool = False


def heavy(joint: Joint, name: str) -> bool:
    """Return True if a press of a model is slow."""
    return is_curve_slow(catalogue[name], joint)


def solved(file: JointFile, name: str) -> Contact | str | None:
    """Return the result of a slow press so far; None before its request."""
    press = _solved.get(_key(file, name))
    return None if press is None else press.result


def solved_curve(contact: Contact) -> Contact | None:
    """Return the curve of the contact of a slow press; None before it is solved."""
    return next((press.curve for press in _solved.values() if press.result is contact), None)


def _unfinished(file: JointFile, names: Iterable[str]) -> tuple[str, ...]:
    presses = {name: _solved.get(_key(file, name)) for name in names if heavy(file.joint, name)}
    return tuple(name for name, press in presses.items() if press is None or not press.complete)


def _key(file: JointFile, name: str) -> Key:
    return file.joint, file.cup, (*file.load.items(), *file.aim.items()), name


def _store(file: JointFile, name: str, press: SolvedPress) -> None:
    _solved[_key(file, name)] = press
    while len(_solved) > _MAX_SOLVED:
        _solved.popitem(last=False)


def solve(file: JointFile, names: Sequence[str], report: Report) -> None:
    """Press a joint by slow models in a separate process; report each contact, and its curve later."""
    contacts = {}
    for name in names:
        result = _press(file, name)
        if isinstance(result, Contact) and float(result.half_angle) > 0:
            contacts[name] = result
        report((name, SolvedPress(result, complete=name not in contacts)))
    for name, contact in contacts.items():
        report((name, SolvedPress(None, press_short_curve(contact, catalogue[name]), complete=True)))


def _press(file: JointFile, name: str) -> Contact | str:
    """Press one model; the contact carries the slow numbers that a page shows."""
    try:
        contact = catalogue[name].in_cup(file.cup, **file.aim).press(file.joint, **file.load)
    except OutsideDomainError as error:
        return str(error)
    if not contact.status.failed:
        _ = contact.notes, contact.valid, contact.von_mises, contact.energy, contact.stiffness
    return contact


class SlowPresses:
    """Slow presses of one page, in at most one process for the present screen; `changed` is called on news."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._files: tuple[JointFile, tuple[str, ...]] | None = None
        self.job = Job(self._store_news, PRESS_SECONDS)

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
            name, press = news
            _store(file, name, replace(press, result=press.result or solved(file, name)))
            self._files = file, _unfinished(file, names)
        elif isinstance(news, RunRefused):
            for name in names:
                result = solved(file, name) or f"{name} has no result here: {news.why}"
                _store(file, name, SolvedPress(result, complete=True))
        self._changed()

    def leave(self) -> None:
        self.job.stop()
