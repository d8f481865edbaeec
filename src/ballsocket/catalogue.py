"""Catalogue of the models by name."""

from __future__ import annotations

from typing import Any

from .contact import Model
from .contact.outcome import ModelInfo
from .core.checks import NamedItems, known_name
from .core.deprecation import renamed_names
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


__getattr__ = renamed_names(__name__, {"theories": "listed_models"})
