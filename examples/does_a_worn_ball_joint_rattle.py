"""
Rattle of a worn ball joint
===========================

The ball joint of a suspension is preloaded by a spring when it is new. Wear takes the force of the spring. What
happens then?

A steel ball of 27 mm in a socket of acetal carries a hub of 3 kg. A force of 400 N shakes it at 25 Hz. The ball stays
in place while the spring presses with more than 400 N. With a worn spring the ball crosses its clearance and strikes
the other side. The force of these impacts is several times the shaking force, and grows with the clearance. The force
element needs the geometry and the materials alone. Its time steps balance the energy to rounding.
"""

from math import pi, sin

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.dynamics import Gonthier, simulate
from ballsocket.reports.press_plots import energy_balance

SHAKING, FREQUENCY, MASS = 400.0, 25.0, 3.0  # N, Hz, kg
SPRINGS = {500.0: "#0072B2", 300.0: "#009E73", 0.0: "#D55E00"}  # N, from new to worn out
CLEARANCES = (0.05, 0.2)  # mm, beside 0.1


def shaken(clearance: float, spring: float):
    """A tenth of a second of it, in steps of 20 µs."""
    joint = bs.Joint(ball_radius=13.5, clearance=clearance, liner_thickness=2.0, liner=bs.POM, ball=bs.STEEL)
    element = bs.ForceElement(bs.BondedLayer(), joint, damping=Gonthier(restitution=0.6, impact_speed=100.0))
    rest = bs.BondedLayer().press(joint, force=spring).indentation
    return simulate(
        element,
        mass=MASS,
        position=(0.0, 0.0, clearance + rest),
        pull=lambda t: (0.0, 0.0, spring + SHAKING * sin(2 * pi * FREQUENCY * t)),
        duration=0.1,
        step=2e-5,
    )


def largest(motion) -> float:
    """Force of contact in N."""
    return np.linalg.norm(motion.element(motion.position, motion.velocity).force, axis=1).max()


figure = Figure(figsize=(9.0, 3.9), layout="constrained")
way, blows = figure.subplots(1, 2)
for spring, colour in SPRINGS.items():
    motion = shaken(0.1, spring)
    way.plot(1e3 * motion.time, motion.position[:, 2], color=colour, label=f"spring {spring:g} N")
    blows.plot(spring, largest(motion), "o", color=colour)
    print(
        f"spring {spring:3g} N: {motion.bounces:2d} times apart, up to {largest(motion):5.0f} N, "
        f"{motion.work[-1]:5.1f} N mm put in, {motion.dissipated_energy[-1]:5.1f} of them lost, "
        f"balanced to {motion.drift:.0e}"
    )
for clearance in CLEARANCES:
    force = largest(shaken(clearance, 0.0))
    blows.plot(0.0, force, "o", color=SPRINGS[0.0], fillstyle="none")
    blows.annotate(f"  clearance {clearance:g} mm", (0.0, force), va="center", fontsize=8)
    print(f"worn out, clearance {clearance:g} mm: up to {force:.0f} N")
way.set_xlabel("time [ms]")
way.set_title("where the ball is [mm], clearance 0.1 mm", fontsize=10)
blows.axhline(SHAKING, color="0.6", linewidth=0.8)
blows.set_xlabel("spring [N]; the line is the shaking")
blows.set_title("largest force of contact [N]", fontsize=10)
blows.set_ylim(bottom=0)
for panel in (way, blows):
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
way.legend(frameon=False, fontsize=8)
figure.savefig("does_a_worn_ball_joint_rattle.png", dpi=150)
energy_balance(motion).savefig("does_a_worn_ball_joint_rattle_energy.png", dpi=150)  # of the spring that is worn out
