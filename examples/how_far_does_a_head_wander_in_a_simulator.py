"""
Motion of a head in a hip simulator
===================================

A wear simulator pushes a cup against a head that its motors turn. The holder of the cup can move across the load. How
far does the head move in a steep cup, and where does the work of load and motors go?

One station runs the cycle of ISO 14242-1 (1 Hz, 300 to 3000 N). Its holder of 4 kg carries a metal-backed cup of 36
mm, and slides on guides with a little viscous drag. Friction alone makes the head climb up its cup, back and forth.
In a cup at 30° the load is far from the rim. In a cup at 70° the rim cuts the contact and pushes the head aside,
until the rest of the contact pushes straight up. Friction, liner and guides dissipate the work of load and motors,
except for what is stored.
"""

from math import radians

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction
from ballsocket.hip import iso_14242_1
from ballsocket.hip.kinematics import rotation_vectors

HOLDER, DRAG, FRICTION = 4e-3, 0.5, 0.06  # t; N s/mm in the guides; of metal on polyethylene
JOINT = bs.joints["hip-36"]
CYCLE = iso_14242_1()
TURNS = 100 * rotation_vectors(CYCLE.rotations[1:] @ np.swapaxes(CYCLE.rotations[:-1], 1, 2))  # rad/s
TABLE = np.hstack([CYCLE.forces[:, 2:], (TURNS + np.roll(TURNS, 1, axis=0)) / 2])
ROWS = np.vstack([TABLE, TABLE[:2]]).tolist()


def course(time: float):
    """Load in N and spin in rad/s at a time of the cycle of a second."""
    number = int(100 * time)
    share = 100 * time - number
    load, *spin = (a + share * (b - a) for a, b in zip(ROWS[number], ROWS[number + 1], strict=True))
    return load, spin


def station(inclination: float):
    """A cycle: where the head is in the cup, how fast, what was lost and put in; and its element."""
    element = bs.ForceElement(
        bs.Tabulated(),
        JOINT,
        damping=Damping(time=2e-4),
        friction=Friction(coefficient=FRICTION, transition_speed=1.0),
        cup=bs.Cup(inclination=inclination),
    )

    def rates(time, state):
        position, velocity = state[:3].tolist(), state[3:6].tolist()
        push, spin = course(time)
        load = element(position, velocity, spin)
        drag = [DRAG * velocity[0], DRAG * velocity[1], 0.0]  # seen from the cup all is the other way round
        speeds = [(f - d) / HOLDER for f, d in zip(load.force, drag, strict=True)]
        speeds[2] += push / HOLDER
        guides = drag[0] * velocity[0] + drag[1] * velocity[1]
        turned = sum(m * w for m, w in zip(load.moment, spin, strict=True))
        return [*velocity, *speeds, load.dissipation + guides, push * velocity[2] - turned]

    rest = bs.Tabulated().press(JOINT, force=ROWS[0][0]).indentation
    start = [0.0, 0.0, JOINT.clearance + rest, *[0.0] * 5]
    times = np.linspace(0.0, 1.0, 201)
    done = solve_ivp(rates, (0.0, 1.0), start, method="LSODA", t_eval=times, rtol=1e-7, atol=1e-7)
    return done, element


figure = Figure(figsize=(9.0, 3.9), layout="constrained")
ways, sides, energies = figure.subplots(1, 3)
for inclination, colour in ((30.0, "#0072B2"), (70.0, "#D55E00")):
    done, element = station(radians(inclination))
    loads = element(done.y[:3].T, done.y[3:6].T, [course(time)[1] for time in done.t])
    stored = loads.energy + HOLDER / 2 * np.sum(done.y[3:6] ** 2, axis=0)
    off = np.ptp(stored + done.y[6] - done.y[7]) / done.y[7, -1]
    cut = np.mean(loads.status == bs.dynamics.ContactState.AT_RIM)
    aside = np.hypot(done.y[0], done.y[1])
    print(
        f"{inclination:g}°: up to {1e3 * aside.max():.0f} µm aside, at the rim for {100 * cut:.0f} % of the cycle, "
        f"{done.y[6, -1] / 1e3:.2f} J lost, balanced to {off:.0e}"
    )
    label = f"cup at {inclination:g}°"
    ways.plot(1e3 * done.y[0], 1e3 * done.y[1], color=colour, label=label)
    sides.plot(100 * done.t, np.linalg.norm(loads.moment, axis=1) / 1e3, color=colour)
    energies.plot(100 * done.t, done.y[7] / 1e3, color=colour, label="put in")
    energies.plot(100 * done.t, done.y[6] / 1e3, "--", color=colour, label="lost")
ways.set_title("the head seen along the load [µm]", fontsize=10)
ways.set_aspect("equal", adjustable="datalim")
sides.set_title("moment of friction [N m]", fontsize=10)
energies.set_title("energy [J]", fontsize=10)
for panel in (sides, energies):
    panel.set_xlabel("% of the cycle")
for panel in (ways, sides, energies):
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
ways.legend(frameon=False, fontsize=8)
energies.legend(frameon=False, fontsize=8)
figure.savefig("how_far_does_a_head_wander_in_a_simulator.png", dpi=150)
