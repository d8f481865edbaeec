"""
Pendulum on a ball joint with clearance
=======================================

A pendulum hangs from a ball in a socket that is wider than the ball. Where is the ball, and how much energy does
friction take?

A bob of 2 kg swings on a rod of 200 mm. The rod hangs from a steel ball of 20 mm in a socket lined with UHMWPE, half
a millimetre wider all round. Without friction the joint has no moment, and the contact lies in the direction of the
rod, except for a small effect of the bob's inertia. With friction the ball rolls up the socket until it slides. It
then slides at a constant angle, on the other side on the way back. The swing loses the work of friction and nothing
else.
"""

from math import cos, radians, sin

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction

MASS, LENGTH, INERTIA, GRAVITY = 2e-3, 200.0, 5.0, 9806.65  # t, mm, t mm², mm/s²
JOINT = bs.Joint(ball_radius=10.0, clearance=0.5, liner_thickness=4.0, liner=bs.UHMWPE, ball=bs.STEEL)
START, SECONDS = radians(40.0), 1.8


def element(coefficient: float) -> bs.ForceElement:
    friction = Friction(coefficient=coefficient, transition_speed=0.5) if coefficient else None
    return bs.ForceElement(bs.Tabulated(), JOINT, damping=Damping(time=1e-4), friction=friction)


def load_of(joint: bs.ForceElement, state):
    """The load of the joint; the state is that of the bob's centre: x, y, angle, their rates, and what was lost."""
    x, y, angle, vx, vy, turn, _ = state.tolist()
    s, c = LENGTH * sin(angle), LENGTH * cos(angle)
    return joint((x - s, y + c, 0.0), (vx - c * turn, vy - s * turn, 0.0), (0.0, 0.0, turn))


def swing(joint: bs.ForceElement):
    def rates(_, state):
        load = load_of(joint, state)
        (fx, fy, _), angle = load.force, state[2]
        # the ball's centre lies at (-sin, cos) times the rod's length from the bob's
        moment = load.moment[2] - LENGTH * (sin(angle) * fy + cos(angle) * fx)
        return [*state[3:6], fx / MASS, fy / MASS - GRAVITY, moment / INERTIA, load.dissipation]

    hung = JOINT.clearance + bs.Tabulated().press(JOINT, force=MASS * GRAVITY).indentation
    far = LENGTH + hung
    start = [far * sin(START), -far * cos(START), START, 0.0, 0.0, 0.0, 0.0]
    times = np.linspace(0.0, SECONDS, 400)
    return times, solve_ivp(rates, (0.0, SECONDS), start, method="LSODA", t_eval=times, rtol=1e-11, atol=1e-11).y


if __name__ == "__main__":
    figure = Figure(figsize=(9.0, 3.9), layout="constrained")
    swung, climbed, went = figure.subplots(1, 3)
    for coefficient, colour in ((0.0, "#0072B2"), (0.1, "#D55E00"), (0.3, "#009E73")):
        joint = element(coefficient)
        times, y = swing(joint)
        loads = [load_of(joint, state) for state in y.T]
        stored = np.array([load.energy for load in loads])
        moving = MASS * (y[3] ** 2 + y[4] ** 2) / 2 + INERTIA * y[5] ** 2 / 2 + MASS * GRAVITY * y[1]
        total = stored + moving + y[6]
        x, z = y[0] - LENGTH * np.sin(y[2]), y[1] + LENGTH * np.cos(y[2])
        label = f"friction {coefficient:g}" if coefficient else "no friction"
        swung.plot(times, np.degrees(y[2]), color=colour, label=label)
        climbed.plot(times, np.degrees(np.arctan2(x, -z) - y[2]), color=colour)
        went.plot(times, y[6], color=colour)
        went.plot(times[::20], (stored + moving)[0] - (stored + moving)[::20], "o", color=colour, fillstyle="none")
        print(
            f"{label:12s}: swings back to {np.degrees(y[2].max(where=times > 0.6, initial=0.0)):.1f}°, "
            f"{y[6, -1]:6.2f} N mm lost, moment up to {max(abs(load.moment[2]) for load in loads):4.1f} N mm, "
            f"balanced to {np.ptp(total) / np.ptp(moving):.0e}"
        )
    swung.set_xlabel("time [s]")
    swung.set_title("angle of the rod [°]", fontsize=10)
    climbed.set_xlabel("time [s]")
    climbed.set_title("the contact, less where the rod points [°]", fontsize=10)
    went.set_xlabel("time [s]")
    went.set_title("energy lost; circles: balance [N mm]", fontsize=10)
    for panel in (swung, climbed, went):
        panel.grid(color="0.9", linewidth=0.6)
        panel.spines[["top", "right"]].set_visible(False)
    went.legend(*swung.get_legend_handles_labels(), frameon=False, fontsize=8)
    figure.savefig("what_does_clearance_do_to_a_pendulum.png", dpi=150)
