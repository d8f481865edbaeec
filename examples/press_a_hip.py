"""
Press a hip: one joint, one load, every model
=============================================

The reference case of Heß & Forsbach 2021: a 36 mm steel head in a UHMWPE liner under 3 kN.
"""

from pathlib import Path

import numpy as np

import ballsocket as bs
from ballsocket.output.press_plot import press_figure
from ballsocket.output.save import save

hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)

# %%
# One model, all quantities.

contact = bs.HessForsbach().press(hip, force=3000.0)
print(contact)
print(f"friction torque in flexion at a coefficient of 0.06: {contact.friction_torque(0.06):.0f} N mm")

# %%
# Every model, each with its validity, and the reasons of those that are outside it.

answers = bs.compare(hip, force=3000.0)
print(answers)

# %%
# A picture of the exact answer, of those that can be trusted here, and of Hertz, that cannot (thin).

names = ["exact", "hess-forsbach", "vessel", "bartel", "hertz"]
curves = {name: bs.catalogue[name].press(hip, indentation=np.linspace(0.0, 0.12, 60)) for name in names}
save(press_figure({name: answers[name] for name in names}, curves), Path("press_a_hip.png"))

# %%
# The publications to cite.

print(bs.cite(contact))
