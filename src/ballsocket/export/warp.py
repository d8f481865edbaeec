"""Force element as functions of Warp, for Newton and MuJoCo Warp."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy

from ..contact.octave_curve import OctaveCurve
from ..core.checks import require
from ..dynamics.ball_centre import Constants
from ..dynamics.potential import CurvePotential, curve_potential
from .c_text import CURVE_SLOPES, Language
from .job import ExportJob, Texts
from .recording import ENERGY, Recording


def _warp_number(value: float) -> str:
    """Format a number as a literal of the type `real` of a module of Warp."""
    finite = math.isfinite(value)
    return f"real({value!r})" if finite else f"real({'-' if value < 0 else ''}wp.{'nan' if value != value else 'inf'})"


WARP = Language(
    number=_warp_number,
    operators={"&": "and", "|": "or"},
    formats={"where": "wp.where({}, {}, {})", "not": "not {}", "scaled_exp": "{0} * wp.exp({1})"},
    function="wp.{}",
    functions={"fabs": "wp.abs", "log1p": "log1p", "asinh": "asinh"},
    assignment={"int": "{} = {}", "double": "{} = {}", "target": "{} = {}"},
    curve="{2} = {0}(table, {1})",
)
"""Python that Warp compiles."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WarpRecording(Recording):
    """Recorded formulas of a force element with fixed parameters, whose energy is a fitted curve."""

    joint = None

    @cached_property
    def constants(self) -> Constants:
        """Constants of the force element."""
        return self.element.constants

    @cached_property
    def curves(self) -> dict[str, OctaveCurve]:
        """Fitted curve of the energy, which needs no logarithm."""
        potential = self.element.potential
        if not isinstance(potential, CurvePotential):
            potential = curve_potential(self.element.model, self.element.joint)
        return {ENERGY: potential.curve}


def warp_texts(job: ExportJob) -> Texts:
    """Return the text of the module of Warp, by file name.

    Raises ValueError: an element with a state; a preloaded joint.
    """
    job.c_program  # noqa: B018 - refuses names and elements that cannot be exported
    recording = WarpRecording(element=job.central_element, beyond=job.beyond)
    curve = recording.curves[ENERGY]
    require("density", curve.density, curve.density in (1, 2, 4, 8), "the number of pieces of an octave: 1, 2, 4 or 8")
    load = dict(zip(("fx", "fy", "fz", "mx", "my", "mz", "energy"), recording.load.values(), strict=True))
    tangent = {f"k{index}": part for index, part in enumerate(recording.tangent.values())}
    # rows: origin of a piece, its inverse width, and coefficients over the part of the width; the widths keep the
    # coefficients within the range of single precision
    _, exponent = numpy.frexp(curve.origins)
    width = numpy.ldexp(0.5 / curve.density, exponent)
    powers = numpy.arange(curve.coefficients.shape[1] - 1, -1, -1)[:, None]
    rows = numpy.column_stack([curve.origins, 1.0 / width, (curve.coefficients[0] * width**powers).T])
    return job.file(
        "warp.py.txt",
        load=WARP.statements(load, indent=8),
        tangent_statements=WARP.statements(tangent, indent=8),
        tangent=", ".join(tangent),
        rows=",\n".join(f"    {row}" for row in rows.tolist()),
        low=repr(curve.low),
        pieces=str(len(curve.origins)),
        terms=str(curve.coefficients.shape[1]),
        first=str(curve.first),
        density=str(curve.density),
        slopes=str(CURVE_SLOPES),
    )
