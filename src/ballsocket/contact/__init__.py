"""Models of contact and the results they return; no formula of a single model.

Results: `contact`, the result of a press; `outcome`, status, validity and notes; `strength`, stress relative to the
strength of the materials; `describe`, a contact in text and numbers.

Models: `model`, the base classes; `answer`, checked inputs and assembled results; `law`, a model bound to one joint;
`per_joint`, models that solve joint by joint; `peak_pressure`, the position of the largest pressure; `model_info`,
name, sources and validity; `roots`, the inversion.
"""

from .contact import Contact, Laws, Pressed
from .model import Model, ModelWrapper, RimLimited

__all__ = ["Contact", "Covered", "Laws", "Model", "Pressed", "Wrapped"]
