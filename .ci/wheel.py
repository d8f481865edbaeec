#!/usr/bin/env python3
"""Sdist and wheel built into a folder (`.ci/wheel.py dist`), and checked: all of the package, and nothing else."""

import re
import subprocess
import sys
import tarfile
from pathlib import Path, PurePosixPath
from zipfile import ZipFile

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "src" / "ballsocket"
MUST_BE_THERE = {
    "py.typed",
    "__init__.pyi",  # the package reads its names there
    "hip/__init__.pyi",
    "studies/__init__.pyi",
    "data/references.bib",
    "data/exact_tables.npz",
    "app/assets/page.html",
    "reports/templates/style.css",
}
IN_THE_SDIST = {"README.md", "LICENSE", "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "pyproject.toml"}
ROOMS_OF_THE_SDIST = {"src", "tests", "docs", "examples", "benchmarks"}


def main() -> None:
    folder = Path(sys.argv[1])
    subprocess.run([sys.executable, "-m", "build", "--outdir", folder, ROOT], check=True, stdout=subprocess.DEVNULL)
    version = re.search(r'__version__ = "(.+)"', (PACKAGE / "version.py").read_text(encoding="utf-8"))[1]
    check_wheel(folder / f"ballsocket-{version}-py3-none-any.whl", version)
    check_sdist(folder / f"ballsocket-{version}.tar.gz", version)
    print(f"wheel and sdist of ballsocket {version} hold what they should")


def check_wheel(path: Path, version: str) -> None:
    """Every file of the package as it is here, its metadata, and no test."""
    with ZipFile(path) as wheel:
        names = set(wheel.namelist())
        info = f"ballsocket-{version}.dist-info"
        packed = {name.removeprefix("ballsocket/") for name in names if not name.startswith(info)}
        same("the wheel", packed, package_files())
        require(packed >= MUST_BE_THERE, f"the wheel lacks {sorted(MUST_BE_THERE - packed)}")
        for name in package_files():
            whole = wheel.read(f"ballsocket/{name}") == (PACKAGE / name).read_bytes()
            require(whole, f"{name} differs in the wheel")
        metadata = wheel.read(f"{info}/METADATA").decode()
        commands = wheel.read(f"{info}/entry_points.txt").decode()
    require(f"\nVersion: {version}\n" in metadata, f"the wheel's metadata are not of {version}")
    require("ballsocket = ballsocket.cli:main" in commands, "the wheel has no command")
    require(f"{info}/licenses/LICENSE" in names, "the wheel has no licence")


def check_sdist(path: Path, version: str) -> None:
    """What a packager needs to build, test and document it, and nothing that was made."""
    with tarfile.open(path) as sdist:
        names = {PurePosixPath(name).relative_to(f"ballsocket-{version}") for name in sdist.getnames()}
    tops = {name.parts[0] for name in names if len(name.parts) > 1}
    same("the sdist", tops, ROOMS_OF_THE_SDIST)
    found = {str(name) for name in names}
    require(found >= IN_THE_SDIST, f"the sdist lacks {sorted(IN_THE_SDIST - found)}")
    made = sorted(str(name) for name in names if {"__pycache__", "_build", "_generated", "gallery"} & set(name.parts))
    require(not made, f"the sdist has {made[:5]}")


def package_files() -> set[str]:
    every = (path for path in PACKAGE.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(PACKAGE).as_posix() for path in every}


def same(what: str, found: set[str], expected: set[str]) -> None:
    require(found >= expected, f"{what} lacks {sorted(expected - found)[:10]}")
    require(found <= expected, f"{what} has {sorted(found - expected)[:10]} too")


def require(holds: bool, otherwise: str) -> None:
    if not holds:
        sys.exit(otherwise)


if __name__ == "__main__":
    main()
