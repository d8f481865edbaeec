"""Views whose results take long: a button, its progress, and results that outlive a change of the inputs."""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from . import results
from .jobs import Job, call_later
from .running import MAX_SECONDS, PREPARE_AFTER, WORKERS, Reached, RunFinished, RunRefused, Work
from .state.screen import Screen
from .view import View
from .widgets.words import alert

if TYPE_CHECKING:
    from .session import Page

_EARLIER = "<p class='earlier'>These results belong to earlier inputs.</p>"


def long_body(view: str, shown: str, more_inputs: str = "") -> str:
    """Return the HTML of a view with its inputs, the button of its work, and the HTML of its results."""
    return (
        f'<div class="inputs-row" id="{view}-inputs">{more_inputs}</div><div data-field="{view}.run"></div>'
        f'<div id="{view}-trouble" role="alert"></div><div id="{view}-earlier" role="status"></div>'
        f'<div class="results">{shown}</div>'
    )


@dataclass(eq=False)
class LongWork:
    """Long work of a view with its button, a field of kind `run` that is named "<name>.run"."""

    page: Page
    name: str  # also of the elements "<name>-trouble" and "<name>-earlier"
    label: str  # words on the button
    question_of: Callable[[Screen], Hashable]  # equal keys of one `kind` have one result on all pages
    work: Callable[[Screen], Work]  # raises ValueError if the inputs of a screen allow none
    show_result: Callable[[Screen, Any], None]  # shows the result for a screen; None clears it
    automatic: bool = False  # starts without a click after each change, not only for the first result
    longest: float = MAX_SECONDS  # s
    kind: str = ""  # of the result, by default the name
    _shown: Any = field(default=None, init=False)
    _cancelled: Hashable = field(default=None, init=False)
    _refusal: str = field(default="", init=False)
    _start: float = field(default=0.0, init=False)
    unseen: bool = field(default=False, init=False)  # True for a result that came while another view was open

    def __post_init__(self) -> None:
        call_later(PREPARE_AFTER, WORKERS.prepare)
        self._job = Job(lambda key, news: self.page.attempt(partial(self._hear, key, news)), self.longest)

    @property
    def runs(self) -> bool:
        return self._job.works

    def show(self, screen: Screen) -> None:
        """Show the stored result for a screen, or that of an earlier screen with a mark."""
        question, result = self._key(screen), self.result(screen)
        self._put("trouble", self._refusal if question == self._cancelled else "")
        if result is not None:
            self._shown = result
        self._put("earlier", _EARLIER if result is None and self._shown is not None else "")
        self.show_result(screen, self._shown)
        if self.automatic and result is not None:
            self._job.stop()
        elif (self.automatic or self._shown is None) and question != self._cancelled:
            self.run()
        if not self._job.works:
            self.put_button(hidden=result is not None)

    def result(self, screen: Screen) -> Any:
        """Return the result for a screen; None without one."""
        return results.RESULTS.get(self._key(screen))

    def click(self, starts: Any) -> None:
        """Start the work, or cancel it; nothing that was shown is lost."""
        if starts:
            self.run()
        else:
            self._job.stop()
            self._cancelled, self._refusal = self._key(self.page.screen), ""
            self.put_button(words="Cancelled.")

    def run(self) -> None:
        """Start the work for the screen, unless its result is stored."""
        screen = self.page.screen
        self._put("trouble", "")
        self._cancelled, self._refusal = None, ""
        if self.result(screen) is not None:
            return
        try:
            work = self.work(screen)
        except ValueError as error:
            self._put("trouble", alert(str(error)))
            self.put_button()
            return
        self._start = time.monotonic()
        self.put_button(share=0.0, words="starting")
        self._job.ask(self._key(screen), work)

    def _key(self, screen: Screen) -> Hashable:
        return self.kind or self.name, self.question_of(screen)

    def _put(self, element: str, html: str) -> None:
        self.page.channel.put(f"#{self.name}-{element}", html)

    def put_button(self, share: float | None = None, words: str = "", hidden: bool = False) -> None:
        """Show the button with the progress from 0 to 1; None while nothing runs."""
        name = f"{self.name}.run"
        state = {"share": share, "words": words, "hidden": hidden}
        self.page.channel.put_fields({name: {"name": name, "kind": "run", "label": self.label, **state}})

    def _hear(self, question: Hashable, news: Any) -> None:
        if isinstance(news, Reached):
            elapsed = time.monotonic() - self._start
            left = elapsed * (1.0 - news.share) / news.share if news.share > 0.05 else 0.0
            known = elapsed >= 1.0 and left >= 1.0
            self.put_button(news.share, f"{news.words}, about {left:.0f} s left" if known else news.words)
        elif isinstance(news, RunRefused):
            self._cancelled, self._refusal = question, alert(news.why)
            self._put("trouble", self._refusal)
            self.put_button()
        elif isinstance(news, RunFinished):
            results.RESULTS.put(question, news.value)
            call_later(PREPARE_AFTER, WORKERS.prepare)
            self._shown = news.value
            self.show(self.page.screen)
            self.unseen = True

    def leave(self) -> None:
        self._job.stop()


class LongView(View):
    """View whose result takes long; the first comes by itself, later ones on a click unless it is `automatic`.

    A subclass has the words of its button `run_label`, and a `body` of `long_body`.
    """

    run_label = "Run"
    automatic = False
    longest = MAX_SECONDS
    result_kind = ""

    def begin(self) -> None:
        hooks = self.question_of, self.work, self.show_result
        kind = self.automatic, self.longest, self.result_kind
        self.long = self.add(LongWork(self.page, self.name, self.run_label, *hooks, *kind))

    @abstractmethod
    def question_of(self, screen: Screen) -> Hashable:
        """Return what the result depends on: numbers and choices, no names and no units."""

    @abstractmethod
    def work(self, screen: Screen) -> Work:
        """Return the work for a screen; raise ValueError if the inputs allow none."""

    @abstractmethod
    def show_result(self, screen: Screen, result: Any) -> None:
        """Show a result, which may belong to an earlier screen; None clears it."""

    def show(self, screen: Screen) -> None:
        self.long.show(screen)

    def result(self, screen: Screen) -> Any:
        """Return the result for a file; raise ValueError without one."""
        result = self.long.result(screen)
        if result is None:
            raise ValueError(f"there is no result for this design yet: press {self.run_label!r} first")
        return result
