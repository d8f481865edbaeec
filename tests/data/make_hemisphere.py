"""Print `data/hemisphere.toml`: change of a contact on a hemisphere with a free rim, fitted to `Exact`'s own estimate.

Run `python tests/data/make_hemisphere.py > src/ballsocket/data/hemisphere.toml`; it takes some minutes.
"""

import numpy as np

import ballsocket as bs
from ballsocket.contact import closed_sphere

ANGLES = np.radians([3, 6, 10, 15, 20, 25, 30, 36, 42, 48, 54, 60, 66, 72, 78, 83])
COUNT, SEED = 800, 1
MIN_CHANGE = 1e-4  # changes below it are not fitted
SMALL_CHANGE = 3e-3  # changes below it count less

HEAD = """\
# Relative change of a contact at the same force from the closed sphere to a hemisphere with a free rim, for liners on
# a rigid backing: ln of it is a polynomial of e (rad), ln(R2/L), ln(0.52 - nu), fitted to `contact.hemisphere` of Exact
# for half angles of 3-83 degrees, nu 0-0.499 and R2/L 0.2-20, as tests/data/make_hemisphere.py prints it. `indentation`
# and `largest` (of d, e, pmax and dF/dd) are for a rigid ball; `ball` is what half a ball adds in d over E/E_ball.
# Estimate over change, 1st, 5th, 50th, 95th and 99th percentile of held-out joints where it is above 0.5 %:"""


def joint_of(random: np.random.Generator) -> tuple[bs.Joint, float, float]:
    """A joint with a rigid ball, and modulus ratio and Poisson's ratio of an elastic one."""
    near_half = 0.5 - np.exp(random.uniform(np.log(0.5 - closed_sphere.POISSON_RANGE[1]), np.log(0.1)))
    poisson = random.uniform(closed_sphere.POISSON_RANGE[0], 0.45) if random.random() < 0.5 else near_half
    ratio = np.exp(random.uniform(*np.log(closed_sphere.THICKNESS_RATIO_RANGE)))
    liner = bs.Material(young=1000.0, poisson=float(poisson))
    joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=14.1 / ratio, liner=liner)
    modulus_ratio = float(np.exp(random.uniform(np.log(1e-3), np.log(closed_sphere.MAX_MODULUS_RATIO))))
    return joint, modulus_ratio, random.uniform(0.15, 0.4)


def changes(joint: bs.Joint) -> np.ndarray:
    """Change of the indentation, and the largest of all, at the half angles."""
    relative_changes = bs.ExactCurve().press(joint, half_angle=ANGLES).hemisphere
    largest = np.max([abs(values) for values in relative_changes.values()], axis=0)
    return np.stack([relative_changes["indentation"], largest])


def fitted(variables: np.ndarray, known: np.ndarray, degree: int, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients, and the estimates at all variables."""
    exponents = np.array(closed_sphere.polynomial_exponents(degree))
    terms = np.prod(variables.T[:, None] ** exponents, axis=-1)
    good = np.isfinite(known) & (known > MIN_CHANGE) & ~held
    weight = np.clip(known[good] / SMALL_CHANGE, 0.15, 1.0)
    numbers, *_ = np.linalg.lstsq(terms[good] * weight[:, None], np.log(known[good]) * weight)
    return numbers, np.exp(terms @ numbers)


def main() -> None:
    random = np.random.default_rng(SEED)
    where, rigid, elastic, ratios = [], [], [], []
    for _ in range(COUNT):
        joint, ratio, poisson = joint_of(random)
        variables = closed_sphere.polynomial_variables(ANGLES, joint.liner.poisson, joint.thickness_ratio)
        where.append(np.stack(np.broadcast_arrays(*variables)))
        rigid.append(changes(joint))
        elastic.append(changes(joint.replace(ball=bs.Material(young=1000.0 / ratio, poisson=poisson))))
        ratios.append(np.full(len(ANGLES), ratio))
    at, share = np.concatenate(where, axis=1), np.concatenate(ratios)
    still, soft = np.concatenate(rigid, axis=1), np.concatenate(elastic, axis=1)
    held = np.arange(at.shape[1]) // len(ANGLES) % 4 == 0
    known = {"indentation": (still[0], 5), "largest": (still[1], 5), "ball": ((soft[0] - still[0]) / share, 4)}
    fits = {name: fitted(at, *values, held) for name, values in known.items()}
    estimates = {name: estimate for name, (_, estimate) in fits.items()}
    added = {"indentation": share * estimates["ball"], "largest": closed_sphere.BALL_FACTOR * share * estimates["ball"]}
    print(HEAD)
    for body, truth, change in (("rigid ball", still, dict.fromkeys(added, 0.0)), ("elastic ball", soft, added)):
        for row, name in enumerate(added):
            ratio = (estimates[name] + change[name]) / truth[row]
            quantiles = np.percentile(ratio[held & (truth[row] > 0.005)], [1, 5, 50, 95, 99])
            print(f"# {body}, {name}: {', '.join(f'{value:.2f}' for value in quantiles)}")
    for name, (numbers, _) in fits.items():
        print(f"{name} = [")
        for first in range(0, len(numbers), 7):
            print("    " + " ".join(f"{number:.5g}," for number in numbers[first : first + 7]))
        print("]")


if __name__ == "__main__":
    main()
