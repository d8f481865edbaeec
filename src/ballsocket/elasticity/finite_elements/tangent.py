"""Tangent and work of one solved contact, from contacts beside it on the same mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy

from ...core.arrays import gauss_legendre
from .full_contact import FullContact
from .load_search import ContactBracket, is_pressed
from .round_contact import PartialContact, partial_contact

Solved = PartialContact | FullContact
"""A contact on one mesh: inside of its socket, or filling it."""

_AROUND = 0.02 * numpy.arange(-3, 4)
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(12))
_DEPTHS = numpy.geomspace(1 / 30, 1.0, 12)


def stiffness(one: Solved) -> float:
    """dF/dd in N/mm, from contacts on both sides, since the edge moves unevenly through the elements.

    With q = ln(F/d) and v = 1/d, both smooth in ε even where d goes to infinity: F' = (F/d) (1 - v q'/v').
    """
    if isinstance(one, FullContact):
        return one.stiffness
    angles = numpy.minimum(_AROUND, one.pair.angle[-1] / one.half_angle - 1)
    beside = [partial_contact(one.pair, one.gap, float(one.half_angle * (1 + angle))) for angle in numpy.unique(angles)]
    sound = [other for other in beside if is_pressed(other)]
    if len(sound) < _CUBIC + 1:
        return numpy.nan
    x = numpy.array([other.half_angle / one.half_angle - 1 for other in sound])
    q = numpy.log([other.force / other.indentation for other in sound])
    v = numpy.array([one.indentation / other.indentation for other in sound])
    dq, dv = (numpy.polynomial.Polynomial.fit(x, values, _CUBIC).deriv()(0.0) for values in (q, v))
    return float(one.force / one.indentation * (1 - dq / dv))


_CUBIC = 3


def work(one: Solved) -> float:
    """Work of the load in N mm: the strain energy, where the gap makes that the same."""
    if one.gap.conservative:
        return one.strain_energy
    if isinstance(one, FullContact):
        return _work_up_to(partial_contact(one.pair, one.gap, one.half_angle)) + _work_beyond(one)
    return _work_up_to(one)


def _work_up_to(one: PartialContact) -> float:
    """∫ F dd, from where F is a power of d: ln F is a polynomial of ln d over what matters of it."""
    ladder = ContactBracket(pair=one.pair, gap=one.gap, low=0.2 * one.half_angle, high=one.half_angle)
    found = [ladder.find("indentation", float(depth * one.indentation)) for depth in _DEPTHS[:-1]]
    known = [other for other in found if other is not None] + [one]
    x = numpy.log([other.indentation / one.indentation for other in known])
    y = numpy.log([other.force / one.force for other in known])
    law = numpy.polynomial.Polynomial.fit(x, y, min(6, len(x) - 1))
    depths = x[0] * (1 - _NODES)  # ln d
    narrow = numpy.exp(law(x[0]) + x[0]) / (law.deriv()(x[0]) + 1)
    return float(one.force * one.indentation * (narrow - x[0] * (_WEIGHTS @ numpy.exp(law(depths) + depths))))


def _work_beyond(one: FullContact) -> float:
    """∫ F dd from where the contact reaches the rim."""
    start = partial_contact(one.pair, one.gap, one.half_angle).indentation
    depth = one.indentation - start
    forces = [replace(one, indentation=start + depth * node).force for node in _NODES]
    return float(depth * (_WEIGHTS @ forces))
