"""Structure of the package: no circle of imports, few modules with a single user, few floors.

`import_graph` says what counts as an import; `python -m tests.import_graph ROOM` prints the figures of a room.
"""

import tomllib
from functools import cache
from textwrap import dedent

import pytest

from .import_graph import graph_of
from .places import ROOT
from .rooms import room_of, rooms

MAX_SINGLE_IMPORTERS, MAX_FLOORS = 0.12, 12
"""Goals: share of a room's modules that only one module imports; floors of a room, and of the package."""

NOT_YET = {
    "circles": (),
    "single importers": ("app",),  # a view is a package of its own: its work and its charts serve it alone
    "floors": (),
}
"""Rooms that are exempt from a goal; every other room of the package must meet it."""


ABOVE_MECHANICS = ("app", "cli", "evidence", "files", "mcp", "paper", "reports", "studies")
"""Rooms of files, studies, pages and commands."""

LOADED_BY_NAME = ("", "__init__", "app.views.registry", "core.deprecation", "cli.root")
"""Modules that load what a folder or a table holds: `import_module` takes a name that they do not state themselves."""


OLD_PATHS = "core.deprecation"
"""Module with the new paths of moved modules as text; it imports one only where a user gives its old path."""


@cache
def whole_graph():
    """Read the graph once for all tests of a process."""
    graph = graph_of()
    return graph.without({(OLD_PATHS, target) for target in graph.edges[OLD_PATHS]})


def held_to(goal, names=None):
    """Return the rooms that must meet a goal."""
    return [room for room in names or rooms() if room not in NOT_YET[goal]]


def lines(title, rows):
    """Return a title and rows of text below it."""
    return "\n  ".join([title, *rows])


@pytest.mark.parametrize("room", held_to("circles"))
def test_no_module_of_a_room_is_in_a_circle_of_imports(room):
    """Also within `if TYPE_CHECKING`, in functions and by strings: move what both need below both, or merge the two."""
    graph = whole_graph()
    circles = [group for group in graph.circles() if room in {graph.room(name) for name in group}]
    assert not circles, "\n".join(lines(f"circle in {group}:", graph.shortest_circle(group)) for group in circles)


def test_no_room_imports_one_that_imports_it():
    graph = whole_graph()
    assert graph.circles_of_rooms() == [], "python -m tests.import_graph prints the imports"


def test_modules_are_imported_by_names_that_the_source_states():
    """A name that is only known at run time hides an import from all tests here."""
    graph = whole_graph()
    hidden = [text for name, texts in graph.unknown.items() if name not in LOADED_BY_NAME for text in texts]
    assert not hidden, lines("imported by a name that the source does not state:", hidden)


@pytest.mark.parametrize("room", held_to("single importers", [room for room in rooms() if not room.endswith(".py")]))
def test_few_modules_of_a_room_have_a_single_importer(room):
    """Move such a module into its importer, unless it is a subject of its own."""
    graph = whole_graph()
    single, total = graph.single_importers(room), len(graph.modules(room))
    title = f"{room}: {len(single)} of {total} modules have one importer; move into it what is no subject of its own"
    assert len(single) <= MAX_SINGLE_IMPORTERS * total, lines(title, (f"{a} <- {b}" for a, b in single.items()))


def test_few_modules_of_mechanics_have_a_single_importer():
    """Rooms below the pages and commands together, those included that do not meet the goal alone."""
    graph = whole_graph()
    mechanics = [name for name in rooms() if not name.endswith(".py") and name not in ABOVE_MECHANICS]
    single = {name: user for room in mechanics for name, user in graph.single_importers(room).items()}
    total = sum(len(graph.modules(room)) for room in mechanics)
    assert len(single) <= MAX_SINGLE_IMPORTERS * total, lines(
        "one importer:", (f"{a} <- {b}" for a, b in single.items())
    )


@pytest.mark.parametrize("room", held_to("floors"))
def test_a_room_has_few_floors(room):
    chain = whole_graph().longest_chain(room)
    assert len(chain) <= MAX_FLOORS, lines(f"{room}: {len(chain)} modules in one chain of imports:", chain)


def test_the_package_has_few_floors():
    """Rooms on one floor do not import each other; put a room on the lowest floor that its imports allow."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    (floors,) = (one["layers"] for one in contracts if one.get("containers") == ["ballsocket"])
    assert len(floors) <= MAX_FLOORS


PACKAGE = {
    "__init__.py": "from .wear import Law\nfrom . import joint",
    "joint.py": "",
    "arrays.py": "",
    "wear/__init__.py": "from .laws import Law\nfrom .basis import *",
    "wear/basis.py": "from ..joint import Joint",
    "wear/laws.py": "from . import basis\nfrom .. import arrays",
    "plots/__init__.py": "",
    "plots/draw.py": "from ..wear import Law\nimport package.joint\nimport numpy.linalg",
    "plots/lazy.py": """
        from typing import TYPE_CHECKING
        from importlib import import_module
        from logging import getLogger

        if TYPE_CHECKING:
            from .draw import Picture

        LATER = "package.wear"
        log = getLogger("package.joint")

        def plot():
            from package.arrays import array
            import_module(LATER).plot()
            import_module(".basis", "package.wear")
    """,
    "plots/hidden.py": "from importlib import import_module\nimport_module(f'package.{__name__}')",
}


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Graph of a small package."""
    root = tmp_path_factory.mktemp("small") / "package"
    for name, text in PACKAGE.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(dedent(text), encoding="utf-8")
    return graph_of(root)


@pytest.mark.parametrize(
    ("source", "targets"),
    [
        ("", {"wear", "wear.laws", "joint"}),
        ("wear", {"wear.laws", "wear.basis"}),
        ("wear.basis", {"joint"}),
        ("wear.laws", {"wear.basis", "arrays"}),  # modules through their package: the door does not count
        ("plots.draw", {"wear", "wear.laws", "joint"}),  # a name through a door: the door and its origin
        ("plots.lazy", {"plots.draw", "arrays", "wear", "wear.basis"}),  # types, in a function, by strings; no logger
        ("plots.hidden", set()),
    ],
)
def test_every_form_of_import_is_read(small, source, targets):
    assert set(small.edges[source]) == targets


def test_kind_and_place_of_an_import_are_known(small):
    kinds = {target: (edge.kind, edge.line) for target, edge in small.edges["plots.lazy"].items()}
    assert kinds == {
        "plots.draw": ("for types", 7),
        "arrays": ("in a function", 13),
        "wear": ("by a string", 9),
        "wear.basis": ("by a string", 15),
    }


def test_a_name_known_only_at_run_time_is_reported(small):
    assert list(small.unknown) == ["plots.hidden"]


def test_importers_are_counted_without_doors(small):
    assert small.importers("wear.basis") == ["plots.lazy", "wear.laws"]
    assert small.importers("wear.laws") == ["plots.draw"]
    assert small.single_importers("plots") == {"plots.draw": "plots.lazy"}
    assert small.single_importers("wear") == {"wear.laws": "plots.draw"}


def test_floors_are_the_longest_chain(small):
    assert small.longest_chain("wear") == ["wear.laws", "wear.basis"]
    assert small.longest_chain("plots") == ["plots.lazy", "plots.draw"]
    assert small.circles() == []


def test_circles_are_found(tmp_path):
    root = tmp_path / "package"
    files = {"a/one.py": "from ..b import two", "b/two.py": "import package.c", "c.py": "def f(): from .a.one import x"}
    for name, text in {"a/__init__.py": "", "b/__init__.py": "", "__init__.py": "", **files}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    graph = graph_of(root)
    assert graph.circles() == [["a.one", "b.two", "c"]]
    assert graph.circles_of_rooms() == [["a", "b", "c.py"]]
    assert [line.split(": ", 1)[1] for line in graph.shortest_circle(["a.one", "b.two", "c"])] == [
        "a.one -> b.two (import)",
        "b.two -> c (import)",
        "c -> a.one (in a function)",
    ]
    assert graph.without({("c", "a.one")}).circles() == []


def test_rooms_of_a_collection_are_its_directories(tmp_path):
    names = ["elasticity/__init__.py", "elasticity/exact/model.py", "hip/laws/archard.py", "cup.py"]
    assert [room_of(tmp_path / name, tmp_path) for name in names] == ["elasticity", "elasticity/exact", "hip", "cup.py"]
