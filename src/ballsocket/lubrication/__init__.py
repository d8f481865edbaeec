"""Lubricating film between ball and socket: closed form, kinematic wave, and Reynolds' equation.

`bs.film(contact, spin=..., lubricant=...)` is the function for users, `film.film` here. `inlet` has the film at the
edge of the dry contact, `wave` carries it over the contact, and `reynolds` solves the equation that judges both.
`rigid_fields` has pressures of rigid bodies in closed form.
"""

from .lubricant import Lubricant

__all__ = ["Lubricant"]
