"""Tangent stiffness and work of one solved contact, from neighbouring contacts on the same mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy

from ...core.arrays import gauss_legendre
from .full_contact import FullContact
from .load_search import ContactBracket, is_pressed
from .round_contact import PartialContact, partial_contact

Solved = PartialContact | FullContact
"""Contact on one mesh: with its edge inside the socket, or filling the socket."""

_RELATIVE_STEPS = 0.02 * numpy.arange(-3, 4)
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(12))
_DEPTHS = numpy.geomspace(1 / 30, 1.0, 12)


def stiffness(contact: Solved) -> float:
    """Compute the tangent stiffness dF/dd in N/mm from slightly narrower and wider contacts.

    A single step is not enough, because the edge moves unevenly through the elements.

    With q = ln(F/d) and v = 1/d, both smooth in ε even where d goes to infinity: F' = (F/d) (1 - v q'/v').
    """
    if isinstance(contact, FullContact):
        return contact.stiffness
    angles = numpy.minimum(_RELATIVE_STEPS, contact.pair.angle[-1] / contact.half_angle - 1)
    neighbours = [
        partial_contact(contact.pair, contact.gap, float(contact.half_angle * (1 + angle)))
        for angle in numpy.unique(angles)
    ]
    valid = [neighbour for neighbour in neighbours if is_pressed(neighbour)]
    if len(valid) < _DEGREE + 1:
        return numpy.nan
    x = numpy.array([neighbour.half_angle / contact.half_angle - 1 for neighbour in valid])
    q = numpy.log([neighbour.force / neighbour.indentation for neighbour in valid])
    v = numpy.array([contact.indentation / neighbour.indentation for neighbour in valid])
    dq, dv = (numpy.polynomial.Polynomial.fit(x, values, _DEGREE).deriv()(0.0) for values in (q, v))
    return float(contact.force / contact.indentation * (1 - dq / dv))


_DEGREE = 3


def work(contact: Solved) -> float:
    """Compute the work of the load in N mm, which is the strain energy if the gap has a potential."""
    if contact.gap.conservative:
        return contact.strain_energy
    if isinstance(contact, FullContact):
        return _partial_work(partial_contact(contact.pair, contact.gap, contact.half_angle)) + _rim_work(contact)
    return _partial_work(contact)


def _partial_work(contact: PartialContact) -> float:
    """Compute the work ∫ F dd in N mm up to a partial contact, from a polynomial fit of ln F over ln d."""
    bracket = ContactBracket(pair=contact.pair, gap=contact.gap, low=0.2 * contact.half_angle, high=contact.half_angle)
    narrower = [bracket.solve("indentation", float(depth * contact.indentation)) for depth in _DEPTHS[:-1]]
    known = [neighbour for neighbour in narrower if neighbour is not None] + [contact]
    x = numpy.log([neighbour.indentation / contact.indentation for neighbour in known])
    y = numpy.log([neighbour.force / contact.force for neighbour in known])
    law = numpy.polynomial.Polynomial.fit(x, y, min(6, len(x) - 1))
    depths = x[0] * (1 - _NODES)  # ln d
    narrow = numpy.exp(law(x[0]) + x[0]) / (law.deriv()(x[0]) + 1)
    return float(contact.force * contact.indentation * (narrow - x[0] * (_WEIGHTS @ numpy.exp(law(depths) + depths))))


def _rim_work(contact: FullContact) -> float:
    """Compute the work ∫ F dd in N mm from the indentation at which the contact reaches the rim."""
    start = partial_contact(contact.pair, contact.gap, contact.half_angle).indentation
    depth = contact.indentation - start
    forces = [replace(contact, indentation=start + depth * node).force for node in _NODES]
    return float(depth * (_WEIGHTS @ forces))
