"""What a model is, and what stands between its formulas and whoever asks: no mechanics.

`model` itself; `answer`, what comes into a press and what it hands back; `law`, a model bound to one joint;
`per_joint`, models that are solved joint by joint; `largest`, where a pressure is largest; `theory`, what can be
listed, cited and trusted; `roots`, the one inversion.
"""

from .model import Covered, Model, Wrapped

__all__ = ["Covered", "Model", "Wrapped"]
