"""Check by finite elements: the joint on the screen with its rim and support, beside the exact result."""

from __future__ import annotations

from collections.abc import Hashable
from functools import partial
from html import escape
from typing import Any

from ....comparison import relative_deviation
from ....core.quantities import CONTACT, JOINT
from ....files.joint_file import JointFile
from ....reports.pages import picture, table
from ...long_view import LongView, long_body
from ...pictures.section import extent_of, section
from ...results import without_name
from ...running import Work
from ...state.screen import Screen
from ...view import Document, field_places
from ...widgets.cup_fields import cup_edited, cup_fields
from ...widgets.reading import number_text
from ...widgets.words import distinct_quantities, notes_list, percent
from .charts import pressure_picture, section_picture
from .worker import ElementResult, run_finite_elements

_NAME = "judge"
_FIELDS = ("arc_of_cover", "chamfer", "interface")
_TO_COME = (
    "A run meshes this section with its rim, chamfer and backing, presses the ball in four load steps and shows the "
    "von Mises stress, the pressure beside the exact one of a complete shell, and the error of the mesh. It takes some "
    "seconds."
)


class ElementCheck(LongView):
    """View that runs finite elements on request."""

    title = "Check by finite elements"
    name = _NAME
    run_label = "Run finite elements"
    body = long_body(
        _NAME, field_places(_NAME, _FIELDS), f'<div id="{_NAME}-numbers"></div><div id="{_NAME}-picture"></div>'
    )

    def question_of(self, screen: Screen) -> Hashable:
        file, cup = screen.file, screen.file.cup
        load = tuple(file.load.items())
        return without_name(file.joint), load, file.tilt, cup.arc_of_cover, cup.chamfer, cup.interface

    def work(self, screen: Screen) -> Work:
        return partial(run_finite_elements, screen.file)

    def show_inputs(self, screen: Screen) -> None:
        fields = cup_fields(screen, self.name)
        self.channel.put_fields({name: fields[name] for name in (f"{_NAME}.{key}" for key in _FIELDS)})

    def edit(self, key: str, value: Any) -> None:
        self.page.ask(file=cup_edited(self.page.screen, key, value))

    def show_result(self, screen: Screen, result: ElementResult | None) -> None:
        if result is None:
            self.put(numbers="", picture=_preview(screen.file))
        else:
            self.put(numbers=_numbers(result, screen), picture=_pictures(result, screen))

    def document(self, screen: Screen) -> Document:
        result: ElementResult = self.result(screen)
        heads = ["quantity", "finite elements", "error of the mesh", "exact"]
        rows = [
            [name, result.numbers[name], result.error.get(quantity.name, ""), (result.exact or {}).get(name, "")]
            for name, quantity in ((item.key, item) for item in CONTACT.values())
            if isinstance(result.numbers[name], float)
        ]
        body = table(heads, [[str(cell) for cell in row] for row in rows])
        figure = picture(result.png, "mesh, von Mises stress, and pressure beside the exact one")
        return Document(
            picture=lambda form: result.svg if form == "svg" else result.png,
            rows=lambda: [heads, *rows],
            sections=lambda: {"judge": ("Finite elements", body + figure)},
        )


def _preview(file: JointFile) -> str:
    drawing = section(file, None, extent_of(file), 1.0)
    return f"<div class='beside'><figure>{drawing}</figure><p class='quiet'>{_TO_COME}</p></div>"


def _pictures(result: ElementResult, screen: Screen) -> str:
    reading, joint = screen.reading, result.file.joint
    head, outside = (
        reading.with_unit(JOINT[name], getattr(joint, name)) for name in ("head_diameter", "outer_diameter")
    )
    ((kind, load),) = result.file.load.items()
    caption = f"head ⌀ {head}, outside ⌀ {outside}, {CONTACT[kind].title} {reading.with_unit(CONTACT[kind], load)}"
    return (
        f"<div class='beside elements'><figure><figcaption>{escape(caption)}</figcaption>"
        f"{section_picture(result.drawing, result.file, reading)}</figure>"
        f"<figure><figcaption>Pressure beside the exact one</figcaption>"
        f"{pressure_picture(result.pressures, reading)}</figure></div>"
    )


def _numbers(result: ElementResult, screen: Screen) -> str:
    rows = []
    for quantity in distinct_quantities(result.numbers[CONTACT["max_pressure_angle"].key]):
        unit = screen.reading.unit(quantity)
        factor = unit.factor / quantity.written.factor  # the numbers are those of JSON
        value = result.numbers[quantity.key] * factor
        error = result.error.get(quantity.name)
        unit_text = unit.text.replace(" ", "\N{NO-BREAK SPACE}")
        row = [f"{quantity.title} [{unit_text}]", number_text(value), percent(error) if error else "–"]
        if result.exact is None:
            row += ["–", "–"]
        else:
            exact = result.exact[quantity.key] * factor
            row += [number_text(exact), percent(float(relative_deviation(value, exact)), "+")]
        rows.append(row)
    heads = ["quantity", "finite elements", "mesh error", "exact", "difference"]
    return (
        f"<div class='narrow'>{table(heads, rows)}</div>"
        f"<p class='quiet'>{result.elements} elements, {result.seconds:.2g} s. The exact solution is that of a "
        f"complete shell, without a rim.</p>{notes_list(result.notes)}"
    )
