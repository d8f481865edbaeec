"""Progress messages of long finite element calculations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_CALLBACK: ContextVar[Callable[[str], object]] = ContextVar("progress_callback", default=str)
"""Function that takes each message; `str` ignores it."""


def report_progress(text: str) -> None:
    """Report the next step of a calculation."""
    _CALLBACK.get()(text)


@contextmanager
def progress_to(callback: Callable[[str], None]) -> Iterator[None]:
    """Call a function with each progress message within the context."""
    token = _CALLBACK.set(callback)
    try:
        yield
    finally:
        _CALLBACK.reset(token)
