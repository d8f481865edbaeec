"""Definition of the problem: a joint, its materials, layers and lengths, and the cup around its socket.

`joint`, a ball in a lined socket; `material`, materials and layers; `dimensions`, the lengths of a joint from radii or
diameters; `cup`, rim and orientation of a socket; `gaps`, the displacement that a rigid ball prescribes; `presets`,
materials and joints with sources.
"""

from .joint import Joint, Support
from .material import Layer, Material, elementwise_maximum, make_unchecked

__all__ = ["Joint", "Layer", "Material", "Support", "elementwise_maximum", "make_unchecked"]
