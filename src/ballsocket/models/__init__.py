"""The closed forms, and the plane layer: what answers to `press` without a solver."""

from .adhesion import AdhesiveSocket
from .base import Model
from .foundation import Bartel, BondedLayer, BondedLayerExact, CosineLimit, HessForsbach, Vessel
from .half_space import Hertz, Steuermann
from .liu import LiuReconstruction
from .plane_layer import PlaneLayer
from .refined import Refined

every: tuple[Model, ...] = (
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
