"""Finite elements of a pressed joint, computed in a separate process."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy

from ....contact import Contact
from ....contact.describe import to_summary
from ....core.validity import OutsideDomainError
from ....elasticity.finite_elements.model import MeshedContact
from ....files.joint_file import JointFile
from ....model_catalogue import JUDGE, named_models, reference
from ....reports.figure_files import figure_bytes
from ....reports.section_plots import section_figure
from ...pressing import profile
from ...running import Reached, Report
from .charts import SectionDrawing, section_drawing

_LOAD_STEPS = (0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, kw_only=True)
class ElementResult:
    """Result of finite elements as for JSON, beside the exact one, with drawings for the page and for files.

    `pressures` are angles (rad) and pressures (MPa) by model.
    """

    file: JointFile
    numbers: dict[str, Any]
    error: dict[str, float]
    exact: dict[str, Any] | None
    elements: int
    seconds: float
    notes: tuple[str, ...]
    drawing: SectionDrawing
    pressures: dict[str, tuple[numpy.ndarray, numpy.ndarray]]
    png: bytes
    svg: bytes


def run_finite_elements(file: JointFile, report: Report) -> ElementResult:
    """Press a joint in load steps by finite elements, and report progress as `Reached`."""
    start = time.perf_counter()
    model = named_models[JUDGE].in_cup(file.cup, **file.aim)
    ((kind, load),) = file.load.items()
    report(Reached(share=0.05, words="making the meshes"))
    for share in _LOAD_STEPS:
        contact = model.press(file.joint, **{kind: share * load})
        report(Reached(share=0.05 + 0.75 * share, words=f"pressed to {100 * share:g} % of the load"))
    if contact.status.failed:
        raise ValueError(f"the finite elements have no result: {contact.status.sentence}")
    assert isinstance(contact, MeshedContact)
    exact = _exact(file)
    report(Reached(share=0.85, words="drawing stresses"))
    figure = section_figure(contact, exact)
    contacts = {JUDGE: contact, reference.name: exact}
    return ElementResult(
        file=file,
        numbers=to_summary(contact),
        error={name: float(value) for name, value in contact.error.items()},
        exact=None if exact is None else to_summary(exact),
        elements=contact.mesh.elements,
        seconds=time.perf_counter() - start,
        notes=tuple(contact.notes),
        drawing=section_drawing(contact),
        pressures={name: profile(pressed) for name, pressed in contacts.items() if pressed is not None},
        png=figure_bytes(figure),
        svg=figure_bytes(figure, "svg"),
    )


def _exact(file: JointFile) -> Contact | None:
    try:
        contact = reference.press(file.joint, **file.load)
    except OutsideDomainError:
        return None
    return None if contact.status.failed else contact
