"""What full elasticity changes against springs in wear: volume and depth over five million cycles, for the gallery.

    python -m benchmarks.elastic_wear examples/elastic_wear.json

Some minutes; the gallery draws what is kept.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from math import radians
from pathlib import Path
from time import perf_counter
from typing import Any

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

K = 1.066e-6
LOOKS = (1e4, 3e4, 1e5, 2e5, 5e5, 1e6, 2e6, 5e6)
SURFACES = {"springs": bs.Springs(), "closed shell": bs.ClosedShell(), "real cup": bs.RealCup()}
USUAL: Mapping[str, float] = {"diameter": 28.0, "liner": 8.0, "clearance": 0.1, "poisson": 0.4, "tilt": 30.0}
CASES: Mapping[str, Mapping[str, float]] = {
    "28 mm, as usual": {},
    "clearance 0.05 mm": {"clearance": 0.05},
    "clearance 0.2 mm": {"clearance": 0.2},
    "36 mm, liner 6 mm": {"diameter": 36.0, "liner": 6.0},
    "cup tilted by 50°": {"tilt": 50.0},
    "ν = 0.46": {"poisson": 0.46},
}


def worn(surface: Any, case: Mapping[str, float]) -> dict[str, list[float]]:
    """Volume, depth, penetration and largest pressure at the looks; the first cycle's rates before them."""
    sizes = {**USUAL, **case}
    use = HipSimulation(
        joint=bs.Joint(
            head_diameter=sizes["diameter"],
            clearance=sizes["clearance"],
            liner_thickness=sizes["liner"],
            liner=bs.Material(young=1000.0, poisson=sizes["poisson"]),
        ),
        cup=bs.Cup(inclination=radians(sizes["tilt"])),
        cycle=iso_14242_1(),
        wear=Archard(coefficient=K),
        surface=surface,
    )
    reports = use.after(max(LOOKS), LOOKS).reports
    names = ("volume", "depth", "penetration", "max_pressure")
    found = {name: [round(float(getattr(report, name)), 6) for report in reports] for name in names}
    return {**found, "first": [round(each, 6) for each in (use.first.volume, use.first.depth, use.first.max_pressure)]}


def main(path: Path) -> None:
    begin = perf_counter()
    found = {case: {name: worn(surface, sizes) for name, surface in SURFACES.items()} for case, sizes in CASES.items()}
    origin = (
        f"python -m benchmarks.elastic_wear, ballsocket {bs.__version__}, {perf_counter() - begin:.0f} s on one core: "
        f"ISO 14242-1 in 100 instants, rings of 3°, Archard with k = {K} mm³/(N m), E 1000 MPa"
    )
    told = {
        "origin": origin,
        "units": "mm³, mm, MPa",
        "first": "volume and depth a million cycles, largest pressure",
        "cycles": LOOKS,
        "cases": found,
    }
    path.write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
