"""Stress in the liner against its stated bounds: random axial joints by `Exact`, tilted cups by meridian harmonics.

Run `python docs/measure_stress_bounds.py [joints]`; the table of docs/explanation/valid.md has the numbers.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from math import exp, inf, log, pi, radians
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.core.arrays import Numbers
from ballsocket.elasticity.finite_elements.bodies import factorize
from ballsocket.elasticity.finite_elements.harmonics import Harmonics, _sum_powers, socket_harmonics
from ballsocket.elasticity.finite_elements.mesh import socket_shape
from ballsocket.elasticity.finite_elements.section import _CORNER_RADIUS, _superconvergent_points
from ballsocket.elasticity.off_axis.bore_shapes import BoreDeviation, OvalBore

RANGES = {
    "elastic ball": {"softness": (1e-4, 10.0)},
    "auxetic": {"poisson": (-0.9, 0.0)},
    "incompressible": {"poisson": (0.4993, 0.49999)},
    "thin": {"thickness_ratio": (20.5, 200.0)},
}
AZIMUTHS = numpy.append(numpy.linspace(0.0, pi / 2, 17), [0.75 * pi, pi])


def random_joint(random: numpy.random.Generator, ranges: dict[str, tuple[float, float]]) -> bs.Joint:
    """Draw a joint; softness is E over the modulus of the ball, which is rigid without it."""
    poisson = random.uniform(*ranges.get("poisson", (0.0, 0.4993)))
    low, high = ranges.get("thickness_ratio", (0.05, 20.5))
    ratio = exp(random.uniform(log(low), log(high)))
    liner = bs.Material(young=1000.0, poisson=poisson)
    ball = None
    if "softness" in ranges:
        low, high = ranges["softness"]
        ball = bs.Material(young=1000.0 / exp(random.uniform(log(low), log(high))), poisson=0.3)
    return bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=18.0 / ratio, liner=liner, ball=ball)


def axial_excesses(name: str, joints: int) -> Iterator[tuple[float, bool]]:
    """Yield the excess of the exact stress over the tabulated one, and whether the bounds contain it."""
    random = numpy.random.default_rng(2)
    for _ in range(joints):
        contact = bs.Exact(tolerance=1e-4).press(
            random_joint(random, RANGES[name]), half_angle=radians(random.uniform(1.0, 84.0))
        )
        if not contact.status.failed:
            stress, low, high = contact.quick_von_mises
            yield contact.von_mises / stress - 1, bool(low <= contact.von_mises <= high)


def harmonic_strains(meridian: Harmonics, contact: Any) -> Numbers:
    """Compute the strains (6, elements, points, azimuths) of a bore of radius 1 and E 1 under a map of pressure."""
    grid, pressure = contact._patch.grid, numpy.asarray(contact._patch.pressure)
    loads, block = meridian._ring_loads(grid.edges), meridian._block
    elements = numpy.arange(block.elements.shape[1])
    points, _ = _superconvergent_points(block.order)
    gradients = meridian.elastic.gradients(elements, points)
    plain, azimuthal = meridian._harmonic_strains(gradients.strain, points, gradients.coordinates[0])
    total = numpy.zeros((6, len(elements), points.shape[1], len(AZIMUTHS)))
    for m in range(min(grid.max_harmonic, 72) + 1):
        wave = pressure @ numpy.cos(m * grid.azimuth) / len(grid.azimuth) * (1 if m == 0 else 2)
        order, count = meridian._elimination_order(m)
        force, displacement = numpy.zeros(len(order)), numpy.zeros(3 * block.number.size)
        force[-count:] = (loads @ wave)[-count:]
        displacement[order] = factorize(_sum_powers(meridian.stiffness_powers, m), order).solve(force)
        strain = numpy.einsum("eqsu,eu->seq", plain + m * azimuthal, displacement[meridian._element_unknowns])
        waves = [numpy.cos(m * AZIMUTHS)] * 4 + [numpy.sin(m * AZIMUTHS)] * 2
        total += numpy.stack([part[..., None] * wave for part, wave in zip(strain, waves, strict=True)])
    return total


def largest_stress(contact: Any) -> float:
    """Compute the largest von Mises stress in MPa in a liner on a rigid backing, away from the corners of its rim."""
    meridian = socket_harmonics(socket_shape(contact.joint, contact.model.cup), contact._patch.grid.edges)
    block, (_, extrapolation) = meridian._block, _superconvergent_points(2)
    strain = harmonic_strains(meridian, contact)
    mean, shear = (strain[0] + strain[1] + strain[3]) / 3, float(meridian.elastic.moduli[0][0])
    stress = shear * numpy.stack([*(2 * (strain[i] - mean) for i in (0, 1, 3)), *strain[[2, 4, 5]]])
    nodes, total = block.elements.T, numpy.zeros((6, block.number.size, len(AZIMUTHS)))
    for sums, values in zip(total, numpy.einsum("ceqa,qn->cena", stress, extrapolation), strict=True):
        numpy.add.at(sums, nodes, values)
    total /= numpy.bincount(nodes.ravel(), minlength=block.number.size)[:, None]
    von_mises = numpy.sqrt(1.5 * (total[:3] ** 2).sum(0) + 3 * (total[3:] ** 2).sum(0))
    position, radius = numpy.asarray(block.nodes).reshape(2, -1), block.radius
    corners = position.reshape(2, *radius.shape)[:, -1, [0, -1]]
    distance = numpy.hypot(*(position[:, :, None] - corners[:, None])).min(axis=-1)
    size = min(float(contact.joint.liner_thickness / contact.joint.socket_radius), 1.0)
    return float(von_mises[distance > _CORNER_RADIUS * size].max())


def tilted_excesses(joints: int) -> Iterator[tuple[float, bool]]:
    """Yield the excess of the stress of tilted contacts over the axial one, and whether the bounds contain it."""
    random = numpy.random.default_rng(1)
    for _ in range(joints):
        joint = random_joint(random, {"poisson": (0.3, 0.49), "thickness_ratio": (1.0, 6.0)})
        cover, half_angle = random.uniform(140, 180), random.uniform(25, 52)
        tilt = max(radians(cover / 2 - half_angle) - random.uniform(0.0, 1.5) / float(joint.thickness_ratio), 0.0)
        force = float(bs.Tabulated().press(joint, half_angle=radians(half_angle)).force)
        contact = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(cover))).press(joint, force=force, tilt=tilt)
        stress, low, high = contact.quick_von_mises
        if not contact.status.failed and high < inf:
            largest = largest_stress(contact)
            yield largest / stress - 1, low <= largest <= high


def random_bore(random: numpy.random.Generator, tilt: float) -> Any:
    """Draw an oval bore, a wavy one, or one into which a ball with a clearance of 0.1 mm has worn near the load."""
    kind, size = random.integers(3), random.uniform(0.0, 1.0)
    if kind == 0:
        return OvalBore(squeeze=0.3 * size - 0.15)
    if kind == 1:
        waves = random.uniform(4.0, 12.0)
        return BoreDeviation(of=lambda n: 0.02 * size * numpy.cos(waves * numpy.arctan2(numpy.hypot(*n[:2]), n[2])))
    angle = tilt + radians(random.uniform(-20.0, 20.0))
    return BoreDeviation(
        of=lambda n: numpy.maximum((0.1 + 0.5 * size) * (n[0] * numpy.sin(angle) + n[2] * numpy.cos(angle)) - 0.1, 0.0)
    )


def worn_excesses(joints: int) -> Iterator[tuple[float, bool]]:
    """Yield the excess of the stress in bores that are no spheres, and whether the bounds contain it."""
    random = numpy.random.default_rng(3)
    for _ in range(joints):
        joint, tilt = (
            random_joint(random, {"poisson": (0.3, 0.49), "thickness_ratio": (1.0, 6.0)}),
            random.uniform(0, 0.8),
        )
        force = float(bs.Tabulated().press(joint, half_angle=radians(random.uniform(20, 45))).force)
        contact = bs.Sphere(worn=random_bore(random, tilt)).press(joint, force=force, tilt=tilt)
        stress, low, high = contact.quick_von_mises
        if not contact.status.failed and high < inf:
            largest = largest_stress(contact)
            yield largest / stress - 1, low <= largest <= high


def main(joints: int) -> None:
    """Print the range of the excess and the share of the stresses within their bounds."""
    off_axis = {"tilted": tilted_excesses, "worn": worn_excesses}
    for name in (*RANGES, *off_axis):
        rows = off_axis[name](joints) if name in off_axis else axial_excesses(name, joints)
        excesses, within = numpy.array(list(rows)).T
        print(f"{name}: {excesses.min():+.3f} to {excesses.max():+.3f}, {within.mean():.1%} of {len(within)} within")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
