"""Evidence: a question about the joint on the screen, gathered while one looks, as a pack to hand in."""

from __future__ import annotations

import tempfile
from base64 import b64encode
from collections.abc import Hashable
from dataclasses import fields, replace
from functools import partial
from typing import Any

from ....core.checks import check_names, shown
from ....evidence.matrix import title_of
from ....reports.evidence_parts import case_text, value_text
from ....reports.pages import items, table
from ...jobs import ViewJob
from ...running import CachedRun
from ...state.evidence_question import EvidenceQuestion
from ...state.screen import Screen
from ...view import Document, Host, View
from ...widgets.fields import Field, segments, words
from ...widgets.words import alert, progress
from .worker import EVIDENCE_SECONDS, EvidencePack, count_cases, gather_pack

_PACKS: CachedRun = CachedRun(max_size=8)
_LEVELS, _YES = (("low", "low"), ("medium", "medium"), ("high", "high")), (("no", "no"), ("yes", "yes"))
_NAMES = tuple(entry.name for entry in fields(EvidenceQuestion))


class Evidence(View):
    """View that gathers evidence for a question and resumes after a stop."""

    title = "Evidence"
    body = f"""
<div class="asking">{"".join(f'<div data-field="evidence.{name}"></div>' for name in _NAMES)}</div>
<div id="evidence-said" role="status"></div>
<p><button type="button" class="plain" data-tell="evidence.run">Gather the evidence</button></p>
<div id="evidence-trouble" role="alert"></div>
<div id="evidence-progress" role="status"></div>
<div id="evidence-found"></div>
"""

    def __init__(self, page: Host) -> None:
        self._page, self._screen = page, page.screen
        self._job = ViewJob(page.channel, "evidence", self._store_result, longest=EVIDENCE_SECONDS)
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        page.listen("evidence", self._edited)

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._job.put("trouble", "")
        self._page.channel.put_fields(_fields(screen.asked))
        self._job.put("said", _case_count(screen))
        self._put_found()

    @property
    def _key(self) -> Hashable:
        return _key(self._screen)

    def _put_found(self) -> None:
        pack: EvidencePack | None = _PACKS.get(self._key)
        self._job.put("found", "" if pack is None else _pack_html(pack))

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
        count_cases(screen.asked, screen.file, screen.use)  # or it is refused here and now
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="ballsocket-")
        self._job.put("trouble", "")
        self._job.ask(self._key, partial(gather_pack, screen.asked, screen.file, screen.use, self._folder.name))

    def _take(self) -> None:
        pack: EvidencePack | None = _PACKS.get(self._key)
        if pack is None:
            raise ValueError("there is no pack of this yet: gather the evidence first")
        content = b64encode(pack.content).decode("ascii")
        self._page.channel.once("file", {"name": "evidence.zip", "content": content})

    def _store_result(self, key: Hashable, pack: EvidencePack) -> None:
        _PACKS.put(key, pack)
        self._put_found()

    def document(self, screen: Screen) -> Document:
        pack: EvidencePack | None = _PACKS.get(_key(screen))
        if pack is None:
            raise ValueError("there is no evidence of this yet: gather it first")
        heads, rows = _worst(pack)
        return Document(
            rows=lambda: [heads, *rows],
            sections=lambda: {"evidence": ("Evidence", items(pack.conclusions) + table(heads, rows))},
        )

    def leave(self) -> None:
        self._job.stop()
        if self._folder is not None:
            self._folder.cleanup()


def _key(screen: Screen) -> Hashable:
    """Return a key of the inputs of a pack."""
    use = replace(screen.use, instant=None) if screen.asked.wear == "yes" else None
    return screen.asked, screen.file.joint, screen.file.cup, screen.file.cup.oriented, use


def _fields(question: EvidenceQuestion) -> dict[str, Field]:
    inputs = [
        words("evidence.question", "What is to be decided", question.question, 2),
        words("evidence.context", "What the answer is used for, and for what not", question.context, 2),
        segments("evidence.influence", "Influence of the model on the decision", _LEVELS, question.influence),
        segments("evidence.consequence", "Consequence of a wrong decision", _LEVELS, question.consequence),
        words("evidence.accuracy", "How far off the numbers may be", question.accuracy),
        words("evidence.limits", "Limits, with ; between", question.limits),
        words("evidence.matrix", "Cases: force = 2, 3 kN; clearance = 0.05, 0.1 mm", question.matrix),
        words("evidence.tolerances", "Tolerances: clearance = 0.1 +- 0.02 mm", question.tolerances),
        words("evidence.friction", "Coefficient of friction, if any", question.friction),
        segments("evidence.elements", "Finite elements judge the worst cases", _YES, question.elements),
        segments("evidence.wear", "With the wear of the view Wear", _YES, question.wear),
    ]
    return {field["name"]: field for field in inputs}


def _changed(question: EvidenceQuestion, key: str, value: Any) -> EvidenceQuestion:
    check_names([key], _NAMES, "among the inputs of a question")
    if not isinstance(value, str):
        raise ValueError(f"{key} = {shown(value)} must be text")
    changes: dict[str, Any] = {key: value.strip()}
    return replace(question, **changes)


def _case_count(screen: Screen) -> str:
    """State the number of cases, or the error in the question."""
    try:
        number = count_cases(screen.asked, screen.file, screen.use)
    except ValueError as error:
        return alert(str(error).removeprefix("question.toml: "))
    return (
        f"<p class='quiet'>{number} case{'s' if number > 1 else ''}. A pack takes some seconds, with wear minutes.</p>"
    )


def _pack_html(pack: EvidencePack) -> str:
    take = "<p><button type='button' class='plain' data-tell='evidence.take'>Take the pack (ZIP)</button></p>"
    return f"{items(pack.conclusions)}{table(*_worst(pack), kind='words')}{take}"


def _worst(pack: EvidencePack) -> tuple[list[str], list[list[str]]]:
    """Tabulate the worst case of each quantity."""
    worst = pack.record["worst"].items()
    rows = [[title_of(name), value_text(name, row), case_text(row["case"])] for name, row in worst]
    return ["worst", "value", "case"], rows
