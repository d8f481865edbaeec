"""
Film over head diameter and clearance
=====================================

Which head and which clearance have the thickest lubricating film?

The ball turns at 1.5 rad/s under 1500 N in a lubricant of 2.5 mPa s. The exact contact gives the rise of the pressure
at its edge. The inlet formula gives the film from it, for every head and clearance. The kinematic wave includes the
leakage to the sides; dots show it at two clearances.
"""

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs

DIAMETERS = (28.0, 36.0, 44.0)
CLEARANCES = np.linspace(0.04, 0.25, 12)
LUBRICANT = bs.Lubricant(viscosity=2.5e-3)


def central_film(diameter: float, clearance: float, method: str) -> float:
    """Central film in nm."""
    joint = bs.Joint(
        ball_radius=diameter / 2, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.ALUMINA
    )
    contact = bs.Tabulated().press(joint, force=1500.0)
    return 1e6 * bs.film(contact, spin=(1.5, 0.0, 0.0), lubricant=LUBRICANT, method=method).central


def film_table(clearances: np.ndarray, method: str) -> np.ndarray:
    """Central films in nm, a row for each head and a column for each clearance."""
    return np.array([[central_film(diameter, clearance, method) for clearance in clearances] for diameter in DIAMETERS])


films = film_table(CLEARANCES, "inlet")
by_wave = film_table(CLEARANCES[[2, 9]], "wave")

figure = Figure(figsize=(6.4, 4.2), layout="constrained")
axes = figure.subplots()
for diameter, row, dots in zip(DIAMETERS, films, by_wave, strict=True):
    (line,) = axes.plot(1e3 * CLEARANCES, row, label=f"head of {diameter:g} mm")
    axes.plot(1e3 * CLEARANCES[[2, 9]], dots, "o", color=line.get_color())
axes.set(xlabel="radial clearance c [µm]", ylabel="central film h [nm]", ylim=(0.0, None))
axes.legend(frameon=False)
axes.grid(alpha=0.3)
figure.savefig("thickest_film.png", dpi=120)

best = np.unravel_index(films.argmax(), films.shape)
print(
    f"The thickest film, {films.max():.0f} nm, has the head of {DIAMETERS[best[0]]:g} mm with a clearance of "
    f"{1e3 * CLEARANCES[best[1]]:.0f} µm. The thinnest has {films.min():.0f} nm."
)

# %%
# A large head moves faster, and a small clearance makes a wide contact whose pressure rises slowly at the edge. Both
# thicken the film. Every film is far below a roughness of 1 µm of polyethylene: the surfaces touch.
