"""Wear: a design over millions of cycles, or two beside each other: depth, penetration with its band, numbers."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from ....core.checks import check_names, shown
from ....core.kinds import Kind, Unit
from ....core.quantities import CONTACT
from ....files.joint_file import JointFile
from ....hip.law_fields import LawField
from ....problem.presets import joints
from ....reports.pages import picture
from ...jobs import ViewJob
from ...running import CachedRun
from ...state.screen import Screen
from ...state.use import CHOICES, CREEP_INPUTS, LAW_INPUTS, WEAR_INPUTS, Use, cycle_fields
from ...view import Document, Host, View
from ...widgets.fields import Field, choice, number, segments, typed
from ...widgets.words import progress, unit_of_files
from .charts import depth_maps, penetration_chart, wear_numbers
from .worker import WEAR_SECONDS, WearResult, simulate_wear, wear_key

_RESULTS: CachedRun = CachedRun(max_size=24)
_ALONE, _NOW, _AS_COMPARED = "", "as it is now", "as it was put beside"
_SHOWN = (
    *("cycle", "body_weight", "contact", "law", "coefficient", *WEAR_INPUTS, "spread", "millions", "creep"),
    *(*CREEP_INPUTS, "beside"),
)


class Wear(View):
    """View of wear that runs on request and shows stored results at once."""

    title = "Wear"
    body = f"""
<div class="inputs-row">{"".join(f'<div data-field="wear.{name}"></div>' for name in _SHOWN)}</div>
<p><button type="button" class="plain" data-tell="wear.run">Run the wear</button></p>
<div id="wear-trouble" role="alert"></div>
<div id="wear-progress" role="status"></div>
<div id="wear-numbers"></div>
<div id="wear-curve"></div>
<div class="beside" id="wear-maps"></div>
"""

    def __init__(self, page: Host) -> None:
        self._page, self._screen = page, page.screen
        self._job = ViewJob(page.channel, "wear", self._store_results, longest=WEAR_SECONDS)
        page.listen("wear", self._edited)

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._job.put("trouble", "")
        self._page.channel.put_fields(_fields(screen))
        if not self._job.works:
            self._job.put("progress", "")
        self._put_found()

    def _put_found(self) -> None:
        """Show the stored results for the designs on the screen, or instructions."""
        results = self._stored_results()
        self._job.put("numbers", wear_numbers(results, self._screen.reading) if results else _NOTHING)
        self._job.put("curve", penetration_chart(results, self._screen.reading) if results else "")
        self._job.put("maps", depth_maps(results, self._screen.reading) if results else "")

    def _stored_results(self) -> dict[str, WearResult]:
        results = {name: _RESULTS.get(wear_key(file, self._screen.use)) for name, file in designs(self._screen).items()}
        return results if all(result is not None for result in results.values()) else {}

    def _edited(self, key: str, value: Any) -> None:
        if key == "run":
            self._run()
        elif key == "stop":
            self._job.stop()
            self._job.put("progress", progress("Stopped.", None))
        elif key == "beside":
            self._page.ask(beside=_compared(self._screen, value))
        else:
            self._page.ask(use=_changed(self._screen, key, value))

    def _run(self) -> None:
        use = self._screen.use
        files_by_key = {wear_key(file, use): file for file in designs(self._screen).values()}
        missing = {key: file for key, file in files_by_key.items() if _RESULTS.get(key) is None}
        self._job.put("trouble", "")
        if missing:
            self._job.ask(tuple(missing), partial(simulate_wear, list(missing.values()), use))

    def _store_results(self, keys: tuple[Hashable, ...], results: list[WearResult]) -> None:
        for key, result in zip(keys, results, strict=True):
            _RESULTS.put(key, result)
        self._put_found()

    def document(self, screen: Screen) -> Document:
        results = self._stored_results()
        if not results:
            raise ValueError("the wear of this has not been run yet: run it first")
        unit = unit_of_files(CONTACT["indentation"], screen.reading)
        depths = [f"{name}{unit.text_in_brackets}" for name in ("penetration", "low", "high", "deepest")]
        rows = [
            [name, float(cycles), *(unit.factor * float(depth) for depth in row), float(volume)]
            for name, design in results.items()
            for cycles, *row, volume in zip(
                design.cycles, design.penetration, design.low, design.high, design.deepest, design.volume, strict=True
            )
        ]
        pictures = "".join(picture(design.figure, f"penetration of {name}") for name, design in results.items())
        return Document(
            rows=lambda: [["design", "million cycles", *depths, "volume [mm3]"], *rows],
            sections=lambda: {"wear": ("Wear", wear_numbers(results, screen.reading) + pictures)},
        )

    def leave(self) -> None:
        self._job.stop()


_NOTHING = (
    "<p class='quiet'>Nothing has been run of this yet. A run of springs takes some seconds, of a real cup a minute. "
    "A second design can be put beside: then change the one on the screen. Who has a new hip walks one to two million "
    "cycles a year.</p>"
)


def designs(screen: Screen) -> dict[str, JointFile]:
    """Return the design on the screen and the first compared one, by name."""
    named = {screen.file.joint.name or "this design": screen.file}
    for file in screen.beside[:1]:
        name = file.joint.name or "the other"
        named[f"{name}, beside" if name in named else name] = file
    return named


def _fields(screen: Screen) -> dict[str, Field]:
    use = screen.use
    listed = [
        *cycle_fields("wear", use),
        choice("wear.law", "Law of wear", [(name, name) for name in CHOICES["law"]], use.law),
        _coefficient_input(use),
        *(_law_input(name, use) for name in WEAR_INPUTS),
        number("wear.spread", "It scatters by a factor", Unit(""), (1.0, 3.0), 0.1, use.spread),
        number("wear.millions", "Million cycles", Unit(""), (0.5, 20.0), 0.5, use.millions),
        segments("wear.creep", "The liner creeps", [(name, name) for name in CHOICES["creep"]], use.creep),
        *(_law_input(name, use) for name in CREEP_INPUTS),
        choice("wear.beside", "Compare with", _choices(screen), _AS_COMPARED if screen.beside else _ALONE),
    ]
    return {field["name"]: field for field in listed}


def _law_field(name: str, part: LawField, value: float, title: str) -> Field:
    """Describe the input of a number of a law, over three decades around its example."""
    unit = f" [{part.unit.text}]" if part.unit.text else ""
    step = part.example / 100 or 0.01
    return number(f"wear.{name}", f"{title}{unit}", Unit(""), (step, 1000 * step), step, value)


def _coefficient_input(use: Use) -> Field:
    """Describe the input of the wear coefficient, hidden for a law without one."""
    part = use.coefficient_field
    if part is None:
        return {**number("wear.coefficient", "Coefficient", Unit(""), (0.0, 1.0), 0.01, 0.0), "hidden": True}
    return _law_field("coefficient", part, use.coefficient, "Coefficient")


def _law_input(name: str, use: Use) -> Field:
    """Describe the input of a number of `LAW_INPUTS`, hidden unless a chosen law has it."""
    part = LAW_INPUTS[name]
    title = part.meaning[0].upper() + part.meaning[1:]
    return {**_law_field(name, part, use.law_number(name), title), "hidden": name not in use.used_inputs}


def _choices(screen: Screen) -> list[tuple[str, str]]:
    compared = [(_AS_COMPARED, f"{screen.beside[0].joint.name or 'a joint'}, {_AS_COMPARED}")] if screen.beside else []
    return [(_ALONE, "– nothing –"), *compared, (_NOW, f"this design {_NOW}"), *((name, name) for name in joints)]


def _compared(screen: Screen, value: Any) -> tuple[JointFile, ...]:
    """Return the compared design: this one, or a preset in the same cup."""
    if value == _ALONE:
        return ()
    if value in (_NOW, _AS_COMPARED):
        return (screen.file,) if value == _NOW else screen.beside
    check_names([value], joints, "as design")
    return (replace(screen.file, joint=joints[value]),)


def _changed(screen: Screen, key: str, value: Any) -> Use:
    """Return the settings after one input has changed."""
    check_names([key], _SHOWN, "among the inputs of wear")
    if key in LAW_INPUTS:
        return screen.use.with_law_number(key, float(LAW_INPUTS[key].unit.read(key, _decimal_point(value))))
    changes: dict[str, Any] = {key: _READ[key](value, screen.use) if key in _READ else _word(key, value)}
    return replace(screen.use, **changes)


def _word(key: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{key} = {shown(value)} is not a choice")
    return value


def _decimal_point(value: Any) -> Any:
    """Replace the decimal comma of a typed number."""
    return value.strip().replace(",", ".") if isinstance(value, str) else value


def _coefficient(value: Any, use: Use) -> float:
    """Read a typed coefficient: a number with a decimal point or comma, with or without its unit."""
    if use.coefficient_field is None:
        raise ValueError(f"the law {use.law!r} has no coefficient")
    return float(use.coefficient_field.unit.read("coefficient", _decimal_point(value)))


_READ: Mapping[str, Callable[[Any, Use], float]] = {
    "body_weight": lambda value, use: typed("body_weight", value, Unit("N"), Kind.FORCE),
    "coefficient": _coefficient,
    "spread": lambda value, use: typed("spread", value, Unit(""), Kind.NUMBER),
    "millions": lambda value, use: typed("millions", value, Unit(""), Kind.NUMBER),
}
