"""Resumed runs: equal to uninterrupted runs bit by bit, for every kind of run."""

import json
import os
import random
import sys
from dataclasses import fields, replace
from math import radians
from subprocess import DEVNULL, Popen, TimeoutExpired
from time import monotonic

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Activity, Archard, Mix, in_vivo, iso_14242_1, iso_14242_4, logarithmic

from ..cli.command import run
from .hips import K, hip, write_edited_file
from .test_checkpoint import KilledError

WIDE = {"ring_width": radians(9.0), "cycle": iso_14242_1(16)}
MIX = Mix(
    activities=(
        Activity(cycle=in_vivo("walking", 750.0, 16), per_year=9e5),
        Activity(cycle=in_vivo("stairs-up", 750.0, 16), per_year=1e5),
    )
)
QUICK = {
    "springs": hip(**WIDE),
    "creep": hip(**WIDE, creep=logarithmic()),
    "ball": hip(**WIDE, ball_wear=Archard(coefficient=K)),
    "mix": hip(**WIDE | {"cycle": MIX}),
    "shell": hip(**WIDE, surface=bs.ClosedShell()),
}
LONG = {
    "steep cup": hip(**WIDE | {"cup": bs.Cup(inclination=radians(60.0))}),
    "microseparation": hip(**WIDE | {"cycle": replace(iso_14242_4(), n_steps=16)}),
    "creeping shell": hip(**WIDE, surface=bs.ClosedShell(), creep=logarithmic()),
    "cup": hip(**WIDE, surface=bs.RealCup()),
}
CYCLES, REPORTS = 1e5, [2e4]


def assert_same(expected, resumed):
    """Compare every number of two histories to the last bit."""
    assert (resumed.steps, resumed.error) == (expected.steps, expected.error)
    for report, twin in zip(expected.reports, resumed.reports, strict=True):
        for field in fields(report):
            assert np.array_equal(getattr(report, field.name), getattr(twin, field.name), equal_nan=True), field.name


def interrupted(use, store, blocks):
    """Run a hip that is interrupted after every few blocks, and resume it until it ends."""
    for _ in range(200):
        blocks_left = blocks

        def listen(cycles):
            nonlocal blocks_left
            blocks_left -= 1
            if blocks_left <= 0 and cycles not in (*REPORTS, CYCLES):  # there the state is stored after the report
                raise KilledError

        try:
            return replace(use).after(CYCLES, REPORTS, progress=listen, store=store)
        except KilledError:
            pass
    raise AssertionError("the run did not end")


@pytest.mark.parametrize("use", QUICK.values(), ids=QUICK)
def test_an_interrupted_run_equals_an_uninterrupted_one(use, tmp_path):
    uninterrupted = replace(use).after(CYCLES, REPORTS)
    assert uninterrupted.steps > 3
    assert_same(uninterrupted, interrupted(use, tmp_path, blocks=3))


@pytest.mark.long
@pytest.mark.parametrize("use", (QUICK | LONG).values(), ids=QUICK | LONG)
def test_a_run_interrupted_after_every_block_equals_an_uninterrupted_one(use, tmp_path):
    assert_same(replace(use).after(CYCLES, REPORTS), interrupted(use, tmp_path, blocks=1))


def numbers(process):
    """Return the JSON of a run without the commands that follow it, which name the store."""
    return {name: value for name, value in json.loads(process.stdout).items() if name != "next"}


KILLS = int(os.environ.get("BALLSOCKET_KILLS", "20"))
"""Number of kills in the long form of the test."""


@pytest.mark.long
def test_a_process_killed_at_random_times_gives_the_same_json(tmp_path):
    file = write_edited_file(
        tmp_path, ("[1e6, 2e6, 5e6]", "[1e6, 2e6, 3e6, 4e6, 5e6]"), ("instants = 100", "instants = 60")
    )
    expected, draw = numbers(run("hip", str(file), "--json")), random.Random(20)
    words = [sys.executable, "-m", "ballsocket", "hip", str(file), "--json", "--store"]
    begun = monotonic()
    Popen([*words, str(tmp_path / "timed")], stdout=DEVNULL, stderr=DEVNULL).wait(120)
    duration, kills, number = monotonic() - begun, 0, 0
    while kills < KILLS:
        number += 1
        store = str(tmp_path / f"store{number}")
        for _ in range(6):  # each resumes what the one before has stored
            process = Popen([*words, store], stdout=DEVNULL, stderr=DEVNULL)
            try:
                process.wait(draw.uniform(0.5, 1.0) * duration)
                break
            except TimeoutExpired:
                process.kill()
                process.wait()
                kills += 1
        assert numbers(run("hip", str(file), "--json", "--store", store)) == expected
