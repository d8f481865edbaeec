"""Makes the figures of the manuscript: `python docs/make_method_figures.py`, from the root, by hand (a minute)."""

from __future__ import annotations

import json
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.elasticity.exact.model import curve_of
from ballsocket.elasticity.exact.modes import socket_of
from ballsocket.reports.style import LEGEND, finish, in_matplotlib, numbered

ROOT = Path(__file__).parents[1]
HERE = Path(__file__).with_name("paper")
HIP = bs.joints["hess-forsbach"]
JOINTS = {
    "hip, R₂/L 2.7, ν 0.40": HIP,
    "thin, R₂/L 7.2, ν 0.49": replace(HIP, liner_thickness=2.5, liner=bs.Material(young=1000.0, poisson=0.49)),
    "thick, R₂/L 1.2, ν 0.30": replace(HIP, liner_thickness=15.0, liner=bs.Material(young=1000.0, poisson=0.30)),
}
WIDTHS = (6.0, 4.0, 3.0, 2.0, 1.5, 1.0)


def main() -> None:
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    modes, points = figure.subplots(1, 2)
    draw_modes(modes)
    draw_points(points)
    figure.savefig(HERE / "equation.png", dpi=150)
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    draw_rings(*figure.subplots(1, 2))
    figure.savefig(HERE / "rings.png", dpi=150)


def draw_modes(axes) -> None:
    """Compliance of each mode over that of a half-space."""
    degrees = np.arange(0, 60)
    for index, (name, joint) in enumerate(JOINTS.items()):
        socket = socket_of(joint)
        ratio = socket.compliance(degrees) * (degrees + 0.5) / socket.asymptote
        axes.plot(degrees, ratio, label=name, **in_matplotlib(numbered(index)))
    finish(axes, "degree n", "$c_n\\,(n + ½)\\,/\\,C$")
    axes.legend(**LEGEND)


def draw_points(axes) -> None:
    """What so many points miss of the largest pressure, against many more, at a half angle of 45°."""
    counts = np.arange(4, 33, 2)
    for index, (name, joint) in enumerate(JOINTS.items()):
        curve = curve_of(bs.Exact(), joint)
        found = [float(curve.state(np.array([radians(45.0)]), count).pole_pressure[0]) for count in (*counts, 80)]
        error = np.abs(np.array(found[:-1]) / found[-1] - 1.0)
        axes.semilogy(counts, np.maximum(error, 1e-15), label=name, **in_matplotlib(numbered(index)))
    finish(axes, "points", "error of $p_0$")


def draw_rings(forces, pressures) -> None:
    """Against three-dimensional elements of another program, over the width of the rings."""
    reference = json.loads((ROOT / "tests" / "data" / "real_cup.json").read_text(encoding="utf-8"))
    for index, case in enumerate(reference["cases"]):
        off = np.array([misses(case, width) for width in WIDTHS])
        for axes, error in zip((forces, pressures), off.T, strict=True):
            label = f"tilt {case['tilt_deg']}°, ν {case['poisson']}"
            axes.semilogy(WIDTHS, 100 * error, "o", label=label, **in_matplotlib(numbered(index)))
    finish(forces, "width of rings [°]", "largest error of the force [%]")
    finish(pressures, "width of rings [°]", "largest error of $p_{max}$ [%]")
    pressures.legend(**LEGEND)


def misses(case: dict, width: float) -> tuple[float, float]:
    """Largest relative error of the force's size and of the largest pressure over the steps of a case."""
    joint = replace(HIP, ball=None, liner=bs.Material(young=1000.0, poisson=case["poisson"]))
    model = bs.Sphere(cup=bs.Cup(), ring_width=radians(width))
    steps = case["steps"]
    contact = model.press(
        joint, indentation=np.array([step["indentation"] for step in steps]), tilt=radians(case["tilt_deg"])
    )
    force = np.array([np.hypot(step["force_lateral"], step["force_axial"]) for step in steps])
    pressure = np.array([step["max_pressure"] for step in steps])
    return (
        float(np.max(np.abs(contact.force / force - 1.0))),
        float(np.max(np.abs(contact.max_pressure / pressure - 1.0))),
    )


if __name__ == "__main__":
    main()
