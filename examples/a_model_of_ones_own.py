"""A foundation modulus of one's own, and what it changes.

Say a finite-element study of one's own liner gave K R2/E = 1.02 + 1.25 (R2/L) + 0.10 (R2/L)².
"""

import ballsocket as bs

own = bs.RadialFoundation(modulus=bs.polynomial(1.02, 1.25, 0.10, source="our liner, 2026"))
hip = bs.joints["hip-32"]
for name, model in {"paper": bs.HessForsbach(), "own": own}.items():
    contact = model.press(hip, force=3000.0)
    stiffness, pressure = contact.foundation_modulus, contact.max_pressure
    print(f"{name:>6}: K {stiffness:6.1f} MPa/mm, p0 {pressure:5.2f} MPa, valid {contact.valid}")

# The ball pushed off the axis: the socket pushes back along the displacement.
contact = own.press(hip, force=3000.0)
print("force on a ball displaced by (0.10, 0, 0.10) mm:", contact.force_vector([0.10, 0.0, 0.10]).round(1), "N")
