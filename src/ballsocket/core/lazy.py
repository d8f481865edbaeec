"""Values and names that are computed or imported on first use.

`cached_property` has no lock, as in Python 3.12: `torch.compile` cannot trace the lock of Python 3.11.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
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


def imported_names(package: str, names_by_module: Mapping[str, str]) -> Callable[[str], Any]:
    """Return the function `__getattr__` of a package that imports its names on first use.

    The table has names, separated by spaces, by the module of the package that defines them.
    """
    modules = {name: module for module, names in names_by_module.items() for name in names.split()}

    def get_name(name: str) -> Any:
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name, obj=sys.modules[package])
        value = getattr(import_module(f"{package}.{modules[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return get_name
