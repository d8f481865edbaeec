"""Measured values with uncertainties, at loads or of the joint itself, and the machine that reads them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import inf, pi
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers, owned
from ..core.checks import known_name, nearest, require, select_load, shown
from ..core.quantities import CONTACT, DERIVED, FIELD, JOINT, LOADS, PARTS, Quantity
from ..problem import Joint
from .observables import CustomObservable
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


MEASURED: Mapping[str, Quantity] = MappingProxyType(
    {
        **{name: quantity for name, quantity in CONTACT.items() if name != "max_pressure_angle"},
        "pressure": FIELD["pressure"],
        "pressure_integral": DERIVED["pressure_integral"],
        **JOINT,
        **PARTS,
    }
)
"""Quantities that can be measured: those of a contact need a load, those of the joint none."""

ALIASES: Mapping[str, str] = MappingProxyType({"displacement": "indentation"})
"""Other names of measured quantities; a displacement is positive into the socket, and 0 at first touch."""

OF_JOINT = (*JOINT, *PARTS)
"""Quantities that are measured without a load, such as the free play of a joint, its `diametral_clearance`."""


_FIRST_NOISE = 0.02  # first estimate of an uncertainty that was not stated, over the largest value
_ZERO_HINT = "; it is positive into the socket and 0 at first touch: for another zero, give the machine an offset"
_NOT_NEGATIVE = "the value must be 0 or more and finite"  # rule in a message


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """Data set: measured values of one quantity with uncertainties and loads.

    A quantity of the joint itself has no load.

    Parameters
    ----------
    quantity : str
        One of `MEASURED`: "indentation", "half_angle", "area", "max_pressure", "force", ...; "pressure" needs angles. A
        number of the joint, such as "diametral_clearance", needs no load. "displacement" is another name of the
        indentation: positive into the socket, 0 at first touch. For another zero, the machine has an offset.
    values : array (values,)
        Measured values in mm, N, MPa, rad.
    uncertainty : float or array, optional
        Standard uncertainty (k = 1) of the values in their unit, above 0. Without it, `identify` estimates one for the
        data set from the scatter about the fit.
    force, indentation, half_angle : array
        Loads in N, mm or rad; exactly one of the three is given.
    relative_uncertainty : float
        Standard uncertainty as a share of each true value, in place of `uncertainty`: `identify` takes it of the fitted
        values, so that a reading that is low by chance has no larger weight. Default 0: none.
    load_uncertainty : float or array
        Standard uncertainty of the loads.
    angle : array
        Polar angles in rad from the load axis, for a "pressure".
    saturation : float
        Largest reading of a film or sensor. A value at this limit is a lower bound.
    machine : Machine
        Machine that reads the indentations.
    order : array
        Numbers of the readings in the order of measurement, for a drift of the zero. Default 0, 1, 2, ...
    observable : CustomObservable
        Custom quantity; `quantity` is then its name.
    name : str
        Name of the data set in messages and figures, such as its file.
    remark : str
        Rows of the file that were read, and lines that were left out; empty without such lines.

    Raises
    ------
    ValueError
        A number that is not allowed, with its value and index; an unknown quantity; a missing load.
    TypeError
        A machine that is not a `Machine`.

    Examples
    --------
    >>> areas = Measured(quantity="area", values=[300.0, 420.0], uncertainty=8.0, force=[1000.0, 2000.0])
    >>> len(areas)
    2
    """

    quantity: str
    values: Any
    uncertainty: Any = None
    force: Any = None
    indentation: Any = None
    half_angle: Any = None
    relative_uncertainty: float = 0.0
    load_uncertainty: Any = 0.0
    angle: Any = None
    saturation: float = inf
    machine: Machine = IDEAL_MACHINE
    order: Any = None
    observable: CustomObservable | None = None
    name: str = ""
    remark: str = ""
    described: Quantity = field(init=False)
    """Quantity with its title and unit."""
    load: str = field(init=False, default="")
    """Name of the load; empty for a quantity of the joint."""
    has_unknown_noise: bool = field(init=False, default=False)
    """True if no uncertainty was stated: `uncertainty` is then a start of its estimate."""

    def __post_init__(self) -> None:
        if not isinstance(self.machine, Machine):
            raise TypeError(f"machine must be a Machine, got {shown(self.machine)}")
        if self.observable is None:
            name = ALIASES.get(self.quantity, self.quantity) if isinstance(self.quantity, str) else self.quantity
            vars(self).update(quantity=known_name("quantity", name, MEASURED))
        described = MEASURED[self.quantity] if self.observable is None else self.observable.described
        values = _to_float_array(self._label(self.quantity), self.values)
        vars(self).update(described=described, values=values)
        self._check_values()
        share = self.relative_uncertainty
        require("relative_uncertainty", share, 0 <= share < inf, "a share of each value is at least 0 and finite")
        stated, is_unknown = self.uncertainty, self.uncertainty is None and not share
        if is_unknown:
            stated = _FIRST_NOISE * float(abs(values).max()) or 1.0
        elif stated is None:
            stated = share * abs(values)
        sigma = self._broadcast(f"{self.quantity}_uncertainty", stated)
        title = self._label(f"{self.quantity}_uncertainty")
        require(title, sigma, (sigma > 0) & (sigma < inf), "an uncertainty is above 0 and finite")
        vars(self).update(has_unknown_noise=is_unknown, uncertainty=sigma)
        require("saturation", self.saturation, self.saturation > 0, "the largest reading of a film is above 0")
        if self.quantity not in OF_JOINT:
            self._check_and_set_load()
        if (self.angle is not None) != (self.quantity == "pressure"):
            rule = "needs an angle" if self.angle is None else "takes no angle"
            raise ValueError(f"{self._label(self.quantity)} {rule}")
        if self.angle is not None:
            vars(self).update(angle=FIELD["angle"].check(self._broadcast("angle", self.angle)))
        if self.machine is not IDEAL_MACHINE and "indentation" not in (self.quantity, self.load):
            raise ValueError(f"{self._label(self.quantity)} has a machine, but only indentations are read by one")
        order = numpy.arange(float(values.size))
        if self.order is not None:
            order = self._broadcast("order", self.order)
            require(self._label("order"), order, abs(order) < inf, "numbers of readings must be finite")
        vars(self).update(order=order)

    def _label(self, quantity: str) -> str:
        return f"{self.name}: {quantity}" if self.name else quantity

    def _check_values(self) -> None:
        label, values = self._label(self.quantity), self.values
        missing = numpy.flatnonzero(numpy.isnan(values))
        if len(missing):
            rows = ", ".join(str(index + 1) for index in missing[:8])
            raise ValueError(f"{label} has no number in row {rows}: add it, or omit the row")
        if self.observable is not None:
            return
        if not self.described.allowed:
            require(label, values, (values >= 0) & (values < inf), _NOT_NEGATIVE)
        elif self.machine is IDEAL_MACHINE:  # a machine with an offset may read less than 0
            rule = self.described.allowed + (_ZERO_HINT if self.quantity == "indentation" else "")
            require(label, values, self.described.allows(values), rule)

    def _broadcast(self, name: str, numbers: Any) -> Numbers:
        """Repeat one number for all values, or check that there is one number for each value."""
        label, size = self._label(name), self.values.size
        array = _to_float_array(label, numbers)
        if array.size not in (1, size):
            raise ValueError(f"{label} must have 1 or {size} numbers, got {array.size}")
        if numpy.isnan(array).any():
            raise ValueError(f"{label} has no number in row {int(numpy.isnan(array).argmax()) + 1}")
        return numpy.broadcast_to(array, self.values.shape)

    def _check_and_set_load(self) -> None:
        kind, load = select_load(**{name: getattr(self, name) for name in LOADS})
        label = self._label(kind)
        if kind == self.quantity:
            raise ValueError(f"{label} is both the measured quantity and the load; choose another load")
        loads = self._broadcast(kind, load)
        if self.machine is IDEAL_MACHINE or kind != "indentation":
            require(label, loads, LOADS[kind].allows(loads), LOADS[kind].allowed)
        sigma = self._broadcast("load_uncertainty", self.load_uncertainty)
        require(self._label("load_uncertainty"), sigma, (sigma >= 0) & (sigma < inf), _NOT_NEGATIVE)
        vars(self).update(load=kind, **{kind: loads}, load_uncertainty=sigma)
        if not self.machine.has_zero_error:
            rule = f"at first touch the {self.described.title} is 0, except with a zero error of the machine"
            require(label, loads, (loads > 0) | (self.values == 0), rule)

    def __len__(self) -> int:
        return len(self.values)

    @property
    def loads(self) -> Numbers:
        """Loads in N, mm or rad, one for each value; empty for a number of the joint."""
        return getattr(self, self.load) if self.load else numpy.zeros(0)

    @property
    def saturated(self) -> Numbers:
        """Mask of the saturated values, which are only lower bounds of the true values."""
        return numpy.asarray(self.values >= self.saturation)

    def check_area(self, joint: Joint) -> None:
        """Check that measured contact areas are smaller than half of the ball's surface; ValueError otherwise."""
        if self.quantity == "area":
            half_ball_area = 2 * pi * float(joint.ball_radius) ** 2
            rule = f"a contact area is below half of the ball, 2π R1² = {half_ball_area:.4g} mm²"
            require(self._label("area"), self.values, self.values < half_ball_area, rule)


def _to_float_array(name: str, numbers: Any) -> Numbers:
    try:
        array = numpy.asarray(numbers)
        array = numpy.atleast_1d(array.astype(float, casting="safe" if array.dtype.kind == "c" else "unsafe"))
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name} = {shown(numbers)} must be numbers") from error
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"{name} of shape {array.shape} must be a row of numbers")
    return owned(array)
