"""Compare: two or three joints side by side, answered by one model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from html import escape
from typing import Any

import panel as pn

from ....catalogue import catalogue
from ....compare import relative_deviation, successful_contacts
from ....contact import Contact
from ....core.quantities import JOINT
from ....files.joint_file import JointFile
from ....problem.presets import joints
from ....reports.figure_files import figure_bytes
from ....reports.pages import table
from ....reports.press_plots import press_figure
from ....reports.style import LineStyle, numbered
from ...pictures.section import extent_of, section
from ...pressing import fine_curves, press_charts, pressed
from ...state.screen import MAX_COMPARED, Screen
from ...style import html, inputs
from ...view import Document, Host, View
from ...widgets.reading import number_text
from ...widgets.words import alert, number_rows, percent

_CHOOSE = "– choose –"


class Compare(View):
    """View that compares the joint on the screen with up to two others."""

    title = "Compare"

    def __init__(self, page: Host) -> None:
        self._ask, self._screen, self._putting = page.ask, page.screen, False

        self._keep = pn.widgets.Button(label="Put this joint beside", width=180)
        self._preset = pn.widgets.Select(
            label="Put beside", options=[_CHOOSE, *joints], width=220, stylesheets=inputs()
        )
        self._base = pn.widgets.Select(label="Percent against", options={}, width=220, stylesheets=inputs())
        self._base.param.watch(self._based, "value")
        self._drop = [pn.widgets.Button(label="", width=200, visible=False) for _ in range(MAX_COMPARED)]
        self._keep.on_click(lambda event: self._add(self._screen.file))
        self._preset.param.watch(self._chosen, "value")
        for number, button in enumerate(self._drop):
            button.on_click(lambda event, number=number: self._remove(number))
        self._told, self._table, self._drawn = html(), html(), html()
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self.panel = pn.Column(
            pn.FlexBox(self._preset, self._keep, self._base, *self._drop, align_items="end", gap="12px", **wide),
            self._told,
            self._table,
            self._drawn,
            **wide,
        )

    def _add(self, file: JointFile) -> None:
        if len(self._screen.beside) >= MAX_COMPARED:
            self._told.object = alert(f"There is room for {MAX_COMPARED}: take one away first.")
            return
        self._ask(beside=(*self._screen.beside, file))

    def _chosen(self, event: Any) -> None:
        if event.new != _CHOOSE:
            self._add(JointFile(joints[event.new], self._screen.file.load))
            self._preset.value = _CHOOSE

    def _based(self, event: Any) -> None:
        if not self._putting:  # ignore changes by the page itself
            self._ask(base=event.new)

    def _put_base(self, files: Mapping[str, JointFile], screen: Screen) -> None:
        self._putting = True
        options = {name: str(index) for index, name in enumerate(files)}
        self._base.param.update(options=options, value=str(base_of(files, screen)))
        self._putting = False

    def _remove(self, number: int) -> None:
        compared = self._screen.beside
        self._ask(beside=(*compared[:number], *compared[number + 1 :]))

    def show(self, screen: Screen) -> None:
        self._screen = screen
        files = labelled(screen)
        self._put_base(files, screen)
        for number, button in enumerate(self._drop):
            button.visible = number < len(screen.beside)
            button.label = f"Take {list(files)[number + 1]} away" if button.visible else "–"
        self._told.object = (
            _percent(files, screen)
            if screen.beside
            else "<p class='quiet'>Put this joint or a preset beside, then change this one.</p>"
        )
        contacts = answers(files, screen.answered_by)
        self._table.object = table(*_text_table(files, contacts, screen))
        self._drawn.object = _drawings(files, contacts) + press_charts(contacts, _lines(files), screen.reading)

    def document(self, screen: Screen) -> Document:
        files = labelled(screen)
        contacts = answers(files, screen.answered_by)
        models = dict.fromkeys(contacts, catalogue[screen.answered_by])
        title = f"answered by {screen.answered_by}"

        def picture(form: str) -> bytes:
            return figure_bytes(
                press_figure(contacts, fine_curves(contacts, models), title, _lines(files), units=screen.reading.units),
                form,
            )

        return Document(
            picture=picture if contacts else None,
            rows=lambda: number_rows("joint", contacts, screen.reading),
            sections=lambda: {"joints": ("Joints", table(*_text_table(files, contacts, screen)))},
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        return list(labelled(screen).values()), (screen.answered_by,)


def _percent(files: Mapping[str, JointFile], screen: Screen) -> str:
    base = escape(list(files)[base_of(files, screen)])
    return f"<p class='quiet'>In brackets: how much more or less than {base}, in percent of that.</p>"


def labelled(screen: Screen) -> dict[str, JointFile]:
    """Name the joints uniquely, all under the load on the screen."""
    files = {"this joint": screen.file}
    for file in screen.beside:
        base = name = file.joint.name or "kept joint"
        number = 2
        while name in files:
            name, number = f"{base} ({number})", number + 1
        files[name] = replace(file, load=screen.file.load)
    return files


def _drawings(files: Mapping[str, JointFile], contacts: Mapping[str, Contact]) -> str:
    """Draw the sections of the joints to one scale and in one colour scale."""
    extent = max(map(extent_of, files.values()))
    highest = max((float(contact.max_pressure) for contact in contacts.values()), default=1.0)
    figures = "".join(
        f"<figure><figcaption>{escape(name)}</figcaption>{section(file, contacts.get(name), extent, highest)}</figure>"
        for name, file in files.items()
    )
    return f"<div class='pair'>{figures}</div>"


def _lines(files: Mapping[str, JointFile]) -> dict[str, LineStyle]:
    """Return the line style of each joint by its position."""
    return {name: numbered(index) for index, name in enumerate(files)}


def answers(files: Mapping[str, JointFile], model: str) -> dict[str, Contact]:
    """Press the joints by a model; return the successful contacts by name."""
    comparisons = {name: successful_contacts(pressed(file, (model,))) for name, file in files.items()}
    return {name: contacts[model] for name, contacts in comparisons.items() if model in contacts}


_DIMENSIONS = {
    "radius": ("ball_radius", "clearance", "liner_thickness", "outer_radius"),
    "diameter": ("head_diameter", "diametral_clearance", "liner_thickness", "outer_diameter"),
}


def _text_table(
    files: Mapping[str, JointFile], contacts: Mapping[str, Contact], screen: Screen
) -> tuple[list[str], list[list[str]]]:
    """Tabulate the joints in columns, with differences from the base joint."""
    rows = [
        [_head(name, screen), *(_length(file, name, screen) for file in files.values())]
        for name in _DIMENSIONS[screen.size]
    ]
    rows.append(["liner", *(str(file.joint.liner) for file in files.values())])
    rows.append(["ball", *("rigid" if file.joint.ball is None else str(file.joint.ball) for file in files.values())])
    base = list(files)[base_of(files, screen)]
    first = contacts.get(base)
    for column in screen.reading.columns:
        row = [column.label]
        for name in files:
            contact = contacts.get(name)
            if contact is None:
                row.append("no answer")
                continue
            number = float(column.values_of(contact))
            share = (
                ""
                if first is None or contact is first
                else percent(relative_deviation(number, float(column.values_of(first))), "+")
            )
            apart = f" ({share})" if share else ""
            row.append(f"{number_text(number)}{apart}")
        rows.append(row)
    rows.append(["trust it here?", *(_trusted(contacts.get(name), file, screen) for name, file in files.items())])
    heads = (f"{name}: the base" if name == base and len(files) > 1 else name for name in files)
    return [screen.answered_by, *heads], rows


def base_of(files: Mapping[str, JointFile], screen: Screen) -> int:
    """Return the index of the base joint, at most that of the last joint."""
    return min(int(screen.base), len(files) - 1)


def _head(name: str, screen: Screen) -> str:
    return JOINT[name].head(screen.reading.unit(JOINT[name]))


def _length(file: JointFile, name: str, screen: Screen) -> str:
    return f"{float(getattr(file.joint, name)) * screen.reading.unit(JOINT[name]).factor:.5g}"


def _trusted(contact: Contact | None, file: JointFile, screen: Screen) -> str:
    if contact is None:
        return pressed(file, (screen.answered_by,)).missing.get(screen.answered_by, "–")
    if not bool(contact.valid):
        return f"no: {'; '.join(contact.notes)}"
    return "; ".join(["yes", *contact.notes])
