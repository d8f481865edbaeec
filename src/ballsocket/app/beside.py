"""Drawings, files and maps: made in a thread beside the server, so that others' pages are answered meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import panel as pn
from tornado.ioloop import IOLoop

_DRAWING = ThreadPoolExecutor(max_workers=1, thread_name_prefix="drawing")
"""One at a time: they share what a figure is drawn with, and leave the other core to the pages."""


def beside(work: Callable[[], Any], then: Callable[[Future[Any]], None]) -> None:
    """Do some work, and tell the page of this moment when it is done; without a page it is done at once.

    Parameters
    ----------
    work : callable
        It touches nothing that the page touches.
    then : callable
        Told the outcome, in the server's own thread; never, if the page has been closed meanwhile.
    """
    document = pn.state.curdoc
    context = None if document is None else document.session_context
    if context is None:
        then(_done(work))
        return
    loop = IOLoop.current()

    def tell(future: Future[Any]) -> None:
        if not context.destroyed:
            document.add_next_tick_callback(lambda: then(future))

    _DRAWING.submit(work).add_done_callback(lambda future: loop.add_callback(tell, future))


def _done(work: Callable[[], Any]) -> Future[Any]:
    future: Future[Any] = Future()
    try:
        future.set_result(work())
    except Exception as error:
        future.set_exception(error)
    return future
