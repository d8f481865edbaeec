#!/usr/bin/env python3
"""The lowest versions that pyproject.toml allows: the core alone with them, its command, and some of its tests."""

import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TOOLS = ("array-api-strict", "hypothesis", "mpmath", "pytest", "pytest-xdist")
TESTS = (
    "catalogue",
    "contact/test_contact.py",
    "contact/test_model_laws.py",
    "contact/test_models.py",
    "contact/test_peak_pressure.py",
    "problem",
    "models/test_limits.py",
    "models/test_published.py",
    "files",
)
ASIDE = ("-k", "not array_libraries", "-W", "ignore::DeprecationWarning")  # what newer tools say of older ones


def main() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lowest = [requirement.replace(">=", "==") for requirement in project["dependencies"]]
    print("lowest:", *lowest)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        python = Path(folder) / "bin" / "python"
        run(python, "-m", "pip", "install", "--quiet", ROOT, *lowest, *TOOLS)
        run(python, "-m", "ballsocket", "press", "--help")
        run(python, "-m", "ballsocket", "press", "examples/hip.toml", "--all", "--figure", f"{folder}/press.png")
        run(python, "-m", "pytest", *ASIDE, *(f"tests/{name}" for name in TESTS))


def run(*words: object) -> None:
    subprocess.run(words, check=True, cwd=ROOT)


if __name__ == "__main__":
    main()
