"""Finite elements for a page: what a run of them does in its process."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from ..catalogue import judge, reference
from ..contact import Contact
from ..contact.describe import to_summary
from ..core.validity import OutsideDomainError
from ..elasticity.finite_elements.contact import MeshedContact
from ..files.joint_file import JointFile
from ..reports.figure_files import figure_bytes
from ..reports.section_plots import section_figure
from .running import Reached, Told

_SHARES = (0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What finite elements say: numbers as for JSON, beside the exact ones, and a picture as PNG and SVG."""

    numbers: dict[str, Any]
    error: dict[str, float]
    exact: dict[str, Any] | None
    elements: int
    seconds: float
    notes: tuple[str, ...]
    png: bytes
    svg: bytes


def judged(file: JointFile, told: Told) -> Judged:
    """The finite elements' answer to a joint with a load, pressed on to it in steps; tells `Reached` on the way.

    Raises
    ------
    ValueError
        There is no answer, and why.
    """
    start = time.perf_counter()
    model = judge.in_cup(file.cup)
    ((kind, load),) = file.load.items()
    told(Reached(share=0.05, words="making the meshes"))
    for share in _SHARES:
        contact = model.press(file.joint, **{kind: share * load})
        told(Reached(share=0.05 + 0.75 * share, words=f"pressed to {100 * share:g} % of the load"))
    if contact.status.failed:
        raise ValueError(f"the finite elements have no answer: {contact.status.sentence}")
    assert isinstance(contact, MeshedContact)
    exact = _exact(file)
    told(Reached(share=0.85, words="drawing stresses"))
    figure = section_figure(contact, exact)
    return Judged(
        numbers=to_summary(contact),
        error={name: float(value) for name, value in contact.error.items()},
        exact=None if exact is None else to_summary(exact),
        elements=contact.mesh.elements,
        seconds=time.perf_counter() - start,
        notes=tuple(contact.notes),
        png=figure_bytes(figure),
        svg=figure_bytes(figure, "svg"),
    )


def _exact(file: JointFile) -> Contact | None:
    try:
        contact = reference.press(file.joint, **file.load)
    except OutsideDomainError:
        return None
    return None if contact.status.failed else contact
