"""Cost of a new model: one file and one line of the catalogue, in a copy of the package."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ballsocket as bs

from ..places import CONTRIBUTING, ROOT

PAGE = (CONTRIBUTING / "model.md").read_text("utf-8")
FILE = re.search(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)[1]
CONTRACT = ("catalogue", "evidence", "models/test_limits.py", "contact/test_models.py")


@pytest.mark.long
def test_a_new_file_and_a_line_of_the_catalogue_pass_the_contract(tmp_path):
    """The model of the page is added to a copy of the package."""
    assert FILE.count("\n") <= 48
    added = tmp_path / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, added, ignore=shutil.ignore_patterns("__pycache__"))
    (added / "models" / "mattress.py").write_text(FILE, encoding="utf-8")
    catalogue = (added / "model_catalogue.py").read_text("utf-8")
    lines = {"from .models.pin": "from .models.mattress import Mattress\n", "    Hertz(),": "    Mattress(),\n"}
    for before, line in lines.items():
        assert before in catalogue
        catalogue = catalogue.replace(before, line + before, 1)
    (added / "model_catalogue.py").write_text(catalogue, encoding="utf-8")
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    places = [str(ROOT / "tests" / name) for name in CONTRACT]
    options = ("-n", "0", "--long", "-o", "pythonpath=", "-p", "no:cacheprovider", "-k", "mattress")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(tmp_path), "PYTHONIOENCODING": "utf-8"}
    command = [sys.executable, "-m", "pytest", "-v", *options, *places]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False, env=environment)
    assert done.returncode == 0, done.stdout
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) >= 30
