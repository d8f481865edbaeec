"""Single entry points of the package: one module parses units, one opens input files."""

import ast
from functools import cache

import pytest

from .rooms import PACKAGE, tree_of

OPENING = {"open", "read_text", "read_bytes", "genfromtxt", "loadtxt", "fromfile", "read_csv", "read_parquet"}
OWN_FILES = {
    "app/page.py": "files of the page, in the package",
    "app/server.py": "the default browser",
    "core/storage/atomic_files.py": "locks a folder that is written; writes arrays",
    "cli/root.py": "opens the null device",
    "contact/closed_sphere.py": "a table of the package",
    "contact/strength.py": "a table of the package",
    "elasticity/exact/tabulated/build.py": "writes the tables of the package",
    "elasticity/exact/tabulated/chebyshev.py": "tables of the package",
    "evidence/code_checks.py": "a table of the package",
    "evidence/comparison.py": "the files of a pack, named by its user on the command line",
    "evidence/folder.py": "a pack, and inputs that were opened before",
    "evidence/plan.py": "inputs that were opened before",
    "export/c_element.py": "templates of the package",
    "export/compiler.py": "a library that it has just compiled",
    "export/fmu/fmu.py": "a library that it has just compiled",
    "elasticity/finite_elements/calculix.py": "results in a folder of decks, named by its user in Python",
    "core/storage/folders.py": "a draft that it has just written",
    "core/storage/pieces.py": "the source of the package; pieces of a run",
    "models/refined_state.py": "a table of the package",
    "models/table_3.py": "a table of the package",
    "reports/paper_report.py": "a picture that it has just drawn",
    "paper/cases.py": "a table of the package",
    "core/sources.py": "the bibliography of the package",
    "elasticity/off_axis/deck.py": "results in a folder of decks, named by its user in Python",
    "reports/study_tables.py": "writes the indices of a sensitivity",
    "studies/export.py": "writes the numbers of a study",
    "core/executors/processes.py": "memory of the machine",
    "studies/store.py": "the label of a store",
}
"""Modules that open files without `input_files`, with these files; readers of input files are excluded."""


@cache
def modules():
    """Return the syntax trees of all modules of the package."""
    return {path.relative_to(PACKAGE).as_posix(): tree_of(path) for path in PACKAGE.rglob("*.py")}


def called(tree):
    """Return the names of all functions and methods that a module calls."""
    calls = (node.func for node in ast.walk(tree) if isinstance(node, ast.Call))
    return {call.attr if isinstance(call, ast.Attribute) else getattr(call, "id", "") for call in calls}


def imported(tree):
    """Return the names of all modules that a module imports directly or by name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module.split(".")[0]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def test_only_the_module_of_units_calls_pint():
    assert [name for name, tree in modules().items() if "pint" in imported(tree)] == ["files/units.py"]


def test_pint_evaluates_no_text():
    """No parser of expressions is called; `Unit` and `Quantity` of text would call one."""
    calls = called(modules()["files/units.py"])
    assert not calls & {"parse_expression", "parse_units_as_container"}
    assert {"UnitsContainer", "get_name"} <= calls


def test_files_that_users_name_are_opened_by_one_module():
    opening = {name for name, tree in modules().items() if called(tree) & OPENING}
    assert opening - {"core/input_files.py"} == set(OWN_FILES)


@pytest.mark.parametrize(
    "reader",
    [
        "files/toml.py",
        "files/columns.py",
        "elasticity/off_axis/scans.py",
        "core/storage/atomic_files.py",
        "elasticity/exact/tabulated/chebyshev.py",
        "evidence/signature.py",
    ],
)
def test_every_reader_uses_the_module_of_input_files(reader):
    assert "open_input" in called(modules()[reader])


def test_other_modules_do_not_read_files_by_names_of_users():
    """Readers of other packages that take a path get one that was checked."""
    readers = {name for name, tree in modules().items() if called(tree) & {"ZipFile", "ParquetFile"}}
    assert readers == {
        "app/views/evidence/worker.py",
        "export/fmu/fmu.py",
        "core/storage/atomic_files.py",
        "files/columns.py",
    }  # the first two write
