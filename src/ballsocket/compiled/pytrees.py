"""Teach JAX that materials, layers, joints and contacts are trees of numbers.

    import ballsocket.compiled.pytrees

Then a whole `Joint` can be an argument of `jax.jit`, `jax.vmap` and `jax.grad` (which returns a `Joint` of
derivatives), and a `Contact` can be returned by them.
"""

from __future__ import annotations

from typing import Any

from jax.tree_util import register_pytree_node

from ..contact import Contact
from ..core.quantities import STRESS_LIMITS
from ..elasticity.exact.tabulated.solution import TableSolution
from ..models.closed_form import Bound
from ..models.plane_layer import LayerSolution
from ..models.refined import RefinedSolution
from ..problem import Joint, Layer, Material, make_unchecked

Parts = tuple[Any, ...]


def _register(cls: Any, parts: tuple[str, ...], fixed: tuple[str, ...]) -> None:
    """`parts` are the branches of the tree, `fixed` what must be equal for two trees to be alike."""

    def flatten(made: Any) -> tuple[Parts, Parts]:
        return tuple(getattr(made, name) for name in parts), tuple(getattr(made, name) for name in fixed)

    def unflatten(fixed_values: Parts, values: Parts) -> Any:
        names = (*parts, *fixed)
        return make_unchecked(cls, **dict(zip(names, (*values, *fixed_values), strict=True)))

    register_pytree_node(cls, flatten, unflatten)


_register(Material, ("young", "poisson", *STRESS_LIMITS), ("name", "source"))
_register(Layer, ("thickness", "material"), ())
_register(
    Joint,
    ("ball_radius", "clearance", "liner_thickness", "liner", "ball", "backing"),
    ("support", "name", "source"),
)
_register(TableSolution, ("joint", "angle", "values"), ("file",))
_register(LayerSolution, ("joint", "width"), ("widest",))
_register(RefinedSolution, ("joint", "edge"), ())
_register(Bound, ("joint", "indentation"), ("model",))
_register(Contact, ("laws", "joint", "force", "indentation", "status"), ("model",))
