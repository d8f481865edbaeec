"""The words of the finite elements, and how their work is shown while it lasts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Annotated, Any

import typer
from rich.console import Console

from ..catalogue import judge
from ..contact.describe import COLUMNS
from ..contact.per_joint import SolvedContact
from ..core.checks import known_name, require
from ..core.kinds import Kind
from ..core.quantities import CONTACT, LOADS
from ..elasticity.finite_elements.contact import MeshedContact
from ..elasticity.finite_elements.model import FiniteElement
from ..elasticity.finite_elements.progress import progress_to
from ..elasticity.finite_elements.spacing import Adapted, Element, Spacing, Uniform
from ..files.joint_file import read_cup
from ..files.units import parse
from ..problem.cup import Cup
from .words import given


@dataclass(frozen=True, kw_only=True)
class CupWords:
    """What a cup is, where it differs from that of the joint's file."""

    arc_of_cover: Annotated[str | None, typer.Option(help="From rim to rim, '180 deg'")] = None
    chamfer: Annotated[str | None, typer.Option(help="Of the rim's inner edge, '1 mm'")] = None
    interface: Annotated[str | None, typer.Option(help="Liner 'bonded' or 'sliding' on its backing")] = None

    def on(self, cup: Cup) -> Cup:
        """The cup with what the words say of it."""
        words = given(vars(self))
        asked = read_cup(words)
        return replace(cup, **{name: getattr(asked, name) for name in words})


@dataclass(frozen=True, kw_only=True)
class MeshWords:
    """How a joint is meshed."""

    element_size: Annotated[str | None, typer.Option(help="'0.05 mm'; without it, what the contact needs")] = None
    element: Annotated[str | None, typer.Option(help="'biquadratic' or 'bilinear'")] = None

    def model(self, cup: Cup, meshes: int) -> FiniteElement:
        """Finite elements of a cup, on so many meshes."""
        return FiniteElement(cup=cup, spacing=self._spacing(), element=self._element(), meshes=meshes)

    @property
    def size(self) -> float | None:
        """The size of the elements in mm, where it was given."""
        if self.element_size is None:
            return None
        length = parse("element_size", self.element_size, Kind.LENGTH)
        require("element_size", length, length > 0, "an element's size (mm) is above 0")
        return length

    def _spacing(self) -> Spacing:
        return Adapted() if self.size is None else Uniform(size=self.size)

    def _element(self) -> Element:
        known = {element.name.lower(): element for element in Element}
        return Element.BIQUADRATIC if self.element is None else known[known_name("element", self.element, known)]


def refuse(words: Mapping[str, Any]) -> None:
    """Raise ValueError for words that only the finite elements understand, where these are not asked."""
    for name, word in words.items():
        if word is not None:
            raise ValueError(f"--{name.replace('_', '-')} is for the finite elements: add --model {judge.name}")


def timed(model: FiniteElement, joint: Any, load: Mapping[str, float]) -> tuple[MeshedContact, float]:
    """One contact, and the seconds that it took; on stderr is shown what is being done, where somebody looks."""
    start = perf_counter()
    status = Console(stderr=True).status("finite elements")
    with status, progress_to(lambda text: status.update(f"finite elements: {text}")):
        contact: Any = model.press(joint, **load)
        _ = [column.values_of(contact) for column in COLUMNS]
    return contact, perf_counter() - start


def remark(contact: MeshedContact, seconds: float) -> str:
    """Mesh, time and the errors of the mesh in a line."""
    if contact.status.failed or contact.indentation == 0:
        return f"fem: {seconds:.2f} s"
    size = contact.mesh
    mesh = f"fem: {size.elements} elements, {size.element_size:.3g} mm at the contact, {seconds:.2f} s"
    bars = error_bars(contact)
    return f"{mesh}; error of the mesh: {bars}" if bars else f"{mesh}; error of the mesh not estimated"


def error_bars(contact: SolvedContact) -> str:
    """The estimated errors of what the load leaves open and of the largest pressure, in a line."""
    told = (*LOADS, "max_pressure")
    return ", ".join(
        f"{CONTACT[name].symbol} ±{100 * error:.1g} %"
        for name, error in contact.error.items()
        if name in told and error > 1e-9
    )
