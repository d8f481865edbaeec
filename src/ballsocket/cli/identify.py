"""Commands `identify`, `calibrate` and `build-tables`: parameters fitted to measurements or to the exact solution."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated, Any

import numpy
import typer

from ..core.checks import known_name
from ..core.kinds import Kind
from ..core.unit_systems import Units
from ..files.joint_file import named_joint
from ..files.toml import read_toml
from ..files.units import parse
from ..identification import as_constant, as_corrected_vessel, as_polynomial
from ..identification import calibrate as fit_modulus
from ..identification.file import read_identify
from ..identification.result_answer import describe_identification
from ..paper.cases import refit_table_3
from ..reports import identify_results
from ..reports.accuracy_results import describe_table_3
from ..reports.figure_files import check_format
from ..studies.calibration import FORCES, Form, describe_calibration
from .options import AsJson, UnitSystem, print_result, write_figure
from .root import app, echo_path, fail

_FORMATS = "(.png, .svg, .pdf)"
_FORMS: dict[str, Form] = {
    "constant": as_constant,
    "polynomial": as_polynomial,
    "corrected-vessel": as_corrected_vessel,
}


@app.command()
def identify(
    file: Annotated[Path, typer.Argument(help="Measurement file (TOML): joint, free parameters, data.")],
    samples: Annotated[
        int | None, typer.Option(help="Number of posterior samples by Markov chains, such as 4000. Default: none.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option(help=f"Write a figure of the fit with its residuals {_FORMATS}.")
    ] = None,
    corner: Annotated[
        Path | None, typer.Option(help=f"Write a figure of the correlations between parameters {_FORMATS}.")
    ] = None,
    experiment: Annotated[
        Path | None, typer.Option(help=f"Write a figure of the most informative next measurement {_FORMATS}.")
    ] = None,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
) -> None:
    """Identify a joint or its wear coefficient from data.

    The table shows each parameter with its uncertainty and names the parameters that are not identifiable.
    A hip file with measured volumes, penetrations or rates in [[data]] gives its wear coefficient.

    Exit status: 0 success, 2 wrong input, 3 the search did not converge.
    """
    check_format(figure, corner, experiment)
    if _has_measured_wear(file):
        for option, value in {"--samples": samples, "--corner": corner, "--experiment": experiment}.items():
            if value is not None:
                raise ValueError(f"{option} needs measurements of a contact, and {file.name} has measured wear")
        _fit_wear(file, figure, units, as_json)
        return
    result = read_identify(file).identify_unknowns()
    posterior = None if samples is None else result.posterior(samples)

    def summarise() -> dict[str, Any]:
        return {
            "joint": result.joint.summary(),
            **result.summary(),
            "posterior": None if posterior is None else posterior.summary(),
            "experiment": result.next.summary(),
        }

    print_result(summarise, lambda: describe_identification(result, posterior), units, as_json)
    write_figure(figure, lambda: identify_results.fit_figure(result), units)
    write_figure(corner, lambda: identify_results.corner_figure(result, posterior), units)
    write_figure(experiment, lambda: identify_results.experiment_figure(result.next), units)
    if not result.best.converged:
        fail("the search did not converge (see the notes)")


def _has_measured_wear(file: Path) -> bool:
    """Check if a file is a hip file: it has a cycle, activities, or data of worn volumes or penetrations."""
    from ..hip.measured_wear import WEAR_QUANTITIES

    content = read_toml(file, "measurement", lambda content: content)
    tables = content.get("data")
    rows = [table for table in tables if isinstance(table, dict)] if isinstance(tables, list) else []
    has_wear = any(str(table.get("quantity")) in WEAR_QUANTITIES for table in rows)
    return "cycle" in content or "activity" in content or has_wear


def _fit_wear(file: Path, figure: Path | None, units: Units, as_json: bool) -> None:
    from ..hip.answers import describe_wear_fit
    from ..hip.config import read_wear_test
    from ..hip.wear_fit import fit_wear_coefficient
    from ..reports.hip_comparison import wear_fit_figure

    hip_file = read_wear_test(file)
    fit = fit_wear_coefficient(hip_file.use, hip_file.data)
    valid = all(check.valid for check in fit.simulation.unworn_checks)
    joint = fit.simulation.joint
    print_result(
        lambda: {"joint": joint.summary(), "valid": valid, **fit.summary()},
        lambda: describe_wear_fit(fit),
        units,
        as_json,
    )
    write_figure(figure, lambda: wear_fit_figure(fit, hip_file.cycles), units)


@app.command()
def calibrate(
    joint: Annotated[
        str | None, typer.Argument(help="Joint file (TOML), or name of a preset. Default: the joints of Table 3.")
    ] = None,
    force: Annotated[
        list[str] | None, typer.Option(help="Load of the fit: '2 kN'. Repeat for several. Default: 1, 2 and 3 kN.")
    ] = None,
    thickness: Annotated[
        list[str] | None, typer.Option(help="Liner thickness: '5 mm'. Repeat for a family. Default: that of the joint.")
    ] = None,
    form: Annotated[
        str, typer.Option(help="Formula of the modulus: constant, polynomial (Eq. 18) or corrected-vessel.")
    ] = "constant",
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
) -> None:
    """Fit a foundation modulus to the exact solution.

    Without a joint, it repeats Table 3 of Heß & Forsbach 2021.
    """
    if joint is None:
        if force or thickness or form != "constant":
            raise ValueError("--force, --thickness and --form need a joint; without a joint Table 3 is fitted")
        columns = refit_table_3()
        print_result(
            lambda: {"table_3": [column.summary() for column in columns]},
            lambda: describe_table_3(columns),
            units,
            as_json,
        )
        return
    form = known_name("form", form, _FORMS)
    fitted_joint = named_joint(joint).joint
    if thickness:
        lengths = [parse("thickness", text, Kind.LENGTH) for text in thickness]
        fitted_joint = dataclasses.replace(fitted_joint, liner_thickness=numpy.array(lengths))
    loads = [parse("force", text, Kind.FORCE) for text in force or []] or FORCES
    fit = fit_modulus(fitted_joint, force=loads, form=_FORMS[form])
    print_result(
        lambda: {"joint": fitted_joint.summary(), **fit.summary()},
        lambda: describe_calibration(fit),
        units,
        as_json,
    )


@app.command(hidden=True)  # for developers of the tables
def build_tables(
    out: Annotated[Path | None, typer.Option(help="File to write. Default: the file of the package.")] = None,
    points: Annotated[int, typer.Option(min=1, help="Number of random contacts that check the tables.")] = 10_000,
    workers: Annotated[int, typer.Option(min=1, help="Number of worker processes.")] = 2,
    check: Annotated[bool, typer.Option("--check", help="Check the existing tables and build none.")] = False,
) -> None:
    """Build the tables of the model `tabulated`.

    It takes two minutes and prints the accuracy of the tables.
    """
    from ..elasticity.exact.tabulated import build as builder

    path = builder.SHIPPED if out is None else out
    run = builder.check_tables if check else builder.build_tables
    echo_path(path, f": {run(path, points=points, workers=workers)}")
