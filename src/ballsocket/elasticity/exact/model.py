"""Exact solution of an elastic ball in a layered elastic socket, loaded along an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf
from typing import TYPE_CHECKING, Any, ClassVar

from ...contact import Contact, Model
from ...contact.assembly import SolverResult
from ...contact.per_joint import solve_per_joint
from ...core import arrays
from ...core.arrays import Array
from ...core.checks import check_numeric, require, shown
from ...core.sources import Source
from ...core.validity import SMALL_STRAIN, Range, Status
from ...problem import Joint, Support
from ...problem.gaps import CircularGap, GapKind, LinearGap, check_gap, gap_remarks, gap_validity, select_gap
from .contact import ElasticContact, NearHemisphere
from .kernel import Kernel
from .load_curve import LoadCurve
from .modes import ball_of, socket_of

if TYPE_CHECKING:
    from .chebyshev_curve import ChebyshevCurve


def _effective_poisson(contact: Any) -> Array:
    """Return Poisson's ratio of the liner, limited to 0.4999 if the liner can deform freely on one side."""
    joint = contact.joint
    nu = joint.liner.poisson
    if joint.backing or joint.support is Support.FREE:
        return arrays.clip(nu, -1.0, 0.4999)
    return arrays.where(joint.liner_thickness < inf, nu, arrays.clip(nu, -1.0, 0.4999))


@dataclass(frozen=True, kw_only=True)
class Exact(Model):
    """Exact linear-elastic contact without friction: liner and backing are bonded, closed concentric shells.

    The integral equation of the contact is solved in Abel space (see the docs, theory) to a requested tolerance.
    Half angles reach up to 85 degrees. The ball is solid and elastic, or rigid. All arrays are converted to NumPy.

    Parameters
    ----------
    tolerance : float
        Relative tolerance, 1e-10 to 1e-2. `contact.error` estimates the error; where it exceeds the tolerance, the
        status is NOT_CONVERGED.
    gap : type, optional
        `LinearGap` (Eq. 6 of Heß & Forsbach 2021) or `CircularGap` (Eq. 5). By default it is linear up to c/R2 0.01,
        and circular beyond.

    Raises
    ------
    ValueError
        A tolerance that double precision cannot keep.
    TypeError
        A press inside `jax.jit` or `jax.grad`.

    References
    ----------
    The equation is derived in the docs (theory). The problem of two bodies of one size is Goodman & Keer's (1965).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Exact().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    16.94
    """

    tolerance: float = 1e-6
    gap: GapKind | None = None

    def __post_init__(self) -> None:
        tolerance = check_numeric("tolerance", self.tolerance)
        if not arrays.is_plain_number(tolerance):
            raise TypeError(f"tolerance must be one number, got {shown(self.tolerance)}")
        good = 1e-10 <= tolerance <= 1e-2
        require("tolerance", self.tolerance, good, "double precision keeps a relative tolerance of 1e-10 to 1e-2")
        check_gap(self.gap)

    contact_type: ClassVar[type[Contact]] = ElasticContact
    is_closed_sphere: ClassVar[bool] = True
    differentiable: ClassVar[bool] = False
    smooth_step: ClassVar[float] = 2e-3
    seconds_a_press: ClassVar[float] = 3e-3
    name: ClassVar[str] = "exact"

    @property
    def title(self) -> str:
        """Description of the model in one line."""
        shape = ", circular gap" if self.gap is CircularGap else ""
        return f"elastic ball and layered shell, integral equation{shape}"

    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "(6)"), Source("goodman1965"))

    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="joint.clearance",
            low=0.0,
            why="without clearance every load gives the same half angle, beyond 85°: use cosine-limit",
        ),
        Range(
            quantity=_effective_poisson,
            symbol="ν",
            low=-1.0,
            high=0.49991,
            why="a liner of ν = 0.5 between fixed walls is incompressible and cannot be indented: use at most 0.4999",
        ),
        Range(quantity="joint.thickness_ratio", high=200.0, why="the liner is too thin to be solved"),
    )

    @property
    def validity(self) -> tuple[Range, ...]:
        """Validity ranges; a circular gap needs no close fit."""
        return (*gap_validity(self.gap), SMALL_STRAIN, _NEAR_HEMISPHERE)

    @property
    def remarks(self) -> tuple[Range, ...]:
        """Remarks on the gap."""
        return gap_remarks(self.gap)

    reach: ClassVar[str] = (
        "half angles up to 85°, or less if the ball fills its socket first, or touches it up to its own equator"
    )

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self._solve_on_curves(curve_of, joint, kind, load)

    def _solve_curve_points(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self._solve_on_curves(chebyshev_curve_of, joint, kind, load)

    def _solve_on_curves(
        self, curve_of_joint: Callable[[Exact, Joint], LoadCurve | ChebyshevCurve], joint: Joint, kind: str, load: Array
    ) -> SolverResult:
        """Solve the contacts on the load curve of each joint; errors beyond the tolerance count as not converged."""
        solution = solve_per_joint(
            self, joint, load, lambda plain_joint, loads: curve_of_joint(self, plain_joint).press(kind, loads)
        )
        tolerance = max(self.tolerance, 10 * arrays.machine_epsilon(load))
        return SolverResult(
            laws=solution,
            force=solution.force,
            indentation=solution.indentation,
            failures={Status.NOT_CONVERGED: ~(solution.max_error <= tolerance)},
        )


_NEAR_HEMISPHERE = NearHemisphere()


@lru_cache(maxsize=256)
def curve_of(model: Exact, joint: Joint) -> LoadCurve:
    """Return the load curve of a joint of plain numbers, cached for further loads."""
    kernel = Kernel(socket=socket_of(joint), ball=ball_of(joint), tolerance=max(1e-3 * model.tolerance, 1e-14))
    kind = select_gap(model.gap, joint)
    gap = kind(clearance=float(joint.clearance), socket_radius=float(joint.socket_radius))
    return LoadCurve(kernel=kernel, gap=gap, tolerance=model.tolerance)


@lru_cache(maxsize=256)
def chebyshev_curve_of(model: Exact, joint: Joint) -> LoadCurve | ChebyshevCurve:
    """Return the Chebyshev series of the load curve of a joint of plain numbers with a linear gap, from a cache.

    A joint with a circular gap has the load curve itself.
    """
    from .chebyshev_curve import fit_curve  # presses do without it

    curve = curve_of(model, joint)
    return fit_curve(curve) if isinstance(curve.gap, LinearGap) else curve
