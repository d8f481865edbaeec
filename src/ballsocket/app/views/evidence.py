"""Evidence: a question about the joint on the screen, gathered while one looks, as a pack to hand in."""

from __future__ import annotations

import tempfile
from base64 import b64encode
from collections.abc import Hashable
from dataclasses import fields, replace
from functools import partial
from typing import Any

from ...core.checks import check_names, shown
from ...evidence.matrix import title_of
from ...files.joint_file import JointFile
from ...reports.evidence_parts import case_text, value_text
from ...reports.pages import items, table
from ..asked import Asked
from ..evidencing import LONGEST, Packed, cases_of, packed
from ..fields import Field, segments, words
from ..jobs import CachedRun, ViewJob
from ..screen import Screen
from ..view import Document, Host
from ..words import alert, progress

_FOUND: CachedRun = CachedRun(most=8)
_LEVELS, _YES = (("low", "low"), ("medium", "medium"), ("high", "high")), (("no", "no"), ("yes", "yes"))
_NAMES = tuple(each.name for each in fields(Asked))


class Evidence:
    """The question is read as it is typed; it runs when asked, and goes on where it was stopped."""

    title = "Evidence"
    panel = None
    body = f"""
<div class="asking">{"".join(f'<div data-field="evidence.{name}"></div>' for name in _NAMES)}</div>
<div id="evidence-said" role="status"></div>
<p><button type="button" class="plain" data-tell="evidence.run">Gather the evidence</button></p>
<div id="evidence-trouble" role="alert"></div>
<div id="evidence-progress" role="status"></div>
<div id="evidence-found"></div>
"""

    def __init__(self, host: Host) -> None:
        self._page, self._screen = host, host.screen
        self._job = ViewJob(host.channel, "evidence", self._done, longest=LONGEST)
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        host.listen("evidence", self._edited)

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._job.put("trouble", "")
        self._page.channel.put_fields(_fields(screen.asked))
        self._job.put("said", _said(screen))
        self._put_found()

    @property
    def _key(self) -> Hashable:
        return _key(self._screen)

    def _put_found(self) -> None:
        found: Packed | None = _FOUND.get(self._key)
        self._job.put("found", "" if found is None else _told(found))

    def _edited(self, key: str, value: Any) -> None:
        if key == "run":
            self._run()
        elif key == "stop":
            self._job.stop()
            self._job.put("progress", progress("Stopped. What is done is kept.", None, again="evidence.run"))
        elif key == "take":
            self._take()
        else:
            self._page.ask(asked=_changed(self._screen.asked, key, value))

    def _run(self) -> None:
        screen = self._screen
        cases_of(screen.asked, screen.file, screen.use)  # or it is refused here and now
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="ballsocket-")
        self._job.put("trouble", "")
        self._job.ask(self._key, partial(packed, screen.asked, screen.file, screen.use, self._folder.name))

    def _take(self) -> None:
        found: Packed | None = _FOUND.get(self._key)
        if found is None:
            raise ValueError("there is no pack of this yet: gather the evidence first")
        content = b64encode(found.content).decode("ascii")
        self._page.channel.once("file", {"name": "evidence.zip", "content": content})

    def _done(self, key: Hashable, found: Packed) -> None:
        _FOUND.put(key, found)
        self._put_found()

    def document(self, screen: Screen) -> Document:
        found: Packed | None = _FOUND.get(_key(screen))
        if found is None:
            raise ValueError("there is no evidence of this yet: gather it first")
        heads, rows = _worst(found)
        return Document(
            rows=lambda: [heads, *rows],
            sections=lambda: {"evidence": ("Evidence", items(found.conclusions) + table(heads, rows))},
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        return [], ()

    def leave(self) -> None:
        self._job.stop()
        if self._folder is not None:
            self._folder.cleanup()


def _key(screen: Screen) -> Hashable:
    """What a pack depends on."""
    use = replace(screen.use, instant=None) if screen.asked.wear == "yes" else None
    return screen.asked, screen.file.joint, screen.file.cup, screen.file.cup.oriented, use


def _fields(asked: Asked) -> dict[str, Field]:
    inputs = [
        words("evidence.question", "What is to be decided", asked.question, 2),
        words("evidence.context", "What the answer is used for, and for what not", asked.context, 2),
        segments("evidence.influence", "Influence of the model on the decision", _LEVELS, asked.influence),
        segments("evidence.consequence", "Consequence of a wrong decision", _LEVELS, asked.consequence),
        words("evidence.accuracy", "How far off the numbers may be", asked.accuracy),
        words("evidence.limits", "Limits, with ; between", asked.limits),
        words("evidence.matrix", "Cases: force = 2, 3 kN; clearance = 0.05, 0.1 mm", asked.matrix),
        words("evidence.tolerances", "Tolerances: clearance = 0.1 +- 0.02 mm", asked.tolerances),
        words("evidence.friction", "Coefficient of friction, if any", asked.friction),
        segments("evidence.elements", "Finite elements judge the worst cases", _YES, asked.elements),
        segments("evidence.wear", "With the wear of the view Wear", _YES, asked.wear),
    ]
    return {field["name"]: field for field in inputs}


def _changed(asked: Asked, key: str, value: Any) -> Asked:
    check_names([key], _NAMES, "among the inputs of a question")
    if not isinstance(value, str):
        raise ValueError(f"{key} = {shown(value)} must be text")
    changes: dict[str, Any] = {key: value.strip()}
    return replace(asked, **changes)


def _said(screen: Screen) -> str:
    """How many cases there are, or what is wrong with the question."""
    try:
        number = cases_of(screen.asked, screen.file, screen.use)
    except ValueError as error:
        return alert(str(error).removeprefix("question.toml: "))
    return (
        f"<p class='quiet'>{number} case{'s' if number > 1 else ''}. A pack takes some seconds, with wear minutes.</p>"
    )


def _told(found: Packed) -> str:
    take = "<p><button type='button' class='plain' data-tell='evidence.take'>Take the pack (ZIP)</button></p>"
    return f"{items(found.conclusions)}{table(*_worst(found), kind='words')}{take}"


def _worst(found: Packed) -> tuple[list[str], list[list[str]]]:
    """The case in which each number is worst."""
    worst = found.record["worst"].items()
    rows = [[title_of(name), value_text(name, row), case_text(row["case"])] for name, row in worst]
    return ["worst", "value", "case"], rows
