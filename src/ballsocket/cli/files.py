"""The files that `press` writes: figures, and what other programs open."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from ..catalogue import judge, off_axis, reference
from ..compare import Comparison, successful_contacts
from ..elasticity.finite_elements.contact import MeshedContact
from ..elasticity.off_axis.contact import OffAxisContact
from ..reports import press_plots
from ..reports.figure_files import check_format, save
from ..reports.section_plot import section_figure

_THREE_D = ".png"


@dataclass(frozen=True, kw_only=True)
class Files:
    """Files that are asked for."""

    figure: Annotated[
        Path | None, typer.Option(help="Write a figure, .png, .svg or .pdf; of sphere, the cup, where it comes first")
    ] = None
    section: Annotated[Path | None, typer.Option(help="fem: write mesh, stresses and pressure as a figure")] = None
    view: Annotated[Path | None, typer.Option(help="sphere: write the cup in three dimensions, .png")] = None
    vtk: Annotated[
        Path | None, typer.Option(help="fem: write meshes and fields, .vtu or .vtk; sphere: bore and ball")
    ] = None

    def check(self) -> None:
        """Raise ValueError for an ending that is not written."""
        for figure in (self.figure, self.section):
            if figure is not None:
                check_format(figure)
        if self.view is not None and self.view.suffix.lower() != _THREE_D:
            raise ValueError(f"view {str(self.view)!r} must end in {_THREE_D}")
        if self.vtk is not None:
            from ..elasticity.finite_elements.decks.vtk import check_vtk_path

            check_vtk_path(self.vtk)

    def check_models(self, asked: Container[str]) -> None:
        """Raise ValueError where nobody is asked who could fill a file; `asked` holds names."""
        meshed, tilted = judge.name in asked, off_axis.name in asked
        if self.section is not None and not meshed:
            raise ValueError(f"--section is for the finite elements: add --model {judge.name}")
        if self.vtk is not None and not (meshed or tilted):
            raise ValueError(f"--vtk is for the finite elements: add --model {judge.name}, or {off_axis.name}")
        if self.view is not None and not tilted:
            raise ValueError(f"--view is for contacts off the axis: add --model {off_axis.name}")

    def write(self, comparison: Comparison, leading: str) -> None:
        """Write what was asked for; `leading` is the name of the model that is asked first."""
        shown = successful_contacts(comparison)
        if self.figure is not None and shown:
            alone = leading == off_axis.name and leading in shown
            save(press_plots.plot({leading: shown[leading]} if alone else shown), self.figure)
        loaded = {name: contact for name, contact in shown.items() if contact.max_pressure > 0}
        meshed, tilted = loaded.get(judge.name), loaded.get(off_axis.name)
        exact = shown.get(reference.name)
        _write(self.section, meshed, lambda contact, path: save(section_figure(contact, exact), path))
        _write(self.view, tilted, _view)
        if judge.name in comparison:
            _write(self.vtk, meshed, _meshes)
        else:
            _write(self.vtk, tilted, _surfaces)


def _write(path: Path | None, contact: Any, write: Callable[[Any, Path], None]) -> None:
    """Write a file that is asked for; without a contact there is none."""
    if path is None:
        return
    if contact is None:
        Console(stderr=True).print("ballsocket: without a contact there is nothing to draw or write")
        return
    write(contact, path)


def _meshes(contact: MeshedContact, path: Path) -> None:
    from ..elasticity.finite_elements.decks.vtk import write_vtk

    write_vtk(contact.section, path)


def _surfaces(contact: OffAxisContact, path: Path) -> None:
    from ..elasticity.off_axis.vtk import write_vtk

    write_vtk(contact, path)


def _view(contact: OffAxisContact, path: Path) -> None:
    from ..reports.cup_plots import save_view

    save_view(contact, path)
