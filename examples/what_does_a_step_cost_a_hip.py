"""
Friction moment and heat in a hip during a step
===============================================

The head of a hip turns in its cup under three times the body weight. How large are the friction moment and the heat?

The cycle is walking as in wear simulators (ISO 14242-1). A leg of 20 kg hangs on the head. The load of the cycle
pushes the head, and the rotation of the leg turns it. The force element computes force and moment at each instant.
Friction and damping dissipate the work of load and rotation, except for what is stored. The friction moment follows
from the pressure of the contact. With a head of 36 mm it is larger than with one of 28 mm, in proportion to the
radius.
"""

from math import radians

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction
from ballsocket.hip import iso_14242_1
from ballsocket.hip.kinematics import rotation_vectors

MASS, FRICTION = 2e-2, 0.06  # t, and of metal on polyethylene
CYCLE = iso_14242_1()
SPINS = 100 * rotation_vectors(CYCLE.rotations[1:] @ np.swapaxes(CYCLE.rotations[:-1], 1, 2))  # rad/s
TABLE = np.hstack([CYCLE.forces, (SPINS + np.roll(SPINS, 1, axis=0)) / 2])
ROWS = np.vstack([TABLE, TABLE[:2]]).tolist()


def course(time: float):
    """Load in N and spin in rad/s at a time of the cycle of a second."""
    number = int(100 * time)
    share = 100 * time - number
    both = [a + share * (b - a) for a, b in zip(ROWS[number], ROWS[number + 1], strict=True)]
    return both[:3], both[3:]


def walked(joint: bs.Joint):
    element = bs.ForceElement(
        bs.Tabulated(),
        joint,
        damping=Damping(time=2e-4),
        friction=Friction(coefficient=FRICTION, transition_speed=1.0),
        cup=bs.Cup(inclination=radians(30.0)),
    )

    def rates(time, state):
        position, velocity = state[:3].tolist(), state[3:6].tolist()
        pushed, spin = course(time)
        load = element(position, velocity, spin)
        push = [(a + b) / MASS for a, b in zip(load.force, pushed, strict=True)]
        work = sum(a * b for a, b in zip(pushed, velocity, strict=True))
        turned = sum(a * b for a, b in zip(load.moment, spin, strict=True))
        return [*velocity, *push, load.dissipation, work - turned]

    rest = bs.Tabulated().press(joint, force=float(CYCLE.forces[0, 2])).indentation
    start = [0.0, 0.0, joint.clearance + rest, *[0.0] * 5]
    done = solve_ivp(rates, (0.0, 1.0), start, method="LSODA", t_eval=np.linspace(0.0, 1.0, 201), rtol=1e-7, atol=1e-7)
    return done, element(done.y[:3].T, done.y[3:6].T, [course(time)[1] for time in done.t])


figure = Figure(figsize=(9.0, 3.9), layout="constrained")
moments, energies = figure.subplots(1, 2)
for name, colour in (("hip-28", "#0072B2"), ("hip-36", "#D55E00")):
    joint = bs.joints[name]
    done, loads = walked(joint)
    moment = np.linalg.norm(loads.moment, axis=1)
    stored = loads.energy + MASS * np.sum(done.y[3:6] ** 2, axis=0) / 2
    off = np.ptp(stored + done.y[6] - done.y[7]) / done.y[7, -1]
    most = int(moment.argmax())
    contact = bs.Tabulated().press(joint, force=float(np.linalg.norm(loads.force[most])))
    print(
        f"{name}: up to {moment[most] / 1e3:.2f} N m, {contact.friction_torque(FRICTION) / 1e3:.2f} by its pressure, "
        f"{done.y[6, -1] / 1e3:.2f} J a step, balanced to {off:.0e}"
    )
    moments.plot(100 * done.t, moment / 1e3, color=colour, label=name)
    energies.plot(100 * done.t, done.y[7] / 1e3, color=colour, label=f"{name}, put in")
    energies.plot(100 * done.t, done.y[6] / 1e3, "--", color=colour, label=f"{name}, lost")
moments.set_title("moment of friction [N m]", fontsize=10)
energies.set_title("energy [J]", fontsize=10)
for panel in (moments, energies):
    panel.set_xlabel("% of the step")
    panel.set_ylim(bottom=0)
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
    panel.legend(frameon=False, fontsize=8)
figure.savefig("what_does_a_step_cost_a_hip.png", dpi=150)
