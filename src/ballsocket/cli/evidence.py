"""Commands of documents that are computed: `evidence` packs, and `reproduce`, the results of Heß & Forsbach 2021."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from ..contact.verdict import Verdict
from ..core.checks import needs
from ..core.executors.processes import Engine, Processes
from ..core.storage.pieces import fingerprint
from ..evidence.comparison import compare
from ..evidence.credibility_levels import Record
from ..evidence.folder import WORK, Signed, check_folder, digest_of, sign_pack, signature_of, write
from ..evidence.pack import Listener, gather_evidence
from ..evidence.plan import count_stored_pieces, remove_stored_pieces
from ..evidence.question import Question, read_question
from ..evidence.signature import PublicKey, SignatureError, public_key_of, read_private_key, read_public_key
from ..reports.evidence_page import conclusions, evidence_page
from ..version import __version__
from .json_answers import echo_json
from .options import AsJson
from .root import FAILURE, app, echo_path

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey


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
    sign: Annotated[
        Path | None,
        typer.Option(
            help="File of an OpenSSH private key (Ed25519) that signs the checksums of the pack. Default: no signature."
        ),
    ] = None,
    verify: Annotated[
        Path | None,
        typer.Option(
            help="With --check: public key file that must match the signature of the pack. Default: not verified."
        ),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="End with exit status 1 unless every limit of the question is kept.")
    ] = False,
    as_json: AsJson = False,
    workers: Annotated[int | None, typer.Option(help="Number of worker processes. Default: number of cores.")] = None,
) -> None:
    """Write or check an evidence pack for a computed number.

    The pack is a page and JSON with verification, comparison with published results, and uncertainty. The same command
    resumes a stopped run; a signed pack is computed in one run.

    Exit status: 0 success, 1 with --strict: a limit is not kept, 2 wrong input, 3 the pack differs from the computation
    or has an invalid signature.
    """
    needs("study", "xarray")
    if (question is None) == (check is None):
        raise ValueError("a question file is needed, or --check with the folder of a pack")
    if verify is not None and check is None:
        raise ValueError("--verify needs --check with the folder that is signed")
    if verify is not None and sign is not None:
        raise ValueError("--verify and --sign exclude each other: one reads the signature, one replaces it")
    key = None if sign is None else read_private_key(sign)
    engine = Processes(workers=workers)
    if check is not None:
        record = _check(check, engine, as_json, key, None if verify is None else read_public_key(verify))
    else:
        assert question is not None
        record = _gather(read_question(question), out, engine, as_json, key)
    if strict and not all(limit["verdict"] == Verdict.KEPT.word for limit in record["limits"]):
        raise typer.Exit(_LIMIT_NOT_KEPT)


_LIMIT_NOT_KEPT = 1
"""Exit status with --strict if a limit is not kept, or if that is not known."""


def _gather(question: Question, out: Path, engine: Engine, as_json: bool, key: Ed25519PrivateKey | None) -> Record:
    """Compute and write the pack of a question, signed if there is a key; return its record."""
    check_folder(out, question)
    resumed = 0 if key is not None else count_stored_pieces(question, out / WORK)
    with _show_progress() as progress, tempfile.TemporaryDirectory() as temporary:
        work = out / WORK if key is None else Path(temporary)
        record = gather_evidence(question, work, progress, engine)
        path = write(question, record, evidence_page, out)
    remove_stored_pieces(out / WORK)
    signed = None if key is None else Signed(public_key_of(key), None)
    if key is not None:
        sign_pack(out, key)
    notes = [*conclusions(record), *([_RESUMED.format(resumed)] if resumed else [])]
    if as_json:
        more = {"digest": digest_of(out), "signature": None if signed is None else signed.summary()}
        echo_json({**record, "folder": str(out), **more, "valid": record["accurate"]["holds"], "notes": notes})
        return record
    for conclusion in conclusions(record):
        typer.echo(conclusion)
    echo_path(path)
    typer.echo(f"digest of the pack {digest_of(out)}")
    if signed is not None:
        typer.echo(f"signed with {signed.key.fingerprint}")
    if resumed:
        typer.echo(_RESUMED.format(resumed))
    return record


_RESUMED = "{} results were read from an earlier, stopped run and not computed: --check computes all of them again"


def _check(
    folder: Path, engine: Engine, as_json: bool, key: Ed25519PrivateKey | None, expected: PublicKey | None
) -> Record:
    """Compute a pack again, print the differences and its signature, and sign it if it is equal and there is a key.

    Return its record.
    """
    with _show_progress() as progress:
        comparison = compare(folder, evidence_page, progress, engine)
    signed, defect = (None, "") if key is not None else _signature(folder, expected, comparison.sums)
    good = not comparison.differences and not defect
    if key is not None and good:
        sign_pack(folder, key, comparison.sums)
        signed = Signed(public_key_of(key), None)
    if as_json:
        echo_json(
            {
                "version": __version__,
                "valid": good,
                "made_by": comparison.made_by,
                "compared": comparison.count,
                "differences": [difference.summary() for difference in comparison.differences],
                "digest": comparison.digest,
                "signature": {"error": defect} if defect else None if signed is None else signed.summary(),
            }
        )
    else:
        for difference in comparison.differences:
            typer.echo(str(difference))
        equal = max(0, comparison.count - len(comparison.differences))
        typer.echo(f"{equal} of {comparison.count} numbers, words and files are unchanged")
        typer.echo(f"written by ballsocket {comparison.made_by}, computed again by {fingerprint()}")
        typer.echo(f"digest of the pack {comparison.digest}")
        typer.echo(_describe_signature(signed, defect, key is not None))
    if not good:
        raise typer.Exit(FAILURE)
    if not as_json:
        for conclusion in conclusions(comparison.record):
            typer.echo(conclusion)
    return comparison.record


def _signature(folder: Path, expected: PublicKey | None, sums: bytes) -> tuple[Signed | None, str]:
    """Return the signature of a pack and an error message, which is empty for a valid signature."""
    try:
        return signature_of(folder, expected, sums), ""
    except SignatureError as error:
        return None, str(error)


def _describe_signature(signed: Signed | None, defect: str, signed_now: bool) -> str:
    """Return the state of a signature as text."""
    if defect:
        return f"signature: {defect}"
    if signed is None:
        return (
            "not signed: the pack differs" if signed_now else "not signed: author, question and date are not confirmed"
        )
    if signed_now:
        return f"signed with {signed.key.fingerprint}"
    if signed.expected:
        return f"signature verified: by {signed.key.fingerprint}"
    return f"signed with {signed.key.fingerprint}, a key that was not compared: compare it with --verify KEY.pub"


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
    from ..reports.paper_report import print_verdicts, write_report

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
    print_verdicts(results)
    echo_path(report)
