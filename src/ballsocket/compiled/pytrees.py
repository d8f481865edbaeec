"""Registration of materials, layers, joints and contacts as JAX pytrees.

    import ballsocket.compiled.pytrees

Then a whole `Joint` can be an argument of `jax.jit`, `jax.vmap` and `jax.grad` (which returns a `Joint` of
derivatives), and a `Contact` can be returned by them.
"""

from __future__ import annotations

from typing import Any

from jax.tree_util import register_pytree_node

from ..contact import Contact
from ..core.quantities import STRESS_LIMITS
from ..elasticity.exact.tabulated.model import TableSolution
from ..models.closed_form import ClosedFormSolution
from ..models.plane_layer import LayerSolution
from ..models.refined import RefinedSolution
from ..problem import Joint, Layer, Material, make_unchecked

Leaves = tuple[Any, ...]


def _register_pytree(cls: Any, leaves: tuple[str, ...], fixed: tuple[str, ...]) -> None:
    """Register a class as a JAX pytree: `leaves` are its children, `fixed` its static data."""

    def flatten_instance(instance: Any) -> tuple[Leaves, Leaves]:
        """Return the children and the static data of an instance."""
        return tuple(getattr(instance, name) for name in leaves), tuple(getattr(instance, name) for name in fixed)

    def unflatten_instance(fixed_values: Leaves, values: Leaves) -> Any:
        """Make an instance from its static data and its children."""
        names = (*leaves, *fixed)
        return make_unchecked(cls, **dict(zip(names, (*values, *fixed_values), strict=True)))

    register_pytree_node(cls, flatten_instance, unflatten_instance)


_register_pytree(Material, ("young", "poisson", *STRESS_LIMITS), ("name", "source"))
_register_pytree(Layer, ("thickness", "material"), ())
_register_pytree(
    Joint, ("ball_radius", "clearance", "liner_thickness", "liner", "ball", "backing"), ("support", "name", "source")
)
_TABLE_LEAVES = ("joint", "half_angle", "indentation", "force", "pole_pressure", "stiffness")
_register_pytree(TableSolution, _TABLE_LEAVES, ("file",))
_register_pytree(LayerSolution, ("joint", "width"), ("widest",))
_register_pytree(RefinedSolution, ("joint", "half_angle", "indentation", "scaled"), ())
_register_pytree(ClosedFormSolution, ("joint", "indentation"), ("model",))
_register_pytree(Contact, ("laws", "joint", "force", "indentation", "status"), ("model",))
