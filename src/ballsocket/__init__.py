"""ballsocket: contact of a ball in a socket of nearly its own radius.

    import ballsocket as bs
    hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    contact.max_pressure

Lengths are in mm, forces in N, moduli and pressures in MPa, angles in rad.
"""

from .catalogue import catalogue
from .compare import compare
from .contact import Contact
from .cup import Cup, Interface, Side
from .elastic.exact import Exact
from .elastic.tabulated.model import Tabulated
from .fem.model import FiniteElement
from .fem.spacing import Adapted, Element, Uniform
from .gaps import CircularGap, LinearGap
from .identify.modulus import as_constant, as_corrected_vessel, as_polynomial, calibrate
from .io.joint_file import read_joint
from .joint import Joint, Layer, Material, Support
from .model import Model
from .models.adhesion import AdhesiveSocket
from .models.closed_form import ClosedForm
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
from .models.pin_in_hole import PinInHole
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
    "Side",
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
