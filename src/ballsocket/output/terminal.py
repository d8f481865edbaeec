"""Results in a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..catalogue import reference
from ..compare import Comparison
from ..contact import Contact
from ..describe import Column, number_text
from ..identify.modulus import Calibration
from ..joint import Joint, Material
from ..model import Theory
from ..paper.table_3 import RATIOS
from ..paper.table_3 import Column as TableColumn
from ..presets import joints, materials
from ..quantities import CONTACT

if TYPE_CHECKING:
    from ..fem.export.calculix import CcxAnswer

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"
_NARROW = 72
_PROFILE = "profile"
_APART = "deviation"
_OFF_THE_POLE = ("pole_pressure", "max_pressure_angle")
_COLUMNS = tuple(Column(each, each.shown) for each in CONTACT.values())
_LATER = ("stiffness", "area", _PROFILE, _APART, "indentation", "force", "half_angle")
_DROPPED = (*(name for name in reversed(tuple(CONTACT)) if name not in (*_LATER, "max_pressure")), *_LATER)
"""What a narrow terminal does without, first to last; never the largest pressure."""


def print_press(comparison: Comparison, remarks: Iterable[str] = ()) -> None:
    """The comparison as a table, each model with its pressure profile from the pole to 90 degrees, and remarks."""
    console = _console()
    _print_folded(console, str(comparison.joint), "bold")
    console.print(_fitting(comparison, console))
    for reason in (*remarks, *comparison.notes()):
        _print_folded(console, reason, "dim")


def _console() -> Console:
    return Console(highlight=False)


def _print_folded(console: Console, text: str, style: str) -> None:
    folded = textwrap.fill(text, max(console.width, 20), subsequent_indent="    ", break_on_hyphens=False)
    console.print(Text(folded, style=style), soft_wrap=True)


def _fitting(comparison: Comparison, console: Console) -> Table:
    """The table with as many columns as the terminal is wide enough for."""
    unbounded = console.options.update(width=10_000)
    bars = _BARS if console.encoding.startswith("utf") else _BARS_ASCII
    usual = _pole(comparison)
    for count in range(len(_DROPPED) + 1):
        table = _press_table(comparison, (*usual, *_DROPPED[:count]), bars)
        if console.measure(table, options=unbounded).maximum <= console.width:
            break
    return table


def _pole(comparison: Comparison) -> tuple[str, ...]:
    """The columns that say nothing new where every pressure that can be trusted is highest at the pole."""
    off = any(contact.valid and contact.max_pressure_angle > 0 for contact in comparison.values())
    return () if off else _OFF_THE_POLE


def _press_table(comparison: Comparison, dropped: Sequence[str], bars: str) -> Table:
    columns = [column for column in _COLUMNS if column.attribute not in dropped]
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    apart = () if _APART in dropped else _compared(comparison)
    for head in (*(column.symbol for column in columns), *(f"Δ{column.symbol[0]}" for column in apart)):
        table.add_column(head, justify="right", no_wrap=True)
    if _PROFILE not in dropped:
        table.add_column(" p, 0° to 90°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    units = (*(column.unit for column in columns), *("%" for _ in apart))
    table.add_row("", *(Text(unit, style="dim") for unit in units))
    profiles = {} if _PROFILE in dropped else _profiles(comparison, bars)
    for name, contact in comparison.items():
        away = _percents(comparison.deviation(name), apart)
        table.add_row(*_cells(name, contact, columns, away, [profiles[name]] if profiles else []))
    for name in comparison.missing:
        gaps = [*["-"] * len(columns), *[""] * (len(apart) + (_PROFILE not in dropped))]
        table.add_row(Text(name, style="dim"), *gaps, Text("no", style="red"))
    return table


def _compared(comparison: Comparison) -> tuple[Column, ...]:
    """What is measured against the exact answer: what the load leaves open, and the peak pressure."""
    if comparison.get(reference.name) is None or len(comparison) == 1:
        return ()
    by_depth = len({contact.indentation for contact in comparison.values()}) == 1
    first = "force" if by_depth else "indentation"
    return tuple(column for column in _COLUMNS if column.attribute in (first, "max_pressure"))


def _percents(deviation: dict[str, Any] | None, columns: Sequence[Column]) -> list[str]:
    if deviation is None:
        return [""] * len(columns)
    shares = [100 * float(deviation[column.name]) for column in columns]
    return ["-" if share != share else f"{share:+.1f}" for share in shares]


def _cells(
    name: str, contact: Contact, columns: Sequence[Column], away: Sequence[str], profile: Sequence[str]
) -> list[Text]:
    style = "" if contact.valid else "yellow"
    numbers = [number_text(column.of(contact), 4, "-") for column in columns]
    bars = [Text(f" {bar}", style=style or "cyan") for bar in profile]
    mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
    return [*(Text(text, style=style) for text in (name, *numbers, *away)), *bars, mark]


def _profiles(comparison: Comparison, bars: str) -> dict[str, str]:
    """For every model its pressure from the pole to 90 degrees as a row of bars, all to one scale."""
    angle = numpy.linspace(0.0, pi / 2, 12)
    pressures = {name: _pressure(contact, angle) for name, contact in comparison.items()}
    highest = max((pressure.max() for pressure in pressures.values()), default=0.0)
    return {name: _bars(pressure / highest if highest > 0 else 0 * angle, bars) for name, pressure in pressures.items()}


def _pressure(contact: Contact, angle: numpy.ndarray) -> numpy.ndarray:
    return 0 * angle if contact.status.failed else numpy.nan_to_num(contact.pressure(angle), posinf=0.0)


def _bars(share: numpy.ndarray, bars: str) -> str:
    return "".join(bars[round(float(level) * 8)] for level in numpy.clip(share, 0.0, 1.0)).rstrip()


def print_calibration(fit: Calibration) -> None:
    """A fitted modulus with its residual and the error of the closed form that takes it."""
    console = _console()
    _print_folded(console, str(fit.joint), "bold")
    low, high = float(fit.force.min()), float(fit.force.max())
    constants = ", ".join(f"{number:.6g}" for number in fit.modulus.constants)
    rows = [
        (f"{fit.modulus.name}", constants),
        ("K = p0/d of the reference", number_text(fit.wanted, 5, "-") + " MPa/mm"),
        (f"spread over {low:g} to {high:g} N", f"{100 * fit.spread:.2f} %"),
        ("largest residual of the fit", f"{100 * float(numpy.max(abs(fit.residual))):.2f} %"),
        *(
            (f"closed form, worst error in {name.replace('_', ' ')}", f"{100 * error:.2f} %")
            for name, error in fit.error.items()
        ),
    ]
    for name, text in rows:
        console.print(f"  {name:<46} {text}")


def print_table_3(columns: Sequence[TableColumn]) -> None:
    """Table 3 of the paper beside the same fit to the exact answer."""
    console = _console()
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in ("", *(f"ν {column.poisson:g}" for column in columns)):
        table.add_column(head, justify="right" if head else "left", no_wrap=True)
    for i, name in enumerate(("C1", "C2", "C3")):
        table.add_row(f"{name}, paper", *(f"{column.paper[i]:.2f}" for column in columns))
        table.add_row(f"{name}, exact", *(f"{column.ours[i]:.2f}" for column in columns))
    thick = RATIOS < 4.5
    for head, part in ((f"paper's K, R2/L to {RATIOS[thick][-1]:g}", thick), (f"to {RATIOS[-1]:g}", RATIOS > 0)):
        worst = (max(column.difference[part], key=abs) for column in columns)
        table.add_row(f"{head}: off by", *(f"{100 * share:+.1f} %" for share in worst))
    residuals = (float(numpy.max(abs(column.calibration.residual))) for column in columns)
    table.add_row("our fit: largest residual", *(f"{100 * share:.1f} %" for share in residuals))
    table.add_row("K over 1 to 3 kN: spread", *(f"{100 * column.calibration.spread:.1f} %" for column in columns))
    for name in ("indentation", "max_pressure", "half_angle", "force"):
        errors = (100 * column.calibration.error[name] for column in columns)
        table.add_row(f"closed form: {name.replace('_', ' ')}", *(f"{error:.1f} %" for error in errors))
    console.print("Table 3 of Heß & Forsbach 2021: K R2/E = C1 + C2 (R2/L) + C3 (R2/L)²", style="bold")
    console.print(table)
    text = f"{len(RATIOS)} joints of 24 mm outer radius, clearance 0.1 mm, steel on 1 GPa; mean of p0/d at 1, 2, 3 kN."
    _print_folded(console, text, "dim")


def print_rival(ours: Mapping[str, numpy.ndarray], theirs: CcxAnswer) -> None:
    """Our own answer at each step of a deck beside CalculiX', with how far that lies above ours."""
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    heads = list(_rival_heads())
    for head, _ in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_row(*(Text(unit, style="dim") for _, unit in heads))
    columns = (ours["indentation"], ours["force"], theirs.force, ours["pole_pressure"], theirs.pole_pressure)
    angles = (ours["half_angle_deg"], numpy.degrees(theirs.half_angle))
    for d, F, F_ccx, p, p_ccx, angle, angle_ccx in zip(*columns, *angles, strict=True):
        forces = (f"{F:.1f}", f"{F_ccx:.1f}", f"{100 * (F_ccx / F - 1):+.2f}")
        pressures = (f"{p:.3f}", f"{p_ccx:.3f}", f"{100 * (p_ccx / p - 1):+.2f}")
        table.add_row(f"{d:.5f}", *forces, *pressures, f"{angle:.2f}", f"{angle_ccx:.2f}", f"{angle_ccx - angle:+.2f}")
    _console().print(table)


def _rival_heads() -> Iterator[tuple[str, str]]:
    """Symbols and units of those columns."""
    yield CONTACT["indentation"].symbol, CONTACT["indentation"].written.text
    for name, apart in (("force", "%"), ("pole_pressure", "%"), ("half_angle", "°")):
        symbol, unit = CONTACT[name].symbol, CONTACT[name].written.text
        yield from ((symbol, unit), (f"{symbol} ccx", unit), (f"Δ{symbol}", apart))


def print_models(models: Iterable[Theory]) -> None:
    """The catalogue with validity and sources."""
    rows = [(model.name, model.title, _trust(model), _sources(model)) for model in models]
    _print_rows(("model", "what it is", "trusted for", "source"), rows, gap=1)


def _trust(model: Theory) -> str:
    """What the model promises, and where."""
    promised = [] if model.promise is None else [f"{model.promise}:"]
    return "\n".join([*promised, *map(str, model.validity)])


def print_presets() -> None:
    """Materials and joints with the sources of their numbers."""
    for title, presets in (("materials", materials), ("joints", joints)):
        rows = [(name, _numbers(preset), preset.source) for name, preset in presets.items()]
        _print_rows((title, "numbers", "source"), rows, gap=0)
        _console().print()


def _sources(model: Theory) -> str:
    """A line for each publication, with all its places."""
    places: dict[str, list[str]] = {}
    for source in model.sources:
        places.setdefault(source.short, []).extend([source.place] if source.place else [])
    return "\n".join(", ".join([short, *place]) for short, place in places.items())


def _numbers(preset: Material | Joint) -> str:
    text = str(preset).removeprefix(preset.name)
    return text.removeprefix(": ") if isinstance(preset, Joint) else text.strip(" ()")


def _print_rows(heads: Sequence[str], rows: Sequence[Sequence[str]], gap: int) -> None:
    """A table with `gap` empty lines between rows; a paragraph for each row where the terminal is narrow."""
    console = _console()
    if console.width < _NARROW:
        for name, *texts in rows:
            console.print(Text(name, style="bold"))
            for text in texts:
                _print_folded(console, f"  {text.replace(chr(10), '; ')}", "")
        return
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, gap, 0))
    for head in heads:
        table.add_column(head, overflow="fold", no_wrap=head == heads[0])
    for name, *texts in rows:
        table.add_row(Text(name, style="bold"), *map(Text, texts))
    console.print(table)
