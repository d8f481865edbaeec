"""The machine that reads indentations, with known and unknown errors."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf
from typing import Any

from ..core.checks import nearest, require, shown
from .registry import MACHINE_ERRORS

NumberOrRange = float | tuple[float, float]
"""A known number, or the lower and upper end of an unknown one."""


@dataclass(frozen=True, init=False)
class Machine:
    """Testing machine that adds errors to the indentations it reads.

    A reading is d + compliance x force + offset + drift x order.

    Parameters
    ----------
    compliance : float or (low, high)
        Compliance of frame and fixtures in mm/N. Two ends make it an unknown of the identification.
    offset : float or (low, high)
        Offset of the zero in mm.
    drift : float or (low, high)
        Drift of the zero in mm per reading; `Measured.order` numbers the readings.
    name : str
        Data sets with the same machine name share its unknowns.

    Raises
    ------
    ValueError
        A compliance below 0; ends that are not finite or not in ascending order.
    TypeError
        An error that is not registered.
    """

    errors: tuple[tuple[str, NumberOrRange], ...]
    """Sizes of all registered errors, by name."""
    name: str

    def __init__(
        self,
        *,
        name: str = "machine",
        errors: Iterable[tuple[str, NumberOrRange]] = (),
        **sizes: NumberOrRange,
    ) -> None:
        sizes = {**dict(errors), **sizes}
        for key in sizes:
            if key not in MACHINE_ERRORS:
                raise TypeError(f"{shown(key)} is not an error of a machine{nearest(key, MACHINE_ERRORS)}")
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "errors", tuple((key, sizes.get(key, 0.0)) for key in MACHINE_ERRORS))
        for key, size in self.errors:
            quantity, ends = MACHINE_ERRORS[key].quantity, size if isinstance(size, tuple) else (size, size)
            is_ascending = len(ends) == 2 and -inf < ends[0] <= ends[1] < inf
            if not is_ascending or (isinstance(size, tuple) and ends[0] == ends[1]):
                raise ValueError(f"{key} = {shown(size)} must be a number, or two ends in ascending order")
            require(key, ends[0], quantity.allows(ends[0]), quantity.allowed)

    def __getattr__(self, name: str) -> Any:
        sizes = dict(self.__dict__.get("errors", ()))
        if name not in sizes:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return sizes[name]

    def __repr__(self) -> str:
        sizes = [f"{key}={size!r}" for key, size in self.errors]
        return f"Machine({', '.join([*sizes, f'name={self.name!r}'])})"

    def key(self, error: str) -> str:
        """Return the full name of an error of this machine, such as "machine.offset"."""
        return f"{self.name}.{error}"

    @property
    def unknown_errors(self) -> dict[str, tuple[float, float]]:
        """Lower and upper limit of each unknown error, by full name such as "machine.offset"."""
        return {self.key(error): size for error, size in self.errors if isinstance(size, tuple)}

    def known_errors(self) -> dict[str, float]:
        """Return the size of each known error, by full name such as "machine.offset"."""
        return {self.key(error): size for error, size in self.errors if not isinstance(size, tuple)}

    @property
    def has_zero_error(self) -> bool:
        """True if the machine may read an indentation other than zero at zero force."""
        return any(size != 0.0 for error, size in self.errors if MACHINE_ERRORS[error].slope is None)

    @property
    def depends_on_force(self) -> bool:
        """True if an error of the machine depends on the force."""
        return any(size != 0.0 for error, size in self.errors if MACHINE_ERRORS[error].slope is not None)


IDEAL_MACHINE = Machine(name="")
"""A machine without errors."""
