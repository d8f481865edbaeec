"""The finite elements beside CalculiX: on the paper's mesh, and at equal error."""

from __future__ import annotations

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.finite_elements import bodies, solver
from ballsocket.elasticity.finite_elements import calculix as ccx
from ballsocket.elasticity.finite_elements.deck import deck_of

from .calculix_rival import Calculix, Mesh
from .report import Rows
from .timing import Spread

PAPER = bs.Joint(ball_radius=12.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE, ball=bs.STEEL)
PAPERS_MESH: dict[str, Any] = {"spacing": bs.Uniform(size=0.05), "element": bs.Element.BILINEAR, "meshes": 1}
STEPS = 20
RIGID = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE)
DEPTHS = numpy.linspace(0.01, 0.045, STEPS)
COARSE: dict[str, Any] = {
    "cup": bs.Cup(arc_of_cover=numpy.radians(240.0)),
    "spacing": bs.Adapted(elements=24),
    "meshes": 1,
}
MESH = Mesh(name="0.3 % mesh", angles=((1.0, 1), (48.0, 12)), deep=2, slope=1e6)
REPEATS = 5


def forget() -> None:
    """Nothing is known of any joint."""
    for kept in (solver.load_curve_of, bodies.socket_compliance, bodies.ball_compliance):
        kept.cache_clear()


def seconds(settings: dict[str, Any], joint: bs.Joint, depths: numpy.ndarray) -> tuple[float, bs.Contact]:
    """A curve on a joint that was never seen: how long, and what."""
    forget()
    start = perf_counter()
    contact = bs.FiniteElement(**settings).press(joint, indentation=depths)
    _ = contact.max_pressure, contact.half_angle
    return perf_counter() - start, contact


def on_the_papers_mesh() -> Rows:
    """Twenty steps to 3 kN, both programs on the same bilinear mesh; once, since CalculiX takes minutes."""
    table = Rows(
        f"The paper's mesh, {STEPS} steps to 3 kN", ("what", "elements", "s", "at 3 kN: d µm", "F N", "p0 MPa", "ε °")
    )
    pressed: Any = bs.FiniteElement(**PAPERS_MESH).press(PAPER, force=3000.0)
    made = deck_of(pressed, steps=STEPS)
    depths = made.expected["indentation"]
    ours, answer = seconds(PAPERS_MESH, PAPER, depths)
    row = (answer.indentation[-1], answer.force[-1], answer.pole_pressure[-1], answer.half_angle[-1])
    table.add("ours", pressed.mesh.elements, f"{ours:.2f}", *_digits(*row))
    if shutil.which("ccx") is None:
        return table
    with TemporaryDirectory() as folder:
        made.write(Path(folder))
        start = perf_counter()
        theirs = ccx.run(Path(folder), threads=2)
        took = perf_counter() - start
    row = (theirs.indentation[-1], theirs.force[-1], theirs.pole_pressure[-1], theirs.half_angle[-1])
    table.add("CalculiX", pressed.mesh.elements, f"{took:.1f}", *_digits(*row))
    table.add("ratio (aim 50)", "", f"{took / ours:.0f}", "", "", "", "")
    return table


def _digits(d: float, force: float, pressure: float, angle: float) -> tuple[str, ...]:
    return f"{1e3 * d:.3f}", f"{force:.1f}", f"{pressure:.3f}", f"{numpy.degrees(angle):.2f}"


def at_equal_error() -> Rows:
    """A curve of twenty steps on the coarsest mesh with which CalculiX keeps the force within 0.3 %."""
    table = Rows(
        f"Equal error: a curve of {STEPS} steps, rigid ball",
        ("what", "elements", "s", "worst of F, %", "p0, %", "ε, °"),
    )
    exact = bs.Exact(tolerance=1e-9).press(RIGID, indentation=DEPTHS)
    ours, theirs = [], []
    with TemporaryDirectory() as folder:
        rival = Calculix(RIGID, MESH, DEPTHS, Path(folder)) if shutil.which("ccx") else None
        for _ in range(REPEATS):
            took, contact = seconds(COARSE, RIGID, DEPTHS)
            ours.append(took)
            if rival is not None:
                start = perf_counter()
                rival.run()
                theirs.append(perf_counter() - start)
        widest: Any = bs.FiniteElement(**COARSE).press(RIGID, indentation=float(DEPTHS[-1]))
        table.add(
            "ours, adapted to each step", f"{widest.mesh.elements} each", Spread(tuple(ours)), *_errors(contact, exact)
        )
        if rival is not None:
            table.add("CalculiX", 84, Spread(tuple(theirs)), *_errors(rival.answer(), exact))
            table.add("ratio (aim 20)", "", Spread(tuple(theirs)).over(Spread(tuple(ours))), "", "", "")
    return table


def _errors(answer: Any, exact: bs.Contact) -> tuple[str, ...]:
    shares = (numpy.nanmax(abs(getattr(answer, name) / getattr(exact, name) - 1)) for name in ("force", "max_pressure"))
    degrees = numpy.degrees(numpy.nanmax(abs(answer.half_angle - exact.half_angle)))
    return (*(f"{100 * share:.2g}" for share in shares), f"{degrees:.2g}")
