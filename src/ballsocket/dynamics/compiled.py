"""Force element for compiled programs, with the formulas of `ForceElement` for one state or for arrays.

Needs numba (`pip install "ballsocket[fast]"`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy
from numba import njit
from numba.extending import overload

from ..compiled import kernels as _kernels  # noqa: F401 - registers the formulas of the foundation
from ..compiled.law import CompiledLaw
from ..compiled.overloads import VECTOR_FUNCTIONS, inline_formula, jit_formula, vector_formula, zero_setter
from ..contact import octave_curve
from ..core.arrays import Numbers
from ..core.checks import check_shape, check_vectors, shown
from ..models import kinematics
from ..models.kinematics import Kinematics
from . import ball_centre, film, friction, reaction, stepping
from .ball_centre import Constants
from .element import ForceElement
from .load import Load
from .potential import CurvePotential, SpringPotential, curve_potential


@dataclass(frozen=True, eq=False)
class CompiledElement:
    """Force element for functions compiled by numba, and for large arrays of states.

    Parameters
    ----------
    element : ForceElement
        Element with any model. A closed form other than radial springs becomes a curve within 1e-9 of its force.

    Attributes
    ----------
    potential : CompiledLaw
        Energy, force and stiffness of an indentation, for compiled functions.
    constants : Constants
        Numbers of the element.

    Raises
    ------
    ValueError
        An element with bristles or adhesion, which has an internal state.

    Examples
    --------
    >>> import numpy
    >>> import ballsocket as bs
    >>> from ballsocket.dynamics.compiled import CompiledElement
    >>> fast = CompiledElement(bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"]))
    >>> position, rest = numpy.array([[0.0, 0.0, 0.12]]), numpy.zeros((1, 3))
    >>> force, moment, energy, tangent = fast.loads(position, rest, rest)  # doctest: +SKIP
    >>> fast(position).energy.round(2)
    array([5.16])
    """

    element: ForceElement

    def __post_init__(self) -> None:
        if not isinstance(self.element, ForceElement):
            raise TypeError(f"element must be a ForceElement, got {shown(self.element)}")
        if self.element.internal_state:
            raise ValueError(
                f"{self.element.internal_state}; compiled elements support no internal state, use the ForceElement"
            )

    def __call__(self, position: Any, velocity: Any = (0.0, 0.0, 0.0), spin: Any = (0.0, 0.0, 0.0)) -> Load:
        """Compute the load at a state of the ball by the `ForceElement`."""
        return self.element(position, velocity, spin)

    @property
    def constants(self) -> Constants:
        """Constants of the element: lengths in mm, speeds in mm/s, times in s."""
        return self.element.constants

    @cached_property
    def potential(self) -> CompiledLaw:
        """Compiled function of the indentation in mm: energy in N mm, force in N and stiffness in N/mm."""
        model, joint, energy_law = self.element.model, self.element.joint, self.element.potential
        if isinstance(energy_law, SpringPotential):
            springs = energy_law.springs
            numbers: tuple[Any, ...] = springs.socket_radius, springs.clearance, springs.modulus
            return CompiledLaw(function=_compiled_spring_potential(springs.kinematics), numbers=numbers)
        if not isinstance(energy_law, CurvePotential):
            energy_law = curve_potential(model, joint)
        return CompiledLaw(function=_compiled_curve_potential(), numbers=energy_law.curve.numbers)

    @property
    def march(self) -> Any:
        """Compiled function that advances a ball over all time steps of `simulate`."""
        return _compiled_march()

    def loads(self, position: Numbers, velocity: Numbers, spin: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Compute force and moment on the ball, energy and tangent stiffness for an array of states.

        The components of the tangent stiffness are xx, yy, zz, xy, yz, zx.

        Parameters
        ----------
        position, velocity, spin : array (states, 3)
            NumPy arrays of float64.

        Returns
        -------
        arrays (states, 3), (states, 3), (states,), (states, 6)

        Raises
        ------
        ValueError
            Arrays of another shape, or of different lengths.
        TypeError
            Other values than real numbers.
        """
        position = check_vectors("position", position, "x, y, z (mm)")
        if position.ndim != 2:
            raise ValueError(f"position of shape {position.shape} is not allowed: each state is a row x, y, z")
        motion = [
            check_shape(name, values, (position.shape,)) for name, values in [("velocity", velocity), ("spin", spin)]
        ]
        state = [numpy.ascontiguousarray(values, dtype=float) for values in (position, *motion)]
        force, moment, energy, tangent = (numpy.empty((len(position), *row)) for row in ((3,), (3,), (), (6,)))
        absent = tuple(Constants._fields.index(name) for name in _OPTIONAL if getattr(self.constants, name) == 0.0)
        _compiled_batch_loop(absent)(self.potential, self.constants, *state, force, moment, energy, tangent)
        return force, moment, energy, tangent


@cache
def _compiled_spring_potential(motion: Kinematics) -> Any:
    """Compile the energy, force and stiffness of radial springs as one function of the indentation."""
    energy, force, stiffness = jit_formula(motion.energy), jit_formula(motion.force), jit_formula(motion.stiffness)

    @njit(error_model="numpy")
    def energy_force_stiffness(indentation, R2, c, K):  # type: ignore[no-untyped-def]
        return energy(R2, c, K, indentation), force(R2, c, K, indentation), stiffness(R2, c, K, indentation)

    return energy_force_stiffness


@cache
def _compiled_curve_potential() -> Any:
    """Compile the function that evaluates a fitted energy curve: energy, force and stiffness."""
    return njit(error_model="numpy", fastmath={"contract"})(
        vector_formula(octave_curve.derivatives_at, VECTOR_FUNCTIONS)
    )


def loads_at(potential, constants, position, velocity, spin):  # type: ignore[no-untyped-def]
    """Compute force, moment, energy and tangent stiffness at one state of the ball, in compiled functions.

    The components of the tangent stiffness are xx, yy, zz, xy, yz, zx.
    """
    centre = ball_centre.ball_centre_at(position[0], position[1], position[2], constants.clearance)
    return load_from_contact(centre, reaction.elastic_contact(potential, centre, constants), velocity, spin, constants)


def load_from_contact(centre, contact, velocity, spin, constants):  # type: ignore[no-untyped-def]
    """Compute force, moment, energy and tangent stiffness from the elastic contact and the motion of the ball."""
    fx, fy, fz, mx, my, mz = reaction.force_and_moment(centre, contact, velocity, spin, constants)
    return (fx, fy, fz), (mx, my, mz), contact.energy, reaction.tangent_stiffness(centre, contact, constants)


_BLOCK_SIZE = 256  # number of states in a block, whose loads one loop of vector instructions computes
_OPTIONAL = ("smoothing", "time", "static", "viscous", "rim", "film_damping")  # constants that are 0 without an effect


@cache
def _compiled_batch_loop(absent: tuple[int, ...]) -> Any:
    """Compile the loop over states without the branches of absent constants, so that it has vector instructions."""
    without_absent = zero_setter(absent)

    @njit(error_model="numpy", fastmath={"contract"})
    def compute_batch(potential, given_constants, position, velocity, spin, force, moment, energy, tangent):  # type: ignore[no-untyped-def]
        """Compute force, moment, energy and tangent stiffness of each state, in blocks with a row for each number."""
        constants = without_absent(given_constants)
        block = numpy.empty((25, _BLOCK_SIZE))
        state, slopes, results = block[:9], block[9:12], block[12:]
        for first in range(0, len(energy), _BLOCK_SIZE):
            count = min(len(energy) - first, _BLOCK_SIZE)
            for i in range(count):
                for axis in range(3):
                    state[axis, i] = position[first + i, axis]
                    state[3 + axis, i] = velocity[first + i, axis]
                    state[6 + axis, i] = spin[first + i, axis]
            for i in range(count):
                centre = ball_centre.ball_centre_at(state[0, i], state[1, i], state[2, i], constants.clearance)
                depth = ball_centre.smooth_ramp(centre.indentation, constants.smoothing)[0]
                slopes[0, i], slopes[1, i], slopes[2, i] = potential(depth)
            for i in range(count):
                centre = ball_centre.ball_centre_at(state[0, i], state[1, i], state[2, i], constants.clearance)
                depth = ball_centre.smooth_ramp(centre.indentation, constants.smoothing)
                energy_slopes = slopes[0, i], slopes[1, i], slopes[2, i]
                contact = reaction.elastic_from_slopes(centre, depth, energy_slopes, constants)
                v, w = (state[3, i], state[4, i], state[5, i]), (state[6, i], state[7, i], state[8, i])
                f, m, results[6, i], J = load_from_contact(centre, contact, v, w, constants)
                results[0, i], results[1, i], results[2, i] = f
                results[3, i], results[4, i], results[5, i] = m
                results[7, i], results[8, i], results[9, i], results[10, i], results[11, i], results[12, i] = J
            for i in range(count):
                for axis in range(3):
                    force[first + i, axis], moment[first + i, axis] = results[axis, i], results[3 + axis, i]
                energy[first + i] = results[6, i]
                for component in range(6):
                    tangent[first + i, component] = results[7 + component, i]

    return compute_batch


@cache
def _compiled_march() -> Any:
    return njit(error_model="numpy")(stepping.march)


for _formula in (
    kinematics.linear_energy,
    kinematics.circular_energy,
    ball_centre.smooth_ramp,
    ball_centre.smooth_ramp_value,
    ball_centre._corner_polynomial,
    ball_centre.rim_share,
    friction.widening_factor,
    friction.drill_lever,
    friction.rolling_slip_ratio,
    friction.effective_slip,
    ball_centre.ball_centre_at,
    reaction.elastic_contact,
    reaction.elastic_at_rim,
    ball_centre.dome_angle,
    reaction.normal_force,
    reaction.sliding_state,
    reaction.versine,
    film.film_damping,
    film.film_thickness,
    film._eccentricity_function,
    film._covered_share,
    film.squeeze_damping,
    film.film_force_and_moment,
    film.mean_velocity,
    film.film_dissipation,
    reaction.force_and_moment,
    reaction.contact_force_and_moment,
    reaction.dissipation,
    reaction.tangent_stiffness,
    stepping.end_state,
    stepping.surface_speed,
    stepping.mean_contact,
    stepping.step_residual,
    stepping.newton_correction,
    stepping.advance_one_step,
    loads_at,
):
    jit_formula(_formula)

# without a call of the C library loops over states have vector instructions
overload(friction.friction_coefficient, strict=False, jit_options={"forceinline": True})(
    lambda speed, sliding, static, stribeck_speed: vector_formula(friction.friction_coefficient, VECTOR_FUNCTIONS)
)

for _inlined in (reaction.elastic_from_slopes, load_from_contact):
    inline_formula(_inlined)
