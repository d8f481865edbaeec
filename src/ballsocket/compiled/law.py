"""Force law of a joint for compiled programs: `law(indentation)` in Python and in functions compiled by numba."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from numba import njit, typeof
from numba.core import cgutils, types
from numba.extending import (
    NativeValue,
    lower_builtin,
    make_attribute_wrapper,
    models,
    overload_method,
    register_model,
    typeof_impl,
    unbox,
)

from ..contact import law as formulas
from ..contact import octave_curve
from ..contact.law import CurveLaw, ForceLaw
from ..models.closed_form import ClosedLaw
from ..models.foundation import FoundationLaw
from ..models.kinematics import Kinematics
from . import kernels as _kernels  # noqa: F401 - registers the formulas of the foundation
from .overloads import VECTOR_FUNCTIONS, jit_formula, vector_formula


@dataclass(frozen=True, kw_only=True, eq=False)
class CompiledLaw:
    """Force law of a joint that Python and functions compiled by numba can call and take as an argument.

    Attributes
    ----------
    function : numba function
        Function of an indentation, followed by the numbers, that returns force and stiffness. That of a
        `CompiledElement` returns energy, force and stiffness.
    numbers : tuple
        Numbers of the joint.

    Examples
    --------
    >>> import numba
    >>> import ballsocket as bs
    >>> from ballsocket.compiled import Compiled
    >>> law = Compiled(model=bs.HessForsbach()).law(bs.joints["hess-forsbach"])
    >>> @numba.njit
    ... def work(law, deepest, steps):
    ...     total = 0.0
    ...     for step in range(steps):
    ...         force, _ = law((step + 0.5) / steps * deepest)
    ...         total += force * deepest / steps
    ...     return total
    >>> round(work(law, 0.05, 1000), 3)
    78.226
    """

    function: Any
    numbers: tuple[Any, ...]

    def __call__(self, indentation: float) -> Any:
        return self.function(indentation, *self.numbers)


def compiled_law(law: ForceLaw) -> CompiledLaw:
    """Compile the force law of a model: the formulas of a radial foundation, else a curve.

    Parameters
    ----------
    law : Law
        Result of `model.law(joint)`.

    Raises
    ------
    TypeError
        The law is another function, or one with forces that are not positive (`AdhesiveSocket`).
    """
    if isinstance(law, FoundationLaw):
        return CompiledLaw(
            function=_foundation_function(law.kinematics), numbers=(law.socket_radius, law.clearance, law.modulus)
        )
    curve = law.model.curve(law.joint) if isinstance(law, ClosedLaw) else law
    if not isinstance(curve, CurveLaw):
        raise TypeError(f"law must be one that model.law(joint) returned, got {law!r}")
    return CompiledLaw(function=_curve_function(), numbers=curve.curve.numbers)


@cache
def _foundation_function(motion: Kinematics) -> Any:
    """Return the compiled force law of a radial foundation with one kinematics."""
    force, stiffness, finite_or_nan = (
        jit_formula(motion.force),
        jit_formula(motion.stiffness),
        jit_formula(formulas.finite_or_nan),
    )

    @njit(error_model="numpy")
    def force_and_tangent(indentation, R2, c, K):  # type: ignore[no-untyped-def]
        """Compute the force in N and the stiffness in N/mm at an indentation in mm; 0 without contact."""
        if indentation < 0:
            return 0.0, 0.0
        return finite_or_nan(force(R2, c, K, indentation), stiffness(R2, c, K, indentation))

    return force_and_tangent


@cache
def _curve_function() -> Any:
    derivatives_at = vector_formula(octave_curve.derivatives_at, VECTOR_FUNCTIONS)

    @njit(error_model="numpy", fastmath={"contract"})
    def force_and_tangent(indentation, low, high, first, density, origins, rows):  # type: ignore[no-untyped-def]
        """Evaluate the numbers of a curve at an indentation in mm: force in N and stiffness in N/mm."""
        force, stiffness, _ = derivatives_at(indentation, low, high, first, density, origins, rows)
        return force, stiffness

    return force_and_tangent


class _LawType(types.Type):
    """Numba type of a `CompiledLaw`, one for each function."""

    def __init__(self, function: Any, numbers: Any) -> None:
        self.function, self.numbers = function, numbers
        super().__init__(name=f"CompiledLaw({id(function)}, {numbers})")


@typeof_impl.register(CompiledLaw)
def _law_type(law: CompiledLaw, _: Any) -> _LawType:
    return _LawType(law.function, typeof(law.numbers))


@register_model(_LawType)
class _LawModel(models.StructModel):
    """Numba data model of `_LawType`: a structure of the numbers of the law."""

    def __init__(self, manager: Any, kind: _LawType) -> None:
        super().__init__(manager, kind, [("numbers", kind.numbers)])


make_attribute_wrapper(_LawType, "numbers", "numbers")


@unbox(_LawType)
def _unbox_law(kind: _LawType, value: Any, context: Any) -> NativeValue:
    numbers = context.pyapi.object_getattr_string(value, "numbers")
    native = context.unbox(kind.numbers, numbers)
    context.pyapi.decref(numbers)
    result = cgutils.create_struct_proxy(kind)(context.context, context.builder)
    result.numbers = native.value
    return NativeValue(result._getvalue(), is_error=native.is_error)


@overload_method(_LawType, "__call__")
def _overload_call(law, indentation):  # type: ignore[no-untyped-def]
    """Implement the call `law(indentation)` in compiled code."""
    function = law.function
    return lambda law, indentation: function(indentation, *law.numbers)


@lower_builtin(_LawType, _LawType, types.Any)
def _lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Generate the machine code of a call `law(indentation)`, which numba requests separately from the type."""
    return context.compile_internal(builder, _overload_call(*signature.args), signature, arguments)
