"""Synthetic liners and heads as triangles, and pelves as landmarks of a cup of known angles.

`python -m tests.planning.scans`, from the root, writes the example of the planning page.
"""

import json
import struct

import numpy as np
from scipy.spatial.transform import Rotation

from ..places import EXAMPLES

CENTRE = np.array([7.0, -3.0, 40.0])
NAMES = ("right ASIS", "left ASIS", "pubic symphysis")


def rotated(pitch=0.0, roll=0.0, yaw=0.0):
    """Return the matrix of a pelvis in the scanner, by angles in degrees; pitch moves its top to the front."""
    return Rotation.from_euler("xyz", [-pitch, -roll, yaw], degrees=True).as_matrix()


def axis(inclination, anteversion, side="right"):
    """Return the axis out of the opening of a cup by radiographic angles in degrees."""
    ri, ra = np.radians([inclination, anteversion])
    x = np.sin(ri) * np.cos(ra)
    return np.array([x if side == "right" else -x, np.sin(ra), -np.cos(ri) * np.cos(ra)])


def pelvis(inclination=42.0, anteversion=17.0, side="right", scatter=0.0, turn=None, shift=(5.0, -40.0, 900.0)):
    """Return names and points (n, 3) in mm, RAS, of a pelvis whose pelvic plane is turned in the scanner."""
    anterior = [[120.0, 0.0, 0.0], [-120.0, 0.0, 0.0], [0.0, 0.0, -95.0]]
    out = axis(inclination, anteversion, side)
    first = np.cross(out, [0.0, 0.0, 1.0])
    first /= np.linalg.norm(first)
    angles = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    ring = 26.0 * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), np.cross(out, first)))
    ring += np.random.default_rng(5).normal(0.0, scatter, ring.shape) if scatter else 0.0
    centre = np.array([90.0 if side == "right" else -90.0, -40.0, -85.0])
    matrix = np.eye(3) if turn is None else turn
    everything = np.concatenate([anterior, centre + ring]) @ matrix.T + np.array(shift)
    return [*NAMES, *(f"rim-{number}" for number in range(1, 9))], everything


def fcsv(names, points, system="LPS"):
    signs = np.array([1.0, 1.0, 1.0] if system in ("RAS", "0") else [-1.0, -1.0, 1.0])
    head = f"# Markups fiducial file version = 4.11\n# CoordinateSystem = {system}\n"
    lines = ["# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID"]
    for number, (name, (x, y, z)) in enumerate(zip(names, points * signs, strict=True)):
        lines.append(f"vtkMRML_{number},{x:.4f},{y:.4f},{z:.4f},0,0,0,1,1,1,0,{name},,")
    return head + "\n".join(lines) + "\n"


def markups(names, points, system="LPS", unit="mm", scale=1.0):
    signs = np.array([1.0, 1.0, 1.0] if system == "RAS" else [-1.0, -1.0, 1.0])
    controls = [
        {"id": str(number), "label": name, "position": (point * signs * scale).tolist(), "positionStatus": "defined"}
        for number, (name, point) in enumerate(zip(names, points, strict=True))
    ]
    markup = {"type": "Fiducial", "coordinateSystem": system, "coordinateUnits": unit, "controlPoints": controls}
    return json.dumps({"@schema": "markups-schema-v1.0.3.json#", "markups": [markup]})


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
    end = arc_of_cover / 2
    bore = arc(radius, 0.0, end, steps)
    mouth = bore[-1:] + np.array([[0.0, cylinder]])
    corner = mouth + chamfer * np.array([[1.0, 1.0]]) if chamfer else mouth
    face = [[np.sqrt(max((radius + wall) ** 2 - corner[0, 1] ** 2, 0.0)), corner[0, 1]]]
    outer_end = np.degrees(np.arctan2(face[0][0], -face[0][1]))
    outer = arc(radius + wall, 0.0, outer_end, steps)[::-1]
    return turned(np.concatenate([bore, mouth, corner, face, outer]), segments)


def lipped(triangles, lip=15.0, offset=0.0, radius=16.0, height=-1.394, outer=True):
    """Raise the rim of a liner to a second plane, tilted by an angle in degrees from a line at an x = offset in mm.

    The main plane is at a height, -R cos(arc/2). The outer surface ends at both planes, or at the main one only.
    """
    distance = np.linalg.norm(triangles, axis=2)
    polar, azimuth = np.arccos(-triangles[..., 2] / distance), np.arctan2(triangles[..., 1], triangles[..., 0])
    tangent = np.tan(np.radians(lip)) * np.cos(azimuth)
    level = -(height - offset * np.tan(np.radians(lip))) / radius
    main = np.arccos(-height / radius)
    end = np.maximum(np.arctan(tangent) + np.arccos(level / np.hypot(1.0, tangent)), main)
    end = np.where(outer | (abs(distance - radius) < 1e-6), end, main)
    polar *= end / main
    directions = [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), -np.cos(polar)]
    return distance[..., None] * np.stack(directions, axis=-1)


def locked(triangles, radius=26.0, low=-14.0, high=-8.0):
    """Add a locking ring around the z axis to the triangles of a liner."""
    profile = np.array([[22.0, low], [22.0, high], [radius, high], [radius, low], [22.0, low]])
    return np.concatenate([triangles, turned(profile[::-1], 64)])


def head(radius=16.0, arc_of_cover=280.0, depth=12.0, steps=40, segments=96):
    """Return the triangles of a head whose taper opens upwards."""
    ball = arc(radius, 0.0, arc_of_cover / 2, steps)
    mouth = ball[-1]
    taper = np.array([mouth - [0.6, 0.0], [mouth[0] - 1.0, mouth[1] - depth], [0.0, mouth[1] - depth]])
    return turned(np.concatenate([ball, taper])[::-1], segments)


def ribbed(triangles, radius, height=1.0, ribs=8, width=8.0):
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


def worn_bore(count=4000, head=15.9, shift=0.4, tilt=20.0, cover=90.0, noise=0.0, seed=1, radius=16.0):
    """Return points (n, 3) of a bore up to a polar angle, worn by a head that is shifted at a tilt from the pole."""
    generator = np.random.default_rng(seed)
    height = np.cos(np.radians(cover)) + (1 - np.cos(np.radians(cover))) * (np.arange(count) + 0.5) / count
    azimuth = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    ring = np.sqrt(1 - height**2)
    rays = np.column_stack([ring * np.cos(azimuth), ring * np.sin(azimuth), -height])
    along = shift * (rays @ [np.sin(np.radians(tilt)), 0.0, -np.cos(np.radians(tilt))])
    worn = along + np.sqrt(head**2 - shift**2 + along**2)
    return rays * np.maximum(radius, worn)[:, None] + generator.normal(0.0, noise, (count, 3)) + CENTRE


def removed_volume(head=15.9, shift=0.4, radius=16.0):
    """Volume in mm³ of a ball outside a sphere: the ball without the lens of both (closed form)."""
    if head + shift <= radius:
        return 0.0
    lens = np.pi * (radius + head - shift) ** 2 / (12 * shift)
    lens *= shift**2 + 2 * shift * (radius + head) - 3 * (radius - head) ** 2
    return 4 / 3 * np.pi * head**3 - lens


def binary(triangles, header=b"made by a test"):
    records = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    records["v"] = triangles
    return header.ljust(80, b" ") + struct.pack("<I", len(triangles)) + records.tobytes()


def ascii_stl(triangles):
    corner = "      vertex {:.7g} {:.7g} {:.7g}\n"
    loop = f"  facet normal 0 0 0\n    outer loop\n{3 * corner}    endloop\n  endfacet\n"
    facets = "".join(loop.format(*corners.ravel()) for corners in triangles)
    return f"solid test\n{facets}endsolid test\n".encode()


if __name__ == "__main__":
    folder = EXAMPLES / "planning"
    names, points = pelvis(scatter=0.3, turn=rotated(pitch=6.0, roll=1.5, yaw=4.0))
    content = json.loads(markups(names, points.round(2)))
    (folder / "pelvis.mrk.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    bore = scattered(liner(chamfer=1.0, steps=10, segments=24), 0.003)
    (folder / "liner.stl").write_bytes(binary(bore, b"synthetic liner of the planning page"))
    ball = head(radius=15.95, steps=10, segments=24)
    (folder / "head.stl").write_bytes(binary(ball, b"synthetic head of the planning page"))
    points = worn_bore(head=15.85, shift=0.35, count=1500, noise=0.004)
    rows = "\n".join(" ".join(f"{number:.3f}" for number in point) for point in points)
    (folder / "worn.xyz").write_text(
        f"# synthetic worn bore of the planning page, x y z in mm\n{rows}\n", encoding="utf-8"
    )
