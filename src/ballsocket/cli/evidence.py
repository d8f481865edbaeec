"""Commands of documents that are computed: `evidence` packs, and `reproduce`, the results of Heß & Forsbach 2021."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from ..contact.verdict import Verdict
from ..core.checks import needs
from ..core.display import counted
from ..core.executors.processes import Engine, Processes
from ..core.storage.pieces import fingerprint
from ..core.unit_systems import Units
from ..evidence.comparison import compare
from ..evidence.credibility_levels import Record
from ..evidence.folder import SUMS, WORK, check_folder, digest, write
from ..evidence.pack import Listener, count_stored_pieces, gather_evidence, remove_stored_pieces
from ..evidence.question import Question, read_question
from ..reports.evidence_page import conclusions, evidence_page
from .json_answers import echo_json
from .options import AsJson, UnitSystem
from .root import FAILURE, app, echo_path


@app.command()
def evidence(
    question: Annotated[Path | None, typer.Argument(help="Question file (TOML). Default: none, with --check.")] = None,
    out: Annotated[Path, typer.Option(help="Output folder; created if it does not exist.")] = Path("evidence"),
    check: Annotated[
        Path | None,
        typer.Option(
            help="Folder of an evidence pack: compute everything again and list the differences. Default: write a pack."
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="End with exit status 1 unless every limit of the question is kept.")
    ] = False,
    as_json: AsJson = False,
    units: UnitSystem = Units.SI,
    workers: Annotated[int | None, typer.Option(help="Number of worker processes. Default: number of cores.")] = None,
) -> None:
    """Write or check an evidence pack for a computed number.

    The pack is a page and JSON with verification, comparison with published results, and uncertainty. The same command
    resumes a stopped run.

    Exit status: 0 success, 1 with --strict: a limit is not kept, 2 wrong input, 3 the pack differs from the results.
    """
    needs("study", "xarray")
    if (question is None) == (check is None):
        raise ValueError("a question file is needed, or --check with the folder of a pack")
    engine = Processes(workers=workers)
    if check is not None:
        record = _check(check, engine, as_json, units)
    else:
        assert question is not None
        record = _gather(read_question(question), out, engine, as_json, units)
    if strict and not all(limit["verdict"] == Verdict.KEPT.word for limit in record["limits"]):
        raise typer.Exit(_LIMIT_NOT_KEPT)


_LIMIT_NOT_KEPT = 1  # exit status with --strict if a limit is not kept, or if that is not known


def _gather(question: Question, out: Path, engine: Engine, as_json: bool, units: Units) -> Record:
    """Compute and write the pack of a question; return its record."""
    check_folder(out, question)
    resumed = count_stored_pieces(question, out / WORK)
    with _show_progress() as progress:
        record = gather_evidence(question, out / WORK, progress, engine)
        path = write(question, record, partial(evidence_page, units=units), out)
    remove_stored_pieces(out / WORK)
    notes = conclusions(record, Units.SI if as_json else units)
    if resumed:
        notes.append(
            f"{counted(resumed, 'result')} of an earlier, stopped run not computed but read: --check computes all of "
            "them again"
        )
    identifier = digest((out / SUMS).read_bytes())
    if as_json:
        more = {"folder": str(out), "digest": identifier, "valid": record["accurate"]["holds"], "notes": notes}
        echo_json({**record, **more})
        return record
    for note in notes:
        typer.echo(note)
    echo_path(path)
    typer.echo(f"digest of the pack {identifier}")
    return record


def _check(folder: Path, engine: Engine, as_json: bool, units: Units) -> Record:
    """Compute a pack again and print the differences; return its record."""
    with _show_progress() as progress:
        comparison = compare(folder, progress, engine)
    record, differences = comparison.record, comparison.differences
    if as_json:
        echo_json(
            {
                "valid": not differences,
                "made_by": record.get("version"),
                "made_on": record.get("made_on"),
                "compared": comparison.count,
                "differences": list(map(asdict, differences)),
                "digest": comparison.digest,
                "notes": comparison.notes,
            }
        )
    else:
        equal, made = max(0, comparison.count - len(differences)), f"{record.get('version')} on {record.get('made_on')}"
        for line in (
            *map(str, differences),
            f"{equal} of {comparison.count} numbers, words and files are unchanged",
            f"written by ballsocket {made}, computed again by {fingerprint()}",
            *(f"note: {note}" for note in comparison.notes),
            f"digest of the pack {comparison.digest}",
            "author, question and date are not confirmed by a computation: sign checksums.txt with ssh-keygen or gpg",
            *(() if differences else conclusions(record, units)),
        ):
            typer.echo(line)
    if differences:
        raise typer.Exit(FAILURE)
    return record


@contextmanager
def _show_progress() -> Iterator[Listener]:
    """Show a progress line if stderr is a terminal."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("gathering", total=None)
        yield lambda name: progress.update(task, description=name)


@app.command()
def reproduce(
    out: Annotated[Path, typer.Option(help="Output folder; created if it does not exist.")] = Path("reproduced"),
    quick: Annotated[bool, typer.Option("--quick", help="Only the exact solution, without finite elements.")] = False,
    workers: Annotated[int | None, typer.Option(help="Number of worker processes. Default: number of cores.")] = None,
) -> None:
    """Recompute the results of Heß & Forsbach 2021.

    The verdict on each claim of the paper is printed, and the report also shows its tables and figures. A stopped run
    is resumed by the same command.
    """
    from ..paper.plan import full_plan, quick_plan
    from ..reports.paper_report import describe_verdicts, write_report
    from ..reports.terminal import print_answer

    if not quick:
        needs("fem", "skfem", "meshio", "psutil")
    engine = Processes(workers=workers)
    plan = quick_plan() if quick else full_plan()
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("reproducing", total=len(plan))
        advance = partial(progress.update, task, advance=1)
        results = plan.results(out / "data", lambda name: advance(description=name), engine)
        advance(advance=0, description="drawing")
        report = write_report(results, out, engine)
    print_answer(describe_verdicts(results))
    echo_path(report)
