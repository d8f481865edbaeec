#!/usr/bin/env python3
"""Wheel and sdist as users have them (`.ci/installed.py dist`): tried away from the sources.

The sdist on this Python, the wheel on the newest there is.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MOST = 99  # minor versions of Python 3
PIP = ("-m", "pip", "install", "--quiet", "--no-compile", "--disable-pip-version-check")
LINES = """
import sys, ballsocket as bs
hip = bs.Joint(head_diameter=35.8, diametral_clearance=0.2, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
answers = bs.compare(hip, force=3000.0)
assert abs(answers["exact"].max_pressure - 11.1703) < 1e-4, answers
assert bs.__file__.startswith(sys.argv[1]), bs.__file__
"""


def main() -> None:
    dist = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(folder, sys.executable, *PIP, "--no-deps", "--target", folder / "sdist", next(dist.glob("*.tar.gz")))
        try_out("sdist", sys.executable, folder, folder / "sdist")
        run(folder, "uv", "venv", "--quiet", "--python", newest(), folder / "newest")
        python = folder / "newest" / "bin" / "python"
        run(folder, "uv", "pip", "install", "--quiet", "--python", python, next(dist.glob("*.whl")))
        try_out("wheel", python, folder, folder / "newest")


def newest() -> str:
    """The newest Python 3 that runs here."""
    for minor in range(MOST, 10, -1):
        for path in named(f"python3.{minor}"):
            if subprocess.run([path, "-c", ""], capture_output=True, check=False).returncode == 0:
                return str(path)
    return sys.executable


def named(name: str) -> list[Path]:
    """Where a Python of that name is, also one that pyenv keeps and does not show."""
    found = shutil.which(name)
    if found is None:
        return []
    return [Path(found), *sorted(Path(found).parents[1].glob(f"versions/*/bin/{name}"))]


def try_out(kind: str, python: object, folder: Path, place: Path) -> None:
    """Lines that anyone would type first, with the package that lies in a place."""
    run(folder, python, "-c", LINES, place, path=place)
    press = ("-m", "ballsocket", "press", "hip-36", "--force", "3 kN")
    told = json.loads(run(folder, python, *press, "--json", path=place))
    run(folder, python, *press, "--figure", folder / f"{kind}.png", path=place)
    version = run(folder, python, "--version").strip()
    print(f"the {kind} on {version}: {told['results'][0]['max_pressure']:.4f} MPa")


def run(folder: Path, *words: object, path: Path | None = None) -> str:
    """What a command prints, away from the sources."""
    environment = {**os.environ, **({"PYTHONPATH": str(path)} if path else {})}
    command = [str(word) for word in words]
    done = subprocess.run(command, check=True, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True)
    return done.stdout


if __name__ == "__main__":
    main()
