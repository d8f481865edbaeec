"""Results of the public entries for data, studies, programs and commands, for `benchmarks.identical`.

A function here records the room that it is named after, as in `entries_of_contact`.
"""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from collections.abc import Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import replace
from hashlib import sha256
from io import StringIO
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest import mock

import numpy

import ballsocket as bs
from ballsocket import studies as design
from ballsocket.identification import HeavyTailed, Machine, Measured, oscillation

from .entries_of_contact import EXAMPLES, SEED

if TYPE_CHECKING:
    from .identical import Results


def identify(results: Results, folder: Path) -> None:
    """Record identifications of synthetic data, and calibrations."""
    random = numpy.random.default_rng(SEED)
    truth = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.Material(young=1000.0, poisson=0.4))
    force = numpy.array([300.0, 800.0, 1500.0, 2500.0, 4000.0])
    pressed = bs.Tabulated().press(truth, force=force)

    def measured(quantity: str, share: float, **words: Any) -> Measured:
        values = numpy.asarray(getattr(pressed, quantity))
        noise = share * values.mean()
        read = values + random.normal(0.0, noise, values.shape)
        return Measured(quantity=quantity, values=read, uncertainty=noise, force=force, **words)

    machine = Machine(offset=(-0.02, 0.02), name="frame")
    depths, areas, angles = measured("indentation", 0.005), measured("area", 0.02), measured("half_angle", 0.03)
    read = measured("indentation", 0.005, machine=machine)
    film = measured("max_pressure", 0.03, saturation=9.0)
    own = oscillation(mass=2.0)
    frequency = (1e3 * pressed.stiffness[:3] / 2.0) ** 0.5 / (2 * numpy.pi)
    swing = Measured(quantity="frequency", values=frequency, uncertainty=4.0, force=force[:3], observable=own)
    by_depth = Measured(
        quantity="force",
        values=pressed.force,
        uncertainty=0.01 * pressed.force,
        indentation=pressed.indentation,
        load_uncertainty=2e-4,
        machine=Machine(compliance=(0.0, 1e-5), drift=1e-5, name="frame"),
    )
    free: dict[str, Any] = {"clearance": (0.02, 0.3), "liner.young": (400.0, 2000.0)}
    poisson = design.Normal(mean=0.4, deviation=0.02)
    cases: dict[str, tuple[Any, Any, dict[str, Any]]] = {
        "indentations": (depths, free, {}),
        "areas": (areas, free, {}),
        "loads": (measured("indentation", 0.005, load_uncertainty=0.02 * force), free, {}),
        "forces": (by_depth, free, {}),
        "machine": ([read, areas], free, {}),
        "heavy-tailed": ([depths, film], free, {"scatter": HeavyTailed()}),
        "known before": ([depths, angles], {**free, "liner.poisson": poisson}, {}),
        "oscillation": ([swing, areas], free, {}),
    }
    for name, (sets, unknowns, words) in cases.items():
        with results.attempt(name):
            fit = bs.identify(bs.Tabulated(), truth, sets, unknowns, **words)
            results.add(name, {**fit.summary(), "point": fit.point, "next": fit.next.summary()})
            results.add(f"{name}/curve", fit.curve(0, 8))
    with results.attempt("springs"):
        springs = bs.identify(bs.HessForsbach(), truth, [depths, areas], {**free, "liner.poisson": poisson})
        results.add("springs", {**springs.summary(), "point": springs.point})
        drawn = springs.posterior(100, seed=1)
        results.add("posterior/summary", drawn.summary())
        results.add("posterior/samples", drawn.samples[::10])
    table = "force_N,force_uncertainty_N,indentation_um,indentation_uncertainty_um,area_mm2,area_uncertainty_mm2\n"
    rows = "500,10,16,0.5,200,5\n1500,20,28,0.6,,\n3000,30,44,0.7,480,9\n"
    (folder / "press.csv").write_text(table + rows, encoding="utf-8")
    (folder / "press.toml").write_text(_MEASURED, encoding="utf-8")
    add_command(results, "file", "identify", str(folder / "press.toml"))
    family = replace(truth, liner_thickness=numpy.array([4.0, 6.0, 8.0, 10.0]))
    forms = {"constant": bs.as_constant, "polynomial": bs.as_polynomial, "vessel": bs.as_corrected_vessel}
    for name, form in forms.items():
        with results.attempt(f"calibrate/{name}"):
            calibration = bs.calibrate(family, form=form, force=[500.0, 2000.0])
            results.add(f"calibrate/{name}", {**calibration.summary(), "residual": calibration.residual})
    with results.attempt("calibrate/reference"):
        results.add("calibrate/reference", bs.calibrate(truth, reference=bs.Refined()).summary())


_MEASURED = """
model = "hess-forsbach"
joint = "hip-36"
scatter = "heavy-tailed"
[free]
clearance = "0.05..0.2 mm"
liner.young = { median = "900 MPa", factor = 1.3 }
[machine.frame]
offset = "-10..10 um"
drift = "0.1 um"
[[data]]
file = "press.csv"
quantities = ["indentation", "area"]
gaps = "leave-out"
machine = "frame"
[[data]]
quantity = "frequency"
values = ["1.1 kHz", "1.3 kHz"]
uncertainty = "2 %"
force = ["1 kN", "3 kN"]
load_uncertainty = "10 N"
mass = "2 kg"
"""


def studies(results: Results, folder: Path) -> None:
    """Record designs, studies, and the questions that follow from them."""
    joint = bs.joints["hess-forsbach"]
    scattered: dict[str, Any] = {
        "clearance": design.tolerance(0.10, 0.05),
        "liner_young": design.LogNormal(median=1000.0, factor=1.2),
        "liner_poisson": design.Rectangular(low=0.38, high=0.45),
    }
    sample = design.sample(32, seed=2, **scattered)
    hypercube = design.sample(16, seed=2, method=design.Method.LATIN_HYPERCUBE, **scattered)
    (folder / "rows.csv").write_text("force_N,clearance_mm\n1000,0.05\n2500,0.1\n4000,0.2\n", encoding="utf-8")
    grid = design.grid(ball_radius=design.Span(11.0, 23.0, 6), liner_thickness=[3.0, 6.0, 9.0], force=[1e3, 4e3])
    designs = {
        "grid": grid,
        "sample": sample * design.grid(force=design.Span(500.0, 3000.0, 3)),
        "hypercube": hypercube * design.grid(indentation=[0.01, 0.05]),
        "materials": design.grid(liner=[bs.UHMWPE, bs.POM], half_angle=[0.4, 0.9]),
        "table": design.table(folder / "rows.csv"),
    }
    for (name, points), model in product(designs.items(), (bs.HessForsbach(), bs.Tabulated())):
        with results.attempt(f"{name}/{model.name}"):
            _dataset(results, f"{name}/{model.name}", bs.study(model, joint, points))
    answers = ("indentation", "stiffness", "utilisation", "area", "energy")
    kept = bs.study(
        bs.Exact(), joint, clearance=[0.05, 0.2], force=[1e3, 3e3], quantities=answers, store=folder / "kept"
    )
    _dataset(results, "kept", kept)
    design.export(kept, folder / "kept.csv")
    add_table(results, "exported", folder / "kept.csv")
    _dataset(
        results, "tilted", bs.study(bs.Sphere(ring_width=0.1), joint, tilt=[0.0, 0.9], azimuth=[0.0, 1.0], force=2e3)
    )
    wide = bs.study(bs.Tabulated(), joint, grid)
    limits = [design.Limit(name="outer_radius", high=29.0), design.parse_limit("liner_thickness>=4 mm")]
    results.add("allowed", design.allowed(wide, limits).values)
    _dataset(results, "front", design.pareto(wide, ("area", "max_pressure"), limits))
    ranges = {"ball_radius": (11.0, 23.0), "liner_thickness": (3.0, 15.0)}
    for model in (bs.HessForsbach(), bs.Tabulated()):
        best = design.optimise(model, joint, ranges, load={"force": 3000.0}, limits=limits)
        results.add(f"optimum/{model.name}", best.summary())
        at = {"clearance": 0.1, "liner_young": 1000.0, "force": 3000.0}
        results.add(f"elasticities/{model.name}", design.elasticities(model, joint, ("area", "max_pressure"), at))
    shares = design.sensitivity(bs.HessForsbach(), joint, scattered, count=64, seed=5, load={"force": 3000.0})
    _dataset(results, "sensitivity", shares)


def _dataset(results: Results, name: str, dataset: Any) -> None:
    """Add the coordinates and variables of a study."""
    for kind in ("coords", "data_vars"):
        results.add(f"{name}/{kind}", {str(key): variable.values for key, variable in getattr(dataset, kind).items()})


_COMMENT = re.compile(r'/\*.*?\*/|<!--.*?-->|"""[^"]*"""|"[^"\n]*"|^\s*(?://|#|\*\*)[^\n]*', re.DOTALL | re.MULTILINE)
_NUMBER = re.compile(r"(?<![\w.])-?\d+\.\d*(?:[eE][-+]?\d+)?|(?<![\w.])-?\d+[eE][-+]?\d+")


def add_program(results: Results, name: str, text: str) -> None:
    """Add a program: its numbers, the digest of its code without comments and messages, and its text."""
    text = text.replace(bs.__version__, "VERSION")
    code = "\n".join(line.rstrip() for line in _COMMENT.sub("", text).splitlines() if line.strip())
    results.add(f"{name}/numbers", [float(number) for number in _NUMBER.findall(code)])
    results.add(f"{name}/code", sha256(code.encode()).hexdigest())
    results.add(f"{name}/text", f"text: {text}")


def add_table(results: Results, name: str, path: Path) -> None:
    """Add a table of CSV by its columns."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    for head, *column in zip(*rows, strict=True):
        results.add(f"{name}/{head}", [_number(cell) for cell in column])


def _number(cell: str) -> Any:
    """Convert a cell to a number where it is one."""
    try:
        return float(cell) if cell else None
    except ValueError:
        return cell


def add_command(results: Results, name: str, *words: str) -> None:
    """Run a command with --json, and add its exit status, its object and what it complains of."""
    with results.attempt(name):
        status, text, complaint = run_command(*words, "--json")
        results.add(f"{name}/status", status)
        lines = (line for line in complaint.splitlines() if "━" not in line)  # no bar of progress
        results.add(f"{name}/complaint", f"complaint: {' '.join(lines)}")
        results.add(name, json.loads(text))


def run_command(*words: str) -> tuple[int, str, str]:
    """Run the command line in this process; return its exit status and both its streams."""
    from ballsocket.cli import main

    out, complaints, status = StringIO(), StringIO(), 0
    with (
        mock.patch.object(sys, "argv", ["ballsocket", *words]),
        redirect_stdout(out),
        redirect_stderr(complaints),
        chdir(EXAMPLES.parent),
    ):
        try:
            main()
        except SystemExit as end:
            status = int(end.code or 0)
    return status, out.getvalue(), complaints.getvalue()


def command(results: Results, folder: Path) -> None:
    """Record the answers of the command line on the examples."""
    (folder / "study.toml").write_text(_STUDY, encoding="utf-8")
    for name, words in _COMMANDS.items():
        add_command(results, name, *words.format(folder=folder).split("|"))
    for name, words in {"models": "models", "presets": "presets"}.items():
        add_command(results, name, words)
    for name, words in _TEXTS.items():
        with results.attempt(name):
            status, text, _ = run_command(*words.format(folder=folder).split("|"))
            results.add(name, {"status": status, "text": f"text: {text}"})
    for path in sorted((folder / "deck").iterdir()):
        add_program(results, f"deck/{path.name}", path.read_text(encoding="utf-8"))


def evidence(results: Results, folder: Path) -> None:
    """Record a pack of evidence of one case, without finite elements."""
    text = (EXAMPLES / "evidence.toml").read_text(encoding="utf-8")
    changes = {"finite_elements = true": "", '"32 mm", ': "", '"0.05 mm", ': "", '"2 kN", ': ""}
    for old, new in changes.items():
        text = text.replace(old, new)
    (folder / "evidence.toml").write_text(text, encoding="utf-8")
    words = ("-m", "ballsocket", "evidence", str(folder / "evidence.toml"), "--out", str(folder / "pack"))
    subprocess.run([sys.executable, *words], cwd=EXAMPLES.parent, check=True, capture_output=True)
    results.add("pack", json.loads((folder / "pack" / "evidence.json").read_text(encoding="utf-8")))


_STUDY = """
joint = "hip-36"
model = "tabulated"
quantities = ["area", "stiffness", "max_pressure"]
[axes]
ball_radius = { from = "14 mm", to = "18 mm", count = 3 }
force = ["1 kN", "3 kN"]
liner = ["uhmwpe", "pom"]
[samples]
count = 8
clearance = { nominal = "0.1 mm", plus_minus = "0.05 mm" }
"""
_COMMANDS: Mapping[str, str] = {
    "press/all": "press|examples/hip.toml|--all",
    "press/backed": "press|examples/metal_backed_hip.toml|--model|refined",
    "press/words": (
        "press|--ball-radius|16 mm|--clearance|50 um|--liner-thickness|6 mm|--liner|uhmwpe|--half-angle|40 deg"
    ),
    "press/changed": "press|hip-36|--liner|uhmwpe|--head-diameter|32 mm|--indentation|30 um|--model|hertz",
    "press/tilted": "press|examples/tilted_hip.toml|--ring-width|6 deg",
    "press/fem": "press|hip-28|--force|2 kN|--model|fem|--meshes|1|--element-size|0.7 mm|--arc-of-cover|150 deg",
    "curve/exact": "curve|hip-28|--force|3 kN|--points|7",
    "curve/liu": "curve|hip-28|--half-angle|50 deg|--points|7|--model|liu-reconstruction",
    "orient": "orient|examples/tilted_hip.toml|--inclination|35..60|--anteversion|0..30|--points|3|--ring-width|6 deg",
    "map": "map|examples/hip.toml|--points|6|--limit|outer_radius<=26 mm|--limit|edge_distance>=1 mm",
    "optimise": (
        "optimise|examples/hip.toml|--vary|ball_radius=11..23 mm|--vary|liner_thickness=3..15 mm|"
        "--limit|outer_radius<=26 mm"
    ),
    "optimise/choices": (
        "optimise|hip-36|--vary|head_diameter=28,32,36 mm|--vary|liner=uhmwpe,crosslinked-pe|--force|3 kN|"
        "--limit|outer_diameter<=48 mm"
    ),
    "optimise/front": (
        "optimise|examples/hip.toml|--vary|ball_radius=11..23 mm|--vary|liner_thickness=3..15 mm|--points|9|"
        "--minimise|area|--minimise|max_pressure"
    ),
    "sensitivity": (
        "sensitivity|examples/hip.toml|--spread|clearance=0.10+-0.05 mm|--spread|liner_poisson=0.38..0.46|--count|64"
    ),
    "study": "study|{folder}/study.toml",
    "hip": "hip|examples/hip_in_use.toml",
    "identify/joint": "identify|examples/measured_joint.toml",
    "identify/areas": "identify|examples/measured_areas.toml",
    "calibrate": "calibrate|hip-32|--force|500 N|--force|2.5 kN",
    "calibrate/family": "calibrate|hip-32|--thickness|4 mm|--thickness|6 mm|--thickness|9 mm|--form|polynomial",
}
"""Commands that answer --json, their words parted by bars."""

_TEXTS: Mapping[str, str] = {
    "text/press": "press|examples/hip.toml",
    "text/models": "models",
    "text/cite": "cite",
    "text/refusal": "press|hip-28|--force|-3 kN",
    "text/deck": "deck|hip-28|--indentation|30 um|--element-size|0.7 mm|--out|{folder}/deck|--steps|2",
}
"""Commands that answer in words."""
