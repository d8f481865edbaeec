"""The words of the finite elements, and how their work is shown while it lasts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from rich.console import Console

from ..catalogue import judge
from ..checks import nearest, require
from ..contact import Contact
from ..cup import Cup
from ..describe import COLUMNS
from ..fem.contact import MeshedContact
from ..fem.model import FiniteElement
from ..fem.progress import listening
from ..fem.spacing import Adapted, Element, Spacing, Uniform
from ..io.joint_file import read_cup
from ..io.units import parse
from ..output import section_plot
from ..output.save import check_format, save

Words = Mapping[str, str | None]

CUP = ("arc_of_cover", "chamfer", "interface")


@dataclass(frozen=True, kw_only=True)
class Output:
    """Files that are asked for: a figure of the section, and its fields for ParaView."""

    section: Path | None
    vtk: Path | None

    def check(self) -> None:
        """Raise ValueError for an ending that is not written."""
        if self.section is not None:
            check_format(self.section)
        if self.vtk is not None:
            from ..fem.export.vtk import check_suffix

            check_suffix(self.vtk)

    def write(self, contact: Contact, exact: Contact | None) -> None:
        """Write what was asked for."""
        if not isinstance(contact, MeshedContact) or contact.status.failed or contact.indentation == 0:
            if self.section is not None or self.vtk is not None:
                Console(stderr=True).print("ballsocket: without a contact there is nothing to draw or write")
            return
        if self.section is not None:
            save(section_plot.section_figure(contact, exact), self.section)
        if self.vtk is not None:
            from ..fem.export.vtk import write_vtk

            write_vtk(contact.section, self.vtk)


def check_asked(words: Mapping[str, Any], asked: bool) -> None:
    """Raise ValueError where words are given that only the finite elements understand, and these are not asked."""
    names = [name for name, word in words.items() if word is not None]
    if names and not asked:
        option = names[0].replace("_", "-")
        raise ValueError(f"--{option} is for the finite elements: add --model {judge.name}")


def finite_elements(words: Words, cup: Cup) -> FiniteElement:
    """The model that the words ask for, on a joint file's cup unless they say otherwise."""
    own = {name: words[name] for name in CUP if words[name] is not None}
    asked = read_cup(own)
    return FiniteElement(
        cup=replace(cup, **{name: getattr(asked, name) for name in own}),
        spacing=_spacing(words["element_size"]),
        element=_element(words["element"]),
        meshes=int(words["meshes"] or 2),
    )


def _spacing(size: str | None) -> Spacing:
    if size is None:
        return Adapted()
    length = parse("element_size", size, "length")
    require("element_size", length, length > 0, "an element's size (mm) is above 0")
    return Uniform(size=length)


def _element(name: str | None) -> Element:
    known = {element.name.lower(): element for element in Element}
    if name is not None and name not in known:
        raise ValueError(f"element {name!r} is not known{nearest(name, known)}")
    return Element.BIQUADRATIC if name is None else known[name]


def timed(model: FiniteElement, joint: Any, load: Mapping[str, float]) -> tuple[MeshedContact, float]:
    """One contact, and the seconds that it took; on stderr is shown what is being done, where somebody looks."""
    start = perf_counter()
    status = Console(stderr=True).status("finite elements")
    with status, listening(lambda text: status.update(f"finite elements: {text}")):
        contact: Any = model.press(joint, **load)
        _ = [column.of(contact) for column in COLUMNS]
    return contact, perf_counter() - start


def remark(contact: MeshedContact, seconds: float) -> str:
    """Mesh, time and error bars in a line."""
    if contact.status.failed or contact.indentation == 0:
        return f"fem: {seconds:.2f} s"
    size = contact.mesh
    mesh = f"fem: {size.elements} elements, {size.element_size:.3g} mm at the contact, {seconds:.2f} s"
    names = {"indentation": "d", "half_angle": "ε", "max_pressure": "pmax", "force": "F"}
    bars = ", ".join(
        f"{names[name]} ±{100 * error:.1g} %" for name, error in contact.error.items() if name in names and error > 1e-9
    )
    return f"{mesh}; {bars}" if bars else f"{mesh}; errors not estimated"
