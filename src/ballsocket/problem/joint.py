"""The problem itself: a ball in a lined socket."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import Enum
from functools import reduce
from itertools import chain
from math import inf
from typing import Any, Unpack

from ..core.arrays import Array, is_plain, to_list, where
from ..core.checks import check_names, require, shown
from .dimensions import LENGTHS, STORED_LENGTHS, Dimensions, Lengths, resolve_lengths
from .material import Layer, Material
from .values import larger, make_unchecked, set_fields, short_text


class Support(Enum):
    """What holds the outermost surface of a socket: nothing moves it (FIXED), or nothing touches it (FREE)."""

    FIXED = "fixed"
    FREE = "free"


@dataclass(frozen=True, kw_only=True, init=False)
class Joint(Dimensions):
    """A ball in a socket of nearly its own radius, lined with an elastic layer.

    What is behind the liner is rigid, unless `backing` or `support` say otherwise. Models that take it as rigid all
    the same say so in their validity.

    Every number may be an array; arrays broadcast against each other and against the loads.

    Parameters
    ----------
    ball_radius : float or array
        R1 in mm, positive.
    clearance : float or array
        Radial clearance c = R2 - R1 in mm, zero or more.
    liner_thickness : float or array
        L in mm, positive; `inf` is a massive socket.
    head_diameter, diametral_clearance, socket_radius, outer_radius, outer_diameter : float or array
        In mm, in place of the radius, the clearance or the thickness that they fix: 2 R1; 2 c; R2, where one of R1 and
        c is given; R2 + L, with the layer right behind the liner (the shell) if that is of finite thickness; twice
        that. What is fixed twice is refused.
    liner : Material
        What the socket is lined with.
    ball : Material or None
        None is a rigid ball. Models that take the ball as rigid say so in their validity.
    backing : tuple of Layer
        The layers behind the liner, from the liner outwards, bonded to it and to each other. Only the outermost layer
        of all may be infinite.
    support : Support
        The outermost surface, of the liner if there is no backing: FIXED (default) or FREE of traction. That of an
        infinite layer is at rest either way.
    name, source : str
        What it is called, and where the numbers come from.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value; a length too few or too many.
    TypeError
        What is neither a number nor an array; a liner, ball, backing or support of another type.

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

    def __init__(
        self,
        *,
        liner: Material,
        ball: Material | None = None,
        backing: Sequence[Layer] = (),
        support: Support = Support.FIXED,
        name: str = "",
        source: str = "",
        **lengths: Unpack[Lengths],
    ) -> None:
        if not isinstance(liner, Material):
            raise TypeError(f"liner must be a Material, got {shown(liner)}")
        if not (ball is None or isinstance(ball, Material)):
            raise TypeError(f"ball must be a Material, or None for a rigid ball, got {shown(ball)}")
        if not isinstance(support, Support):
            raise TypeError(f"support must be Support.FIXED or Support.FREE, got {shown(support)}")
        layers = _checked_backing(backing)
        set_fields(self, **resolve_lengths(lengths, {}, _shell(layers)))
        set_fields(self, liner=liner, ball=ball, backing=layers, support=support, name=name, source=source)
        for name, inner in self._thicknesses()[:-1]:
            require(name, inner, inner < inf, "only the outermost layer may be infinite, and there is one behind this")

    def _thicknesses(self) -> list[tuple[str, Array]]:
        """Thicknesses of the liner and the layers behind it, with their names."""
        layers = [(f"backing[{number}].thickness", layer.thickness) for number, layer in enumerate(self.backing)]
        return [("liner_thickness", self.liner_thickness), *layers]

    @property
    def shell(self) -> Array:
        return _shell(self.backing)

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
        """Young's modulus of the liner over that of the ball; 0 for a rigid ball."""
        return 0.0 * self.liner.young if self.ball is None else self.liner.young / self.ball.young

    @property
    def backing_ratio(self) -> Array:
        """Young's modulus of the liner over that of the softest layer behind it.

        0 for a rigid backing: none at all, on a fixed support. `inf` where the outermost surface is free.
        """
        rigid = 0.0 * self.liner.young
        softest = reduce(larger, (self.liner.young / layer.material.young for layer in self.backing), rigid)
        if self.support is Support.FIXED:
            return softest
        _, outermost = self._thicknesses()[-1]
        if is_plain(outermost):
            return softest if outermost == inf else inf + softest
        return where(outermost < inf, inf, softest)

    @property
    def effective_modulus(self) -> Array:
        """E* in MPa of ball and liner, from 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2."""
        compliance = (1 - self.liner.poisson**2) / self.liner.young
        if self.ball is not None:
            compliance = compliance + (1 - self.ball.poisson**2) / self.ball.young
        return 1 / compliance

    def numbers(self) -> tuple[Array, ...]:
        """Every number of the joint, in a fixed order (see `with_numbers`)."""
        ball = () if self.ball is None else (self.ball.young, self.ball.poisson)
        own = (self.ball_radius, self.clearance, self.liner_thickness)
        behind = ((layer.thickness, layer.material.young, layer.material.poisson) for layer in self.backing)
        return (*own, self.liner.young, self.liner.poisson, *ball, *chain.from_iterable(behind))

    def strengths(self) -> tuple[Array, ...]:
        """Return the known strengths and proportional limits of liner and ball."""
        ball = () if self.ball is None else self.ball.stress_limits.values()
        return (*self.liner.stress_limits.values(), *ball)

    def without_strengths(self) -> Joint:
        """This joint of materials whose strengths are not known; no solution depends on them."""
        parts: dict[str, Any] = {
            "liner": self.liner.without_strengths(),
            "ball": None if self.ball is None else self.ball.without_strengths(),
            "backing": tuple(layer.without_strengths() for layer in self.backing),
        }
        return make_unchecked(Joint, **{**vars(self), **parts})

    def with_numbers(self, numbers: Any) -> Joint:
        """A joint like this one with other numbers, in the order of `numbers()`. Nothing is checked."""
        radius, clearance, thickness, young, poisson, *others = numbers
        behind = others if self.ball is None else others[2:]
        triples = zip(self.backing, behind[::3], behind[1::3], behind[2::3], strict=True)
        return make_unchecked(
            Joint,
            ball_radius=radius,
            clearance=clearance,
            liner_thickness=thickness,
            liner=self.liner.with_numbers(young, poisson),
            ball=self.ball.with_numbers(*others[:2]) if self.ball is not None else None,
            backing=tuple(layer.with_numbers(*three) for layer, *three in triples),
            support=self.support,
            name=self.name,
            source=self.source,
        )

    def replace(self, **changes: Any) -> Joint:
        """A joint like this one with other lengths, materials, layers or another name.

        Of radius, clearance and thickness stays what the changes do not fix: with another head the clearance and the
        liner's thickness are the same. A joint with a name is called "varied" afterwards.

        Parameters
        ----------
        **changes
            As of `Joint`.

        Raises
        ------
        ValueError
            A name that is not known; a number that is not allowed.
        TypeError
            As of `Joint`.

        Examples
        --------
        >>> import ballsocket as bs
        >>> print(bs.joints["hip-36"].replace(liner=bs.UHMWPE, head_diameter=32.0).dimensions)
        R1 16 mm, clearance 0.1 mm, liner 5 mm
        """
        known = [each.name for each in fields(self) if each.name not in STORED_LENGTHS]
        check_names(changes, (*LENGTHS, *known), "in a joint")
        lengths = {name: value for name, value in changes.items() if name in LENGTHS}
        others = {name: value for name, value in changes.items() if name not in LENGTHS}
        standing = {name: getattr(self, name) for name in STORED_LENGTHS}
        made = resolve_lengths(lengths, standing, _shell(_checked_backing(others.get("backing", self.backing))))
        if is_plain(made["clearance"]) and made["clearance"] < 0:
            made["interference"] = -made.pop("clearance")
        called = {"name": f"{self.name.removesuffix(_VARIED)}{_VARIED}", "source": ""} if changes and self.name else {}
        kept: dict[str, Any] = {name: getattr(self, name) for name in known}
        return Joint(**kept | called | others, **made)

    def with_floats(self) -> Joint:
        """This joint of Python numbers with all of them floats."""
        numbers = self.numbers()
        return self if all(type(number) is float for number in numbers) else self.with_numbers(map(float, numbers))

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON in mm and MPa; arrays become lists, and what is infinite the text "inf"."""
        lengths = ("ball_radius", "socket_radius", "clearance", "liner_thickness")
        return {
            "name": self.name,
            **{name: to_list(getattr(self, name)) for name in lengths},
            "liner": self.liner.summary(),
            "ball": None if self.ball is None else self.ball.summary(),
            "backing": [layer.summary() for layer in self.backing],
            "support": self.support.value,
        }

    @property
    def dimensions(self) -> str:
        """Ball, clearance and what lines the socket, in words."""
        lined = _thickness(self.liner_thickness)
        return f"R1 {short_text(self.ball_radius)} mm, clearance {short_text(self.clearance)} mm, {lined}"

    def __str__(self) -> str:
        ball = "rigid" if self.ball is None else str(self.ball)
        head = f"{self.name}: " if self.name else ""
        behind = "".join(f" on {layer}" for layer in self.backing)
        free = ", free outside" if self.support is Support.FREE else ""
        return f"{head}{self.dimensions} of {self.liner}{behind}{free}; ball {ball}"


_VARIED = ", varied"


def _shell(backing: Sequence[Layer]) -> Array:
    """Thickness of the layer right behind the liner; 0 of none, and of an infinite one."""
    if not backing:
        return 0.0
    thickness = backing[0].thickness
    if is_plain(thickness):
        return thickness if thickness < inf else 0.0
    return where(thickness < inf, thickness, 0.0)


def _checked_backing(backing: Any) -> tuple[Layer, ...]:
    if not isinstance(backing, list | tuple):
        raise TypeError(f"backing must be a tuple of Layers from the liner outwards, got {shown(backing)}")
    for number, layer in enumerate(backing):
        if not isinstance(layer, Layer):
            raise TypeError(f"backing[{number}] must be a Layer, got {shown(layer)}")
    return tuple(backing)


def _thickness(value: Array) -> str:
    text = short_text(value)
    return "massive socket" if text == "inf" else f"liner {text} mm"
