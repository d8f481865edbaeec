"""The exact answer: an elastic ball in a layered elastic socket, loaded along an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf, prod
from types import SimpleNamespace

import numpy

from .. import arrays
from ..checks import require
from ..contact import Contact
from ..joint import Joint
from ..models.base import Answer, Model
from ..sources import Source
from ..validity import SMALL_STRAIN, Range
from .abel import State
from .contact import ElasticContact
from .curve import QUANTITIES, Curve, Piece
from .gaps import CircularGap, LinearGap
from .kernel import Kernel
from .modes import ball_of, socket_of

Array = arrays.Array


@dataclass(frozen=True, kw_only=True)
class Exact(Model):
    """Linear elasticity without friction: liner and backing are closed concentric shells bonded to each other.

    The integral equation of the contact is solved in Abel space (see the docs, theory) to a requested tolerance.
    Half angles up to 85 degrees; a solid elastic ball or a rigid one; NumPy inside, whatever arrays come in.

    Parameters
    ----------
    tolerance : float
        Relative, 1e-10 to 1e-2. `contact.error` estimates what was reached; where that is more, the status is
        NOT_CONVERGED.
    gap : type
        `LinearGap` (Eq. 6 of Heß & Forsbach 2021, default) or `CircularGap` (Eq. 5).

    Raises
    ------
    ValueError
        A tolerance that double precision cannot keep.
    TypeError
        A press inside `jax.jit` or `jax.grad`.

    References
    ----------
    The equation is derived in the docs (theory). The problem of two bodies of one size is Goodman & Keer's (1965).
    """

    tolerance: float = 1e-6
    gap: type[LinearGap] | type[CircularGap] = LinearGap

    def __post_init__(self) -> None:
        good = 1e-10 <= self.tolerance <= 1e-2
        require("tolerance", self.tolerance, good, "double precision keeps a relative tolerance of 1e-10 to 1e-2")
        if self.gap not in (LinearGap, CircularGap):
            raise TypeError(f"gap must be LinearGap or CircularGap, got {self.gap!r}")

    @property
    def contact_type(self) -> type[Contact]:
        return ElasticContact

    @property
    def name(self) -> str:
        return "exact"

    @property
    def title(self) -> str:
        shape = "" if self.gap is LinearGap else ", circular gap"
        return f"elastic ball and layered shell, integral equation{shape}"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (Source("hess2021", "(6)"), Source("goodman1965"))

    @property
    def domain(self) -> tuple[Range, ...]:
        fit = "without clearance every load gives the same half angle, beyond 85°: ask cosine-limit"
        incompressible = "a bonded liner of ν = 0.5 does not give way to a uniform pressure: 0.4999 is solved"
        return (
            Range(quantity="joint.clearance", symbol="c", low=0.0, why=fit),
            Range(quantity="joint.liner.poisson", symbol="ν", low=-1.0, high=0.49991, why=incompressible),
            Range(quantity="joint.thickness_ratio", symbol="R2/L", high=200.0, why="so thin a liner is not solved"),
        )

    @property
    def validity(self) -> tuple[Range, ...]:
        return (SMALL_STRAIN,)

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        numbers = [_values(number) for number in (*joint.numbers(), load)]
        table = numpy.stack([part.ravel() for part in numpy.broadcast_arrays(*numbers)]).astype(float)
        shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in numbers))
        solution = ElasticSolution(like=load, shape=shape, pieces=self._pieces(joint, kind, table))
        indentation = solution.indentation(joint, load)
        return Answer(
            laws=solution,
            force=solution.force(joint, load),
            indentation=indentation,
            converged=solution.worst <= max(self.tolerance, 10 * arrays.rounding(load)),
            beyond_equator=indentation < 0,
        )

    def _pieces(self, joint: Joint, kind: str, table: numpy.ndarray) -> tuple[tuple[numpy.ndarray, Piece], ...]:
        """The table's columns (numbers of the joint, load) joint by joint: which they are, and their contacts."""
        joints, which = numpy.unique(table[:-1], axis=1, return_inverse=True)
        order = numpy.argsort(which.ravel(), kind="stable")
        ends = numpy.cumsum(numpy.bincount(which.ravel(), minlength=joints.shape[1]))
        pieces = []
        for column, place in zip(joints.T, numpy.split(order, ends[:-1]), strict=False):
            one = joint.with_numbers(column.tolist())
            if all(limit.strictly_holds(SimpleNamespace(joint=one)) for limit in self.domain):
                pieces.append((place, _curve(self, one).press(kind, table[-1, place])))
        return tuple(pieces)


def _values(number: Array) -> numpy.ndarray:
    values = arrays.known(number)
    if values is None:
        raise TypeError("exact cannot be traced by JAX: tabulated and refined can")
    return values


@lru_cache(maxsize=256)
def _curve(model: Exact, joint: Joint) -> Curve:
    """The curve of a joint of plain numbers; kept, since more loads on it are likely."""
    kernel = Kernel(socket=socket_of(joint), ball=ball_of(joint), tolerance=max(1e-3 * model.tolerance, 1e-14))
    gap = model.gap(clearance=float(joint.clearance), socket_radius=float(joint.socket_radius))
    return Curve(kernel=kernel, gap=gap, tolerance=model.tolerance)


def _error_of(name: str) -> Callable[[Piece], numpy.ndarray]:
    return lambda piece: piece.error[name]


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticSolution:
    """The contacts of all joints, as the `Laws` of the contact they belong to, in the caller's array library."""

    like: Array
    shape: tuple[int, ...]
    pieces: tuple[tuple[numpy.ndarray, Piece], ...]

    def spread(self, quantity: Callable[[Piece], numpy.ndarray]) -> Array:
        """A quantity of every piece at its place; NaN where there is none."""
        return self._own(self._flat(lambda place, piece: quantity(piece)))

    def _flat(self, quantity: Callable[[numpy.ndarray, Piece], numpy.ndarray], rows: int = 1) -> numpy.ndarray:
        whole = numpy.full((rows, prod(self.shape)), numpy.nan)
        for place, piece in self.pieces:
            whole[:, place] = piece.spread(quantity(place, piece))
        return whole

    def _own(self, whole: numpy.ndarray, shape: tuple[int, ...] = ()) -> Array:
        """NumPy values in the shape, library, dtype and device of the load."""
        values = whole.reshape((*shape, *self.shape))
        xp = arrays.namespace(self.like)
        return xp.asarray(values, dtype=self.like.dtype, device=arrays.device(self.like))

    @property
    def worst(self) -> Array:
        """The largest of the estimated errors, point by point."""
        return self.spread(lambda piece: numpy.max(list(piece.error.values()), axis=0))

    @property
    def error(self) -> dict[str, Array]:
        """Estimated relative error of each quantity."""
        return {name: self.spread(_error_of(name)) for name in QUANTITIES}

    def force(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.force)

    def indentation(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.indentation)

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.half_angle)

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.max_pressure)

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.stiffness)

    def energy(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.energy)

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        return self.spread(lambda piece: piece.state.pressure_integral)

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        quotient = self.max_pressure(joint, indentation) / arrays.divisor(indentation)
        return arrays.where(indentation == 0, inf, quotient)

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        return self.profile(angle, lambda state, angles: state.pressure(angles))

    def profile(self, angle: Array, law: Callable[[State, numpy.ndarray], numpy.ndarray]) -> Array:
        """A quantity of state and angle (anything, loads), at angles that broadcast against the contact's shape."""
        given = arrays.to_numpy(angle)
        shape = numpy.broadcast_shapes(given.shape, self.shape)
        front = shape[: len(shape) - len(self.shape)]
        rows = numpy.broadcast_to(given, (*front, *self.shape)).reshape(prod(front), prod(self.shape))
        values = self._flat(lambda place, piece: law(piece.state, rows[:, place[piece.touching]]), rows=len(rows))
        return self._own(values, front)
