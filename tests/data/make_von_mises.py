"""Print `data/von_mises.toml`: largest von Mises stress in a liner over the largest pressure, from the exact answer.

Run `python tests/data/make_von_mises.py > src/ballsocket/data/von_mises.toml`; it takes some minutes.
"""

from itertools import product
from math import inf, radians

import numpy as np

import ballsocket as bs
from ballsocket.contact.strength import FIT_EXPONENTS, fit_variables

ANGLES = (4, 8, 15, 25, 35, 45, 55, 65, 75, 85)
POISSON = (0.0, 0.15, 0.3, 0.4, 0.45, 0.48, 0.499)
RATIOS = (0, 0.35, 0.8, 1.5, 2.67, 4, 6, 10, 20)
LEAST = 0.25  # shares below it are counted by their difference

HEAD = """\
# Largest von Mises stress in a liner on a rigid backing over the largest pressure: fitted to the exact answer for
# half angles of 4-85 degrees, nu 0-0.499, R2/L 0-20, as tests/data/make_von_mises.py prints it. Each row is a
# coefficient and the powers of x = sin(e/2), y = a/(L + a) with a = R2 sin(e), and nu that it multiplies.
# Off by {typical:.3f} typically, {worst:.3f} at the worst, relative to the share or to {least} if that is more."""


def share(angle: float, poisson: float, ratio: float) -> tuple[float, ...] | None:
    """The three places and the share; None where the ball fills its socket before."""
    liner, thickness = bs.Material(young=1000.0, poisson=poisson), 18.0 / ratio if ratio else inf
    joint = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=thickness, liner=liner)
    contact = bs.Exact(tolerance=1e-5).press(joint, half_angle=radians(angle))
    if contact.status.failed:
        return None
    where = fit_variables(contact.half_angle, joint.liner.poisson, joint.thickness_ratio)
    return (*where, contact.peak_stress.von_mises / contact.max_pressure)


def main() -> None:
    found = (share(*case) for case in product(ANGLES, POISSON, RATIOS))
    x, y, nu, known = np.array([case for case in found if case is not None]).T
    terms = np.stack([x**i * y**j * nu**k for i, j, k in FIT_EXPONENTS], axis=1)
    scale = np.maximum(known, LEAST)
    fitted, *_ = np.linalg.lstsq(terms / scale[:, None], known / scale)
    off = abs(terms @ fitted - known) / scale
    print(HEAD.format(typical=np.sqrt(np.mean(off**2)), worst=off.max(), least=LEAST))
    print("terms = [")
    for number, powers in zip(fitted, FIT_EXPONENTS, strict=True):
        print(f"    [{number:.4f}, {', '.join(map(str, powers))}],")
    print("]")


if __name__ == "__main__":
    main()
