"""A copy of the package with the code of a page of docs/contributing, and Python that imports it."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import ballsocket as bs

from .places import CONTRIBUTING


def page_code(page):
    """List the blocks of Python of a page of docs/contributing."""
    text = (CONTRIBUTING / f"{page}.md").read_text("utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def extend_package(folder, files, changes):
    """Copy the package into a folder with new files, and replace texts of others, all by their path in the package."""
    package = folder / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    for name, text in files.items():
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text(text, "utf-8")
    for name, replacements in changes.items():
        text = (package / name).read_text("utf-8")
        for old, new in replacements.items():
            assert old in text, (name, old)
            text = text.replace(old, new, 1)
        (package / name).write_text(text, "utf-8")


def run_python(package_folder, *words, folder=None):
    """Run Python, which imports the copy in a folder, and return the finished process."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(package_folder), "PYTHONIOENCODING": "utf-8", "COLUMNS": "120"}
    options = {"capture_output": True, "encoding": "utf-8", "check": False}
    return subprocess.run([sys.executable, *words], cwd=folder or package_folder, env=environment, **options)
