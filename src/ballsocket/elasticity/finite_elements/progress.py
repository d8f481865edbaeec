"""What is being done, told to whoever wants to hear it while it lasts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar


def _silent(_: str) -> None: ...


_LISTENER: ContextVar[Callable[[str], None]] = ContextVar("listener", default=_silent)


def report_progress(text: str) -> None:
    """Say what is about to be done."""
    _LISTENER.get()(text)


@contextmanager
def progress_to(listener: Callable[[str], None]) -> Iterator[None]:
    """Inside, finite elements report_progress the listener in words what they are about to do."""
    token = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(token)
