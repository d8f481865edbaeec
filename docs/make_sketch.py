"""Sketch with dimensions of the first page and the glossary: `python docs/make_sketch.py`, from the root, by hand.

Clearance and indentation are drawn twenty times too large.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ballsocket.output.style import BLUE, GREY, INK, SKY, VERMILLION

SOCKET, LINER, CLEARANCE, INDENTATION = 18.0, 6.75, 2.0, 1.4
BALL = SOCKET - CLEARANCE
CENTRE = np.array([0.0, -(CLEARANCE + INDENTATION)])
EDGE = np.arccos(CLEARANCE / (CLEARANCE + INDENTATION))
PRESSURE_SCALE = 4.0  # drawn height of the pressure per displacement of the bore


def main() -> None:
    figure = Figure(figsize=(7.0, 4.6), dpi=160, layout="constrained")
    axes = figure.add_subplot()
    axes.set(aspect="equal", xlim=(-33.0, 38.0), ylim=(-28.0, 20.5))
    axes.axis("off")
    bodies(axes)
    dimensions(axes)
    figure.savefig(Path(__file__).with_name("sketch.png"))


def polar(radius: float, angle: float | np.ndarray, centre: np.ndarray | tuple[float, float] = (0.0, 0.0)):
    """Return points at an angle from the pole, which lies below."""
    return centre[0] + radius * np.sin(angle), centre[1] - radius * np.cos(angle)


def bodies(axes: Axes) -> None:
    """Draw ball, liner with the displaced bore, backing, and contact pressure."""
    around = np.linspace(-np.pi / 2, np.pi / 2, 400)
    bore = np.where(np.abs(around) < EDGE, SOCKET + displacement(around), SOCKET)
    outer = polar(SOCKET + LINER, around[::-1])
    inner = polar(bore, around)
    axes.fill(np.r_[inner[0], outer[0]], np.r_[inner[1], outer[1]], facecolor=SKY, alpha=0.35)
    axes.plot(*inner, color=BLUE, linewidth=1.4)
    axes.plot(*polar(SOCKET + LINER, around), color=INK, linewidth=1.4)
    for angle in np.linspace(-1.5, 1.5, 41):
        start, end = polar(SOCKET + LINER, angle), polar(SOCKET + LINER + 1.3, angle + 0.05)
        axes.plot([start[0], end[0]], [start[1], end[1]], color=INK, linewidth=0.6)
    axes.plot(*polar(BALL, np.linspace(-np.pi, np.pi, 400), CENTRE), color=INK, linewidth=1.4)
    loaded = np.linspace(-EDGE, EDGE, 200)
    pressed = polar(SOCKET + (1.0 - PRESSURE_SCALE) * displacement(loaded), loaded)
    touched = polar(SOCKET + displacement(loaded), loaded)
    axes.fill(np.r_[pressed[0], touched[0][::-1]], np.r_[pressed[1], touched[1][::-1]], color=VERMILLION, alpha=0.45)
    axes.text(4.2, -14.8, "$p(\\varphi)$", color=INK, ha="left", va="center", fontsize=12)
    pole, largest = -(SOCKET + INDENTATION), -(SOCKET + INDENTATION - PRESSURE_SCALE * INDENTATION)
    arrow = {"arrowstyle": "<|-|>", "color": INK, "linewidth": 0.9, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", (0.0, pole), (0.0, largest), arrowprops=arrow)
    axes.text(-0.8, (pole + largest) / 2, "$p_0$", color=INK, ha="right", va="center", fontsize=12)


def displacement(angle: np.ndarray) -> np.ndarray:
    """Return the radial displacement of the bore, u = (c + d) cos φ - c."""
    return (CLEARANCE + INDENTATION) * np.cos(angle) - CLEARANCE


def dimensions(axes: Axes) -> None:
    """Draw the lengths and angles that are inputs or results of the models."""
    axes.plot([0.0, 0.0], [-27.0, 19.5], color=GREY, linewidth=0.8, linestyle=(0, (8, 3, 2, 3)))
    axes.plot([0.0, 33.0], [0.0, 0.0], color=GREY, linewidth=0.8)
    axes.plot([0.0, 33.0], [-CLEARANCE] * 2, color=GREY, linewidth=0.8)
    axes.plot([0.0, 33.0], [CENTRE[1]] * 2, color=GREY, linewidth=0.8)
    radius(axes, CENTRE, polar(BALL, -2.25, CENTRE), "$R_1$")
    radius(axes, (0.0, 0.0), polar(SOCKET, -1.27), "$R_2$")
    radius(axes, polar(SOCKET, 1.22), polar(SOCKET + LINER, 1.22), "$L$", both=True)
    distance(axes, 29.0, 0.0, -CLEARANCE, "$c$")
    distance(axes, 32.0, -CLEARANCE, CENTRE[1], "$d$")
    axes.plot(*zip((0.0, 0.0), polar(SOCKET + 1.0, EDGE), strict=True), color=GREY, linewidth=0.8)
    arc = polar(9.0, np.linspace(0.0, EDGE, 60))
    axes.plot(*arc, color=INK, linewidth=0.9)
    axes.text(*polar(10.6, EDGE / 2), "$\\varepsilon$", color=INK, ha="center", va="center", fontsize=13)
    axes.annotate("", (0.0, 1.2), (0.0, 11.0), arrowprops={"arrowstyle": "-|>", "color": VERMILLION, "linewidth": 2.2})
    axes.text(1.2, 8.5, "$F$", color=VERMILLION, fontsize=13)
    axes.text(*polar(SOCKET + LINER / 2, -0.62), "liner", color=INK, ha="center", va="center", rotation=-38)
    axes.text(-4.5, 9.6, "ball", color=INK, ha="center", va="center")
    axes.plot(0.0, 0.0, "o", color=BLUE, markersize=4)
    axes.plot(*CENTRE, "o", color=INK, markersize=4)


def radius(axes: Axes, start, end, text: str, both: bool = False) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": "<|-|>" if both else "-|>", "color": INK, "linewidth": 0.9})
    middle = (np.asarray(start) + np.asarray(end)) / 2
    axes.text(middle[0], middle[1] + 0.9, text, color=INK, ha="center", va="bottom", fontsize=12)


def distance(axes: Axes, x: float, top: float, bottom: float, text: str) -> None:
    """Draw a short length between two lines, with its arrows outside."""
    for level, far in ((top, top + 3.2), (bottom, bottom - 3.2)):
        axes.annotate("", (x, level), (x, far), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 0.9})
    axes.text(x + 0.7, top + 1.8, text, color=INK, ha="left", va="center", fontsize=12)


if __name__ == "__main__":
    main()
