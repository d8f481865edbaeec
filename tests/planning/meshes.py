"""Synthetic liners and heads as triangles: turned profiles with holes, ribs and scatter."""

import struct

import numpy as np


def turned(profile, segments=96):
    """Turn a profile (n, 2) of radius and height around z; the body lies to the right of its direction."""
    angles = np.linspace(0.0, 2 * np.pi, segments + 1)
    angles[-1] = 0.0
    ring = np.array([[[r * np.cos(a), r * np.sin(a), z] for a in angles] for r, z in profile])
    here, right, above, both = ring[:-1, :-1], ring[:-1, 1:], ring[1:, :-1], ring[1:, 1:]
    faces = np.concatenate([np.stack([here, both, right], axis=2), np.stack([here, above, both], axis=2)])
    a, b, c = np.moveaxis(faces.reshape(-1, 3, 3), 1, 0)
    return np.stack([a, b, c], axis=1)[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-9]


def arc(radius, start, end, steps):
    """Return points of an arc around the origin, by polar angles in degrees from the pole, which lies below."""
    angle = np.radians(np.linspace(start, end, steps))
    return np.column_stack([radius * np.sin(angle), -radius * np.cos(angle)])


def liner(radius=16.0, wall=8.0, arc_of_cover=170.0, chamfer=0.0, steps=40, segments=96, cylinder=0.0):
    """Triangles of a liner that opens upwards."""
    end = arc_of_cover / 2
    bore = arc(radius, 0.0, end, steps)
    mouth = bore[-1:] + np.array([[0.0, cylinder]])
    corner = mouth + chamfer * np.array([[1.0, 1.0]]) if chamfer else mouth
    face = [[np.sqrt(max((radius + wall) ** 2 - corner[0, 1] ** 2, 0.0)), corner[0, 1]]]
    outer_end = np.degrees(np.arctan2(face[0][0], -face[0][1]))
    outer = arc(radius + wall, 0.0, outer_end, steps)[::-1]
    return turned(np.concatenate([bore, mouth, corner, face, outer]), segments)


def head(radius=16.0, arc_of_cover=280.0, depth=12.0, steps=40, segments=96):
    """Return the triangles of a head whose taper opens upwards."""
    ball = arc(radius, 0.0, arc_of_cover / 2, steps)
    mouth = ball[-1]
    taper = np.array([mouth - [0.6, 0.0], [mouth[0] - 1.0, mouth[1] - depth], [0.0, mouth[1] - depth]])
    return turned(np.concatenate([ball, taper])[::-1], segments)


def ribbed(triangles, radius, height=1.0, ribs=8, width=8.0):
    """Raise ribs on the outer surface beyond a radius."""
    distance = np.linalg.norm(triangles, axis=2)
    azimuth = np.degrees(np.arctan2(triangles[..., 1], triangles[..., 0])) % (360.0 / ribs)
    polar = np.degrees(np.arccos(np.clip(-triangles[..., 2] / distance, -1.0, 1.0)))
    raised = (distance > radius - 1e-6) & (azimuth < width) & (polar > 25.0) & (polar < 75.0)
    return triangles * np.where(raised, 1.0 + height / distance, 1.0)[..., None]


def with_hole(triangles, direction, angle=14.0):
    """Remove the facets within an angle in degrees of a direction from the origin."""
    middle = triangles.mean(axis=1)
    cosine = middle @ direction / np.linalg.norm(middle, axis=1) / np.linalg.norm(direction)
    return triangles[cosine < np.cos(np.radians(angle))]


def scattered(triangles, deviation, seed=1):
    """Move the corners at random, equal corners alike."""
    corners, index = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    moved = corners + np.random.default_rng(seed).normal(0.0, deviation, corners.shape)
    return moved[index.ravel()].reshape(-1, 3, 3)


def binary(triangles, header=b"made by a test"):
    records = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    records["v"] = triangles
    return header.ljust(80, b" ") + struct.pack("<I", len(triangles)) + records.tobytes()


def ascii_stl(triangles):
    corner = "      vertex {:.7g} {:.7g} {:.7g}\n"
    loop = f"  facet normal 0 0 0\n    outer loop\n{3 * corner}    endloop\n  endfacet\n"
    facets = "".join(loop.format(*corners.ravel()) for corners in triangles)
    return f"solid test\n{facets}endsolid test\n".encode()
