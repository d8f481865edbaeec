"""Exact solution interpolated from small tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from ....contact import Model
from ....contact.assembly import SolverResult
from ....contact.closed_sphere import HEMISPHERE_NOTE, LIKE_HEMISPHERE
from ....core import arrays
from ....core.arrays import Array, broadcast, safe_divisor
from ....core.sources import Source
from ....core.validity import SMALL_STRAIN, Promise, Range, Remark, Status
from ....problem import Joint
from .chebyshev import POISSON, THICKNESS_RATIO
from .solution import CurveReader, curve_reader, solve_with_tables


def _ball_poisson(contact: Any) -> Array:
    """Return Poisson's ratio of the ball, or 0.3 for a rigid ball, whose ν has no effect."""
    joint = contact.joint
    return 0.3 + 0.0 * joint.liner.young if joint.ball is None else joint.ball.poisson + 0.0 * joint.liner.young


def _backing_count(contact: Any) -> Array:
    """Return the number of backing layers behind the liner."""
    return len(contact.joint.backing) + 0.0 * contact.joint.liner.young


_NOT_TABULATED = "outside the tables: use exact"


@dataclass(frozen=True, kw_only=True)
class Tabulated(Model):
    """Exact solution interpolated from tables: vectorised, differentiable, about 1 µs for each contact.

    Arrays may come from any array library. The tables contain the linear gap (Eq. 6 of Heß & Forsbach 2021) and one
    liner bonded to a rigid backing. Half angles reach up to 85 degrees. Results are within 1e-5 of `Exact` for a rigid
    ball, within 2e-4 for an elastic one.

    Parameters
    ----------
    file : str
        Path of tables made by `build.build`; the default is the tables of the package.

    References
    ----------
    The equation behind the tables is derived in the docs (theory).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Tabulated().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    16.94
    """

    file: str = ""

    seconds_a_press: ClassVar[float] = 4e-6
    accepts_floats: ClassVar[bool] = True
    name: ClassVar[str] = "tabulated"
    title: ClassVar[str] = "elastic ball and bonded liner, from tables of the exact answer"
    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "(6)"), Source("goodman1965"))
    domain: ClassVar[tuple[Range, ...]] = (
        Range(quantity="joint.clearance", low=0.0, why="no clearance: use cosine-limit"),
        Range(quantity="joint.liner.poisson", low=POISSON[0], high=POISSON[1], why=_NOT_TABULATED),
        Range(quantity="joint.thickness_ratio", low=THICKNESS_RATIO[0], high=THICKNESS_RATIO[1], why=_NOT_TABULATED),
        Range(quantity="joint.modulus_ratio", high=0.0201, why=_NOT_TABULATED),
        Range(quantity=_ball_poisson, symbol="ν_ball", low=-0.01, high=0.501, why=_NOT_TABULATED),
        Range(quantity=_backing_count, symbol="layers behind the liner", high=1.0, why=_NOT_TABULATED),
        Range(quantity="joint.backing_ratio", high=1.0, why="a free outer surface is not in the tables: use exact"),
    )
    validity: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity=_ball_poisson,
            symbol="ν_ball",
            low=0.15,
            high=0.4,
            why="the tables hold balls of ν 0.15, 0.27 and 0.38 and keep 2e-4 between them",
        ),
        SMALL_STRAIN,
        LIKE_HEMISPHERE,
    )
    remarks: ClassVar[tuple[Remark, ...]] = (HEMISPHERE_NOTE,)

    promise: ClassVar[Promise] = Promise(within=2e-4, quantities=("indentation", "half_angle", "max_pressure"))

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self.solve_with_reader(joint, kind, load, curve_reader(kind))

    def solve_with_reader(self, joint: Joint, kind: str, load: Array, read: CurveReader) -> SolverResult:
        """Solve the contacts for loads of one kind with a function that evaluates the curves of joints.

        `read` is such a function, see `curve_reader`.
        """
        solution = solve_with_tables(self.file, joint, load, read)
        d, F, _, _ = solution.values
        return SolverResult(
            laws=solution,
            force=F,
            indentation=d,
            failures={
                Status.NOT_CONVERGED: arrays.logical_not(
                    _relative_residual(kind, load, d, F) <= _rounding_error(load, d / joint.clearance)
                )
            },
        )


def _rounding_error(load: Array, depth: Array) -> Array:
    """Return the relative rounding error of a load, which increases with `depth` = d/c."""
    return arrays.machine_epsilon(load) * (1e4 + 1e2 * depth)


def _relative_residual(kind: str, load: Array, d: Array, F: Array) -> Array:
    """Compute the relative difference between the load and the solution; 0 for half angles."""
    if kind == "half_angle":
        return 0.0 * F
    target = broadcast(load, F)
    return abs((F if kind == "force" else d) - target) / safe_divisor(target)
