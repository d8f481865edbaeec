"""The compiler of C on this machine."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

_NAMES = ("cc", "gcc", "clang")
_ENDINGS = {"win32": ".dll", "darwin": ".dylib"}
LIBRARY_ENDING = _ENDINGS.get(sys.platform, ".so")
_SHARED = ("-shared",) if sys.platform == "win32" else ("-fPIC", "-shared")


class NoCompiler(RuntimeError):  # noqa: N818 - a sentence for people
    """There is no compiler of C, or it does not do its work."""


def compiler() -> list[str]:
    """The command of the compiler: that of the environment's CC, or the first of cc, gcc and clang.

    Raises
    ------
    NoCompiler
        None of them is there.
    """
    chosen = _words("CC")
    if chosen and shutil.which(chosen[0]):
        return chosen
    found = next(filter(None, map(shutil.which, _NAMES)), None)
    if chosen or found is None:
        names = f"CC is {chosen[0]!r}, which is not there" if chosen else f"none of {', '.join(_NAMES)} is there"
        raise NoCompiler(f"no compiler of C: {names}")
    return [found]


def shared_library(sources: Sequence[str], library: Path, folder: Path, options: Sequence[str] = ()) -> Path:
    """Compile sources of a folder into a library that other programs load; the environment's CFLAGS are obeyed.

    Raises
    ------
    NoCompiler
        There is no compiler, or it refuses, with its first complaint.
    """
    chosen = _words("CFLAGS")
    words = [*compiler(), "-std=c99", "-O2", *chosen, *_SHARED, *options, *sources, "-o", str(library), "-lm"]
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, errors="replace", timeout=300)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoCompiler(f"the compiler {words[0]} could not be run: {error}") from error
    if done.returncode:
        told = done.stderr.splitlines() or ["it says nothing"]
        said = next((line for line in told if "error" in line), told[0])
        raise NoCompiler(f"the compiler {words[0]} ended with {done.returncode}: {said:.200}")
    return library


def _words(name: str) -> list[str]:
    """A variable of the environment as the words of a command."""
    value = os.environ.get(name, "")
    try:
        return shlex.split(value)
    except ValueError as error:
        raise NoCompiler(f"no compiler of C: {name} is {value!r:.60}, which is no command") from error
