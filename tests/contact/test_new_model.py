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
PATHS = re.search(r"^pytest --long -k mattress (.*) && lint-imports$", PAGE, re.MULTILINE)[1].split()


@pytest.mark.long
@pytest.mark.parametrize(("promise", "failed"), [("0.15", 0), ("0.02", 1)])
def test_the_check_of_the_page_fails_for_a_model_that_breaks_its_promise(promise, failed, tmp_path):
    """The model of the page is added to a copy of the package; springs on a plane are not within 2 %."""
    assert FILE.count("\n") <= 48
    added = tmp_path / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, added, ignore=shutil.ignore_patterns("__pycache__"))
    (added / "models" / "mattress.py").write_text(FILE.replace("within=0.15", f"within={promise}"), encoding="utf-8")
    catalogue = (added / "model_catalogue.py").read_text("utf-8")
    lines = {"from .models.pin": "from .models.mattress import Mattress\n", "    Hertz(),": "    Mattress(),\n"}
    for before, line in lines.items():
        assert before in catalogue
        catalogue = catalogue.replace(before, line + before, 1)
    (added / "model_catalogue.py").write_text(catalogue, encoding="utf-8")
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    options = ("-n", "0", "--long", "-o", "pythonpath=", "-p", "no:cacheprovider", "-k", "mattress")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(tmp_path), "PYTHONIOENCODING": "utf-8"}
    command = [sys.executable, "-m", "pytest", "-v", *options, *PATHS]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False, env=environment)
    assert done.returncode == failed, done.stdout
    failures = re.findall("^FAILED (.*?)(?: - |$)", done.stdout, re.MULTILINE)
    assert failures == ["tests/evidence/test_validity.py::test_valid_results_are_within_the_promise[mattress]"][:failed]
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) >= 30
