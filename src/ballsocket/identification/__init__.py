"""Identification of a joint from measurements, and calibration of a foundation modulus.

`identify` fits measurements; the other names are its data and results.
"""

from ..core.lazy import names_of_stub

__getattr__, __dir__, __all__ = names_of_stub(__name__, __file__)
