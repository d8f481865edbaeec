"""Validity as data: statuses of a press, and ranges of quantities with the reason of each limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from math import inf
from typing import Any, NamedTuple, Self

from .arrays import Array, all_true, logical_not, safe_divisor, to_numpy, where
from .kinds import Unit
from .quantities import QUANTITIES


class Status(IntEnum):
    """Outcome of a press: success, or the reason of its failure, with a sentence that describes it.

    Arrays of results have the integer codes.
    """

    sentence: str

    def __new__(cls, code: int, sentence: str = "") -> Self:
        status = int.__new__(cls, code)
        status._value_, status.sentence = code, sentence
        return status

    OK = 0, "solved"
    OUTSIDE_DOMAIN = 1, "the model has no formula for this joint"
    NOT_REACHED = 2, "the model does not reach this load"
    NOT_CONVERGED = 3, "the iteration did not converge"
    BEYOND_EQUATOR = 4, "the contact circle would pass the socket's equator (half angle above 90 degrees)"
    AT_RIM = 5, "the contact fills the socket and reaches its rim"
    NOT_ROUND = 6, "the contact is not a single round patch around the pole, as the model assumes"
    NO_JOINT = 7, "invalid geometry: liner thickness or clearance would be negative"
    DISLOCATED = 8, "dislocated: the load pushes the ball out of its bore"

    @property
    def failed(self) -> bool:
        """True if the calculation failed; its results are then NaN."""
        return self not in _SOLVED


_SOLVED = (Status.OK, Status.BEYOND_EQUATOR, Status.AT_RIM)


def is_missing(status: Array) -> Array:
    """Return a mask of the points whose status means that their results are NaN."""
    mask = status == status
    for solved in _SOLVED:
        mask = mask & (status != int(solved))
    return mask


class OutsideDomainError(ValueError):
    """Error raised if no point of a press lies in the domain of the model."""


@dataclass(frozen=True, kw_only=True)
class Range:
    """Limits of a quantity within which a model is valid or defined, with their reason.

    Parameters
    ----------
    quantity : str or function
        Attribute path of a contact ("joint.liner.poisson", "half_angle"), or a function of a contact.
    symbol : str
        Symbol in messages; by default that of the quantity.
    low, high : float
        Limits in the internal unit of the quantity; angles are printed in degrees.
    why : str
        Reason of the limits.
    """

    quantity: str | Callable[[Any], Array]
    symbol: str = ""
    low: float = -inf
    high: float = inf
    why: str = ""

    def __post_init__(self) -> None:
        if not self.symbol and isinstance(self.quantity, str):
            name = self.quantity.rpartition(".")[2]
            object.__setattr__(self, "symbol", QUANTITIES[name].symbol if name in QUANTITIES else name)

    def quantity_of(self, contact: Any) -> Array:
        """Read or compute the quantity of a contact."""
        if callable(self.quantity):
            return self.quantity(contact)
        value = contact
        for name in self.quantity.split("."):  # `torch.compile` traces no `attrgetter`
            value = getattr(value, name)
        return value

    def holds(self, contact: Any) -> Array:
        """Return a mask of the contacts inside the closed range, limits included."""
        value = self.quantity_of(contact)
        return (value >= self.low) & (value <= self.high)

    def strictly_holds(self, contact: Any) -> Array:
        """Return a mask of the contacts inside the open range, limits excluded."""
        value = self.quantity_of(contact)
        return (value > self.low) & (value < self.high)

    @property
    def sentence(self) -> str:
        """Note for a contact outside the range."""
        return f"outside {self}: {self.why}"

    def note(self, contact: Any) -> str:
        """Note for a contact outside the range; ranges with an amount of the contact in their note override it."""
        return self.sentence

    def value_text(self, joint: Any) -> str:
        """Format symbol and value of the quantity of a joint, such as "R2/L = 3"."""
        value = to_numpy(self.quantity_of(_UnloadedContact(joint))).ravel()
        return f"{self.symbol} = {value[0]:g}" + (f" (and {value.size - 1} more)" if value.size > 1 else "")

    def __str__(self) -> str:
        low, high = (f"{end * self._unit.factor:.4g}{self._unit.text}" for end in (self.low, self.high))
        if self.low == -inf:
            return f"{self.symbol} ≤ {high}"
        if self.high == inf:
            return f"{self.symbol} ≥ {low}"
        return f"{self.symbol} {low} to {high}"

    @property
    def _unit(self) -> Unit:
        """Unit of the printed limits: degrees for an angle, empty for a plain number."""
        quantity = QUANTITIES.get(self.quantity) if isinstance(self.quantity, str) else None
        return Unit("") if quantity is None else quantity.written


@dataclass(frozen=True, kw_only=True)
class Promise:
    """Measured accuracy of a model relative to the elastic solution at equal force, inside its validity.

    `ballsocket.evidence.validity` measures it: 99 % of the points lie within it, and all within 1.3 times as much.
    """

    within: float  # largest relative difference
    quantities: tuple[str, ...] = ("indentation", "max_pressure")  # names of the attributes of a `Contact`

    def __str__(self) -> str:
        return f"within {100 * self.within:g} % in {' and '.join(QUANTITIES[name].symbol for name in self.quantities)}"


@dataclass(frozen=True, kw_only=True)
class NeverValid(Range):
    """Empty validity range, of a model whose results are only for comparison."""

    quantity: str | Callable[[Any], Array] = "indentation"

    def holds(self, contact: Any) -> Array:
        """Return a mask that is false for all contacts."""
        return self.quantity_of(contact) != self.quantity_of(contact)

    def __str__(self) -> str:
        return "nothing"

    @property
    def sentence(self) -> str:
        """Note for all contacts of the model."""
        return f"never valid: {self.why}"


class _UnloadedContact(NamedTuple):
    """Joint before it is pressed, in the place of a contact for ranges that read only the joint."""

    joint: Any


def check_domain(domain: tuple[Range, ...], joint: Any, name: str) -> Array:
    """Check which joints lie in the domain of a model or modulus: return a mask, true for these joints.

    The mask is true for an empty array of joints. The message has the `name` of the model or modulus.

    Raises OutsideDomainError: no point is inside one of the ranges.
    """
    points: Array = joint.ball_radius == joint.ball_radius
    unloaded = _UnloadedContact(joint)
    for limit in domain:
        holds = limit.strictly_holds(unloaded)
        if holds is True:
            continue
        if all_true(logical_not(holds)) and 0 not in getattr(holds, "shape", ()):
            raise OutsideDomainError(f"{name} has no answer for {limit.value_text(joint)}: {limit.why}")
        points = points & holds
    return points


NON_NEGATIVE_CLEARANCE = Range(
    quantity="joint.interference",
    symbol="interference",
    high=5e-324,  # 0 is inside
    why="a joint with interference is preloaded, which only the model sphere solves",
)
SMALL_STRAIN = Range(
    quantity="depth_ratio", symbol="d/L", high=0.1, why="small strains: the indentation is a tenth of the liner"
)
RIGID_BALL = Range(quantity="joint.modulus_ratio", high=0.02, why="the model takes the ball as rigid")
RIGID_BACKING = Range(quantity="joint.backing_ratio", high=0.01, why="the model takes the liner's backing as rigid")


@dataclass(frozen=True, kw_only=True)
class Remark(Range):
    """Range outside of which a result gets a note but remains valid."""

    @property
    def sentence(self) -> str:
        """Note for a contact outside the range."""
        return self.why


def infinite_layer_share(contact: Any) -> Array:
    """Estimate the fraction of the indentation that depends on the assumed shape of an infinite outer layer.

    The fraction is 0 without an infinite layer.

    The indentation of a half space around a hemisphere exceeds that of a full space around a closed sphere by
    α (1 + ν) F/(E b), with E, ν and the inner radius b of the layer. The factor α is 0.06 to 0.1 for a rigid ball
    (ν 0.48 to 0.1), 0.17 for bone behind a shell, and 0.25 for ball and socket of one steel. The estimate takes 0.1.
    """
    joint = contact.joint
    inner, material, last = joint.socket_radius, joint.liner, joint.liner_thickness
    for layer in joint.backing:
        inner, material, last = inner + last, layer.material, layer.thickness
    infinite = last == inf
    radius, d = where(infinite, 1.0 * inner, 1.0), contact.indentation
    fraction = 0.1 * (1 + material.poisson) * contact.force / (material.young * radius * safe_divisor(d))
    return where(infinite & (d > 0), fraction, 0.0 * d)


def body_remarks(socket: str, ball: str) -> tuple[Remark, Remark]:
    """Make two remarks: on the shapes that a model assumes for an infinite outer layer and for a soft ball."""
    spaces = (
        f"the infinite layer is {socket}; between a full space around a closed sphere (exact) and a half space around "
        "a hemisphere (fem) d differs by more than 2 %, up to 26 % in massive sockets and 55 % in bone behind a shell, "
        "pmax and ε by less than 4 %"
    )
    balls = (
        f"the ball is {ball}; between a full ball (exact) and half a ball on its plane equator (fem) d differs by "
        "10 to 40 % and pmax by 1 to 10 % where the ball is as soft as its liner"
    )
    return (
        Remark(quantity=infinite_layer_share, symbol="share of the infinite layer in d", high=0.02, why=spaces),
        Remark(quantity="joint.modulus_ratio", high=0.05, why=balls),
    )


def _largest(name: str, contact: Any) -> Array:
    """Return the largest elastic constant of liner, ball and backing: "young" in MPa, or "poisson"."""
    joint = contact.joint
    largest = getattr(joint.liner, name)
    for part in (joint.ball, *(layer.material for layer in joint.backing)):
        if part is not None:
            largest = where(getattr(part, name) > largest, getattr(part, name), largest)
    return largest


largest_poisson = partial(_largest, "poisson")  # of liner, ball and backing of a contact


def _largest_strength(contact: Any) -> Array:
    """Return the largest strength of liner and ball in MPa; 0 if none is known."""
    largest: Array = 0.0 * contact.joint.liner.young
    for strength in contact.joint.strengths():
        largest = where(strength > largest, strength, largest)
    return largest


UNIT_REMARKS = (
    Remark(
        quantity="joint.ball_radius",
        low=0.1,
        why="R1 is below 0.1 mm, as if lengths were in metres: give lengths in mm, moduli in MPa and forces in N",
    ),
    Remark(
        quantity=partial(_largest, "young"),
        symbol="E",
        high=2e6,
        why="a Young's modulus is above 2 million MPa, as if it were in pascals (diamond has 1.1 million MPa): give "
        "moduli in MPa, and a rigid ball as None",
    ),
    Remark(
        quantity=_largest_strength,
        symbol="σy",
        high=1e5,
        why="a strength is above 100 000 MPa, as if it were in pascals: give strengths in MPa",
    ),
)
"""Remarks of all models on joints whose numbers look like SI base units: no joint or material has such numbers."""
