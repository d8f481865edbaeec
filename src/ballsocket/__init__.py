"""ballsocket: contact of a ball in a socket of nearly its own radius.

    import ballsocket as bs
    hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    contact.max_pressure

Lengths are in mm, forces in N, moduli and pressures in MPa, angles in rad.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .core.lazy import imported_names
from .reports.figure_files import register_plots
from .version import __version__ as __version__

if TYPE_CHECKING:
    from . import studies as studies
    from .comparison import compare
    from .contact import Contact, Model
    from .core.sources import Source, cite
    from .core.validity import OutsideDomainError, Range, Status
    from .dynamics.element import ForceElement
    from .elasticity.exact.exact_curve import ExactCurve
    from .elasticity.exact.model import Exact
    from .elasticity.exact.tabulated.model import Tabulated
    from .elasticity.finite_elements.model import FiniteElement
    from .elasticity.finite_elements.spacing import Adapted, Element, Uniform
    from .elasticity.off_axis.bore_shapes import BoreDeviation, DepthTable, OvalBore
    from .elasticity.off_axis.model import Sphere
    from .elasticity.off_axis.orientations import Orientations, orient
    from .elasticity.off_axis.preload import Preload, pull_out
    from .elasticity.off_axis.scans import read_scan
    from .elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
    from .files.joint_file import read_joint
    from .identification import as_constant, as_corrected_vessel, as_polynomial, calibrate, identify
    from .lubrication import Lubricant
    from .lubrication.film import film
    from .model_catalogue import catalogue
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
    from .models.half_space import Hertz, LiuReconstruction, Steuermann
    from .models.kinematics import cosine_kinematics, exact_kinematics, linear_kinematics
    from .models.modulus import bonded_layer, constant, corrected_vessel, hess_forsbach, polynomial, spherical_vessel
    from .models.pin_in_hole import PinInHole
    from .models.plane_layer import PlaneLayer
    from .models.refined import Refined
    from .problem import Joint, Layer, Material, Support
    from .problem.cup import AngleDefinition, Cup, Interface, Side
    from .problem.gaps import CircularGap, LinearGap
    from .problem.presets import (
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
    from .studies.run import study

register_plots()

__all__ = [  # noqa: RUF022, grouped by subject
    # problem
    "AngleDefinition",
    "CircularGap",
    "Cup",
    "Interface",
    "Joint",
    "Layer",
    "LinearGap",
    "Material",
    "Side",
    "Support",
    "BoreDeviation",
    "OvalBore",
    "DepthTable",
    "read_scan",
    "read_joint",
    # presets
    "joints",
    "materials",
    "Lubricant",
    # functions and results
    "Contact",
    "OutsideDomainError",
    "Range",
    "Status",
    "calibrate",
    "catalogue",
    "cite",
    "compare",
    "film",
    "ForceElement",
    "identify",
    "Orientations",
    "orient",
    "pull_out",
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
    # parts of custom models
    "ClosedForm",
    "Model",
    "RadialFoundation",
    "Source",
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

_HINTS = {
    "press": "press is a method of models, such as bs.Exact().press(joint, force=3000.0); "
    "bs.compare(joint, force=3000.0) presses with all models"
}
"""Sentences on names that users look for here."""

_DOORS = ("dynamics", "evidence", "export", "hip", "identification", "studies")
"""Subpackages for users, which are imported on first use."""

_NAMES_BY_MODULE = {
    "comparison": "compare",
    "contact": "Contact Model",
    "core.sources": "Source cite",
    "core.validity": "OutsideDomainError Range Status",
    "dynamics.element": "ForceElement",
    "elasticity.exact.exact_curve": "ExactCurve",
    "elasticity.exact.model": "Exact",
    "elasticity.exact.tabulated.model": "Tabulated",
    "elasticity.finite_elements.model": "FiniteElement",
    "elasticity.finite_elements.spacing": "Adapted Element Uniform",
    "elasticity.off_axis.bore_shapes": "BoreDeviation DepthTable OvalBore",
    "elasticity.off_axis.model": "Sphere",
    "elasticity.off_axis.orientations": "Orientations orient",
    "elasticity.off_axis.preload": "Preload pull_out",
    "elasticity.off_axis.scans": "read_scan",
    "elasticity.off_axis.surfaces": "ClosedShell RealCup Springs",
    "files.joint_file": "read_joint",
    "identification": "as_constant as_corrected_vessel as_polynomial calibrate identify",
    "lubrication": "Lubricant",
    "lubrication.film": "film",
    "model_catalogue": "catalogue",
    "models.adhesion": "AdhesiveSocket",
    "models.closed_form": "ClosedForm",
    "models.foundation": "Bartel BondedLayer BondedLayerExact CosineLimit HessForsbach RadialFoundation Vessel",
    "models.half_space": "Hertz LiuReconstruction Steuermann",
    "models.kinematics": "cosine_kinematics exact_kinematics linear_kinematics",
    "models.modulus": "bonded_layer constant corrected_vessel hess_forsbach polynomial spherical_vessel",
    "models.pin_in_hole": "PinInHole",
    "models.plane_layer": "PlaneLayer",
    "models.refined": "Refined",
    "problem": "Joint Layer Material Support",
    "problem.cup": "AngleDefinition Cup Interface Side",
    "problem.gaps": "CircularGap LinearGap",
    "problem.presets": "ALUMINA ALUMINA_COMPOSITE BONE_CEMENT CANCELLOUS_BONE COCR CORTICAL_BONE CROSSLINKED_PE POM "
    "STEEL STRUCTURAL_STEEL TITANIUM UHMWPE joints materials",
    "studies.run": "study",
}
"""Names for users by module. A module is imported on the first use of one of its names."""

_import_name = imported_names(__name__, _NAMES_BY_MODULE)

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import a name or a subpackage on first use."""
        if name in _HINTS:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}; {_HINTS[name]}")
        return import_module(f"{__name__}.{name}") if name in _DOORS else _import_name(name)


def __dir__() -> list[str]:
    """List the names for users; other modules of the package can still be imported."""
    return sorted({*__all__, *_DOORS, "__doc__", "__version__"})
