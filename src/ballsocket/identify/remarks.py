"""Remarks on an identification, in words."""

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
_SHIFT = 0.5  # share of half a band, about one standard uncertainty; a larger shift by a machine error is noted
_WIDENED = 1.05  # smallest noted factor on the uncertainties


def remarks(found: Identified) -> tuple[str, ...]:
    """List remarks on identifiability, ends of ranges, fit, machine errors, and validity of the model."""
    parts = (_unidentifiable, _limits, _searched, _ends, _fit, _sensitivity, _trust)
    return tuple(remark for part in parts for remark in part(found))


def _unidentifiable(found: Identified) -> Iterator[str]:
    lost = found.information.unidentifiable
    if not lost:
        return
    products = found.information.products
    mixed = {name for product in products for name in product.exponents}
    apart = [name for name in found.scales.names if name in {*lost, *mixed}]
    if products:
        names, verb = _and([product.name for product in products]), "is" if len(products) == 1 else "are"
        said = f"only {names} {verb} identifiable from these data, {_and(apart)} separately are not"
    else:
        said = f"{_and(apart)} {'is' if len(apart) == 1 else 'are'} not identifiable from these data"
    settling = [_plain(name) for name in found.next.settling if name not in {each.quantity for each in found.data}]
    if not settling:
        best = _plain(found.next.best.candidate.quantity)
        yield f"{said}; of the usual measurements {best} would add most, though not enough"
        return
    yield f"{said}: measure {_or(settling)}"


def _limits(found: Identified) -> Iterator[str]:
    """Note the bands that end at the end of a range."""
    own = [name for name, each in found.estimates.items() if name in each.limited_by]
    for name in own:
        each, unknown = found.estimates[name], found.scales.unknowns[found.scales.names.index(name)]
        ends = [end for end, range_end in ((each.low, unknown.low), (each.high, unknown.high)) if end == range_end]
        if ends:
            yield f"the band of {name} ends at {_and([f'{end:g}' for end in ends])}, the end of its range"
        else:
            yield f"the band of {name} ends where {found.model.name} has no result for all the data"
    for name, each in found.estimates.items():
        if each.limited_by and name not in each.limited_by:
            yield f"the band of {name} ends where the range of {_and(each.limited_by)} ends"


def _plain(quantity: str) -> str:
    return "free play" if quantity == "diametral_clearance" else MEASURED[quantity].title


def _or(names: Sequence[str]) -> str:
    return " or ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]


def _and(names: Sequence[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]


def _searched(found: Identified) -> Iterator[str]:
    if not found.best.converged:
        yield "the search did not converge: the numbers are those of its last step"
    if found.best.rivals and found.identifiable:
        yield "another point fits the data about as well: sample the posterior"


def _ends(found: Identified) -> Iterator[str]:
    places, scales = found.best.places, found.scales
    for place, each in enumerate(scales.unknowns):
        for side, end in ((-1, each.low), (1, each.high)):
            at_end = abs(places[place] - each.to_scale(end) / each.span) < 1e-6
            if at_end and not each.is_physical(side, places[place]):
                yield f"the best {each.name} is {end:g}, the end of its range: widen the range, or check the data"


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
    if found.misfit.widening > _WIDENED:
        yield f"bands are {found.misfit.widening:.3g} times as wide as the stated uncertainties make them"


def _sensitivity(found: Identified) -> Iterator[str]:
    """Note the machine errors that shift a joint parameter by a standard uncertainty or more."""
    of_joint = [name for name in found.scales.names if "." not in name]
    for each in found.sensitivity:
        ratio, name = max((found.shift_ratio(each, name), name) for name in of_joint)
        if ratio > _SHIFT:
            shown = found.scales.unknowns[found.scales.names.index(name)].quantity.shown
            shift = f"{shown.factor * each.shifts[name]:+.3g} {shown.text}".strip()
            yield (
                f"{each.title} would move {name} by {shift}, {ratio:.1f} times half its band: "
                f"measure it, or make {each.part} an unknown of the machine"
            )


def _trust(found: Identified) -> Iterator[str]:
    """List the notes of the model at the loads of the data."""
    told: dict[str, None] = {}
    for each in found.data:
        if each.load:
            load = numpy.maximum(each.loads, 0.0) if each.load == "indentation" else each.loads
            contact = found.model.press(found.joint, **{each.load: load})
            told |= dict.fromkeys(note for note in contact.notes if note != contact.utilisation_note)
    yield from told
