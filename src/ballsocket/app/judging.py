"""Finite elements in a process of their own: with progress, a stop, and limits on time and memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from ..catalogue import judge, reference
from ..contact import Contact
from ..describe import summary
from ..engines.local import available_cores, one_thread_each
from ..fem.contact import MeshedContact
from ..io.joint_file import JointFile
from ..output.html import drawn
from ..output.section_plot import section_figure
from ..validity import OutsideDomainError

LONGEST = 60.0
"""Seconds that a run may take."""

MEMORY = 4_000_000_000
"""Bytes that its process may ask for."""

_SHARES = (0.25, 0.5, 0.75, 1.0)


class Line:
    """Runs in the order in which they came; so many of the first are at work."""

    def __init__(self, places: int) -> None:
        self._places = places
        self._runs: list[Run] = []

    def __len__(self) -> int:
        return len(self._runs)

    def turn(self, run: Run) -> bool:
        """Whether it may work; who is not in line stands behind the others."""
        if run not in self._runs:
            self._runs.append(run)
        return self._runs.index(run) < self._places

    def leave(self, run: Run) -> None:
        """Make room."""
        if run in self._runs:
            self._runs.remove(run)


LINE = Line(max(1, available_cores()))
"""As many runs at once as there are cores, whoever asks."""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What finite elements say: numbers as for JSON, beside the exact ones, and a picture as PNG and SVG."""

    numbers: dict[str, Any]
    error: dict[str, float]
    exact: dict[str, Any] | None
    elements: int
    seconds: float
    notes: tuple[str, ...]
    png: bytes
    svg: bytes


@dataclass(frozen=True, kw_only=True)
class Reached:
    """How far a run is: `share` from 0 to 1, and in words what is done now."""

    share: float
    words: str


@dataclass(frozen=True, kw_only=True)
class Refused:
    """Why there is no answer, in one sentence."""

    why: str


@dataclass(eq=False)
class Run:
    """One run. Ask `news` now and then; it waits for a free place first, and is killed when it takes too long.

    Parameters
    ----------
    file : JointFile
        With a load.
    longest : float
        Seconds it may take.
    """

    file: JointFile
    longest: float = LONGEST
    _process: Any = field(default=None, init=False)
    _pipe: Connection | None = field(default=None, init=False)
    _start: float = field(default=0.0, init=False)

    def news(self) -> Reached | Judged | Refused | None:
        """What has happened since it was last asked; None if nothing. The last is `Judged` or `Refused`."""
        if self._process is None:
            if not LINE.turn(self):
                return Reached(share=0.0, words="waiting for a free place: others are running")
            try:
                self._begin()
            except OSError as error:
                self.stop()
                return Refused(why=f"no process could be started: {error.strerror or error}")
        assert self._pipe is not None
        if self._pipe.poll():
            try:
                found: Reached | Judged | Refused = self._pipe.recv()
            except EOFError:
                found = Refused(why="the process of the finite elements died; it may have had too little memory")
            if not isinstance(found, Reached):
                self.stop()
            return found
        if time.monotonic() - self._start > self.longest:
            self.stop()
            return Refused(why=f"stopped after {self.longest:g} s, the longest that a run may take here")
        return None

    def _begin(self) -> None:
        context = get_context("spawn")
        pipe, there = context.Pipe(duplex=False)
        process = context.Process(target=_judge, args=(there, self.file), daemon=True)
        with one_thread_each():
            process.start()
        there.close()
        self._process, self._pipe, self._start = process, pipe, time.monotonic()

    def stop(self) -> None:
        """End it, wherever it is, and give its place to the next."""
        LINE.leave(self)
        if self._process is not None:
            self._process.kill()
            self._process.join()
        if self._pipe is not None:
            self._pipe.close()


def _judge(pipe: Connection, file: JointFile) -> None:
    """In the process: presses on to the load in steps, then draws."""
    _limit_memory()
    try:
        pipe.send(_judged(file, lambda share, words: pipe.send(Reached(share=share, words=words))))
    except (ValueError, OutsideDomainError, ImportError) as error:
        pipe.send(Refused(why=str(error)))
    except MemoryError:
        pipe.send(Refused(why=f"this mesh takes more than {MEMORY / 1e9:g} GB, the most that a run may have here"))


def _limit_memory() -> None:
    try:
        import resource
    except ImportError:  # no such limits on this system: only the time is limited
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def _judged(file: JointFile, told: Callable[[float, str], None]) -> Judged | Refused:
    start = time.perf_counter()
    model = judge.in_cup(file.cup)
    ((kind, load),) = file.load.items()
    told(0.05, "making the meshes")
    for share in _SHARES:
        contact = model.press(file.joint, **{kind: share * load})
        told(0.05 + 0.75 * share, f"pressed to {100 * share:g} % of the load")
    if contact.status.failed:
        return Refused(why=f"the finite elements have no answer: {contact.status.sentence}")
    assert isinstance(contact, MeshedContact)
    exact = _exact(file)
    told(0.85, "drawing stresses")
    figure = section_figure(contact, exact)
    return Judged(
        numbers=summary(contact),
        error={name: float(value) for name, value in contact.error.items()},
        exact=None if exact is None else summary(exact),
        elements=contact.mesh.elements,
        seconds=time.perf_counter() - start,
        notes=tuple(contact.notes),
        png=drawn(figure),
        svg=drawn(figure, "svg"),
    )


def _exact(file: JointFile) -> Contact | None:
    try:
        contact = reference.press(file.joint, **file.load)
    except OutsideDomainError:
        return None
    return None if contact.status.failed else contact
