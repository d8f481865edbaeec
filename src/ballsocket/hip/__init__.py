"""Wear simulation of hip joints: gait, sliding, wear and creep over millions of cycles, film and friction."""

from ..core.lazy import names_of_stub

__getattr__, __dir__, __all__ = names_of_stub(__name__, __file__)
