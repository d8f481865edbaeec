"""Files that `press` writes: figures, meshes for other programs, and the report."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeGuard

import typer

from ..comparison import Comparison, successful_contacts
from ..core.checks import unique
from ..core.unit_systems import Units
from ..files.joint_file import JointFile
from ..model_catalogue import JUDGE, OFF_AXIS, reference
from ..question import PressAnswer
from ..reports.figure_files import check_format, save
from .options import write_figure
from .root import print_message

if TYPE_CHECKING:
    from ..studies.derivatives import LocalUncertainty
    from ..studies.distributions import Distribution


@dataclass(frozen=True, kw_only=True)
class FigureOptions:
    """Options of figures, and of files for other programs."""

    figure: Annotated[
        Path | None,
        typer.Option(help="Write a figure to this file (.png, .svg, .pdf); of the cup if sphere is the first model."),
    ] = None
    section: Annotated[
        Path | None, typer.Option(help="fem: write a figure of mesh, stress and pressure (.png, .svg, .pdf).")
    ] = None
    view: Annotated[Path | None, typer.Option(help="sphere: write a three-dimensional picture of the cup (.png).")] = (
        None
    )
    vtk: Annotated[
        Path | None, typer.Option(help="fem: write meshes and fields (.vtu, .vtk); sphere: surfaces of bore and ball.")
    ] = None

    def check(self) -> None:
        """Raise ValueError for a file format that cannot be written."""
        check_format(self.figure, self.section)
        if self.view is not None:
            from ..core.storage.atomic_files import check_ending

            check_ending("view", self.view, ".png")
        if self.vtk is not None:
            from ..elasticity.finite_elements.section import check_vtk_path

            check_vtk_path(self.vtk)

    def check_models(self, models: Container[str]) -> None:
        """Raise ValueError for a file that needs a model which is not among the named ones."""
        has_mesh, has_view = JUDGE in models, OFF_AXIS in models
        if self.section is not None and not has_mesh:
            raise ValueError(f"--section is for the finite elements: add --model {JUDGE}")
        if self.vtk is not None and not (has_mesh or has_view):
            raise ValueError(f"--vtk is for the finite elements: add --model {JUDGE}, or {OFF_AXIS}")
        if self.view is not None and not has_view:
            raise ValueError(f"--view is for contacts off the axis: add --model {OFF_AXIS}")

    def check_single(self, count: int) -> None:
        """Raise ValueError for a file that shows one joint, if there are several."""
        for name, path in vars(self).items():
            if path is not None and count > 1:
                raise ValueError(f"--{name} shows one joint, got {count}; --report shows several")

    def write(self, comparison: Comparison, first_model: str, units: Units) -> None:
        """Write the files for the results; `first_model` is the name of the first requested model."""
        contacts = successful_contacts(comparison)
        if self.figure is not None and contacts:
            from ..reports import press_plots

            alone = first_model == OFF_AXIS and first_model in contacts
            save(press_plots.plot({first_model: contacts[first_model]} if alone else contacts, units), self.figure)
        loaded = {name: contact for name, contact in contacts.items() if contact.max_pressure > 0}
        meshed: Any = loaded.get(JUDGE)
        tilted: Any = loaded.get(OFF_AXIS)
        if _can_write(self.section, meshed):
            from ..reports.section_plots import section_figure

            write_figure(self.section, lambda: section_figure(meshed, contacts.get(reference.name)), units)
        if _can_write(self.view, tilted):
            from ..reports.cup_plots import save_view

            save_view(tilted, self.view, units)
        if JUDGE in comparison and _can_write(self.vtk, meshed):
            from ..elasticity.finite_elements.section import write_vtk as write_meshes

            write_meshes(meshed.section, self.vtk)
        elif JUDGE not in comparison and _can_write(self.vtk, tilted):
            from ..elasticity.off_axis.vtk import write_vtk as write_surfaces

            write_surfaces(tilted, self.vtk)


def _can_write(path: Path | None, contact: Any) -> TypeGuard[Path]:
    """Return True for a path and a contact; with a path alone, print a message."""
    if path is not None and contact is None:
        print_message("without a contact there is nothing to draw or write")
    return path is not None and contact is not None


@dataclass(frozen=True, kw_only=True)
class ReportOptions:
    """Options of the report, with the tolerances of the drawing."""

    report: Annotated[
        Path | None, typer.Option(help="Write a report on one page to this file (.html, or .pdf with the extra pdf).")
    ] = None
    tolerance: Annotated[
        list[str] | None,
        typer.Option(help="Tolerance in the report: 'clearance=0.1+-0.05 mm'. Repeat for several. Default: none."),
    ] = None

    def check(self) -> None:
        """Raise an error for a page that cannot be written, an unknown tolerance, or tolerances without a report."""
        _ = self.tolerances
        if self.report is not None:
            from ..reports.pages import check_page_path

            check_page_path(self.report)
        elif self.tolerance:
            raise ValueError(f"--tolerance {self.tolerance[0]!r} is for the report: add --report press.html")

    @property
    def tolerances(self) -> dict[str, Distribution]:
        """Distributions of the tolerances by parameter; ValueError for an unknown name or a name stated twice."""
        if not self.tolerance:
            return {}
        from ..studies.expressions import parse_distribution

        return unique(map(parse_distribution, self.tolerance))

    def design(self, answer: PressAnswer, units: Units, remarks: Sequence[str]) -> Any:
        """Return a design of the report with the effect of its tolerances; None without a report."""
        if self.report is None:
            return None
        from ..reports.press_report import PressedDesign

        return PressedDesign(
            comparison=answer.comparison,
            file=answer.file,
            leading=answer.leading,
            uncertainty=self._tolerance_study(answer.comparison, answer.file),
            command=self._command(answer.comparison, answer.models, units),
            remarks=remarks,
        )

    def write(self, designs: Sequence[Any], units: Units) -> None:
        """Write the report of designs if there is a file for it."""
        if self.report is None:
            return
        from ..reports.pages import write_page
        from ..reports.press_report import designs_report

        write_page(designs_report(designs, units), self.report, units.paper)

    def _command(self, comparison: Comparison, models: Iterable[str], units: Units) -> str:
        """Return the options that compute the results from the joint file: models, rings, tolerances and units."""
        words = [f"--model {name}" for name in models]
        tilted: Any = comparison.get(OFF_AXIS)
        if tilted is not None and tilted.model.ring_width != type(tilted.model).ring_width:
            words.append(f'--ring-width "{degrees(tilted.model.ring_width):.6g} deg"')
        words += [f'--tolerance "{text}"' for text in self.tolerance or ()]
        words += ["--report again.html"] if self.tolerance else []
        words += [f"--units {units}"] if units is not Units.SI else []
        return " ".join(words)

    def _tolerance_study(self, comparison: Comparison, file: JointFile) -> LocalUncertainty | None:
        """Compute the effect of the tolerances; None without contact, and off the axis without tolerances."""
        from ..studies.derivatives import local_uncertainty, off_axis_uncertainty

        load = {name: float(value) for name, value in file.load.items()}
        if not any(value > 0 for value in load.values()):
            return None
        if OFF_AXIS not in comparison:
            return local_uncertainty(file.joint, file.cup, load, self.tolerances)
        if not self.tolerances:
            return None
        model = comparison[OFF_AXIS].model
        return off_axis_uncertainty(file.joint, model, load, self.tolerances, file.aim.get("tilt"))
