"""Radial foundation: a rigid ball on radial springs of the socket, as in the paper and in related models."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan

from ..contact.law import ForceLaw, finite_or_nan
from ..core.arrays import Array, cos, where
from ..core.checks import shown
from ..core.sources import Source
from ..core.validity import SMALL_STRAIN, Promise, Range, Remark
from ..problem import Joint
from .closed_form import ClosedForm
from .kinematics import Kinematics, angle_of, cosine_kinematics, exact_kinematics, linear_kinematics, versine_of
from .modulus import Modulus, as_modulus, bonded_layer, hess_forsbach, spherical_vessel


@dataclass(frozen=True, kw_only=True)
class RadialFoundation(ClosedForm):
    """Radial foundation: p = K u on the socket's surface, with u the radial displacement under a rigid ball.

    Parameters
    ----------
    modulus : Modulus or function
        Foundation modulus: `hess_forsbach` (default), `spherical_vessel`, `bonded_layer`, `polynomial(...)`,
        `constant(...)`, or a function that computes K in MPa/mm of a joint.
    kinematics : Kinematics
        Shape of the ball: `linear_kinematics` (Eq. 6, default), `exact_kinematics` (Eq. 5) or
        `cosine_kinematics` (Eq. 6 without clearance).

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (4)-(13). The closed form for exact kinematics, which the
    paper calls numerical, is derived in the docs (theory).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.RadialFoundation().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.06
    >>> def winkler(joint):
    ...     return 1.5 * joint.liner.young / joint.liner_thickness
    >>> round(bs.RadialFoundation(modulus=winkler).press(bs.joints["hip-28"], force=3000.0).max_pressure, 2)
    15.76
    """

    modulus: Modulus = hess_forsbach
    kinematics: Kinematics = linear_kinematics

    def __post_init__(self) -> None:
        object.__setattr__(self, "modulus", as_modulus(self.modulus))
        if not isinstance(self.kinematics, Kinematics):
            raise TypeError(
                f"kinematics must be a Kinematics, such as bs.linear_kinematics, got {shown(self.kinematics)}"
            )

    @property
    def name(self) -> str:
        """Name of the model: that of a published model, else the names of modulus and kinematics."""
        return _NAMES.get((self.modulus.name, self.kinematics.name), f"{self.modulus.name}-{self.kinematics.name}")

    @property
    def title(self) -> str:
        return f"radial springs, {self.kinematics.name} kinematics; {self.modulus.title}"

    @property
    def sources(self) -> tuple[Source, ...]:
        related = _RELATED_SOURCES.get((self.modulus.name, self.kinematics.name), ())
        return (*self.modulus.sources, *self.kinematics.sources, *related)

    @property
    def source(self) -> str:
        """Source of a custom modulus, as text; empty for a published one."""
        return self.modulus.source

    @property
    def domain(self) -> tuple[Range, ...]:
        return self.modulus.domain

    @property
    def validity(self) -> tuple[Range, ...]:
        return (*self.modulus.validity, *self.kinematics.validity, SMALL_STRAIN)

    @property
    def remarks(self) -> tuple[Remark, ...]:
        return self.kinematics.remarks

    @property
    def promise(self) -> Promise | None:
        return self.modulus.promise

    @property
    def parameters(self) -> tuple[Array, ...]:
        """Constants of the foundation modulus."""
        return self.modulus.constants

    def for_joint(self, joint: Joint) -> RadialFoundation:
        return replace(self, modulus=self.modulus.for_joint(joint))

    def force(self, joint: Joint, indentation: Array) -> Array:
        return self.kinematics.force(joint.socket_radius, joint.clearance, self.modulus.evaluate(joint), indentation)

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        return self.kinematics.stiffness(
            joint.socket_radius, joint.clearance, self.modulus.evaluate(joint), indentation
        )

    def energy(self, joint: Joint, indentation: Array) -> Array:
        return self.kinematics.energy(joint.socket_radius, joint.clearance, self.modulus.evaluate(joint), indentation)

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        return self.kinematics.pressure_integral(
            joint.socket_radius, joint.clearance, self.modulus.evaluate(joint), indentation
        )

    def indentation(self, joint: Joint, force: Array) -> Array:
        return self.kinematics.indentation(joint.socket_radius, joint.clearance, self.modulus.evaluate(joint), force)

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return angle_of(self.kinematics.versine(joint.socket_radius, joint.clearance, indentation))

    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        return self.kinematics.indentation_of_versine(joint.socket_radius, joint.clearance, versine_of(half_angle))

    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.modulus.evaluate(joint) * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        return self.modulus.evaluate(joint) + 0.0 * indentation

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        u = self.kinematics.displacement(joint.socket_radius, joint.clearance, indentation, versine_of(angle))
        inside = (u > 0) & (cos(angle) > 0)
        return where(inside, self.modulus.evaluate(joint) * u, 0.0)

    def _law(self, joint: Joint) -> ForceLaw:
        R2, c, K = joint.socket_radius, joint.clearance, float(self.modulus.evaluate(joint))
        return FoundationLaw(kinematics=self.kinematics, socket_radius=R2, clearance=c, modulus=K)


@dataclass(frozen=True, kw_only=True)
class FoundationLaw:
    """Force law of a radial foundation in one joint: lengths in mm, the modulus K in MPa/mm."""

    kinematics: Kinematics
    socket_radius: float
    clearance: float
    modulus: float

    def __call__(self, indentation: float) -> tuple[float, float]:
        if indentation < 0:
            return 0.0, 0.0
        R2, c, K, motion = self.socket_radius, self.clearance, self.modulus, self.kinematics
        try:
            return finite_or_nan(motion.force(R2, c, K, indentation), motion.stiffness(R2, c, K, indentation))
        except ArithmeticError:  # Python's numbers raise an error where NumPy's become infinite
            return nan, nan


_NAMES = {
    ("hess-forsbach", "linear"): "hess-forsbach",
    ("hess-forsbach", "cosine"): "cosine-limit",
    ("spherical-vessel", "linear"): "vessel",
    ("spherical-vessel", "exact"): "bartel",
    ("bonded-layer", "linear"): "bonded-layer",
    ("bonded-layer", "exact"): "bonded-layer-exact",
}


_RELATED_SOURCES = {
    ("spherical-vessel", "linear"): (Source("jin1994"),),
    ("bonded-layer", "exact"): (Source("askari2018"),),
}
"""Published models of the same physics, in addition to the sources of modulus and kinematics."""


def HessForsbach() -> RadialFoundation:  # noqa: N802 - named like a class, as the other models
    """Make the model of Heß & Forsbach 2021: linear kinematics and a modulus fitted to finite elements (Table 3).

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (6), (8), (13), (18).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.HessForsbach().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.06
    """
    return RadialFoundation()


def Vessel() -> RadialFoundation:  # noqa: N802
    """Make the model with the modulus of a spherical vessel and linear kinematics.

    It is the closed form of Heß & Forsbach for Bartel's integral. It equals the constrained radial columns with K_B of
    Jin, Dowson & Fisher 1994.

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (6), (8), (13), (14).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Vessel().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.68
    """
    return RadialFoundation(modulus=spherical_vessel)


def Bartel() -> RadialFoundation:  # noqa: N802
    """Make the closed-form model of Bartel et al. 1985: vessel modulus and exact kinematics.

    References
    ----------
    Bartel et al. 1985, doi 10.1115/1.3138540; the closed form is derived in the docs (theory).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Bartel().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.77
    """
    return RadialFoundation(modulus=spherical_vessel, kinematics=exact_kinematics)


def BondedLayer() -> RadialFoundation:  # noqa: N802
    """Make the model of a bonded layer (constrained column) with linear kinematics, as in the paper.

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (6), (8), (13), (15); Johnson 1985.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.BondedLayer().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    18.01
    """
    return RadialFoundation(modulus=bonded_layer)


def BondedLayerExact() -> RadialFoundation:  # noqa: N802
    """Make the model of a bonded layer (constrained column) with exact kinematics.

    It is the physics of Askari & Andersen 2018, whose text was not available.

    References
    ----------
    Askari & Andersen 2018, doi 10.1177/0954411918810044.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.BondedLayerExact().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    18.1
    """
    return RadialFoundation(modulus=bonded_layer, kinematics=exact_kinematics)


def CosineLimit() -> RadialFoundation:  # noqa: N802
    """Make the paper's model without clearance, with the pressure p = p0 cos φ over the full hemisphere.

    The force is F = (2π/3) K R2² d.

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (6) and (13) with c = 0.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.CosineLimit().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    7.2
    """
    return RadialFoundation(kinematics=cosine_kinematics)
