"""Every input gives a result or a refusal in one sentence, within 5 s and 1 GB."""

from hypothesis import given
from hypothesis import strategies as st

from ballsocket.files.joint_file import joint_of, parse_joint
from ballsocket.files.joint_toml import tables_of

from . import flags, toml_files
from .limits import check_command, check_sentence, inputs, within_limits

CLOSED = (["--model", "hess-forsbach"], ["--model", "hertz", "--json"], ["--model", "tabulated", "--json"])
STORED = ([], [], [], [], ["--store", "store"])
MODELS = (*CLOSED * 6, [], ["--all"])
TABULAR = st.just(b'joint = "hip-28"\n[table]\npath = "points.csv"\n[axes]\nforce = 1000\n')


@inputs(7)
@given(raw=toml_files.joints, model=st.sampled_from(MODELS))
def test_joint_files(raw, model):
    check_command({"joint.toml": raw}, "press", "joint.toml", *model)


@inputs(10)
@given(line=flags.line)
def test_command_lines(line):
    check_command({}, *line)


@inputs(8)
@given(raw=toml_files.studies | TABULAR, csv=toml_files.csv, store=st.sampled_from(STORED))
def test_study_files(raw, csv, store):
    check_command({"study.toml": raw, toml_files.TABLE: csv}, "study", "study.toml", *store)


@inputs(12)
@given(raw=toml_files.joints)
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
