"""Lubricating film between ball and socket: closed form, kinematic wave, and Reynolds' equation.

`bs.film(contact, spin=..., lubricant=...)` is the function for users, `film.film` here. `inlet` has the film at the
edge of the dry contact, `wave` carries it over the contact, and `reynolds` solves the equation that judges both.
`transient.film_over_steps` solves it over steps of load and motion.
"""

from .lubricant import Lubricant, Stribeck

__all__ = ["Lubricant", "Stribeck"]
