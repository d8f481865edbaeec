"""What is on the screen as files: a picture, numbers, a page, a joint file."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from io import BytesIO, StringIO
from typing import Any

import panel as pn

from ..io.joint_file import JointFile
from ..io.joint_toml import toml_of
from ..output.html import page as html_page
from ..output.html import picture
from .view import Document


@dataclass(frozen=True, kw_only=True)
class Seen:
    """What is on the screen: the view's title, the joint, the link that leads back, and the view as a document."""

    title: str
    file: JointFile
    link: str
    document: Callable[[], Document]


class Downloads:
    """A button for each kind of file; made when it is pressed.

    Parameters
    ----------
    seen : callable
        What is on the screen now.
    refuse : callable
        Says in one sentence why there is no file.
    """

    def __init__(self, seen: Callable[[], Seen], refuse: Callable[[str], None]) -> None:
        self._seen, self._refuse = seen, refuse
        kinds: dict[str, tuple[str, Callable[[], bytes]]] = {
            "PNG": ("ballsocket.png", lambda: self._picture("png")),
            "SVG": ("ballsocket.svg", lambda: self._picture("svg")),
            "CSV": ("ballsocket.csv", self._numbers),
            "HTML": ("ballsocket.html", self._report),
            "TOML": ("joint.toml", self._joint),
        }
        buttons = [
            pn.widgets.FileDownload(
                callback=lambda make=make: self._made(make),
                filename=name,
                label=kind,
                embed=False,
                width=64,
                margin=(2, 2),
            )
            for kind, (name, make) in kinds.items()
        ]
        self.panel = pn.Column(
            pn.pane.HTML("<span class='label'>Save figure, numbers, report, joint</span>"),
            pn.FlexBox(*buttons, flex_wrap="wrap"),
            sizing_mode="stretch_width",
        )

    def _made(self, make: Callable[[], bytes]) -> BytesIO:
        """The file; where there is none, the page says why."""
        try:
            return BytesIO(make())
        except ValueError as error:
            self._refuse(str(error))
            raise

    def _picture(self, form: str) -> bytes:
        draw = self._seen().document().picture
        if draw is None:
            raise ValueError("there is nothing to draw: no model has an answer")
        return draw(form)

    def _numbers(self) -> bytes:
        stream = StringIO()
        csv.writer(stream, lineterminator="\n").writerows(_safe(row) for row in self._seen().document().rows())
        return stream.getvalue().encode("utf-8")

    def _joint(self) -> bytes:
        return toml_of(self._seen().file).encode("utf-8")

    def _report(self) -> bytes:
        """One page: the joint, the figure, the numbers, and the link that leads back."""
        seen = self._seen()
        document, joint = seen.document(), seen.file.joint
        title = f"{seen.title}: {joint.name or 'a joint'}"
        figure = "" if document.picture is None else picture(document.picture("png"), title)
        lede = (
            f"<p>{escape(str(joint))}</p><pre>{escape(toml_of(seen.file))}</pre>"
            f"<p class='quiet'>Seen in the explorer: <code>{escape(seen.link)}</code></p>"
        )
        return html_page(title, lede, {"figure": ("Figure", figure), **document.sections()}).encode("utf-8")


def _safe(row: Sequence[Any]) -> list[Any]:
    """Text that a spreadsheet would take for a formula is marked as text."""
    return [f"'{cell}" if isinstance(cell, str) and cell[:1] in ("=", "+", "-", "@") else cell for cell in row]
