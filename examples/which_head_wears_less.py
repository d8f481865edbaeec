"""
Wear of 28 mm and 36 mm heads
=============================

A head of 36 mm wears a quarter more volume than one of 28 mm, because every step slides further under the same load.
Its depth is a fifth less, because the wear is distributed over a larger contact.

The heads have 22.2, 28, 32 and 36 mm, in cups of one outer size. The run has five million simulator steps, with
Archard's law for conventional polyethylene.
"""

from math import radians

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

OUTER_RADIUS = 24.1
DIAMETERS = {22.2: "#009E73", 28.0: "#0072B2", 32.0: "#E69F00", 36.0: "#D55E00"}
MILLIONS = np.linspace(0.5, 5.0, 10)


def worn(diameter: float) -> tuple[np.ndarray, np.ndarray]:
    """Volume in mm³ and penetration in mm over the cycles."""
    joint = bs.Joint(
        head_diameter=diameter,
        clearance=0.1,
        outer_radius=OUTER_RADIUS,
        liner=bs.UHMWPE,
    )
    use = HipSimulation(
        joint=joint,
        cup=bs.Cup(inclination=radians(30.0)),
        cycle=iso_14242_1(50),
        wear=Archard(coefficient=1.066e-6),
    )
    reports = use.after(5e6, list(1e6 * MILLIONS)).reports
    return np.array([each.volume for each in reports]), np.array([each.penetration for each in reports])


figure = Figure(figsize=(9.0, 3.9), layout="constrained")
volume, penetration = figure.subplots(1, 2)
for diameter, colour in DIAMETERS.items():
    volumes, depths = worn(diameter)
    print(f"{diameter:g} mm: {volumes[-1]:.1f} mm³, {depths[-1]:.3f} mm after five million cycles")
    for panel, values in ((volume, volumes), (penetration, depths)):
        panel.plot([0, *MILLIONS], [0, *values], color=colour, label=f"{diameter:g} mm")
for panel, title in ((volume, "worn volume [mm³]"), (penetration, "penetration of the head [mm]")):
    panel.set_title(title, fontsize=10)
    panel.set_xlabel("million cycles")
    panel.set_ylim(bottom=0)
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
volume.legend(title="head", frameon=False)
figure.savefig("which_head_wears_less.png", dpi=150)
