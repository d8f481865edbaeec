"""Figures of a moving joint: energy balance, path of the ball, force loops with their loss."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from ..dynamics.motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers

_PARTS = {
    "kinetic_energy": ("moving", "#0072B2"),
    "energy": ("stored", "#009E73"),
    "dissipated_energy": ("lost", "#D55E00"),
}
_DASHES = ("-", "--", "-.", ":")


def _axes(count: int = 1, size: tuple[float, float] = (6.4, 4.2)) -> tuple[Figure, Any]:
    """Create a figure with axes side by side."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(1, count, squeeze=False)[0]
    for axes in panels:
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(color="0.9", linewidth=0.6)
    return figure, panels


def energy_balance(motion: Motion) -> Figure:
    """Draw kinetic, stored and dissipated energy over time as a stack, with the total supplied energy as a line."""
    figure, (axes,) = _axes()
    parts = [getattr(motion, name) for name in _PARTS]
    labels, colours = zip(*_PARTS.values(), strict=True)
    axes.stackplot(1e3 * motion.time, parts, labels=labels, colors=colours, alpha=0.7, linewidth=0)
    supplied = motion.kinetic_energy[0] + motion.energy[0] + motion.dissipated_energy[0] + motion.work
    axes.plot(1e3 * motion.time, supplied, color="black", linewidth=1.0, label="put in")
    axes.set_xlabel("time [ms]")
    axes.set_ylabel("energy [N mm]")
    axes.set_title(f"balanced to {motion.drift:.0e} of the largest", fontsize=10)
    axes.legend(frameon=False, fontsize=8)
    return figure


def motion_figure(motion: Motion) -> Figure:
    """Draw the path of the ball's centre within its clearance, seen along y, and the force over time."""
    figure, (path_axes, force_axes) = _axes(2, (9.0, 3.9))
    clearance = float(motion.element.joint.clearance)
    angle = numpy.linspace(0.0, 2 * numpy.pi, 200)
    path_axes.plot(clearance * numpy.sin(angle), clearance * numpy.cos(angle), color="0.4", linewidth=0.8)
    path_axes.plot(motion.position[:, 0], motion.position[:, 2], color="#0072B2", linewidth=0.8)
    path_axes.set_aspect("equal")
    path_axes.set_xlabel("x [mm]")
    path_axes.set_ylabel("z [mm]; grey is first touch")
    load = motion.element(motion.position, motion.velocity, motion.spin)
    force_axes.plot(1e3 * motion.time, numpy.linalg.norm(load.force, axis=1), color="#D55E00", linewidth=0.8)
    force_axes.set_xlabel("time [ms]")
    force_axes.set_ylabel("force [N]")
    force_axes.set_ylim(bottom=0)
    return figure


def loop_figure(depth: Numbers, forces: dict[str, Numbers]) -> Figure:
    """Draw forces over the indentation, each with the energy (N mm) that its loop dissipates."""
    figure, (axes,) = _axes()
    for dash, (name, force) in zip(_DASHES * len(forces), forces.items(), strict=False):
        label = f"{name}: {numpy.trapezoid(force, depth):.3g} N mm lost"
        axes.plot(1e3 * numpy.asarray(depth), force, dash, label=label)
    axes.set_xlabel("indentation d [µm]")
    axes.set_ylabel("force [N]")
    axes.legend(frameon=False, fontsize=8)
    return figure
