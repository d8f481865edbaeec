"""Planning data of a hip: landmarks, orientation of the cup, meshes of liner and head, points of worn bores.

    from ballsocket.planning import fit_liner, read_mesh
    liner = fit_liner(read_mesh("liner.stl"))
    liner.radius, liner.arc_of_cover, liner.wall_thickness

Lengths are in mm, angles in rad.
"""

from ..core.lazy import names_of_stub

__getattr__, __dir__, __all__ = names_of_stub(__name__, __file__)
