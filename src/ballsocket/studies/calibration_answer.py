"""Description of a calibration: the fitted modulus, its residual, and the error of the closed form that uses it."""

from __future__ import annotations

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.kinds import NEWTONS, PERCENT, PLAIN, Kind
from ..core.unit_systems import Amount, Sentence, joint_sentence
from .calibration import Calibration


def describe_calibration(fit: Calibration) -> Answer:
    """Describe a fitted modulus with its residual and the error of the closed form that uses it."""
    foundation = Kind.FOUNDATION.written
    unit = foundation if fit.modulus.name == "constant" else PLAIN
    amounts = [(fit.modulus.name, Amount(constant, unit, 6)) for constant in map(float, fit.modulus.constants)]
    ends = dict.fromkeys([float(numpy.min(fit.wanted)), float(numpy.max(fit.wanted))])
    amounts += [("K = p0/d of the reference", Amount(end, foundation, 5)) for end in ends]
    low, high = (Amount(float(end), NEWTONS) for end in (fit.force.min(), fit.force.max()))
    shares = {
        Sentence("spread over {} to {}", low, high): fit.spread,
        "largest residual of the fit": float(numpy.max(abs(fit.residual))),
    }
    shares |= {f"closed form, worst error in {name.replace('_', ' ')}": error for name, error in fit.error.items()}
    amounts += [(title, Amount(share, PERCENT, 3)) for title, share in shares.items()]
    columns = [Column.of_words("number"), Column.of_number("value")]
    return Answer(
        title=joint_sentence(fit.joint),
        tables=[Table("calibration", "Calibration", columns, [Row(cells) for cells in amounts])],
    )
