"""Values that public entries accept and refuse, for `benchmarks.identical`.

Each parameter takes a row of values in turn, while the others keep good ones. The result is "accepted", or the type of
the exception, for each value; messages are recorded as texts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import inf, nan, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import ballsocket as bs
from ballsocket import dynamics as motion
from ballsocket import hip as wear
from ballsocket import studies as design
from ballsocket.identification import Machine, Measured, oscillation

from .entries_in_use import JOINT, WALK, elements, in_use
from .entries_of_contact import HIP

if TYPE_CHECKING:
    from .identical import Results

VALUES: tuple[Any, ...] = (
    *(-inf, -1e9, -1.0, -1e-9, 0.0, 1e-12, 1e-4, 0.01, 0.05, 0.1, 0.3, 0.49, 0.5, 0.9, 1.0, 1.5, 2.0, pi, 7.0, 24, 60),
    *(100.0, 1e9, inf, nan, None, "1", True, 1j),
)
"""Values that a parameter takes in turn."""


def _entries() -> Iterator[tuple[str, Callable[..., Any], dict[str, Any]]]:
    """Yield names, functions, and good values of the parameters that vary."""
    strengths = {"proportional_limit": 5.0, "yield_stress": 20.0, "fatigue_limit": 9.0, "allowable_pressure": 30.0}
    yield "Material", bs.Material, {"young": 1000.0, "poisson": 0.4, **strengths}
    yield "Layer", lambda thickness: bs.Layer(thickness=thickness, material=bs.TITANIUM), {"thickness": 3.0}
    lengths = {"ball_radius": 14.0, "clearance": 0.1, "liner_thickness": 8.0}
    yield "Joint", lambda **words: bs.Joint(liner=bs.UHMWPE, **words), lengths
    yield "Joint by diameters", HIP.replace, {"head_diameter": 28.0, "diametral_clearance": 0.2, "outer_diameter": 40.0}
    yield "Cup", bs.Cup, {"arc_of_cover": 2.8, "chamfer": 1.0, "inclination": 0.7, "anteversion": 0.2}
    for model in (*bs.catalogue.values(), bs.Sphere(ring_width=0.1)):
        for load in ("force", "indentation", "half_angle"):
            yield f"{model.name} by {load}", _presses(model, load), {load: 0.3}
    yield "Sphere", bs.Sphere, {"ring_width": 0.05}
    aims = {"tilt": 0.3, "azimuth": 0.5}
    yield "Sphere aims", lambda **words: bs.Sphere(ring_width=0.1).press(HIP, force=1e3, **words), aims
    yield "Exact", bs.Exact, {"tolerance": 1e-6}
    yield "Adapted", bs.Adapted, {"elements": 24, "growth": 1.3}
    yield "Uniform", bs.Uniform, {"size": 0.5, "growth": 1.03}
    yield "FiniteElement", bs.FiniteElement, {"meshes": 1}
    yield "OvalBore", bs.OvalBore, {"squeeze": 0.1, "direction": 0.3}
    yield "AdhesiveSocket", bs.AdhesiveSocket, {"work_of_adhesion": 1e-4}
    yield "constant", bs.constant, {"modulus": 200.0}
    yield "polynomial", bs.polynomial, {"c1": 0.8, "c2": 1.4, "c3": 0.06}
    yield "corrected_vessel", bs.corrected_vessel, {"a0": 1.0, "a1": 0.1, "a2": 0.1}
    yield "pressure", bs.HessForsbach().press(HIP, force=1e3).pressure, {"angle": 0.3}
    torque = bs.HessForsbach().press(HIP, force=1e3).friction_torque
    yield "friction_torque", torque, {"coefficient": 0.1, "axis_angle": 0.3}
    yield "pin", lambda **words: bs.PinInHole().press(HIP, **words), {"line_load": 10.0}
    yield "Damping", motion.Damping, {"hysteresis": 1e-3, "time": 1e-3}
    yield "Flores", motion.Flores, {"restitution": 0.8, "impact_speed": 100.0}
    rubbing = {"coefficient": 0.1, "static_coefficient": 0.2, "stribeck_speed": 10.0, "viscous": 1e-4}
    yield "Friction", motion.Friction, {**rubbing, "transition_speed": 0.1}
    yield "Bristles", motion.Bristles, {**rubbing, "stiffness": 100.0, "damping": 1e-3, "release": 1e-3}
    yield (
        "ForceElement",
        lambda smoothing: bs.ForceElement(bs.HessForsbach(), HIP, smoothing=smoothing),
        {"smoothing": 0},
    )
    yield "Prony", lambda share, time: motion.Prony(terms=((share, time),)), {"share": 0.3, "time": 1.0}
    yield "restitution_of", motion.relations.restitution_of, {"damping": 0.1}
    for relation in motion.relations.relations:
        yield f"relation {relation.name}", relation.damping, {"restitution": 0.7}
    yield "from_restitution", motion.from_restitution, {"speed": 20.0, "restitution": 0.8, "uncertainty": 0.01}
    thrown = {"mass": 1.0, "inertia": 100.0}
    still: dict[str, Any] = {"position": (0.0, 0.0, 0.0), "duration": 1e-5, "step": 1e-5}
    yield "simulate", lambda **words: motion.simulate(elements()["springs"], **still, **words), thrown
    yield from _wear_entries()
    yield "LogNormal", design.LogNormal, {"median": 1.0, "factor": 1.5}
    yield "Normal", design.Normal, {"mean": 1.0, "deviation": 0.3, "low": 0.1, "high": 8.0}
    yield "Rectangular", design.Rectangular, {"low": 0.1, "high": 8.0}
    yield "tolerance", design.tolerance, {"nominal": 0.1, "plus_minus": 0.05}
    yield "Limit", lambda low, high: design.Limit(name="max_pressure", low=low, high=high), {"low": 0.2, "high": 5.0}
    force = design.Rectangular(low=1.0, high=2.0)
    yield "sample", lambda **words: design.sample(**words, force=force), {"count": 4, "seed": 1}
    yield "Machine", Machine, {"compliance": 1e-6, "offset": 0.01, "drift": 1e-4}
    yield "oscillation", oscillation, {"mass": 2.0}
    numbers = {"values": 0.1, "uncertainty": 0.01, "force": 100.0, "load_uncertainty": 1.0, "saturation": 5.0}
    yield "Measured", lambda **words: Measured(quantity="indentation", **words), numbers


def _presses(model: Any, load: str) -> Callable[..., Any]:
    """Return a press of a model by a load."""
    return lambda **words: model.press(HIP, **{load: words[load]})


def _wear_entries() -> Iterator[tuple[str, Callable[..., Any], dict[str, Any]]]:
    """Yield the entries of hips in use."""
    yield "Archard", wear.Archard, {"coefficient": 1e-6}
    yield "FrictionEnergyWear", wear.FrictionEnergyWear, {"coefficient": 1e-6, "friction": 0.06}
    yield "ContactAreaWear", wear.ContactAreaWear, {"coefficient": 1e-9}
    yield "CrossShear", wear.CrossShear, {"straight": 1e-7, "circular": 1e-6, "exponent": 0.1, "reference": 2.0}
    yield (
        "KelvinVoigtChain",
        lambda J, time: wear.KelvinVoigtChain(compliances=(J,), times=(time,)),
        {"J": 1e-3, "time": 60.0},
    )
    yield "logarithmic", wear.logarithmic, {"confinement": 0.5}
    yield "constrained_share", wear.constrained_share, {"poisson": 0.4}
    lubricant = {"viscosity": 1e-3, "ball_roughness": 1e-5, "cup_roughness": 1e-3, "friction": 0.06}
    yield "Lubricant", wear.Lubricant, lubricant
    yield "Spring", wear.Spring, {"stiffness": 100.0, "mismatch": 4.0}
    yield "Activity", lambda per_year: wear.Activity(cycle=WALK, per_year=per_year), {"per_year": 1e6}
    yield "iso_14242_1", wear.iso_14242_1, {"n_steps": 20, "order": "xyz"}
    yield "iso_14242_4", wear.iso_14242_4, {"n_steps": 20, "mismatch": 4.0, "stiffness": 100.0, "swing_load": 70.0}
    yield "in_vivo", wear.in_vivo, {"name": "walking", "body_weight": 800.0}
    yield "named_cycle", wear.named_cycle, {"name": "flexion", "n_steps": 20}
    yield (
        "HipSimulation",
        in_use,
        {"ring_width": 0.1, "tolerance": 4e-3, "seconds_per_cycle": 1.0, "joint": JOINT, "cycle": WALK},
    )
    yield "after", lambda cycles: in_use(ring_width=0.17).after(cycles, report_at=[0.2]), {"cycles": 2.0}
    scatter = {"body_weight": 700.0}
    distributions = {"body_weight": design.LogNormal(median=700.0, factor=1.1)}
    yield (
        "PatientVariability",
        lambda **words: wear.PatientVariability(use=in_use(), distributions=distributions, **words),
        scatter,
    )
    patient = {"clearance": 0.2, "tilt": 0.5, "body_weight": 800.0, "coefficient": 1e-6}
    yield (
        "patient",
        lambda **words: wear.PatientVariability(use=in_use(), distributions=distributions).patient(words),
        patient,
    )


def refusals(results: Results, folder: Path) -> None:
    """Record which values each entry accepts."""
    for name, entry, good in _entries():
        for parameter in good:
            outcomes = [_outcome(entry, {**good, parameter: value}) for value in VALUES]
            results.add(f"{name}/{parameter}", [float(outcome == "accepted") for outcome in outcomes])
            results.add(f"{name}/{parameter}/kinds", ",".join(outcome.partition(":")[0] for outcome in outcomes))
            results.add(f"{name}/{parameter}/messages", outcomes)


def _outcome(entry: Callable[..., Any], words: Mapping[str, Any]) -> str:
    """Return "accepted", or the type and message of the exception."""
    try:
        entry(**words)
    except Exception as error:
        return f"{type(error).__name__}: {error}".partition("\n")[0]
    return "accepted"
