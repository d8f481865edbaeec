"""Presses that take long: a process beside the server solves them, and pages go on while they wait."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import panel as pn

from ..catalogue import catalogue
from ..compare import is_curve_slow, press_short_curve
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..problem import Joint
from ..problem.cup import Cup
from .running import Done, Run, RunRefused, Told, looked_at
from .written import WrittenContact, written

LONGEST = 20.0
"""Seconds that the presses of one joint may take."""

_KEPT = 256
_EVERY = 150  # ms between two questions for news; a slider that moves asks for others before the first

Key = tuple[Joint, Cup, tuple[tuple[str, float], ...], str]


Solved = WrittenContact | str
"""What a model says: a contact with its curve, or why there is none."""


def heavy(joint: Joint, name: str) -> bool:
    """Whether a press of a model may take longer than others are to wait."""
    return is_curve_slow(catalogue[name], joint)


_solved: OrderedDict[Key, tuple[Solved, bool]] = OrderedDict()
"""What is known of heavy presses, and whether that is all: a contact comes before its curve."""


def solved(file: JointFile, name: str) -> Solved | None:
    """What is known of a heavy press; None before it was asked for."""
    return _solved.get(_key(file, name), (None, False))[0]


def _unfinished(file: JointFile, names: Iterable[str]) -> tuple[str, ...]:
    return tuple(
        name for name in names if heavy(file.joint, name) and not _solved.get(_key(file, name), ("", False))[1]
    )


def _key(file: JointFile, name: str) -> Key:
    return file.joint, file.cup, tuple(file.load.items()), name


def _keep(file: JointFile, name: str, found: Solved, whole: bool) -> None:
    _solved[_key(file, name)] = found, whole
    while len(_solved) > _KEPT:
        _solved.popitem(last=False)


def solve(file: JointFile, names: Sequence[str], told: Told) -> None:
    """In a process: tells each name with what its model says in plain numbers, and if that is all: curves follow."""
    contacts = {}
    for name in names:
        found = _contact(file, name)
        if isinstance(found, WrittenContact) and float(found.half_angle) > 0:
            contacts[name] = found
        told((name, found, name not in contacts))
    for name, contact in contacts.items():
        told((name, replace(contact, curve=written(press_short_curve(contact, catalogue[name]))), True))


def _contact(file: JointFile, name: str) -> Solved:
    try:
        return written(catalogue[name].in_cup(file.cup).press(file.joint, **file.load))
    except OutsideDomainError as error:
        return str(error)


class Errand:
    """The heavy presses of one page: at most one process, for what is on the screen now.

    Parameters
    ----------
    changed : callable
        Told when something has been solved, or will not be.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._for: tuple[JointFile, tuple[str, ...]] | None = None
        self._run: Run | None = None
        self._asking: Any = None

    def ask(self, files: Iterable[JointFile], names: tuple[str, ...]) -> None:
        """See to it that all of these become known, one joint after the other."""
        wanted = next(((file, some) for file in files if (some := _unfinished(file, names))), None)
        if wanted == self._for:
            return
        self.leave()
        if wanted is not None:
            self._for, self._run = wanted, Run(partial(solve, *wanted), longest=LONGEST)
            self._asking = pn.state.add_periodic_callback(self.hear, period=_EVERY)

    def hear(self) -> None:
        """Ask for news; the first time the process is started."""
        if self._run is None or self._for is None:
            return
        if not looked_at():
            self.leave()
            return
        file, names = self._for
        news = self._run.news()
        if isinstance(news, tuple):
            _keep(file, *news)
            self._for = file, _unfinished(file, names)
            self._changed()
        elif isinstance(news, RunRefused):
            for name in names:
                _keep(file, name, solved(file, name) or f"{name} has no answer here: {news.why}", True)
            self.leave()
            self._changed()
        elif isinstance(news, Done):
            self.leave()
            self._changed()

    def leave(self) -> None:
        """End what is running."""
        if self._asking is not None:
            self._asking.stop()
        if self._run is not None:
            self._run.stop()
        self._for = self._run = self._asking = None
