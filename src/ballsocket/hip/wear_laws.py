"""Wear laws, and the registry in which files, the command line and the explorer find them by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy

from ..core.arrays import Numbers
from ..core.checks import NamedItems, known_name, require
from ..core.kinds import Unit
from ..core.unit_systems import Amount, Sentence
from ..problem.presets import materials
from .law_fields import NUMBER, PRESSURE, Law, law_field, read_law, select_law_class
from .wear_law import (
    COEFFICIENT,
    METRE,
    WEAR_FACTOR,
    WEAR_PER_ENERGY,
    WEAR_PER_SLIDE,
    CycleExposure,
    WearLaw,
    plausibility_notes,
)


@dataclass(frozen=True, kw_only=True)
class WearFactor:
    """Published wear factor of a material against a smooth ball.

    Attributes
    ----------
    material : str
        Name of the material.
    value : float
        Wear factor k in mm³/(N m).
    low, high : float
        Range of the factors in mm³/(N m).
    source : str
        Publications; "(unverified)" follows a number that was not read in its publication.
    """

    material: str
    value: float
    low: float
    high: float
    source: str

    @property
    def description(self) -> Sentence:
        """Sentence with the factor, its range and its source."""
        numbers = (Amount(number, Unit(WEAR_FACTOR.text)) for number in (self.value, self.low, self.high))
        return Sentence("wear factor of {}: {}, range {} to {}; {}", self.material, *numbers, self.source)


_WEAR_FACTORS = (
    WearFactor(
        material="uhmwpe",
        value=1.066e-6,
        low=0.7e-6,
        high=1.6e-6,
        source="Maxian et al. 1996, J. Biomech. 29, 687 (unverified); range: a factor of 1.5 (assumed)",
    ),
    WearFactor(
        material="crosslinked-pe",
        value=2e-7,
        low=1e-7,
        high=4e-7,
        source="middle of the range (unverified); a review of pin tests has an eighth of the wear of conventional "
        "polyethylene, some 1.3e-7 (Baykal et al. 2013, J. Mech. Behav. Biomed. Mater., abstract)",
    ),
)

WEAR_FACTORS: Mapping[str, WearFactor] = NamedItems("wear factor", {item.material: item for item in _WEAR_FACTORS})
"""Published wear factors by material, for `material = "crosslinked-pe"` in the table [wear] of a file."""


def wear_factor_of(material: str) -> WearFactor:
    """Return the published wear factor of a material.

    Raises ValueError: a material that is not known, or without a published wear factor in this package.
    """
    preset = materials[known_name("material", material, materials)]
    for name, factor in WEAR_FACTORS.items():
        if materials[name] is preset:
            return factor
    raise ValueError(
        f"no published wear factor of {material!r} is known here: state coefficient; materials with one: "
        f"{', '.join(WEAR_FACTORS)}"
    )


@dataclass(frozen=True, kw_only=True)
class Archard(WearLaw):
    """Archard's wear law dh = k p v dt, with pressure p and sliding speed v.

    Parameters
    ----------
    coefficient : float
        k in mm³/(N m): 1.066e-6 for conventional UHMWPE, some 1e-7 to 4e-7 for cross-linked UHMWPE.
    source : str
        Source of the coefficient, for the notes.

    Examples
    --------
    >>> Archard.of_material("crosslinked-pe").coefficient
    2e-07
    """

    name: ClassVar[str] = "archard"
    title: ClassVar[str] = "Archard: pressure and sliding"
    coefficient: float = law_field(WEAR_FACTOR, "wear factor k", example=1e-6)
    source: str = ""

    @classmethod
    def of_material(cls, material: str) -> Archard:
        """Create the law with the published wear factor of a material, such as "crosslinked-pe"; see `WEAR_FACTORS`.

        Raises ValueError: as `wear_factor_of`.
        """
        factor = wear_factor_of(material)
        return cls(coefficient=factor.value, source=factor.description)

    @property
    def pressure_degree(self) -> float:
        return 1.0

    def depth(self, cycle: CycleExposure) -> Numbers:
        return METRE * self.coefficient * cycle.work

    def with_coefficient(self, value: float) -> Archard:
        """Return the law with another wear factor, which has no source."""
        return Archard(coefficient=value)

    def summary(self) -> dict[str, Any]:
        """Return name, wear factor and its source as a dictionary for JSON."""
        return {**super().summary(), **({"source": self.source} if self.source else {})}

    @property
    def notes(self) -> tuple[str, ...]:
        return (*plausibility_notes(self.coefficient), *filter(None, [self.source]))


@dataclass(frozen=True, kw_only=True)
class FrictionEnergyWear(WearLaw):
    """Wear law by the work of friction, dh = e μ p v dt.

    Parameters
    ----------
    coefficient : float
        e in mm³ per joule of friction.
    friction : float
        Coefficient of friction μ.
    """

    name: ClassVar[str] = "energy"
    title: ClassVar[str] = "work of friction"
    coefficient: float = law_field(WEAR_PER_ENERGY, "worn volume e per friction energy", example=2e-5)
    friction: float = law_field(NUMBER, "coefficient of friction", example=0.05, high=10.0)

    @property
    def pressure_degree(self) -> float:
        return 1.0

    def depth(self, cycle: CycleExposure) -> Numbers:
        return METRE * self.coefficient * self.friction * cycle.work

    @property
    def notes(self) -> tuple[str, ...]:
        return plausibility_notes(self.coefficient * self.friction)


@dataclass(frozen=True, kw_only=True)
class ContactAreaWear(WearLaw):
    """Wear law by sliding in contact, dh = C v dt, independent of the pressure.

    A cell at the edge of the contact wears in proportion to its contact share.

    Parameters
    ----------
    coefficient : float
        C in mm per mm of sliding, mm³/(mm² mm).
    """

    name: ClassVar[str] = "area"
    title: ClassVar[str] = "sliding at any pressure"
    coefficient: float = law_field(WEAR_PER_SLIDE, "worn depth C per length of sliding", example=1e-9)

    @property
    def pressure_degree(self) -> float:
        return 0.0

    def depth(self, cycle: CycleExposure) -> Numbers:
        return self.coefficient * numpy.einsum("tp,tp->p", cycle.contact, cycle.sliding.distances)


@dataclass(frozen=True, kw_only=True)
class CrossShear(WearLaw):
    """Wear law dh = k p v dt with a wear factor k that increases with cross-shear, and may depend on pressure.

    k = [straight + 2 CS (circular - straight)] (p/reference)^exponent. CS is the cross-shear, and p the mean pressure
    of a point while it slides in contact.

    Parameters
    ----------
    straight, circular : float
        k in mm³/(N m) on a straight track, CS = 0, and on a circle, CS = 1/2.
    exponent : float
        Exponent of the pressure; 0 (default) for a k that is independent of the pressure.
    reference : float
        Pressure in MPa at which k has the values above. Default 1.
    """

    name: ClassVar[str] = "cross-shear"
    title: ClassVar[str] = "Archard with cross-shear"
    wears_balls: ClassVar[bool] = False
    straight: float = law_field(WEAR_FACTOR, "wear factor on a straight track", example=1e-6, key=COEFFICIENT)
    circular: float = law_field(WEAR_FACTOR, "wear factor on a circle", example=2e-6)
    exponent: float = law_field(NUMBER, "exponent", example=0.0, default=0.0, low=-1.0, high=3.0, low_included=False)
    reference: float = law_field(PRESSURE, "reference pressure", example=1.0, default=1.0, low_included=False)

    @property
    def pressure_degree(self) -> float:
        return 1.0 + self.exponent

    def depth(self, cycle: CycleExposure) -> Numbers:
        factor = self.straight + 2 * cycle.cross_shear * (self.circular - self.straight)
        if self.exponent != 0:
            distance = cycle.sliding.distances.sum(axis=0, where=cycle.pressure > 0)
            mean = numpy.divide(cycle.work, distance, out=numpy.zeros_like(distance), where=distance > 0)
            factor = factor * numpy.where(mean > 0, mean / self.reference, 1.0) ** self.exponent
        return METRE * factor * cycle.work

    def with_coefficient(self, value: float) -> CrossShear:
        """Return the law with another wear factor on a straight track, and the same ratio of both factors."""
        require(COEFFICIENT, self.straight, self.straight > 0, "a sampled wear factor on a straight track is positive")
        return replace(self, straight=value, circular=self.circular * (value / self.straight))

    @property
    def notes(self) -> tuple[str, ...]:
        return plausibility_notes(self.straight, self.circular)


@dataclass(frozen=True, kw_only=True)
class CustomWearLaw(Law):
    """Wear law defined by a Python function; files do not have it.

    Parameters
    ----------
    function : function
        Function from a `CycleExposure` (its `pressure`, `sliding.distances`, `work`, `cross_shear`) to worn depths in
        mm: (points,), at least 0.

    Raises
    ------
    ValueError
        A depth of the function has another shape, is negative, or is not finite.

    Examples
    --------
    Archard's law with a pressure below which nothing wears:

    >>> law = CustomWearLaw(
    ...     function=lambda cycle: 1e-9 * ((cycle.pressure - 0.5).clip(0) * cycle.sliding.distances).sum(axis=0)
    ... )
    """

    name: ClassVar[str] = "custom"
    title: ClassVar[str] = "custom function"
    storable: ClassVar[bool] = False
    function: Callable[[CycleExposure], Numbers]

    def depth(self, cycle: CycleExposure) -> Numbers:
        """Compute the worn depth in mm of each point in a cycle by the given function: (points,)."""
        depth, shape = numpy.asarray(self.function(cycle), dtype=float), cycle.pressure.shape[1:]
        if depth.shape != shape:
            raise ValueError(f"a CustomWearLaw returned depths of shape {depth.shape}; the points need {shape}")
        allowed = (depth >= 0) & (depth < numpy.inf)
        if not allowed.all():
            raise ValueError(
                f"a CustomWearLaw returned a depth of {depth[~allowed][0]:g} mm: a depth is at least 0, and finite"
            )
        return depth


_WEAR_LAWS: tuple[type[WearLaw], ...] = (
    Archard,
    FrictionEnergyWear,
    ContactAreaWear,
    CrossShear,
)

WEAR_LAWS: Mapping[str, type[WearLaw]] = NamedItems("wear law", {law.name: law for law in _WEAR_LAWS})
"""Registry of the wear laws by their names in files; the first one is the default."""

BALL_COEFFICIENT = "ball_coefficient"  # key of the wear coefficient of a ball that wears too


MATERIAL = "material"  # key of the material whose published wear factor is used


def read_wear_law(table: Mapping[str, Any]) -> WearLaw:
    """Read the wear law of the socket from the table [wear] of a file."""
    law = select_law_class(table, WEAR_LAWS, "law")
    if MATERIAL not in table:
        return read_law(table, WEAR_LAWS, law)
    if law is not Archard:
        raise ValueError(f"material gives the wear factor of the law 'archard', and the law is {law.name!r}")
    if COEFFICIENT in table:
        raise ValueError("material and coefficient exclude each other: both set the wear factor; remove one")
    return Archard.of_material(table[MATERIAL])


def read_ball_law(table: Mapping[str, Any]) -> WearLaw | None:
    """Read the wear law of the ball from the table [wear] of a file; None for a ball without wear."""
    law = select_law_class(table, WEAR_LAWS, "law")
    if BALL_COEFFICIENT not in table:
        return None
    if not law.wears_balls:
        names = ", ".join(repr(name) for name, registered_law in WEAR_LAWS.items() if registered_law.wears_balls)
        raise ValueError(f"{BALL_COEFFICIENT} is not allowed with the law {law.name!r}; it belongs to {names}")
    return read_law(table, WEAR_LAWS, law, keys={COEFFICIENT: BALL_COEFFICIENT})
