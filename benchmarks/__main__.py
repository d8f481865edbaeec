"""The runner: `python -m benchmarks` lists the benchmarks, `python -m benchmarks NAME ... [--write]` runs them.

Options of a benchmark are arguments of its function `measure`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from inspect import signature

from . import report

BENCHMARKS = {
    "inverse": ("inverse", "ten million inverse solves of the paper's model: compiled, NumPy, JAX, SciPy"),
    "opensim": ("opensim_rival", "one force evaluation against OpenSim's ElasticFoundationForce"),
    "one-question": (
        "one_question",
        "a press, a law, the formula, and OpenSim, one at a time; a joint each",
    ),
    "plane-layer": ("plane_layer", "one case of the numerical plane layer, alone and in a batch"),
    "random-joints": ("random_joints", "a hundred thousand random joints through the exact solver, one by one"),
    "hemisphere": ("hemisphere", "the closed sphere of the exact solver beside a hemisphere by finite elements"),
    "exact": ("exact", "the exact answer: a first load, further loads, a curve, a sweep; and CalculiX"),
    "fem": ("fem", "the finite elements: default mesh, the paper's mesh, cost against size; and CalculiX"),
    "papers-mesh": ("papers_mesh", "CalculiX and the finite elements on the paper's mesh: a quarter of an hour"),
    "reproduce": ("reproduce", "the whole paper by one command: quick, full, and when everything is kept"),
    "studies": ("studies", "studies of ten million presses, what they add, and their cost against size: 10 minutes"),
    "blocks": (
        "blocks",
        "blocks of large studies, Dask's processor time for each, and memory of samples",
    ),
    "tabulated": (
        "tabulated",
        "a million presses by force from the tables, beside the exact solver and the paper's model",
    ),
    "inverse-of-solved": (
        "inverse_of_solved",
        "a million presses by force of tabulated and refined: NumPy, numba and JAX, with the goals",
    ),
    "off-axis": ("off_axis", "a ball in a cup at a tilt: set up, displacement, force, a cycle; and CalculiX"),
    "off-axis-many": ("off_axis_many", "tilted loads on one real cup in batches: NumPy and JAX on one core"),
    "rings": ("rings", "a tilted cup by the number of its rings: set up, displacement, force, and error"),
    "force-element": ("force_element", "the joint in motion: force, moment and tangent, beside OpenSim"),
    "hip": ("hip", "a hip in use: a cycle, millions of them, springs and real cup; and a loop by hand in NumPy"),
    "wear-on-springs": (
        "wear_on_springs",
        "a million cycles on springs against rings and instants: numba, NumPy in blocks, NumPy in one block",
    ),
    "film": ("film", "the lubricating film: three methods, cost against cells, a cycle; and a loop in NumPy"),
    "element-in-c": ("element_in_c", "one evaluation of the force element: exported to C, in Python, in NumPy"),
    "scaling": ("scaling", "cost against size: presses, tilted loads, cells, instants, patients and workers"),
    "patients": ("patients", "hips of patients who differ, a million cycles each, and ten thousand of them on paper"),
    "cohort": ("cohort", "a million similar patients by a series, beside a simulation of each: time and error"),
    "bounce": ("bounce", "a ball that bounces in its socket, in every program that a joint is exported to"),
    "four-bar": ("four_bar", "a second of a spatial four-bar with clearance: compiled, in Python, in Exudyn"),
    "identify": ("identify", "clearance and modulus from twenty points: the best point, 4000 samples of the posterior"),
    "identifiability": (
        "identifiability",
        "synthetic data: unknowns that count as identifiable, and coverage with wrong data or machines: 10 minutes",
    ),
    "evidence": ("evidence", "a pack of evidence for 81 cases off the axis, with and without finite elements"),
    "in-motion": ("in_motion", "a ball joint in MuJoCo, Exudyn, OpenSim and FMI, beside what these have themselves"),
    "gpu": (
        "gpu",
        "presses on a GPU through PyTorch and JAX, against its memory's bandwidth; skipped without one",
    ),
    "app": ("app", "the explorer in a browser: first load, sliders, many sessions, floods; and empty pages"),
    "identical": ("identical", "results of every public entry, recorded twice and compared bit for bit"),
    "import": ("start", "how long a fresh interpreter takes to import the package and to answer a joint file"),
}
"""Name: the module with a `measure()`, and one line on it."""


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="which to run; none lists them")
    parser.add_argument("--write", action="store_true", help="also put the rows into benchmarks/RESULTS.md")
    parser.add_argument(
        "--other", metavar="PATH", help="checkout of another version, which `app`, `blocks` and `import` measure too"
    )
    parser.add_argument("--python", metavar="PATH", help="interpreter with the rivals of `app`, if not this one")
    given = parser.parse_args(words)
    for name in given.names:
        if name not in BENCHMARKS:
            return _unknown(name)
    if not given.names:
        for name, (_, title) in BENCHMARKS.items():
            print(f"{name:<14} {title}")
    for name in given.names:
        module, title = BENCHMARKS[name]
        measure = import_module(f".{module}", __package__).measure
        options = {key: value for key in ("other", "python") if (value := getattr(given, key)) is not None}
        unknown = [key for key in options if key not in signature(measure).parameters]
        if unknown:
            print(f"benchmarks: {name} has no option --{unknown[0]}", file=sys.stderr)
            return 2
        found = measure(**options)
        if isinstance(found, str):
            print(f"{name}: skipped, {found}")
            continue
        report.show(name, title, found)
        if given.write:
            report.write(name, title, found)
    return 0


def _unknown(name: str) -> int:
    close = get_close_matches(name, BENCHMARKS, n=1, cutoff=0.0)
    print(f"benchmarks: {name!r} is not known; did you mean {close[0]!r}?", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
