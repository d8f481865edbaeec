"""Catalogue of the models by name."""

from __future__ import annotations

from collections import UserDict
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pkgutil import resolve_name
from typing import Any, TypeVar

from .contact import Model, ModelInfo
from .contact.model import RimLimited
from .core.checks import NamedItems, known_name
from .problem.gaps import GAP_KINDS

_MODELS = {
    "exact": "elasticity.exact.model:Exact",
    "tabulated": "elasticity.exact.tabulated.model:Tabulated",
    "refined": "models.refined:Refined",
    "hess-forsbach": "models.foundation:HessForsbach",
    "vessel": "models.foundation:Vessel",
    "bartel": "models.foundation:Bartel",
    "bonded-layer": "models.foundation:BondedLayer",
    "bonded-layer-exact": "models.foundation:BondedLayerExact",
    "cosine-limit": "models.foundation:CosineLimit",
    "hertz": "models.half_space:Hertz",
    "steuermann": "models.half_space:Steuermann",
    "plane-layer": "models.plane_layer:PlaneLayer",
    "liu-reconstruction": "models.half_space:LiuReconstruction",
    "adhesive": "models.adhesion:AdhesiveSocket",
}
"""Module and class of each model that presses in milliseconds or less, by its name."""

JUDGE = "fem"  # name of the finite-element model; slow, therefore not in the catalogue
OFF_AXIS = "sphere"  # name of the elastic solution for loads in any direction; slow, therefore not in the catalogue

_SLOW_MODELS = {
    JUDGE: "elasticity.finite_elements.model:FiniteElement",
    OFF_AXIS: "elasticity.off_axis.model:Sphere",
}


@cache
def _load_model(entry: str) -> Any:
    """Import the module of an entry such as "models.refined:Refined", and return a model of its class."""
    return resolve_name(f"{__package__}.{entry}")()


SomeInfo = TypeVar("SomeInfo", bound=ModelInfo)


class Models(UserDict[str, SomeInfo]):
    """Models by name; the module of a model is imported when the model is first used."""

    def __init__(self, entries: Mapping[str, str]) -> None:
        self.data: NamedItems[Any] = NamedItems("model", entries)

    def __getitem__(self, name: str) -> SomeInfo:
        entry = self.data[name]
        return _load_model(entry) if isinstance(entry, str) else entry

    def _repr_html_(self) -> str:
        return NamedItems("model", self)._repr_html_()


catalogue: Models[Model] = Models(_MODELS)
"""Models that press in milliseconds or less, by the name that files and the option `--model` use."""

named_models: Models[Model] = Models(
    {**_MODELS, "exact-curve": "elasticity.exact.exact_curve:ExactCurve", **_SLOW_MODELS}
)
"""Models by the names that files and the command line use."""

listed_models: Models[ModelInfo] = Models({**_MODELS, **_SLOW_MODELS, "pin-in-hole": "models.pin_in_hole:PinInHole"})
"""Models that are listed and cited: the catalogue, the slow models, and the plane model of a pin in a hole."""

reference = catalogue["exact"]
"""Exact elastic solution, the reference of every accuracy."""


def named_model(name: Any) -> Model:
    """Return a model by its name.

    Raises ValueError: a name that is not known; the message suggests the nearest one.
    """
    return named_models[known_name("model", name, named_models)]


SomeModel = TypeVar("SomeModel", bound=Model)


def with_yielding(model: SomeModel) -> SomeModel:
    """Return the finite elements with a liner that yields; ValueError for another model."""
    if not hasattr(model, "plastic"):
        raise ValueError(f"{model.name} has no liner that yields: use {JUDGE}")
    return replace(model, plastic=True)  # type: ignore[type-var]


def with_gap(model: SomeModel, name: str | None) -> SomeModel:
    """Return a model with the gap of a name, "linear" or "circular"; None leaves the model as it is.

    Raises ValueError: an unknown name, or a model that has one gap only.
    """
    if name is None:
        return model
    kind = GAP_KINDS[known_name("gap", name, GAP_KINDS)]
    if isinstance(model, RimLimited):
        return replace(model, model=with_gap(model.model, name))
    if not hasattr(model, "gap"):
        choices = [known for known, other in named_models.items() if hasattr(other, "gap")]
        raise ValueError(f"{model.name} has no choice of the gap; models with one: {', '.join(choices)}")
    return replace(model, gap=kind)  # type: ignore[type-var]
