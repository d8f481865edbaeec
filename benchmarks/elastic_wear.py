"""What full elasticity changes against springs in wear over five million cycles: data of the gallery, some minutes.

python -m benchmarks.elastic_wear examples/elastic_wear.json
"""

from __future__ import annotations

import json
import sys
from math import radians
from pathlib import Path
from time import perf_counter
from typing import Any

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

K = 1.066e-6
CYCLES = (1e4, 3e4, 1e5, 2e5, 5e5, 1e6, 2e6, 5e6)
SURFACES = {"springs": bs.Springs(), "closed shell": bs.ClosedShell(), "real cup": bs.RealCup()}
CASES: dict[str, dict[str, float]] = {
    "28 mm, as usual": {},
    "clearance 0.05 mm": {"clearance": 0.05},
    "clearance 0.2 mm": {"clearance": 0.2},
    "36 mm, liner 6 mm": {"head_diameter": 36.0, "liner_thickness": 6.0},
    "cup tilted by 50°": {"tilt": 50.0},
    "ν = 0.46": {"poisson": 0.46},
}


def worn(surface: Any, case: dict[str, float]) -> dict[str, list[float]]:
    """Volume, depth, penetration and largest pressure after the cycles; the first cycle's rates."""
    sizes: dict[str, Any] = {
        "head_diameter": 28.0,
        "liner_thickness": 8.0,
        "clearance": 0.1,
        "poisson": 0.4,
        "tilt": 30.0,
        **case,
    }
    liner, tilt = bs.Material(young=1000.0, poisson=sizes.pop("poisson")), sizes.pop("tilt")
    use = HipSimulation(
        joint=bs.Joint(liner=liner, **sizes),
        cup=bs.Cup(inclination=radians(tilt)),
        cycle=iso_14242_1(),
        wear=Archard(coefficient=K),
        surface=surface,
    )
    reports, first = use.after(max(CYCLES), CYCLES).reports, use.first
    names = ("volume", "depth", "penetration", "max_pressure")
    results = {name: [round(float(getattr(report, name)), 6) for report in reports] for name in names}
    return {**results, "first": [round(float(value), 6) for value in (first.volume, first.depth, first.max_pressure)]}


if __name__ == "__main__":
    start = perf_counter()
    results = {
        case: {name: worn(surface, sizes) for name, surface in SURFACES.items()} for case, sizes in CASES.items()
    }
    data = {
        "origin": f"python -m benchmarks.elastic_wear, ballsocket {bs.__version__}, {perf_counter() - start:.0f} s on "
        f"one core: ISO 14242-1 in 100 instants, rings of 3°, Archard with k = {K} mm³/(N m), E 1000 MPa",
        "units": "mm³, mm, MPa",
        "first": "volume and depth a million cycles, largest pressure",
        "cycles": CYCLES,
        "cases": results,
    }
    Path(sys.argv[1]).write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
