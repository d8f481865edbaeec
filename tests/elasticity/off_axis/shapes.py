"""Joints, models, bores and scanned points that several tests of this room use."""

from dataclasses import replace
from math import pi, radians
from types import SimpleNamespace

import numpy as np

import ballsocket as bs
from ballsocket.elasticity.off_axis import patch_measures as measures
from ballsocket.elasticity.off_axis.bore_contact import BoreContact, GapField
from ballsocket.elasticity.off_axis.directions import unit_vectors

from ...joints import HIP

RIGID = replace(HIP, ball=None)
COARSE = bs.Sphere(ring_width=radians(4.0))
TIGHT = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM)
WRAPPED = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(300.0)), ring_width=radians(5.0))


def direction(tilt, azimuth=0.0):
    return unit_vectors(np.asarray(tilt), np.asarray(azimuth))


def gap_of(grid, depth=0.0, clearance=0.1, kind=bs.LinearGap):
    depth = depth + np.zeros((grid.rings, grid.meridians))
    return GapField(grid=grid, clearance=clearance, socket_radius=18.0, depth=depth, kind=kind)


def bore_of(compliance, **gap):
    return BoreContact(compliance=compliance, gap=gap_of(compliance.grid, **gap))


def measures_of(patch):
    """Measure one contact by the functions that measure many."""
    cells = measures.make_cell_arrays(patch.grid, patch.inset)
    patches = measures.Patches(pressure=patch.pressure[None], level=patch.level[None], axis=patch.axis[None])
    largest, location = measures.largest_pressures(cells, patches.pressure, patches.axis)
    return SimpleNamespace(
        half_angle=measures.half_angles(cells, patches, measures.measure_edges(cells, patches)[1])[0],
        edge_loaded=measures.edge_loaded(patches.pressure)[0],
        edge_margin=measures.edge_margins(cells, patches)[0],
        max_pressure=largest[0],
        max_pressure_at=location[0],
    )


def scanned_points(radius=18.0, depth=lambda n: 0.0 * n[2], reach=85.0, count=60, shift=(0.0, 0.0, 0.0)):
    """Compute points of a bore with its axis along -y, as in a scan."""
    polar, azimuth = np.meshgrid(np.radians(np.linspace(0.5, reach, count)), np.linspace(0, 2 * pi, 2 * count)[:-1])
    n = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
    points = (radius + depth(n)) * n
    return np.stack([points[0], points[2], -points[1]], axis=-1).reshape(-1, 3) + shift
