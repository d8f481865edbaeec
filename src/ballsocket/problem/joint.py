"""Joint: a ball in a lined socket."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from itertools import chain
from math import inf
from typing import Any, Unpack

from ..core.arrays import Array, all_true, is_plain_number, read_only, to_list, where
from ..core.checks import check_names, require, shown
from ..core.display import OneLine, html_list
from ..core.kinds import MILLIMETRES, Choice
from ..core.quantities import JOINT
from ..core.unit_systems import Sentence
from .dimensions import LENGTHS, STORED_LENGTHS, Lengths, canonical, check_given, lost_lengths, resolve_lengths
from .material import (
    ByValue,
    Layer,
    Material,
    elementwise_maximum,
    make_unchecked,
    number_with_unit,
    short_text,
)


class Support(Choice):
    """Boundary condition of the outermost surface of a socket.

    FIXED: no displacement. FREE: no traction.
    """

    FIXED = "fixed"
    FREE = "free"


@dataclass(frozen=True, kw_only=True, init=False, repr=False, eq=False)
class Joint(OneLine, ByValue):
    """Ball in a socket of nearly equal radius, lined with an elastic layer.

    The support of the liner is rigid unless `backing` or `support` define it. The validity of a model states if it
    assumes a rigid support.

    Every number may be an array. Arrays broadcast against each other and against the loads.

    Parameters
    ----------
    ball_radius : float or array
        R1 in mm, positive.
    clearance : float or array
        Radial clearance c = R2 - R1 in mm, zero or more.
    liner_thickness : float or array
        L in mm, positive; `inf` is a massive socket.
    head_diameter, diametral_clearance, socket_radius, outer_radius, outer_diameter : float or array
        Lengths in mm in place of radius, clearance or thickness: 2 R1; 2 c; R2 with one of R1 and c; R2 + L, plus the
        shell, that is, a layer of finite thickness right behind the liner; twice that. Redundant lengths are an error.
    liner : Material
        Material of the liner.
    ball : Material or None
        Material of the ball; None is a rigid ball. The validity of a model states if it assumes a rigid ball.
    backing : tuple of Layer
        Layers behind the liner, from the liner outwards, bonded to it and to each other. Only the outermost layer may
        be infinite.
    support : Support
        Boundary condition of the outermost surface: FIXED (default) or FREE. An infinite layer has no displacement at
        infinity in both cases.
    name, source : str
        Name of the joint, and source of its numbers.
    given : tuple of str
        Names of the three lengths that determine the joint, those of the call by default. `replace` keeps them.

    Raises
    ------
    ValueError
        A number that is not allowed; too few or too many lengths.
    TypeError
        A length that is neither a number nor an array; a liner, ball, backing or support of another type.

    Examples
    --------
    >>> import ballsocket as bs
    >>> hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    >>> hip.socket_radius
    18.0
    >>> same = bs.Joint(head_diameter=35.8, diametral_clearance=0.2, outer_diameter=49.5, liner=bs.UHMWPE)
    >>> same.liner_thickness
    6.75
    """

    ball_radius: Array
    clearance: Array
    liner_thickness: Array
    liner: Material
    ball: Material | None = None
    backing: tuple[Layer, ...] = ()
    support: Support = Support.FIXED
    name: str = ""
    source: str = ""
    given: tuple[str, ...] = field(default=(), compare=False)

    def __init__(
        self,
        *,
        liner: Material,
        ball: Material | None = None,
        backing: Sequence[Layer] = (),
        support: Support = Support.FIXED,
        name: str = "",
        source: str = "",
        given: tuple[str, ...] = (),
        **lengths: Unpack[Lengths],
    ) -> None:
        """Check the parts, and derive radius, clearance and thickness from the lengths."""
        self._define(lengths, {}, liner=liner, ball=ball, backing=backing, support=support, name=name, source=source)
        if given:
            vars(self).update(given=check_given(given))

    def _define(
        self,
        lengths: Mapping[str, Array],
        old_lengths: Mapping[str, Array],
        *,
        liner: Any,
        ball: Any,
        backing: Any,
        support: Any,
        **texts: str,
    ) -> None:
        """Set all fields: checked parts, and lengths that follow from new and old ones, see `resolve_lengths`."""
        if not isinstance(liner, Material):
            raise TypeError(f"liner must be a Material, got {shown(liner)}")
        if not (ball is None or isinstance(ball, Material)):
            raise TypeError(f"ball must be a Material, or None for a rigid ball, got {shown(ball)}")
        if not isinstance(support, Support):
            raise TypeError(f"support must be Support.FIXED or Support.FREE, got {shown(support)}")
        layers = _check_backing(backing)
        stored = resolve_lengths(lengths, old_lengths, _shell_thickness(layers))
        vars(self).update(**stored, liner=liner, ball=ball, backing=layers, support=support, **texts)
        allowed = "only the outermost layer may be infinite, and there is one behind this"
        inner, thickness = "liner_thickness", self.liner_thickness
        for number, layer in enumerate(layers):
            require(inner, thickness, thickness < inf, allowed)
            inner, thickness = f"backing[{number}].thickness", layer.thickness

    @property
    def shell(self) -> Array:
        """Thickness in mm of the finite layer directly behind the liner; 0 if there is none."""
        return _shell_thickness(self.backing)

    @property
    def socket_radius(self) -> Array:
        """Socket radius R2 = R1 + c in mm."""
        return self.ball_radius + self.clearance

    @property
    def outer_radius(self) -> Array:
        """Outer radius in mm of the liner, or of the shell if there is one."""
        return self.socket_radius + self.liner_thickness + self.shell

    @property
    def head_diameter(self) -> Array:
        """Diameter 2 R1 of the ball in mm."""
        return 2 * self.ball_radius

    @property
    def diametral_clearance(self) -> Array:
        """Diametral clearance 2 c in mm, difference of the diameters."""
        return 2 * self.clearance

    @property
    def interference(self) -> Array:
        """Interference -c in mm, positive in a preloaded joint."""
        return -self.clearance

    @property
    def fit(self) -> tuple[str, Array]:
        """Name and positive radial value in mm of the fit: "clearance", or "interference" of a preloaded joint."""
        preloaded = all_true(self.clearance < 0)
        return ("interference", self.interference) if preloaded else ("clearance", self.clearance)

    @property
    def outer_diameter(self) -> Array:
        """Outer diameter in mm, twice the outer radius."""
        return 2 * self.outer_radius

    @property
    def thickness_ratio(self) -> Array:
        """Socket radius over liner thickness, R2/L."""
        return self.socket_radius / self.liner_thickness

    @property
    def clearance_ratio(self) -> Array:
        """Radial clearance over socket radius, c/R2."""
        return self.clearance / self.socket_radius

    @property
    def modulus_ratio(self) -> Array:
        """Ratio of Young's moduli of liner and ball, E/E1; 0 for a rigid ball."""
        return 0.0 * self.liner.young if self.ball is None else self.liner.young / self.ball.young

    @property
    def backing_ratio(self) -> Array:
        """Ratio of Young's moduli of the liner and of the softest layer behind it.

        It is 0 for a fixed support without backing, and `inf` for a free outermost surface.
        """
        rigid = 0.0 * self.liner.young
        softest = reduce(
            elementwise_maximum, (self.liner.young / layer.material.young for layer in self.backing), rigid
        )
        if self.support is Support.FIXED:
            return softest
        outermost = self.backing[-1].thickness if self.backing else self.liner_thickness
        if is_plain_number(outermost):
            return softest if outermost == inf else inf + softest
        return where(outermost < inf, inf, softest)

    @property
    def effective_modulus(self) -> Array:
        """Effective modulus E* in MPa of ball and liner, from 1/E* = (1 - ν1²)/E1 + (1 - ν²)/E."""
        compliance = (1 - self.liner.poisson**2) / self.liner.young
        if self.ball is not None:
            compliance = compliance + (1 - self.ball.poisson**2) / self.ball.young
        return 1 / compliance

    @property
    def given_lengths(self) -> dict[str, Array]:
        """Lengths in mm that the joint was made from, by their names; arrays are read-only."""
        return {name: read_only(getattr(self, name)) for name in self.given or STORED_LENGTHS}

    def numbers(self) -> tuple[Array, ...]:
        """List all lengths and elastic constants of the joint, in a fixed order.

        `with_numbers` has the same order.
        """
        ball = () if self.ball is None else (self.ball.young, self.ball.poisson)
        lengths = (self.ball_radius, self.clearance, self.liner_thickness)
        layers = ((layer.thickness, layer.material.young, layer.material.poisson) for layer in self.backing)
        return (*lengths, self.liner.young, self.liner.poisson, *ball, *chain.from_iterable(layers))

    def strengths(self) -> tuple[Array, ...]:
        """List the known strengths and proportional limits of liner and ball in MPa."""
        ball = () if self.ball is None else self.ball.stress_limits.values()
        return (*self.liner.stress_limits.values(), *ball)

    def without_strengths(self) -> Joint:
        """Return a copy of the joint without strengths, on which no elastic solution depends."""
        parts: dict[str, Any] = {
            "liner": self.liner.without_strengths(),
            "ball": None if self.ball is None else self.ball.without_strengths(),
            "backing": tuple(layer.without_strengths() for layer in self.backing),
        }
        return make_unchecked(Joint, **{**vars(self), **parts})

    def with_numbers(self, numbers: Any) -> Joint:
        """Return a copy of the joint with new lengths and elastic constants, in the order of `numbers()`.

        Nothing is checked.
        """
        radius, clearance, thickness, young, poisson, *remaining = numbers
        behind = remaining if self.ball is None else remaining[2:]
        layers = zip(self.backing, behind[::3], behind[1::3], behind[2::3], strict=True)
        parts: dict[str, Any] = {
            "ball_radius": radius,
            "clearance": clearance,
            "liner_thickness": thickness,
            "liner": self.liner.with_numbers(young, poisson),
            "ball": self.ball.with_numbers(*remaining[:2]) if self.ball is not None else None,
            "backing": tuple(layer.with_numbers(*layer_numbers) for layer, *layer_numbers in layers),
        }
        return make_unchecked(Joint, **{**vars(self), **parts})

    def replace(self, **changes: Any) -> Joint:
        """Return a copy of the joint with other lengths, materials, layers or another name.

        The joint keeps the lengths that it was made from, `given`. Another head diameter keeps the clearance, and the
        thickness of the liner or the outer diameter, whichever was given. A change that breaks a given length needs
        the lengths that stay beside it. The name of a changed joint ends in ", varied", with the given lengths that
        follow from others.

        Parameters
        ----------
        **changes
            Arguments of `Joint`.

        Raises
        ------
        ValueError
            An unknown argument; a number that is not allowed.
        TypeError
            A value of the wrong type, see `Joint`.

        Examples
        --------
        >>> import ballsocket as bs
        >>> print(bs.joints["hip-36"].replace(liner=bs.UHMWPE, head_diameter=32.0).dimensions)
        R1 16 mm, clearance 0.1 mm, liner 5 mm
        """
        check_names(changes, (*LENGTHS, *_PARTS), "in a joint")
        lengths = {name: value for name, value in changes.items() if name in LENGTHS}
        parts: dict[str, Any] = {name: getattr(self, name) for name in _PARTS}
        base = self.name.split(_VARIED)[0]
        if changes and self.name:
            parts |= {"name": f"{base}{_VARIED}", "source": ""}
        parts |= {name: value for name, value in changes.items() if name not in LENGTHS}
        old_lengths, shell = self.given_lengths, _shell_thickness(_check_backing(parts["backing"]))
        keeps_lengths = not lengths and len(old_lengths) > 3 and all_true(shell == self.shell)
        if keeps_lengths:  # three lengths are enough, the outer one gave the shell
            old_lengths = {name: old for name, old in old_lengths.items() if canonical(name) != "outer_radius"}
        joint: Joint = object.__new__(Joint)
        joint._define(lengths, old_lengths, **parts)
        if keeps_lengths:
            vars(joint).update(given=self.given)
        lost = lost_lengths(joint.given, self.given)
        changed = [(name, getattr(self, name), getattr(joint, name)) for name in lost]
        words = [
            f"{LENGTHS[name].title} {new:.6g} mm in place of {old:.6g} mm"
            for name, old, new in changed
            if is_plain_number(old) and is_plain_number(new) and abs(new - old) > 1e-9 * abs(old)
        ]
        if words and "name" not in changes:
            vars(joint).update(name=f"{base}{_VARIED}: {', '.join(words)}".removeprefix(", "))
        return joint

    def with_floats(self) -> Joint:
        """Return a copy of the joint with floats in place of integers; its numbers must be plain."""
        numbers = self.numbers()
        return self if {*map(type, numbers)} == {float} else self.with_numbers(map(float, numbers))

    def summary(self) -> dict[str, Any]:
        """Return the joint as a dictionary for JSON, in mm and MPa.

        Arrays become lists, and infinity the text "inf".
        """
        lengths = ("ball_radius", "socket_radius", "clearance", "liner_thickness")
        return {
            "name": self.name,
            **{name: to_list(getattr(self, name)) for name in lengths},
            "given": list(self.given_lengths),
            "liner": self.liner.summary(),
            "ball": None if self.ball is None else self.ball.summary(),
            "backing": [layer.summary() for layer in self.backing],
            "support": self.support.value,
        }

    @property
    def dimensions(self) -> Sentence:
        """Text of ball radius, clearance or interference, and liner thickness, with units."""
        name, fit = self.fit
        return self._lengths_text(f"R1 {{}}, {name} {{}}", self.ball_radius, fit)

    @property
    def diameters(self) -> Sentence:
        """Text of head diameter, diametral clearance or interference, and liner thickness, with units."""
        name, fit = self.fit
        return self._lengths_text(f"head ⌀ {{}}, {name} ⌀ {{}}", self.head_diameter, 2 * fit)

    def _lengths_text(self, form: str, *lengths: Array) -> Sentence:
        massive = short_text(self.liner_thickness) == "inf"
        lengths = lengths if massive else (*lengths, self.liner_thickness)
        liner = "massive socket" if massive else "liner {}"
        return Sentence(f"{form}, {liner}", *(number_with_unit(size, MILLIMETRES) for size in lengths))

    def _repr_html_(self) -> str:
        lengths = ("ball_radius", "socket_radius", self.fit[0], "liner_thickness")
        rows = [(JOINT[name].title, f"{short_text(getattr(self, name))} mm") for name in lengths]
        rows += [("liner", str(self.liner)), ("ball", "rigid" if self.ball is None else str(self.ball))]
        rows += [(f"layer {number} behind the liner", str(layer)) for number, layer in enumerate(self.backing, start=1)]
        rows += [("outermost surface", self.support.value)] if self.backing else []
        return html_list(self.name or "joint", [*rows, *([("source", self.source)] if self.source else [])])

    def __str__(self) -> str:
        layers = [part for layer in self.backing for part in (" on ", str(layer))]
        free = ", free outside" if self.support is Support.FREE else ""
        outside = [
            Sentence(f", {JOINT[name].title} {{}}", number_with_unit(getattr(self, name), MILLIMETRES))
            for name in ("outer_radius", "outer_diameter")
            if name in self.given
        ]
        ball = "rigid" if self.ball is None else str(self.ball)
        head = f"{self.name}: " if self.name else ""
        parts = [head, self.dimensions, " of ", str(self.liner), *layers, free, *outside, "; ball ", ball]
        return Sentence("{}" * len(parts), *parts)


_PARTS = ("liner", "ball", "backing", "support", "name", "source")  # fields of a joint beside its lengths

_VARIED = ", varied"  # end of the name of a changed joint


def _shell_thickness(backing: Sequence[Layer]) -> Array:
    """Return the thickness in mm of the layer next to the liner; 0 without layers, or if it is infinite."""
    if not backing:
        return 0.0
    thickness = backing[0].thickness
    if is_plain_number(thickness):
        return thickness if thickness < inf else 0.0
    return where(thickness < inf, thickness, 0.0)


def _check_backing(backing: Any) -> tuple[Layer, ...]:
    """Check that the backing is a list of layers, and return it as a tuple; raise TypeError otherwise."""
    if not isinstance(backing, list | tuple):
        raise TypeError(f"backing must be a tuple of Layers from the liner outwards, got {shown(backing)}")
    for number, layer in enumerate(backing):
        if not isinstance(layer, Layer):
            raise TypeError(f"backing[{number}] must be a Layer, got {shown(layer)}")
    return tuple(backing)
