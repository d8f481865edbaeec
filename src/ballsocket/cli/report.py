"""`press --report`: one page to send."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..catalogue import off_axis, reference
from ..compare import Comparison
from ..core.storage.atomic_files import check_parent_folder, write_atomically
from ..io.joint_file import JointFile
from ..output.press_report import press_report
from ..output.unit_systems import Units
from ..studies.expressions import parse_distribution
from ..studies.local_uncertainty import LocalUncertainty, local_uncertainty

_ENDING = ".html"


@dataclass(frozen=True, kw_only=True)
class ReportWords:
    """The page that is asked for, and how far the numbers of a drawing may be off."""

    report: Annotated[Path | None, typer.Option(help="Write one page to send or print, .html")] = None
    tolerance: Annotated[
        list[str] | None, typer.Option(help="Of the report: 'clearance=0.1+-0.05 mm'; repeat for more")
    ] = None

    def check(self) -> None:
        """Raise ValueError for another ending, a folder that is not there, or tolerances without a report."""
        if self.report is None:
            if self.tolerance:
                raise ValueError(f"--tolerance {self.tolerance[0]!r} is for the report: add --report press{_ENDING}")
            return
        if self.report.suffix.lower() != _ENDING:
            raise ValueError(f"report {str(self.report)!r} must end in {_ENDING}")
        check_parent_folder(self.report)

    def write(self, comparison: Comparison, file: JointFile, units: Units) -> None:
        """Write it, if it is asked for."""
        if self.report is None:
            return
        page = press_report(comparison, file, _leading(comparison), units, self._around(comparison, file))
        with write_atomically(self.report) as draft:
            draft.write_text(page, encoding="utf-8")

    def _around(self, comparison: Comparison, file: JointFile) -> LocalUncertainty | None:
        """What tolerances do along the axis; none is told of a load beside it, nor of a ball that does not touch."""
        if off_axis.name in comparison or not any(float(load) > 0 for load in file.load.values()):
            return None
        return local_uncertainty(
            file.joint, file.cup, _plain(file.load), dict(map(parse_distribution, self.tolerance or ()))
        )


def _leading(comparison: Comparison) -> str:
    """Who gives the verdict: the answer in the cup as it stands, else the exact one, else the first."""
    trusted = [name for name in (off_axis.name, reference.name) if name in comparison and comparison[name].valid]
    return trusted[0] if trusted else next(iter(comparison))


def _plain(load: Mapping[str, float]) -> dict[str, float]:
    return {name: float(value) for name, value in load.items()}
