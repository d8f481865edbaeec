"""What is pressed, and into what: a joint, its materials and layers, and the lengths that people state.

`joint` itself; `material`, materials and layers; `dimensions`, from radii or diameters to what a joint keeps; `values`,
what they are made of.
"""

from .joint import Joint, Support
from .material import Layer, Material
from .values import larger, make_unchecked

__all__ = ["Joint", "Layer", "Material", "Support", "larger", "unchecked"]
