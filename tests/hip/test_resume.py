"""Resumed runs equal uninterrupted ones bit by bit, and checkpoints of other runs are refused."""

import os
import random
import subprocess
import sys
from dataclasses import fields, replace
from math import radians
from subprocess import DEVNULL

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.storage.atomic_files import read_arrays, write_arrays
from ballsocket.hip import Activity, Archard, FilmLimit, Mix, in_vivo, iso_14242_1, iso_14242_4, logarithmic
from ballsocket.hip.simulation import make_checkpoint

from ..cli.command import answer
from ..processes import stopped_program
from .hips import QUICK, SHORT, K, hip, refuses, write_edited_file

WIDE = {"ring_width": radians(9.0), "cycle": iso_14242_1(16)}
PARTS = {in_vivo("walking", 750.0, 16): 9e5, in_vivo("stairs-up", 750.0, 16): 1e5}
MIX = Mix(activities=tuple(Activity(cycle=cycle, per_year=count) for cycle, count in PARTS.items()))
KINDS = {
    "springs": {},
    "creep": {"creep": logarithmic()},
    "ball": {"ball_wear": Archard(coefficient=K)},
    "mix": {"cycle": MIX},
    "steep cup": {"cup": bs.Cup(inclination=radians(60.0))},
    "microseparation": {"cycle": replace(iso_14242_4(), n_steps=16)},
    "creeping shell": {"surface": bs.ClosedShell(), "creep": logarithmic()},
}
CYCLES, REPORTS = 1e5, [2e4]


class KilledError(Exception):
    pass


def interrupted(use, store):
    """Run a hip that is interrupted after every block, and resume it until it ends; count all blocks."""
    total = 0
    for _ in range(200):

        def listen(cycles):
            nonlocal total
            total += 1
            if cycles not in (*REPORTS, CYCLES):  # there the state is stored after the report
                raise KilledError

        try:
            return replace(use).after(CYCLES, REPORTS, progress=listen, store=store), total
        except KilledError:
            pass
    raise AssertionError("the run did not end")


@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=pytest.mark.long if "shell" in kind else ()) for kind in KINDS]
)
def test_an_interrupted_run_equals_an_uninterrupted_one(kind, tmp_path):
    use = hip(**WIDE | KINDS[kind])
    expected, (resumed, total) = replace(use).after(CYCLES, REPORTS), interrupted(use, tmp_path)
    assert resumed.steps == expected.steps == total > 3  # no block is lost
    assert resumed.error == expected.error
    for report, twin in zip(expected.reports, resumed.reports, strict=True):
        assert (type(twin.converged), type(twin.volume)) == (bool, float)
        for field in fields(report):
            assert np.array_equal(getattr(report, field.name), getattr(twin, field.name), equal_nan=True), field.name


def test_a_finished_run_is_not_repeated_and_can_be_continued(tmp_path):
    use, store = hip(**QUICK), tmp_path / "new" / "folder"
    first = use.after(2e5, store=store)
    blocks = []
    assert use.after(2e5, progress=blocks.append, store=store).last.volume == first.last.volume
    assert not blocks
    longer = use.after(4e5, [2e5], store=store)
    assert longer.reports[0].volume == first.last.volume
    assert longer.last.volume == pytest.approx(use.after(4e5).last.volume, rel=1e-3)
    refuses("400000 cycles .*100000", use.after, 4e5, [1e5], store=store)


def test_checkpoints_of_other_runs_and_damaged_ones_are_refused(tmp_path):
    use, path = hip(**QUICK), tmp_path / "hip_in_use.npz"
    use.after(1e4, store=tmp_path)
    with pytest.raises(ValueError, match="has the checkpoint of another run: another hip, cycle, law or version"):
        hip(wear=Archard(coefficient=2 * K), **QUICK).after(1e4, store=tmp_path)
    arrays = read_arrays(path)
    del arrays["report_0_volume"]
    write_arrays(path, **arrays)
    for content in (path.read_bytes(), b"", b"no archive", b"PK"):
        path.write_bytes(content)
        refuses("hip_in_use.npz is not a checkpoint of a run; delete it to start again", use.after, 1e4, store=tmp_path)


def test_the_identity_depends_on_every_input_of_the_run(tmp_path):
    use = hip()
    hips = {"diameter": 32.0, "clearance": 0.2, "creep": logarithmic(), "ball_wear": Archard(coefficient=K)}
    settings = {"ring_width": 0.06, "tolerance": 1e-3, "seconds_per_cycle": 2.0, "cup": use.cup.tilted(0.1)}
    settings |= {"cycle": use.cycle.scaled(1.1), "film_limit": FilmLimit(ratio=1.0)}
    others = [use, replace(use, film_limit=FilmLimit(ratio=2.0))]
    others += [hip(**{name: value}) for name, value in hips.items()]
    others += [replace(use, **{name: value}) for name, value in settings.items()]
    identities = {make_checkpoint(other, tmp_path).identity for other in others}
    assert len(identities) == len(others)
    assert {len(identity) for identity in identities} == {64}
    assert make_checkpoint(replace(use), tmp_path).identity in identities


KILLS = int(os.environ.get("BALLSOCKET_KILLS", "8"))
"""Number of kills in the long form of the test."""


@pytest.mark.long
def test_a_process_killed_at_random_changes_of_its_files_gives_the_same_json(tmp_path):
    file = str(write_edited_file(tmp_path, *SHORT[1:]))
    words, store, draw = ("hip", file, "--store"), str(tmp_path / "store"), random.Random(20)
    expected = answer(*words, str(tmp_path / "other"))
    for _ in range(KILLS):  # each resumes what the one before has stored
        program = stopped_program(draw.randrange(1, 12), "hip_in_use.npz")
        assert subprocess.run([sys.executable, "-c", program, *words, store], stdout=DEVNULL).returncode != 0
    found = answer(*words, store)
    assert found | {"next": None} == expected | {"next": None}  # these commands name the store
