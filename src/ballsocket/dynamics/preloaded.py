"""Force element of a preloaded joint: its elastic energy, tabulated by the off-axis solver in seven directions.

s is the displacement of the ball's centre from its equilibrium without a load, e = abs(s), and t the cosine of the
angle between s and the axis of the dome. The elastic energy is U(e, t) = Σ w_j(t) U_j(e): a curve U_j along each
direction t_j = cos(π j/6), with the Lagrange polynomials w_j of these nodes. It is exact for small displacements, where
U is a quadratic form in s. The force is the gradient of U, so that no cycle gains energy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar, NamedTuple

import numpy

from ..contact.assembly import check_joint
from ..contact.octave_curve import OctaveCurve, piece_edges, piece_number
from ..core import arrays
from ..core.arrays import Array, Numbers, clip, is_plain_number, sqrt, where
from ..core.checks import shown
from ..core.display import OneLine
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.preload import Preload
from ..problem import Joint
from .ball_centre import Constants, Vector
from .bristles import Bristles
from .damping import Damping
from .element import components, is_one_vector, loss_constants, split_states
from .friction import Friction, friction_coefficient
from .load import ContactState, describe_load, is_finite_state, tangent_matrix, to_contact_state
from .matrices import join_vector
from .potential import CurvePotential

NODES = 7  # number of tabulated directions, from the dome to the opening

QUANTITIES = ("energy", "friction_lever", "half_angle", "max_pressure")
"""Tabulated quantities."""

_DENSITY = 3  # number of pieces of an octave of a curve

_SHALLOWEST, _LARGEST_STRAIN = 0.02, 0.1
"""First tabulated displacement over the interference, and last one over the thickness of the liner."""

_ZERO_VECTOR = (0.0, 0.0, 0.0)


def node_cosines() -> Numbers:
    """Return the cosines t_j of the tabulated directions with the axis of the dome."""
    return numpy.cos(pi * numpy.arange(NODES) / (NODES - 1))


class PreloadedForce(NamedTuple):
    """Energy, derivatives of the energy, and loads of a preloaded ball at a state.

    `slope` is ∂U/∂e, `turn` is ∂U/∂t, and the others are second derivatives. (`nx`, `ny`, `nz`) is the direction of s,
    and (`px`, `py`, `pz`) the part of the dome's axis across it. `lever` is the torque of friction for a coefficient of
    1 in N mm, about an axis across the dome's.
    """

    energy: Array
    slope: Array
    turn: Array
    slope_by_distance: Array
    slope_by_turn: Array
    turn_by_turn: Array
    distance: Array
    cosine: Array
    nx: Array
    ny: Array
    nz: Array
    px: Array
    py: Array
    pz: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class PreloadTable:
    """Tabulated contact of a preloaded joint."""

    # position of the ball's centre in equilibrium along the axis of the dome in mm; negative towards the opening
    offset: float
    limit: float  # largest tabulated displacement from equilibrium in mm
    # stiffness in equilibrium across and along the axis of the dome in N/mm
    stiffness_across: float
    stiffness_along: float
    drill_ratio: float  # torque of friction about the axis of the dome over that about an axis across it
    # curves over the displacement from equilibrium by quantity, one for each direction
    curves: dict[str, tuple[OctaveCurve, ...]]
    # largest error of the force between the tabulated directions, relative to the solver's force there
    error: float = 0.0

    @cached_property
    def evaluators(self) -> dict[str, tuple[CurvePotential, ...]]:
        """Functions of the displacement by quantity: the quantity with two derivatives."""
        return {name: tuple(CurvePotential(curve=curve) for curve in rows) for name, rows in self.curves.items()}

    def evaluate(self, quantity: str, distance: Array) -> tuple[Any, ...]:
        """Evaluate the curves of a quantity at a displacement in mm: value and two derivatives in each direction."""
        return tuple(curve(distance) for curve in self.evaluators[quantity])


def tabulate_preload(model: Sphere, joint: Joint) -> PreloadTable:
    """Solve the contacts of a preloaded joint in seven directions, fit curves to them, and check the force."""
    equilibrium: Any = Preload(model=model, joint=joint).equilibrium
    if equilibrium.status.failed:
        raise ValueError(f"the preloaded ball has no equilibrium in its socket: {'; '.join(equilibrium.notes)}")
    interference = -float(joint.clearance)
    offset, stiffness = float(equilibrium.displacement[2]), equilibrium.stiffness_matrix
    limit = max(_LARGEST_STRAIN * float(min(joint.liner_thickness, joint.socket_radius)), 2.0 * interference)
    distances = piece_edges(_SHALLOWEST * interference, limit, _DENSITY)
    curves: dict[str, list[OctaveCurve]] = {name: [] for name in QUANTITIES}
    for cosine in node_cosines():
        contact, direction = _contact_along(model, joint, offset, distances, cosine)
        force, (lever, _, half_angle, pressure) = contact.force_vector @ direction, _patch_values(contact)
        solved = numpy.isfinite(force) & (force > 0.0)
        if not solved.all():
            distance, angle = distances[int(numpy.argmin(solved))], numpy.degrees(numpy.arccos(cosine))
            position = f"{distance:.3g} mm from equilibrium, {angle:.0f}° from the dome"
            raise ValueError(f"the preloaded joint has no restoring force {position}")
        curves["energy"].append(_energy_curve(distances, force))
        for name, values in (("friction_lever", lever), ("half_angle", half_angle), ("max_pressure", pressure)):
            curves[name].append(_curve(distances, values))
    across, along, *_ = _patch_values(equilibrium)
    table = PreloadTable(
        offset=offset,
        limit=float(distances[-1]),
        stiffness_across=float(stiffness[0, 0] + stiffness[1, 1]) / 2.0,
        stiffness_along=float(stiffness[2, 2]),
        drill_ratio=float(along[0] / across[0]),
        curves={name: tuple(rows) for name, rows in curves.items()},
    )
    return replace(table, error=_interpolation_error(model, joint, table, distances))


def _contact_along(
    model: Sphere, joint: Joint, offset: float, distances: Numbers, cosine: float
) -> tuple[Any, Numbers]:
    """Solve the contacts at distances (mm) from equilibrium along a direction, and return that in the cup's frame."""
    direction = numpy.array([numpy.sqrt(max(1.0 - cosine * cosine, 0.0)), 0.0, cosine])
    centres = numpy.array([0.0, 0.0, offset]) + distances[:, None] * direction
    return model.press(joint, displacement=centres @ numpy.array(model.cup.frame)), direction


def _interpolation_error(model: Sphere, joint: Joint, table: PreloadTable, distances: Numbers) -> float:
    """Compute the largest error of the force halfway between the tabulated directions, relative to the force."""
    largest, dome = 0.0, numpy.array([0.0, 0.0, 1.0])
    for angle in pi * (numpy.arange(NODES - 1) + 0.5) / (NODES - 1):
        contact, direction = _contact_along(model, joint, table.offset, distances, float(numpy.cos(angle)))
        energy, slope, _ = zip(*table.evaluate("energy", distances), strict=True)
        across = interpolate(energy, numpy.cos(angle), 1) / distances
        force = interpolate(slope, numpy.cos(angle))[:, None] * direction
        force = force + across[:, None] * (dome - numpy.cos(angle) * direction)
        error = numpy.linalg.norm(force - contact.force_vector, axis=1)
        largest = max(largest, float((error / numpy.linalg.norm(contact.force_vector, axis=1)).max()))
    return largest


def _patch_values(contact: Any) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """Compute the torques of friction in N mm for a coefficient of 1 about axes across and along the dome's axis.

    Further results are the half angle in rad of a round contact of the same area, and the largest pressure in MPa.
    """
    ((_, contacts),) = contact.laws.pieces
    grid, pressure = contacts.state.bore.compliance.grid, contacts.state.equilibrium.pressure
    weights, scale = pressure * grid.areas, float(contact.joint.ball_radius * contact.joint.socket_radius**2)
    x, y, z = (scale * (weights * numpy.sqrt(1.0 - part * part)).sum(axis=(1, 2)) for part in grid.centroids)
    solid_angle = ((pressure > 0) * grid.areas).sum(axis=(1, 2))
    half_angle = numpy.arccos(numpy.clip(1.0 - solid_angle / (2 * pi), -1.0, 1.0))
    return (x + y) / 2.0, z, half_angle, pressure.max(axis=(1, 2))


def _curve(distances: Numbers, values: Numbers) -> OctaveCurve:
    """Fit a cubic spline over e, level at the first distance: the quantity is constant at smaller ones."""
    from scipy.interpolate import CubicSpline

    return _octave_curve(distances, CubicSpline(distances, values, bc_type=((1, 0.0), "not-a-knot")).c)


def _energy_curve(distances: Numbers, forces: Numbers) -> OctaveCurve:
    """Integrate forces (N) along one direction to the elastic energy: pieces of a cubic spline of F/e over e."""
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(distances, forces / distances, bc_type=((1, 0.0), "not-a-knot"))
    left = distances[:-1]
    force = numpy.append(spline.c, numpy.zeros((1, len(left))), axis=0)
    force[1:] += left * spline.c  # (e - left) times the spline, plus left times the spline
    energy = numpy.append(force / numpy.arange(5, 0, -1)[:, None], numpy.zeros((1, len(left))), axis=0)
    work = numpy.polyval(energy, numpy.diff(distances))
    energy[-1] = 0.5 * forces[0] * distances[0] + numpy.append(0.0, numpy.cumsum(work)[:-1])
    return _octave_curve(distances, energy)


def _octave_curve(distances: Numbers, pieces: Numbers) -> OctaveCurve:
    """Make a curve of polynomials (powers, pieces) in e less the beginning of the piece, the highest power first."""
    low, high = float(distances[0]), float(distances[-1])
    return OctaveCurve(
        low=low,
        high=high,
        density=_DENSITY,
        first=piece_number(low, _DENSITY),
        origins=distances[:-1],
        coefficients=pieces[None],
        error=numpy.zeros(1),
    )


def interpolate(values: Any, cosine: Array, order: int = 0) -> Array:
    """Interpolate values of all directions at a cosine, or differentiate the interpolation `order` times."""
    coefficients = []
    for weights in _WEIGHTS:
        first, *others = (weight * value for weight, value in zip(weights, values, strict=True) if weight != 0.0)
        coefficients.append(sum(others, first))
    for _ in range(order):
        coefficients = [power * coefficient for power, coefficient in enumerate(coefficients)][1:]
    result = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        result = result * cosine + coefficient
    return result


_WEIGHTS = numpy.round(numpy.linalg.inv(numpy.vander(node_cosines(), increasing=True)), 12).tolist()
"""Coefficients of the Lagrange polynomials w_j(t): (powers, nodes), the lowest power first."""

_CENTRE = 1e-9  # displacement in mm below which the direction of the displacement does not matter


def displacement_from_equilibrium(
    x: Array, y: Array, z: Array, constants: Constants, offset: float
) -> tuple[Array, ...]:
    """Compute distance, direction and cosine of the displacement from equilibrium, of a position in mm."""
    a, b, c = constants.dome_x, constants.dome_y, constants.dome_z
    x, y, z = x - offset * a, y - offset * b, z - offset * c
    distance = sqrt(x * x + y * y + z * z)
    moved = distance > _CENTRE
    inverse = 1.0 / where(moved, distance, 1.0)
    nx, ny, nz = where(moved, x * inverse, a), where(moved, y * inverse, b), where(moved, z * inverse, c)
    return where(moved, distance, _CENTRE), nx, ny, nz, clip(a * nx + b * ny + c * nz, -1.0, 1.0)


def preloaded_force(energies: Any, place: tuple[Array, ...], constants: Constants) -> PreloadedForce:
    """Compute the elastic energy and its derivatives from the energies of all directions at a displacement."""
    distance, nx, ny, nz, t = place
    energy, slope, bend = zip(*energies, strict=True)
    a, b, c = constants.dome_x, constants.dome_y, constants.dome_z
    return PreloadedForce(
        energy=interpolate(energy, t),
        slope=interpolate(slope, t),
        turn=interpolate(energy, t, 1),
        slope_by_distance=interpolate(bend, t),
        slope_by_turn=interpolate(slope, t, 1),
        turn_by_turn=interpolate(energy, t, 2),
        distance=distance, cosine=t,
        nx=nx, ny=ny, nz=nz,
        px=a - t * nx, py=b - t * ny, pz=c - t * nz,
    )  # fmt: skip


def preloaded_load(
    force: PreloadedForce, lever: Array, velocity: Vector, spin: Vector, constants: Constants, table: PreloadTable
) -> tuple[Array, ...]:
    """Compute force (N) and moment (N mm) on the ball about its centre, as six components.

    The liner of full contact damps translations with the retardation time and the stiffness in equilibrium. Hysteresis
    adds a factor 1 + χ ė to the radial force. Friction opposes the spin with the torque of all pressures, whatever the
    net force; friction of the small translations is neglected.
    """
    (vx, vy, vz), (wx, wy, wz) = velocity, spin
    a, b, c = constants.dome_x, constants.dome_y, constants.dome_z
    across = force.turn / force.distance
    speed = vx * force.nx + vy * force.ny + vz * force.nz
    radial = force.slope + constants.hysteresis * clip(force.slope, 0.0, inf) * speed
    along = a * vx + b * vy + c * vz
    drag = constants.time * table.stiffness_across
    extra = constants.time * (table.stiffness_along - table.stiffness_across) * along
    fx = -radial * force.nx - across * force.px - drag * vx - extra * a
    fy = -radial * force.ny - across * force.py - drag * vy - extra * b
    fz = -radial * force.nz - across * force.pz - drag * vz - extra * c
    drilling, ratio = a * wx + b * wy + c * wz, table.drill_ratio * table.drill_ratio
    turning = wx * wx + wy * wy + wz * wz + (ratio - 1.0) * drilling * drilling
    slow = constants.transition_speed / constants.ball_radius
    rate = sqrt(turning + slow * slow)
    slip = constants.ball_radius * rate
    mu = friction_coefficient(slip, constants.sliding, constants.static, constants.stribeck_speed)
    torque, twist = -lever * (mu + constants.viscous * slip) / rate, (ratio - 1.0) * drilling
    return fx, fy, fz, torque * (wx + twist * a), torque * (wy + twist * b), torque * (wz + twist * c)


def preloaded_tangent(force: PreloadedForce) -> tuple[Array, ...]:
    """Compute the tangent stiffness ∂²U/∂r² in N/mm: components xx, yy, zz, xy, yz, zx."""
    n, p, inverse = (force.nx, force.ny, force.nz), (force.px, force.py, force.pz), 1.0 / force.distance
    mixed = (force.slope_by_turn - force.turn * inverse) * inverse
    isotropic = (force.slope - force.turn * force.cosine * inverse) * inverse
    radial, polar = force.slope_by_distance - isotropic, force.turn_by_turn * inverse * inverse

    def component(i: int, j: int) -> Array:
        """Compute one component of the tangent, without its isotropic part."""
        return radial * n[i] * n[j] + mixed * (n[i] * p[j] + p[i] * n[j]) + polar * p[i] * p[j]

    diagonal = (component(i, i) + isotropic for i in range(3))
    return *diagonal, component(0, 1), component(1, 2), component(2, 0)


def preloaded_state(distance: Array, is_finite: Array, limit: float) -> ContactState | Array:
    """Determine the state of a preloaded contact: contact, beyond the table, or a state that is not finite."""
    none = 0.0 * where(is_finite, distance, 0.0)
    code = where(distance > limit, none + float(ContactState.THROUGH_WALL), none + float(ContactState.CONTACT))
    return to_contact_state(where(is_finite, code, none + float(ContactState.NO_NUMBER)))


class PreloadedLoad(NamedTuple):
    """Load of a preloaded ball at a state, in numbers or in arrays like those of the state.

    Attributes
    ----------
    force : (3,)
        Force on the ball at its centre in N.
    moment : (3,)
        Moment on the ball about its centre in N mm.
    energy : float or array
        Elastic energy in N mm, 0 in equilibrium without a load.
    """

    force: Any
    moment: Any
    energy: Array
    element: PreloadedElement
    elastic: PreloadedForce
    is_finite: Array

    def __repr__(self) -> str:
        return f"<PreloadedLoad {self}>"

    def __str__(self) -> str:
        return describe_load(self.force, self.moment, self.energy)

    @property
    def half_angle(self) -> Array:
        """Half angle in rad of a round contact of the same area."""
        return self.element.interpolate("half_angle", self.elastic)

    @property
    def max_pressure(self) -> Array:
        """Largest pressure in MPa, that of a cell of the off-axis solver."""
        return self.element.interpolate("max_pressure", self.elastic)

    @property
    def tangent(self) -> Any:
        """Tangent stiffness ∂²U/∂r² in N/mm, a symmetric matrix (3, 3)."""
        with numpy.errstate(all="ignore"):
            return tangent_matrix(type(self.force), preloaded_tangent(self.elastic))

    @property
    def status(self) -> ContactState | Array:
        """State of the contact: a `ContactState`, or an array of its codes."""
        return preloaded_state(self.elastic.distance, self.is_finite, self.element.wall)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on states without a load."""
        codes, limit = numpy.atleast_1d(arrays.to_numpy(self.status)), f"{self.element.wall:.4g} mm from equilibrium"
        failed = [state for state in ContactState if state.failed and (codes == state).any()]
        return tuple(f"{state.sentence}; the limit is {limit}" for state in failed)


@dataclass(frozen=True, eq=False, repr=False)
class PreloadedElement(OneLine):
    """Force element of a preloaded joint for time-stepping programs, tabulated by the off-axis solver.

    A ball with an interference touches its socket without a load. The element has a force for displacements in any
    direction, and a friction torque from the pressures of the preload. The law covers displacements up to a tenth of
    the liner's thickness (`wall`). `table.error` is its largest error relative to the solver's force: about 1 % for an
    arc of cover of 220° and more, 3 % for 200°, and 10 % for 190°.

    Parameters
    ----------
    model : Sphere
        Model with a cup that reaches beyond the equator, an arc of cover above π.
    joint : Joint
        Joint with an `interference`.
    damping : Damping, optional
        Hysteresis, and a retardation time with the stiffness in equilibrium. None, the default, has no losses.
    friction : Friction, optional
        None, the default, has no friction.

    Raises
    ------
    ValueError
        A joint without an interference; a socket that does not hold its ball.
    TypeError
        Another model; arrays in the joint; a wrong type of damping or friction.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> from ballsocket.dynamics import Friction, PreloadedElement
    >>> joint = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    >>> model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0)), ring_width=radians(4.0))
    >>> element = PreloadedElement(model, joint, friction=Friction(coefficient=0.05))
    >>> load = element((0.01, 0.0, element.table.offset), spin=(0.0, 0.0, 1.0))
    >>> f"{load.force[0] / 1e3:.1f} kN, {load.moment[2] / 1e3:.0f} N m"
    '-11.3 kN, -40 N m'
    """

    model: Sphere
    joint: Joint
    damping: Damping | None = None
    friction: Friction | None = None
    table: PreloadTable = field(init=False, repr=False)
    constants: Constants = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_joint(self.joint)
        for name, kind in (("model", Sphere), ("damping", Damping), ("friction", Friction)):
            value = getattr(self, name)
            if not (isinstance(value, kind) or (value is None and name != "model")):
                reason = "; bristles are not supported in a preloaded joint" if isinstance(value, Bristles) else ""
                raise TypeError(f"{name} must be {kind.__name__}, got {shown(value)}{reason}")
        if not all(map(is_plain_number, self.joint.numbers())):
            raise TypeError("a force element needs one joint: its numbers must be plain, not arrays")
        object.__setattr__(self, "table", tabulate_preload(self.model, self.joint))
        object.__setattr__(self, "constants", self._collect_constants())

    def __str__(self) -> str:
        parts = {"damping": self.damping, "friction": self.friction}
        named = [f"{name} {type(part).__name__}" for name, part in parts.items() if part is not None]
        return "; ".join([f"{self.model.name} on {self.joint.name or self.joint.dimensions}", *named])

    internal_state = ""
    internal_states: ClassVar[Mapping[str, int]] = {}
    stretch = 0.0

    @property
    def wall(self) -> float:
        """Largest displacement from equilibrium in mm."""
        return self.table.limit

    @property
    def valid_depth(self) -> float:
        """Largest tabulated indentation in mm, measured from first touch."""
        return self.table.limit - float(self.joint.clearance)

    @property
    def rest_position(self) -> tuple[float, float, float]:
        """Position in mm of the ball's centre without a load, relative to the socket's centre."""
        dome_x, dome_y, dome_z = (self.table.offset * component + 0.0 for component in self.model.cup.dome)
        return dome_x, dome_y, dome_z

    def _collect_constants(self) -> Constants:
        joint = self.joint.with_floats()
        return Constants(
            ball_radius=joint.ball_radius,
            socket_radius=joint.socket_radius,
            clearance=joint.clearance,
            wall=self.table.limit,
            smoothing=0.0,
            **loss_constants(self.damping, self.friction),
            rim=0.0,
            **dict(zip(("dome_x", "dome_y", "dome_z"), self.model.cup.dome, strict=True)),
        )

    def __call__(self, position: Any, velocity: Any = _ZERO_VECTOR, spin: Any = _ZERO_VECTOR) -> PreloadedLoad:
        """Compute force, moment and energy at a state of the ball, with axes fixed to the socket.

        Position (mm), velocity (mm/s) and spin (rad/s) are (3,) or arrays (..., 3), as in `ForceElement`.

        Raises ValueError: a vector without three components.
        """
        if is_one_vector(position):
            return self._load(tuple, components(position), components(velocity), components(spin))
        r, v, w = split_states(position, velocity, spin)
        return self._load(object, r, v, w)

    def _load(self, kind: type, position: Vector, velocity: Vector, spin: Vector) -> PreloadedLoad:
        with numpy.errstate(all="ignore"):
            is_finite = is_finite_state((*position, *velocity, *spin))
            place = displacement_from_equilibrium(*position, self.constants, self.table.offset)
            elastic = preloaded_force(self.table.evaluate("energy", place[0]), place, self.constants)
            lever = self.interpolate("friction_lever", elastic)
            loads = preloaded_load(elastic, lever, velocity, spin, self.constants, self.table)
        force, moment = join_vector(kind, *loads[:3]), join_vector(kind, *loads[3:])
        return PreloadedLoad(force, moment, elastic.energy, self, elastic, is_finite)

    def interpolate(self, quantity: str, elastic: PreloadedForce) -> Array:
        """Interpolate a tabulated quantity at a displacement."""
        values = [derivatives[0] for derivatives in self.table.evaluate(quantity, elastic.distance)]
        return interpolate(values, elastic.cosine)
