"""Picture of the landmarks of the planning page: `python docs/make_planning_picture.py`, from the root, by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from ballsocket.problem.cup import Cup
from ballsocket.reports.style import BLUE, GREY, INK, SKY, VERMILLION

RIGHT_ASIS, LEFT_ASIS, PUBIS = np.array([[120.0, 0.0], [-120.0, 0.0], [0.0, -95.0]])
TUBERCLES = np.array([[25.0, -95.0], [-25.0, -95.0]])
CUP_CENTRE, CUP_RADIUS = np.array([90.0, -85.0]), 26.0
INCLINATION, ANTEVERSION = np.radians(42.0), np.radians(17.0)


def main() -> None:
    """Draw both views into one picture."""
    figure = Figure(figsize=(8.4, 4.0), dpi=160, layout="constrained")
    front, side = figure.subplots(1, 2, width_ratios=(1.75, 1.0))
    front_view(front)
    side_view(side)
    figure.savefig(Path(__file__).with_name("planning.png"))


def prepare(axes: Axes, title: str, xlim: tuple[float, float]) -> None:
    """Set limits and title of a view."""
    axes.set(aspect="equal", xlim=xlim, ylim=(-165.0, 70.0))
    axes.axis("off")
    axes.set_title(title, fontsize=10, color=INK)


def point(axes: Axes, position: np.ndarray, text: str, offset: tuple[float, float], colour: str = VERMILLION) -> None:
    """Draw a landmark with its name."""
    axes.plot(*position, "o", color=colour, markersize=6)
    align = "left" if offset[0] > 0 else "right" if offset[0] < 0 else "center"
    axes.text(*(position + offset), text, color=INK, fontsize=9, ha=align, va="center")


def arrow(axes: Axes, start: np.ndarray, end: np.ndarray, text: str, colour: str = BLUE) -> None:
    """Draw an arrow with a letter at its end."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.6})
    direction = (np.asarray(end) - start) / np.linalg.norm(np.asarray(end) - start)
    axes.text(*(end + 9.0 * direction), text, color=colour, fontsize=11, ha="center", va="center")


def front_view(axes: Axes) -> None:
    """Draw the anterior pelvic plane, the cup's rim and the inclination, seen from the front."""
    prepare(axes, "from the front", (185.0, -185.0))  # the patient's right is at the left
    corners = np.array([RIGHT_ASIS, LEFT_ASIS, TUBERCLES[1], TUBERCLES[0]])
    axes.fill(*corners.T, facecolor=SKY, alpha=0.3, edgecolor=BLUE, linewidth=1.0)
    point(axes, RIGHT_ASIS, "right ASIS", (0.0, 14.0))
    point(axes, LEFT_ASIS, "left ASIS", (0.0, 14.0))
    point(axes, PUBIS, "pubic symphysis", (0.0, -15.0))
    for tubercle in TUBERCLES:
        point(axes, tubercle, "", (0.0, 0.0), GREY)
    axes.text(-34.0, -90.0, "pubic tubercles", color=GREY, fontsize=8, ha="left", va="center")
    origin = (RIGHT_ASIS + LEFT_ASIS) / 2
    arrow(axes, origin, origin + np.array([55.0, 0.0]), "x")
    arrow(axes, origin, origin + np.array([0.0, 50.0]), "z")
    cup = Cup(inclination=INCLINATION, anteversion=ANTEVERSION)
    opening, (first, second, _) = np.array(cup.opening), np.array(cup.frame)
    angles = np.linspace(0.0, 2 * np.pi, 200)
    rim = CUP_RADIUS * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))[:, [0, 2]] + CUP_CENTRE
    axes.plot(*rim.T, color=INK, linewidth=1.2)
    axes.plot(*rim[::25].T, "o", color=VERMILLION, markersize=4)
    axes.text(*(CUP_CENTRE + np.array([30.0, 30.0])), "rim-1 ... rim-8", color=INK, fontsize=9, ha="right", va="center")
    end = CUP_CENTRE + 70.0 * opening[[0, 2]]
    arrow(axes, CUP_CENTRE, end, "", INK)
    axes.plot(*np.array([CUP_CENTRE, CUP_CENTRE - [0.0, 70.0]]).T, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.add_patch(Arc(CUP_CENTRE, 90.0, 90.0, theta1=270.0, theta2=270.0 + np.degrees(INCLINATION), color=INK))
    axes.text(*(CUP_CENTRE + np.array([22.0, -57.0])), "inclination", color=INK, fontsize=9, ha="right", va="center")


def side_view(axes: Axes) -> None:
    """Draw the pelvic plane and the tilt, seen from the right; the patient looks to the right."""
    prepare(axes, "from the right", (-75.0, 95.0))
    tilt = np.radians(12.0)
    up = np.array([np.sin(tilt), np.cos(tilt)])
    top, pubis = np.zeros(2), -95.0 * up
    axes.plot(*np.array([top, pubis]).T, color=BLUE, linewidth=2.0)
    point(axes, top, "ASIS", (-8.0, 6.0))
    point(axes, pubis, "pubis", (9.0, -4.0))
    arrow(axes, top, 52.0 * up, "z")
    arrow(axes, top, 52.0 * np.array([up[1], -up[0]]), "y")
    axes.plot([0.0, 0.0], [0.0, 62.0], color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.text(-6.0, 50.0, "vertical", color=GREY, fontsize=9, ha="right", va="center")
    axes.add_patch(Arc((0.0, 0.0), 66.0, 66.0, theta1=90.0 - np.degrees(tilt), theta2=90.0, color=INK))
    axes.text(34.0, 40.0, "pelvic tilt > 0", color=INK, fontsize=9, ha="left", va="center")


if __name__ == "__main__":
    main()
