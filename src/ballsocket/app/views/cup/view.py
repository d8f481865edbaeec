"""Cup: the load in the cup as it stands, how near it comes to the rim, and cups that stand otherwise."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from html import escape
from math import degrees, radians
from typing import Any

from ....core.checks import shown
from ....core.quantities import CONTACT, CUP, DERIVED, QUANTITIES, Quantity
from ....core.validity import OutsideDomainError
from ....elasticity.off_axis.contact import OffAxisContact
from ....files.joint_file import JointFile
from ....reports.cup_plots import cup_figure
from ....reports.figure_files import figure_bytes
from ....reports.pages import picture, table
from ...jobs import ViewJob, run_in_thread
from ...pictures.bore import pressed_bore, pressed_bowl
from ...running import CachedRun
from ...state.screen import STANDINGS, Screen
from ...view import Document, Host, View
from ...widgets.cup_fields import cup_edited, cup_fields
from ...widgets.fields import segments
from ...widgets.reading import Reading
from ...widgets.words import alert, column_of, number_cell, progress, trust, unit_of_files, value_text
from .charts import angle_map
from .worker import SOLVED, Stood, bore_of, pressed_in_cup, set_up, stand_of, stood

_STOOD: CachedRun = CachedRun(max_size=32)
_FIELDS = (
    *("inclination", "anteversion", "tilt", "inwards", "forwards"),
    *("arc_of_cover", "chamfer", "aim", "side"),
)
_TYPICAL = {"inclination": 45.0, "anteversion": 15.0}


class CupView(View):
    """View of the load in the present cup, followed by a map over orientations."""

    title = "Cup"
    body = f"""
<div class="inputs-row">{"".join(f'<div data-field="cup.{name}"></div>' for name in _FIELDS)}</div>
<div id="cup-trouble" role="alert"></div>
<div id="cup-progress" role="status"></div>
<div id="cup-numbers"></div>
<div class="beside">
  <figure><figcaption>Pressure on the cup, seen from its opening</figcaption><div id="cup-map"></div></figure>
  <figure><figcaption>In three dimensions: drag it, or use the arrow keys</figcaption><div id="cup-bowl"></div></figure>
</div>
<figure>
  <figcaption>How the cup may stand</figcaption>
  <div data-field="cup.show"></div>
  <div id="cup-stood"></div>
</figure>
"""

    def __init__(self, page: Host) -> None:
        self._page, self._screen = page, page.screen
        self._job = ViewJob(page.channel, "cup", self._store_result)
        self._stopped: Hashable = None
        page.listen("cup", self._edited)

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._job.put("trouble", "")
        self._fields()
        self._put_map()
        self._work()

    def _fields(self) -> None:
        maps = [(name, QUANTITIES[name].title) for name in STANDINGS]
        show = segments("cup.show", "Map of", maps, self._screen.standing)
        self._page.channel.put_fields({**cup_fields(self._screen), "cup.show": show})

    def _edited(self, key: str, value: Any) -> None:
        if key == "stop":
            self._stopped = stand_of(self._screen.file)
            self._job.stop()
            self._job.put("progress", progress("Stopped.", None, again="cup.again"))
        elif key == "again":
            self._stopped = None
            self._work()
        elif key == "show":
            self._page.ask(standing=str(value))
        elif key == "usual":
            self._stand(**_TYPICAL)
        elif key == "pick":
            self._stand(**dict(zip(_TYPICAL, _picked(value), strict=True)))
        else:
            self._page.ask(file=cup_edited(self._screen, key, value))

    def _stand(self, **angles: float) -> None:
        """Change angles of the cup, in degrees."""
        screen = self._screen
        factor = 1.0 if screen.angle == "degrees" else radians(1.0)
        for name, angle in angles.items():
            screen = _with(screen, cup_edited(screen, name, angle * factor))
        self._page.ask(file=screen.file)

    def _work(self) -> None:
        """Set up the bore, press the load, or map the orientations, as needed next."""
        file = self._screen.file
        if SOLVED.get(bore_of(file)) is None:
            self._clear()
            self._job.ask(("bore", bore_of(file)), partial(set_up, file))
            return
        run_in_thread(
            lambda: _drawn(file, self._screen.reading) if file is self._screen.file else None,
            partial(self._pressed, file),
        )
        self._map()

    def _map(self) -> None:
        file = self._screen.file
        if _STOOD.get(stand_of(file)) is not None or "tilt" in file.aim or self._stopped == stand_of(file):
            self._job.stop()
        else:
            self._job.ask(("map", stand_of(file)), partial(stood, file))

    def _store_result(self, key: tuple[str, Hashable], result: Any) -> None:
        """Store the bore or the map, and continue."""
        kind, of = key
        if kind == "bore":
            SOLVED.put(of, True)
            self._work()
        else:
            _STOOD.put(of, result)
            self._put_map()

    def _pressed(self, file: JointFile, outcome: Future[Any]) -> None:
        if file is not self._screen.file:
            return
        try:
            contact, bore, bowl = outcome.result()
        except (ValueError, OutsideDomainError) as error:
            self._clear()
            self._job.put("trouble", alert(str(error)))
        else:
            self._job.put("numbers", _numbers(contact, self._screen))
            self._job.put("map", bore)
            self._job.put("bowl", bowl)
        self._page.channel.send()

    def _clear(self) -> None:
        for element in ("numbers", "map", "bowl"):
            self._job.put(element, "")

    def _put_map(self) -> None:
        """Show the map of orientations if it is available."""
        orientations: Stood | None = _STOOD.get(stand_of(self._screen.file))
        if "tilt" in self._screen.file.aim:
            self._job.put("stood", _NO_MAP)
        elif orientations is None:
            self._job.put("stood", "")
        else:
            seen = self._screen
            self._job.put("stood", f"{angle_map(orientations, seen.file.cup, seen.standing, seen.reading)}{_KEY}")

    def document(self, screen: Screen) -> Document:
        if SOLVED.get(bore_of(screen.file)) is None:
            raise ValueError("this bore is still being set up: wait until its pressure is there")
        contact = pressed_in_cup(screen.file)
        orientations: Stood | None = _STOOD.get(stand_of(screen.file))
        stands = (
            {}
            if orientations is None
            else {"orientations": ("How the cup may stand", picture(orientations.figure, "map"))}
        )
        rows = [["quantity", "value"], *_file_rows(contact, screen.reading)]
        listed = table(rows[0], [[name, value_text(value)] for name, value in rows[1:]])
        return Document(
            picture=lambda form: figure_bytes(cup_figure(contact), form),
            rows=lambda: rows,
            sections=lambda: {"cup": ("In the cup", listed), **stands},
        )

    def leave(self) -> None:
        self._job.stop()


_NO_MAP = (
    "<p class='quiet'>A load that is aimed from the cup's axis turns with the cup: there is no map of orientations.</p>"
)
_KEY = (
    "<p class='quiet'>Dotted: where the contact reaches the rim. Dashed: Lewinnek's zone (1978). Ring: this cup. "
    "Blank: the load leaves the bore, or the rim digs in. Click to have the cup stand there.</p>"
)


def _picked(value: Any) -> list[float]:
    """Read the two angles (degrees) of a point on the map."""
    numbers = value if isinstance(value, list) else []
    if len(numbers) != len(_TYPICAL) or not all(isinstance(number, int | float) for number in numbers):
        raise ValueError(f"{shown(value)} is not a point of the map, which has two angles")
    return [round(float(number), 1) for number in numbers]


def _with(screen: Screen, file: JointFile) -> Screen:
    return replace(screen, file=file)


def _drawn(file: JointFile, reading: Reading) -> tuple[OffAxisContact, str, str]:
    contact = pressed_in_cup(file)
    return contact, pressed_bore(contact, reading), pressed_bowl(contact)


_NAMED = {**QUANTITIES, "rim_distance": replace(DERIVED["edge_distance"], name="rim_distance")}


def _file_rows(contact: OffAxisContact, reading: Reading) -> Iterator[list[Any]]:
    """Plain numbers of a file, by the names of JSON, each with its unit."""
    for name, value in contact.summary().items():
        quantity = _NAMED.get(name.removesuffix("_deg"))
        if quantity is not None and isinstance(value, float | int):
            unit = unit_of_files(quantity, reading)
            yield [column_of(quantity, unit), value / quantity.written.factor * unit.factor]
        elif isinstance(value, float | int | str | bool):
            yield [name, value]


def _numbers(contact: OffAxisContact, screen: Screen) -> str:
    reading = screen.reading
    angle = reading.unit(CUP["inclination"])
    degree = angle.text if angle.text == "°" else f" {angle.text}"
    margin = f"{float(contact.edge_margin) * angle.factor:.3g}{degree} of arc"
    cells = [
        _cell(DERIVED["edge_distance"], contact.edge_distance, reading, margin),
        _cell(CONTACT["max_pressure"], contact.max_pressure, reading),
        number_cell("load from the cup's axis", float(contact.tilt) * angle.factor, angle.text),
        _cell(CONTACT["half_angle"], contact.half_angle, reading),
        _cell(CONTACT["force"], contact.force, reading),
    ]
    value_text = f"{trust(contact, contact.notes)}{_hint(contact)}"
    return f"{_verdict(contact, reading)}<dl class='tiles'>{''.join(cells)}</dl>{value_text}"


def _cell(quantity: Quantity, value: Any, reading: Reading, more: str = "") -> str:
    unit = reading.unit(quantity)
    return number_cell(quantity.title, float(value) * unit.factor, unit.text, more)


def _verdict(contact: OffAxisContact, reading: Reading) -> str:
    """State in words if the contact stays on the bore."""
    apart = reading.with_unit(DERIVED["edge_distance"], float(contact.edge_distance))
    margin = degrees(float(contact.edge_margin))
    if contact.edge_loaded:
        return "<p class='trust no'>✗ Edge loading: the contact reaches the rim of the cup</p>"
    return f"<p class='trust yes'>✓ The contact ends {apart} ({margin:.1f}°) before the rim</p>"


def _hint(contact: OffAxisContact) -> str:
    """Offer the usual orientation for a cup without one."""
    if contact.model.cup.oriented:
        return ""
    words = escape(
        f"This cup opens straight down. Put it at {_TYPICAL['inclination']:g}° / {_TYPICAL['anteversion']:g}°"
    )
    return f"<p><button type='button' class='plain' data-tell='cup.usual'>{words}</button></p>"
