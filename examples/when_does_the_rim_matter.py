"""
Effect of the rim on the contact
================================

Finite elements with a rim are compared with a socket that is a full sphere.

The exact solution assumes a closed sphere of liner. A real liner ends at its rim, where it can move sideways. Up to
which size of contact is the difference negligible? Both results come from the same elements, at the same force. The
joint is a steel ball on liners of several thicknesses, soft or nearly incompressible.
"""

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs

ANGLES = np.radians([30.0, 40.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0])
WHOLE = bs.FiniteElement(cup=bs.Cup(arc_of_cover=np.radians(340.0)), meshes=1)
HEMISPHERE = bs.FiniteElement(meshes=1)
LINERS = {  # ν, R2/L: colour and dashes
    (0.40, 6.0): ("#0072B2", "-"),
    (0.40, 2.67): ("#009E73", (0, (6, 2))),
    (0.40, 1.2): ("#56B4E9", (0, (2, 1.5))),
    (0.49, 2.67): ("#D55E00", (0, (7, 2, 1.5, 2))),
    (0.49, 1.2): ("#CC79A7", (0, (4, 1.5, 1, 1.5))),
}
QUANTITIES = {"indentation": "indentation d", "max_pressure": "peak pressure p0", "half_angle": "half angle ε"}


def rim_effect(poisson: float, ratio: float) -> dict[str, np.ndarray]:
    """How much more a hemisphere has than the whole sphere at the same forces, in percent."""
    joint = bs.Joint(
        ball_radius=17.9,
        clearance=0.1,
        liner_thickness=18.0 / ratio,
        liner=bs.Material(young=1000.0, poisson=poisson),
        ball=bs.STEEL,
    )
    whole = WHOLE.press(joint, half_angle=ANGLES)
    cut = HEMISPHERE.press(joint, force=whole.force)
    return {name: 100 * (getattr(cut, name) / getattr(whole, name) - 1) for name in QUANTITIES}


figure = Figure(figsize=(11.0, 3.9), layout="constrained")
panels = dict(zip(QUANTITIES, figure.subplots(1, 3), strict=True))
print("indentation of a hemisphere over that of a whole sphere, in % at half angles of", np.degrees(ANGLES).round())
for (poisson, ratio), (colour, dashes) in LINERS.items():
    effect = rim_effect(poisson, ratio)
    print(f"  ν {poisson:g}, R2/L {ratio:4g}:", " ".join(f"{percent:6.2f}" for percent in effect["indentation"]))
    for name, panel in panels.items():
        panel.plot(
            np.degrees(ANGLES), effect[name], color=colour, linestyle=dashes, label=f"ν {poisson:g}, R2/L {ratio:g}"
        )
for name, panel in panels.items():
    panel.set_title(QUANTITIES[name], fontsize=10)
    panel.set_xlabel("half angle of the contact [°]")
    panel.set_yscale("symlog", linthresh=0.1)
    panel.set_yticks([-10, -1, -0.1, 0, 0.1, 1, 10], ["-10", "-1", "-0.1", "0", "0.1", "1", "10"])
    panel.grid(color="0.9", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
panels["indentation"].set_ylabel("hemisphere against whole sphere [%]")
figure.legend(
    *panels["indentation"].get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False, fontsize=9
)
figure.savefig("when_does_the_rim_matter.png", dpi=150)
