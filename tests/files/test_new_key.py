"""A new key of hip files, with its unit, costs one line of the schema."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ballsocket as bs

from ..places import ROOT

LINE = '    groove_depth: Annotated[Length | None, meaning("depth of a groove in the cup")] = None\n'
CHECK = f"""
import sys
from ballsocket.files.tables import read_table
from ballsocket.hip.schema import HipTable

print(read_table({{"film": {{"groove_depth": "0.02 cm"}}}}, HipTable).film.groove_depth)
for film in ({{"groove_depth": "3 N"}}, {{"groove_depth": [1]}}, {{"grove_depth": 1}}):
    try:
        read_table({{"film": film}}, HipTable)
    except ValueError as error:
        print(error)
sys.path.insert(0, {str(ROOT / "docs" / "_ext")!r})
from generated import _file_keys
print(next(line for line in _file_keys("hip").splitlines() if "groove_depth" in line))
"""


@pytest.fixture
def package(tmp_path):
    """Return a folder with a copy of the package that has one more key in [film]."""
    copy = tmp_path / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    module = copy / "hip" / "schema.py"
    text = module.read_text("utf-8")
    end = text.index("\n\n\n", text.index("class FilmTable(")) + 1
    module.write_text(text[:end] + LINE + text[end:], "utf-8")
    return tmp_path


def python(package, *words):
    """Run Python with the copy of the package."""
    run = subprocess.run(
        [sys.executable, *words],
        cwd=package,
        capture_output=True,
        encoding="utf-8",
        check=False,
        env={**os.environ, "PYTHONPATH": str(package), "PYTHONIOENCODING": "utf-8"},
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.mark.long
def test_reading_refusals_schema_and_documentation_follow_a_new_key(package):
    number, *refusals, row = python(package, "-c", CHECK).splitlines()
    assert float(number) == pytest.approx(0.2)
    assert refusals == [
        "groove_depth = '3 N' is not a length, such as '16 mm'",
        "groove_depth = [1] is not a length, such as '16 mm'",
        "'grove_depth' in [film] is not known; did you mean 'groove_depth'?",
    ]
    assert row == "| `groove_depth` | a length, such as '16 mm' |  | depth of a groove in the cup |"
    film = json.loads(python(package, "-m", "ballsocket", "schema", "hip"))["$defs"]["FilmTable"]
    described = {"$ref": "#/$defs/Length", "description": "depth of a groove in the cup"}
    assert film["properties"]["groove_depth"] == described
