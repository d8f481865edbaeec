"""The catalogue: every model that answers to `press`, by name."""

from __future__ import annotations

from .contact import Model
from .contact.model_info import ModelInfo
from .core.checks import NamedItems
from .elasticity.exact.model import Exact
from .elasticity.exact.tabulated.model import Tabulated
from .elasticity.finite_elements.model import FiniteElement
from .elasticity.off_axis.model import Sphere
from .models.adhesion import AdhesiveSocket
from .models.foundation import Bartel, BondedLayer, BondedLayerExact, CosineLimit, HessForsbach, Vessel
from .models.half_space import Hertz, Steuermann
from .models.liu import LiuReconstruction
from .models.pin_in_hole import PinInHole
from .models.plane_layer import PlaneLayer
from .models.refined import Refined

reference: Model = Exact()
"""What every other model is measured by."""

judge: Model = FiniteElement()
"""The finite elements: asked by name, not along with the others."""

off_axis: Sphere = Sphere()
"""Full elasticity for loads in any direction: asked by name, or where a load is tilted."""

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
"""Name -> model: what `--model` and files call them, all of them answering in milliseconds or less."""

listed_models: dict[str, ModelInfo] = {theory.name: theory for theory in (*_MODELS, judge, off_axis, PinInHole())}
"""Name -> all that is listed and cited: the catalogue, the judge, and the plane relative, which knows no force."""
