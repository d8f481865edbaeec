"""Names of version 1.0: each one still works; names inside modules warn."""

import subprocess
import sys
from dataclasses import dataclass
from importlib import import_module

import pytest

from ballsocket.core import deprecation
from ballsocket.core.deprecation import RenamedAttribute, renamed_arguments, renamed_fields, renamed_names


@pytest.mark.parametrize(("old", "new"), [*deprecation.MOVED.items()][::60])
def test_an_old_path_imports_the_module(old, new):
    assert import_module(old) is import_module(new)
    assert deprecation.present_module_path("ballsocket.models.half_space") is None


def test_imports_of_version_1_still_run():
    code = """
import ballsocket as bs
from ballsocket.elastic.exact import Exact
from ballsocket.sphere import Sphere
from ballsocket.model import Model
import ballsocket.quantities, ballsocket.joint.joint
assert Exact is bs.Exact and Sphere is bs.Sphere and Model is bs.Model
assert bs.quantities.QUANTITIES and bs.fem.model.FiniteElement is bs.FiniteElement
assert bs.joint.joint.Joint is bs.Joint
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


class Cup:
    new = 3.0
    old = RenamedAttribute("new")


@renamed_fields(told="text")
@dataclass(frozen=True, kw_only=True)
class Note:
    text: str


@renamed_arguments(listen="progress")
def work(*, progress):
    return progress


find = renamed_names(__name__, {"Socket": "Cup", "Old": "ballsocket.problem.cup.Cup"})


def test_renamed_names_attributes_and_arguments_warn():
    with pytest.warns(DeprecationWarning, match=r"test_deprecation.Socket is deprecated: use Cup; removed in 2.0"):
        assert find("Socket") is Cup
    with pytest.warns(DeprecationWarning, match="use ballsocket.problem.cup.Cup"):
        assert find("Old") is import_module("ballsocket").Cup
    with pytest.raises(AttributeError, match="has no attribute 'Shell'"):
        find("Shell")
    with pytest.warns(DeprecationWarning, match=r"^Cup.old is deprecated: use new; removed in 2.0$"):
        assert Cup().old == 3.0
    with pytest.warns(DeprecationWarning, match=r"^argument 'listen' of work\(\) is deprecated: use 'progress'"):
        assert work(listen=1) == 1
    assert work(progress=2) == 2
    with pytest.raises(TypeError, match="got both 'progress' and its old name 'listen'"):
        work(progress=2, listen=1)
    with pytest.warns(DeprecationWarning, match=r"^argument 'told' of Note\(\) is deprecated: use 'text'"):
        note = Note(told="loose")
    with pytest.warns(DeprecationWarning, match=r"^Note.told is deprecated: use text"):
        assert note.told == note.text == "loose"


@pytest.mark.parametrize(
    "use", [lambda: find("Socket"), lambda: Cup().old, lambda: work(listen=1), lambda: Note(told="loose")]
)
def test_a_warning_points_to_the_line_that_uses_the_old_name(use):
    with pytest.warns(DeprecationWarning, match="is deprecated: use") as caught:
        use()
    assert [(warning.filename, warning.lineno) for warning in caught] == [(__file__, use.__code__.co_firstlineno)]
