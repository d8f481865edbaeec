"""An exported element, compiled and called."""

import ctypes
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from ballsocket.export import CElement
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library


def _missing():
    """Return the reason why no library can be compiled and loaded, empty if one can."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        Path(folder, "one.c").write_text("int one(void) { return 1; }\n")
        try:
            ctypes.CDLL(str(shared_library(["one.c"], Path(folder, f"one{LIBRARY_ENDING}"), Path(folder))))
        except (NoCompiler, OSError) as missing:
            return str(missing)
    return ""


MISSING = _missing()
needs_compiler = pytest.mark.skipif(bool(MISSING), reason=MISSING)


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
