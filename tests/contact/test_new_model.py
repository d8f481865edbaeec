"""Cost of a new model: one file and one line of the catalogue, in a copy of the package."""

import re
import shutil

import pytest

from ..extended_package import extend_package, page_code, run_python
from ..places import CONTRIBUTING, ROOT

PAGE = (CONTRIBUTING / "model.md").read_text("utf-8")
PATHS = re.search(r"^pytest --long -k mattress (.*) && lint-imports$", PAGE, re.MULTILINE)[1].split()


@pytest.mark.long
@pytest.mark.parametrize(("promise", "failed"), [("0.15", 0), ("0.02", 1)])
def test_the_check_of_the_page_fails_for_a_model_that_breaks_its_promise(promise, failed, tmp_path):
    """The model of the page is added to a copy of the package; springs on a plane are not within 2 %."""
    code = page_code("model")[0]
    assert code.count("\n") <= 48
    line = '    "mattress": "models.mattress:Mattress",\n'
    changes = {"model_catalogue.py": {'    "hertz":': line + '    "hertz":'}}
    extend_package(tmp_path, {"models/mattress.py": code.replace("within=0.15", f"within={promise}")}, changes)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    options = ("-n", "0", "--long", "-o", "pythonpath=", "-p", "no:cacheprovider", "-k", "mattress")
    done = run_python(tmp_path, "-m", "pytest", "-v", *options, *PATHS, folder=ROOT)
    assert done.returncode == failed, done.stdout
    failures = re.findall("^FAILED (.*?)(?: - |$)", done.stdout, re.MULTILINE)
    assert failures == ["tests/evidence/test_validity.py::test_valid_results_are_within_the_promise[mattress]"][:failed]
    assert int(re.search(r"(\d+) passed", done.stdout)[1]) >= 30
