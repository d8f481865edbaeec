"""Every cycle that has a name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from ..core.checks import known_name
from ..core.deprecation import renamed_arguments
from .cycle import DEFAULT_STEPS, Cycle
from .gait import constant_load, flexion, iso_14242_1, iso_14242_1_key_points, iso_14242_4, rocking, two_axis
from .in_vivo import IN_VIVO, in_vivo

MACHINES: Mapping[str, Callable[..., Cycle]] = MappingProxyType(
    {
        "iso-14242-1": iso_14242_1,
        "iso-14242-1-key-points": iso_14242_1_key_points,
        "iso-14242-4": iso_14242_4,
        "flexion": flexion,
        "biaxial-rocking": rocking,
        "two-axis": two_axis,
        "constant-load": constant_load,
    }
)
"""Of machines and their standards, with loads in N."""

CYCLES = (*MACHINES, *IN_VIVO)


@renamed_arguments(instants="n_steps")
def named_cycle(
    name: Any, n_steps: int = DEFAULT_STEPS, order: str = "xyz", body_weight: float | None = None, **words: Any
) -> Cycle:
    """A cycle by its name.

    Parameters
    ----------
    name : str
    n_steps, order
        As of `Cycle`.
    body_weight : float, optional
        In N, which loads that were measured in patients need.
    **words
        Of the function that makes a machine's cycle.

    Raises
    ------
    ValueError
        None of that name, with the nearest one; a body weight that is missing, or one too many.
    """
    known = known_name("cycle", name, CYCLES)
    if known in IN_VIVO:
        if body_weight is None:
            raise ValueError(f"the loads of {known!r} are multiples of the body's weight: body_weight is needed")
        return in_vivo(known, body_weight, n_steps, order)
    if body_weight is not None:
        raise ValueError(f"the loads of {known!r} are a machine's: it takes no body_weight")
    return MACHINES[known](n_steps, order, **words)
