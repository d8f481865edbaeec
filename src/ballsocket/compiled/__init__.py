"""The same formulas, compiled: many presses in one pass, and the law of a joint for programs that are compiled too.

Needs numba (`pip install 'ballsocket[fast]'`). Nothing is written twice: numba is taught what the few functions of
`ballsocket.core.arrays` mean for one number (`teaching`), and then compiles the formulas of the models as they stand.
"""

from .law import CompiledLaw, compiled_law
from .model import Compiled

__all__ = ["Compiled", "CompiledLaw", "compiled_law"]
