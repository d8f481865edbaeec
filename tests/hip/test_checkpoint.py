"""Checkpoints: a killed run resumes, continues to more cycles, and refuses the checkpoint of another run."""

from dataclasses import fields, replace

import numpy as np
import pytest

from ballsocket.core.storage.atomic_files import read_arrays, write_arrays
from ballsocket.hip import Archard, CustomWearLaw, logarithmic
from ballsocket.hip.simulation import make_checkpoint, make_report
from ballsocket.hip.wear_integrator import WearIntegrator

from .hips import QUICK, K, hip, report_after


class KilledError(Exception):
    pass


def killed_after(blocks):
    """Return a progress function that kills a run after some blocks."""

    def listen(cycles):
        nonlocal blocks
        blocks -= 1
        if blocks == 0:
            raise KilledError

    return listen


@pytest.mark.parametrize("creep", [None, logarithmic()], ids=["wear", "creep"])
def test_a_killed_run_resumes_and_ends_the_same(tmp_path, creep):
    use, report_at = hip(creep=creep, **QUICK), [1e5, 3e5]
    uninterrupted = use.after(4e5, report_at)
    with pytest.raises(KilledError):
        use.after(4e5, report_at, progress=killed_after(6), store=tmp_path)
    blocks = []
    resumed = use.after(4e5, report_at, progress=blocks.append, store=tmp_path)
    assert len(blocks) == uninterrupted.steps - 6  # no block is lost
    assert resumed.steps == uninterrupted.steps
    for expected, report in zip(uninterrupted.reports, resumed.reports, strict=True):
        assert report.cycles == expected.cycles
        assert report.volume == pytest.approx(expected.volume, rel=1e-6)
        assert report.wear == pytest.approx(expected.wear, abs=1e-6 * expected.depth)
        assert report.creep_depth == pytest.approx(expected.creep_depth, rel=1e-5)
        assert report.max_pressure == pytest.approx(expected.max_pressure, rel=1e-6)


def test_a_finished_run_is_not_repeated_and_can_be_continued(tmp_path):
    use = hip()
    first = use.after(2e5, store=tmp_path)
    blocks = []
    assert use.after(2e5, progress=blocks.append, store=tmp_path).last.volume == first.last.volume
    assert not blocks
    longer = use.after(4e5, [2e5], store=tmp_path)
    assert longer.reports[0].volume == first.last.volume
    assert longer.last.volume == pytest.approx(report_after(use, 4e5).volume, rel=1e-3)
    with pytest.raises(ValueError, match="400000 cycles .*100000"):
        use.after(4e5, [1e5], store=tmp_path)


def test_the_checkpoint_of_another_run_is_refused(tmp_path):
    hip().after(1e4, store=tmp_path)
    with pytest.raises(ValueError, match="has the checkpoint of another run: another hip, cycle, law or version"):
        hip(wear=Archard(coefficient=2 * K)).after(1e4, store=tmp_path)


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK"], ids=range(3))
def test_a_damaged_checkpoint_is_refused(tmp_path, content):
    (tmp_path / "hip_in_use.npz").write_bytes(content)
    with pytest.raises(ValueError, match="hip_in_use.npz is not a checkpoint of a run; delete it to start again"):
        hip().after(1e4, store=tmp_path)


def test_a_checkpoint_without_a_report_field_is_refused(tmp_path):
    hip().after(1e4, store=tmp_path)
    path = tmp_path / "hip_in_use.npz"
    arrays = read_arrays(path)
    del arrays["report_0_volume"]
    write_arrays(path, **arrays)
    with pytest.raises(ValueError, match="is not a checkpoint of a run"):
        hip().after(1e4, store=tmp_path)


def test_a_custom_wear_law_cannot_be_stored(tmp_path):
    with pytest.raises(ValueError, match="runs with a CustomWearLaw cannot be stored"):
        hip(wear=CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)).after(1e4, store=tmp_path)


def test_state_and_reports_are_read_as_they_were_written(tmp_path):
    use = hip()
    run = WearIntegrator(setup=use)
    reports = [make_report(run.run_until(cycles, lambda cycles: None)) for cycles in (1e4, 2e4)]
    stored = make_checkpoint(use, tmp_path / "new" / "folder")
    assert stored.read() is None
    stored.write(run.state, tuple(reports))
    state, read_reports = stored.read()
    assert set(state) == set(run.state)
    for name, array in run.state.items():
        np.testing.assert_array_equal(state[name], array)
    for expected, report in zip(reports, read_reports, strict=True):
        for field in fields(report):
            np.testing.assert_array_equal(getattr(report, field.name), getattr(expected, field.name))
            assert (
                isinstance(getattr(report, field.name), type(getattr(expected, field.name)))
                or field.name == "converged"
            )
        assert type(report.converged) is bool
        assert type(report.volume) is float


def test_the_identity_depends_on_every_input_of_the_run(tmp_path):
    use = hip()
    others = [
        use,
        hip(diameter=32.0),
        hip(clearance=0.2),
        hip(creep=logarithmic()),
        hip(ball_wear=Archard(coefficient=K)),
        hip(cycle=use.cycle.scaled(1.1)),
        replace(use, ring_width=0.06),
        replace(use, tolerance=1e-3),
        replace(use, seconds_per_cycle=2.0),
        replace(use, cup=use.cup.tilted(0.1)),
    ]
    identities = {make_checkpoint(other, tmp_path).identity for other in others}
    assert len(identities) == len(others)
    assert {len(identity) for identity in identities} == {64}
    assert make_checkpoint(hip(), tmp_path).identity in identities
