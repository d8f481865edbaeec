"""What was measured: numbers at loads, each with its uncertainty, and the machine that measured them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import inf, pi
from types import MappingProxyType
from typing import Any

import numpy

from ..contact import Contact
from ..core.arrays import Numbers
from ..core.checks import known_name, require, select_load, shown
from ..core.kinds import Kind, Unit
from ..core.quantities import CONTACT, DERIVED, FIELD, JOINT, LOADS, PARTS, Quantity
from ..problem import Joint

MEASURED: Mapping[str, Quantity] = MappingProxyType(
    {
        **{name: each for name, each in CONTACT.items() if name != "max_pressure_angle"},
        "pressure": FIELD["pressure"],
        "pressure_integral": DERIVED["pressure_integral"],
        **JOINT,
        **PARTS,
    }
)
"""What can be measured: of a contact at a load, or of the joint itself, which needs none."""

OF_JOINT = (*JOINT, *PARTS)
"""What is measured without a load, such as the free play of a joint, its `diametral_clearance`."""

MACHINE: Mapping[str, Quantity] = MappingProxyType(
    {
        "compliance": Quantity(
            "compliance",
            "Cm",
            "compliance of the machine",
            Kind.COMPLIANCE,
            "Deformation of frame and fixtures per force.",
            Unit("µm/kN", 1e6),
            allows=lambda value: value >= 0,
            allowed="a machine's compliance (mm/N) is 0 or more",
        ),
        "offset": Quantity(
            "offset", "d0", "zero offset", Kind.LENGTH, "Indentation that is read at first touch.", Unit("µm", 1e3)
        ),
        "drift": Quantity(
            "drift",
            "dd",
            "drift of the zero",
            Kind.LENGTH,
            "Change of the zero from one reading to the next.",
            Unit("µm", 1e3),
        ),
    }
)
"""Errors of a machine that add to an indentation."""

Between = float | tuple[float, float]
"""A number that is known, or the ends between which it is unknown."""


@dataclass(frozen=True, kw_only=True)
class Machine:
    """A machine that adds to the indentations it reads: d + compliance x force + offset + drift x order.

    Parameters
    ----------
    compliance : float or (low, high)
        Of frame and fixtures in mm/N; two ends make it an unknown that is found with the others.
    offset : float or (low, high)
        Of the zero in mm.
    drift : float or (low, high)
        Drift of the zero in mm per reading; `Measured.order` numbers the readings.
    name : str
        Machines of one name are one: several sets of data may share its unknowns.

    Raises
    ------
    ValueError
        A compliance below 0; ends that are not finite, or the wrong way round.
    """

    compliance: Between = 0.0
    offset: Between = 0.0
    drift: Between = 0.0
    name: str = "machine"

    def __post_init__(self) -> None:
        for part, value in self._parts():
            ends = value if isinstance(value, tuple) else (value, value)
            if (
                len(ends) != 2
                or not -inf < ends[0] <= ends[1] < inf
                or (isinstance(value, tuple) and ends[0] == ends[1])
            ):
                raise ValueError(f"{part} = {shown(value)} must be a number, or two ends that go upwards")
        low = self.compliance[0] if isinstance(self.compliance, tuple) else self.compliance
        require("compliance", low, MACHINE["compliance"].allows(low), MACHINE["compliance"].allowed)

    def _parts(self) -> list[tuple[str, Between]]:
        return [(part, getattr(self, part)) for part in MACHINE]

    def key(self, part: str) -> str:
        """The name of an unknown of this machine, "machine.offset"."""
        return f"{self.name}.{part}"

    @property
    def unknowns(self) -> dict[str, tuple[float, float]]:
        """Ends of what is not known, by its key."""
        return {self.key(part): value for part, value in self._parts() if isinstance(value, tuple)}

    def known(self) -> dict[str, float]:
        """What is known, by its key."""
        return {self.key(part): value for part, value in self._parts() if not isinstance(value, tuple)}


@dataclass(frozen=True)
class Own:
    """One's own quantity, such as the frequency of a vibration: how it is described, and read from a contact."""

    described: Quantity
    read: Callable[[Contact], Any]


PERFECT = Machine(name="")
"""A machine that adds nothing."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """Measured values of one quantity, at loads or of the joint itself.

    Parameters
    ----------
    quantity : str
        One of `MEASURED`: "indentation", "half_angle", "area", "max_pressure", "force", ...; "pressure" at angles; or
        a number of the joint, such as "diametral_clearance", which needs no load.
    values : array
        In mm, N, MPa, rad.
    uncertainty : float or array
        Standard uncertainty (k = 1) of the values, in their unit, above 0.
    force, indentation, half_angle : array
        One of them: the loads.
    load_uncertainty : float or array
        Standard uncertainty of the loads.
    angle : array
        Polar angles (rad) from the load axis, of a "pressure".
    saturation : float
        What a film or sensor reads at most: values there say that the quantity is at least so much.
    machine : Machine
        What reads the indentations.
    order : array
        Numbers of the readings in the order of measurement, for a drift of the zero. Default 0, 1, 2, ...
    own : Own
        What one's own quantity is, of any name.
    name : str
        What a refusal or a figure calls this set, such as its file.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value and place; a quantity that is not known; no load.

    Examples
    --------
    >>> areas = Measured(quantity="area", values=[300.0, 420.0], uncertainty=8.0, force=[1000.0, 2000.0])
    >>> len(areas)
    2
    """

    quantity: str
    values: Any
    uncertainty: Any
    force: Any = None
    indentation: Any = None
    half_angle: Any = None
    load_uncertainty: Any = 0.0
    angle: Any = None
    saturation: float = inf
    machine: Machine = PERFECT
    order: Any = None
    own: Own | None = None
    name: str = ""
    described: Quantity = field(init=False)
    """The quantity with its title and unit."""
    load: str = field(init=False, default="")
    """The name of the load; empty where there is none."""

    def __post_init__(self) -> None:
        if not isinstance(self.machine, Machine):
            raise TypeError(f"machine must be a Machine, got {shown(self.machine)}")
        if self.own is None:
            self._set("quantity", known_name("quantity", self.quantity, MEASURED))
        self._set("described", MEASURED[self.quantity] if self.own is None else self.own.described)
        values = _row(self._called(self.quantity), self.values)
        self._set("values", values)
        self._check_values(values)
        self._set("uncertainty", self._beside(f"{self.quantity}_uncertainty", self.uncertainty, values))
        sigma, title = self.uncertainty, self._called(f"{self.quantity}_uncertainty")
        require(title, sigma, (sigma > 0) & (sigma < inf), "an uncertainty is above 0 and finite")
        require("saturation", self.saturation, self.saturation > 0, "what a film reads at most is above 0")
        if self.quantity not in OF_JOINT:
            self._take_load(values)
        if (self.angle is not None) != (self.quantity == "pressure"):
            raise ValueError(f"{self._called(self.quantity)} needs {'an angle' if self.angle is None else 'no angle'}")
        if self.angle is not None:
            self._set("angle", FIELD["angle"].checked(self._beside("angle", self.angle, values)))
        if self.machine is not PERFECT and "indentation" not in (self.quantity, self.load):
            raise ValueError(f"{self._called(self.quantity)} has a machine, which belongs to an indentation")
        self._set("order", self._readings(values))

    def _set(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)

    def _called(self, what: str) -> str:
        return f"{self.name}: {what}" if self.name else what

    def _readings(self, values: Numbers) -> Numbers:
        if self.order is None:
            return numpy.arange(float(values.size))
        order = self._beside("order", self.order, values)
        require(self._called("order"), order, abs(order) < inf, "numbers of readings must be finite")
        return order

    def _check_values(self, values: Numbers) -> None:
        gaps = numpy.flatnonzero(numpy.isnan(values))
        if len(gaps):
            rows = ", ".join(str(gap + 1) for gap in gaps[:8])
            raise ValueError(f"{self._called(self.quantity)} has no number in row {rows}: leave it out, or give it one")
        if self.own is not None:
            return
        if not self.described.allowed:
            require(self._called(self.quantity), values, (values >= 0) & (values < inf), "it is 0 or more and finite")
        elif self.machine is PERFECT:  # one that adds an offset may read less than nothing
            good = self.described.allows(values)
            require(self._called(self.quantity), values, good, self.described.allowed)

    def _beside(self, what: str, numbers: Any, values: Numbers) -> Numbers:
        """One number for all the values, or one each."""
        row = _row(self._called(what), numbers)
        if row.size not in (1, values.size):
            raise ValueError(f"{self._called(what)} has {row.size} numbers beside {values.size} values")
        if numpy.isnan(row).any():
            raise ValueError(f"{self._called(what)} has no number in row {int(numpy.isnan(row).argmax()) + 1}")
        return numpy.broadcast_to(row, values.shape)

    def _take_load(self, values: Numbers) -> None:
        kind, given = select_load(**{name: getattr(self, name) for name in LOADS})
        if kind == self.quantity:
            raise ValueError(f"{self._called(kind)} is measured, and is the load too")
        row = self._beside(kind, given, values)
        if self.machine is PERFECT or kind != "indentation":
            require(self._called(kind), row, LOADS[kind].allows(row), LOADS[kind].allowed)
        self._set("load", kind)
        self._set(kind, row)
        blur = self._beside("load_uncertainty", self.load_uncertainty, values)
        require(self._called("load_uncertainty"), blur, (blur >= 0) & (blur < inf), "it is 0 or more and finite")
        self._set("load_uncertainty", blur)
        self._check_unloaded(row, values)

    def _check_unloaded(self, load: Numbers, values: Numbers) -> None:
        """Raise ValueError for a value without a load, except from a machine with a zero error."""
        if self.machine.offset == 0.0 and self.machine.drift == 0.0:
            said = f"at first touch there is no {self.described.title}, unless the machine's zero is off"
            require(self._called(self.load), load, (load > 0) | (values == 0), said)

    def __len__(self) -> int:
        return len(self.values)

    @property
    def loads(self) -> Numbers:
        """The loads; empty where there are none."""
        return getattr(self, self.load) if self.load else numpy.zeros(0)

    @property
    def saturated(self) -> Numbers:
        """Which values only say that the quantity is at least so much."""
        return numpy.asarray(self.values >= self.saturation)

    def check_within(self, joint: Joint) -> None:
        """Raise ValueError for what no contact of such a ball can be: wider than half of it."""
        if self.quantity == "area":
            half = 2 * pi * float(joint.ball_radius) ** 2
            said = f"half of this ball has 2π R1² = {half:.4g} mm², which no contact exceeds"
            require(self._called("area"), self.values, self.values < half, said)


def _row(name: str, numbers: Any) -> Numbers:
    try:
        plain = numpy.asarray(numbers)
        row = numpy.atleast_1d(plain.astype(float, casting="safe" if plain.dtype.kind == "c" else "unsafe"))
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name} = {shown(numbers)} must be numbers") from error
    if row.ndim != 1 or row.size == 0:
        raise ValueError(f"{name} of shape {row.shape} must be a row of numbers")
    return row
