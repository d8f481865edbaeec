"""Planning data of a hip: landmarks of the pelvis, orientation of the cup, and STL files of liner and head.

    from ballsocket.planning import fit_liner, read_stl
    liner = fit_liner(read_stl("liner.stl"))
    liner.radius, liner.arc_of_cover, liner.wall_thickness

Lengths are in mm, angles in rad.
"""

from .implants import ImplantFit, Mesh, fit_head, fit_liner, read_stl
from .landmarks import Landmarks, read_landmarks
from .pelvis import CupOrientation, PelvicFrame, cup_orientation, orientation_of_axis, pelvic_frame
from .plan import HipPlan, make_plan

__all__ = [
    "CupOrientation",
    "HipPlan",
    "ImplantFit",
    "Landmarks",
    "Mesh",
    "PelvicFrame",
    "cup_orientation",
    "fit_head",
    "fit_liner",
    "make_plan",
    "orientation_of_axis",
    "pelvic_frame",
    "read_landmarks",
    "read_stl",
]
