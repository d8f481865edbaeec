"""Presses for the page, each done once: a joint, a load, a model."""

from __future__ import annotations

from functools import lru_cache
from math import ceil, log10

import numpy

from ..catalogue import catalogue
from ..compare import Comparison, compare
from ..contact import Contact
from ..cup import Cup
from ..io.joint_file import JointFile
from ..joint import Joint
from ..validity import OutsideDomainError

_POINTS = numpy.linspace(0.0, 1.0, 33) ** 1.5


def pressed(file: JointFile, names: tuple[str, ...]) -> Comparison:
    """Some models beside each other."""
    return _pressed(file.joint, file.cup, tuple(file.load.items()), names)


@lru_cache(maxsize=64)
def _pressed(joint: Joint, cup: Cup, load: tuple[tuple[str, float], ...], names: tuple[str, ...]) -> Comparison:
    return compare(joint, models={name: catalogue[name] for name in names}, cup=cup, **dict(load))


@lru_cache(maxsize=256)
def curve(joint: Joint, name: str, largest: float) -> Contact | None:
    """A model from first touch to the largest force; None outside its domain."""
    try:
        return catalogue[name].press(joint, force=largest * _POINTS)
    except OutsideDomainError:
        return None


def rounded_up(value: float) -> float:
    """The next of 1, 1.5, 2, 3, 5, 7 times a power of ten: an axis that stays while a slider moves."""
    if not value > 0:
        return 1.0
    scale = 10.0 ** (ceil(log10(value)) - 1)
    return float(next(step * scale for step in (1, 1.5, 2, 3, 5, 7, 10, 15) if step * scale >= value * (1 - 1e-12)))
