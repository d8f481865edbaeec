"""Evidence: a question about the joint on the screen, gathered while one looks, as a pack to hand in."""

from __future__ import annotations

import tempfile
from base64 import b64encode
from collections.abc import Hashable, Mapping
from dataclasses import fields, replace
from functools import partial
from html import escape
from math import prod
from typing import Any

from ....contact.verdict import Verdict
from ....evidence.matrix import limit_text, title_of, verdict_text
from ....evidence.question import LEVELS
from ....model_catalogue import reference
from ....reports.evidence_parts import case_text, value_text
from ....reports.pages import items, table
from ....studies.expressions import parse_limit
from ....studies.limits import Limit
from ....studies.parameters import PARAMETERS
from ...long_view import LongView, long_body
from ...pressing import pressed
from ...running import Work
from ...state.evidence_question import EvidenceQuestion
from ...state.screen import Screen, phrases_of
from ...view import Document, Host, field_places
from ...widgets.fields import segments
from ...widgets.limit_rows import LimitRows, present_value
from ...widgets.settings import chosen, text
from ...widgets.words import VERDICT_KINDS, alert
from .worker import EVIDENCE_SECONDS, EvidencePack, axes_of, gather_pack, phrases_in

_NO_YES = ("no", "yes")
_INPUTS = field_places("evidence", (entry.name for entry in fields(EvidenceQuestion)))
_LIMITED = ("max_pressure", "half_angle", "edge_distance", "indentation", "area", "utilisation")
_NO_LIMIT = "Evidence needs a limit to decide on: add one, such as the largest pressure at most 20 MPa"


class Evidence(LongView):
    """View that gathers evidence for a question and resumes after a stop."""

    settings = (
        text("asked.question", "Decision", 2),
        text("asked.context", "Context: what the result is for, and not for", 2),
        chosen("asked.influence", "Influence of the model on the decision", LEVELS, segments),
        chosen("asked.consequence", "Consequence of a wrong decision", LEVELS, segments),
        text("asked.accuracy", "Allowed error of the numbers"),
        text("asked.matrix", "Cases, such as force = 2, 3 kN"),
        text("asked.tolerances", "Tolerances, such as clearance = 0.1 +- 0.02 mm"),
        text("asked.friction", "Coefficient of friction, if any"),
        chosen("asked.elements", "Check the worst cases by finite elements", _NO_YES, segments),
        chosen("asked.wear", "Include the wear of the view Wear", _NO_YES, segments),
    )
    title, name, run_label, longest = "Evidence", "evidence", "Gather the evidence", EVIDENCE_SECONDS
    body = long_body("evidence", _INPUTS, '<div id="evidence-found"></div>').replace("inputs-row", "asking")

    def __init__(self, page: Host) -> None:
        super().__init__(page)
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._rows = LimitRows("evidence.limits", _LIMITED)

    def question_of(self, screen: Screen) -> Hashable:
        use = replace(screen.use, instant=None) if screen.asked.wear == "yes" else None
        return screen.asked, screen.file.joint, screen.file.cup, screen.file.cup.oriented, use

    def work(self, screen: Screen) -> Work:
        axes_of(screen.asked, screen.file, screen.use)  # an invalid question is refused at once
        if not screen.asked.limits.strip():
            raise ValueError(_NO_LIMIT)
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="ballsocket-")
        return partial(gather_pack, screen.asked, screen.file, screen.use, self._folder.name)

    def show_inputs(self, screen: Screen) -> None:
        limits = self._rows.field(_limits(screen.asked), screen.reading)
        self.channel.put_fields({**self.fields(screen), "evidence.limits": limits})

    def show_result(self, screen: Screen, result: EvidencePack | None) -> None:
        self.put(found=_case_table(screen) if result is None else _pack_html(result))

    def edit(self, key: str, value: Any) -> None:
        screen = self.page.screen
        if key == "take":
            content = b64encode(self.result(screen).content).decode("ascii")
            self.channel.once("file", {"name": "evidence.zip", "content": content})
        elif key == "allowable":
            self.page.ask(asked=replace(screen.asked, limits=_allowable_limit(screen)))
        elif key == "limits":
            self._edit_limits(value)
        else:
            super().edit(key, value)

    def _edit_limits(self, value: Any) -> None:
        """Take the rows of limits, or show which row is wrong."""
        screen = self.page.screen
        contact = pressed(screen.file, (reference.name,)).contacts.get(reference.name)
        present = partial(present_value, screen.file, contact=contact)
        limits = self._rows.read(value, _limits(screen.asked), screen.reading, present)
        self.show_inputs(screen)
        if limits is not None:
            phrases = "; ".join(phrase for limit in limits for phrase in phrases_of(limit))
            self.page.ask(asked=replace(screen.asked, limits=phrases))

    def document(self, screen: Screen) -> Document:
        pack: EvidencePack = self.result(screen)
        heads, rows = _worst(pack)
        return Document(
            rows=lambda: [heads, *rows],
            sections=lambda: {"evidence": ("Evidence", items(pack.conclusions) + table(heads, rows))},
        )

    def leave(self) -> None:
        super().leave()
        if self._folder is not None:
            self._folder.cleanup()


def _allowable_limit(screen: Screen) -> str:
    pressure = screen.file.joint.liner.allowable_pressure
    if pressure is None:
        raise ValueError("the liner has no allowable pressure: enter it beside the liner")
    return f"max_pressure <= {float(pressure):g} MPa"


def _limits(question: EvidenceQuestion) -> tuple[Limit, ...]:
    """Read the limits of a question; none if a link has others than limits."""
    try:
        return tuple(map(parse_limit, phrases_in(question.limits)))
    except ValueError:
        return ()


def _case_table(screen: Screen) -> str:
    """List the cases of the question, or the error in it, before there is a result."""
    try:
        axes = axes_of(screen.asked, screen.file, screen.use)
    except ValueError as error:
        return alert(str(error).removeprefix("question.toml: "))
    number = prod(map(len, axes.values()))
    rows = [
        [PARAMETERS[name].title, ", ".join(screen.reading.with_unit(PARAMETERS[name], value) for value in values)]
        for name, values in axes.items()
    ]
    offer = "" if screen.asked.limits.strip() else _OFFER
    heads = ["1 case" if number == 1 else f"{number} cases", "values"]
    return f"{offer}{table(heads, rows, 'text')}{_CONTENTS}"


_OFFER = (
    "<p class='trust no'>✗ No limit is stated. "
    "<button type='button' class='plain' data-tell='evidence.allowable'>Use the liner's allowable pressure</button>"
    "</p>"
)
_CONTENTS = (
    "<p class='quiet'>The pack has a page with the decision on each limit, the worst cases and their figures, all "
    "numbers as JSON, the question and checksums. It takes some seconds, with wear minutes.</p>"
)


def _pack_html(pack: EvidencePack) -> str:
    """Return the decisions on the limits, failures first, then the other conclusions and the worst cases."""
    take = "<p><button type='button' class='plain' data-tell='evidence.take'>Download the pack (ZIP)</button></p>"
    limits = pack.record["limits"]
    decided = "".join(_decision(limit) for limit in sorted(limits, key=_verdict, reverse=True))
    return f"{decided}{items(pack.conclusions[len(limits) :])}{table(*_worst(pack), kind='words')}{take}"


def _verdict(limit: Mapping[str, Any]) -> Verdict:
    return Verdict[limit["verdict"].upper()]


def _decision(limit: Mapping[str, Any]) -> str:
    verdict = _verdict(limit)
    words = f"{verdict.sign} {limit_text(limit)}: {verdict_text(limit)}"
    return f"<p class='verdict {VERDICT_KINDS[verdict]}'>{escape(words)}</p>"


def _worst(pack: EvidencePack) -> tuple[list[str], list[list[str]]]:
    worst = pack.record["worst"].items()
    rows = [[title_of(name), value_text(name, row), case_text(row["case"])] for name, row in worst]
    return ["worst", "value", "case"], rows
