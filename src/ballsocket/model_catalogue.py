"""Catalogue of the models by name."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from .contact import Model
from .contact.model import RimLimited
from .contact.outcome import ModelInfo
from .core.checks import NamedItems, known_name
from .elasticity.exact.exact_curve import ExactCurve
from .elasticity.exact.model import Exact
from .elasticity.exact.tabulated.model import Tabulated
from .elasticity.finite_elements.model import FiniteElement
from .elasticity.off_axis.model import Sphere
from .models.adhesion import AdhesiveSocket
from .models.foundation import Bartel, BondedLayer, BondedLayerExact, CosineLimit, HessForsbach, Vessel
from .models.half_space import Hertz, LiuReconstruction, Steuermann
from .models.pin_in_hole import PinInHole
from .models.plane_layer import PlaneLayer
from .models.refined import Refined
from .problem.gaps import GAP_KINDS

reference: Model = Exact()
"""Exact elastic solution, the reference of every accuracy."""

judge: Model = FiniteElement()
"""Finite-element model; slow, therefore not in the catalogue."""

off_axis: Sphere = Sphere()
"""Elastic solution for loads in any direction; slow, therefore not in the catalogue."""

_MODELS: tuple[Model, ...] = (
    reference,
    Tabulated(),
    Refined(),
    HessForsbach(),
    Vessel(),
    Bartel(),
    BondedLayer(),
    BondedLayerExact(),
    CosineLimit(),
    Hertz(),
    Steuermann(),
    PlaneLayer(),
    LiuReconstruction(),
    AdhesiveSocket(),
)

catalogue: dict[str, Model] = NamedItems("model", {model.name: model for model in _MODELS})
"""Models that press in milliseconds or less, by the name that files and the option `--model` use."""

named_models: dict[str, Model] = {**catalogue, "exact-curve": ExactCurve(), judge.name: judge, off_axis.name: off_axis}
"""Models by the names that files and the command line use."""

listed_models: dict[str, ModelInfo] = {model.name: model for model in (*_MODELS, judge, off_axis, PinInHole())}
"""Models that are listed and cited: the catalogue, the slow models, and the plane model of a pin in a hole."""


def named_model(name: Any) -> Model:
    """Return a model by its name.

    Raises
    ------
    ValueError
        A name that is not known; the message suggests the nearest one.
    """
    return named_models[known_name("model", name, named_models)]


def with_gap(model: Model, name: str | None) -> Model:
    """Return a model with the gap of a name, "linear" or "circular"; None leaves the model as it is.

    Raises
    ------
    ValueError
        An unknown name, or a model that has one gap only.
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
