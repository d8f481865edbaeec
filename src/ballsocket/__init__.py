"""ballsocket: contact of a ball in a socket of nearly its own radius.

    import ballsocket as bs
    hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    contact.max_pressure

Lengths are in mm, forces in N, moduli and pressures in MPa, angles in rad.
"""

from .all_models import catalogue
from .calibrate import as_constant, as_corrected_vessel, as_polynomial, calibrate
from .compare import compare
from .contact import Contact
from .elastic.axisymmetric import Exact
from .elastic.table import Tabulated
from .fem.cup import Cup, Interface
from .fem.model import FiniteElement
from .fem.spacing import Adapted, Element, Uniform
from .files import read_joint
from .gaps import CircularGap, LinearGap
from .joint import Joint, Layer, Material, Support
from .models.adhesion import AdhesiveSocket
from .models.base import ClosedForm, Model
from .models.cylinder import PinInHole
from .models.foundation import (
    Bartel,
    BondedLayer,
    BondedLayerExact,
    CosineLimit,
    HessForsbach,
    RadialFoundation,
    Vessel,
)
from .models.half_space import Hertz, Steuermann
from .models.kinematics import cosine_kinematics, exact_kinematics, linear_kinematics
from .models.liu import LiuReconstruction
from .models.modulus import bonded_layer, constant, corrected_vessel, hess_forsbach, polynomial, spherical_vessel
from .models.plane_layer import PlaneLayer
from .models.refined import Refined
from .presets import (
    ALUMINA,
    ALUMINA_COMPOSITE,
    BONE_CEMENT,
    CANCELLOUS_BONE,
    COCR,
    CORTICAL_BONE,
    CROSSLINKED_PE,
    POM,
    STEEL,
    STRUCTURAL_STEEL,
    TITANIUM,
    UHMWPE,
    joints,
    materials,
)
from .sources import cite
from .studies.run import study
from .validity import Range, Status
from .version import __version__ as __version__

__all__ = [
    "ALUMINA",
    "ALUMINA_COMPOSITE",
    "BONE_CEMENT",
    "CANCELLOUS_BONE",
    "COCR",
    "CORTICAL_BONE",
    "CROSSLINKED_PE",
    "POM",
    "STEEL",
    "STRUCTURAL_STEEL",
    "TITANIUM",
    "UHMWPE",
    "Adapted",
    "AdhesiveSocket",
    "Bartel",
    "BondedLayer",
    "BondedLayerExact",
    "CircularGap",
    "ClosedForm",
    "Contact",
    "CosineLimit",
    "Cup",
    "Element",
    "Exact",
    "FiniteElement",
    "Hertz",
    "HessForsbach",
    "Interface",
    "Joint",
    "Layer",
    "LinearGap",
    "LiuReconstruction",
    "Material",
    "Model",
    "PinInHole",
    "PlaneLayer",
    "RadialFoundation",
    "Range",
    "Refined",
    "Status",
    "Steuermann",
    "Support",
    "Tabulated",
    "Uniform",
    "Vessel",
    "as_constant",
    "as_corrected_vessel",
    "as_polynomial",
    "bonded_layer",
    "calibrate",
    "catalogue",
    "cite",
    "compare",
    "constant",
    "corrected_vessel",
    "cosine_kinematics",
    "exact_kinematics",
    "hess_forsbach",
    "joints",
    "linear_kinematics",
    "materials",
    "polynomial",
    "read_joint",
    "spherical_vessel",
    "study",
]
