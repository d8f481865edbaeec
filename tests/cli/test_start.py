"""Start of the program: imports on demand, the list of commands, and the help of each."""

import os
import re
import subprocess
import sys

import pytest
import typer

from ballsocket.cli.root import app, load_commands
from ballsocket.core.quantities import QUANTITIES
from ballsocket.core.threads import THREAD_VARIABLES
from ballsocket.files.inputs import inputs_of
from ballsocket.files.joint_file import JointFileTable

from .command import run

COMMANDS = load_commands()
HEAVY = {"dask", "jax", "jinja2", "matplotlib", "mcp", "multiprocessing", "numba", "pandas", "pint", "pydantic"}
HEAVY |= {"scipy", "skfem", "torch", "xarray"}


def modules_after(*words):
    code = (
        f"import sys; sys.argv = ['ballsocket', *{words!r}]\n"
        "from ballsocket.cli import main\n"
        "try: main()\n"
        "finally: print(*sys.modules, file=sys.stderr)"
    )
    return set(subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8").stderr.split())


@pytest.mark.parametrize(
    "words",
    [
        ("press", "hip-36", "--force", "3 kN"),
        ("press", "hip-36", "--force", "3 kN", "--clearance", "80 um", "--young", "1 GPa", "--json"),
        ("models",),
        ("--help",),
        ("pres",),
    ],
)
def test_a_command_imports_few_modules_and_no_heavy_package(words):
    loaded = modules_after(*words)
    assert HEAVY & loaded == set()
    assert words == ("models",) or sum(name.startswith("ballsocket") for name in loaded) <= 85
    assert words != ("--help",) or not {"numpy", "ballsocket.model_catalogue"} & loaded


@pytest.mark.parametrize(("stated", "used"), [({}, "1"), ({"OPENBLAS_NUM_THREADS": "3"}, "3")])
def test_linear_algebra_has_one_thread_unless_the_user_states_another_number(stated, used):
    code = (
        "import os; from ballsocket.cli import root\n"
        "root._run = lambda: os.environ['OPENBLAS_NUM_THREADS']\n"
        "root.main()"
    )
    environment = {name: value for name, value in os.environ.items() if name not in THREAD_VARIABLES} | stated
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, encoding="utf-8")
    assert done.stderr.strip() == used  # the text with which Python exits


def test_the_package_is_imported_name_by_name():
    code = (
        "import sys, ballsocket as bs\n"
        "print('numpy' in sys.modules, dir(bs) == sorted({*bs.__all__, *bs._DOORS, '__doc__', '__version__'}))\n"
        "bs.UHMWPE\n"
        "print('ballsocket.model_catalogue' in sys.modules, 'numpy' in sys.modules, *sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True)
    *loaded, modules = done.stdout.split(maxsplit=4)
    assert loaded == ["False", "True", "False", "True"]
    assert {*HEAVY, "rich", "typer"} & set(modules.split()) == set()


def test_help_is_printed_without_a_command_and_lists_press_first_and_all_with_the_first_lines_of_their_docstrings():
    for done in (run(), run("-h")):
        assert (done.returncode, done.stdout) == (0, run("--help").stdout)
    rows = run("--help", columns=80).stdout.partition("Commands:\n")[2]
    listed = dict(re.findall(r"^  ([a-z-]+) +(.*)$", rows, flags=re.MULTILINE))
    first_lines = {name: command.__doc__.partition("\n")[0] for name, command in COMMANDS.items()}
    del first_lines["build-tables"]  # it is hidden
    assert (next(iter(listed)), listed) == ("press", first_lines)
    assert "fem: element size" in run("press", "-h").stdout  # the group names its model


JOINT_OPTIONS = {entry.name for entry in inputs_of(JointFileTable)}
"""Options whose default is the joint file or the preset, as the help of the argument states."""

SIZES = re.compile(r"ring_width|arc_of_cover|chamfer|element_size|tilt|hysteresis|impact_speed|longest|thickness")
UNIT = re.compile(r" in (mm|MPa|N|degrees|s/mm|mm/s|seconds)\b|'\d+ mm'|\d kN|\d deg")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_states_its_unit_and_its_default(name):
    for option in typer.main.get_command(app).commands[name].params:
        text, quantity = option.help, QUANTITIES.get(option.name)
        if SIZES.fullmatch(option.name) or (quantity and quantity.unit not in ("", "1")):
            assert UNIT.search(text), f"--{option.name} has no unit: {text}"
        if option.name == "joint" and name != "calibrate":
            assert "Options replace its values" in text
        elif option.name not in JOINT_OPTIONS and not (option.required or option.default is not None):
            stated = r"Default|^(fem: |sphere: )?[Ww]rite |Not with --|^Show this"
            assert re.search(stated, text), f"--{option.name} has no default: {text}"


@pytest.mark.parametrize(
    "case", ["ori => orient", "press --incl => --inclination", "press --model her => hertz", "press --ball coc => cocr"]
)
def test_a_shell_completes_commands_options_and_names(case, monkeypatch):
    words, _, completed = case.partition(" => ")
    line = f"ballsocket {words}"
    monkeypatch.setenv("_BALLSOCKET_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", str(len(line.split()) - 1))
    assert completed in run().stdout.split()
