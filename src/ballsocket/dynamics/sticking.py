"""A ball that sticks: it snaps in where it touches, and holds on until its last spring lets go."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ..core.arrays import Array, clip
from ..core.checks import require
from ..models.adhesion import AdhesiveSocket
from ..problem import Joint
from .potential import Slopes
from .reaction import Elastic


@dataclass(frozen=True, kw_only=True)
class StickingPotential:
    """The energy of an adhesive socket over d + u_c: from where the last spring lets go, u_c before first touch, on.

    Beyond, nothing is stored; at first touch a ball that comes from afar has already fallen to below 0.
    """

    model: AdhesiveSocket
    joint: Joint
    deepest: float

    @cached_property
    def stretch(self) -> float:
        """u_c in mm."""
        return float(self.model.critical_stretch(self.joint))

    @cached_property
    def _apart(self) -> float:
        return float(self.model.energy(self.joint, -self.stretch))

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation - self.stretch
        return (
            self.model.energy(*arguments) - self._apart,
            self.model.force(*arguments),
            self.model.stiffness(*arguments),
        )


def sticking_potential(model: AdhesiveSocket, joint: Joint) -> StickingPotential:
    """The potential of a joint, if the ball can let go of it at all.

    Raises
    ------
    ValueError
        An adhesion number η = u_c/c of 1 or more: the whole hemisphere sticks, and never lets go spring by spring.
    """
    model.law(joint)  # refuses arrays and what is outside the domain
    checked = joint.with_floats()
    eta = float(model.adhesion_number(checked))
    require("the adhesion number", eta, eta < 1.0, "from 1 on the whole hemisphere sticks, and the rim decides")
    return StickingPotential(model=model, joint=checked, deepest=checked.socket_radius)


def undamped_pull(contact: Elastic) -> Elastic:
    """Damping acts on what presses alone: a pull that grew with the speed would make energy."""
    pressing = clip(contact.damped_force, 0.0, float("inf"))
    return contact._replace(damped_force=pressing, damped_stiffness=clip(contact.damped_stiffness, 0.0, float("inf")))
