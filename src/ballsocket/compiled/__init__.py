"""Compiled formulas: presses of large arrays in one pass, and laws of joints for compiled programs.

Needs numba (`pip install "ballsocket[fast]"`). No formula is written twice: `overloads` defines the few functions of
`ballsocket.core.arrays` for one number, and numba compiles the formulas of the models as they are.
"""

from .law import CompiledLaw, compiled_law
from .model import Compiled

__all__ = ["Compiled", "CompiledLaw", "compiled_law"]
