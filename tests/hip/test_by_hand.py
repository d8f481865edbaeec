"""Wear by a loop by hand: points in a spiral, springs, small blocks; other hips than those of the other program."""

from itertools import pairwise
from math import cos, pi, radians, sqrt

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.hip import Archard, CrossShear, HipSimulation, iso_14242_1

from ..extent import some
from .hips import report_after

POINTS, INSTANTS = 2000, 40
FORCE = ((0.0, 300.0), (0.12, 3000.0), (0.32, 1500.0), (0.5, 3000.0), (0.62, 300.0), (1.0, 300.0))


def load(t):
    (begin, low), (end, high) = next(pair for pair in pairwise(FORCE) if t <= pair[1][0])
    return low + (high - low) * (1 - cos(pi * (t - begin) / (end - begin))) / 2


def turned(t, order):
    flexion = 3.5 + 21.5 * cos(2 * pi * t)
    adduction = 1.5 + 5.5 * cos(2 * pi * (t - 0.21))
    angles = {"X": flexion, "Y": adduction, "Z": -4 - 6 * cos(2 * pi * t)}
    return Rotation.from_euler(order, [angles[axis] for axis in order], degrees=True)


def by_hand(joint, modulus, tilt, order, depth_of, millions, block=0.02):
    """Volume and depth after so many million cycles, and their rates in the first."""
    radius, share = float(joint.socket_radius), (np.arange(POINTS) + 0.5) / POINTS
    around, across = np.arange(POINTS) * pi * (1 + sqrt(5)), np.sqrt(1 - (1 - share) ** 2)
    own = np.stack([across * np.cos(around), across * np.sin(around), 1 - share], axis=1)
    n, area = Rotation.from_euler("Y", -tilt, degrees=True).apply(own), 2 * pi * radius**2 / POINTS
    turns = [turned((i + 1) / INSTANTS, order) * turned(i / INSTANTS, order).inv() for i in range(INSTANTS)]
    slide = float(joint.ball_radius) * np.cross([turn.as_rotvec() for turn in turns], n[:, None]).swapaxes(0, 1)
    force = np.array([[0, 0, load((i + 0.5) / INSTANTS)] for i in range(INSTANTS)])
    e, depth = np.tile([0, 0, joint.clearance + 0.05], (INSTANTS, 1)), np.zeros(POINTS)

    def rate(depth, e):
        for _ in range(30):
            p = modulus * np.maximum(e @ n.T - joint.clearance - depth, 0)
            stiff = modulus * area * np.einsum("tp,pi,pj->tij", (p > 0) * 1.0, n, n) + 1e-9 * np.eye(3)
            e = e + np.linalg.solve(stiff, (force - p @ n * area)[..., None])[..., 0]
            if abs(force - p @ n * area).max() < 1e-3:
                break
        return depth_of(p, slide), e

    begun, done = rate(depth, e)[0], 0.0
    while done < millions - 1e-9:
        length = min(block if done > block else block / 4, millions - done)
        now, e = rate(depth, e)
        middle, e = rate(depth + 0.5e6 * length * now, e)
        depth, done = depth + 1e6 * length * middle, done + length
    return np.array([1e6 * begun.sum() * area, 1e6 * begun.max(), depth.sum() * area, depth.max()])


def archard(k):
    return lambda p, slide: 1e-3 * k * (p * np.linalg.norm(slide, axis=2)).sum(axis=0)


def by_cross_shear(straight, circular):
    def depth(p, slide):
        size = np.linalg.norm(slide, axis=2)
        values = np.linalg.eigvalsh(np.einsum("tp,tpi,tpj->pij", p / size, slide, slide))[:, 1:]  # across n it is 0
        whole = np.maximum(values.sum(axis=1), 1e-300)
        return 1e-3 * (straight + 2 * values[:, 0] / whole * (circular - straight)) * (p * size).sum(axis=0)

    return depth


@pytest.mark.parametrize(
    ("diameter", "clearance", "liner", "tilt", "order", "law", "depth_of"),
    some(
        [
            (44.0, 0.03, 3.0, 55.0, "YXZ", CrossShear(straight=5e-8, circular=8e-7), by_cross_shear(5e-8, 8e-7)),
            (32.0, 0.05, 7.0, 45.0, "ZYX", Archard(coefficient=2e-6), archard(2e-6)),
            (22.225, 0.3, 4.0, 20.0, "XYZ", Archard(coefficient=3e-7), archard(3e-7)),
        ],
        1,
    ),
)
def test_independent_loop_gives_the_same_wear(diameter, clearance, liner, tilt, order, law, depth_of):
    joint = bs.Joint(ball_radius=diameter / 2, clearance=clearance, liner_thickness=liner, liner=bs.UHMWPE)
    use = HipSimulation(
        joint=joint, cycle=iso_14242_1(INSTANTS, order.lower()), wear=law, cup=bs.Cup().tilted(radians(tilt))
    )
    last = report_after(use, 3e5)
    expected = by_hand(joint, float(bs.Springs().modulus(joint)), tilt, order, depth_of, 0.3)
    assert [use.first.volume, use.first.depth, last.volume, last.depth] == pytest.approx(expected, rel=5e-3)
