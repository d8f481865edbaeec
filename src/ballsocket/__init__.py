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
    from .comparison import compare as compare
    from .contact import Contact as Contact
    from .contact import Model as Model
    from .core.sources import Source as Source
    from .core.sources import cite as cite
    from .core.validity import OutsideDomainError as OutsideDomainError
    from .core.validity import Range as Range
    from .core.validity import Status as Status
    from .dynamics.element import ForceElement as ForceElement
    from .elasticity.exact.exact_curve import ExactCurve as ExactCurve
    from .elasticity.exact.model import Exact as Exact
    from .elasticity.exact.tabulated.model import Tabulated as Tabulated
    from .elasticity.finite_elements.model import FiniteElement as FiniteElement
    from .elasticity.finite_elements.spacing import Adapted as Adapted
    from .elasticity.finite_elements.spacing import Element as Element
    from .elasticity.finite_elements.spacing import Uniform as Uniform
    from .elasticity.off_axis.bore_shapes import BoreDeviation as BoreDeviation
    from .elasticity.off_axis.bore_shapes import DepthTable as DepthTable
    from .elasticity.off_axis.bore_shapes import OvalBore as OvalBore
    from .elasticity.off_axis.model import Sphere as Sphere
    from .elasticity.off_axis.orientations import Orientations as Orientations
    from .elasticity.off_axis.orientations import orient as orient
    from .elasticity.off_axis.preload import Preload as Preload
    from .elasticity.off_axis.preload import pull_out as pull_out
    from .elasticity.off_axis.scans import read_scan as read_scan
    from .elasticity.off_axis.surfaces import ClosedShell as ClosedShell
    from .elasticity.off_axis.surfaces import RealCup as RealCup
    from .elasticity.off_axis.surfaces import Springs as Springs
    from .files.joint_file import read_joint as read_joint
    from .identification import as_constant as as_constant
    from .identification import as_corrected_vessel as as_corrected_vessel
    from .identification import as_polynomial as as_polynomial
    from .identification import calibrate as calibrate
    from .identification import identify as identify
    from .lubrication import Lubricant as Lubricant
    from .lubrication.film import film as film
    from .model_catalogue import catalogue as catalogue
    from .models.adhesion import AdhesiveSocket as AdhesiveSocket
    from .models.closed_form import ClosedForm as ClosedForm
    from .models.foundation import Bartel as Bartel
    from .models.foundation import BondedLayer as BondedLayer
    from .models.foundation import BondedLayerExact as BondedLayerExact
    from .models.foundation import CosineLimit as CosineLimit
    from .models.foundation import HessForsbach as HessForsbach
    from .models.foundation import RadialFoundation as RadialFoundation
    from .models.foundation import Vessel as Vessel
    from .models.half_space import Hertz as Hertz
    from .models.half_space import LiuReconstruction as LiuReconstruction
    from .models.half_space import Steuermann as Steuermann
    from .models.kinematics import cosine_kinematics as cosine_kinematics
    from .models.kinematics import exact_kinematics as exact_kinematics
    from .models.kinematics import linear_kinematics as linear_kinematics
    from .models.modulus import bonded_layer as bonded_layer
    from .models.modulus import constant as constant
    from .models.modulus import corrected_vessel as corrected_vessel
    from .models.modulus import hess_forsbach as hess_forsbach
    from .models.modulus import polynomial as polynomial
    from .models.modulus import spherical_vessel as spherical_vessel
    from .models.pin_in_hole import PinInHole as PinInHole
    from .models.plane_layer import PlaneLayer as PlaneLayer
    from .models.refined import Refined as Refined
    from .problem import Joint as Joint
    from .problem import Layer as Layer
    from .problem import Material as Material
    from .problem import Support as Support
    from .problem.cup import AngleDefinition as AngleDefinition
    from .problem.cup import Cup as Cup
    from .problem.cup import Interface as Interface
    from .problem.cup import Side as Side
    from .problem.gaps import CircularGap as CircularGap
    from .problem.gaps import LinearGap as LinearGap
    from .problem.hardening import Hardening as Hardening
    from .problem.presets import ALUMINA as ALUMINA
    from .problem.presets import ALUMINA_COMPOSITE as ALUMINA_COMPOSITE
    from .problem.presets import BONE_CEMENT as BONE_CEMENT
    from .problem.presets import CANCELLOUS_BONE as CANCELLOUS_BONE
    from .problem.presets import COCR as COCR
    from .problem.presets import CORTICAL_BONE as CORTICAL_BONE
    from .problem.presets import CROSSLINKED_PE as CROSSLINKED_PE
    from .problem.presets import PEEK as PEEK
    from .problem.presets import POM as POM
    from .problem.presets import PTFE as PTFE
    from .problem.presets import STEEL as STEEL
    from .problem.presets import STRUCTURAL_STEEL as STRUCTURAL_STEEL
    from .problem.presets import TITANIUM as TITANIUM
    from .problem.presets import UHMWPE as UHMWPE
    from .problem.presets import joints as joints
    from .problem.presets import materials as materials
    from .studies.run import study as study

register_plots()

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
    "problem.hardening": "Hardening",
    "problem.presets": "ALUMINA ALUMINA_COMPOSITE BONE_CEMENT CANCELLOUS_BONE COCR CORTICAL_BONE CROSSLINKED_PE PEEK "
    "POM PTFE STEEL STRUCTURAL_STEEL TITANIUM UHMWPE joints materials",
    "studies.run": "study",
}
"""Names for users by module. A module is imported on the first use of one of its names."""

__all__ = ["studies", *(name for names in _NAMES_BY_MODULE.values() for name in names.split())]

_import_name = imported_names(__name__, _NAMES_BY_MODULE)

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Import a name or a subpackage on first use."""
        if name == "press":
            raise AttributeError(
                f"module {__name__!r} has no attribute 'press'; press is a method of models, such as "
                "bs.Exact().press(joint, force=3000.0); bs.compare(joint, force=3000.0) presses with all models"
            )
        return import_module(f"{__name__}.{name}") if name in _DOORS else _import_name(name)


def __dir__() -> list[str]:
    """List the names for users; other modules of the package can still be imported."""
    return sorted({*__all__, *_DOORS, "__doc__", "__version__"})
