"""Plane mattress of springs: a contact model for `ballsocket press --model plane_springs.py:PlaneSprings`."""

from dataclasses import dataclass
from math import inf, pi, radians

import numpy as np

import ballsocket as bs


def columns(joint):
    """Stiffness of liner columns that expand freely, K = E/L."""
    return joint.liner.young / joint.liner_thickness


columns.source = "textbook formula of a bar, E/L"


@dataclass(frozen=True, kw_only=True)
class PlaneSprings(bs.ClosedForm):
    """Springs of stiffness K on a plane under a ball of radius R*: F = π K R* d²."""

    stiffness_factor: float = 1.0

    name = "plane-springs"
    title = "plane mattress of independent liner columns"
    sources = ()
    source = "lecture notes on contact mechanics, 2026"
    planar = True
    domain = (bs.Range(quantity="joint.clearance", low=0.0, why="R* = R1 R2/c is infinite without clearance"),)
    validity = (bs.Range(quantity="half_angle", high=radians(25.0), why="a plane does not curve"),)

    def spring(self, joint):
        return self.stiffness_factor * columns(joint)

    def force(self, joint, indentation):
        return self.stiffness(joint, indentation) * indentation / 2

    def stiffness(self, joint, indentation):
        return 2 * pi * self.spring(joint) * joint.ball_radius * joint.socket_radius / joint.clearance * indentation

    def energy(self, joint, indentation):
        return self.force(joint, indentation) * indentation / 3

    def half_angle(self, joint, indentation):
        return (2 * joint.ball_radius * indentation / (joint.socket_radius * joint.clearance)) ** 0.5

    def indentation_of_half_angle(self, joint, half_angle):
        return half_angle**2 * joint.socket_radius * joint.clearance / (2 * joint.ball_radius)

    def pole_pressure(self, joint, indentation):
        return self.spring(joint) * indentation

    def pressure(self, joint, indentation, angle):
        depth = indentation - self.indentation_of_half_angle(joint, angle)
        return self.spring(joint) * np.clip(depth, 0.0, inf)
