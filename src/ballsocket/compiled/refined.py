"""`Refined` by force or indentation over large arrays: half angle and state of each contact in one pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy
from numba.extending import overload

from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..models import liner_compliance, refined_state
from ..models.liner_compliance import liner_of
from ..models.refined import RefinedSolution, answer_of, scaled
from ..models.refined_state import State, edge_of_force, edge_of_indentation, state
from ..problem import Joint
from .teaching import compiled, flat, pick, taught


def solved(joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """The answer to a load of a joint of arrays."""
    shape = numpy.broadcast_shapes(*(number.shape for number in (*joint.numbers(), load)))
    widening = 1 + joint.liner_thickness / joint.socket_radius
    inputs = (load, scaled(joint, kind, load), joint.liner.poisson, widening)
    outputs = numpy.empty((1 + len(State._fields), math.prod(shape)))
    _kernel(kind)(*(flat(part, shape) for part in inputs), outputs)
    edge, *parts = (part.reshape(shape) for part in outputs)
    solution = RefinedSolution(joint=joint, edge=edge)
    vars(solution)["_state"] = State(*parts)
    return answer_of(solution, kind, load)


@cache
def _kernel(kind: str) -> Any:
    """The compiled pass for loads of one kind."""
    find = edge_of_force if kind == "force" else edge_of_indentation

    def run(given, load, poisson, widening, outputs):  # type: ignore[no-untyped-def]
        for i in range(outputs.shape[1]):
            liner = liner_of(pick(poisson, i), pick(widening, i))
            edge = find(pick(load, i), liner) if pick(given, i) > 0 else 0.0
            at = state(edge if edge > 0 else 1.0, liner)
            outputs[0, i] = edge
            outputs[1, i], outputs[2, i], outputs[3, i], outputs[4, i] = at[0], at[1], at[2], at[3]
            outputs[5, i], outputs[6, i], outputs[7, i] = at[4], at[5], at[6]

    return compiled(run)


@overload(refined_state.log_compliances, strict=False)
def _log_compliances(half_angle: Any, liner: Any, waves: Any) -> Callable[..., Any]:
    return refined_state.one_by_one


for _formula in (
    liner_compliance.liner_of,
    liner_compliance.log_compliance,
    liner_compliance._sum,
    liner_compliance.log_compliance_anywhere,
    liner_compliance._log_compliance_near,
    liner_compliance._divided,
    liner_compliance._decay_mean,
    liner_compliance._polynomial,
    refined_state.one_by_one,
    refined_state.bends,
    refined_state._log_compliance,
    refined_state._edge,
    refined_state._exponent,
    refined_state.along,
    refined_state.state,
    refined_state._edge_of,
    refined_state._indentation_miss,
    refined_state._force_miss,
    refined_state.edge_of_indentation,
    refined_state.edge_of_force,
):
    taught(_formula)
