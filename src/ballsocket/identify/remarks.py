"""What is to be said of an identification, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy

from .measured import MEASURED

if TYPE_CHECKING:
    from .parameters import Identified

_FAR = 4.0  # uncertainties: a value so far off is named
_NAMED = 5
_RARE = 1e-3  # probability of so large a misfit


def remarks(found: Identified) -> tuple[str, ...]:
    """What the data cannot tell and what would, data that do not fit, ends that are touched, models beyond trust."""
    return (*_untold(found), *_searched(found), *_ends(found), *_fit(found), *_trust(found))


def _untold(found: Identified) -> Iterator[str]:
    untold = found.information.untold
    if not untold:
        return
    products = [product.name for product in found.information.products]
    mixed = {name for product in found.information.products for name in product.exponents}
    apart = " and ".join(name for name in found.scales.names if name in {*untold, *mixed})
    told = (
        f"the data tell {' and '.join(products)}, but not {apart} apart"
        if products
        else f"the data do not tell {apart}"
    )
    settling = [_plain(name) for name in found.next.settling if name not in {each.quantity for each in found.data}]
    if not settling:
        best = _plain(found.next.best.candidate.quantity)
        yield f"{told}; of what is usually measured {best} would tell most, though not all"
        return
    yield f"{told}: measure {_or(settling)}"


def _plain(quantity: str) -> str:
    return "free play" if quantity == "diametral_clearance" else MEASURED[quantity].title


def _or(names: Sequence[str]) -> str:
    return " or ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]


def _searched(found: Identified) -> Iterator[str]:
    if not found.best.converged:
        yield "the search did not converge: the numbers are those of its last step"
    if found.best.rivals and found.told:
        yield "another point fits the data about as well: ask the posterior"


def _ends(found: Identified) -> Iterator[str]:
    places, scales = found.best.places, found.scales
    for place, each in enumerate(scales.unknowns):
        for end in (each.low, each.high):
            at_end = abs(places[place] - each.to_scale(end) / each.span) < 1e-6
            if at_end and each.name not in found.information.untold:
                yield f"{each.name} ends at {end:g}, an end of what was given: widen it, or doubt the data"


def _fit(found: Identified) -> Iterator[str]:
    from scipy.stats import chi2

    off = [
        (each, row, float(residual))
        for each, residuals in zip(found.data, found.residuals, strict=True)
        for row, residual in enumerate(residuals)
        if abs(residual) > _FAR
    ]
    for each, row, residual in sorted(off, key=lambda one: -abs(one[2]))[:_NAMED]:
        yield f"value {row + 1} of {each.name or each.quantity} is {residual:+.3g} uncertainties from the answer"
    if found.freedom > 0 and chi2.sf(found.spread**2 * found.freedom, found.freedom) < _RARE:
        yield (
            f"the data scatter {found.spread:.3g} times as far as their uncertainties say: these are too small, there "
            "are outliers (HeavyTailed), or the model does not hold"
        )


def _trust(found: Identified) -> Iterator[str]:
    """The model's own notes at the loads of the data."""
    told: dict[str, None] = {}
    for each in found.data:
        if each.load:
            load = numpy.maximum(each.loads, 0.0) if each.load == "indentation" else each.loads
            contact = found.model.press(found.joint, **{each.load: load})
            told |= dict.fromkeys(contact.notes)
    yield from told
