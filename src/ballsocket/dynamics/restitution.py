"""Relations between damping and the coefficient of restitution: the exact solution and published approximations.

All relations are for the normal force F(d) (1 + χ ḋ) and the number h = χ v, with the impact speed v. The relation

    h (1 + e) = ln[(1 + h)/(1 - h e)]

is exact for any F(d). The published relations approximate it near e = 1 or for all e.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..contact.roots import bisect
from ..core.checks import require
from ..core.sources import Source


@dataclass(frozen=True, kw_only=True)
class Relation:
    """Relation between the coefficient of restitution e, 0 < e ≤ 1, and the dimensionless damping h = χ v.

    Attributes
    ----------
    name : str
        Authors of the relation.
    law : str
        Relation as a formula, for display.
    formula : function
        Function that returns h for e.
    sources : tuple of Source
        Published sources.
    """

    name: str
    law: str
    formula: Callable[[float], float]
    sources: tuple[Source, ...] = ()

    def damping(self, restitution: float) -> float:
        """Compute the dimensionless damping h = χ v (hysteresis times impact speed) from a restitution.

        Raises ValueError: a coefficient that is not above 0 and at most 1.
        """
        allowed = "a coefficient of restitution must be above 0 and at most 1"
        require("restitution", restitution, 0.0 < restitution <= 1.0, allowed)
        return self.formula(float(restitution))

    def __repr__(self) -> str:
        return f"<relation of {self.name}>"


def restitution_of(damping: float) -> float:
    """Compute the exact coefficient of restitution e from the dimensionless damping h = χ v, for any contact law.

    Parameters
    ----------
    damping : float
        Damping h, 0 or more and finite.

    Raises
    ------
    ValueError
        A negative or infinite damping.
    """
    h = damping
    require("damping", h, 0.0 <= h < math.inf, "χ v must be at least 0 and finite")
    if h < 1e-4:
        return 1.0 - 2.0 * h / 3.0 + 4.0 * h * h / 9.0

    def is_below_root(e: float) -> bool:
        """Check if the energy balance of the impact, ∫ x/(1 + x) dx from -h e to h, is positive."""
        return h * e < 1.0 and h + math.log1p(-h * e) + h * e - math.log1p(h) > 0

    return bisect(0.0, min(1.0, 1.0 / h), is_below_root)


exact = Relation(
    name="the exact solution",
    law="h (1 + e) = ln[(1 + h)/(1 - h e)]",
    formula=lambda e: 0.0 if e == 1.0 else bisect(0.0, 1.0 / e, lambda h: restitution_of(h) > e),
    sources=(Source("gonthier2004"),),
)
"""h (1 + e) = ln[(1 + h)/(1 - h e)]."""

hunt_crossley = Relation(
    name="Hunt & Crossley", law="h = 3 (1 - e)/2", formula=lambda e: 1.5 * (1.0 - e), sources=(Source("hunt1975"),)
)
"""h = 3 (1 - e)/2, for e near 1."""

lankarani_nikravesh = Relation(
    name="Lankarani & Nikravesh",
    law="h = 3 (1 - e²)/4",
    formula=lambda e: 0.75 * (1.0 - e * e),
    sources=(Source("lankarani1990"),),
)
"""h = 3 (1 - e²)/4, for e near 1."""

gonthier = Relation(
    name="Gonthier", law="h = (1 - e²)/e", formula=lambda e: (1.0 - e * e) / e, sources=(Source("gonthier2004"),)
)
"""h = (1 - e²)/e."""

flores = Relation(
    name="Flores", law="h = 8 (1 - e)/(5 e)", formula=lambda e: 1.6 * (1.0 - e) / e, sources=(Source("flores2011"),)
)
"""h = 8 (1 - e)/(5 e)."""

relations = (hunt_crossley, lankarani_nikravesh, flores, gonthier, exact)  # all relations
