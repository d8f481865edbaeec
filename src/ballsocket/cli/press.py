"""`press`: one joint, one load, models side by side."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import typer

import ballsocket as bs

from ..catalogue import judge, off_axis, reference
from ..compare import Comparison, successful_contacts
from ..contact import Model
from ..core.checks import known_name
from ..core.validity import Status
from ..io.joint_file import JointFile
from ..problem.cup import UP
from ..reports import terminal
from ..reports.unit_systems import Units
from . import elements
from .files import Files
from .groups import grouped
from .off_axis import AimWords, Watched, aimed, along, remark
from .report import ReportWords
from .root import FAILURE, app, complain
from .words import AsJson, JointWords, LoadWords, echo_json

DEFAULT_MODEL = "hess-forsbach"


@dataclass(frozen=True, kw_only=True)
class ModelWords:
    """The models that are asked."""

    model: Annotated[list[str] | None, typer.Option(help="A model's name; repeat for more.")] = None
    every: Annotated[bool, typer.Option("--all", help="Every model of the catalogue.")] = False

    @property
    def names(self) -> list[str]:
        """Those that are named, as the catalogue has them."""
        return [known_name("model", name, (*bs.catalogue, judge.name, off_axis.name)) for name in self.model or ()]

    @property
    def judged(self) -> bool:
        """Whether the finite elements are among them."""
        return judge.name in self.names

    def chosen(self, default: str) -> dict[str, Model]:
        """The models by their names, the default where none is asked for."""
        if self.every:
            return dict(bs.catalogue)
        asked = {judge.name: judge, off_axis.name: off_axis}
        return {name: asked.get(name) or bs.catalogue[name] for name in self.names or [default]}


@app.command()
@grouped
def press(
    *,
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    load: LoadWords,
    models: ModelWords,
    units: Annotated[Units, typer.Option(case_sensitive=False, help="Of the table; JSON has mm, N, MPa.")] = Units.SI,
    as_json: AsJson = False,
    files: Files,
    page: ReportWords,
    aim: AimWords,
    cup: elements.CupWords,
    mesh: Annotated[elements.MeshWords, "fem"],
    meshes: Annotated[int | None, typer.Option(min=1, max=2, help="fem: 1 gives no error bars")] = None,
) -> None:
    """Press a ball into its socket and see what models make of it, beside the exact answer.

    The finite elements (--model fem) also answer for rims, chamfers and liners that slide; sphere for loads that are
    tilted against the cup's axis (--tilt, --direction).

    Exit status: 0 done, 2 misuse, 3 an iteration that did not converge, or no answer from any model.
    """
    if not models.judged:
        elements.refuse({**vars(mesh), "meshes": meshes})
    files.check()
    page.check()
    file = words.or_named(joint)
    at = load.or_of(file)
    toward, remarks = aim.or_of(file), []
    around = aimed(cup.on(file.cup), toward)
    asks_sphere = toward or around.tilt(UP) > 0 or file.joint.clearance < 0
    chosen = models.chosen(off_axis.name if asks_sphere else DEFAULT_MODEL)
    if models.judged and toward:
        raise ValueError("fem presses along the cup's own axis; for a tilt or a direction ask --model sphere")
    files.check_models(chosen)
    if off_axis.name not in chosen:
        aim.refuse()
    if off_axis.name in chosen:
        watched: Any = Watched(along(aim.model(), around, toward))
        chosen[off_axis.name] = watched
    if models.judged:
        fem = mesh.model(around, meshes or 2)
        chosen[judge.name] = fem
        remarks.append(elements.remark(*elements.timed(fem, file.joint, at)))
    comparison = _compared(replace(file, cup=around), at, chosen)
    if off_axis.name in comparison:
        remarks.append(remark(comparison[off_axis.name], watched.seconds))
    files.write(comparison, next(iter(chosen)))
    page.write(comparison, replace(file, cup=around, load=at, aim=toward), units)
    if as_json:
        echo_json(comparison.summary())
    else:
        terminal.print_press(comparison, remarks, units)
    _end(comparison, chosen)


def _compared(file: JointFile, load: Mapping[str, float], chosen: Mapping[str, Model]) -> Comparison:
    """The chosen models beside the exact answer, if any of them has an answer for such a joint."""
    comparison = bs.compare(file.joint, models={**chosen, reference.name: reference}, cup=file.cup, **load)
    if not set(comparison) & set(chosen):
        raise ValueError("; ".join(why for name, why in comparison.missing.items() if name in chosen))
    return comparison


def _end(comparison: Comparison, chosen: Iterable[str]) -> None:
    """Leave with a sentence and an exit status where the answer is a failure as a whole."""
    failure = _failure(comparison, chosen)
    if failure:
        complain(failure)
        raise typer.Exit(FAILURE)


def _failure(comparison: Comparison, chosen: Iterable[str]) -> str:
    """What went wrong as a whole, or an empty text: a model without an answer is a note while another one has one."""
    unsettled = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
    if unsettled:
        return f"no convergence of {', '.join(unsettled)} (see the notes)"
    return (
        ""
        if set(successful_contacts(comparison)) & set(chosen)
        else f"no answer from {', '.join(chosen)} (see the notes)"
    )
