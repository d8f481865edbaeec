"""ballsocket: contact of a ball in a socket of nearly its own radius.

    import ballsocket as bs
    hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    contact.max_pressure

Lengths are in mm, forces in N, moduli and pressures in MPa, angles in rad.
"""

from . import studies
from .catalogue import catalogue
from .compare import compare
from .contact import Contact
from .cup import Cup, Interface, Side
from .dynamics.element import ForceElement
from .elastic.exact import Exact
from .elastic.exact_curve import ExactCurve
from .elastic.tabulated.model import Tabulated
from .fem.model import FiniteElement
from .fem.spacing import Adapted, Element, Uniform
from .gaps import CircularGap, LinearGap
from .identify import as_constant, as_corrected_vessel, as_polynomial, calibrate, identify
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
from .sphere import (
    ClosedShell,
    DepthTable,
    Orientations,
    Pinched,
    Preload,
    RealCup,
    Sphere,
    Springs,
    Worn,
    orient,
    read_scan,
)
from .studies.run import study
from .validity import OutsideDomainError, Range, Status
from .version import __version__ as __version__

__all__ = [  # noqa: RUF022, grouped as they are used
    # what is pressed
    "CircularGap",
    "Cup",
    "Interface",
    "Joint",
    "Layer",
    "LinearGap",
    "Material",
    "Side",
    "Support",
    "Worn",
    "Pinched",
    "DepthTable",
    "read_scan",
    "read_joint",
    # presets
    "joints",
    "materials",
    # questions and answers
    "Contact",
    "OutsideDomainError",
    "Range",
    "Status",
    "calibrate",
    "catalogue",
    "cite",
    "compare",
    "ForceElement",
    "identify",
    "Orientations",
    "orient",
    "studies",
    "study",
    # models
    "AdhesiveSocket",
    "Bartel",
    "BondedLayer",
    "BondedLayerExact",
    "CosineLimit",
    "Exact",
    "ExactCurve",
    "FiniteElement",
    "Sphere",
    "RealCup",
    "Preload",
    "ClosedShell",
    "Springs",
    "Hertz",
    "HessForsbach",
    "LiuReconstruction",
    "PlaneLayer",
    "Refined",
    "Steuermann",
    "Tabulated",
    "Vessel",
    # the plane relative
    "PinInHole",
    # what a model of one's own is made of
    "ClosedForm",
    "Model",
    "RadialFoundation",
    "as_constant",
    "as_corrected_vessel",
    "as_polynomial",
    "bonded_layer",
    "constant",
    "corrected_vessel",
    "cosine_kinematics",
    "exact_kinematics",
    "hess_forsbach",
    "linear_kinematics",
    "polynomial",
    "spherical_vessel",
    # meshes
    "Adapted",
    "Element",
    "Uniform",
    # the materials of the presets
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
]
