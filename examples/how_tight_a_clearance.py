"""What does a clearance tolerance of ±0.05 mm do to the peak pressure of a 32 mm head?

One call on arrays: three clearances against a range of loads, and the sensitivity to each dimension by finite
differences (`jax.grad` gives the same without a step size; see the README).
"""

import numpy as np

import ballsocket as bs

model = bs.HessForsbach()
clearance = np.array([0.05, 0.10, 0.15])
force = np.array([500.0, 1500.0, 3000.0])[:, None]
hip = bs.Joint(ball_radius=16.0, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)

contact = model.press(hip, force=force)
print("peak pressure [MPa]; rows 0.5, 1.5, 3 kN, columns clearance 0.05, 0.10, 0.15 mm")
print(contact.max_pressure.round(2))
spread = np.ptp(contact.max_pressure, axis=1) / contact.max_pressure[:, 1]
print("a tolerance of ±0.05 mm spans", ", ".join(f"{share:.0%}" for share in spread), "of the middle value")

nominal = {"ball_radius": 16.0, "clearance": 0.10, "liner_thickness": 6.0}
for name, value in nominal.items():
    near = nominal | {name: value * np.array([0.999, 1.001])}
    pressure = model.press(bs.Joint(**near, liner=bs.UHMWPE, ball=bs.COCR), force=3000.0).max_pressure
    elasticity = np.diff(np.log(pressure)).item() / np.log(1.001 / 0.999)
    print(f"one per cent more {name.replace('_', ' ')} changes the peak pressure by {elasticity:+.2f} %")
