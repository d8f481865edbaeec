"""A host of FMI that loads the binary of a unit and calls its functions."""

import ctypes as c
import zipfile
from xml.etree.ElementTree import fromstring

NUMBERS = c.POINTER(c.c_double)
LOG3 = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)
LOG2 = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p, c.c_char_p)


class _Callbacks(c.Structure):
    _fields_ = (("log", LOG2), *((name, c.c_void_p) for name in ("allocate", "free", "finished", "host")))


class Host:
    """An instance of a unit; `messages` are its log."""

    def __init__(self, path, folder):
        with zipfile.ZipFile(path) as archive:
            about = fromstring(archive.read("modelDescription.xml"))
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

    def directional(self, unknown, known):
        """Return the status and the derivative of one number with respect to another."""
        one, found = (c.c_double * 1)(1.0), (c.c_double * 1)()
        places = [(c.c_uint * 1)(self.references[name]) for name in (unknown, known)]
        count = c.c_size_t(1)
        sizes = ((), ()) if self.version == 2 else ((count,), (count,))
        asked = (places[0], count, places[1], count, one, *sizes[0], found, *sizes[1])
        status = self._function("GetDirectionalDerivative")(c.c_void_p(self.unit), *asked)
        return status, found[0]
