"""Materials and layers, and helpers of such frozen values."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from operator import attrgetter
from typing import Any

from ..core.arrays import Array, all_true, is_plain_number, to_list, where
from ..core.checks import shown
from ..core.display import OneLine, html_list
from ..core.kinds import MEGAPASCALS, MILLIMETRES, PLAIN, Unit
from ..core.quantities import LAYER, MATERIAL, STRENGTH, STRESS_LIMITS
from ..core.unit_systems import Amount, Sentence
from .hardening import Hardening


def make_unchecked(cls: Any, **fields: Any) -> Any:
    """Make a material, layer or joint without the checks of its initialiser.

    The numbers have been checked, or JAX traces them.
    """
    instance = object.__new__(cls)
    vars(instance).update(fields)
    return instance


class ByValue:
    """Base class of frozen dataclasses that are equal if all compared fields are; arrays by shape and all elements.

    An instance with arrays has no hash.
    """

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        kind: Any = type(self)
        read = _compared_fields(kind)
        return self is other or all(map(_is_equal, read(self), read(other)))

    def __hash__(self) -> int:
        kind: Any = type(self)
        return hash(_compared_fields(kind)(self))


@cache
def _compared_fields(kind: Any) -> Any:
    """Make the function that reads the compared fields of a dataclass as a tuple."""
    return attrgetter(*(field.name for field in fields(kind) if field.compare))


def _is_equal(value: Any, other: Any) -> bool:
    if getattr(value, "shape", ()) != getattr(other, "shape", ()):
        return False
    equal = value == other
    return equal if isinstance(equal, bool) else bool(all_true(equal))


def short_text(value: Array) -> str:
    """Format a number with six digits, or the shape of an array; "<traced>" without a value."""
    shape = tuple(getattr(value, "shape", ()))
    try:
        return f"{float(value):g}" if not shape else f"<array {'x'.join(map(str, shape))}>"
    except TypeError:  # a tracer has no value yet
        return "<traced>"


def number_with_unit(value: Array, unit: Unit = PLAIN) -> Amount | str:
    """Return a number for a sentence, with six digits if four do not state it; the shape of an array with the unit."""
    text = short_text(value)
    if text.startswith("<"):
        return f"{text} {unit.text}".strip()
    number = float(value)
    return Amount(number, unit, 4 if float(f"{number:.4g}") == float(text) else 6)


def elementwise_maximum(x: Array, y: Array) -> Array:
    """Return the elementwise maximum of two values."""
    return max(x, y) if is_plain_number(x) and is_plain_number(y) else where(x > y, x, y)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Material(OneLine, ByValue):
    """Linear elastic, isotropic material.

    Parameters
    ----------
    young : float or array
        Young's modulus E in MPa, positive.
    poisson : float or array
        Poisson's ratio, above -1 and at most 0.5.
    name, source : str
        Name of the material, and source of its numbers.
    proportional_limit : float or array, optional
        Stress in MPa above which the secant modulus is lower than `young`. None (default) is an unknown limit.
    yield_stress, fatigue_limit, allowable_pressure : float or array, optional
        Strengths in MPa. None (default) is an unknown limit.
    hardening : Hardening, optional
        Yield stress over plastic strain, for models whose liner yields. None (default) is perfectly plastic.

    Raises
    ------
    ValueError
        A number that is not allowed; the message has its value.
    TypeError
        A value that is neither a number nor an array of numbers.

    Examples
    --------
    >>> Material(young=1000.0, poisson=0.4).poisson
    0.4
    """

    young: Array
    poisson: Array
    name: str = ""
    source: str = ""
    proportional_limit: Array | None = None
    yield_stress: Array | None = None
    fatigue_limit: Array | None = None
    allowable_pressure: Array | None = None
    hardening: Hardening | None = None

    def __post_init__(self) -> None:
        elastic = {name: quantity.check(getattr(self, name)) for name, quantity in MATERIAL.items()}
        limits = {name: STRESS_LIMITS[name].check(limit) for name, limit in self.stress_limits.items()}
        if not isinstance(self.hardening, Hardening | None):
            raise TypeError(f"hardening must be a Hardening, got {shown(self.hardening)}")
        vars(self).update(**elastic, **limits)

    @property
    def strengths(self) -> dict[str, Array]:
        """Known strengths in MPa, by name."""
        return {name: limit for name, limit in self.stress_limits.items() if name in STRENGTH}

    @property
    def stress_limits(self) -> dict[str, Array]:
        """Known strengths and proportional limit in MPa, by name."""
        limits = {name: getattr(self, name) for name in STRESS_LIMITS}
        return {name: limit for name, limit in limits.items() if limit is not None}

    @property
    def yield_curve(self) -> Hardening | None:
        """Hardening, or that of a perfectly plastic material at its yield stress; None if neither is one number."""
        stress: Any = self.yield_stress
        if self.hardening is not None or not is_plain_number(stress):
            return self.hardening
        return Hardening(stress=(float(stress),))

    def without_strengths(self) -> Material:
        """Return a copy of the material without strengths, proportional limit and hardening."""
        return make_unchecked(Material, **{**vars(self), **dict.fromkeys((*STRESS_LIMITS, "hardening"))})

    def with_numbers(self, young: Array, poisson: Array) -> Material:
        """Return a copy of the material with other elastic constants, without checks."""
        return make_unchecked(Material, **{**vars(self), "young": young, "poisson": poisson})

    def summary(self) -> dict[str, Any]:
        """Return the material as a dictionary for JSON, in MPa."""
        numbers = {"young": self.young, "poisson": self.poisson, **self.stress_limits}
        hardening = {} if self.hardening is None else {"hardening": self.hardening.summary()}
        return {"name": self.name, **{name: to_list(number) for name, number in numbers.items()}, **hardening}

    def _repr_html_(self) -> str:
        elastic = {name: getattr(self, name) for name in MATERIAL}
        rows = [
            (quantity.title, f"{short_text(value)} {quantity.unit}".removesuffix(" 1"))
            for name, value in {**elastic, **self.stress_limits}.items()
            for quantity in [{**MATERIAL, **STRESS_LIMITS}[name]]
        ]
        return html_list(self.name or "material", [*rows, *([("source", self.source)] if self.source else [])])

    def __str__(self) -> str:
        numbers = Sentence("E {}, nu {}", number_with_unit(self.young, MEGAPASCALS), number_with_unit(self.poisson))
        return Sentence("{} ({})", self.name, numbers) if self.name else numbers


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Layer(OneLine, ByValue):
    """Layer behind the liner: a metal shell, cement or bone.

    Parameters
    ----------
    thickness : float or array
        Thickness in mm, positive; `inf` is a massive body.
    material : Material

    Raises
    ------
    ValueError
        A thickness that is not allowed; the message has its value.
    TypeError
        A `material` of another type.

    Examples
    --------
    >>> import ballsocket as bs
    >>> print(Layer(thickness=3.0, material=bs.TITANIUM))
    3 mm of titanium (E 110000 MPa, nu 0.3)
    """

    thickness: Array
    material: Material

    def __post_init__(self) -> None:
        thickness = LAYER["thickness"].check(self.thickness)
        if not isinstance(self.material, Material):
            raise TypeError(f"material must be a Material, got {shown(self.material)}")
        vars(self).update(thickness=thickness)

    def without_strengths(self) -> Layer:
        """Return a copy of the layer whose material has no strengths."""
        return make_unchecked(Layer, thickness=self.thickness, material=self.material.without_strengths())

    def with_numbers(self, thickness: Array, young: Array, poisson: Array) -> Layer:
        """Return a copy of the layer with another thickness and elastic constants, without checks."""
        return make_unchecked(Layer, thickness=thickness, material=self.material.with_numbers(young, poisson))

    def summary(self) -> dict[str, Any]:
        """Return the layer as a dictionary for JSON, in mm and MPa."""
        return {"thickness": to_list(self.thickness), **self.material.summary()}

    def __str__(self) -> str:
        if short_text(self.thickness) == "inf":
            return Sentence("a massive body of {}", str(self.material))
        return Sentence("{} of {}", number_with_unit(self.thickness, MILLIMETRES), str(self.material))
