"""Every input gives a result or a refusal in one sentence, within 5 s and 1 GB."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ballsocket.files.joint_file import joint_of, parse_joint
from ballsocket.files.joint_toml import tables_of

from ..cli.command import run
from . import flags, joint_files, study_files
from .limits import check_run, check_sentence, inputs, within_limits

CLOSED = (["--model", "hess-forsbach"], ["--model", "hertz", "--json"], ["--model", "tabulated", "--json"])
STORED = ([], [], [], [], ["--store", "store"])
MODELS = (*CLOSED * 6, [], ["--all"])


@inputs(7)
@given(raw=joint_files.raw, model=st.sampled_from(MODELS))
def test_joint_files(fresh, raw, model):
    with fresh() as folder:
        (folder / "joint.toml").write_bytes(raw)
        with within_limits():
            check_run(run("press", "joint.toml", *model, folder=folder))


@inputs(10)
@given(line=flags.line)
def test_command_lines(fresh, line):
    with fresh() as folder, within_limits():
        check_run(run(*line, folder=folder))


@inputs(5)
@given(raw=study_files.raw, csv=study_files.csv, store=st.sampled_from(STORED))
def test_study_files(fresh, raw, csv, store):
    with fresh() as folder:
        (folder / "study.toml").write_bytes(raw)
        (folder / study_files.TABLE).write_bytes(csv)
        with within_limits():
            check_run(run("study", "study.toml", *store, folder=folder))


@inputs(3)
@given(csv=study_files.csv, store=st.sampled_from(STORED))
def test_tables_of_numbers(fresh, csv, store):
    pytest.importorskip("pandas")
    with fresh() as folder:
        (folder / "study.toml").write_text('joint = "hip-28"\n[table]\npath = "points.csv"\n[axes]\nforce = 1000\n')
        (folder / study_files.TABLE).write_bytes(csv)
        with within_limits():
            check_run(run("study", "study.toml", *store, folder=folder))


@inputs(12)
@given(raw=joint_files.raw)
def test_uploads(raw):
    """An uploaded file is refused, or a joint that is read from its own text as the same."""
    with within_limits():
        try:
            file = parse_joint(raw, "the file")
        except ValueError as error:
            check_sentence(" ".join(str(error).split()))
            return
        again = joint_of(tables_of(file))
        assert again.joint == file.joint
        assert joint_of(tables_of(again)) == again
