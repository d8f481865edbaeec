"""Elastic energy of an adhesive ball, which attaches at first touch and separates when its last spring detaches."""

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
class AdhesionPotential:
    """Energy of an adhesive socket over d + u_c, where the last spring detaches at the distance u_c before first touch.

    The energy is zero at separation, and negative at first touch.
    """

    model: AdhesiveSocket
    joint: Joint
    deepest: float

    @cached_property
    def stretch(self) -> float:
        """Largest stretch u_c of a spring in mm."""
        return float(self.model.critical_stretch(self.joint))

    @cached_property
    def _separation_energy(self) -> float:
        return float(self.model.energy(self.joint, -self.stretch))

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation - self.stretch
        return (
            self.model.energy(*arguments) - self._separation_energy,
            self.model.force(*arguments),
            self.model.stiffness(*arguments),
        )


def adhesion_potential(model: AdhesiveSocket, joint: Joint) -> AdhesionPotential:
    """Return the energy of an adhesive joint whose ball can separate.

    Raises
    ------
    ValueError
        An adhesion number η = u_c/c of 1 or more: the hemisphere sticks as a unit and never separates gradually.
    """
    model.law(joint)  # raises for arrays and for joints outside the domain
    checked = joint.with_floats()
    eta = float(model.adhesion_number(checked))
    require(
        "the adhesion number",
        eta,
        eta < 1.0,
        "it must be below 1; otherwise the entire hemisphere sticks, and the rim determines the separation",
    )
    return AdhesionPotential(model=model, joint=checked, deepest=checked.socket_radius)


def undamped_pull(contact: Elastic) -> Elastic:
    """Remove damping from a contact in tension, where it would generate energy."""
    pressing = clip(contact.damped_force, 0.0, float("inf"))
    return contact._replace(damped_force=pressing, damped_stiffness=clip(contact.damped_stiffness, 0.0, float("inf")))
