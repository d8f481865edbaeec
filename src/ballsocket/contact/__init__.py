"""Base classes of contact models and the results that models return; no formula of a single model.

Results: `contact`, the result of a press; `outcome`, status, validity and notes, with the base class of all models;
`strength`, stress relative to the strength of the materials; `verdict`, error bars; `describe`, a contact in text and
numbers.

Models: `model`, the base classes; `assembly`, checked inputs and assembled results; `law`, the force law of one joint;
`per_joint`, models that solve joint by joint; `roots`, inversion and largest pressure; `closed_sphere`, the difference
between a closed sphere and a hemisphere.
"""

from .contact import Contact, Laws
from .model import Model, ModelWrapper, RimLimited
from .outcome import ModelInfo

__all__ = ["Contact", "Laws", "Model", "ModelInfo", "ModelWrapper", "RimLimited"]
