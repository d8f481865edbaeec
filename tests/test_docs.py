"""Pages of the docs: their Python examples and commands run with the output shown."""

import doctest
import re
import shlex
import shutil
from importlib import import_module
from importlib.util import find_spec

import numpy as np
import pytest
from matplotlib.image import imread

import ballsocket as bs
from ballsocket.core.sources import bibliography
from ballsocket.reports.press_plots import MAX_CURVES

from . import extent
from .cli.command import run
from .places import ROOT, fenced
from .printed import Checker, with_numbers_of

DOCS = ROOT / "docs"
RESULTS = ROOT / "benchmarks" / "RESULTS.md"
FILES = (ROOT / "README.md", DOCS / "index.md", *DOCS.glob("[ehrst]*/*.md"))
PAGES = sorted(path for path in FILES if "```" in path.read_text("utf-8"))
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


SLOW = """
clusters cup deck export film finite_elements gradients hip hip_validation identify law many notebook off_axis
patients plasticity preloaded programs sensitivity study
"""
"""Pages whose examples compute for half a second to four seconds each; they run with `--long`."""


def quick_pages(language, mark):
    """List the pages with examples; slow ones only for `--long`."""
    paths = [path for path in PAGES if any(mark in block for block in fenced(path, language))]
    return [path for path in paths if extent.whole or path.stem not in SLOW.split()]


def check_examples(test):
    """Run examples and count them; some are skipped."""
    said = []
    failed, tried = doctest.DocTestRunner(Checker(), optionflags=FLAGS).run(test, out=said.append)
    assert failed == 0, "".join(said)
    return tried


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Beside the examples, as the pages take it."""
    no_bytecode = shutil.ignore_patterns("__pycache__")  # which another process may be writing
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=no_bytecode)
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("path", quick_pages("python", ">>>"), ids=lambda path: path.stem)
def test_python_examples_of_a_page_have_the_output_shown(path, folder):
    text = path.read_text("utf-8")
    for library in ("jax", "torch"):
        if f"import {library}" in text and find_spec(library) is None:
            pytest.skip(f"{library} is not installed")
    code = "\n".join(fenced(path, "python"))
    assert check_examples(doctest.DocTestParser().get_doctest(code, {}, path.name, str(path), 0)) > 0


SLOW_MODULES = {"preload", "preloaded", "transient"}
MODULES = sorted(
    path
    for path in (ROOT / "src").rglob("*.py")
    if ">>> " in path.read_text("utf-8") and (extent.whole or path.stem not in SLOW_MODULES)
)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_examples_of_docstrings_have_the_output_shown(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = ".".join(path.relative_to(ROOT / "src").with_suffix("").parts).removesuffix(".__init__")
    try:
        module = import_module(name)
    except ModuleNotFoundError as missing:
        pytest.skip(f"{missing.name} is not installed")
    for example in doctest.DocTestFinder(exclude_empty=True).find(module):
        check_examples(example)


@pytest.mark.parametrize("path", quick_pages("console", "$ "), ids=lambda path: path.stem)
def test_commands_of_a_page_print_the_output_shown(path, folder):
    for block in fenced(path, "console"):
        command, _, shown = block.partition("\n")
        program, *words = shlex.split(command.removeprefix("$ "))
        assert program == "ballsocket"
        done = run(*words)
        if "no C compiler" in done.stderr:
            pytest.skip("no C compiler")
        assert (done.returncode, done.stderr) == (0, "")
        printed = "\n".join(line.rstrip() for line in done.stdout.splitlines())
        texts = shown, with_numbers_of(shown, printed)
        expected, got = (re.sub(r"\b\d+\.\d\d s\b", "0.00 s", text).splitlines() for text in texts)
        assert got == expected


def test_python_blocks_of_a_page_are_examples_with_output():
    for path in PAGES:
        for block in fenced(path, "python"):
            assert block.startswith(">>> "), f"{path.name}: {block[:60]!r} is not an example with its output"


def test_valid_models_are_within_ten_percent_on_the_presets_and_promises_are_those_of_the_page():
    """The page on choosing a model states this limit."""
    for joint in bs.joints.values():
        answers = bs.compare(joint, force=3000.0)
        exact = answers["exact"].max_pressure
        for name, contact in answers.items():
            assert not contact.valid or contact.max_pressure == pytest.approx(exact, rel=0.1), (joint.name, name)
    text = re.sub(r"\s+", " ", (DOCS / "explanation" / "choosing.md").read_text("utf-8"))
    stated = re.search(r"promise (\S+) % for .*?, `refined` (\S+) %, `tabulated` (\S+) % \(`model.promise`\)", text)
    models = bs.HessForsbach(), bs.Refined(), bs.Tabulated()
    assert [float(number) / 100 for number in stated.groups()] == pytest.approx([one.promise.within for one in models])


TIME = r"([\d.]+) (ns|µs|ms|s)"
LINKED_TIME = rf'\[{TIME}\]\([\w/.]*(?:RESULTS|measured)\.md "(.+?)"\)'
SECONDS = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1.0}
OTHER_TIMES = {"design", "dynamics", "explore", "export", "film", "hip", "programs", "scaling", "theory"}
"""Pages with times of motions, limits and estimates."""


def test_times_of_pages_are_measured():
    """Each is a link to the results, whose title names the row; of several such rows the slowest counts."""
    measured = {}
    for work, number, unit in re.findall(rf"^\| [\w-]+ \| (.+?) \| {TIME} ", RESULTS.read_text("utf-8"), flags=re.M):
        measured[work] = max(float(number) * SECONDS[unit], measured.get(work, 0.0))
    for path in (*FILES, DOCS / "paper" / "paper.md", DOCS / "paper" / "method.md"):
        text = re.sub(r"^```.*?^```", "", path.read_text("utf-8"), flags=re.M | re.DOTALL)
        for number, unit, work in re.findall(LINKED_TIME, text):
            digit = 10.0 ** -len(number.partition(".")[2])
            assert float(number) == pytest.approx(measured[work] / SECONDS[unit], abs=0.51 * digit), (path.name, work)
        loose = re.search(rf"{TIME}\b|(half a |nano|micro|milli)second", re.sub(LINKED_TIME, "", text))
        assert path.stem in OTHER_TIMES or loose is None, f"{path.name}: {loose[0]!r} names no row of the results"


PICTURES = {"press": "--all --figure", "section": "--model fem --section", "tilted_cup": "--figure"}


@pytest.mark.long  # an old matplotlib draws other letters
@pytest.mark.parametrize("name", list(PICTURES))
def test_pictures_are_those_of_the_printed_commands(name, folder):
    """On another system letters differ by some pixels: 0.5 % of the light of the picture."""
    command = f"press examples/{'tilted_hip' if name == 'tilted_cup' else 'hip'}.toml {PICTURES[name]}"
    assert any(f"ballsocket {command} " in path.read_text("utf-8") for path in FILES)
    assert run(*command.split(), "new.png").stderr == ""
    new, shown = (imread(path)[..., :3] for path in ("new.png", DOCS / f"{name}.png"))
    assert np.mean(abs(new - shown)) < 0.005, f"write it again: ballsocket {command} docs/{name}.png"
    assert MAX_CURVES == 7  # "seven models" of the caption of press.png


def test_map_of_hertz_in_a_pivot_has_a_stiffness_that_is_too_low(monkeypatch):
    """Goodman and Keer's socket is stiffer than a half-space; at 1 kN d is 12 % off, pmax 3 % and dF/dd 15 %."""
    monkeypatch.syspath_prepend(DOCS / "_ext")
    from generated import hertz_map

    head, _, preset, *_ = (line.strip("| ").split(" | ") for line in hertz_map().splitlines())
    assert (head[2], preset[0]) == ("1\u202fkN", "0.004")
    errors = [float(text) for text in preset[2].split(" / ")]  # not bold: Hertz is not valid there
    assert errors == pytest.approx([12, -3, -15], abs=1)


def test_references_of_the_short_paper_are_in_the_bibliography():
    """The bibliography of the paper has the entries of the package, and exactly the cited ones."""
    paper, entries = (DOCS / "paper" / "paper.md").read_text("utf-8"), (DOCS / "paper" / "paper.bib").read_text("utf-8")
    cited = set(re.findall(r"@(\w+\d{4})", paper))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", entries, flags=re.MULTILINE))
    for entry in re.split(r"\n(?=@)", entries.strip()):
        assert entry.strip() in bibliography().values()
