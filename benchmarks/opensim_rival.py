"""One force evaluation of the same ball in the same socket: this package's closed form against OpenSim.

OpenSim's ElasticFoundationForce is the elastic foundation that biomechanics people have at hand: springs at the
centroids of a mesh. Fair, because both get the same radii and the same K; because the mesh is made so that the springs
sit near the sphere, nearer than those of a mesh with its vertices there; because OpenSim neither rubs nor dissipates;
and because it is asked for one force at a new position, as in each step of a simulation. Its time includes its own
Python wrapper, as ours includes Python.
"""

from __future__ import annotations

import importlib.util
from math import pi
from typing import Any

import numpy

import ballsocket as bs

from .report import Report, Rows
from .timing import Work, interleaved

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
K = float(bs.hess_forsbach(JOINT))
MODEL = bs.RadialFoundation(modulus=bs.constant(K), kinematics=bs.exact_kinematics)
DEPTHS, TIMED = (0.005, 0.02, 0.06), 0.06  # mm
FACES = (1000, 4000, 16000)
CALLS, POINTS, REPEATS = 200, 10**5, 15


def measure() -> Report | str:
    if importlib.util.find_spec("opensim") is None:
        return "opensim is not installed"
    from .opensim_model import build

    pairs = [build(JOINT.ball_radius, JOINT.clearance, K, faces) for faces in FACES]
    notes = [
        f"R2 18, c 0.1, L 6.75 mm, E 1000 MPa, nu 0.4: K {K:.2f} MPa/mm from `hess_forsbach`; exact kinematics.",
        "OpenSim pushes along the ball's radius and this package along the socket's, which alone differs by 0.02 to "
        "0.23 %; OpenSim's own physics without a mesh is F = pi K R2/12 (d/e)^2 [4 R2 (2e + c) - (12 e^2 - 4 e d + "
        "d^2)], e = c + d, and what remains against it is the mesh.",
        f"Timed {TIMED} mm deep, at positions that alternate by 1e-6 of that, in runs of {CALLS} calls. OpenSim has no "
        "call for many positions: the rows with an array are for sweeps, not for a step of a simulation.",
        "The meshes are this benchmark's: the farthest spring of the socket is off the sphere by "
        + ", ".join(f"{1e3 * pair.off_sphere:.2f} µm ({pair.faces} faces)" for pair in pairs)
        + ".",
    ]
    return Report([_speeds(pairs), _answers(pairs)], notes, ("opensim",))


def _alternating(force: Any) -> Work:
    def work() -> None:
        for call in range(CALLS):
            force(TIMED * (1 + 1e-6 * (call % 2)))

    return work


def _speeds(pairs: list[Any]) -> Rows:
    many = TIMED * numpy.linspace(0.9, 1.1, POINTS)
    alone, batched = "ours", "ours, array"
    work: dict[str, Work] = {alone: _alternating(lambda d: MODEL.press(JOINT, indentation=d).force)}
    work[batched] = lambda: MODEL.press(JOINT, indentation=many).force
    for pair in pairs:
        work[str(pair.faces)] = _alternating(pair.force)
    _, seconds = interleaved(REPEATS, work)
    rows = Rows("One force evaluation, µs", ("what", "ours", "OpenSim", "OpenSim over ours"))
    for what, name, points in (("one press, plain floats", alone, CALLS), (f"array of {POINTS}", batched, POINTS)):
        ours = seconds[name].per(1e-6 * points)
        for pair in pairs:
            rival = seconds[str(pair.faces)].per(1e-6 * CALLS)
            rows.add(f"{what}; mesh of {pair.faces} faces", ours, rival, rival.over(ours))
    return rows


def _answers(pairs: list[Any]) -> Rows:
    columns = ("depth, faces", "ours, N", "OpenSim, N", "OpenSim against ours", "OpenSim against its own physics")
    rows = Rows("Answers", columns)
    for depth in DEPTHS:
        ours = float(MODEL.press(JOINT, indentation=depth).force)
        for pair in pairs:
            theirs = pair.force(depth)
            own = theirs / along_the_ball(depth)
            what = f"{depth} mm, {pair.faces} faces"
            rows.add(
                what, f"{ours:.4f}", f"{theirs:.4f}", f"{100 * theirs / ours - 100:+.3f} %", f"{100 * own - 100:+.3f} %"
            )
        rows.add(
            f"{depth} mm, no mesh",
            f"{ours:.4f}",
            f"{along_the_ball(depth):.4f}",
            f"{100 * along_the_ball(depth) / ours - 100:+.3f} %",
            "0",
        )
    return rows


def along_the_ball(d: float) -> float:
    """OpenSim's force in N without the error of its mesh: displacement and pressure along the ball's radius."""
    R2, c = JOINT.socket_radius, JOINT.clearance
    e = c + d
    return float(pi * K * R2 / 12 * (d / e) ** 2 * (4 * R2 * (2 * e + c) - (12 * e**2 - 4 * e * d + d**2)))
