"""
The exact solution, and stresses inside the liner
=================================================

The paper's model predicts 11.3 MPa for a hip at 3 kN. How large is its error, and where is the stress in the liner
largest?
"""

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs

hip = bs.joints["hess-forsbach"]
exact = bs.Exact().press(hip, force=3000.0)
print(f"exact: p0 {exact.max_pressure:.4f} MPa, estimated error {exact.error['max_pressure']:.0e}")

for model in (bs.Refined(), bs.HessForsbach(), bs.Bartel(), bs.Hertz()):
    contact = model.press(hip, force=3000.0)
    off = contact.max_pressure / exact.max_pressure - 1
    print(f"{model.name:>14}: p0 {contact.max_pressure:6.3f} MPa ({off:+.1%}), valid {contact.valid}")

# %%
# The largest von Mises stress, and how it falls with depth below the pole.

peak = exact.peak_stress
print(f"von Mises: at most {peak.von_mises:.2f} MPa, {peak.depth:.2f} mm deep at {np.degrees(peak.angle):.0f}°")
for depth in (0.5, 2.0, 5.0):
    stress = exact.stress(angle=0.0, depth=depth)
    print(f"  {depth} mm below the pole: von Mises {float(stress.von_mises):.2f} MPa")

# %%
# All of the liner, in its own shape. The white cross is the largest von Mises stress, the dots are the contact's edge.

angle = np.radians(np.linspace(-80.0, 80.0, 161))
depth = np.linspace(0.05, hip.liner_thickness, 60)[:, None]
stress = exact.stress(angle=abs(angle), depth=depth).von_mises
radius = hip.socket_radius + depth

figure = Figure(figsize=(8.0, 4.2), layout="constrained")
axes = figure.subplots()
filled = axes.contourf(radius * np.sin(angle), -radius * np.cos(angle), stress, levels=14, cmap="viridis")
figure.colorbar(filled, ax=axes, shrink=0.8).set_label("von Mises stress [MPa]")
deepest = hip.socket_radius + peak.depth
axes.plot(deepest * np.sin(peak.angle), -deepest * np.cos(peak.angle), "wx")
edge = hip.socket_radius * np.sin(exact.half_angle), -hip.socket_radius * np.cos(exact.half_angle)
axes.plot([-edge[0], edge[0]], [edge[1], edge[1]], "ko", markersize=4)
axes.set_aspect("equal")
axes.set_xlabel("distance from the load axis [mm]")
axes.set_ylabel("height [mm]")
axes.spines[["top", "right"]].set_visible(False)
figure.savefig("how_exact_is_it.png", dpi=150)

# %%
# A metal shell that is not rigid: 2 mm of titanium on bone cement and bone.

backed = bs.Joint(
    ball_radius=17.9,
    clearance=0.1,
    liner_thickness=6.75,
    liner=bs.UHMWPE,
    ball=bs.STEEL,
    backing=(
        bs.Layer(thickness=2.0, material=bs.TITANIUM),
        bs.Layer(thickness=2.0, material=bs.BONE_CEMENT),
        bs.Layer(thickness=np.inf, material=bs.CANCELLOUS_BONE),
    ),
)
softer = bs.Exact().press(backed, force=3000.0)
print(f"on bone: d {softer.indentation:.4f} mm instead of {exact.indentation:.4f} mm, p0 {softer.max_pressure:.2f} MPa")

# %%
# A stiffness for a multibody model, with its error.

fit = bs.calibrate(hip)
print(f"K = {fit.modulus(hip):.1f} MPa/mm; force off by at most {fit.error['force']:.1%} between 1 and 3 kN")
