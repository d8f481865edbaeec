"""
Ball dropped into a wet socket
==============================

A ball falls in the clearance of its socket. How do the bounces change with a fluid in the gap, and when do the
surfaces touch?

The ball weighs half a kilogram and starts at the centre of a socket with 0.1 mm of clearance. In the dry socket it
bounces. In a fluid it has to squeeze the film out of the gap first. Even water takes all bounces away, and in oil the
ball sinks for seconds. Without inertia the closed form gives the time to any gap:

    t = 6 π η R⁴/(F c²) [artanh κ + (artanh κ - κ)/κ²],   κ = 1 - gap/c.

Circles mark it for the oil. The film ends at a thickness of 1 µm, the roughness of the surfaces.
"""

from math import pi

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.dynamics import simulate

JOINT, MASS, GRAVITY = bs.joints["hip-28"], 0.5, 9.80665  # kg, m/s²
FLUIDS = {"dry": None, "water": 7e-4, "joint fluid": 2.5e-3, "oil": 0.1}  # Pa s at 37 °C


def dropped(viscosity: float | None):
    """Motion of the ball from the centre of the socket, under its weight."""
    lubricant = None if viscosity is None else bs.Lubricant(viscosity=viscosity)
    element = bs.ForceElement(bs.HessForsbach(), JOINT, lubricant=lubricant)
    weight = (0.0, 0.0, -MASS * GRAVITY)
    duration = 6.0 if viscosity == FLUIDS["oil"] else 0.2
    return simulate(element, mass=MASS, position=(0.0, 0.0, 0.0), pull=weight, duration=duration, step=duration / 2000)


def sinking_time(gap: np.ndarray, viscosity: float) -> np.ndarray:
    """Time in s in which the weight squeezes the film to a gap in mm, without inertia."""
    kappa, squared_radius = 1 - gap / JOINT.clearance, JOINT.ball_radius * JOINT.socket_radius
    T = np.arctanh(kappa)
    rate = 6e-6 * pi * viscosity * squared_radius**2 / (MASS * GRAVITY * JOINT.clearance**2)
    return rate * (T + (T - kappa) / kappa**2)


figure = Figure(figsize=(9.0, 3.9), layout="constrained")
fast, slow = figure.subplots(1, 2, sharey=True)
for (name, viscosity), colour in zip(FLUIDS.items(), ("#666666", "#0072B2", "#D55E00", "#009E73"), strict=True):
    motion = dropped(viscosity)
    gap = 1e3 * motion.load.film_thickness
    panel = slow if name == "oil" else fast
    label = name if viscosity is None else f"{name}, {1e3 * viscosity:g} mPa s"
    panel.plot(1e3 * motion.time, gap, color=colour, label=label, linewidth=1.0 if name == "dry" else 1.6)
    touched = motion.time[gap < 1.5]
    end = f"at 1.5 µm after {1e3 * touched[0]:.0f} ms" if len(touched) else f"at {gap[-1]:.1f} µm in the end"
    print(f"{label:22s}: {motion.bounces} bounces, {end}, energy balanced to {motion.drift:.0e}")
thickness = np.array([80.0, 50.0, 20.0, 10.0, 5.0, 2.5])
slow.plot(1e3 * sinking_time(1e-3 * thickness, FLUIDS["oil"]), thickness, "o", color="#009E73", fillstyle="none")
fast.set_ylabel("gap [µm]")
for panel in (fast, slow):
    panel.set_xlabel("time [ms]")
    panel.set_yscale("log")
    panel.set_ylim(0.5, 600.0)
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
    panel.legend(loc="upper right", edgecolor="none", framealpha=1.0, fontsize=8)
figure.savefig("how_soon_does_a_wet_ball_touch.png", dpi=150)
