"""The elastic solution beside the closed forms: how far off they are, and what happens inside the liner.

A hip engineer's question: the paper's model says 11.3 MPa at 3 kN. Can I trust it, and where is the plastic stressed
most?
"""

import numpy as np

import ballsocket as bs

hip = bs.joints["hess-forsbach"]
exact = bs.Exact().press(hip, force=3000.0)
print(f"exact: p0 {exact.max_pressure:.4f} MPa, estimated error {exact.error['max_pressure']:.0e}")

for model in (bs.Refined(), bs.HessForsbach(), bs.Bartel(), bs.Hertz()):
    contact = model.press(hip, force=3000.0)
    off = contact.max_pressure / exact.max_pressure - 1
    print(f"{model.name:>14}: p0 {contact.max_pressure:6.3f} MPa ({off:+.1%}), valid {contact.valid}")

# The largest von Mises stress, and how it falls with depth below the pole.
peak = exact.peak_stress
print(f"von Mises: at most {peak.von_mises:.2f} MPa, {peak.depth:.2f} mm deep at {np.degrees(peak.angle):.0f}°")
for depth in (0.5, 2.0, 5.0):
    stress = exact.stress(angle=0.0, depth=depth)
    print(f"  {depth} mm below the pole: von Mises {float(stress.von_mises):.2f} MPa")

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

# A stiffness for one's own multibody model, with the error it makes.
fit = bs.calibrate(hip)
print(f"K = {fit.modulus(hip):.1f} MPa/mm; force off by at most {fit.error['force']:.1%} between 1 and 3 kN")
