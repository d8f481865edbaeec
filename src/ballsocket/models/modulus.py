"""Foundation moduli (MPa/mm): stiffness of the springs of a radial foundation from geometry and material."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf
from typing import Any

import numpy

from ..core.arrays import Array, clip, sin
from ..core.checks import check_numeric, require, shown
from ..core.sources import Source
from ..core.validity import RIGID_BACKING, RIGID_BALL, Promise, Range, check_domain
from ..problem import Joint
from .table_3 import scaled_modulus, table_formula

Formula = Callable[..., Array]  # function that computes K from R2, L, E, ν and the constants of the modulus


@dataclass(frozen=True, kw_only=True)
class Modulus:
    """Foundation modulus K in MPa/mm as a function of the joint, with its source, domain and validity.

    Attributes
    ----------
    name, title : str
    formula : function
        K in MPa/mm of R2 and L (mm), E (MPa), ν and the constants.
    constants : tuple of float or array
        Constants of the formula.
    sources : tuple of Source
    promise : Promise or None
        Accuracy of the springs inside the validity.
    domain, validity : tuple of Range
        Ranges in which the formula exists (open), and in which it is accurate (closed).
    source : str
        Source of custom constants or of a custom formula, as text; `cite` includes it.

    Examples
    --------
    >>> import ballsocket as bs
    >>> hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE)
    >>> round(bs.hess_forsbach(hip), 2), round(bs.spherical_vessel(hip), 2), round(bs.bonded_layer(hip), 2)
    (276.67, 302.63, 317.46)
    """

    name: str
    title: str
    formula: Formula
    constants: tuple[Array, ...] = ()
    # not in the hash, by which each press finds the joint and the model in a cache
    sources: tuple[Source, ...] = field(default=(), hash=False)
    domain: tuple[Range, ...] = field(default=(), hash=False)
    validity: tuple[Range, ...] = field(default=(), hash=False)
    promise: Promise | None = field(default=None, hash=False)
    source: str = ""

    def __call__(self, joint: Joint) -> Array:
        """Compute the foundation modulus K of a joint in MPa/mm.

        Raises OutsideDomainError, a ValueError: no point of the joint lies in the domain of the formula.
        """
        check_domain(self.domain, joint, self.name)
        with numpy.errstate(all="ignore"):
            return self.evaluate(joint)

    def evaluate(self, joint: Joint) -> Array:
        """Compute the foundation modulus K of a joint in MPa/mm without checking the domain."""
        R2, L, E, nu = joint.socket_radius, joint.liner_thickness, joint.liner.young, joint.liner.poisson
        if type(R2) is float and type(L) is float and type(E) is float and type(nu) is float and not self.constants:
            return _scalar_modulus(self.formula, R2, L, E, nu)
        return self.formula(R2, L, E, nu, *self.constants)

    def for_joint(self, joint: Joint) -> Modulus:
        """Return the constant foundation modulus of a joint, computed once for all laws of a contact."""
        return Modulus(name=self.name, title=self.title, formula=constant_formula, constants=(self.evaluate(joint),))

    def __repr__(self) -> str:
        return self.name.replace("-", "_")


@dataclass(frozen=True, kw_only=True, repr=False)
class FunctionModulus(Modulus):
    """Foundation modulus K in MPa/mm from a custom function of a joint, `formula(joint)`."""

    def evaluate(self, joint: Joint) -> Array:
        """Compute the foundation modulus K of a joint in MPa/mm; a scalar function takes one joint at a time."""
        numbers = joint.numbers()
        try:
            value = check_numeric(f"modulus {self.name}", self.formula(joint))
        except (TypeError, ValueError):
            if not any(isinstance(number, numpy.ndarray) for number in numbers):
                raise
            rows = numpy.broadcast_arrays(*numbers)
            joints = (joint.with_numbers(map(float, row)) for row in zip(*(part.ravel() for part in rows), strict=True))
            value = numpy.array([float(self.formula(single)) for single in joints]).reshape(rows[0].shape)
        valid = (value > 0) & (value < inf)
        require(f"modulus {self.name}", value, valid, "a foundation modulus (MPa/mm) must be above 0 and finite")
        return value


def as_modulus(value: Any) -> Modulus:
    """Return a foundation modulus, also from a function that computes K in MPa/mm of a joint.

    Raises TypeError: another value.
    """
    if isinstance(value, Modulus):
        return value
    name = getattr(value, "__name__", "")
    if not callable(value) or isinstance(value, type) or getattr(value, "__module__", "") == __name__:
        hint = f"call it, such as bs.{name}(...)" if callable(value) else "for a number, use bs.constant(number)"
        raise TypeError(
            f"modulus must be a Modulus, such as bs.hess_forsbach, or a function of a joint that returns K in MPa/mm, "
            f"got {shown(value)}; {hint}"
        )
    summary = (getattr(value, "__doc__", None) or "").strip().partition("\n")[0]
    return FunctionModulus(
        name=name.strip("<>").replace("_", "-") or "custom",
        title=summary.rstrip(".") or f"custom modulus {name}".strip(),
        formula=value,
        validity=(RIGID_BALL, RIGID_BACKING),
        source=str(getattr(value, "source", "")),
    )


@lru_cache(maxsize=256)
def _scalar_modulus(formula: Formula, R2: float, L: float, E: float, nu: float) -> float:
    """Compute the foundation modulus K in MPa/mm from plain numbers, cached because all laws of a joint use it."""
    return float(formula(R2, L, E, nu))


def vessel_formula(R2: Array, L: Array, E: Array, nu: Array) -> Array:
    """Compute the foundation modulus K_B of a thick spherical vessel in MPa/mm."""
    # Eq. (14), K_B, with 1 - κ³ = (1 - κ)(1 + κ + κ²) and 1 - κ = L/(R2 + L)
    ratio = R2 / L
    kappa = ratio / (1 + ratio)
    gap = (1 + kappa * (1 + kappa)) / (1 + ratio)
    return E / R2 * (2 * (1 - 2 * nu) + (1 + nu) * kappa**3) / ((1 + nu) * (1 - 2 * nu) * gap)


def layer_formula(R2: Array, L: Array, E: Array, nu: Array) -> Array:
    """Compute the foundation modulus K_BL of a bonded layer (constrained column) in MPa/mm."""
    # Eq. (15), K_BL
    return (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * E / L


def polynomial_formula(R2: Array, L: Array, E: Array, nu: Array, c1: Array, c2: Array, c3: Array) -> Array:
    """Compute the foundation modulus K in MPa/mm from the polynomial of Eq. (18) in R2/L."""
    return E / R2 * scaled_modulus((c1, c2, c3), R2 / L)


def corrected_vessel_formula(R2: Array, L: Array, E: Array, nu: Array, a0: Array, a1: Array, a2: Array) -> Array:
    """Compute the foundation modulus of a vessel, corrected by a quadratic polynomial of κ = R2/(R2 + L), in MPa/mm."""
    ratio = R2 / L
    kappa = ratio / (1 + ratio)
    return vessel_formula(R2, L, E, nu) * (a0 + kappa * (a1 + kappa * a2))


def constant_formula(R2: Array, L: Array, E: Array, nu: Array, K: Array) -> Array:
    """Broadcast a constant foundation modulus in MPa/mm to the shape of the joint."""
    return K + 0.0 * R2


def _poisson_range(low: float, high: float, why: str) -> Range:
    return Range(quantity="joint.liner.poisson", low=low, high=high, why=why)


def _relative_contact_width(contact: Any) -> Array:
    return contact.width_ratio + sin(contact.half_angle)


def _relative_width_range(low: float) -> Range:
    """Make a validity range of the contact radius over the smaller of liner thickness and radius, rounded off."""
    why = "a contact narrower than the liner is thick feels a half-space, not springs"
    return Range(quantity=_relative_contact_width, symbol="a (1/L + 1/R2)", low=low, why=why)


_SPRINGS = Promise(within=0.15)
_COMPRESSIBLE = _poisson_range(-1.0, 0.5, "the modulus is unbounded for an incompressible liner (ν = 0.5)")
_FINITE_LAYER = Range(
    quantity="joint.liner_thickness", low=0.0, high=inf, why="a layer of infinite thickness has no stiffness"
)

spherical_vessel = Modulus(
    name="spherical-vessel",
    title="spherical vessel under uniform pressure, K_B",
    formula=vessel_formula,
    sources=(Source("bartel1985"), Source("hess2021", "(14)")),
    domain=(_COMPRESSIBLE,),
    validity=(
        _poisson_range(0.0, 0.4, "its pressure is 7 % high at 0.4, 20 % at 0.45 and without bound towards 0.5"),
        _relative_width_range(1.0),
        RIGID_BALL,
        RIGID_BACKING,
    ),
    promise=_SPRINGS,
)
"""K_B of Bartel et al. 1985: exact for uniform pressure all around, Eq. (14) of the paper."""

bonded_layer = Modulus(
    name="bonded-layer",
    title="thin compressible layer bonded to a rigid base, K_BL",
    formula=layer_formula,
    sources=(Source("johnson1985"), Source("hess2021", "(15)")),
    domain=(_COMPRESSIBLE, _FINITE_LAYER),
    validity=(
        _poisson_range(0.0, 0.4, "its pressure is 10 % high at 0.4, 30 % at 0.45 and without bound towards 0.5"),
        Range(
            quantity="joint.thickness_ratio",
            low=5.5,
            why="the layer is taken as flat, but a thick shell is larger outside than inside and stiffer",
        ),
        Range(quantity="width_ratio", low=1.5, why="the layer must be thin against the contact radius"),
        RIGID_BALL,
        RIGID_BACKING,
    ),
    promise=_SPRINGS,
)
"""K_BL of uniaxial compression between bonded faces, Eq. (15) of the paper."""


def polynomial(c1: Array, c2: Array, c3: Array, *, source: str = "") -> Modulus:
    """Make a foundation modulus from Eq. (18) of Heß & Forsbach 2021 with custom constants.

    The modulus is K R2/E = c1 + c2 (R2/L) + c3 (R2/L)².

    Parameters
    ----------
    c1, c2, c3 : float or array
        Dimensionless constants, zero or more; arrays broadcast against joint and load.
    source : str
        Source of the constants.

    Raises
    ------
    ValueError
        A constant that is negative, infinite or NaN; all of them zero.
    """
    constants = tuple(check_numeric(name, value) for name, value in (("c1", c1), ("c2", c2), ("c3", c3)))
    for name, value in zip(("c1", "c2", "c3"), constants, strict=True):
        require(name, value, (value >= 0) & (value < inf), "a constant of Eq. (18) must be 0 or more and finite")
    total = sum(constants)
    require("c1 + c2 + c3", total, total > 0, "at least one constant of Eq. (18) must be above 0")
    title = f"Eq. (18) with constants {c1}, {c2}, {c3}" + (f" ({source})" if source else "")
    sources = (Source("hess2021", "(18)"),)
    return Modulus(
        name="polynomial", title=title, formula=polynomial_formula, constants=constants, sources=sources, source=source
    )


def corrected_vessel(a0: Array, a1: Array, a2: Array, *, source: str = "") -> Modulus:
    """Make the foundation modulus of a vessel, corrected for non-uniform pressure by custom constants.

    The modulus is K_B (a0 + a1 κ + a2 κ²) with κ = R2/(R2 + L).

    The idea is Imado's (2005); the factor is custom, for instance fitted with `calibrate`.

    Parameters
    ----------
    a0, a1, a2 : float or array
        Dimensionless constants; arrays broadcast against joint and load.
    source : str
        Source of the constants.

    Raises
    ------
    ValueError
        A constant that is not finite; a factor that is not above 0 for all κ from 0 to 1.
    """
    constants = tuple(check_numeric(name, value) for name, value in (("a0", a0), ("a1", a1), ("a2", a2)))
    for name, value in zip(("a0", "a1", "a2"), constants, strict=True):
        require(name, value, abs(value) < inf, "a constant of the factor must be finite")
    for kappa in (i / 20 for i in range(21)):
        factor = constants[0] + kappa * (constants[1] + kappa * constants[2])
        require(f"factor at κ = {kappa:g}", factor, factor > 0, "the factor on K_B must be above 0")
    title = f"spherical vessel times {a0} + {a1} κ + {a2} κ²" + (f" ({source})" if source else "")
    return Modulus(
        name="corrected-vessel",
        title=title,
        formula=corrected_vessel_formula,
        constants=constants,
        sources=spherical_vessel.sources,
        domain=spherical_vessel.domain,
        validity=(RIGID_BALL, RIGID_BACKING),
        source=source,
    )


def constant(modulus: Array) -> Modulus:
    """Make a constant foundation modulus.

    Parameters
    ----------
    modulus : float or array
        K in MPa/mm, positive; an array broadcasts against joint and load.

    Raises
    ------
    ValueError
        A modulus that is not positive and finite.
    """
    value = check_numeric("modulus", modulus)
    require("modulus", value, (value > 0) & (value < inf), "a foundation modulus (MPa/mm) must be above 0 and finite")

    return Modulus(name="constant", title=f"{modulus} MPa/mm", formula=constant_formula, constants=(value,))


def _volume_constraint(contact: Any) -> Array:
    """Compute (ν - 0.43) a/L, a measure of the volume constraint in nearly incompressible liners, or 0."""
    excess = contact.joint.liner.poisson - 0.43
    return clip(excess, 0.0, inf) * contact.width_ratio


def _thin_volume_constraint(contact: Any) -> Array:
    """Compute (ν - 0.43) R2/L, a measure of the volume constraint in a narrow contact on a thin liner."""
    return (contact.joint.liner.poisson - 0.43) * contact.joint.thickness_ratio


hess_forsbach = Modulus(
    name="hess-forsbach",
    title="fitted to finite elements, Table 3",
    formula=table_formula,
    sources=(Source("hess2021", "(18), Table 3"),),
    validity=(
        _poisson_range(0.15, 0.47, "Table 3 has ν 0.30 to 0.49; its first column is measured down to 0.15"),
        Range(
            quantity="joint.thickness_ratio",
            low=0.2,
            high=7.7,
            why="Table 1 ends at R2/L 7.7; thicker liners are measured down to 0.2",
        ),
        _relative_width_range(1.0),
        Range(
            quantity=_thin_volume_constraint,
            symbol="(ν - 0.43) R2/L",
            high=0.07,
            why="a thin, nearly incompressible liner is stiffer than the springs of Table 3",
        ),
        Range(
            quantity=_volume_constraint,
            symbol="(ν - 0.43) a/L",
            high=0.04,
            why="the volume of a nearly incompressible liner stiffens a wide contact, which springs do not model",
        ),
        RIGID_BALL,
        RIGID_BACKING,
    ),
    promise=_SPRINGS,
)
"""The paper's fit (18), with monotone cubic interpolation in ν between the columns of Table 3."""
