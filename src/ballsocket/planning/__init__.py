"""Planning data of a hip: landmarks, orientation of the cup, meshes of liner and head, points of worn bores.

    from ballsocket.planning import fit_liner, read_mesh
    liner = fit_liner(read_mesh("liner.stl"))
    liner.radius, liner.arc_of_cover, liner.wall_thickness

Lengths are in mm, angles in rad.
"""

from .clouds import PointCloud, read_points
from .implants import ImplantFit, fit_head, fit_liner
from .landmarks import Landmarks, read_landmarks
from .meshes import Mesh, read_mesh
from .pelvis import CupOrientation, PelvicFrame, cup_orientation, orientation_of_axis, pelvic_frame
from .plan import HipPlan, make_plan
from .rims import RimPlane
from .worn_bores import WornBore, measure_wear

__all__ = [
    "CupOrientation",
    "HipPlan",
    "ImplantFit",
    "Landmarks",
    "Mesh",
    "PelvicFrame",
    "PointCloud",
    "RimPlane",
    "WornBore",
    "cup_orientation",
    "fit_head",
    "fit_liner",
    "make_plan",
    "measure_wear",
    "orientation_of_axis",
    "pelvic_frame",
    "read_landmarks",
    "read_mesh",
    "read_points",
]
