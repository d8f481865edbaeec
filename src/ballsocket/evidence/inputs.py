"""What goes in: every number with its unit, tolerance and source, and what computes with them."""

from __future__ import annotations

import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from math import inf
from typing import Any

from ..joint import Material
from ..joint.dimensions import DIAMETERS, OWN
from ..quantities import JOINT, MATERIAL, QUANTITIES, STRENGTH
from .question import Question

_LIBRARIES = ("numpy", "scipy", "scikit-fem", "array-api-compat")


def inputs(question: Question) -> list[dict[str, Any]]:
    """Every number that goes in, with unit, tolerance and source."""
    joint = question.file.joint
    listed = [("joint", name, getattr(joint, name), JOINT[name].written.text, joint.source) for name in OWN]
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
            "source": question.sources.get(name) or question.sources.get(part) or source,
        }
        for part, name, value, unit, source in listed
    ]


def _material(part: str, material: Material | None, prefix: str = "") -> list[tuple[str, str, Any, str, str]]:
    """Part, name, value, unit and the preset's source of each number that is known."""
    if material is None:
        return []
    known = {name: getattr(material, name) for name in (*MATERIAL, *STRENGTH)}
    return [
        (part, f"{prefix or f'{part}_'}{name}", value, QUANTITIES[name].written.text, material.source)
        for name, value in known.items()
        if value is not None
    ]


def _tolerance(question: Question, name: str) -> str:
    spread = question.tolerances.get(name)
    if spread is None:
        varied = {DIAMETERS.get(each, each) for each in question.axes}
        return "varied in the matrix" if name in varied else ""
    low, high = (float(spread.frozen.ppf(share)) for share in (0.0, 1.0))
    return f"{low:g} to {high:g}"


def made_with() -> dict[str, str]:
    """Versions and machine."""
    versions = {}
    for name in _LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    return {"python": platform.python_version(), "system": f"{sys.platform} {platform.machine()}", **versions}
