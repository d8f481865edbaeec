"""Run benchmarks: each measures this package and its rivals in one run."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module

from . import report
from .timing import MissingError

BENCHMARKS = {
    "start": "whole processes: the first answer, and the whole paper",
    "question": "one press or one force at a time",
    "curve": "one joint, a million loads",
    "joints": "a joint of its own for each load",
    "exact": "a rigid backing or layers, centred load",
    "fem": "finite elements",
    "sphere": "a tilted load in a real cup",
    "motion": "force, moment and tangent of a joint in motion",
    "hosts": "a ball joint in programs of mechanics",
    "four-bar": "one second of a spatial four-bar with clearance",
    "wear": "wear of a hip over a million cycles",
    "cohort": "a million patients, a million cycles each",
    "film": "the lubricating film",
    "studies": "many presses into a store",
    "identify": "clearance and modulus from 20 points",
    "gpu": "on a GPU, through JAX",
    "explorer": "the explorer in a browser",
    "scaling": "cost against size; draws docs/scaling.png",
}
"""Title by name; the module has the same name."""


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="benchmarks to run; none lists them")
    parser.add_argument("--write", action="store_true", help="put the rows into benchmarks/RESULTS.md")
    options = parser.parse_args(words)
    unknown = [name for name in options.names if name not in BENCHMARKS]
    if unknown:
        parser.error(f"unknown benchmark {unknown[0]!r}; known: {', '.join(BENCHMARKS)}")
    if not options.names:
        for name, title in BENCHMARKS.items():
            print(f"{name:<16} {title}")
    for name in options.names:
        try:
            rows = list(import_module(f".{name.replace('-', '_')}", __package__).measure())
        except (ModuleNotFoundError, MissingError) as missing:
            print(f"{name}: skipped: {missing}")
            continue
        report.show(name, BENCHMARKS[name], rows)
        if options.write:
            report.write(name, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
