"""An exported element, compiled and called; a host of FMI that loads the binary of a unit and calls its functions."""

import ctypes as c
import sys
import zipfile
from importlib import import_module
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ballsocket.export import TARGETS, CElement, ExportJob
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library
from ballsocket.export.fmu import Fmu
from ballsocket.export.tunable import tunables_of

from ..places import ROOT


def _compiles():
    """Whether a library can be compiled and loaded."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        Path(folder, "one.c").write_text("int one(void) { return 1; }\n")
        try:
            c.CDLL(str(shared_library(["one.c"], Path(folder, f"one{LIBRARY_ENDING}"), Path(folder))))
        except (NoCompiler, OSError):
            return False
    return True


needs_compiler = pytest.mark.skipif(not _compiles(), reason="no C compiler")
needs_scripts = pytest.mark.skipif(sys.platform == "win32", reason="Windows does not run scripts as programs")


def skip_without(program):
    """Skip a test of a program that is not installed."""
    if find_spec({"drake": "pydrake"}.get(program, program)) is None:
        pytest.skip(f"{program} is not installed")


def benchmark(name):
    """Import a module of the benchmarks."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.syspath_prepend(str(ROOT))
        return import_module(f"benchmarks.{name}")


tools = benchmark("tools")
"""The benchmark that runs one bounce in every program."""


def written(target, element, folder, name="bouncing", depth=0.05, **options):
    """Paths of the files of a target, and its note."""
    return TARGETS[target].write(ExportJob(element=element, name=name, depth=depth, **options), folder)


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


def load_module(folder, name):
    """Load a module of a folder."""
    spec = spec_from_file_location(name, folder / f"{name}.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table(path):
    return np.genfromtxt(path, delimiter=",", names=True, deletechars="")


class Library:
    """The functions of an element in C, on triples of numbers."""

    def __init__(self, element, folder, name="joint", **options):
        CElement(element=element, name=name, **options).write(folder)
        strict = ("-pedantic-errors", "-Wall", "-Wextra", "-Werror")
        path = shared_library([f"{name}.c"], folder / f"{name}{LIBRARY_ENDING}", folder, strict)
        self.functions, self.name = c.CDLL(str(path)), name
        self.names = [parameter.name for parameter in tunables_of(element)]
        numbers = c.c_double * len(self.names)
        self.defaults = tuple(numbers.in_dll(self.functions, f"{name}_defaults"))
        self.parameters = numbers(*self.defaults)

    def _call(self, function, given, *sizes):
        out = [np.full(size, -1.0) for size in sizes]
        numbers = [np.array(each, dtype=float) for each in given]
        status = getattr(self.functions, f"{self.name}_{function}")(
            c.byref(self.parameters), *map(_at, (*numbers, *out))
        )
        return status, *out

    def load(self, *state):
        return self._call("load", state, 3, 3, 1)

    def contact(self, position):
        return self._call("contact", [position], 1, 1)

    def valid(self, position):
        return bool(self._call("valid", [position])[0])

    def tangent(self, position):
        return self._call("tangent", [position], 9)

    def slope(self, *state_and_way):
        return self._call("slope", state_and_way, 9)

    def complaint(self):
        """Return a sentence on parameters that are not allowed."""
        function = getattr(self.functions, f"{self.name}_complaint")
        function.restype = c.c_char_p
        return function(c.byref(self.parameters))

    def check(self, element, *state, near=1e-12, near_contact=2e-9):
        """Compare load, contact and tangent with an element, which may read the contact from curves within 1e-9."""
        wanted = element(*(tuple(map(float, part)) for part in state))
        status, *loads = self.load(*state)
        assert status == wanted.status
        pairs = [*zip(loads, (wanted.force, wanted.moment, wanted.energy), strict=True)]
        for got, answer in (*pairs, (self.tangent(state[0])[1], np.ravel(wanted.tangent))):
            assert_allclose(got, answer, rtol=near, atol=near * np.linalg.norm(answer))
        _, half_angle, max_pressure = self.contact(state[0])
        sizes = [wanted.half_angle], [wanted.max_pressure]
        assert_allclose((half_angle, max_pressure), sizes, rtol=near_contact)
        return status


def _at(numbers):
    return numbers.ctypes.data_as(c.POINTER(c.c_double))


def packed(path, name):
    """Bytes of a file of an archive."""
    with zipfile.ZipFile(path) as archive:
        return archive.read(name)


def description(path):
    return fromstring(packed(path, "modelDescription.xml"))


def hosted(folder, **unit):
    """A host of a unit that is written into a folder."""
    return Host(Fmu(**unit).write(folder / "unit.fmu").path, folder)


LOG3 = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)
LOG2 = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p, c.c_char_p)


class _Callbacks(c.Structure):
    _fields_ = (("log", LOG2), *((name, c.c_void_p) for name in ("allocate", "free", "finished", "host")))


class Host:
    """An instance of a unit; `messages` are its log."""

    def __init__(self, path, folder):
        about = description(path)
        with zipfile.ZipFile(path) as archive:
            binary = next(name for name in archive.namelist() if name.startswith("binaries/"))
            self.functions = c.CDLL(archive.extract(binary, folder))
        self.version = int(about.get("fmiVersion")[0])
        listed = about.find("ModelVariables")
        self.references = {each.get("name"): int(each.get("valueReference")) for each in listed}
        self.messages = []
        self._begin(about.get("guid") or about.get("instantiationToken"))

    def _begin(self, token):
        made = self._function("Instantiate" if self.version == 2 else "InstantiateModelExchange")
        made.restype = c.c_void_p
        if self.version == 2:
            log = LOG2(lambda env, name, status, category, form, text: self.messages.append((status, text.decode())))
            self.callbacks = _Callbacks(log=log), log
            self.unit = made(b"joint", 0, token.encode(), None, c.byref(self.callbacks[0]), 0, 0)
        else:
            self.callbacks = LOG3(lambda env, status, category, text: self.messages.append((status, text.decode())))
            self.unit = made(b"joint", token.encode(), None, c.c_bool(), c.c_bool(), None, self.callbacks)

    def _function(self, name):
        return getattr(self.functions, f"fmi{self.version}{name}")

    def _call(self, name, names, values):
        references = (c.c_uint * len(names))(*(self.references[each] for each in names))
        count = (c.c_size_t(len(names)),)
        more = () if self.version == 2 else count
        return self._function(name)(c.c_void_p(self.unit), references, *count, values, *more)

    def set(self, **values):
        """Set numbers and return the status; vectors such as `position` take three."""
        flat = {name: value for name, value in values.items() if not isinstance(value, tuple)}
        for name, value in values.items():
            if isinstance(value, tuple):
                flat |= {f"{name}[{axis}]": part for axis, part in enumerate(value, 1)}
        kind = "SetReal" if self.version == 2 else "SetFloat64"
        return self._call(kind, list(flat), (c.c_double * len(flat))(*flat.values()))

    def get(self, *names):
        """Status and numbers."""
        values = (c.c_double * len(names))()
        status = self._call("GetReal" if self.version == 2 else "GetFloat64", names, values)
        return status, list(values)

    def difference(self, unknown, known, state, step):
        """Return the central difference of one number with respect to another of a state, which it leaves set."""
        ends = []
        for by in (-step, step):
            self.set(**{**state, known: state[known] + by})
            ends.append(self.get(unknown)[1][0])
        self.set(**state)
        return (ends[1] - ends[0]) / (2 * step)

    def directional(self, unknown, known):
        """Return the status and the derivative of one number with respect to another."""
        one, found = (c.c_double * 1)(1.0), (c.c_double * 1)()
        places = [(c.c_uint * 1)(self.references[name]) for name in (unknown, known)]
        count = c.c_size_t(1)
        sizes = ((), ()) if self.version == 2 else ((count,), (count,))
        asked = (places[0], count, places[1], count, one, *sizes[0], found, *sizes[1])
        status = self._function("GetDirectionalDerivative")(c.c_void_p(self.unit), *asked)
        return status, found[0]
