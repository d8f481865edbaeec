"""
Cup orientation and clearance with the least pressure
=====================================================

Which orientation and clearance of a cup have the smallest worst pressure, over a walking step and standing up?

The loads lean to the middle of the body. They swing forwards and backwards in walking, and far backwards in standing
up. Every load is pressed with full elasticity in a cup with its rim. `JaxSphere` returns the derivatives of the
pressures, so an optimiser needs a few evaluations for three numbers: 15° of anteversion are best.
"""

from time import perf_counter

import jax
import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import minimize

import ballsocket as bs
from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere

jax.config.update("jax_enable_x64", True)

hip = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=7.0, liner=bs.CROSSLINKED_PE, ball=bs.COCR)
cup = bs.Cup(arc_of_cover=np.radians(150.0))
compiled = JaxSphere(model=bs.Sphere(cup=cup, ring_width=np.radians(3.0)), joint=hip, tolerance=1e-6, dtype="float64")

# representative loads of a right hip: walking with two peaks, and standing up from a chair
walking = 1650.0 + 1350.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 11)) ** 2
force = np.concatenate([walking, np.full(5, 2300.0)])
forwards = np.radians(np.concatenate([np.linspace(15.0, -15.0, 11), np.linspace(-20.0, -60.0, 5)]))
lean = np.radians(12.0)
direction = np.stack(
    [np.full_like(forwards, -np.sin(lean)), np.cos(lean) * np.sin(forwards), np.cos(lean) * np.cos(forwards)], axis=-1
)

names = ("inclination", "anteversion", "clearance")
low, high = (np.array([np.radians(a), np.radians(b), c]) for a, b, c in ((35.0, 0.0, 0.05), (50.0, 30.0, 0.2)))


def pressures(x):
    """Largest pressure in MPa at each instant; x is 0 to 1 between the limits."""
    return compiled.press(force, direction, **dict(zip(names, low + x * (high - low), strict=True))).max_pressure


def worst(x):
    """Smooth maximum of the pressures over all instants in MPa, and the pressures."""
    pressure = pressures(x)
    return jax.numpy.sum(pressure**40) ** (1 / 40), pressure


start = np.array([1.0, 0.2, 0.6])
slopes = jax.jit(jax.value_and_grad(worst, has_aux=True))
slopes(start)  # compiles


def value_and_slopes(x):
    """Smooth maximum and its slopes, as SciPy takes them."""
    (value, _), slope = slopes(x)
    return float(value), np.asarray(slope)


began = perf_counter()
optimum = minimize(value_and_slopes, start, jac=True, bounds=[(0.0, 1.0)] * 3, options={"ftol": 1e-5})
print(f"{optimum.nfev} evaluations of {len(force)} loads with their derivatives in {perf_counter() - began:.1f} s")

figure = Figure(figsize=(7.2, 3.6), layout="constrained")
axes = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="polar")
for title, point, colour, marker in (("start", start, "#D55E00", "s"), ("optimum", optimum.x, "#0072B2", "o")):
    inclination, anteversion, clearance = low + point * (high - low)
    pressure = np.asarray(slopes(point)[0][1])
    print(
        f"{title}: inclination {np.degrees(inclination):.0f}°, anteversion {np.degrees(anteversion):.0f}°, "
        f"clearance {clearance:.2f} mm; worst pressure {pressure.max():.1f} MPa"
    )
    axes[0].plot(pressure, color=colour, marker=marker, markersize=4, label=title)
    placed = bs.Cup(arc_of_cover=cup.arc_of_cover, inclination=float(inclination), anteversion=float(anteversion))
    x, y, z = (direction @ np.array(placed.frame).T).T
    axes[1].scatter(np.arctan2(y, x), np.degrees(np.arccos(z)), s=force / 80, color=colour, marker=marker)
axes[0].axvline(10.5, color="0.7", linewidth=0.8)
axes[0].set(xlabel="instant: walking | standing up", ylabel="largest pressure [MPa]", ylim=(0.0, None))
axes[0].set_xticks(np.arange(0, len(force), 5))
axes[0].legend(frameon=False, fontsize=9)
axes[0].spines[["top", "right"]].set_visible(False)
axes[1].set(rlim=(0.0, np.degrees(cup.rim)), xticklabels=[], rticks=[20, 40, 60])
axes[1].set_rlabel_position(135)
axes[1].set_title("loads in the cup, as tilt [°]; the circle is the rim", fontsize=9)
figure.savefig("which_cup_presses_least.png", dpi=150)

# %%
# The inclination and the clearance go to their lower limits. The anteversion has an optimum of 15° between its limits.
# There the peak of walking, forwards, and the end of standing up, backwards, have about the same pressure. At the start
# the contact reaches the rim at the end of standing up. The worst pressure falls from 16.0 to 9.5 MPa, in eight
# evaluations of all loads with their derivatives: some seconds, and about ten to compile.
