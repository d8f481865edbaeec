"""Validity as data: the range of a quantity, why it ends there, and what a press that has no answer is called."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from math import inf
from operator import attrgetter
from types import SimpleNamespace
from typing import Any

from .arrays import Array, all_true, logical_not, safe_divisor, to_numpy, where
from .kinds import Unit
from .quantities import QUANTITIES


class Status(IntEnum):
    """How a press ended, point by point. Arrays hold its codes."""

    OK = 0
    OUTSIDE_DOMAIN = 1
    NOT_REACHED = 2
    NOT_CONVERGED = 3
    BEYOND_EQUATOR = 4
    AT_RIM = 5
    NOT_ROUND = 6
    NO_JOINT = 7
    DISLOCATED = 8

    @property
    def sentence(self) -> str:
        return _SENTENCES[self]

    @property
    def failed(self) -> bool:
        """Whether the numbers are missing (NaN)."""
        return self in _FAILED


_FAILED = frozenset(
    (
        Status.OUTSIDE_DOMAIN,
        Status.NOT_REACHED,
        Status.NOT_CONVERGED,
        Status.NOT_ROUND,
        Status.NO_JOINT,
        Status.DISLOCATED,
    )
)


def is_missing(status: Array) -> Array:
    """Where a status says that the numbers are missing, point by point."""
    bad = status != status
    for one in _FAILED:
        bad = bad | (status == int(one))
    return bad


_SENTENCES = {
    Status.OK: "done",
    Status.OUTSIDE_DOMAIN: "the model has no formula for this joint",
    Status.NOT_REACHED: "the model does not reach this load",
    Status.NOT_CONVERGED: "the iteration did not converge",
    Status.BEYOND_EQUATOR: "the contact circle would pass the socket's equator (half angle above 90 degrees)",
    Status.AT_RIM: "the contact fills the socket and reaches its rim",
    Status.NOT_ROUND: "ball and socket do not touch in one round patch around the pole, as the model takes it",
    Status.NO_JOINT: "these numbers make no joint: they leave no liner, or less than no clearance",
    Status.DISLOCATED: "dislocated: the load pushes the ball out of its bore",
}


class OutsideDomainError(ValueError):
    """No point of a joint lies where the model has a formula."""


@dataclass(frozen=True, kw_only=True)
class Range:
    """Where one quantity may lie, and why.

    Parameters
    ----------
    quantity : str or function
        The attribute path from a contact ("joint.liner.poisson", "half_angle"), or a function of it.
    symbol : str
        How people write it; by default the symbol of the quantity of that name.
    low, high : float
        In the quantity's own unit. A half angle is stored in rad and printed in degrees.
    why : str
        Why it ends there.
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

    @cached_property
    def of(self) -> Callable[[Any], Array]:
        """The quantity of a contact."""
        return self.quantity if callable(self.quantity) else attrgetter(self.quantity)

    def holds(self, contact: Any) -> Array:
        """Inside the closed range."""
        value = self.of(contact)
        return (value >= self.low) & (value <= self.high)

    def strictly_holds(self, contact: Any) -> Array:
        """Inside the open range."""
        value = self.of(contact)
        return (value > self.low) & (value < self.high)

    @property
    def sentence(self) -> str:
        """What a contact outside the range is told."""
        return f"outside {self}: {self.why}"

    def value_text(self, joint: Any) -> str:
        """The quantity of a joint in words."""
        value = to_numpy(self.of(SimpleNamespace(joint=joint))).ravel()
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
        """Degrees for an angle; nothing for numbers."""
        known = QUANTITIES.get(self.quantity) if isinstance(self.quantity, str) else None
        return Unit("") if known is None else known.written


@dataclass(frozen=True, kw_only=True)
class Promise:
    """What "valid" says: how close to the elastic answer a model is, at a given force, where it trusts itself.

    Measured by `ballsocket.evidence.validity`: at 99 % of the points, and at the worst within 1.3 times as much.

    Parameters
    ----------
    within : float
        Relative.
    quantities : tuple of str
        By their names in a `Contact`.
    """

    within: float
    quantities: tuple[str, ...] = ("indentation", "max_pressure")

    def __str__(self) -> str:
        return f"within {100 * self.within:g} % in {' and '.join(map(_symbol, self.quantities))}"


def _symbol(name: str) -> str:
    return QUANTITIES[name].symbol


@dataclass(frozen=True, kw_only=True)
class NeverValid(Range):
    """A range that nothing lies in: an answer for comparison, not to be trusted anywhere."""

    quantity: str | Callable[[Any], Array] = "indentation"
    symbol: str = ""

    def holds(self, contact: Any) -> Array:
        return self.of(contact) != self.of(contact)

    def __str__(self) -> str:
        return "nothing"

    @property
    def sentence(self) -> str:
        return f"not to be trusted anywhere: {self.why}"


def check_domain(domain: tuple[Range, ...], joint: Any, name: str) -> Array:
    """Where all of a model's (or modulus') domain holds for a joint; OutsideDomainError where it does nowhere.

    Of no joint at all it holds.
    """
    points: Array = joint.ball_radius == joint.ball_radius
    asked = SimpleNamespace(joint=joint)
    for limit in domain:
        holds = limit.strictly_holds(asked)
        if all_true(logical_not(holds)) and 0 not in getattr(holds, "shape", ()):
            raise OutsideDomainError(f"{name} has no answer for {limit.value_text(joint)}: {limit.why}")
        points = points & holds
    return points


NON_NEGATIVE_CLEARANCE = Range(
    quantity="joint.clearance",
    low=-5e-324,  # 0 is inside
    why="a preloaded joint (interference) presses at rest: ask sphere",
)
CLOSE_FIT = Range(
    quantity="joint.clearance_ratio",
    high=0.02,
    why="Eq. (6) neglects sin²φ, 1 % of p0 here: ask with gap=CircularGap",
)
SMALL_STRAIN = Range(
    quantity="depth_ratio", symbol="d/L", high=0.1, why="small strains: the indentation is a tenth of the liner"
)
RIGID_BALL = Range(quantity="joint.modulus_ratio", high=0.02, why="the model takes the ball as rigid")
RIGID_BACKING = Range(
    quantity="joint.backing_ratio",
    high=0.01,
    why="the model takes the liner's backing as rigid",
)


@dataclass(frozen=True, kw_only=True)
class Remark(Range):
    """A range outside of which something is said of an answer, which is valid all the same."""

    @property
    def sentence(self) -> str:
        return self.why


def infinite_layer_share(contact: Any) -> Array:
    """How much of d is the way that an infinite last layer gives as a whole; 0 without one.

    Half a space around a hemisphere gives α (1 + ν) F/(E b) more than a whole space around a closed sphere, E and the
    inner radius b being the layer's: α is 0.06 to 0.1 behind a rigid ball (ν 0.48 to 0.1), 0.17 in bone behind a shell,
    0.25 where ball and socket are of one steel. Here it is 0.1.
    """
    joint = contact.joint
    inner, material, last = joint.socket_radius, joint.liner, joint.liner_thickness
    for layer in joint.backing:
        inner, material, last = inner + last, layer.material, layer.thickness
    endless = last == inf
    radius, d = where(endless, 1.0 * inner, 1.0), contact.indentation
    moved = 0.1 * (1 + material.poisson) * contact.force / (material.young * radius * safe_divisor(d))
    return where(endless & (d > 0), moved, 0.0 * d)


def body_remarks(socket: str, ball: str) -> tuple[Remark, Remark]:
    """What a model says that takes an infinite layer and a soft ball for some body, where others take another."""
    spaces = (
        f"the infinite layer is {socket}; between a whole space around a closed sphere (exact) and half a space around "
        "a hemisphere (fem) d differs by more than 2 %, up to 26 % in massive sockets and 55 % in bone behind a shell, "
        "pmax and ε by less than 4 %"
    )
    balls = (
        f"the ball is {ball}; between a whole ball (exact) and half a ball on its plane equator (fem) d differs by "
        "10 to 40 % and pmax by 1 to 10 % where the ball is as soft as its liner"
    )
    return (
        Remark(quantity=infinite_layer_share, symbol="share of the infinite layer in d", high=0.02, why=spaces),
        Remark(quantity="joint.modulus_ratio", high=0.05, why=balls),
    )
