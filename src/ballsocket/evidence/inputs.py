"""What goes in: every number with its unit, tolerance and source, and what computes with them."""

from __future__ import annotations

import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from math import inf
from typing import Any

from ..core.quantities import JOINT, MATERIAL, QUANTITIES, STRESS_LIMITS
from ..problem import Material
from ..problem.dimensions import DIAMETERS, STORED_LENGTHS
from .question import Question

_LIBRARIES = ("numpy", "scipy", "scikit-fem", "array-api-compat", "matplotlib", "pillow")
DRAWING = ("matplotlib", "pillow", "freetype", "zlib")
"""Libraries that decide the bytes of a figure."""

STATED = ("python", "system", *_LIBRARIES, "freetype", "zlib")
"""Names of the entries in `made_with`."""


def inputs(question: Question) -> list[dict[str, Any]]:
    """Every number that goes in, with unit, tolerance and source."""
    joint = question.file.joint
    listed = [("joint", name, getattr(joint, name), JOINT[name].written.text, joint.source) for name in STORED_LENGTHS]
    listed += _material("liner", joint.liner) + _material("ball", joint.ball)
    for number, layer in enumerate(joint.backing):
        listed.append(("backing", f"backing[{number}].thickness", layer.thickness, "mm", joint.source))
        listed += _material("backing", layer.material, f"backing[{number}].")
    if question.friction is not None:
        listed.append(("friction", "friction.coefficient", question.friction, "", ""))
    return [
        {
            "name": name,
            "value": value if abs(value) < inf else "inf",
            "unit": unit,
            "tolerance": _tolerance(question, name),
            "source": _source(question, name, part) or source,
        }
        for part, name, value, unit, source in listed
    ]


def _material(part: str, material: Material | None, prefix: str = "") -> list[tuple[str, str, Any, str, str]]:
    """Part, name, value, unit and the preset's source of each number that is known."""
    if material is None:
        return []
    known = {name: getattr(material, name) for name in (*MATERIAL, *STRESS_LIMITS)}
    return [
        (part, f"{prefix or f'{part}_'}{name}", value, QUANTITIES[name].written.text, material.source)
        for name, value in known.items()
        if value is not None
    ]


def _source(question: Question, name: str, part: str) -> str:
    """Return the source that the question states for an input; empty without one."""
    recentred = {DIAMETERS.get(each.name, each.name) for each in question.recentred}
    by_tolerance = "nominal value of its tolerance in the question" if name in recentred else ""
    return question.sources.get(name) or by_tolerance or question.sources.get(part, "")


def _tolerance(question: Question, name: str) -> str:
    spreads = {DIAMETERS.get(each, each): (each, spread) for each, spread in question.tolerances.items()}
    if name not in spreads:
        varied = {DIAMETERS.get(each, each) for each in question.axes}
        return "varied in the matrix" if name in varied else ""
    stated, spread = spreads[name]
    share = 0.5 if stated in DIAMETERS else 1.0
    low, high = (share * float(spread.frozen.ppf(end)) for end in (0.0, 1.0))
    return f"{low:g} to {high:g}"


def made_with() -> dict[str, str]:
    """Return the machine and the versions of the libraries that compute and draw."""
    from matplotlib.ft2font import __freetype_version__
    from PIL import features

    versions = {}
    for name in _LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    drawing = {"freetype": __freetype_version__, "zlib": str(features.version("zlib"))}
    machine = f"{sys.platform} {platform.machine()}"
    return {"python": platform.python_version(), "system": machine, **versions, **drawing}
