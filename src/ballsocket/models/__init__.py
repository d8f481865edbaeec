"""The catalogue: every model that answers to `press`, by name."""

from .adhesion import AdhesiveSocket
from .base import Model
from .foundation import Bartel, BondedLayer, BondedLayerExact, CosineLimit, HessForsbach, Vessel
from .half_space import Hertz, Steuermann
from .liu import LiuReconstruction
from .plane_layer import PlaneLayer

_ALL: tuple[Model, ...] = (
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

catalogue: dict[str, Model] = {model.name: model for model in _ALL}
"""Name -> model: what `--model` and files call them."""
