"""Cost of a new model: one file and one line of the catalogue, in a copy of the package."""

import re
import shutil

import pytest

from ..extended_package import extend_package, page_code, run_python
from ..places import ROOT

CONTRACT = ("catalogue", "evidence", "models/test_limits.py", "contact/test_models.py")


@pytest.mark.long
def test_a_new_file_and_a_line_of_the_catalogue_pass_the_contract(tmp_path):
    """The model of the page is added to a copy of the package."""
    code = page_code("model")[0]
    assert code.count("\n") <= 48
    lines = {"from .models.pin": "from .models.mattress import Mattress\n", "    Hertz(),": "    Mattress(),\n"}
    changes = {"catalogue.py": {before: line + before for before, line in lines.items()}}
    extend_package(tmp_path, {"models/mattress.py": code}, changes)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    places = [str(ROOT / "tests" / name) for name in CONTRACT]
    options = ("-n", "0", "--long", "-o", "pythonpath=", "-p", "no:cacheprovider", "-k", "mattress")
    done = run_python(tmp_path, "-m", "pytest", "-v", *options, *places, folder=ROOT)
    assert done.returncode == 0, done.stdout
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) >= 30
