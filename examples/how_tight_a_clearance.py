"""
How tight a clearance?
======================

What does a clearance tolerance of ±0.05 mm do to the peak pressure of a 32 mm head?

One call on arrays: clearances against loads, and the sensitivity to each dimension by finite differences (`jax.grad`
gives the same without a step size).
"""

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.figures import COLOURS, finish

model = bs.HessForsbach()
clearance = np.array([0.05, 0.10, 0.15])
force = np.array([500.0, 1500.0, 3000.0])[:, None]
hip = bs.Joint(ball_radius=16.0, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)

contact = model.press(hip, force=force)
print("peak pressure [MPa]; rows 0.5, 1.5, 3 kN, columns clearance 0.05, 0.10, 0.15 mm")
print(contact.max_pressure.round(2))
spread = np.ptp(contact.max_pressure, axis=1) / contact.max_pressure[:, 1]
print("a tolerance of ±0.05 mm spans", ", ".join(f"{share:.0%}" for share in spread), "of the middle value")

# %%
# The same over all clearances, with the exact answer in black. `Tabulated` gives it as fast as a closed form.

range_of_clearances = np.linspace(0.02, 0.2, 60)
wide = bs.Joint(ball_radius=16.0, clearance=range_of_clearances, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)
figure = Figure(figsize=(7.0, 4.2), layout="constrained")
axes = figure.subplots()
axes.axvspan(0.05, 0.15, color="0.93", label="the tolerance")
for load, colour in zip(force[:, 0], COLOURS, strict=False):
    closed, exact = (each.press(wide, force=load) for each in (model, bs.Tabulated()))
    axes.plot(range_of_clearances, exact.max_pressure, color="black", linewidth=1.0)
    axes.plot(range_of_clearances, closed.max_pressure, color=colour, label=f"{load:.0f} N")
finish(axes, "radial clearance c [mm]", "peak pressure p0 [MPa]")
axes.set_ylim(bottom=0.0)
axes.legend(frameon=False)
figure.savefig("how_tight_a_clearance.png", dpi=150)

# %%
# Which dimension matters most at 3 kN?

nominal = {"ball_radius": 16.0, "clearance": 0.10, "liner_thickness": 6.0}
for name, value in nominal.items():
    near = nominal | {name: value * np.array([0.999, 1.001])}
    pressure = model.press(bs.Joint(**near, liner=bs.UHMWPE, ball=bs.COCR), force=3000.0).max_pressure
    elasticity = np.diff(np.log(pressure)).item() / np.log(1.001 / 0.999)
    print(f"one per cent more {name.replace('_', ' ')} changes the peak pressure by {elasticity:+.2f} %")
