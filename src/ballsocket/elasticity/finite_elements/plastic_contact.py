"""Contact of a ball with a socket whose liner yields, along a path of loads.

Each increment is solved by Newton's method with the consistent tangent, whose steps end at the lowest energy if they
raise the residual: near collapse, where the tangent is soft, full ones diverge. Its linear problem is a contact problem
on the bore: the tangent compliance of the socket and the compliance of the ball, with pressures that are linear between
the corners of elements. An active set makes each pressure positive or its gap open. The contact need not be a cap:
after a permanent set it can begin anywhere.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy
from scipy.optimize import brentq

from ...core.arrays import Numbers
from ...core.quantities import SHAKEDOWN_WORK
from ...problem.gaps import Gap
from .bodies import SurfacePair
from .pair_contact import edge_beyond, pressure_at_pole
from .plastic_body import PlasticBody, Tangent
from .plasticity import PlasticStrain

_MAX_ITERATIONS, _MAX_SET_CHANGES = 50, 60
_TOLERANCE = 1e-8  # of the nodal forces, relative
_MAX_REPETITIONS = 20  # of a load
_START_FRACTION = 0.25  # of the nodes: first guess of a contact
_GAP_STEP = 1e-6  # over the radius


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticContact:
    """Equilibrium of ball and yielding socket.

    `pressures` (nodes,) are in MPa at the pair's angles, and `displacement` the unknowns of the socket of unit radius.
    """

    path: PlasticPath
    indentation: float  # in mm
    pressures: Numbers
    displacement: Numbers
    plastic: PlasticStrain
    stiffness: float  # tangent stiffness in N/mm, of the direction of the last increment

    tension: ClassVar[float] = 0.0  # the active set has neither tension nor overlap
    overlap: ClassVar[float] = 0.0

    @property
    def pair(self) -> SurfacePair:
        """Contact surfaces."""
        return self.path.pair

    @property
    def force(self) -> float:
        """Force F in N."""
        return float(self.pressures @ self.path.axial_areas)

    @property
    def pressure_integral(self) -> float:
        """Integral of the pressure over the contact area, ∫ p dA, in N."""
        return float(self.pressures @ self.path.areas)

    @cached_property
    def half_angle(self) -> float:
        """Half angle in rad of the outer edge, from the gaps beyond it."""
        touching = numpy.flatnonzero(self.pressures > 0)
        if not len(touching):
            return 0.0
        first, last = self.pair.angle[[touching[-1], min(touching[-1] + 2, len(self.pair.angle) - 1)]]
        angle = self.pair.surfaces[0].angle
        gaps = self.bore_displacement - self.path.gap.displacement(angle, self.indentation)
        for surface in self.pair.surfaces[1:]:
            gaps = gaps + numpy.interp(angle, surface.angle, surface.compliance @ self.forces(1))
        edge = edge_beyond(int(numpy.searchsorted(angle, first)), angle, numpy.maximum(gaps, 0.0))
        return float(numpy.clip(edge, first, last))

    @property
    def fills_bore(self) -> bool:
        """True if the last pressure node is pressed."""
        return bool(self.pressures[-1] > 0)

    @property
    def edge_element(self) -> float:
        """Length in rad of the elements at the edge."""
        last = int(numpy.flatnonzero(self.pressures > 0)[-1]) if self.pressures.any() else 0
        return float(numpy.diff(self.pair.angle)[max(last - 1, 0)])

    @cached_property
    def pole_pressure(self) -> float:
        """Pressure p0 at the pole in MPa, extrapolated because the node at the pole has almost no area."""
        if not self.pressures.any():
            return 0.0
        return pressure_at_pole(self.pair.angle, self.pressures, self.half_angle)

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (rad); 0 outside the contact."""
        nodes = numpy.append(self.pole_pressure, self.pressures[1:])
        return numpy.where(angle <= self.half_angle, numpy.interp(angle, self.pair.angle, nodes), 0.0)

    def forces(self, surface: int) -> Numbers:
        """Compute normal forces in N on the nodes of a surface: 0 is the socket, 1 the ball."""
        return self.pair.forces[surface] @ self.pressures

    @property
    def bore_displacement(self) -> Numbers:
        """Normal displacement of the bore's nodes in mm, outwards."""
        return self.pair.radius * self.displacement[-len(self.path.body.body.contact) :]

    @cached_property
    def unloaded(self) -> PlasticContact | None:
        """Equilibrium after the load is removed; None if it is not found."""
        return self.path.approach("force", 0.0, self) if self.pressures.any() else self

    @property
    def permanent_set(self) -> float:
        """Largest outward displacement of the bore in mm that remains after the load is removed; NaN if unknown."""
        if not self.plastic_work:
            return 0.0
        return numpy.nan if self.unloaded is None else max(float(self.unloaded.bore_displacement.max()), 0.0)

    @cached_property
    def repeated_work(self) -> float:
        """Plastic work of the last of repeated loads, over the work until then; 0 once a repetition is elastic."""
        contact, growth = self, 0.0
        for _ in range(_MAX_REPETITIONS if self.plastic_work > 0 else 0):
            rest = contact.unloaded
            repeated = None if rest is None else self.path.approach("force", self.force, rest)
            if repeated is None:
                return numpy.inf
            contact, growth = repeated, repeated.plastic_work / contact.plastic_work - 1
            if growth < SHAKEDOWN_WORK:
                break
        return growth

    @property
    def plastic_strain(self) -> float:
        """Largest equivalent plastic strain in the liner."""
        return float(self.plastic.equivalent.max())

    @property
    def plastic_fraction(self) -> float:
        """Fraction of the liner's volume that has yielded."""
        volume = self.path.body.volume
        return float(volume[self.plastic.equivalent > 0].sum() / volume.sum())

    @property
    def plastic_work(self) -> float:
        """Accumulated work of the stresses on plastic strains in N mm."""
        return float(self.path.energy_unit * numpy.sum(self.plastic.work * self.path.body.volume))

    @property
    def von_mises(self) -> float:
        """Largest von Mises stress in the liner in MPa, at the quadrature points."""
        return float(self.path.young * self.path.body.von_mises(self.displacement, self.plastic).max())

    @property
    def energy(self) -> float:
        """Work of the load in N mm: elastic energy of both bodies, and plastic work."""
        socket = self.path.energy_unit * self.path.body.elastic_energy(self.displacement, self.plastic)
        ball = self.pressures @ (self.path.ball_matrix @ self.pressures) / 2
        return float(socket + ball) + self.plastic_work


class _Response(NamedTuple):
    """Strain deviators of a liner, their plastic strain and factors of the tangent, and nodal forces on the socket."""

    strain: Numbers
    plastic: PlasticStrain
    a: Numbers
    b: Numbers
    forces: Numbers  # of the pressures
    internal: Numbers  # of the stresses

    @property
    def residual(self) -> float:
        """Norm of the forces without equilibrium."""
        return float(numpy.linalg.norm(self.forces - self.internal))


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticPath:
    """Surfaces in contact, of which the socket yields; `young` is the liner's modulus in MPa."""

    body: PlasticBody
    pair: SurfacePair
    gap: Gap
    young: float

    @property
    def energy_unit(self) -> float:
        """Energy in N mm of a unit energy of the body."""
        return self.young * self.pair.radius**3

    @cached_property
    def axial_areas(self) -> Numbers:
        """Integrals of the pressure functions times cos φ, in mm²."""
        return self.pair.integrate_with_shapes(numpy.cos(self.pair.points[0]))

    @cached_property
    def areas(self) -> Numbers:
        """Integrals of the pressure functions, in mm²."""
        return self.pair.integrate_with_shapes(numpy.ones_like(self.pair.points[0]))

    @cached_property
    def ball_matrix(self) -> Numbers:
        """Integrals ∫ φ_i (displacement of the ball by φ_j) dA in mm³/MPa; 0 for a rigid ball."""
        parts = zip(self.pair.forces[1:], self.pair.displacements[1:], strict=True)
        return sum((forces.T @ moved for forces, moved in parts), numpy.zeros((len(self.areas), len(self.areas))))

    def _imposed(self, indentation: float) -> Numbers:
        """Integrate the displacement by a rigid ball with the pressure functions, in mm³."""
        return self.pair.integrate_with_shapes(self.gap.displacement(self.pair.points[0], indentation))

    @cached_property
    def start(self) -> PlasticContact:
        """Contact before the first load."""
        return PlasticContact(
            path=self,
            indentation=0.0,
            pressures=0.0 * self.areas,
            displacement=numpy.zeros(len(self.body.free_unknowns)),
            plastic=PlasticStrain.zero(self.body.volume.shape),
            stiffness=0.0,
        )

    def approach(self, kind: str, load: float, old: PlasticContact) -> PlasticContact | None:
        """Go from a contact to a load ("force" in N, "indentation" in mm) in one increment; None without equilibrium.

        There is none either if Newton's method does not converge.
        """
        with suppress(numpy.linalg.LinAlgError, RuntimeError):  # singular: a liner that collapses has no stiffness
            size = len(old.displacement)
            state = numpy.concatenate([old.displacement, old.pressures, [old.indentation]])
            response, residual = self._respond(state, old.plastic), numpy.inf
            scale = numpy.linalg.norm(response.forces)
            for _ in range(_MAX_ITERATIONS):
                tangent = self.body.tangent(*response[:4])
                unloaded = state[:size] - tangent.factors.solve(response.internal)
                linear = self._solve_contact(kind, load, tangent, unloaded, state[size:-1], state[-1])
                if linear is None:
                    return None
                pressures, d, stiffness = linear
                moved = tangent.factors.solve(self._nodal_forces(pressures) - response.internal)
                step = numpy.concatenate([moved, pressures - state[size:-1], [d - state[-1]]])
                response, previous = self._respond(state + step, old.plastic), residual
                if response.residual > previous:
                    step *= self._share_of(step, state, old.plastic, load if kind == "force" else 0.0)
                    response = self._respond(state + step, old.plastic)
                state, residual = state + step, response.residual
                is_linear = abs(step[-1]) <= 1e-4 * abs(state[-1]) or self.gap.steps == 1
                if residual <= _TOLERANCE * max(numpy.linalg.norm(response.forces), scale) and is_linear:
                    return PlasticContact(
                        path=self,
                        indentation=float(state[-1]),
                        pressures=state[size:-1],
                        displacement=state[:size],
                        plastic=response.plastic,
                        stiffness=stiffness,
                    )
                if not numpy.isfinite(residual):
                    return None
        return None

    def _nodal_forces(self, pressures: Numbers) -> Numbers:
        """Compute the forces of pressures on the free unknowns of the socket."""
        forces = numpy.zeros(len(self.body.free_unknowns))
        forces[-len(self.body.body.contact) :] = self.pair.forces[0] @ pressures / (self.young * self.pair.radius**2)
        return forces

    def _respond(self, state: Numbers, old: PlasticStrain) -> _Response:
        """Compute the response to a state: displacements of the socket, then pressures, then the indentation."""
        size = len(self.body.free_unknowns)
        strain = self.body.strain(state[:size])
        plastic, a, b = self.body.law.update(strain, old)
        internal = self.body.internal_forces(state[:size], plastic)
        return _Response(strain, plastic, a, b, self._nodal_forces(state[size:-1]), internal)

    def _share_of(self, step: Numbers, state: Numbers, old: PlasticStrain, force: float) -> float:
        """Find the share of a step with the lowest energy, which is a convex function of the state."""
        size = len(self.body.free_unknowns)
        ball = self.ball_matrix @ step[size:-1]

        def slope(share: float) -> float:
            moved = state + share * step
            socket = self._respond(moved, old).internal @ step[:size]
            return float(self.energy_unit * socket + moved[size:-1] @ ball - force * step[-1])

        return brentq(slope, 0.0, 1.0, xtol=1e-3, rtol=0.1) if slope(0.0) < 0 < slope(1.0) else 1.0

    def _solve_contact(
        self, kind: str, load: float, tangent: Tangent, unloaded: Numbers, pressures: Numbers, d: float
    ) -> tuple[Numbers, float, float] | None:
        """Solve the linearised contact: pressures, indentation and tangent stiffness; None without a consistent set.

        `unloaded` are the displacements of the socket without pressure. The gap is linearised at the indentation `d`,
        and the active set starts from the pressures.
        """
        radius, forces = self.pair.radius, self.pair.forces[0]
        matrix = forces.T @ (tangent.bore_compliance / (radius * self.young)) @ forces + self.ball_matrix
        imposed, step = self._imposed(d), _GAP_STEP * radius
        rise = (self._imposed(d + step) - imposed) / step
        openings = radius * forces.T @ unloaded[-tangent.count :] - imposed + rise * d  # gaps at d = 0
        if kind == "force" and load <= 0:
            return 0.0 * pressures, float((openings / rise)[rise > 0].min()), 0.0
        weight = numpy.trace(matrix) / self.areas.sum()
        active = pressures > 0
        if not active.any():
            active[: max(int(_START_FRACTION * len(active)), 2)] = True
        for _ in range(_MAX_SET_CHANGES):
            if kind == "indentation" and not active.any():
                active = openings < rise * load
                if not active.any():
                    return 0.0 * pressures, load, 0.0
            nodes = numpy.flatnonzero(active)
            columns = numpy.column_stack([rise[nodes], openings[nodes]])
            by_depth, by_opening = numpy.linalg.solve(matrix[numpy.ix_(nodes, nodes)], columns).T
            stiffness = float(self.axial_areas[nodes] @ by_depth)
            if kind == "force" and not stiffness > 0:
                return None
            d = (load + float(self.axial_areas[nodes] @ by_opening)) / stiffness if kind == "force" else load
            pressures = numpy.zeros(len(openings))
            pressures[nodes] = by_depth * d - by_opening
            gaps = matrix @ pressures + openings - rise * d
            gaps[nodes] = 0.0
            following = weight * self.areas * pressures > gaps + 1e-12 * abs(rise * d)
            if (following == active).all():
                return pressures, d, stiffness
            if kind == "force" and not following.any():
                following = openings == openings.min()
            active = following
        return None
