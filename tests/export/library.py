"""An exported element, compiled and called."""

import ctypes
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from ballsocket.export import CElement
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library


def _compiles():
    """Whether a library can be compiled and loaded."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        Path(folder, "one.c").write_text("int one(void) { return 1; }\n")
        try:
            ctypes.CDLL(str(shared_library(["one.c"], Path(folder, f"one{LIBRARY_ENDING}"), Path(folder))))
        except (NoCompiler, OSError):
            return False
    return True


needs_compiler = pytest.mark.skipif(not _compiles(), reason="no C compiler")
needs_scripts = pytest.mark.skipif(sys.platform == "win32", reason="Windows does not run scripts as programs")


def skip_without(package):
    """Skip a test of a program that is not installed."""
    if find_spec(package) is None:
        pytest.skip(f"{package} is not installed")


def set_compiler(monkeypatch, folder, lines):
    """Write a script of Python that `CC` names as the compiler."""
    script = folder / "script gcc"
    script.write_text("\n".join([f"#!{sys.executable}", "import sys", *lines]), encoding="utf-8")
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))


def writes(header):
    """Line of a compiler that writes the header of a library."""
    return f"open(sys.argv[sys.argv.index('-o') + 1], 'wb').write({header!r})"


def python_header():
    """First bytes of the program of this Python; that of a universal one of macOS has no single platform."""
    header = Path(sys.executable).resolve().read_bytes()[:4096]
    if header[:4] == b"\xca\xfe\xba\xbe":
        pytest.skip("this Python is built for several processors")
    return header


def table(path):
    return np.genfromtxt(path, delimiter=",", names=True, deletechars="")


class Library:
    """The functions of an element in C, on triples of numbers."""

    def __init__(self, element, folder, name="joint"):
        CElement(element=element, name=name).write(folder)
        strict = ("-pedantic-errors", "-Wall", "-Wextra", "-Werror")
        path = shared_library([f"{name}.c"], folder / f"{name}{LIBRARY_ENDING}", folder, strict)
        self.functions, self.name = ctypes.CDLL(str(path)), name
        self.defaults = tuple((ctypes.c_double * 7).in_dll(self.functions, f"{name}_defaults"))
        self.parameters = (ctypes.c_double * 7)(*self.defaults)

    def _call(self, function, given, *sizes):
        out = [np.full(size, -1.0) for size in sizes]
        numbers = [np.array(each, dtype=float) for each in given]
        status = getattr(self.functions, f"{self.name}_{function}")(*self._first(function), *map(_at, (*numbers, *out)))
        return status, *out

    def _first(self, function):
        return (ctypes.byref(self.parameters),) if function in ("load", "slope") else ()

    def load(self, *state):
        return self._call("load", state, 3, 3, 1)

    def contact(self, position):
        return self._call("contact", [position], 1, 1)

    def tangent(self, position):
        return self._call("tangent", [position], 9)

    def slope(self, *state_and_way):
        return self._call("slope", state_and_way, 9)


def _at(numbers):
    return numbers.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
