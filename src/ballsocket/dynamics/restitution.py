"""How much of its speed a ball keeps: what published relations make of a coefficient of restitution, and what is exact.

All of them speak of one law of damping, F(d) (1 + χ ḋ), and of h = χ v, v being the speed at touch-down. For any F(d)

    h (1 + e) = ln[(1 + h)/(1 - h e)]

is exact; the published relations are approximations of it, near e = 1 or over all of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..core.checks import require
from ..core.sources import Source


@dataclass(frozen=True, kw_only=True)
class Relation:
    """A relation between the coefficient of restitution e, above 0 and up to 1, and the damping h = χ v.

    Attributes
    ----------
    name : str
    law : str
        The relation as people write it.
    formula : function
        From e to h.
    sources : tuple of Source
    """

    name: str
    law: str
    formula: Callable[[float], float]
    sources: tuple[Source, ...] = ()

    def damping(self, restitution: float) -> float:
        """h = χ v that the relation takes for a coefficient of restitution.

        Raises
        ------
        ValueError
            A coefficient that is not above 0 and up to 1.
        """
        why = "a coefficient of restitution is above 0, up to 1"
        require("restitution", restitution, 0.0 < restitution <= 1.0, why)
        return self.formula(float(restitution))

    def __repr__(self) -> str:
        return f"<relation of {self.name}>"


def restitution_of(damping: float) -> float:
    """The coefficient of restitution e that h = χ v really has, for any law of contact.

    Parameters
    ----------
    damping : float
        h, 0 or more.
    """
    require("damping", damping, 0.0 <= damping < math.inf, "χ v is 0 or more and finite")
    if damping < 1e-4:
        return 1.0 - 2.0 * damping / 3.0 + 4.0 * damping * damping / 9.0
    low, high = 0.0, min(1.0, 1.0 / damping)
    for _ in range(200):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (middle, high) if _exit_balance(damping, middle) > 0 else (low, middle)
    return low


def _exit_balance(h: float, e: float) -> float:
    """Above 0 where the ball leaves faster than e: what is left of ∫ x/(1 + x) dx from -h e to h."""
    return h + math.log1p(-h * e) + h * e - math.log1p(h) if h * e < 1.0 else -math.inf


def _exact(e: float) -> float:
    if e == 1.0:
        return 0.0
    low, high = 0.0, 1.0 / e
    for _ in range(200):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (middle, high) if restitution_of(middle) > e else (low, middle)
    return low


exact = Relation(
    name="the exact solution",
    law="h (1 + e) = ln[(1 + h)/(1 - h e)]",
    formula=_exact,
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

relations = (hunt_crossley, lankarani_nikravesh, flores, gonthier, exact)
"""All of them."""
