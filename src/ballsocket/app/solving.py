"""Slow presses, solved in a separate process while the page stays usable."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any

from ..comparison import is_curve_slow, press_short_curve
from ..contact import Contact
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..model_catalogue import catalogue
from ..problem import Joint
from ..problem.cup import Cup
from . import results
from .jobs import Job
from .running import Report, RunFinished, RunRefused

PRESS_SECONDS = 20.0  # processor time in s of one press, and of one curve
Named = tuple[tuple[str, Any], ...]  # values by name


def heavy(joint: Joint, name: str) -> bool:
    """Return True if a press of a model is slow."""
    return is_curve_slow(catalogue[name], joint)


def solved(file: JointFile, name: str) -> Contact | str | None:
    """Return the contact of a slow press or the reason for its absence; None before it is solved."""
    result: Contact | str | None = results.RESULTS.get(_press_call(file, name))
    return result


def solved_curve(contact: Contact) -> Contact | None:
    """Return the curve of the contact of a slow press; None before it is solved, or without one."""
    curve = results.RESULTS.get(_curve_call(contact))
    return curve if isinstance(curve, Contact) else None


def _press_call(file: JointFile, name: str) -> tuple[Any, ...]:
    """Return the function of a slow press and its arguments, which are also the key of its result."""
    return _press, name, file.joint, file.cup, tuple(file.load.items()), tuple(file.aim.items())


def _press(name: str, joint: Joint, cup: Cup, load: Named, aim: Named, report: Report) -> Contact | str:
    """Press one model; the contact carries the slow numbers that a page shows."""
    try:
        contact = catalogue[name].in_cup(cup, **dict(aim)).press(joint, **dict(load))
    except OutsideDomainError as error:
        return str(error)
    if not contact.status.failed:
        _ = contact.notes, contact.valid, contact.von_mises, contact.energy, contact.stiffness
    return contact


def _curve_call(contact: Contact) -> tuple[Any, ...]:
    return _press_curve, contact.model.name, contact


def _press_curve(name: str, contact: Contact, report: Report) -> Contact:
    return press_short_curve(contact, catalogue[name])


def _missing(files: Iterable[JointFile], names: Iterable[str]) -> Iterator[tuple[Any, ...]]:
    """Yield the calls without a result: of all presses, then of the curves of those that have a contact."""
    calls = [_press_call(file, name) for file in files for name in names if heavy(file.joint, name)]
    contacts = [results.RESULTS.get(call) for call in calls]
    yield from (call for call, contact in zip(calls, contacts, strict=True) if contact is None)
    for contact in contacts:
        if isinstance(contact, Contact) and float(contact.half_angle) > 0:
            call = _curve_call(contact)
            if results.RESULTS.get(call) is None:
                yield call


class SlowPresses:
    """Slow presses of one page, one at a time in a process; `changed` is called after each."""

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self.job = Job(self._store_result, PRESS_SECONDS)

    def ask(self, files: Iterable[JointFile], names: tuple[str, ...]) -> None:
        """Start the first press or curve of these files that has no result; stop one that is no longer needed."""
        call = next(_missing(files, names), None)
        if call is None:
            self.leave()
        else:
            function, *arguments = call
            self.job.ask(call, partial(function, *arguments))

    def _store_result(self, call: Any, news: Any) -> None:
        if isinstance(news, RunFinished):
            results.RESULTS.put(call, news.value)
        elif isinstance(news, RunRefused):
            _, name, *_ = call
            results.RESULTS.put(call, f"{name} has no result here: {news.why}")
        else:
            return
        self._changed()

    def leave(self) -> None:
        self.job.stop()
