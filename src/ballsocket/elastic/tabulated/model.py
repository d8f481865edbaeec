"""The exact answer from small tables: what one joint's curve looks like, for every bonded liner there is.

Under the linear gap everything is proportional to c + d, so with the compliance C = 2 (1 - ν²) R2/E (1 + β) of
liner and ball, three functions of the half angle, ν, R2/L and the ball alone are all there is to know:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

They are tabulated as Chebyshev series; stiffness and energy follow from them. A further table has the profile p/p0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ... import arrays
from ...arrays import Array, broadcast, divisor
from ...joint import Joint
from ...model import Answer, Model
from ...sources import Source
from ...validity import SMALL_STRAIN, Range
from .chebyshev import (
    POISSON,
    THICKNESS_RATIO,
)
from .solution import solution_of


@dataclass(frozen=True, kw_only=True)
class Tabulated(Model):
    """`Exact` from tables, in any array library, differentiable and vectorised: about a millionth of a second a press.

    The linear gap (Eq. 6 of Heß & Forsbach 2021) and one liner bonded to something rigid. Half angles up to 85 degrees;
    within 1e-5 of `Exact` for a rigid ball, within 2e-4 for an elastic one.

    Parameters
    ----------
    file : str
        Tables made by `build_tables.build`; those that come with the package by default.

    References
    ----------
    The equation behind the tables is derived in the docs (theory).
    """

    file: str = ""

    @property
    def seconds_a_press(self) -> float:
        return 4e-6

    @property
    def name(self) -> str:
        return "tabulated"

    @property
    def title(self) -> str:
        return "elastic ball and bonded liner, from tables of the exact answer"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (Source("hess2021", "(6)"), Source("goodman1965"))

    @property
    def domain(self) -> tuple[Range, ...]:
        ask = "that is not in the tables: ask exact"
        return (
            Range(quantity="joint.clearance", symbol="c", low=0.0, why="no clearance: ask cosine-limit"),
            Range(quantity="joint.liner.poisson", symbol="ν", low=POISSON[0], high=POISSON[1], why=ask),
            Range(
                quantity="joint.thickness_ratio",
                symbol="R2/L",
                low=THICKNESS_RATIO[0],
                high=THICKNESS_RATIO[1],
                why=ask,
            ),
            Range(quantity="joint.modulus_ratio", symbol="E/E_ball", high=0.0201, why=ask),
            Range(quantity=_ball_poisson, symbol="ν_ball", low=-0.01, high=0.501, why=ask),
            Range(quantity=_layers, symbol="layers behind the liner", high=1.0, why=ask),
        )

    @property
    def validity(self) -> tuple[Range, ...]:
        why = "between three tabulated balls, 0.15, 0.27 and 0.38, the tables keep 2e-4"
        return (Range(quantity=_ball_poisson, symbol="ν_ball", low=0.15, high=0.4, why=why), SMALL_STRAIN)

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        solution = solution_of(self.file, joint, kind, load)
        d, F, _, _ = solution.values
        return Answer(
            laws=solution,
            force=F,
            indentation=d,
            converged=_miss(kind, load, d, F) <= 1e4 * arrays.rounding(load),
            beyond_equator=d < 0,
        )


def _miss(kind: str, load: Array, d: Array, F: Array) -> Array:
    if kind == "half_angle":
        return 0.0 * F
    given = broadcast(load, F)
    return arrays.namespace(F).abs((F if kind == "force" else d) - given) / divisor(given)


def _ball_poisson(contact: Any) -> Array:
    """ν of the ball; one that is as good as any for a rigid ball."""
    joint = contact.joint
    return 0.3 + 0.0 * joint.liner.young if joint.ball is None else joint.ball.poisson + 0.0 * joint.liner.young


def _layers(contact: Any) -> Array:
    """More than 1 where something other than a rigid surface is behind the liner."""
    return contact.joint.backing_ratio + 2.0 * len(contact.joint.backing)
