"""Registry of the cycles that have a name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ..core.checks import known_name
from .cycle import DEFAULT_STEPS, Cycle, CycleDefinition
from .in_vivo_cycles import IN_VIVO_CYCLES
from .simulator_cycles import SIMULATOR_CYCLES

_DEFINITIONS = (
    *SIMULATOR_CYCLES,
    *IN_VIVO_CYCLES,
)
"""Definitions of all named cycles; a new cycle is one line here."""

CYCLES: Mapping[str, CycleDefinition] = MappingProxyType({definition.name: definition for definition in _DEFINITIONS})
"""Definitions of the named cycles by name, in the order in which they are listed."""


def named_cycle(
    name: Any, n_steps: int = DEFAULT_STEPS, order: str = "xyz", body_weight: float | None = None, **parameters: Any
) -> Cycle:
    """Create one of the registered cycles by its name, such as "iso-14242-1".

    Parameters
    ----------
    name : str
        Name of the cycle; see `CYCLES`.
    n_steps, order
        As in `Cycle`.
    body_weight : float, optional
        Body weight in N, required by loads measured in patients.
    **parameters
        Arguments of the function that makes the cycle.

    Raises
    ------
    ValueError
        The name is unknown (the message suggests the closest one), or a body weight is missing or not allowed.
    """
    definition = CYCLES[known_name("cycle", name, CYCLES)]
    if definition.per_body_weight:
        if body_weight is None:
            raise ValueError(f"{definition.name!r} has loads in multiples of body weight: set body_weight")
        parameters["body_weight"] = body_weight
    elif body_weight is not None:
        raise ValueError(f"{definition.name!r} has loads in N: it does not take a body_weight")
    return definition.make(n_steps=n_steps, order=order, **parameters)
