"""How a ball sits in its socket, state by state, and the words for it."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

import numpy

from ..core import arrays
from ..core.arrays import Array, Numbers, where

if TYPE_CHECKING:
    from .load import Load
    from .reaction import Constants, Elastic, Place


class Touch(IntEnum):
    """What a force element finds at a state. Arrays hold its codes."""

    FREE = 0
    CONTACT = 1
    AT_RIM = 2
    OVER_RIM = 3
    THROUGH_WALL = 4
    NO_NUMBER = 5

    @property
    def sentence(self) -> str:
        return _SENTENCES[self]

    @property
    def failed(self) -> bool:
        """Whether there is no answer: the step that led here is to be taken again, shorter."""
        return self >= Touch.THROUGH_WALL


_SENTENCES = {
    Touch.FREE: "nothing touches",
    Touch.CONTACT: "the ball touches the socket",
    Touch.AT_RIM: "the contact reaches the rim, which carries a part of it",
    Touch.OVER_RIM: "the ball has left the cup over its rim, and nothing carries it",
    Touch.THROUGH_WALL: "the ball is deeper than the wall, or the model, goes: a shorter step is needed",
    Touch.NO_NUMBER: "the state is no finite number, or too large a one",
}


ROOM = 1e8
"""Numbers of a state are too large if this times the sum of their squares is none."""


def status_of(place: Place, contact: Elastic, known: Array, given: Constants) -> Touch | Array:
    """A `Touch`, or an array of its codes."""
    d, s = place.indentation, contact.covered
    none = 0.0 * where(known, d, 0.0)
    touching = d > -given.smoothing
    code = where(touching, none + 1.0, none)
    code = where(touching & (s < 1.0), none + float(Touch.AT_RIM), code)
    code = where(
        (d > given.wall) | (touching & (contact.normal != contact.normal)), none + float(Touch.THROUGH_WALL), code
    )
    code = where(touching & (s <= -1.0), none + float(Touch.OVER_RIM), code)
    code = where(known, code, none + float(Touch.NO_NUMBER))
    if type(code) is float:
        return Touch(int(code))
    xp = arrays.namespace(code)
    return xp.astype(code, xp.int8)


def told(load: Load) -> tuple[str, ...]:
    """A sentence for each kind of state that is to be told, with the first of its states."""
    codes = numpy.atleast_1d(arrays.to_numpy(load.status)).ravel()
    return tuple(_told(load, codes, touch) for touch in list(Touch)[2:] if (codes == touch).any())


def _told(load: Load, codes: Numbers, touch: Touch) -> str:
    numbers = numpy.flatnonzero(codes == touch)
    x, y, z, d = (_at(part, codes, numbers[0]) for part in (*load.position, load.indentation))
    many = "" if codes.size == 1 else f"{len(numbers)} of {codes.size}: "
    state = f"r = ({x:.6g}, {y:.6g}, {z:.6g}) mm, d = {d:.6g} mm"
    return f"{many}{touch.sentence}; {state}, and there is an answer up to {load.element.wall:.6g} mm"


def _at(part: Array, codes: Numbers, number: int) -> float:
    return float(numpy.broadcast_to(arrays.to_numpy(part), codes.shape).ravel()[number])
