"""One step of a ball in its socket: energy is kept to rounding, and what damping and friction take is never below 0.

The discrete gradient of Gonzalez: the elastic force of a step is that at its middle plus a part along the way, so that
its work is exactly what the energy falls by; damping, friction and spin are those at the middle of the step.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from ..arrays import divisor
from .reaction import Constants, Three, dissipation, elastic, place_of, pressed, reaction, sliding

ROUNDS = 60


class Ball(NamedTuple):
    """The ball as it moves: its centre (mm), velocity (mm/s) and spin (rad/s), seen from a socket at rest."""

    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float
    wx: float
    wy: float
    wz: float


class Step(NamedTuple):
    """What a step led to: the ball, what was lost (N mm), and whether the iteration converged and the cup holds it."""

    ball: Ball
    lost: float
    good: bool


def energy_of(potential, ball: Ball, given: Constants) -> float:  # type: ignore[no-untyped-def]
    """Stored in the contact, in N mm."""
    return elastic(potential, place_of(ball.x, ball.y, ball.z, given.clearance), given).energy


def stepped(potential, given: Constants, ball: Ball, mass: float, inertia: float, pull: Three, h: float) -> Step:  # type: ignore[no-untyped-def]
    """The ball after h seconds.

    `mass` in t (N s²/mm), `inertia` in t mm², `pull` a constant force in N. The unknowns are velocity and spin at the
    middle of the step; each round solves for them as if stiffness and friction's rate were constant.
    """
    x, y, z, vx, vy, vz, wx, wy, wz = ball
    before = energy_of(potential, ball, given)
    # unknown: velocity and spin at the middle
    ax, ay, az = vx + pull[0] * h / (2.0 * mass), vy + pull[1] * h / (2.0 * mass), vz + pull[2] * h / (2.0 * mass)
    bx, by, bz = wx, wy, wz
    heavy, slow = 2.0 * mass / h, 2.0 * inertia / h
    size = 1e-300 + abs(ax) + abs(ay) + abs(az) + given.ball_radius * (abs(bx) + abs(by) + abs(bz))
    best, moved, lost, held = 1e300, 1e300, 0.0, True
    for _ in range(ROUNDS):
        place = place_of(x + 0.5 * h * ax, y + 0.5 * h * ay, z + 0.5 * h * az, given.clearance)
        contact = elastic(potential, place, given)
        fx, fy, fz, mx, my, mz = reaction(place, contact, (ax, ay, az), (bx, by, bz), given)
        there = place_of(x + h * ax, y + h * ay, z + h * az, given.clearance)
        end = elastic(potential, there, given)
        held = end.covered > -1.0 or there.indentation <= -given.smoothing
        # the part along the way: what the middle's force misses of the energy's fall
        gx = contact.normal * place.x - contact.polar * contact.px
        gy = contact.normal * place.y - contact.polar * contact.py
        gz = contact.normal * place.z - contact.polar * contact.pz
        square = h * divisor(ax * ax + ay * ay + az * az)
        missed = (end.energy - before) / square - (gx * ax + gy * ay + gz * az) * h / square
        rx = heavy * (ax - vx) - fx + missed * ax - pull[0]
        ry = heavy * (ay - vy) - fy + missed * ay - pull[1]
        rz = heavy * (az - vz) - fz + missed * az - pull[2]
        sx, sy, sz = slow * (bx - wx) - mx, slow * (by - wy) - my, slow * (bz - wz) - mz
        nx, ny, nz = place.x, place.y, place.z
        speed = ax * nx + ay * ny + az * nz
        slip = sliding(place, pressed(contact, speed, given), (ax, ay, az), (bx, by, bz), given)
        rate, R1 = slip.rate, given.ball_radius
        lossy = given.hysteresis * contact.damped_force + given.time * contact.damped_stiffness
        across = (0.5 * h * contact.normal + given.time * contact.damped_force) * place.over
        outward = rx * nx + ry * ny + rz * nz
        turning = sx * nx + sy * ny + sz * nz
        dn = -outward / (heavy + lossy + 0.5 * h * abs(contact.stiffness))
        dw = -turning / (slow + rate * slip.lever_squared)
        # across the load: slip = v + R1 ω x n ties velocity and u = ω x n
        A, B, C = heavy + rate + across, slow + rate * R1 * R1, rate * R1
        over = 1.0 / (A * B - C * C)
        tx, ty, tz = rx - outward * nx, ry - outward * ny, rz - outward * nz
        ux, uy, uz = sy * nz - sz * ny, sz * nx - sx * nz, sx * ny - sy * nx
        dx, dy, dz = (C * ux - B * tx) * over, (C * uy - B * ty) * over, (C * uz - B * tz) * over
        ex, ey, ez = (C * tx - A * ux) * over, (C * ty - A * uy) * over, (C * tz - A * uz) * over
        moved = abs(dx) + abs(dy) + abs(dz) + abs(dn) + R1 * (abs(ex) + abs(ey) + abs(ez) + abs(dw))
        if not isfinite(moved):
            break
        ax, ay, az = ax + dx + dn * nx, ay + dy + dn * ny, az + dz + dn * nz
        bx, by, bz = (
            bx + ny * ez - nz * ey + dw * nx,
            by + nz * ex - nx * ez + dw * ny,
            bz + nx * ey - ny * ex + dw * nz,
        )
        lost = h * dissipation(place, contact, (ax, ay, az), (bx, by, bz), given)
        if moved <= 1e-16 * size or (moved <= 1e-11 * size and moved >= 0.5 * best):
            break
        best = min(best, moved)
    made = Ball(
        x + h * ax, y + h * ay, z + h * az,
        2.0 * ax - vx, 2.0 * ay - vy, 2.0 * az - vz,
        2.0 * bx - wx, 2.0 * by - wy, 2.0 * bz - wz,
    )  # fmt: skip
    return Step(made, lost, held and moved <= 1e-11 * size)


def march(  # type: ignore[no-untyped-def]
    potential, given: Constants, ball: Ball, mass: float, inertia: float, pulls, h: float, states, lost
) -> int:
    """Steps into `states` (steps + 1, 9) and `lost` (steps + 1,), pulled by `pulls` (steps, 3); how many were good."""
    states[0, :] = ball
    for number in range(len(lost) - 1):
        pull = pulls[number, 0], pulls[number, 1], pulls[number, 2]
        after = stepped(potential, given, ball, mass, inertia, pull, h)
        ball = after.ball
        states[number + 1, :] = ball
        lost[number + 1] = lost[number] + after.lost
        if not after.good:
            return number
    return len(lost) - 1
