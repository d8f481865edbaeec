"""`calibrate` and `build-tables`: the exact answer carried into closed forms and tables."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated

import numpy
import typer

import ballsocket as bs

from ..core.checks import known_name
from ..core.kinds import Kind
from ..identify.modulus import FORCES, Form
from ..io.units import parse
from ..paper.table_3 import refit_table_3
from ..reports.reference_terminal import print_calibration, print_table_3
from .root import app, echo_path
from .words import AsJson, echo_json, named_joint

_FORMS: dict[str, Form] = {
    "constant": bs.as_constant,
    "polynomial": bs.as_polynomial,
    "corrected-vessel": bs.as_corrected_vessel,
}


@app.command()
def calibrate(
    joint: Annotated[str | None, typer.Argument(help="A joint file or a preset's name; none refits Table 3.")] = None,
    force: Annotated[list[str] | None, typer.Option(help="A load, '2 kN'; repeat. Default 1, 2 and 3 kN.")] = None,
    thickness: Annotated[list[str] | None, typer.Option(help="A liner thickness, '5 mm'; repeat for a family.")] = None,
    form: Annotated[str, typer.Option(help="constant, polynomial (Eq. 18) or corrected-vessel")] = "constant",
    as_json: AsJson = False,
) -> None:
    """Fit the closed form's foundation modulus to the exact answer: for one joint, or as the paper did (Table 3)."""
    if joint is None:
        if force or thickness or form != "constant":
            raise ValueError(
                "--force, --thickness and --form need a joint; without one Table 3 is fitted as the paper did"
            )
        columns = refit_table_3()
        if as_json:
            echo_json({"version": bs.__version__, "table_3": [column.summary() for column in columns]})
        else:
            print_table_3(columns)
        return
    form = known_name("form", form, _FORMS)
    given = named_joint(joint).joint
    if thickness:
        lengths = [parse("thickness", text, Kind.LENGTH) for text in thickness]
        given = dataclasses.replace(given, liner_thickness=numpy.array(lengths))
    loads = [parse("force", text, Kind.FORCE) for text in force or []] or FORCES
    fit = bs.calibrate(given, force=loads, form=_FORMS[form])
    if as_json:
        echo_json({"version": bs.__version__, "joint": given.summary(), **fit.summary()})
    else:
        print_calibration(fit)


@app.command(hidden=True)  # for those who work on the tables
def build_tables(
    out: Annotated[Path | None, typer.Option(help="Where to; without it the package's own file.")] = None,
    points: Annotated[int, typer.Option(min=1, help="Random contacts that the tables are checked at.")] = 10_000,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
    check: Annotated[bool, typer.Option("--check", help="Check the tables that are there, and build none.")] = False,
) -> None:
    """Build the tables of `tabulated` from the exact answer (two minutes), and report how accurate they are."""
    from ..elasticity.exact.tabulated import build as builder

    path = builder.SHIPPED if out is None else out
    do = builder.check if check else builder.build_tables
    echo_path(path, f": {do(path, points=points, workers=workers)}")
