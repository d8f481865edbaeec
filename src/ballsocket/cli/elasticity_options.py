"""Options of the models of linear elasticity: finite elements (`fem`) and loads off the cup's axis (`sphere`)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import degrees
from typing import TYPE_CHECKING, Annotated, Any, Self

import typer

from ..core.checks import require
from ..files.schema import Angle, FileTable, Length, Word, meaning
from ..files.units import as_given
from ..model_catalogue import JUDGE, OFF_AXIS
from ..problem.cup import AngleDefinition, Cup
from ..question import DEFAULT_MODEL
from .options import complete_model

ModelNames = Annotated[
    list[str] | None,
    typer.Option(
        help="Name of a model (see `ballsocket models`), fem, sphere, or FILE.py:NAME for a custom model. Repeat for "
        f"several. Default: {DEFAULT_MODEL}, or {OFF_AXIS} for a tilted load or a preloaded joint.",
        autocompletion=complete_model,
    ),
]

Yielding = Annotated[
    bool,
    typer.Option(
        "--plastic", help=f"Let the liner yield, by its hardening or yield stress, in finite elements ({JUDGE})."
    ),
]

if TYPE_CHECKING:
    from ..elasticity.finite_elements.model import FiniteElement
    from ..elasticity.finite_elements.spacing import Spacing
    from ..elasticity.off_axis.model import Sphere


class ElementSize(Length):
    """Size of the elements in mm."""

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        size = super().read(name, value)
        require(name, float(size), size > 0, "an element's size (mm) is above 0")
        return size


class ElementName(Word):
    """Type of the elements."""

    choices = ("biquadratic", "bilinear")


class MeshTable(FileTable, frozen=True, kw_only=True):
    """Finite-element mesh."""

    element_size: Annotated[
        ElementSize | None, meaning("element size in the contact", example="0.05 mm", default="from the contact size")
    ] = None
    element: Annotated[ElementName | None, meaning("element type", default="biquadratic")] = None

    def model(self, meshes: int, plastic: bool) -> FiniteElement:
        """Return the finite-element model, on one mesh or on two for error estimates, with a liner that may yield."""
        from ..elasticity.finite_elements.model import FiniteElement
        from ..elasticity.finite_elements.spacing import Adapted, Element, Uniform

        element = Element[(self.element or "biquadratic").upper()]
        spacing: Spacing = Adapted() if self.element_size is None else Uniform(size=float(self.element_size))
        return FiniteElement(spacing=spacing, element=element, meshes=meshes, plastic=plastic)


def refuse_mesh_options(options: Mapping[str, Any]) -> None:
    """Raise ValueError for options of the finite elements that are used without this model."""
    for name, value in options.items():
        if value is not None:
            raise ValueError(f"--{name.replace('_', '-')} is for the finite elements: add --model {JUDGE}")


@contextmanager
def solver_progress(name: str) -> Iterator[None]:
    """Show the progress of a solver on stderr."""
    from rich.console import Console

    from ..elasticity.finite_elements.progress import progress_to

    status = Console(stderr=True).status(name)
    with status, progress_to(lambda text: status.update(f"{name}: {text}")):
        yield


class RingTable(FileTable, frozen=True, kw_only=True):
    """Rings of the model `sphere`."""

    ring_width: Annotated[
        Angle | None, meaning("width of its rings; finer is slower and more exact", default="2 deg")
    ] = None

    def refuse(self) -> None:
        """Raise ValueError for options of `sphere` that are used without this model."""
        if self.ring_width is not None:
            raise ValueError(f"--ring-width is for contact on the sphere: add --model {OFF_AXIS}, or a --tilt")

    def model(self) -> Sphere | None:
        """Return the model `sphere` with the ring width of the options; None for the model of the catalogue."""
        if self.ring_width is None:
            return None
        from ..elasticity.off_axis.model import Sphere

        with as_given({"ring_width": self.ring_width.written}):
            return Sphere(ring_width=float(self.ring_width))


def orientation_summary(cup: Cup) -> dict[str, dict[str, float]]:
    """Return the angles of a cup in the body in every definition, for JSON; empty without an orientation."""
    names = ("inclination_deg", "anteversion_deg")
    angles = {definition.value: map(degrees, cup.angles(definition)) for definition in AngleDefinition}
    return {name: dict(zip(names, pair, strict=True)) for name, pair in angles.items()} if cup.oriented else {}


def orientation_remark(cup: Cup) -> str:
    """Return one line with the angles of a cup in the body in every definition."""
    angles = orientation_summary(cup)
    texts = (f"{name} {pair['inclination_deg']:.4g}°/{pair['anteversion_deg']:.4g}°" for name, pair in angles.items())
    return f"cup: inclination/anteversion {', '.join(texts)}, {cup.side.value} side"
