"""
The paper in thirty lines
=========================

Heß & Forsbach (2021) replace the liner by springs along the radius. Everything follows from one modulus K, whose fit to
finite elements is Eq. (18). Their reference hip has a 36 mm head in a liner of 6.75 mm.
"""

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs

R1, c, L, E, nu = 17.9, 0.1, 6.75, 1000.0, 0.4  # mm, MPa
R2 = R1 + c
C1, C2, C3 = 1.06, 1.23, 0.09  # Table 3, for ν = 0.4
K = E / R2 * (C1 + C2 * R2 / L + C3 * (R2 / L) ** 2)  # Eq. (18), MPa/mm

d = np.linspace(1e-3, 0.12, 100)  # indentation, mm
F = np.pi / 3 * R2**2 * K * (2 * d - c + c * (c / (c + d)) ** 2)  # Eq. (13), N
epsilon = np.arccos(c / (c + d))  # half angle of the contact, Eq. (8)
p0 = K * d  # pressure at the pole, Eq. (9), MPa

# %%
# The elastic solution of the same hip, which has no springs:

hip = bs.Joint(ball_radius=R1, clearance=c, liner_thickness=L, liner=bs.Material(young=E, poisson=nu))
exact = bs.Exact().press(hip, indentation=d)
for force in (500.0, 1500.0, 3000.0):
    springs, elastic = (np.interp(force, *pair) for pair in ((F, p0), (exact.force, exact.max_pressure)))
    print(
        f"{force:4.0f} N: springs {springs:5.2f} MPa, exact {elastic:5.2f} MPa, {100 * (springs / elastic - 1):+.1f} %"
    )

figure = Figure(figsize=(8, 3), layout="constrained")
for axes, name, values, solution in zip(
    figure.subplots(1, 3),
    ("F [kN]", "ε [°]", "p0 [MPa]"),
    (F / 1e3, np.degrees(epsilon), p0),
    (exact.force / 1e3, np.degrees(exact.half_angle), exact.pole_pressure),
    strict=True,
):
    axes.plot(1e3 * d, values, label="springs")
    axes.plot(1e3 * d, solution, "k--", label="exact")
    axes.set(xlabel="d [µm]", ylabel=name)
axes.legend()
figure.savefig("the_paper_in_thirty_lines.png", dpi=150)
