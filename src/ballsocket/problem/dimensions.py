"""Lengths of a joint, derived from radii or diameters and from a radial or diametral clearance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from math import floor, log10
from types import MappingProxyType
from typing import Any, TypedDict

from ..core.arrays import Array, is_plain_number
from ..core.checks import check_names, require, shown
from ..core.quantities import FIT, JOINT

DIAMETERS = MappingProxyType(
    {"head_diameter": "ball_radius", "diametral_clearance": "clearance", "outer_diameter": "outer_radius"}
)
"""Stored length whose double each of these lengths is."""

_CANONICAL = {**DIAMETERS, "interference": "clearance"}

LENGTHS = MappingProxyType({**JOINT, **FIT})
"""All lengths that can define a joint."""

_ROUNDING = 1e-9  # relative difference of two lengths below which they agree

STORED_LENGTHS = ("ball_radius", "clearance", "liner_thickness")
"""Lengths that a joint stores; the others are derived."""

_RADIAL_LENGTHS = ("ball_radius", "socket_radius", "clearance")  # lengths of which any two determine the third

_WALLS = ("liner_thickness", "outer_radius")  # lengths of which one determines the wall behind a socket

_BASES = (
    *(frozenset({*pair, wall}) for pair in combinations(_RADIAL_LENGTHS, 2) for wall in _WALLS),
    frozenset({"clearance", "liner_thickness", "outer_radius"}),
)
"""Lengths that determine a joint: two radial ones and one of the wall, or both of the wall and the clearance."""

_STAYING_ORDER = ("ball_radius", "clearance", "socket_radius", *_WALLS)
"""Lengths without diameters and interference, in the order in which they stay where another one is given."""


def canonical(name: str) -> str:
    """Return the radial length of a diameter, the clearance for an interference, and any other name itself."""
    return _CANONICAL.get(name, name)


class Lengths(TypedDict, total=False):
    """Keyword arguments for the lengths of a joint in mm.

    Two of radius, socket and clearance are needed, and the thickness or the outer radius.
    """

    ball_radius: Array
    head_diameter: Array
    socket_radius: Array
    clearance: Array
    diametral_clearance: Array
    interference: Array
    liner_thickness: Array
    outer_radius: Array
    outer_diameter: Array


def resolve_lengths(lengths: Mapping[str, Array], given: Mapping[str, Array], shell: Array) -> dict[str, Any]:
    """Check new lengths, and derive the `STORED_LENGTHS` of a joint in mm; `given` has the names that determine them.

    The given lengths, those that an existing joint was made from, stay as far as the new ones allow; a new joint has
    none. `shell` is the thickness in mm of the finite layer right behind the liner, 0 without one.

    Raises ValueError: a length that is not allowed; too few or too many lengths; a given length that would change
    although nothing says which one.
    Raises TypeError: a length that is neither a number nor an array.
    """
    check_names(lengths, LENGTHS, "among the lengths of a joint")
    numbers = {name: LENGTHS[name].check(value) for name, value in lengths.items()}
    try:
        check_unique_lengths(numbers)
    except ValueError as error:
        raise ValueError(f"{error}{_contradiction(numbers, given, shell)}") from None
    if given:
        held = held_lengths(numbers, given)
    else:
        held = {}
        _check_sufficient_lengths(numbers)
    stored = derive_lengths({**held, **numbers}, shell)
    outer = next((name for name in (*numbers, *held) if canonical(name) == "outer_radius"), None)
    if outer is not None:
        _check_liner_fits(outer, {**held, **numbers}, stored["liner_thickness"], tuple(numbers))
    c, names = stored["clearance"], (*held, *numbers)
    derived = {name: length for name, length in stored.items() if name not in numbers}
    may_preload = not any(name in numbers for name in ("clearance", "diametral_clearance", "socket_radius"))
    if may_preload and ("interference" in names or is_plain_number(c)):
        require("interference", -c, -c <= 0.1 * stored["ball_radius"], "it is at most a tenth of the ball's radius")
        del derived["clearance"]
    return {**stored, **{name: JOINT[name].check(length) for name, length in derived.items()}, "given": names}


def _check_liner_fits(outer: str, lengths: Mapping[str, Array], thickness: Array, changed: Sequence[str]) -> None:
    """Check that the outer dimension leaves a liner; the message has the new length, with the room that there is."""
    inner = next((name for name in changed if canonical(name) in _RADIAL_LENGTHS), outer)
    name, other = (outer, inner) if outer in changed else (inner, outer)
    allowed = "it must leave a liner between socket and backing"
    if name != other and is_plain_number(lengths[other]) and is_plain_number(thickness):
        factor = (2 if name in DIAMETERS else 1) * (1 if name == outer else -1)
        limit = lengths[name] - factor * thickness
        allowed += f" with {other} = {lengths[other]:g} mm: {'above' if name == outer else 'below'} {limit:.6g} mm"
    require(name, lengths[name], thickness > 0, allowed)


def held_lengths(changed: Iterable[str], given: Mapping[str, Array]) -> dict[str, Array]:
    """Select the given lengths that stay where others change.

    Three lengths determine a joint. A change of one that is not among the given ones breaks a given one. It is refused
    unless the changed lengths leave one choice.

    Raises ValueError: several choices; the message has each of them.
    """
    changed_names = tuple(changed)
    new = {canonical(name) for name in changed_names if name in LENGTHS}
    old = {canonical(name): name for name in given}
    choices = [basis for basis in _BASES if new <= basis <= {*new, *old}]
    if len(choices) > 1:
        kept = [[old[name] for name in _STAYING_ORDER if name in basis - new] for basis in choices]
        shared = set.intersection(*map(set, kept))
        texts = {name: f"{name} = {value:g} mm" if is_plain_number(value) else name for name, value in given.items()}
        ways = " or ".join(" and ".join(texts[name] for name in names if name not in shared) for names in kept)
        raise ValueError(
            f"{' and '.join(changed_names) or 'another shell'} would change another length that the joint gives: add "
            f"the one that stays, {ways}"
        )
    if not choices:
        names = ", ".join((*changed_names, *(name for name in given if name not in changed_names)))
        raise ValueError(
            f"{names} do not determine a joint: two of ball_radius, socket_radius and clearance do so with "
            "liner_thickness or outer_radius"
        )
    (basis,) = choices
    return {old[name]: given[old[name]] for name in _STAYING_ORDER if name in basis - new and name in old}


def check_given(names: Iterable[str]) -> tuple[str, ...]:
    """Return names of lengths that determine a joint, one or more beside them; raise ValueError for others."""
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise TypeError(f"given must be a tuple of names of lengths, got {shown(names)}")
    given = tuple(names)
    check_names(given, LENGTHS, "among the given lengths of a joint")
    if not any(basis <= {canonical(name) for name in given} for basis in _BASES):
        raise ValueError(f"given = {shown(given)} does not determine a joint: it needs three lengths")
    return given


def lost_lengths(names: Iterable[str], given: Iterable[str]) -> list[str]:
    """List the given lengths that are not among those which determine a changed joint."""
    kept = {canonical(name) for name in names}
    return [name for name in given if canonical(name) not in kept]


def fit_beside(varied: Iterable[str], stated: Iterable[str]) -> list[str]:
    """Select the stated lengths that can stay where others vary, in their order; none if no length varies."""
    taken = {canonical(name) for name in varied if name in LENGTHS}
    fitting: list[str] = []
    for name in stated if taken else ():
        if canonical(name) not in taken and any({canonical(name), *taken} <= basis for basis in _BASES):
            fitting.append(name)
            taken.add(canonical(name))
    return fitting


def give(name: str, given: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the lengths that determine a joint once one more is given.

    The others stay as far as they fit: the ball's radius first, then the clearance, the socket's radius and the wall.
    """
    fitting = fit_beside((name,), sorted(given, key=lambda other: _STAYING_ORDER.index(canonical(other))))
    return (*(other for other in given if other in fitting), name)


def derive_lengths(lengths: Mapping[str, Array], shell: Array) -> dict[str, Array]:
    """Derive ball radius, clearance and liner thickness in mm from the lengths that determine a joint, without checks.

    The thickness may be negative.
    """
    known = {DIAMETERS.get(name, name): value / 2 if name in DIAMETERS else value for name, value in lengths.items()}
    if "interference" in known:
        known["clearance"] = -known.pop("interference")
    if "ball_radius" in known:
        R1 = known["ball_radius"]
        c = known["clearance"] if "clearance" in known else _subtract_lengths(known["socket_radius"], R1)
        R2 = known.get("socket_radius", R1 + c)
    else:
        c = known["clearance"]
        if "socket_radius" in known:
            R2 = known["socket_radius"]
        else:
            R2 = _subtract_lengths(known["outer_radius"], known["liner_thickness"] + shell)
        R1 = _subtract_lengths(R2, c)
    L = known["liner_thickness"] if "liner_thickness" in known else _subtract_lengths(known["outer_radius"], R2 + shell)
    return {"ball_radius": R1, "clearance": c, "liner_thickness": L}


def check_unique_lengths(names: Iterable[str]) -> None:
    """Check that no given length follows from the others; raise ValueError otherwise."""
    names_by_length = {canonical(name): name for name in names}
    for name in names:
        duplicate = names_by_length[canonical(name)]
        if duplicate != name:
            raise ValueError(f"{name} and {duplicate} are one too many: either fixes the other")
    radial = [names_by_length[name] for name in _RADIAL_LENGTHS if name in names_by_length]
    if len(radial) == len(_RADIAL_LENGTHS):
        raise ValueError(f"{', '.join(radial[:2])} and {radial[2]} are one too many: any two of them fix the third")
    if {*_WALLS} <= {*names_by_length} and len(radial) > 1:
        outer = names_by_length["outer_radius"]
        raise ValueError(f"{outer} and liner_thickness are one too many: either fixes the other")


def _contradiction(numbers: Mapping[str, Array], given: Mapping[str, Array], shell: Array) -> str:
    """Describe the first of too many lengths that disagrees with the others; empty for arrays."""
    if not all(map(is_plain_number, (*numbers.values(), *given.values(), shell))):
        return ""
    for name, value in sorted(numbers.items(), key=lambda item: canonical(item[0]) in _RADIAL_LENGTHS):
        remaining = {key: number for key, number in numbers.items() if key != name}
        try:
            check_unique_lengths(remaining)
            implied = length_of(name, derive_lengths({**held_lengths(remaining, given), **remaining}, shell), shell)
        except (ValueError, KeyError):  # the others are too many as well, or too few
            continue
        if abs(implied - value) > _ROUNDING * abs(value):
            return f"; {name} = {value:g} mm, but the others make {implied:.6g} mm"
    return "; leave one out"


def length_of(name: str, stored: Mapping[str, Array], shell: Array) -> Array:
    """Return a length of a joint by its name, from its stored lengths in mm."""
    socket = stored["ball_radius"] + stored["clearance"]
    lengths = {**stored, "socket_radius": socket, "outer_radius": socket + stored["liner_thickness"] + shell}
    lengths["interference"] = -stored["clearance"]
    return 2 * lengths[DIAMETERS[name]] if name in DIAMETERS else lengths[name]


def _check_sufficient_lengths(names: Iterable[str]) -> None:
    """Check that the given lengths define a new joint; raise ValueError otherwise."""
    names_by_length = {canonical(name): name for name in names}
    if {"clearance", "liner_thickness", "outer_radius"} <= {*names_by_length}:
        return
    if not ("liner_thickness" in names_by_length or "outer_radius" in names_by_length):
        raise ValueError("liner_thickness is missing, or outer_radius; liner_thickness = inf is a massive socket")
    radial = [names_by_length[name] for name in _RADIAL_LENGTHS if name in names_by_length]
    if len(radial) < 2:
        got = radial[0] if radial else "none"
        raise ValueError(f"two of ball_radius, socket_radius, clearance are needed, got {got}")


def _subtract_lengths(larger: Array, smaller: Array) -> Array:
    """Subtract two lengths, and round plain numbers to the digits of the larger: 18 - 17.9 is 0.1."""
    if not (is_plain_number(larger) and is_plain_number(smaller) and 0 < larger < float("inf")):
        return larger - smaller
    return round(larger - smaller, 14 - floor(log10(larger)))
