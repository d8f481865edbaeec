"""
Map of cup orientations
=======================

Distance to the rim and largest pressure over inclination and anteversion.

In single-leg stance the load of a hip leans to the middle of the body, and the cup opens to the side. How steep can
the cup be until the contact reaches its rim? The result is 49° for a 32 mm head and 170° of cover, at 15° of
anteversion. Every orientation is pressed with full elasticity in a cup with its rim. The compliance of its rings does
not depend on the orientation, so a map of seventy orientations takes a second.
"""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.reports.orientation_plots import orientation_figure

hip = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=7.0, liner=bs.CROSSLINKED_PE, ball=bs.COCR)
stance = (-0.2, 0.0, 1.0)  # to the right, to the front, upwards: the middle of the body is to the left of a right hip
cup = bs.Cup(arc_of_cover=np.radians(170.0), inclination=np.radians(45.0), anteversion=np.radians(15.0))
sphere = bs.Sphere(cup=cup, direction=stance, ring_width=np.radians(3.0))
angles = {"inclination": np.radians(np.linspace(30, 60, 13)), "anteversion": np.radians(np.linspace(0, 30, 5))}

stood = bs.orient(hip, model=sphere, force=3000.0, **angles)
print(f"{stood.status.size} orientations in {stood.seconds:.1f} s")
print(f"pressures from {stood.max_pressure.min():.1f} to {stood.max_pressure.max():.1f} MPa")
orientation_figure(stood).savefig("how_must_the_cup_stand.png", dpi=150)

# %%
# The dotted line is where the contact reaches the rim. A cup that reaches further around the head may stand steeper:
# 10° more of cover, half of them at the upper rim, are 5° more of inclination.


def steepest(stood: bs.Orientations) -> np.ndarray:
    """The inclination in degrees at which the contact reaches the rim, for each anteversion; NaN outside of the map."""
    inclination = np.degrees(stood.inclination)
    return np.array([np.interp(0.0, -margin, inclination, np.nan, np.nan) for margin in stood.edge_distance.T])


figure = Figure(figsize=(6.4, 4.2), layout="constrained")
axes = figure.subplots()
for arc, colour, dash in ((160, "#0072B2", (0, (6, 2))), (170, "black", "-"), (180, "#D55E00", (0, (2, 1.5)))):
    model = replace(sphere, cup=replace(cup, arc_of_cover=np.radians(arc)))
    limit = steepest(bs.orient(hip, model=model, force=3000.0, **angles))
    axes.plot(limit, np.degrees(angles["anteversion"]), color=colour, linestyle=dash, linewidth=2, label=f"{arc}°")
    print(f"arc of cover {arc}°, anteversion 15°: off the rim up to an inclination of {limit[2]:.0f}°")
axes.set_xlabel("inclination at which the contact reaches the rim [°]")
axes.set_ylabel("anteversion [°]")
axes.grid(color="0.9", linewidth=0.6)
axes.spines[["top", "right"]].set_visible(False)
axes.legend(title="arc of cover", frameon=False, fontsize=9)
figure.savefig("how_must_the_cup_stand_arcs.png", dpi=150)
