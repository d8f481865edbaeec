"""
Spatial four-bar with clearance in a ball joint
===============================================

A crank, a coupler and a rocker whose axes cross in space fall from rest. The ball joint between coupler and rocker
has clearance. Do other programs compute the same motion, and where does the energy go?

The ball of 20 mm has a socket of acetal, 0.2 mm wider all round. The ball joint at the crank is ideal. The element
needs the geometry and the material of the joint alone. The same law, exported to Exudyn and used in Exudyn's model of
the mechanism, gives the same motion until the errors of the steps there, of second order, become visible.

Exudyn's hollow sphere uses the nearest k and n and a restitution of 0.8. Its swing agrees within a milliradian, but
it rattles in another way. Its loss depends on the speed of each impact, and it still rattles when the other is at
rest.

Both results of Exudyn are stored (``benchmarks/four_bar.py`` computes them). Compiled, the element and this mechanism
take 30 ms for one second of motion in steps of 40 µs (``python -m benchmarks four-bar``).
"""

from math import cos, hypot, sin
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Gonthier

HERE = Path(__file__).parent if "__file__" in globals() else Path()  # the gallery runs it where it stands
GRAVITY, THICK = 9806.65, 16.0  # mm/s², and the radius of the links in mm
CRANK, ROCKER = (100.0, 2e-3), (150.0, 2.5e-3)  # mm, t: the crank turns about x, the rocker about y
COUPLER = (hypot(200.0, 100.0, 50.0), 3e-3)
PIVOT = (200.0, 0.0, -100.0)  # of the rocker; that of the crank is the origin
START = (0.0, 0.0, *(side / COUPLER[0] for side in (200.0, -100.0, 50.0)), *[0.0] * 7)
JOINT = bs.Joint(ball_radius=10.0, clearance=0.2, liner_thickness=2.0, liner=bs.POM, ball=bs.STEEL)
ELEMENT = bs.ForceElement(bs.Tabulated(), JOINT, damping=Gonthier(restitution=0.8, impact_speed=50.0))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a, k, b):
    return a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]


def at_joint(y):
    """Position, velocity and spin of the ball in the socket, and the ball's arm about the rocker's pivot.

    The state is the angle of the crank and its rate, the direction of the coupler, its rate and the spin about it. Then
    follow the angle of the rocker, its rate, and the lost energy. A full sphere is the same in all axes: the axes are
    those of the ground.
    """
    a, b, r = CRANK[0], COUPLER[0], ROCKER[0]
    along, turn = (y[2], y[3], y[4]), (y[5], y[6], y[7])
    ball = plus((0.0, a * cos(y[0]), a * sin(y[0])), b, along)
    speed = plus((0.0, -a * sin(y[0]) * y[1], a * cos(y[0]) * y[1]), b, turn)
    arm = plus(ball, -1.0, PIVOT)
    spin = plus(cross(along, turn), y[8], along)
    position = plus(arm, -r, (sin(y[9]), 0.0, cos(y[9])))
    velocity = plus(speed, -y[10], (arm[2], 0.0, -arm[0]))
    return position, velocity, (spin[0], spin[1] - y[10], spin[2]), arm


def rates(ask, joint, y):
    """Return the rates of the state; `ask(joint, position, velocity, spin)` returns force, moment and lost power."""
    (a, m), (b, M), (r, n) = CRANK, COUPLER, ROCKER
    u, turn = (y[2], y[3], y[4]), (y[5], y[6], y[7])
    position, velocity, spin, arm = at_joint(y)
    force, moment, lost = ask(joint, position, velocity, spin)
    out, ahead = (0.0, cos(y[0]), sin(y[0])), (0.0, -sin(y[0]), cos(y[0]))  # of the crank
    # the coupler about its end at the crank, whose acceleration is a (angle'' ahead - angle'² out)
    pushed = plus(moment, b, cross(u, plus(force, -0.5 * M * GRAVITY, (0.0, 0.0, 1.0))))
    around, axial = M * b * b / 3.0, M * THICK * THICK / 2.0
    free = plus((0.0, 0.0, 0.0), 1.0 / around, plus(cross(pushed, u), -axial * y[8], cross(turn, u)))
    free = plus(plus(free, -dot(turn, turn), u), 1.5 * a * y[1] * y[1] / b, plus(out, -dot(out, u), u))
    level = plus(ahead, -dot(ahead, u), u)
    heavy = a * a * (m / 3.0 + M * (1.0 - 0.75 * dot(level, level)))
    carried = ahead[2] * GRAVITY * (m / 2.0 + M) + M * b / 2.0 * dot(ahead, free) - dot(ahead, force)
    crank = -a * carried / heavy
    bend = plus(free, -1.5 * a * crank / b, level)
    rocker = (n * GRAVITY * r / 2.0 * sin(y[9]) - cross(arm, force)[1] - moment[1]) / (n * r * r / 3.0)
    return y[1], crank, *turn, *bend, dot(pushed, u) / axial, y[10], rocker, lost


def mechanical(y):
    """What moves and what is raised, in N mm, of states (12, times)."""
    (a, m), (b, M), (r, n) = CRANK, COUPLER, ROCKER
    end = np.stack([0 * y[0], -a * np.sin(y[0]) * y[1], a * np.cos(y[0]) * y[1]])
    middle = np.sum((end + b / 2 * y[5:8]) ** 2, axis=0)
    turning = b**2 / 12 * np.sum(y[5:8] ** 2, axis=0) + THICK**2 / 2 * y[8] ** 2
    moving = (m * (a * y[1]) ** 2 / 3 + M * (middle + turning) + n * (r * y[10]) ** 2 / 3) / 2
    raised = m * a / 2 * np.sin(y[0]) + M * (a * np.sin(y[0]) + b / 2 * y[4]) + n * r / 2 * np.cos(y[9])
    return moving + GRAVITY * raised


def ask(element, position, velocity, spin):
    load = element(position, velocity, spin)
    return load.force, load.moment, load.dissipation


def fallen(times, element=ELEMENT):
    """The states of the mechanism (12, times) with its element, in Python."""
    options = {"method": "LSODA", "rtol": 1e-9, "atol": 1e-10, "max_step": 1e-3}
    given = lambda _, y: rates(ask, element, y.tolist())  # noqa: E731
    return solve_ivp(given, (0.0, times[-1]), START, t_eval=times, **options).y


if __name__ == "__main__":
    kept = np.genfromtxt(HERE / "four_bar_in_exudyn.csv", delimiter=",", names=True)
    times = kept["time_s"]
    states = fallen(times)
    angle, lost = states[9], states[11]
    centres = np.array([at_joint(y)[0] for y in states.T.tolist()])
    energy = mechanical(states) + ELEMENT(centres).energy
    print(f"lost {lost[-1]:.3f} N mm, balanced to {np.ptp(energy + lost) / lost[-1]:.0e} of it")
    figure = Figure(figsize=(9.0, 3.9), layout="constrained")
    swung, apart, went = figure.subplots(1, 3)
    swung.plot(times, np.degrees(angle), color="#0072B2", label="this element")
    went.plot(times, lost, color="#0072B2", label="this element")
    went.plot(
        times[::5], energy[0] - energy[::5], "o", color="#0072B2", fillstyle="none", markersize=4, label="balance"
    )
    for name, label, colour in (("law", "exported to Exudyn", "#009E73"), ("sphere", "hollow sphere", "#D55E00")):
        off = kept[f"{name}_angle_rad"] - angle
        swung.plot(times, np.degrees(kept[f"{name}_angle_rad"]), "--", color=colour, label=label)
        apart.plot(times, 1e3 * off, color=colour, label=label)
        went.plot(times, kept[f"{name}_lost_N_mm"], "--", color=colour, label=label)
        print(f"{label}: {1e3 * abs(off).max():.2f} mrad away, {kept[f'{name}_lost_N_mm'][-1]:.3f} N mm lost")
    titles = "angle of the rocker [°]", "how far from this element [mrad]", "energy lost [N mm]"
    for panel, title in zip((swung, apart, went), titles, strict=True):
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("time [s]")
        panel.grid(color="0.9", linewidth=0.6)
        panel.spines[["top", "right"]].set_visible(False)
    went.legend(frameon=False, fontsize=8)
    figure.savefig("what_does_clearance_do_to_a_four_bar.png", dpi=150)
