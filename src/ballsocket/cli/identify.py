"""`identify`: from measurements to the numbers of a joint."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ballsocket as bs

from ..identify.file import read_identify
from ..identify.posterior import Posterior
from ..identify.result import IdentificationResult
from ..reports import identify_results
from ..reports.figure_files import check_format, save
from ..reports.identify_results import print_identified
from .root import FAILURE, app
from .words import AsJson, echo_json

_PICTURE = "(.png, .svg, .pdf)"


@app.command()
def identify(
    file: Annotated[Path, typer.Argument(help="A file about measurements (TOML).")],
    samples: Annotated[
        int | None, typer.Option(help="So many samples of the posterior by Markov chains, 4000 say; none without.")
    ] = None,
    figure: Annotated[Path | None, typer.Option(help=f"Write the fit with its residuals {_PICTURE}.")] = None,
    corner: Annotated[
        Path | None, typer.Option(help=f"Write how the unknowns depend on each other {_PICTURE}.")
    ] = None,
    experiment: Annotated[Path | None, typer.Option(help=f"Write what to measure next {_PICTURE}.")] = None,
    as_json: AsJson = False,
) -> None:
    """Identify clearance, modulus, ... of a joint from measurements, with bands, and name the unidentifiable ones.

    Exit status: 0 done, 2 misuse, 3 the search did not converge.
    """
    for path in (figure, corner, experiment):
        if path is not None:
            check_format(path)
    found = read_identify(file).identify_unknowns()
    drawn = None if samples is None else found.posterior(samples)
    if as_json:
        echo_json(_summary(found, drawn))
    else:
        print_identified(found, drawn)
    if figure is not None:
        save(identify_results.fit_figure(found), figure)
    if corner is not None:
        save(identify_results.corner_figure(found, drawn), corner)
    if experiment is not None:
        save(identify_results.experiment_figure(found.next), experiment)
    if not found.best.converged:
        typer.echo("ballsocket: the search did not converge (see the notes)", err=True)
        raise typer.Exit(FAILURE)


def _summary(found: IdentificationResult, drawn: Posterior | None) -> dict[str, Any]:
    posterior = None if drawn is None else drawn.summary()
    return {
        "version": bs.__version__,
        "joint": found.joint.summary(),
        **found.summary(),
        "posterior": posterior,
        "experiment": found.next.summary(),
    }
