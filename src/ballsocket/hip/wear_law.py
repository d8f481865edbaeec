"""Base of wear laws: worn depth of each point from the pressures and slides of a cycle; units of wear coefficients."""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any, ClassVar, Protocol

import numpy

from ..core.arrays import Numbers
from ..core.checks import require, shown
from ..core.kinds import Kind, Unit
from ..core.unit_systems import Amount, Sentence
from ..files.units import convert, parse, parse_units, split_quantity
from .kinematics import SurfaceSliding
from .law_fields import Law, LawField, LawUnit

METRE = 1e-3  # wear factor per millimetre of sliding over wear factor per metre
COEFFICIENT = "coefficient"  # key of the wear coefficient in files and among sampled quantities

_NO_COEFFICIENT = "coefficient cannot be sampled: the wear law has no coefficient"
_PRESSURE_STEP = 1e-6  # step of the pressure for the sensitivity of a law, relative to the largest pressure
_PLAUSIBLE_FACTORS = 1e-9, 1e-4  # range of wear factors of materials in joints, in mm³/(N m)
_WORK = re.compile(r"(?<!\()\bN[ *\u00b7]{0,3}(mm?)\b")  # force times length in a denominator, without brackets
_WEAR_FACTOR = "mm^3/(N m)"
_PER_LENGTH = f"{_WEAR_FACTOR}, a volume over a force and a length of sliding"
_FACTOR_UNITS = (_WEAR_FACTOR, "m^3/(N m)")  # accepted units of a wear factor: each is for metres of sliding
_ENERGY_UNITS = (*_FACTOR_UNITS, "mm^3/J", "mm^3/kJ", "mm^3/MJ", "m^3/J")  # accepted units of a wear volume per energy


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleExposure:
    """Pressure and sliding of all points of a surface during a cycle, as a wear law needs.

    Attributes
    ----------
    pressure : array (instants, points)
        Pressure in MPa.
    sliding : SurfaceSliding
    contact_shares : function, optional
        Function that computes `contact`. Without it, a cell with a positive pressure is in contact completely.
    """

    pressure: Numbers
    sliding: SurfaceSliding
    contact_shares: Callable[[], Numbers] | None = None

    @cached_property
    def contact(self) -> Numbers:
        """Fraction of each point's cell that is in contact, from 0 to 1: (instants, points)."""
        return (self.pressure > 0).astype(float) if self.contact_shares is None else self.contact_shares()

    @cached_property
    def work(self) -> Numbers:
        """Friction work per area over the coefficient of friction, ∫ p v dt, in N/mm: (points,)."""
        return numpy.einsum("tp,tp->p", self.pressure, self.sliding.distances)

    @cached_property
    def cross_shear(self) -> Numbers:
        """Cross-shear ratio of sliding at each point, from 0 to 1/2: (points,)."""
        return self.sliding.cross_shear(self.pressure)

    def select_contact(self, mask: Numbers) -> CycleExposure:
        """Return the exposure without the pressure and contact outside a mask (instants, points)."""
        return CycleExposure(
            pressure=numpy.where(mask, self.pressure, 0.0),
            sliding=self.sliding,
            contact_shares=lambda: self.contact * mask,
        )


@dataclass(frozen=True, kw_only=True)
class FirstCycleResult:
    """Results of the first cycle, on an unworn bore.

    Attributes
    ----------
    slide : float
        Sliding distance of the ball past the line of the load, in mm.
    work : float
        ∫∫ p v dA dt in N m.
    cross_shear : float
        Mean cross-shear over the socket, weighted by p v.
    volume, depth : float
        Worn volume in mm³ and largest worn depth in mm of a million such cycles.
    max_pressure, max_force : float
        Largest pressure in MPa and largest force in N.
    """

    slide: float
    work: float
    cross_shear: float
    volume: float
    depth: float
    max_pressure: float
    max_force: float


class AnyWearLaw(Protocol):
    """Interface of a wear law: a `WearLaw`, or any object with `depth` and `notes`."""

    def depth(self, cycle: CycleExposure) -> Numbers:
        """Compute the worn depth in mm of each point in a cycle: (points,)."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the coefficients, for reports."""


class WearLaw(Law):
    """Base class of wear laws: frozen dataclasses with fields by `law_field`, and the method `depth`.

    A law in the registry `WEAR_LAWS` is available in files, on the command line, and in the explorer.
    """

    wears_balls: ClassVar[bool] = True
    """True if files accept a `ball_coefficient` of a ball that wears too."""

    @abstractmethod
    def depth(self, cycle: CycleExposure) -> Numbers:
        """Compute the worn depth in mm of each point in a cycle: (points,)."""

    @property
    def pressure_degree(self) -> float | None:
        """Degree of the law in pressure: a times all pressures wear a^degree times the depth. None if unknown."""
        return None

    def with_coefficient(self, value: float) -> WearLaw:
        """Return this law with another value of its wear coefficient; ValueError for a law without one."""
        field = coefficient_field(self)
        if field is None:
            raise ValueError(_NO_COEFFICIENT)
        changed: WearLaw = replace(self, **{field.name: value})  # type: ignore[type-var]
        return changed


def coefficient_field(law: Any) -> LawField | None:
    """Return the field with the wear coefficient of a law; None for a law without a coefficient."""
    law_numbers = law.law_fields() if isinstance(law, Law) else ()
    return next((law_number for law_number in law_numbers if law_number.key == COEFFICIENT), None)


def with_coefficient(law: AnyWearLaw, value: float) -> AnyWearLaw:
    """Return a wear law with another value of its wear coefficient; ValueError for a law without one."""
    if not isinstance(law, WearLaw):
        raise ValueError(_NO_COEFFICIENT)
    return law.with_coefficient(value)


def plausibility_notes(*factors: float) -> tuple[str, ...]:
    """Return a sentence on a wear factor in mm³/(N m) outside the usual range; empty otherwise."""
    low, high = _PLAUSIBLE_FACTORS
    unusual_factor = next((factor for factor in factors if factor > 0 and not low <= factor <= high), None)
    if unusual_factor is None:
        return ()
    factors_in_text = (Amount(factor, Unit(_WEAR_FACTOR)) for factor in (unusual_factor, low, high))
    text = (
        "a wear factor of {} is out of the usual range of {} to {}; numbers in mm^3/(N mm) are 1000 times smaller than "
        "in mm^3/(N m)"
    )
    return (Sentence(text, *factors_in_text),)


def max_wear_sensitivity(law: AnyWearLaw, cycle: CycleExposure) -> float:
    """Compute the largest derivative in mm/MPa of the worn depth per cycle with respect to pressure."""
    pressure_step = _PRESSURE_STEP * float(cycle.pressure.max(initial=0.0))
    if not pressure_step > 0:
        return 0.0
    raised_exposure = CycleExposure(
        pressure=cycle.pressure + pressure_step * (cycle.pressure > 0),
        sliding=cycle.sliding,
        contact_shares=lambda: cycle.contact,
    )
    return float((law.depth(raised_exposure) - law.depth(cycle)).max() / pressure_step)


def wear_factor(name: str, value: Any) -> float:
    """Read a wear factor k in mm³/(N m) from a number, or from text such as "1.066e-6 mm^3/(N m)".

    Raises
    ------
    ValueError
        Text without a number, a unit of another dimension, or a unit for another length of sliding than the metre.
        The message states the factor between both lengths.

    Examples
    --------
    >>> wear_factor("coefficient", "1.066e-6 mm³/(N·m)")
    1.066e-06
    >>> wear_factor("coefficient", "1.066e-9 mm^3/(N mm)")
    Traceback (most recent call last):
    ValueError: coefficient = '1.066e-9 mm^3/(N mm)' is for mm of sliding: 1 mm^3/(N mm) is 1000 mm^3/(N m), \
so that this is 1.066e-06 mm^3/(N m); write it so
    """
    return _read_coefficient(name, value, _WEAR_FACTOR, f"0 {_WEAR_FACTOR}", _WEAR_FACTOR, _PER_LENGTH, _FACTOR_UNITS)


def wear_per_energy(name: str, value: Any) -> float:
    """Read a worn volume per friction energy in mm³/J, such as "1e-5 mm^3/J"; see `wear_factor`."""
    return _read_coefficient(name, value, "mm^3/J", "0 mm^3/J", _WEAR_FACTOR, _PER_LENGTH, _ENERGY_UNITS)


def wear_per_slide(name: str, value: Any) -> float:
    """Read a worn depth per sliding distance in mm/mm, such as "1e-6 mm/m"; see `wear_factor`."""
    return _read_coefficient(name, value, "mm/m", "0", "", "mm/mm, a depth over a length of sliding")


def _read_coefficient(
    name: str, value: Any, example: str, least: str, target: str, meaning: str, allowed: tuple[str, ...] = ()
) -> float:
    """Read a number, or text with a unit like the example, in the target unit; `allowed` units are for a metre."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        number, unit = parse(name, value, Kind.NUMBER), ""
    else:
        try:
            number, unit = split_quantity(value if isinstance(value, str) else "")
            unit = _WORK.sub(r"(N*\1)", unit)
            parse_units(unit)
        except ValueError as error:
            raise ValueError(f"{name} = {shown(value)} is not a coefficient, such as '1e-6 {example}'") from error
    if unit:
        try:
            factor = convert(1.0, parse_units(unit), parse_units(target))
        except ValueError as error:
            raise ValueError(f"{name} = {shown(value)} has the wrong unit; expected {meaning}") from error
        if allowed and parse_units(unit) not in map(parse_units, allowed):
            written = unit.replace("**", "^").replace("N*m", "N m")
            length = "for mm of sliding" if abs(factor / 1000 - 1) < 1e-9 else "for another length of sliding"
            raise ValueError(
                f"{name} = {shown(value)} is {length}: 1 {written} is {factor:.6g} {target}, "
                f"so that this is {number * factor:.6g} {target}; write it so"
            )
        number *= factor
    require(name, number, 0 <= number < inf, f"a wear coefficient is at least {least}, and finite")
    return number


WEAR_FACTOR = LawUnit(text="mm³/(N m)", typed=_WEAR_FACTOR, suffix="mm3_per_Nm", read=wear_factor)
"""Unit of a worn volume over force and length of sliding."""

WEAR_PER_ENERGY = LawUnit(text="mm³/J", typed="mm^3/J", suffix="mm3_per_J", read=wear_per_energy)
"""Unit of a worn volume over friction energy."""

WEAR_PER_SLIDE = LawUnit(text="mm/mm", typed="mm/mm", suffix="mm_per_mm", read=wear_per_slide)
"""Unit of a worn depth over a length of sliding."""
