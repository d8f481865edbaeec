"""The lengths of a joint from those that people state: radii or diameters, a radial or a diametral clearance."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from math import floor, log10
from types import MappingProxyType
from typing import TypedDict

from ..core.arrays import Array, is_plain
from ..core.checks import check_names, require
from ..core.quantities import FIT, JOINT

DIAMETERS = MappingProxyType(
    {"head_diameter": "ball_radius", "diametral_clearance": "clearance", "outer_diameter": "outer_radius"}
)
"""What is twice another length of a joint."""

LENGTHS = MappingProxyType({**JOINT, **FIT})
"""Every length that a joint can be stated by."""

_SAME = MappingProxyType({**DIAMETERS, "interference": "clearance"})
"""What says the same as another length."""

_TIGHTEST = 0.1
"""Of the ball's radius: an interference that is no larger."""

STORED_LENGTHS = ("ball_radius", "clearance", "liner_thickness")
"""What a joint holds; every other length follows."""

_ACROSS = ("ball_radius", "socket_radius", "clearance")
"""Any two of them fix the third."""


class Lengths(TypedDict, total=False):
    """What a joint is made of: two of radius, socket and clearance, and the liner's thickness or what it ends at."""

    ball_radius: Array
    head_diameter: Array
    socket_radius: Array
    clearance: Array
    diametral_clearance: Array
    interference: Array
    liner_thickness: Array
    outer_radius: Array
    outer_diameter: Array


class Dimensions:
    """The lengths that follow from those that a joint holds."""

    ball_radius: Array
    clearance: Array
    liner_thickness: Array

    @property
    @abstractmethod
    def shell(self) -> Array:
        """Thickness in mm of the layer right behind the liner; 0 where there is none, or where it is infinite."""

    @property
    def socket_radius(self) -> Array:
        """R2 = R1 + c in mm."""
        return self.ball_radius + self.clearance

    @property
    def outer_radius(self) -> Array:
        """Outer radius in mm of the liner, and of the shell where there is one behind it."""
        return self.socket_radius + self.liner_thickness + self.shell

    @property
    def head_diameter(self) -> Array:
        """2 R1 in mm."""
        return 2 * self.ball_radius

    @property
    def diametral_clearance(self) -> Array:
        """2 c in mm, what implant papers usually quote."""
        return 2 * self.clearance

    @property
    def interference(self) -> Array:
        """-c in mm, above 0 in a preloaded joint."""
        return -self.clearance

    @property
    def outer_diameter(self) -> Array:
        """Twice the outer radius in mm."""
        return 2 * self.outer_radius


def resolve_lengths(given: Mapping[str, Array], standing: Mapping[str, Array], shell: Array) -> dict[str, Array]:
    """Radius, clearance and thickness of a joint of given lengths; what is not given stands, if it can.

    Parameters
    ----------
    given : mapping of str to array
        Lengths in mm by their names in `Lengths`.
    standing : mapping of str to array
        Radius, clearance and thickness of a joint that there is; of a new one nothing.
    shell : array
        As of `Dimensions`.

    Raises
    ------
    ValueError
        A length that is not allowed, one too few, one too many.
    TypeError
        What is neither a number nor an array.
    """
    check_names(given, LENGTHS, "among the lengths of a joint")
    numbers = {name: LENGTHS[name].checked(value) for name, value in given.items()}
    check_unique_lengths(numbers)
    if not standing:
        _check_enough(numbers)
    made = derive_lengths(numbers, standing, shell)
    for name in ("outer_radius", "outer_diameter"):
        if name in numbers:
            require(name, numbers[name], made["liner_thickness"] > 0, "it leaves no liner between socket and backing")
    if "interference" in numbers:
        tight = numbers["interference"] <= _TIGHTEST * made["ball_radius"]
        require("interference", numbers["interference"], tight, "it is at most a tenth of the ball's radius")
    loose = not {"clearance", "diametral_clearance", "socket_radius"}.isdisjoint(numbers)
    return {
        name: JOINT[name].checked(made[name]) if name != "clearance" or loose else made[name] for name in STORED_LENGTHS
    }


def derive_lengths(given: Mapping[str, Array], standing: Mapping[str, Array], shell: Array) -> dict[str, Array]:
    """`made_of`, with nothing checked: a liner may be thinner than nothing.

    Two of radius, socket radius and clearance fix the third; of those that are not given the ball stands, and else the
    clearance. An outer radius takes the place of the liner's thickness.
    """
    radii = {DIAMETERS.get(name, name): value / 2 if name in DIAMETERS else value for name, value in given.items()}
    if "interference" in radii:
        radii["clearance"] = -radii.pop("interference")
    known = {**standing, **radii}
    if "socket_radius" in radii:
        if "clearance" in radii:
            known["ball_radius"] = _less(radii["socket_radius"], radii["clearance"])
        else:
            known["clearance"] = _less(radii["socket_radius"], known["ball_radius"])
    if "outer_radius" in radii:
        socket = radii.get("socket_radius", known["ball_radius"] + known["clearance"])
        known["liner_thickness"] = _less(radii["outer_radius"], socket + shell)
    return {name: known[name] for name in STORED_LENGTHS}


def check_unique_lengths(names: Iterable[str]) -> None:
    """Raise ValueError for lengths that say the same in two ways."""
    said = {_SAME.get(name, name): name for name in names}
    for name in names:
        if said[_SAME.get(name, name)] != name:
            other = said[_SAME.get(name, name)]
            raise ValueError(f"{name} and {other} are one too many: either fixes the other")
    across = [said[name] for name in _ACROSS if name in said]
    if len(across) == len(_ACROSS):
        raise ValueError(f"{', '.join(across[:2])} and {across[2]} are one too many: any two of them fix the third")
    if "outer_radius" in said and "liner_thickness" in said:
        raise ValueError(f"{said['outer_radius']} and liner_thickness are one too many: either fixes the other")


def _check_enough(names: Iterable[str]) -> None:
    said = {_SAME.get(name, name): name for name in names}
    if not ("liner_thickness" in said or "outer_radius" in said):
        raise ValueError("liner_thickness is missing, or outer_radius; liner_thickness = inf is a massive socket")
    across = [said[name] for name in _ACROSS if name in said]
    if len(across) < 2:
        got = across[0] if across else "none"
        raise ValueError(f"two of ball_radius, socket_radius, clearance are needed, got {got}")


def _less(larger: Array, smaller: Array) -> Array:
    """The difference; of Python numbers without the digits that are rounding alone, so that 18 - 17.9 is 0.1."""
    if not (is_plain(larger) and is_plain(smaller) and 0 < larger < float("inf")):
        return larger - smaller
    return round(larger - smaller, 14 - floor(log10(larger)))
