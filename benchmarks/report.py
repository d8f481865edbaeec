"""What a benchmark found, as a table for the terminal and as a section of RESULTS.md."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

RESULTS = Path(__file__).with_name("RESULTS.md")
_HEAD = """# Measured

Written by `python -m benchmarks NAME --write`, one section per benchmark. Every time reads "median (min..max)" over
the repeats of one run, in which ours and the rivals took turns; a wide range is a noisy machine. Ratios are taken
round by round, and read the same way.
"""


@dataclass
class Rows:
    """One table."""

    title: str
    columns: tuple[str, ...] = ("what", "ours", "rival", "ratio")
    rows: list[tuple[str, ...]] = field(default_factory=list)

    def add(self, *cells: object) -> None:
        self.rows.append(tuple(map(str, cells)))


@dataclass
class Report:
    """Tables and the sentences that explain them; `rivals` are packages whose versions belong to the numbers."""

    tables: list[Rows]
    notes: Sequence[str]
    rivals: Sequence[str] = ()


def machine(packages: Sequence[str]) -> str:
    """Where and with what this ran, in one line."""
    parts = [_processor(), f"{os.cpu_count()} cores", f"{platform.system()}", f"Python {platform.python_version()}"]
    for package in dict.fromkeys(("numpy", "numba", *packages)):
        try:
            parts.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            parts.append(f"no {package}")
    return ", ".join([*parts, date.today().isoformat()])


def _processor() -> str:
    listed = Path("/proc/cpuinfo")
    lines = listed.read_text(encoding="utf-8").splitlines() if listed.exists() else []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.processor() or platform.machine()


def show(name: str, title: str, report: Report) -> None:
    """Print it."""
    console = Console(width=None if Console().is_terminal else 160, highlight=False, markup=False)
    console.print(f"{name}: {title}\n{machine(report.rivals)}", soft_wrap=True)
    for rows in report.tables:
        table = Table(*rows.columns, title=rows.title, title_justify="left", box=box.SIMPLE_HEAD)
        for row in rows.rows:
            table.add_row(*row)
        console.print(table)
    for note in report.notes:
        console.print(f"- {note}")


def write(name: str, title: str, report: Report, path: Path = RESULTS) -> None:
    """Put it into the file, in the place of the section of that name."""
    parts = path.read_text(encoding="utf-8").split("\n## ")[1:] if path.exists() else []
    sections = {part.partition(":")[0]: part.strip() for part in parts}
    sections[name] = _section(name, title, report)
    text = _HEAD + "".join(f"\n## {section}\n" for section in sections.values())
    path.write_text(text, encoding="utf-8")


def _section(name: str, title: str, report: Report) -> str:
    lines = [f"{name}: {title}", "", machine(report.rivals)]
    for rows in report.tables:
        body = [rows.columns, ("---",) * len(rows.columns), *rows.rows]
        lines += ["", f"**{rows.title}**", "", *("| " + " | ".join(row) + " |" for row in body)]
    return "\n".join([*lines, "", *(f"- {note}" for note in report.notes)])
