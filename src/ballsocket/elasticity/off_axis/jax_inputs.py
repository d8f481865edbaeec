"""Checks of the inputs of `JaxSphere`: a wrong one is one sentence, before the compiler meets it."""

from __future__ import annotations

from typing import Any

import numpy

from ...contact.assembly import check_joint
from ...core.arrays import Array
from ...core.checks import check_numeric, check_vectors, shown
from ...core.validity import check_domain
from .model import check_sphere

_DTYPES = ("float32", "float64")
"""Precisions of the solver."""


def check_bore(model: Any, joint: Any) -> None:
    """Check that model and joint describe one bore that `Sphere` solves.

    Raises
    ------
    TypeError
        Another type than `Sphere` or `Joint`, or a joint with arrays.
    OutsideDomainError
        A joint outside the domain of the model.
    """
    check_sphere(model)
    check_joint(joint)
    if any(numpy.shape(number) for number in joint.numbers()):
        raise TypeError("joint must have plain numbers, got arrays: one JaxSphere presses one joint")
    check_domain(model.domain, joint, model.name)


def check_dtype(dtype: Any) -> None:
    """Check the name of a precision; raise ValueError for another."""
    if not (isinstance(dtype, str) and dtype in _DTYPES):
        raise ValueError(f"dtype = {shown(dtype)} is not allowed: it is {' or '.join(map(repr, _DTYPES))}")


def check_precision(dtype: str) -> None:
    """Check that JAX has the precision that is asked for; raise ValueError otherwise."""
    import jax

    if jax.dtypes.canonicalize_dtype(dtype) != dtype:
        raise ValueError(
            'dtype = "float64" needs jax.config.update("jax_enable_x64", True) first: the default of JAX is single'
        )


def check_loads(force: Any, direction: Any) -> tuple[Array, Array]:
    """Check forces (loads,) and their directions (loads, 3) or (3,); return both as arrays.

    Raises
    ------
    TypeError
        Another type than real numbers.
    ValueError
        Another shape.
    """
    force, direction = check_numeric("force", force), check_vectors("direction", direction, "x, y, z")
    shape = numpy.shape(force)
    if len(shape) != 1 or 0 in shape:
        raise ValueError(f"force of shape {shape} is not allowed: it is a row (loads,) of one or more forces")
    check_shape("direction", direction, ((3,), (1, 3), (*shape, 3)))
    return force, direction


def check_shape(name: str, value: Any, allowed: tuple[tuple[int, ...], ...]) -> Array:
    """Check that a value has real numbers and one of several shapes, and return it.

    Raises
    ------
    TypeError
        Another type than real numbers.
    ValueError
        Another shape.
    """
    value = check_numeric(name, value)
    if numpy.shape(value) not in allowed:
        shapes = " or ".join(dict.fromkeys(map(str, allowed)))
        raise ValueError(f"{name} of shape {numpy.shape(value)} is not allowed: its shape is {shapes}")
    return value
