"""Compare: the design on the screen beside others, by one model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from html import escape
from typing import Any

from ...contact import Contact
from ...core.checks import check_names
from ...core.quantities import JOINT
from ...files.joint_file import JointFile
from ...model_catalogue import catalogue
from ...problem.presets import joints
from ...reports.figure_files import figure_bytes
from ...reports.press_plots import press_figure
from ...reports.style import LineStyle, numbered
from ..pressing import AXIAL_CURVES, fine_curves, press_charts
from ..state.screen import MAX_COMPARED, Screen
from ..view import STRESS_PAUSE, Document, View
from ..widgets.blocks import Block, sentence
from ..widgets.controls import Changes, Control, choice, chosen
from ..widgets.design_table import Designs, design_table, press_designs, report_table, with_drawings, with_stresses
from ..widgets.words import number_rows

_CHOOSE = ""
_PRESENT = "this design"
_EXAMPLE_SHOWN = (
    "Nothing has been added yet, so a preset is shown beside this design as an example. Add this design, then change "
    "its numbers: the table shows every difference. "
)
_EXAMPLES = ("hip-36", "hip-28")
"""Presets of which the first that differs from the design is shown beside it on an empty page."""


class Compare(View):
    """View that compares the design on the screen with others."""

    name, title = "compare", "Compare"
    body = """
<div class="inputs-row" id="compare-inputs"></div>
<p><button type="button" data-tell="compare.keep">Add this design to the comparison</button></p>
<div id="compare-trouble" role="alert"></div><div id="compare-note"></div>
<div id="compare-table"></div>
<div id="compare-charts"></div>
"""

    def begin(self) -> None:
        self.actions |= {
            "compare.keep": lambda value: with_compared(self.page.screen, self.page.screen.file),
            "compare.remove": self._remove,
        }

    def controls(self, screen: Screen) -> list[Control]:
        files = compared_files(screen)
        base = list(files).index(base_of(files, screen))
        added = choice("preset", "Add a preset", [(_CHOOSE, "– choose –"), *joints], _CHOOSE)
        options = [(str(index), name) for index, name in enumerate(files)]
        return [
            Control(
                added, lambda name: with_compared(screen, JointFile(joints[name], screen.file.load)) if name else {}
            ),
            chosen(screen, "base", "Differences from", options).but(value=str(base)),
        ]

    def _remove(self, name: Any) -> Changes:
        screen = self.page.screen
        names = list(compared_files(screen))
        check_names([name], names[1:], "among the compared designs")
        column = names.index(name)
        base = int(screen.base) - (column < int(screen.base))  # the same design unless that is removed
        return {"beside": (*screen.beside[: column - 1], *screen.beside[column:]), "base": str(base)}

    def show(self, screen: Screen) -> None:
        files = compared_files(screen)
        base = base_of(files, screen)
        designs = _pressed(files, screen)
        drawn = _contacts(designs)
        differences = f"Behind the numbers: the difference from {base}. The drawings have one scale."
        self.put(
            note=[sentence(f"{'' if screen.beside else _EXAMPLE_SHOWN}{differences}")],
            table=[design_table(with_drawings(designs), base, screen)],
            charts=[
                *([] if len(drawn) == len(designs) else [AXIAL_CURVES]),
                press_charts(drawn, _lines(files), screen.reading),
            ],
        )

        def stressed() -> Block:
            return design_table(with_drawings(with_stresses(designs)), base, screen)

        self.later(STRESS_PAUSE, partial(self.compute, stressed, lambda table: self.put(table=[table])))

    def document(self, screen: Screen) -> Document:
        files = compared_files(screen)
        designs, base = _pressed(files, screen), base_of(files, screen)
        contacts = _contacts(designs)
        models = dict.fromkeys(contacts, catalogue[screen.answered_by])

        def picture(form: str) -> bytes:
            curves, title = fine_curves(contacts, models), f"model {screen.answered_by}"
            return figure_bytes(press_figure(contacts, curves, title, _lines(files), units=screen.reading.units), form)

        return Document(
            picture=picture if contacts else None,
            rows=lambda: number_rows("joint", contacts, screen.reading),
            sections=lambda: {"joints": ("Designs", [report_table(with_stresses(designs), base, screen)])},
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        return list(compared_files(screen).values()), (screen.answered_by,)


def with_compared(screen: Screen, file: JointFile) -> Changes:
    """Compare one more design; raise ValueError if there is no room for it."""
    if len(screen.beside) >= MAX_COMPARED:
        raise ValueError(f"{MAX_COMPARED} designs are compared with this one already: remove one of them first")
    return {"beside": (*screen.beside, file)}


def compared_files(screen: Screen) -> dict[str, JointFile]:
    """Name the designs uniquely, all under the load on the screen; a preset is the example of an empty comparison."""
    files = {_PRESENT: screen.file}
    preset = next(joints[name] for name in _EXAMPLES if joints[name] != screen.file.joint)
    example = JointFile(preset, screen.file.load, screen.file.cup)
    for file in screen.beside or (example,):
        base = name = file.joint.name or "added design"
        number = 2
        while name in files:
            name, number = f"{base} ({number})", number + 1
        files[name] = replace(file, load=screen.file.load)
    return files


def base_of(files: Mapping[str, JointFile], screen: Screen) -> str:
    """Return the name of the base, from which differences are taken."""
    return list(files)[min(int(screen.base), len(files) - 1)]


def _pressed(files: Mapping[str, JointFile], screen: Screen) -> Designs:
    """Press the designs, with sizes and a button to remove each below their names."""
    headings = {}
    for name, file in files.items():
        head, liner = (
            screen.reading.with_unit(JOINT[key], float(getattr(file.joint, key)))
            for key in ("head_diameter", "liner_thickness")
        )
        headings[name] = f"<small>head ⌀ {head}, liner {liner}</small>"
        if name != _PRESENT and screen.beside:
            attributes = f"data-tell='compare.remove' data-value='{escape(name)}' aria-label='Remove {escape(name)}'"
            headings[name] += f"<button type='button' {attributes}>Remove</button>"
    return press_designs(files, screen.answered_by, headings)


def _contacts(designs: Designs) -> dict[str, Contact]:
    """Return the contacts whose curves are drawn: by the model of the page."""
    pressed: dict[str, Any] = {name: design.contact for name, design in designs.items() if design.contact is not None}
    return {name: contact for name, contact in pressed.items() if not contact.model.off_axis}


def _lines(files: Mapping[str, JointFile]) -> dict[str, LineStyle]:
    return {name: numbered(index) for index, name in enumerate(files)}
