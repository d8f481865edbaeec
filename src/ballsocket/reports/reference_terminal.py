"""Fits and reference solutions in a terminal: results of ballsocket beside those of the paper and of CalculiX."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy
from rich.table import Table
from rich.text import Text

from ..contact.describe import number_text
from ..core.quantities import CONTACT
from ..paper.table_3 import RATIOS
from ..paper.table_3 import TableColumn as TableColumn
from ..studies.calibration import Calibration
from .terminal import console, print_folded

if TYPE_CHECKING:
    from ..elasticity.finite_elements.calculix import CcxAnswer


def print_calibration(fit: Calibration) -> None:
    """Print a fitted modulus with its residual and the error of the closed form that uses it."""
    terminal = console()
    print_folded(terminal, str(fit.joint), "bold")
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
        terminal.print(f"  {name:<46} {text}")


def print_table_3(columns: Sequence[TableColumn]) -> None:
    """Print Table 3 of the paper beside the same fit to the exact solution."""
    terminal = console()
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
    terminal.print("Table 3 of Heß & Forsbach 2021: K R2/E = C1 + C2 (R2/L) + C3 (R2/L)²", style="bold")
    terminal.print(table)
    text = f"{len(RATIOS)} joints of 24 mm outer radius, clearance 0.1 mm, steel on 1 GPa; mean of p0/d at 1, 2, 3 kN."
    print_folded(terminal, text, "dim")


def print_rival(ours: Mapping[str, numpy.ndarray], theirs: CcxAnswer) -> None:
    """Print the result of ballsocket at each step of a deck beside that of CalculiX, with the deviation."""
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
    console().print(table)


def _rival_heads() -> Iterator[tuple[str, str]]:
    """Yield symbols and units of the columns of `print_rival`."""
    yield CONTACT["indentation"].symbol, CONTACT["indentation"].written.text
    for name, apart in (("force", "%"), ("pole_pressure", "%"), ("half_angle", "°")):
        symbol, unit = CONTACT[name].symbol, CONTACT[name].written.text
        yield from ((symbol, unit), (f"{symbol} ccx", unit), (f"Δ{symbol}", apart))


def print_tilted_rival(ours: Sequence[float], rival: Sequence[float]) -> None:
    """Print the force components (N) of a tilted contact beside those of CalculiX."""
    terminal, size = console(), float(numpy.linalg.norm(rival))
    for name, mine, its in zip(("towards the rim", "across", "towards the dome"), ours, rival, strict=True):
        off = 100 * (mine - its) / size
        terminal.print(f"  {name:<18} {mine:>12.6g} N, ccx {its:>12.6g} N, {off:+.2f} % of the load")
