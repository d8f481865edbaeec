"""Names of version 1.0: each one still works; names inside modules warn."""

import pydoc
import subprocess
import sys
from dataclasses import dataclass, replace
from importlib import import_module
from types import SimpleNamespace

import pytest

from ballsocket.core.deprecation import (
    MOVED,
    RenamedAttribute,
    present_module_path,
    renamed_arguments,
    renamed_fields,
    renamed_names,
)
from ballsocket.core.validity import Range
from ballsocket.identify import Machine, synthetic

SUBMODULES = {
    "ballsocket.elastic.exact_curve": "ballsocket.elasticity.exact.exact_curve",
    "ballsocket.elastic.tabulated.model": "ballsocket.elasticity.exact.tabulated.model",
    "ballsocket.fem.export.deck": "ballsocket.elasticity.finite_elements.deck",
    "ballsocket.joint.material": "ballsocket.problem.material",
    "ballsocket.model.law": "ballsocket.contact.law",
    "ballsocket.sphere.model": "ballsocket.elasticity.off_axis.model",
}


@pytest.mark.parametrize(("old", "new"), [*MOVED.items(), *SUBMODULES.items()])
def test_an_old_path_imports_the_module(old, new, monkeypatch):
    for name in [name for name in sys.modules if name == old or name.startswith(old + ".")]:
        monkeypatch.delitem(sys.modules, name)
    parent, _, attribute = old.rpartition(".")
    before = getattr(import_module(parent), attribute, None)
    monkeypatch.setattr(import_module(parent), attribute, before, raising=False)  # undoes what the import sets
    module = import_module(new)
    spec = module.__spec__
    assert import_module(old) is module
    assert module.__spec__ is spec
    assert module.__name__ == new


def test_imports_of_version_1_still_run():
    lines = (
        "import ballsocket as bs",
        "from ballsocket.elastic.exact import Exact",
        "from ballsocket.sphere import Sphere",
        "from ballsocket.model import Model",
        "import ballsocket.quantities, ballsocket.joint.joint",
        "assert Exact is bs.Exact and Sphere is bs.Sphere and Model is bs.Model",
        "assert bs.quantities.QUANTITIES and bs.fem.model.FiniteElement is bs.FiniteElement",
        "assert bs.joint.joint.Joint is bs.Joint",
    )
    subprocess.run([sys.executable, "-W", "error", "-c", "\n".join(lines)], check=True)


def test_unknown_names_are_not_found():
    assert present_module_path("ballsocket") is None
    assert present_module_path("ballsocket.models.half_space") is None
    with pytest.raises(ModuleNotFoundError):
        import_module("ballsocket.elastics")
    with pytest.raises(AttributeError, match="no attribute 'elastics'"):
        import_module("ballsocket").elastics  # noqa: B018


class Cup:
    new = 3.0
    old = RenamedAttribute("new")


@renamed_fields(told="text")
@dataclass(frozen=True, kw_only=True)
class Note:
    text: str


@renamed_arguments(listen="progress")
def work(*, progress):
    """Return the argument."""
    return progress


def test_renamed_names_attributes_and_arguments_warn():
    find = renamed_names(__name__, {"Socket": "Cup", "Old": "ballsocket.problem.cup.Cup"})
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


class Fit:
    def solve(self):
        """Solve the fit."""
        return 3.0

    @property
    def total(self):
        """Total."""
        return 4.0

    run, whole = RenamedAttribute("solve"), RenamedAttribute("total")


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_help_states_that_old_names_are_deprecated():
    text = pydoc.plain(pydoc.render_doc(Fit))
    assert text.count("Deprecated: use `solve`; removed in 2.0.") == 1
    assert text.count("Deprecated: use `total`; removed in 2.0.") == 1
    assert Fit.run(Fit()) == Fit().run() == 3.0
    assert Fit.whole.fget(Fit()) == Fit().whole == 4.0


def test_functions_of_version_1_that_became_properties_still_work():
    old = import_module("ballsocket.export.trusted")
    for name in ("trusted_depth", "valid_depth"):
        with pytest.warns(DeprecationWarning, match="use the property ForceElement.valid_depth"):
            assert getattr(old, name)(SimpleNamespace(valid_depth=0.5)) == 0.5
    with pytest.raises(AttributeError, match="no attribute 'trust'"):
        old.trust  # noqa: B018


def test_a_renamed_field_is_accepted_and_read_with_a_warning():
    with pytest.warns(DeprecationWarning, match=r"^argument 'told' of Note\(\) is deprecated: use 'text'"):
        note = Note(told="loose")
    with pytest.warns(DeprecationWarning, match=r"^Note.told is deprecated: use text"):
        assert note.told == note.text == "loose"
    assert Note(text="loose") == note
    with pytest.warns(DeprecationWarning, match=r"^argument 'told' of Note\(\) is deprecated: use 'text'"):
        assert replace(note, told="tight").text == "tight"


@pytest.mark.parametrize(
    "use",
    [
        lambda: renamed_names(__name__, {"Socket": "Cup"})("Socket"),
        lambda: Cup().old,
        lambda: work(listen=1),
        lambda: Note(told="loose"),
    ],
    ids=["name", "attribute", "argument", "field"],
)
def test_a_warning_points_to_the_line_that_uses_the_old_name(use):
    with pytest.warns(DeprecationWarning, match="is deprecated: use") as caught:
        use()
    assert [(warning.filename, warning.lineno) for warning in caught] == [(__file__, use.__code__.co_firstlineno)]


def test_old_names_of_a_range_and_a_machine_warn():
    limit, machine = Range(quantity="half_angle", high=1.0), Machine(offset=(0.0, 0.1))
    with pytest.warns(DeprecationWarning, match=r"Range.of is deprecated: use quantity_of"):
        assert limit.of is limit.quantity_of
    with pytest.warns(DeprecationWarning, match=r"Machine.known is deprecated: use known_errors"):
        assert machine.known() == machine.known_errors()
    with pytest.warns(DeprecationWarning, match=r"Machine.unknowns is deprecated: use unknown_errors"):
        assert machine.unknowns == machine.unknown_errors
    with pytest.warns(DeprecationWarning, match=r"synthetic.drawn is deprecated: use draw_data_sets"):
        assert synthetic.drawn is synthetic.draw_data_sets
