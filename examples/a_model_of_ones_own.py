"""
A custom foundation modulus
===========================

A finite-element study of a liner gave K R2/E = 1.02 + 1.25 (R2/L) + 0.10 (R2/L)². How does this stiffness change the
contact of a hip?
"""

from pathlib import Path

import numpy as np

import ballsocket as bs
from ballsocket.output.press_plot import press_figure
from ballsocket.output.save import save

hip = bs.joints["hip-32"]
models = {
    "hess-forsbach": bs.HessForsbach(),
    "own": bs.RadialFoundation(modulus=bs.polynomial(1.02, 1.25, 0.10, source="our liner, 2026")),
    "exact": bs.Exact(),
}
contacts = {name: model.press(hip, force=3000.0) for name, model in models.items()}
for name, contact in contacts.items():
    stiffness, pressure = contact.foundation_modulus, contact.max_pressure
    print(f"{name:>13}: K {stiffness:6.1f} MPa/mm, p0 {pressure:5.2f} MPa, valid {contact.valid}")

# %%
# A custom model is drawn, compared and cited like the others.

curves = {name: model.press(hip, indentation=np.linspace(0.0, 0.08, 60)) for name, model in models.items()}
save(press_figure(contacts, curves), Path("a_model_of_ones_own.png"))

# %%
# The ball pushed off the axis: the socket pushes back along the displacement.

force = models["own"].force_vector(hip, [0.10, 0.0, 0.10])
print("force on a ball displaced by (0.10, 0, 0.10) mm:", force.round(1), "N")
