"""Values and names that are computed or imported on first use.

`cached_property` has no lock, as in Python 3.12: `torch.compile` cannot trace the lock of Python 3.11.
"""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property as cached_property
else:

    class cached_property(functools.cached_property):  # noqa: N801 - the name of the standard library
        """Property that is computed once per instance and then stored in its `__dict__`."""

        def __get__(self, instance: Any, owner: Any = None) -> Any:
            if instance is None:
                return self
            values = instance.__dict__
            if self.attrname not in values:
                values[self.attrname] = self.func(instance)
            return values[self.attrname]


def names_of_stub(
    package: str, init_file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], tuple[str, ...]]:
    """Return `__getattr__` of a package, which imports its names for users on first use, `__dir__`, and these names.

    They are those of the stub beside `__init__.py`, which type checkers read: `from .module import Name as Name`.
    """
    stub = Path(init_file).with_suffix(".pyi").read_text(encoding="utf-8")
    lines = re.findall(r"^from (\.\S+) import \w+ as ([A-Za-z]\w*)$", stub, re.MULTILINE)
    modules = {name: module for module, name in lines}

    def get_name(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
        value = getattr(import_module(modules[name], package), name)
        setattr(sys.modules[package], name, value)
        return value

    return get_name, lambda: sorted({*vars(sys.modules[package]), *modules}), tuple(modules)
